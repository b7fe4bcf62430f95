//! Draft of the station: a typing error loses nothing, and nothing is used before all of
//! it is right.

use std::collections::BTreeSet;

use jiff::Timestamp;

use super::{
    antenna_fields,
    fields::{Counts, Field, Problem, Standing, Typed},
    horizon::draft::Skies,
    notices::NoticesDraft,
    page::Page,
    rules::{cannot_act::Around, draft::RulesDraft},
    satellites::draft::SatellitesDraft,
    station_fields::{self, Ground, LATITUDE, LONGITUDE},
};
use crate::{
    astro::Site,
    contract::link_tests::LinkTest,
    model::Model,
    station::{Antenna, AntennaId, ControllerSpec, Station},
};

/// Draft of the whole form.
#[derive(PartialEq)]
pub(in crate::ui) struct Draft {
    pub(in crate::ui) ground: Typed<Ground>,
    pub(in crate::ui) antennas: Vec<Typed<Antenna>>,
    /// Indices of antennas that saving removes; until then each can be taken back.
    removed: BTreeSet<usize>,
    pub(super) notices: NoticesDraft,
    pub(super) skies: Skies,
    pub(super) satellites: SatellitesDraft,
    pub(super) rules: RulesDraft,
}

impl Draft {
    pub(in crate::ui) fn of(station: &Station) -> Self {
        Self {
            ground: Typed::of(Ground::of(station), station_fields::all()),
            antennas: station.antennas.iter().cloned().map(typed).collect(),
            removed: BTreeSet::new(),
            notices: NoticesDraft::of(&station.notices),
            skies: Skies::of(station),
            satellites: SatellitesDraft::of(station),
            rules: RulesDraft::of(station),
        }
    }

    /// Adds an empty antenna of this make. Its id is made of the time, so that it differs from
    /// that of an antenna removed earlier.
    pub(in crate::ui) fn add_antenna(
        &mut self,
        spec: &'static ControllerSpec,
        now: Timestamp,
    ) -> AntennaId {
        self.add(spec.antenna(spec.short_name, spec.default_address), now)
    }

    /// Adds an antenna like this one, as far as it can be used. It has another name, and waits
    /// for an address of its own: two antennas must not drive one unit unnoticed.
    pub(super) fn duplicate(&mut self, index: usize, now: Timestamp) -> Option<AntennaId> {
        let mut antenna = self.antennas.get(index)?.read().0;
        let default_address = antenna.connection.spec().default_address;
        default_address.clone_into(&mut antenna.connection.address);
        Some(self.add(antenna, now))
    }

    fn add(&mut self, antenna: Antenna, now: Timestamp) -> AntennaId {
        let taken: Vec<String> = self.antennas.iter().map(name).collect();
        let taken: Vec<&str> = taken.iter().map(String::as_str).collect();
        let name = Antenna::free_name(&antenna.name, &taken);
        let ids: Vec<AntennaId> = self.antennas.iter().map(|of| of.before().id).collect();
        let second = u32::try_from(now.as_second()).unwrap_or(AntennaId::FIRST.0);
        let id = AntennaId::free(AntennaId(second), &ids);
        let mut antenna = typed(Antenna { id, name, ..antenna });
        antenna.is_new = true;
        self.antennas.push(antenna);
        id
    }

    /// Index of the antenna with this id.
    pub(super) fn index(&self, id: AntennaId) -> Option<usize> {
        self.antennas.iter().position(|antenna| antenna.before().id == id)
    }

    /// The name of an antenna as typed, or that of its make while it has none.
    pub(super) fn antenna_title(&self, id: AntennaId) -> String {
        let Some(antenna) = self.index(id).and_then(|index| self.antennas.get(index)) else {
            return String::new();
        };
        let name = name(antenna).trim().to_owned();
        if name.is_empty() {
            antenna.before().connection.spec().short_name.to_owned()
        } else {
            name
        }
    }

    /// Edits of an antenna, its removal counted as one, and its unusable fields.
    pub(super) fn antenna_counts(&self, id: AntennaId) -> Counts {
        let found = self.index(id).and_then(|index| Some((index, self.antennas.get(index)?)));
        let Some((index, antenna)) = found else { return Counts::default() };
        if self.is_removed(index) {
            return Counts { edited: usize::from(!antenna.is_new), wrong: 0 };
        }
        let standings = self.antenna_standings(index);
        let added = Counts { edited: usize::from(antenna.is_new), wrong: 0 };
        Counts::of(antenna.fields.iter().zip(&standings)).and(added)
    }

