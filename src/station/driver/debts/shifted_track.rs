//! Offsets that were written to a unit for a track of its own, and what it held before: kept on
//! disk until they are taken back, so that a program that breaks off does not lose them.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Debts, Unit};
use crate::{astro::TrackOffsets, whole_file};

/// End of the names of these records.
pub(super) const SHIFTED: &str = ".offsets.toml";

/// A unit whose own track was shifted from here.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::driver) struct ShiftedTrack {
    /// When the first offset was about to be written.
    pub(in crate::driver) since: Timestamp,
    /// What the unit held before, in azimuth and elevation.
    pub(in crate::driver) before: TrackOffsets,
    /// What it may hold by now: the last that was read back, and what was written after it.
    pub(in crate::driver) put: Vec<TrackOffsets>,
    /// An earlier run left it so.
    #[serde(skip)]
    pub(in crate::driver) is_found: bool,
}

/// Content of a record on disk.
#[derive(Debug, Serialize, Deserialize)]
struct Mark {
    #[serde(flatten)]
    unit: Unit,
    #[serde(flatten)]
    shifted: ShiftedTrack,
}

impl ShiftedTrack {
    /// What is added to what the unit held before, where it reports `held`; `None` if that is not
    /// from here.
    pub(in crate::driver) fn added(&self, held: TrackOffsets) -> Option<TrackOffsets> {
        let is_known = held == self.before || self.put.contains(&held);
        is_known.then(|| held.less(self.before)).flatten()
    }
}

impl Debts {
    pub(in crate::driver) fn shifted(&self, unit: &Unit) -> Option<ShiftedTrack> {
        self.ledger().shifted.get(unit).cloned()
    }

    /// The units that may still hold offsets of a track.
    pub fn with_offsets(&self) -> Vec<Unit> {
        self.ledger().shifted.keys().cloned().collect()
    }

    /// What was written to the unit, or is about to be; `None` once it is taken back. It is on the
    /// disk after [`Self::keep_shifted`].
    pub(in crate::driver) fn set_shifted(&self, unit: &Unit, shifted: Option<ShiftedTrack>) {
        let mut ledger = self.ledger();
        match shifted {
            Some(shifted) => drop(ledger.shifted.insert(unit.clone(), shifted)),
            None => drop(ledger.shifted.remove(unit)),
        }
    }

    /// Makes the record on disk say what is known now. Blocks.
    pub(in crate::driver) fn keep_shifted(&self, unit: &Unit) -> io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let _files = self.files();
        let path = path_in(folder, unit);
        match self.shifted(unit) {
            Some(shifted) => {
                let mark = Mark { unit: unit.clone(), shifted };
                let text = toml::to_string(&mark).map_err(io::Error::other)?;
                whole_file::replace(&path, text.as_bytes())
            }
            None => match fs::remove_file(path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
                _ => Ok(()),
            },
        }
    }
}

impl Debts {
    /// Looks again for what an earlier run left, since another Azel may have driven the unit
    /// meanwhile; what was written from here is known better. Blocks.
    pub(in crate::driver) fn find_shifted(&self, unit: &Unit) {
        let Some(folder) = &self.folder else { return };
        let _files = self.files();
        let path = path_in(folder, unit);
        let found = match fs::exists(&path) {
            Ok(false) => None,
            // One that cannot be read says nothing new.
            _ => match read(&path) {
                Some((_, shifted)) => Some(shifted),
                None => return,
            },
        };
        if self.shifted(unit).is_none_or(|shifted| shifted.is_found) {
            self.set_shifted(unit, found);
        }
    }
}

fn path_in(folder: &Path, unit: &Unit) -> PathBuf {
    folder.join(format!("{}{SHIFTED}", unit.stem()))
}

