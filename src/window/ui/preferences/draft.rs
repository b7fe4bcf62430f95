//! Draft of the station. A typing error loses nothing, and Azel uses nothing before all fields are
//! valid.

use std::borrow::Cow;

use jiff::Timestamp;

use super::{
    antenna_fields,
    fields::{Standing, Typed},
    horizon::draft::Skies,
    notices::NoticesDraft,
    page::Page,
    rules::{cannot_act::RuleContext, draft::RulesDraft},
    satellites::draft::SatellitesDraft,
    search::Spot,
    section::{DraftSection, Finding},
    station_fields::{self, Ground, LATITUDE, LONGITUDE},
};
use crate::{
    astro::Site,
    contract::link_tests::LinkTest,
    model::Model,
    station::{Antenna, AntennaId, ControllerSpec, Hook, NetworkPort, RuleSubject, Station},
};

/// Draft of the whole form.
#[derive(PartialEq)]
pub(in crate::ui) struct Draft {
    pub(in crate::ui) ground: Typed<Ground>,
    pub(in crate::ui) antennas: Vec<Typed<Antenna>>,
    pub(super) notices: NoticesDraft,
    pub(super) skies: Skies,
    pub(super) satellites: SatellitesDraft,
    pub(super) rules: RulesDraft,
    /// Hooks and network ports, which the form does not show.
    local: LocalSettings,
}

impl Draft {
    pub(in crate::ui) fn new(station: &Station) -> Self {
        Self {
            ground: Typed::new(Ground::new(station), station_fields::all()),
            antennas: station.antennas.iter().cloned().map(typed).collect(),
            notices: NoticesDraft::new(&station.notices),
            skies: Skies::new(station),
            satellites: SatellitesDraft::new(station),
            rules: RulesDraft::new(station),
            local: LocalSettings::new(station),
        }
    }

    /// Adds an empty antenna of this make. Its id comes from the time, so that it differs from the
    /// id of a removed antenna.
    pub(in crate::ui) fn add_antenna(
        &mut self,
        spec: &'static ControllerSpec,
        now: Timestamp,
    ) -> AntennaId {
        self.add(spec.antenna(spec.short_name, spec.default_address), now)
    }

    /// Adds a copy of this antenna, with another name and the default address. Two antennas must
    /// not drive one unit unnoticed.
    pub(super) fn duplicate(&mut self, index: usize, now: Timestamp) -> Option<AntennaId> {
        let mut antenna = self.antennas.get(index)?.read().0;
        let default_address = antenna.connection.spec().default_address;
        default_address.clone_into(&mut antenna.connection.address);
        Some(self.add(antenna, now))
    }

    fn add(&mut self, antenna: Antenna, now: Timestamp) -> AntennaId {
        let names: Vec<&str> = self.antennas.iter().map(Typed::name).collect();
        let name = Antenna::free_name(&antenna.name, &names);
        let ids: Vec<AntennaId> =
            self.antennas.iter().map(|typed_antenna| typed_antenna.before().id).collect();
        let second = u32::try_from(now.as_second()).unwrap_or(AntennaId::FIRST.0);
        let id = AntennaId::free(AntennaId(second), &ids);
        let mut antenna = typed(Antenna { id, name, ..antenna });
        antenna.is_new = true;
        self.antennas.push(antenna);
        id
    }

    /// Returns the index of the antenna with this id.
    pub(super) fn index(&self, id: AntennaId) -> Option<usize> {
        self.antennas.iter().position(|antenna| antenna.before().id == id)
    }

    /// Returns the entered name of an antenna, or the name of its make if the name is empty.
    pub(super) fn antenna_title(&self, id: AntennaId) -> String {
        let Some(antenna) = self.index(id).and_then(|index| self.antennas.get(index)) else {
            return String::new();
        };
        let name = match antenna.name().trim() {
            "" => antenna.before().connection.spec().short_name,
            name => name,
        };
        name.to_owned()
    }