    /// The fields of a page that cannot be used.
    pub(super) fn findings(&self, page: Page) -> Vec<Finding> {
        let of_ground = |field: &Field<Ground>| Page::of_section(field.section) == page;
        match page {
            Page::Site => findings(&self.ground.fields, &self.ground_standings(), of_ground),
            Page::Satellites => {
                let mut all = findings(&self.ground.fields, &self.ground_standings(), of_ground);
                all.extend(self.satellites.findings());
                all
            }
            Page::Rules => self.rules.findings(&self.around_rules()),
            Page::Antenna(id) => {
                let index = self.index(id).filter(|index| !self.is_removed(*index));
                let antenna = index.and_then(|index| Some((index, self.antennas.get(index)?)));
                let of = |(index, antenna): (usize, &Typed<Antenna>)| {
                    findings(&antenna.fields, &self.antenna_standings(index), |_| true)
                };
                antenna.map(of).unwrap_or_default()
            }
            Page::Horizon => {
                let problems = self.skies.problems(&self.antenna_names()).into_iter();
                problems
                    .map(|label| Finding { label, problem: Problem::of("is not valid") })
                    .collect()
            }
            Page::Notices => self.notices.findings(),
            Page::Appearance => Vec::new(),
        }
    }

    /// Types `text` into a field of this page.
    pub(super) fn write(&mut self, page: Page, label: &str, text: String) {
        match page {
            Page::Site | Page::Satellites => self.ground.write(label, text),
            Page::Antenna(id) => {
                let index = self.index(id);
                if let Some(antenna) = index.and_then(|index| self.antennas.get_mut(index)) {
                    antenna.write(label, text);
                }
            }
            Page::Notices => self.notices.write(label, text),
            Page::Rules | Page::Horizon | Page::Appearance => {}
        }
    }

    pub(super) fn is_removed(&self, index: usize) -> bool {
        self.removed.contains(&index)
    }

    /// Removes an antenna, or takes its removal back.
    pub(super) fn toggle_removed(&mut self, index: usize) {
        if !self.removed.remove(&index) {
            self.removed.insert(index);
        }
    }

    /// The antennas that stay, by their indices.
    fn kept(&self) -> impl Iterator<Item = (usize, &Typed<Antenna>)> {
        self.antennas.iter().enumerate().filter(|(index, _)| !self.is_removed(*index))
    }

    /// The antennas that stay, with their names as typed.
    pub(super) fn antenna_titles(&self) -> Vec<(AntennaId, String)> {
        let ids = self.kept().map(|(_, antenna)| antenna.before().id);
        ids.map(|id| (id, self.antenna_title(id))).collect()
    }

