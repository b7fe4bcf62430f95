//! Reading of a station from TOML. A missing value becomes its default, an invalid value becomes
//! its default with a note, and a note names an unknown key.

mod antenna;
mod favourites;
mod hooks;
mod keep_out;
mod keeping;
mod metrics_port;
mod network_ports;
mod notices;
mod offsets;
mod schedule;
mod unread;

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use toml::{Table, Value};
pub use unread::Unread;

use super::{Antenna, AntennaId, ControllerSpec, Favourites, Frequency, OnClose, Station, ranges};
use crate::astro::{HorizonMask, Site};

/// Entries of earlier versions, without the numbers of list entries. Azel reads them without a
/// note, and the next save drops them.
const RETIRED: [&str; 1] = ["antenna.upkeep.upload"];

/// An entry that Azel did not use as written in the file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    /// Place in the file, such as `antenna[0].beam_width_deg`.
    pub place: String,
    /// Line of the entry in the file, from 1; `None` if the entry was not read from a file.
    #[serde(default)]
    pub line: Option<usize>,
    pub reason: NoteReason,
}

/// Reason why Azel did not use an entry as written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum NoteReason {
    /// An invalid value, which the default replaces.
    Invalid(String),
    /// An unknown setting, perhaps a typing error.
    Unknown,
    /// An unusable keep-out or Sun avoidance, which does not apply.
    DoesNotHold {
        /// Name from the operator.
        name: String,
        #[serde(rename = "why")]
        reason: String,
    },
}