    /// Returns the section that this page edits; `None` if choices take effect immediately.
    pub(super) fn section(&self, page: Page) -> Option<&dyn DraftSection> {
        Some(match page {
            Page::Site => &self.ground,
            Page::Horizon => &self.skies,
            Page::Antenna(id) => self.antennas.get(self.index(id)?)?,
            Page::Satellites => &self.satellites,
            Page::Rules => &self.rules,
            Page::Notices => &self.notices,
            Page::Appearance => return None,
        })
    }

    fn section_mut(&mut self, page: Page) -> Option<&mut dyn DraftSection> {
        Some(match page {
            Page::Site => &mut self.ground,
            Page::Horizon => &mut self.skies,
            Page::Antenna(id) => self.index(id).and_then(|index| self.antennas.get_mut(index))?,
            Page::Satellites => &mut self.satellites,
            Page::Rules => &mut self.rules,
            Page::Notices => &mut self.notices,
            Page::Appearance => return None,
        })
    }

    /// Returns the invalid fields of a page.
    pub(super) fn findings(&self, page: Page) -> Vec<Finding> {
        self.section(page).map(|section| section.findings(self)).unwrap_or_default()
    }

    /// Types `text` into a field of this page.
    pub(super) fn write(&mut self, page: Page, label: &str, text: String) {
        if let Some(section) = self.section_mut(page) {
            section.write(label, text);
        }
    }

    pub(super) fn is_removed(&self, index: usize) -> bool {
        self.antennas.get(index).is_some_and(|antenna| antenna.is_removed)
    }

    /// Marks an antenna for removal, or clears the mark.
    pub(super) fn toggle_removed(&mut self, index: usize) {
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.is_removed = !antenna.is_removed;
        }
    }

    /// Returns the antennas that stay, with their indices.
    fn remaining(&self) -> impl Iterator<Item = (usize, &Typed<Antenna>)> {
        self.antennas.iter().enumerate().filter(|(_, antenna)| !antenna.is_removed)
    }

    /// Returns the antennas that stay, with their entered names.
    pub(super) fn antenna_titles(&self) -> Vec<(AntennaId, String)> {
        let ids = self.remaining().map(|(_, antenna)| antenna.before().id);
        ids.map(|id| (id, self.antenna_title(id))).collect()
    }

    /// Returns the antennas and satellites that the rules can name.
    pub(super) fn around_rules(&self) -> RuleContext<'_> {
        RuleContext {
            antennas: self.antenna_titles(),
            favourites: self.satellites.favourites(),
            satellites: &self.satellites,
        }
    }

    /// Returns the names of the antennas before any edit.
    pub(super) fn antenna_names(&self) -> Vec<String> {
        self.remaining().map(|(_, antenna)| antenna.before().name.clone()).collect()
    }

    /// Returns the entered location, even while other fields are invalid.
    pub(in crate::ui) fn place(&self) -> Option<Site> {
        let (ground, standings) = self.ground.read();
        let mut fields = self.ground.fields.iter().zip(&standings);
        let is_wrong = fields.any(|(field, standing)| {
            let is_of_place = [LATITUDE, LONGITUDE].contains(&&*field.description.label);
            is_of_place && standing.problem.is_some()
        });
        if is_wrong { None } else { ground.site() }
    }

    /// Returns the status of each field of the site.
    pub(in crate::ui) fn ground_standings(&self) -> Vec<Standing> {
        self.ground.read().1
    }

    /// Returns the status of each field of an antenna.
    pub(in crate::ui) fn antenna_standings(&self, index: usize) -> Vec<Standing> {
        let Some(antenna) = self.antennas.get(index) else { return Vec::new() };
        let others = self.remaining().filter(|(other, _)| *other != index);
        let names: Vec<&str> = self.antennas.iter().map(Typed::name).collect();
        let reason = "must differ from those of the other antennas";
        antenna.standings_among(others.map(|(_, other)| other.name()), &names, reason)
    }

    /// Returns the antenna as entered, if every field is valid.
    pub(in crate::ui) fn antenna(&self, index: usize) -> Option<Antenna> {
        let standings = self.antenna_standings(index);
        let is_right = standings.iter().all(|standing| standing.problem.is_none());
        Some(self.antennas.get(index).filter(|_| is_right)?.read().0)
    }

    /// Returns the last link test of the antenna as entered.
    pub(in crate::ui) fn test<'a>(&self, index: usize, model: &'a Model) -> Option<&'a LinkTest> {
        let antenna = self.antenna(index)?;
        let is_it = |test: &&LinkTest| {
            test.antenna.id == antenna.id
                && test.antenna.connection.is_same_link(&antenna.connection)
        };
        model.link_tests.iter().find(is_it)
    }

    /// Returns the antennas that stay: name before any edit, and entered name.
    pub(super) fn renamed_antennas(&self) -> Vec<(String, String)> {
        let names = |antenna: &Typed<Antenna>| {
            (antenna.before().name.clone(), antenna.name().trim().to_owned())
        };
        self.remaining().map(|(_, antenna)| names(antenna)).collect()
    }

    /// Returns the station if every field is valid.
    pub(in crate::ui) fn read(&self) -> Option<Station> {
        let mut station = Station::default();
        for section in Page::all(self).into_iter().filter_map(|page| self.section(page)) {
            section.put_into(self, &mut station)?;
        }
        self.local.put_into(&self.around_rules(), &mut station);
        Some(station)
    }
}