    /// Antennas and satellites that the rules name.
    pub(super) fn around_rules(&self) -> Around<'_> {
        Around {
            antennas: self.antenna_titles(),
            favourites: self.ground.read().0.favourites(),
            satellites: &self.satellites,
        }
    }

    /// Edits and unusable fields of the station on this page.
    pub(super) fn ground_counts(&self, page: Page) -> Counts {
        let standings = self.ground_standings();
        let fields = self.ground.fields.iter().zip(&standings);
        Counts::of(fields.filter(|(field, _)| Page::of_section(field.section) == page))
    }

    /// Names of the antennas before anything was typed.
    pub(super) fn antenna_names(&self) -> Vec<String> {
        self.kept().map(|(_, antenna)| antenna.before().name.clone()).collect()
    }

    /// The place as typed, also while the rest is not right yet.
    pub(in crate::ui) fn place(&self) -> Option<Site> {
        let (ground, standings) = self.ground.read();
        let mut fields = self.ground.fields.iter().zip(&standings);
        let is_wrong = fields.any(|(field, standing)| {
            let is_of_place = [LATITUDE, LONGITUDE].contains(&&*field.description.label);
            is_of_place && standing.problem.is_some()
        });
        if is_wrong { None } else { ground.with(Vec::new()).map(|station| station.site) }
    }

    /// Standings of the fields of the site.
    pub(in crate::ui) fn ground_standings(&self) -> Vec<Standing> {
        self.ground.read().1
    }

    /// Standings of the fields of an antenna.
    pub(in crate::ui) fn antenna_standings(&self, index: usize) -> Vec<Standing> {
        let Some(antenna) = self.antennas.get(index) else { return Vec::new() };
        let (_, mut standings) = antenna.read();
        if let Some(Standing { problem: problem @ None, .. }) = standings.first_mut()
            && self.has_twin(index)
        {
            let taken: Vec<String> = self.antennas.iter().map(name).collect();
            let taken: Vec<&str> = taken.iter().map(String::as_str).collect();
            let free = Antenna::free_name(name(antenna).trim(), &taken);
            let why = "must differ from those of the other antennas";
            *problem = Some(Problem { would_do: Some(free), ..Problem::of(why) });
        }
        standings
    }

    /// The antenna as it is typed now, if every field is right.
    pub(in crate::ui) fn antenna(&self, index: usize) -> Option<Antenna> {
        let standings = self.antenna_standings(index);
        let is_right = standings.iter().all(|of| of.problem.is_none());
        Some(self.antennas.get(index).filter(|_| is_right)?.read().0)
    }

    /// The last test of the link of the antenna as it is typed now.
    pub(in crate::ui) fn test<'a>(&self, index: usize, model: &'a Model) -> Option<&'a LinkTest> {
        let antenna = self.antenna(index)?;
        let is_it = |test: &&LinkTest| {
            test.antenna.id == antenna.id && test.antenna.connection == antenna.connection
        };
        model.link_tests.iter().find(is_it)
    }

    /// Returns `true` if another antenna has the same name.
    fn has_twin(&self, index: usize) -> bool {
        let Some(own) = self.antennas.get(index).map(name) else { return false };
        let mut kept = self.kept();
        kept.any(|(other, antenna)| other != index && Antenna::same_name(&name(antenna), &own))
    }

    /// The station, if every field is right.
    pub(in crate::ui) fn read(&self) -> Option<Station> {
        let is_right = |standings: &[Standing]| standings.iter().all(|of| of.problem.is_none());
        let (ground, standings) = self.ground.read();
        let mut kept = self.kept().map(|(index, _)| index);
        if !is_right(&standings) || !kept.all(|of| is_right(&self.antenna_standings(of))) {
            return None;
        }
        let mut station =
            ground.with(self.kept().map(|(_, antenna)| antenna.read().0).collect())?;
        let renamed: Vec<(String, String)> = self
            .kept()
            .map(|(_, antenna)| (antenna.before().name.clone(), name(antenna).trim().to_owned()))
            .collect();
        station.notices = self.notices.read()?;
        self.skies.put_into(&mut station, &renamed)?;
        self.satellites.put_into(&mut station)?;
        station.rules = self.rules.read(&self.around_rules())?;
        Some(station)
    }
}

/// A field that cannot be used, and why.
pub(super) struct Finding {
    pub(super) label: String,
    pub(super) problem: Problem,
}

impl Finding {
    pub(super) fn sentence(&self) -> String {
        format!("{} {}.", self.label, self.problem.why)
    }
}

/// The unusable ones of the fields that `is_of_page`.
pub(super) fn findings<T>(
    fields: &[Field<T>],
    standings: &[Standing],
    is_of_page: impl Fn(&Field<T>) -> bool,
) -> Vec<Finding> {
    let of_page = fields.iter().zip(standings).filter(|(field, _)| is_of_page(field));
    let found = of_page.filter_map(|(field, standing)| {
        let label = field.description.label.to_string();
        Some(Finding { label, problem: standing.problem.clone()? })
    });
    found.collect()
}

fn typed(antenna: Antenna) -> Typed<Antenna> {
    let fields = antenna_fields::all(antenna.connection.spec());
    Typed::of(antenna, fields)
}