/// What earlier runs left in `folder`. A record that cannot be read names no unit: it stays, and
/// the log says so.
pub(super) fn found(folder: &Path) -> Vec<(Unit, ShiftedTrack)> {
    let Ok(files) = fs::read_dir(folder) else { return Vec::new() };
    let paths = files.filter_map(|file| Some(file.ok()?.path()));
    let is_one = |path: &PathBuf| path.to_string_lossy().ends_with(SHIFTED);
    paths.filter(is_one).filter_map(|path| read(&path)).collect()
}

fn read(path: &Path) -> Option<(Unit, ShiftedTrack)> {
    let text = fs::read_to_string(path).map_err(io::Error::other);
    let mark = text.and_then(|text| toml::from_str::<Mark>(&text).map_err(io::Error::other));
    let told = mark.inspect_err(|error| {
        tracing::error!(%error, path = %path.display(), "a unit may still hold offsets of a pass");
    });
    let Mark { unit, shifted } = told.ok()?;
    Some((unit, ShiftedTrack { is_found: true, ..shifted }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::{Angle, Offset};

    fn azimuth(degrees: f64) -> TrackOffsets {
        TrackOffsets::NONE.plus(Offset::Azimuth(Angle::from_degrees(degrees))).unwrap()
    }

    #[test]
    fn what_was_written_outlives_the_program_until_it_is_taken_back() {
        let folder = tempfile::tempdir().unwrap();
        let debts = || Debts::marked_in(Some(folder.path().join("marks")));
        let unit = Unit { make: "satrak".to_owned(), address: "10.0.0.5:4001".to_owned() };
        let shifted = ShiftedTrack {
            since: Timestamp::UNIX_EPOCH,
            before: azimuth(-0.1),
            put: vec![azimuth(0.1), azimuth(0.2)],
            is_found: false,
        };
        let first = debts();
        first.set_shifted(&unit, Some(shifted.clone()));
        first.keep_shifted(&unit).unwrap();
        let second = debts();
        let found = ShiftedTrack { is_found: true, ..shifted };
        assert_eq!(second.shifted(&unit), Some(found.clone()));
        assert_eq!(second.with_offsets(), std::slice::from_ref(&unit));
        assert_eq!(found.added(azimuth(0.2)), Some(azimuth(0.3)));
        assert_eq!(found.added(azimuth(-0.1)), Some(TrackOffsets::NONE));
        assert_eq!(found.added(azimuth(0.5)), None, "somebody else's");
        second.set_shifted(&unit, None);
        second.keep_shifted(&unit).unwrap();
        second.keep_shifted(&unit).unwrap();
        assert_eq!(debts().shifted(&unit), None);
    }

    #[test]
    fn what_another_azel_has_recorded_or_taken_back_meanwhile_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let [here, there] = [(); 2].map(|()| Debts::marked_in(Some(folder.path().to_owned())));
        let unit = Unit { make: "satrak".to_owned(), address: "a:1".to_owned() };
        let put = |degrees| ShiftedTrack {
            since: Timestamp::UNIX_EPOCH,
            before: TrackOffsets::NONE,
            put: vec![azimuth(degrees)],
            is_found: false,
        };
        there.set_shifted(&unit, Some(put(0.1)));
        there.keep_shifted(&unit).unwrap();
        here.find_shifted(&unit);
        assert_eq!(here.shifted(&unit), Some(ShiftedTrack { is_found: true, ..put(0.1) }));
        there.set_shifted(&unit, None);
        there.keep_shifted(&unit).unwrap();
        here.find_shifted(&unit);
        assert_eq!(here.shifted(&unit), None);
        here.set_shifted(&unit, Some(put(0.2)));
        here.find_shifted(&unit);
        assert_eq!(here.shifted(&unit), Some(put(0.2)), "it is about to be recorded");
    }

    #[test]
    fn a_record_that_cannot_be_read_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format!("satrak-a{SHIFTED}"));
        fs::write(&path, "since = ").unwrap();
        let unit = Unit { make: "satrak".to_owned(), address: "a".to_owned() };
        assert_eq!(Debts::marked_in(Some(folder.path().to_owned())).shifted(&unit), None);
        assert!(path.exists());
    }
}
