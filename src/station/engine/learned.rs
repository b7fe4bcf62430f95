//! Learned properties of drives, in a file beside the station file.

use std::{fs, io, path::Path, time::Duration};

use serde::{Deserialize, Serialize};

use super::Engine;
use crate::{
    clock::Instant,
    contract::driver::{AxisLessons, Unit},
    promises::{FileState, PromisedFile},
    station,
};

/// Extension that replaces the one of the station file.
const EXTENSION: &str = "drives.toml";
/// Min time between two saves.
const SAVES_EVERY: Duration = Duration::from_mins(10);
/// Max number of units in the file. Azel drops the units that left the station first.
const MAX_UNITS: usize = 256;

/// Drives of each unit, including units that left the station: an antenna may return.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct LearnedDrives {
    units: Vec<UnitDrives>,
    /// Last requested content of the file.
    requested: Vec<UnitDrives>,
    saved: Option<Instant>,
    /// `true` if the file exists but cannot be read; Azel leaves it unchanged.
    is_unread: bool,
}

/// Content of the file.
#[derive(Debug, Default, Serialize, Deserialize)]
struct DrivesFile<Entry> {
    #[serde(default = "Vec::new")]
    unit: Vec<Entry>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct UnitDrives {
    make: String,
    address: String,
    axis: [AxisLessons; 2],
}

impl UnitDrives {
    fn belongs_to(&self, unit: &Unit) -> bool {
        self.make == unit.make && self.address == unit.address
    }
}

impl LearnedDrives {
    /// Reads the file at `path`. Skips unreadable entries and impossible values.
    fn load(path: &Path) -> Self {
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Self::default(),
            Err(error) => return Self::unread(path, &error),
        };
        let file: DrivesFile<toml::Value> = match toml::from_str(&text) {
            Ok(file) => file,
            Err(error) => return Self::unread(path, &error),
        };
        let units = file.unit.into_iter().take(MAX_UNITS).filter_map(|entry| {
            let unit: Result<UnitDrives, _> = entry.try_into();
            let unit = unit.ok().filter(|unit| unit.axis.iter().all(AxisLessons::is_plausible));
            if unit.is_none() {
                let path = path.display();
                tracing::warn!(%path, "Azel leaves out a unit whose drives it cannot read");
            }
            unit
        });
        let units: Vec<UnitDrives> = units.collect();
        Self { requested: units.clone(), units, ..Self::default() }
    }

    fn unread(path: &Path, error: &dyn std::fmt::Display) -> Self {
        let path = path.display();
        tracing::warn!(
            %path,
            %error,
            "Azel cannot read the learned figures of the drives and does not save new ones"
        );
        Self { is_unread: true, ..Self::default() }
    }

    fn axes(&self, unit: &Unit) -> [AxisLessons; 2] {
        let unit_drives = self.units.iter().find(|unit_drives| unit_drives.belongs_to(unit));
        unit_drives.map(|unit_drives| unit_drives.axis).unwrap_or_default()
    }

    fn note(&mut self, unit: Unit, axis: [AxisLessons; 2]) {
        let place = self.units.iter().position(|unit_drives| unit_drives.belongs_to(&unit));
        let is_learned = axis != <[AxisLessons; 2]>::default();
        match (place.and_then(|place| self.units.get_mut(place)), place) {
            (Some(unit_drives), _) if is_learned => unit_drives.axis = axis,
            (_, Some(place)) => {
                self.units.remove(place);
            }
            (_, None) if is_learned => {
                let Unit { make, address } = unit;
                self.units.push(UnitDrives { make, address, axis });
                if self.units.len() > MAX_UNITS {
                    self.units.remove(0);
                }
            }
            (_, None) => {}
        }
    }

    fn text(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(&DrivesFile { unit: self.units.clone() })
    }
}

impl Engine {
    pub(super) fn load_learned_drives(&mut self) {
        let path = self.settings_path.as_deref().map(|path| path.with_extension(EXTENSION));
        self.learned_drives = path.as_deref().map(LearnedDrives::load).unwrap_or_default();
    }

    /// Returns the learned properties of the drives of an antenna's unit.
    pub(super) fn learned_drives(&self, config: &station::Antenna) -> [AxisLessons; 2] {
        self.learned_drives.axes(&Unit::new(config))
    }