/// Name as typed; it is the first field.
fn name(antenna: &Typed<Antenna>) -> String {
    antenna.fields.first().map(|field| field.entry.text.clone()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::HorizonMask,
        controller::{
            SPECS,
            rc2000c::{BAUD, BUS_ADDRESS, Calibration},
        },
        makes::DemoAddresses,
    };

    fn station() -> Station {
        Station::demo(&DemoAddresses {
            satrak: "127.0.0.1:4001".to_owned(),
            genius: "127.0.0.1:9006".to_owned(),
            rc2000c: "/dev/pts/7".to_owned(),
        })
    }

    fn write<'a>(fields: &'a mut Typed<Antenna>, label: &str) -> &'a mut String {
        let found = fields.fields.iter_mut().find(|field| field.description.label == label);
        &mut found.unwrap_or_else(|| panic!("no field {label}")).entry.text
    }

    #[test]
    fn what_was_not_touched_comes_back_as_it_was() {
        let horizon_mask = HorizonMask::parse("0 2.5\n120 -0.3\n240.25 11").ok();
        let station = Station { horizon_mask, ..station() };
        assert_eq!(Draft::of(&station).read(), Some(station));
    }

    #[test]
    fn each_make_can_be_added_and_used_as_it_stands() {
        let mut draft = Draft::of(&Station::default());
        for spec in SPECS.iter().chain(SPECS) {
            draft.add_antenna(spec, Timestamp::UNIX_EPOCH);
        }
        let station = draft.read().unwrap();
        let specs: Vec<&ControllerSpec> =
            station.antennas.iter().map(|of| of.connection.spec()).collect();
        assert_eq!(specs, [SPECS, SPECS].concat());
    }

    #[test]
    fn a_removed_antenna_is_left_out_and_can_be_taken_back() {
        let mut draft = Draft::of(&station());
        let whole = draft.read().unwrap();
        "nowhere".clone_into(write(&mut draft.antennas[1], "Address of the Genius"));
        draft.toggle_removed(1);
        let without = draft.read().unwrap();
        assert_eq!(without.antennas.len(), whole.antennas.len() - 1);
        assert!(without.antennas.iter().all(|of| of.name != whole.antennas[1].name));
        draft.toggle_removed(1);
        assert_eq!(draft.read(), None, "what was typed is still there");
        assert_eq!(write(&mut draft.antennas[1], "Address of the Genius"), "nowhere");
    }

    #[test]
    fn a_wrong_field_says_why_and_keeps_the_typing() {
        for (antenna, label, typed) in [
            (0, "Address of the Satrak", "nowhere"),
            (0, "Name", " "),
            (0, "Poll while moving", "11"),
            (1, "Address of the Genius", "host:0"),
            (1, "Azimuth to", "0.5"),
            (1, "Elevation to", "0"),
            (1, "New position every", "0"),
            (2, "Port or address", ""),
            (2, "Port or address", "host:x"),
            (2, "Bus address", "48"),
            (2, "Bus address", "50.5"),
            (2, "Azimuth counts", "30 90"),
            (2, "Elevation counts", "30 0\n1830"),
        ] {
            let mut draft = Draft::of(&station());
            typed.clone_into(write(&mut draft.antennas[antenna], label));
            let standings = draft.antenna_standings(antenna);
            let wrong: Vec<&str> = standings
                .iter()
                .zip(&draft.antennas[antenna].fields)
                .filter(|(standing, _)| standing.problem.is_some())
                .map(|(_, field)| &*field.description.label)
                .collect();
            assert_eq!(wrong, [label], "{typed}");
            assert_eq!(draft.read(), None);
            assert_eq!(write(&mut draft.antennas[antenna], label), typed);
        }
        for (label, typed) in [("Latitude", "91"), ("Altitude", ""), ("Satellites", "25544, NOAA")]
        {
            let mut draft = Draft::of(&station());
            let fields = &mut draft.ground.fields;
            let field = fields.iter_mut().find(|field| field.description.label == label).unwrap();
            typed.clone_into(&mut field.entry.text);
            assert_eq!(draft.read(), None, "{label}");
        }
    }

    #[test]
    fn one_rotator_has_no_elevation_and_what_was_typed_there_waits() {
        let mut draft = Draft::of(&station());
        let genius = &mut draft.antennas[1];
        "steep".clone_into(write(genius, "Elevation to"));
        "Only rotator 2".clone_into(write(genius, "Rotators of this antenna"));
        let station = draft.read().unwrap();
        assert!(!station.antennas[1].connection.variant().capabilities.has_elevation());
        "Azimuth + elevation".clone_into(write(&mut draft.antennas[1], "Rotators of this antenna"));
        assert_eq!(draft.read(), None);
        assert_eq!(write(&mut draft.antennas[1], "Elevation to"), "steep");
    }

    #[test]
    fn what_is_typed_for_an_rc2000c_is_used() {
        let mut draft = Draft::of(&station());
        let unit = &mut draft.antennas[2];
        "host:4002".clone_into(write(unit, "Port or address"));
        "1200".clone_into(write(unit, "Line speed, baud"));
        "111".clone_into(write(unit, "Bus address"));
        "100 -5\n2100; 95".clone_into(write(unit, "Elevation counts"));
        let station = draft.read().unwrap();
        let connection = &station.antennas[2].connection;
        let calibration = Calibration::of(connection);
        assert_eq!(connection.address, "host:4002");
        assert_eq!((connection.whole(&BAUD), connection.whole(&BUS_ADDRESS)), (1200, 111));
        assert_eq!(calibration.elevation.len(), 2);
        assert!((calibration.elevation[0].degrees + 5.0).abs() < 1e-9);
    }

    #[test]
    fn a_decimal_comma_is_understood() {
        let mut draft = Draft::of(&Station::default());
        "41,5".clone_into(&mut draft.ground.fields[1].entry.text);
        let site = draft.read().unwrap().site;
        assert!((site.latitude().degrees() - 41.5).abs() < 1e-9);
    }
}
