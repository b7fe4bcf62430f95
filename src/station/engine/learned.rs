//! Properties of drives that the sessions have learned, kept in a file beside the station file.

use std::{fs, io, path::Path, time::Duration};

use serde::{Deserialize, Serialize};

use super::Engine;
use crate::{
    clock::Instant,
    driver::{AxisLessons, Unit},
    promises::FileState,
    station,
};

/// The file is named like the station file, but for this.
const EXTENSION: &str = "drives.toml";
/// The disk is not written more often.
const SAVES_EVERY: Duration = Duration::from_mins(10);

/// The drives of each unit of the station.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct LearnedDrives {
    #[serde(default)]
    unit: Vec<UnitDrives>,
    #[serde(skip)]
    saved: Option<Instant>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct UnitDrives {
    make: String,
    address: String,
    axis: [AxisLessons; 2],
}

impl UnitDrives {
    fn is_of(&self, unit: &Unit) -> bool {
        self.make == unit.make && self.address == unit.address
    }
}

impl LearnedDrives {
    /// Reads the file at `path`. Figures that cannot be read, or that no drive can have, are learned
    /// anew.
    fn load(path: &Path) -> Self {
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) => {
                if error.kind() != io::ErrorKind::NotFound {
                    tracing::warn!(%error, "the drives are learned anew");
                }
                return Self::default();
            }
        };
        let mut read: Self = toml::from_str(&text).unwrap_or_else(|error| {
            tracing::warn!(%error, "the drives are learned anew");
            Self::default()
        });
        read.unit.retain(|unit| {
            let is_plausible = unit.axis.iter().all(AxisLessons::is_plausible);
            if !is_plausible {
                tracing::warn!(unit.address, "the drives are learned anew");
            }
            is_plausible
        });
        read
    }

    fn axes(&self, unit: &Unit) -> [AxisLessons; 2] {
        let known = self.unit.iter().find(|known| known.is_of(unit));
        known.map(|known| known.axis).unwrap_or_default()
    }
}

impl Engine {
    pub(super) fn load_learned_drives(&mut self) {
        let path = self.settings_path.as_deref().map(|path| path.with_extension(EXTENSION));
        self.learned_drives = path.as_deref().map(LearnedDrives::load).unwrap_or_default();
    }

    /// Returns what was learned of an antenna's unit before.
    pub(super) fn learned_drives(&self, config: &station::Antenna) -> [AxisLessons; 2] {
        self.learned_drives.axes(&Unit::of(config))
    }

    /// Saves what was learned since the last time, unless that was recently.
    pub(super) fn keep_learned_drives(&mut self) {
        let saved = self.learned_drives.saved.get_or_insert(self.steady);
        if self.steady >= *saved + SAVES_EVERY {
            self.save_learned_drives();
        }
    }

    /// Saves what was learned. A unit that another Azel drives keeps what is known of it.
    pub(super) fn save_learned_drives(&mut self) {
        let Some(path) = self.beside_station(EXTENSION) else { return };
        let units = self.antennas.iter().map(|antenna| {
            let Unit { make, address } = Unit::of(&antenna.shown.config);
            let axis = if antenna.shown.held_by.is_some() {
                self.learned_drives(&antenna.shown.config)
            } else {
                antenna.handle.snapshot().learned
            };
            UnitDrives { make, address, axis }
        });
        let unit: Vec<UnitDrives> =
            units.filter(|unit| unit.axis != <[AxisLessons; 2]>::default()).collect();
        let is_changed = unit != self.learned_drives.unit;
        self.learned_drives = LearnedDrives { unit, saved: Some(self.steady) };
        if !is_changed {
            return;
        }
        let text = toml::to_string(&self.learned_drives).map_err(|error| error.to_string());
        let promises = self.driver.debts().promises();
        let kept = text.and_then(|text| promises.put_and_wait(&path, FileState::Holds(text)));
        if let Err(error) = kept {
            tracing::error!(error, "what was learned of the drives is not on the disk");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_that_no_drive_can_have_are_learned_anew() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.drives.toml");
        assert_eq!(LearnedDrives::load(&path), LearnedDrives::default());
        let file = |dead_time_s: &str| {
            format!(
                "[[unit]]\nmake = \"satrak\"\naddress = \"mast:5000\"\n\
                 [[unit.axis]]\ndead_time = {{ longest_s = {dead_time_s}, starts = 9 }}\n\
                 [[unit.axis]]\n"
            )
        };
        let unit = Unit { make: "satrak".to_owned(), address: "mast:5000".to_owned() };
        for (dead_time_s, expected_s) in
            [("0.75", Some(0.75)), ("-1.0", None), ("nan", None), ("inf", None), ("x", None)]
        {
            fs::write(&path, file(dead_time_s)).unwrap();
            let [first, _] = LearnedDrives::load(&path).axes(&unit);
            assert_eq!(first.dead_time_s(), expected_s, "{dead_time_s}");
        }
        let elsewhere = Unit { address: "dish:5000".to_owned(), ..unit };
        fs::write(&path, file("0.75")).unwrap();
        assert_eq!(LearnedDrives::load(&path).axes(&elsewhere), <[AxisLessons; 2]>::default());
    }
}