/// Returns the station of a parsed station file with controllers of these makes, and notes on
/// entries that Azel did not use as written.
pub fn from_toml(table: Table, specs: &[&'static ControllerSpec]) -> (Station, Vec<Note>) {
    let Read { station, notes, .. } = read(table, specs);
    (station, notes)
}

/// A station, with notes on the unusable entries of its file.
pub(super) struct Read {
    pub(super) station: Station,
    pub(super) notes: Vec<Note>,
    /// Places of the omitted list entries.
    pub(super) left_out: Vec<String>,
}

#[expect(clippy::redundant_closure_for_method_calls, reason = "a path names one lifetime")]
pub(super) fn read(mut table: Table, specs: &[&'static ControllerSpec]) -> Read {
    let mut fields = TableFields::new(&mut table, String::new());
    let default = Station::default();
    // `file` checks the version, and refuses files of a newer program.
    fields.table.remove("version");
    let mut station = Station {
        name: fields.text("name", &default.name),
        site: fields.site(),
        horizon_mask: fields.horizon_mask(),
        aos_elevation_deg: default.aos_elevation_deg,
        elevation_floor_deg: fields.number(
            "elevation_floor_deg",
            &ranges::ELEVATION_FLOOR_DEG,
            10.0,
        ),
        favourites: Favourites::default(),
        scheduling: fields.scheduling(),
        groups: Vec::new(),
        pass_choices: fields.list("pass", |pass| pass.pass_choice()),
        rules: Vec::new(),
        frequencies: fields.frequencies(),
        offsets: Vec::new(),
        network_ports: Vec::new(),
        metrics: fields.metrics_port(),
        hooks: Vec::new(),
        notices: fields.notices(),
        record: fields.keeping(),
        on_close: fields.on_close(),
        keep_outs: Vec::new(),
        sun_avoidance: fields.sun_avoidance(),
        antennas: fields.antennas(specs),
        unread: Vec::new(),
    };
    // In earlier versions, the first antenna determined the AOS elevation of the station.
    let of_first = station.antennas.first().map(|antenna| antenna.limits.minimum_elevation_deg);
    station.aos_elevation_deg = fields.number(
        "aos_elevation_deg",
        &ranges::ELEVATION_DEG,
        of_first.unwrap_or(default.aos_elevation_deg),
    );
    // These entries name antennas, and rules name groups.
    station.keep_outs = fields.keep_outs(&station.antennas);
    let antennas: Vec<AntennaId> = station.antennas.iter().map(|antenna| antenna.id).collect();
    station.favourites = fields.favourites(default.favourites, &antennas);
    station.groups = fields.list("group", |group| group.satellite_group(&antennas));
    station.offsets = fields.list("offsets", |offsets| offsets.kept_offsets(&antennas));
    station.network_ports = fields.network_ports(&antennas);
    let groups: Vec<&str> = station.groups.iter().map(|group| &*group.name).collect();
    station.rules = fields.list("rule", |rule| rule.automation_rule(&antennas, &groups));
    station.hooks = fields.hooks(&antennas, &groups);
    fields.name_the_unknown();
    let TableFields { notes, left_out, antenna_places, .. } = fields;
    station.unread = unread::safety_entries(&notes, &antenna_places);
    Read { station, notes, left_out }
}

struct TableFields<'a> {
    table: &'a mut Table,
    path: String,
    notes: Vec<Note>,
    left_out: Vec<String>,
    /// Beginning of the places of each antenna, with its id.
    antenna_places: Vec<(String, AntennaId)>,
}

impl<'a> TableFields<'a> {
    fn new(table: &'a mut Table, path: String) -> Self {
        let (notes, left_out, antenna_places) = (Vec::new(), Vec::new(), Vec::new());
        Self { table, path, notes, left_out, antenna_places }
    }
}

impl TableFields<'_> {
    fn note(&mut self, key: &str, reason: NoteReason) {
        self.notes.push(Note { place: format!("{}{key}", self.path), line: None, reason });
    }

    fn leave_out(&mut self, place: &str) {
        self.left_out.push(format!("{}{place}", self.path));
    }

    /// Adds the notes of a nested table.
    fn note_all_of(&mut self, mut part: TableFields<'_>) {
        self.notes.append(&mut part.notes);
        self.left_out.append(&mut part.left_out);
    }

    fn invalid(&mut self, key: &str, reason: impl Into<String>) {
        self.note(key, NoteReason::Invalid(reason.into()));
    }

    fn text(&mut self, key: &str, default: &str) -> String {
        match self.table.remove(key) {
            None => default.to_owned(),
            Some(Value::String(text)) if !text.trim().is_empty() => text,
            Some(_) => {
                self.invalid(key, "must be a text that is not empty");
                default.to_owned()
            }
        }
    }

    /// Reads a number within `range`, with or without decimals.
    fn number(&mut self, key: &str, range: &RangeInclusive<f64>, default: f64) -> f64 {
        let value = match self.table.remove(key) {
            None => return default,
            Some(Value::Float(number)) => Some(number),
            Some(Value::Integer(number)) => Some(number as f64),
            Some(_) => None,
        };
        match value {
            Some(number) if range.contains(&number) => number,
            _ => {
                let (low, high) = (range.start(), range.end());
                self.invalid(key, format!("must be a number from {low} to {high}"));
                default
            }
        }
    }

    fn site(&mut self) -> Site {
        let Some(mut value) = self.table.remove("site") else { return Site::default() };
        if let Value::Table(site) = &mut value {
            site.entry("refraction").or_insert_with(|| Value::Table(Table::new()));
        }
        value.try_into().unwrap_or_else(|error: toml::de::Error| {
            self.invalid("site", error.message());
            Site::default()
        })
    }

    fn horizon_mask(&mut self) -> Option<HorizonMask> {
        let read = match self.table.remove("horizon_mask")? {
            Value::String(text) => HorizonMask::parse(&text).map_err(|error| error.to_string()),
            _ => Err("must be a text with an azimuth and an elevation a line".to_owned()),
        };
        read.map_err(|reason| self.invalid("horizon_mask", reason)).ok()
    }

    fn on_close(&mut self) -> Option<OnClose> {
        let actions = [
            ("hold", Some(OnClose::Hold)),
            ("park", Some(OnClose::Park)),
            ("leave", Some(OnClose::Leave)),
        ];
        self.one_of("close", &actions, None)
    }

    fn catalog_numbers<T: DeserializeOwned>(&mut self, key: &str, default: T) -> T {
        let Some(value) = self.table.remove(key) else { return default };
        value.try_into().unwrap_or_else(|error: toml::de::Error| {
            self.invalid(key, error.message());
            default
        })
    }

    fn satellite(&mut self) -> Option<u32> {
        let number = self.table.remove("satellite").as_ref().and_then(catalog_number);
        if number.is_none() {
            self.invalid("satellite", "must be a catalogue number");
        }
        number
    }

    #[expect(clippy::redundant_closure_for_method_calls, reason = "a path names one lifetime")]
    fn frequencies(&mut self) -> Vec<Frequency> {
        self.list("frequency", |frequency| frequency.frequency())
    }

    /// Reads a frequency. Satellite and MHz are required; they have no default.
    fn frequency(&mut self) -> Option<Frequency> {
        let name = match self.table.remove("name") {
            Some(Value::String(name)) => name,
            None => String::new(),
            Some(_) => {
                self.invalid("name", "must be a text");
                String::new()
            }
        };
        let mhz = self.number("mhz", &ranges::FREQUENCY_MHZ, 0.0);
        let satellite = self.satellite()?;
        (mhz > 0.0).then_some(Frequency { satellite, mhz, name })
    }

    /// Reads the tables of the list `key`. Omits unusable tables with a note.
    fn list<T>(
        &mut self,
        key: &str,
        mut read: impl FnMut(&mut TableFields<'_>) -> Option<T>,
    ) -> Vec<T> {
        let tables = match self.table.remove(key) {
            None => return Vec::new(),
            Some(Value::Array(tables)) => tables,
            Some(_) => {
                self.invalid(key, "must be a list of tables");
                return Vec::new();
            }
        };
        let mut found = Vec::new();
        for (index, value) in tables.into_iter().enumerate() {
            let place = format!("{key}[{index}]");
            let entry = if let Value::Table(table) = value {
                self.entry(&place, table, &mut read)
            } else {
                self.invalid(&place, "must be a table");
                None
            };
            if entry.is_none() {
                self.leave_out(&place);
            }
            found.extend(entry);
        }
        found
    }

    /// Reads the table at `place` of a list.
    fn entry<T>(
        &mut self,
        place: &str,
        mut table: Table,
        read: impl FnOnce(&mut TableFields<'_>) -> T,
    ) -> T {
        let path = format!("{}{place}.", self.path);
        let mut fields = TableFields::new(&mut table, path);
        let value = read(&mut fields);
        fields.name_the_unknown();
        self.note_all_of(fields);
        value
    }

    fn antennas(&mut self, specs: &[&'static ControllerSpec]) -> Vec<Antenna> {
        let tables = match self.table.remove("antenna") {
            None => return Vec::new(),
            Some(Value::Array(tables)) => tables,
            Some(_) => {
                self.invalid("antenna", "must be a list of tables");
                return Vec::new();
            }
        };
        let ids: Vec<Option<AntennaId>> = tables.iter().map(given_id).collect();
        let mut antennas: Vec<Antenna> = Vec::new();
        for (index, value) in tables.into_iter().enumerate() {
            let place = format!("antenna[{index}]");
            let Value::Table(mut table) = value else {
                self.invalid(&place, "must be a table");
                self.leave_out(&place);
                continue;
            };
            let path = format!("{place}.");
            let mut fields = TableFields::new(&mut table, path.clone());
            // Ids that follow in the file are reserved before a missing id gets a value.
            let later = ids.iter().skip(index + 1).flatten().copied();
            let used_ids: Vec<AntennaId> =
                antennas.iter().map(|other| other.id).chain(later).collect();
            if let Some(mut antenna) = fields.antenna(specs, &antennas, &used_ids) {
                let others: Vec<&str> = antennas.iter().map(|other| &*other.name).collect();
                let name = Antenna::free_name(&antenna.name, &others);
                if name != antenna.name {
                    let reason = format!("another antenna has it too, this one is called {name}");
                    fields.invalid("name", reason);
                    antenna.name = name;
                }
                self.antenna_places.push((path, antenna.id));
                antennas.push(antenna);
                fields.name_the_unknown();
            } else {
                self.left_out.push(place);
            }
            self.note_all_of(fields);
        }
        antennas
    }

    /// Reads the fields of the table `key`; a missing table counts as empty.
    fn inner<T>(&mut self, key: &str, read: impl FnOnce(&mut TableFields<'_>) -> T) -> T {
        let table = match self.table.remove(key) {
            None => Table::new(),
            Some(Value::Table(table)) => table,
            Some(_) => {
                self.invalid(key, "must be a table");
                Table::new()
            }
        };
        self.entry(key, table, read)
    }

    fn name_the_unknown(&mut self) {
        let keys = self.table.keys().filter(|key| !is_retired(&self.path, key));
        let unknown: Vec<String> = keys.cloned().collect();
        for key in unknown {
            self.note(&key, NoteReason::Unknown);
        }
    }
}

/// Returns `true` if earlier versions wrote an entry at this place, such as `antenna[0].upkeep.`.
fn is_retired(path: &str, key: &str) -> bool {
    let mut place = format!("{path}{key}");
    place.retain(|letter| !letter.is_ascii_digit() && !matches!(letter, '[' | ']'));
    RETIRED.contains(&&*place)
}

fn catalog_number(value: &Value) -> Option<u32> {
    value.as_integer().and_then(|number| u32::try_from(number).ok())
}

/// Returns the id in the table of an antenna.
fn given_id(antenna: &Value) -> Option<AntennaId> {
    let id = antenna.get("id")?.as_integer()?;
    u32::try_from(id).ok().map(AntennaId)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::{Air, Refraction};

    fn read_site(lines: &str) -> (Site, Vec<Note>) {
        let text = format!(
            "[site]\nlatitude_deg = 41.0\nlongitude_deg = 29.0\naltitude_m = 100.0\n{lines}"
        );
        let (station, notes) = from_toml(toml::from_str(&text).unwrap(), &[]);
        (station.site, notes)
    }

    #[test]
    fn a_site_without_settings_of_refraction_has_the_default_ones() {
        let (site, notes) = read_site("");
        assert_eq!((site.refraction(), &notes[..]), (Refraction::default(), &[][..]));
        let (site, notes) = read_site("[site.refraction]\npressure_hpa = 950.0\n");
        assert_eq!(notes, []);
        assert_eq!(site.refraction().air, Air::Standard);
        let written = toml::Table::try_from(Station::default()).unwrap();
        assert!(!written["site"].as_table().unwrap().contains_key("refraction"), "{written}");
    }

    #[test]
    fn settings_of_refraction_are_written_and_read_back() {
        let refraction = Refraction {
            air: Air::Measured,
            pressure_hpa: 905.5,
            temperature_c: -11.0,
            humidity_percent: 80.0,
            in_passes: true,
        };
        let site = Site::default().with_refraction(refraction).unwrap();
        let station = Station { site, ..Station::default() };
        let written = toml::Table::try_from(&station).unwrap();
        let (read, notes) = from_toml(written, &[]);
        assert_eq!((read.site, &notes[..]), (site, &[][..]));
    }

    #[test]
    fn refraction_that_cannot_be_used_says_why_and_forbids_motion() {
        for (lines, reason) in [
            ("pressure_hpa = 101.3", "refraction.pressure_hpa 101.3 is not between 300 and 1100"),
            ("humidity_percent = 100\ntemperature_c = 60", "refractivity"),
            ("presure_hpa = 1000", "unknown field `presure_hpa`"),
            ("air = 'vacuum'", "unknown variant `vacuum`"),
        ] {
            let table = toml::from_str(&format!(
                "[site]\nlatitude_deg = 41.0\nlongitude_deg = 29.0\naltitude_m = 100.0\n\
                 [site.refraction]\n{lines}"
            ));
            let (station, notes) = from_toml(table.unwrap(), &[]);
            let [Note { place, reason: NoteReason::Invalid(text), .. }] = &notes[..] else {
                panic!("{notes:?}")
            };
            assert!(place == "site" && text.contains(reason), "{text}");
            assert_eq!(station.unread.len(), 1);
        }
    }
}