/// Settings that the form keeps as they are.
#[derive(PartialEq)]
struct LocalSettings {
    hooks: Vec<Hook>,
    network_ports: Vec<NetworkPort>,
    /// Names of the groups before any edit, in the order of their drafts.
    groups: Vec<String>,
}

impl LocalSettings {
    fn new(station: &Station) -> Self {
        Self {
            hooks: station.hooks.clone(),
            network_ports: station.network_ports.clone(),
            groups: station.groups.iter().map(|group| group.name.clone()).collect(),
        }
    }

    /// Writes the settings, without those of a removed antenna or group. The hooks of a renamed
    /// group follow its name.
    fn put_into(&self, context: &RuleContext<'_>, station: &mut Station) {
        let is_there = |id: AntennaId| station.antennas.iter().any(|antenna| antenna.id == id);
        let ports = self.network_ports.iter().filter(|port| is_there(port.antenna));
        let hooks = self.hooks.iter().filter(|hook| hook.antenna.is_none_or(is_there));
        let renamed = |hook: &Hook| {
            let subject = match &hook.subject {
                Some(RuleSubject::Group(name)) => {
                    let index = self.groups.iter().position(|group| group == name)?;
                    Some(RuleSubject::Group(context.group(index)?))
                }
                other => other.clone(),
            };
            Some(Hook { subject, ..hook.clone() })
        };
        (station.network_ports, station.hooks) =
            (ports.cloned().collect(), hooks.filter_map(renamed).collect());
    }
}

impl DraftSection for Typed<Antenna> {
    /// Counts a removal or an addition as one edit.
    fn edits(&self, _: &Draft) -> usize {
        if self.is_removed {
            return usize::from(!self.is_new);
        }
        self.edited() + usize::from(self.is_new)
    }

    fn findings(&self, draft: &Draft) -> Vec<Finding> {
        let index = draft.index(self.before().id).filter(|_| !self.is_removed);
        index.map(|index| self.findings_in(&draft.antenna_standings(index))).unwrap_or_default()
    }

    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)> {
        self.used_labels()
    }

    fn write(&mut self, label: &str, text: String) {
        self.type_in(label, text);
    }

    fn put_into(&self, draft: &Draft, station: &mut Station) -> Option<()> {
        if !self.is_removed {
            station.antennas.push(draft.antenna(draft.index(self.before().id)?)?);
        }
        Some(())
    }
}