    /// Adopts the learned properties from the sessions, except for units that another Azel drives.
    pub(super) fn note_learned_drives(&mut self) {
        let ours = self.antennas.iter().filter(|antenna| antenna.shown.held_by.is_none());
        let learned = ours
            .map(|antenna| (Unit::new(&antenna.shown.config), antenna.handle.snapshot().learned));
        let learned: Vec<_> = learned.collect();
        for (unit, axes) in learned {
            self.learned_drives.note(unit, axes);
        }
    }

    /// Saves the learned properties, at most once per [`SAVES_EVERY`].
    pub(super) fn keep_learned_drives(&mut self) {
        let saved = self.learned_drives.saved.get_or_insert(self.steady);
        if self.steady < *saved + SAVES_EVERY {
            return;
        }
        self.learned_drives.saved = Some(self.steady);
        self.save_learned_drives(false);
    }

    /// Saves the learned properties. `waits` blocks until the disk has them, for the end of the
    /// program.
    pub(super) fn save_learned_drives(&mut self, waits: bool) {
        let Some(path) = self.beside_station(EXTENSION) else { return };
        if self.learned_drives.is_unread {
            return;
        }
        self.note_learned_drives();
        let promises = self.driver.debts().promises();
        let LearnedDrives { units, requested, .. } = &self.learned_drives;
        let has_failed = matches!(promises.promised(&path), PromisedFile::Failed(_));
        if units == requested && !has_failed {
            return;
        }
        let text = match self.learned_drives.text() {
            Ok(text) => text,
            Err(error) => {
                tracing::error!(%error, "Azel cannot save the learned figures of the drives");
                return;
            }
        };
        self.learned_drives.requested.clone_from(&self.learned_drives.units);
        if !waits {
            return promises.put(&path, FileState::Holds(text));
        }
        if let Err(error) = promises.put_and_wait(&path, FileState::Holds(text)) {
            tracing::error!(error, "the learned figures of the drives are not on the disk");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_that_no_drive_can_have_are_learned_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.drives.toml");
        assert_eq!(LearnedDrives::load(&path), LearnedDrives::default());
        let file = |dead_time_s: &str| {
            let unit = |address: &str, dead_time_s: &str| {
                format!(
                    "[[unit]]\nmake = \"satrak\"\naddress = \"{address}\"\n\
                     [[unit.axis]]\ndead_time = {{ longest_s = {dead_time_s}, starts = 9 }}\n\
                     [[unit.axis]]\n"
                )
            };
            [unit("mast:5000", dead_time_s), unit("dish:5000", "0.5")].concat()
        };
        let unit = |address: &str| Unit { make: "satrak".to_owned(), address: address.to_owned() };
        for (dead_time_s, expected_s) in
            [("0.75", Some(0.75)), ("-1.0", None), ("nan", None), ("inf", None), ("\"x\"", None)]
        {
            fs::write(&path, file(dead_time_s)).unwrap();
            let read = LearnedDrives::load(&path);
            let dead_time_s = |address| read.axes(&unit(address))[0].dead_time_s();
            assert_eq!(dead_time_s("mast:5000"), expected_s);
            assert_eq!(dead_time_s("dish:5000"), Some(0.5), "the other one is kept");
            assert_eq!(dead_time_s("horn:5000"), None);
        }
        fs::write(&path, "[[unit]").unwrap();
        assert!(LearnedDrives::load(&path).is_unread);
    }

    #[test]
    fn a_unit_that_leaves_the_station_is_remembered_up_to_a_limit() {
        let lessons: [AxisLessons; 2] = toml::from_str::<DrivesFile<UnitDrives>>(
            "[[unit]]\nmake = \"satrak\"\naddress = \"a\"\n\
                 [[unit.axis]]\nat_rest = { widest_deg = 0.2, places = 7 }\n[[unit.axis]]\n",
        )
        .unwrap()
        .unit[0]
            .axis;
        let unit = |number: usize| Unit { make: "satrak".to_owned(), address: number.to_string() };
        let mut drives = LearnedDrives::default();
        for number in 0..MAX_UNITS + 2 {
            drives.note(unit(number), lessons);
        }
        assert_eq!(drives.units.len(), MAX_UNITS);
        assert_eq!(drives.axes(&unit(1)), <[AxisLessons; 2]>::default());
        assert_eq!(drives.axes(&unit(2)), lessons);
        drives.note(unit(2), <[AxisLessons; 2]>::default());
        assert_eq!(drives.axes(&unit(2)), <[AxisLessons; 2]>::default(), "the operator reset it");
        assert_eq!(drives.axes(&unit(3)), lessons);
    }
}