fn typed(antenna: Antenna) -> Typed<Antenna> {
    let fields = antenna_fields::all(antenna.connection.spec());
    Typed::new(antenna, fields)
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
        station::{HookAction, HookEvent},
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
        assert_eq!(Draft::new(&station).read(), Some(station));
    }

    #[test]
    fn hooks_and_ports_stay_with_their_antennas_and_groups() {
        let mut station = station();
        let ids: Vec<AntennaId> = station.antennas.iter().map(|antenna| antenna.id).collect();
        station.groups.push(crate::station::SatelliteGroup {
            name: "Weather".to_owned(),
            satellites: vec![43_013],
            priority: None,
            limits: crate::station::PassLimits::default(),
        });
        let hook = |name: &str, antenna, subject| Hook {
            antenna,
            subject,
            ..Hook::new(name, HookEvent::Aos, HookAction::Command(vec!["true".to_owned()]))
        };
        station.hooks = vec![
            hook("all", None, None),
            hook("first", Some(ids[0]), None),
            hook("second", Some(ids[1]), None),
            hook("group", None, Some(RuleSubject::Group("Weather".to_owned()))),
        ];
        station.network_ports = vec![station.free_port(ids[0])];
        station.network_ports.push(station.free_port(ids[1]));
        let mut draft = Draft::new(&station);
        assert_eq!(draft.read().as_ref(), Some(&station));
        draft.toggle_removed(1);
        let after = draft.read().unwrap();
        let names: Vec<&str> = after.hooks.iter().map(|hook| &*hook.name).collect();
        assert_eq!(names, ["all", "first", "group"]);
        let ports: Vec<AntennaId> = after.network_ports.iter().map(|port| port.antenna).collect();
        assert_eq!(ports, [ids[0]]);
    }

    #[test]
    fn each_make_can_be_added_and_used_as_it_stands() {
        let mut draft = Draft::new(&Station::default());
        for spec in SPECS.iter().chain(SPECS) {
            draft.add_antenna(spec, Timestamp::UNIX_EPOCH);
        }
        let station = draft.read().unwrap();
        let specs: Vec<&ControllerSpec> =
            station.antennas.iter().map(|antenna| antenna.connection.spec()).collect();
        assert_eq!(specs, [SPECS, SPECS].concat());
    }

    #[test]
    fn a_removed_antenna_is_left_out_and_can_be_taken_back() {
        let mut draft = Draft::new(&station());
        let whole = draft.read().unwrap();
        "nowhere".clone_into(write(&mut draft.antennas[1], "Address of the Genius"));
        draft.toggle_removed(1);
        let shortened = draft.read().unwrap();
        assert_eq!(shortened.antennas.len(), whole.antennas.len() - 1);
        assert!(shortened.antennas.iter().all(|antenna| antenna.name != whole.antennas[1].name));
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
            let mut draft = Draft::new(&station());
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
        for (page, label, typed) in [
            (Page::Site, "Latitude", "91"),
            (Page::Site, "Altitude", ""),
            (Page::Satellites, "Satellites", "25544, NOAA"),
        ] {
            let mut draft = Draft::new(&station());
            draft.write(page, label, typed.to_owned());
            assert_eq!(draft.read(), None, "{label}");
        }
    }

    #[test]
    fn one_rotator_has_no_elevation_and_what_was_typed_there_waits() {
        let mut draft = Draft::new(&station());
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
        let mut draft = Draft::new(&station());
        let unit = &mut draft.antennas[2];
        "host:4002".clone_into(write(unit, "Port or address"));
        "1200".clone_into(write(unit, "Line speed, baud"));
        "111".clone_into(write(unit, "Bus address"));
        "100 -5\n2100; 95".clone_into(write(unit, "Elevation counts"));
        let station = draft.read().unwrap();
        let connection = &station.antennas[2].connection;
        let calibration = Calibration::from_connection(connection);
        assert_eq!(connection.address, "host:4002");
        assert_eq!((connection.whole(&BAUD), connection.whole(&BUS_ADDRESS)), (1200, 111));
        assert_eq!(calibration.elevation.len(), 2);
        assert!((calibration.elevation[0].degrees + 5.0).abs() < 1e-9);
    }

    #[test]
    fn a_decimal_comma_is_understood() {
        let mut draft = Draft::new(&Station::default());
        "41,5".clone_into(&mut draft.ground.fields[1].entry.text);
        let site = draft.read().unwrap().site;
        assert!((site.latitude().degrees() - 41.5).abs() < 1e-9);
    }
}
