//! Offsets that Azel wrote for a unit's own track, and the offsets before them. The record stays on
//! disk until Azel has restored the offsets, even after a crash.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{DebtRecord, Debts, OFFSETS, file};
use crate::{
    astro::{Angle, Offset, TrackOffsets},
    contract::driver::Unit,
    promises::{FileState, PromisedFile},
};

/// Max number of offset values recorded per unit.
const MAX_PUT: usize = 64;

/// Unit whose own track Azel shifted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::driver) struct ShiftedTrack {
    /// Time just before the first offset was written.
    #[serde(rename = "since")]
    pub(in crate::driver) start: Timestamp,
    /// Previous offsets of the unit in azimuth and elevation.
    pub(in crate::driver) before: TrackOffsets,
    /// Offsets that the unit may have now: the last values read back, and all values written since.
    pub(in crate::driver) put: Vec<TrackOffsets>,
    /// Track with the added offsets. Earlier versions did not record the track.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::driver) track: Option<AddedTo>,
    /// `true` if the record comes from an earlier run.
    #[serde(skip)]
    pub(in crate::driver) is_found: bool,
}

/// Track of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::driver) struct AddedTo {
    pub(in crate::driver) catalog_number: u32,
    /// End of the track by the unit's clock.
    #[serde(rename = "until")]
    pub(in crate::driver) end: Timestamp,
}

impl ShiftedTrack {
    /// Marks the record as coming from an earlier run.
    pub(super) fn mark_found((unit, shifted): (Unit, Self)) -> (Unit, Self) {
        (unit, Self { is_found: true, ..shifted })
    }

    /// Returns the part of `current`, the reported offsets, that Azel added to the previous
    /// offsets; `None` if any component does not come from Azel.
    pub(in crate::driver) fn added(&self, current: TrackOffsets) -> Option<TrackOffsets> {
        let is_ours = [TrackOffsets::azimuth, TrackOffsets::elevation]
            .into_iter()
            .all(|component| self.may_hold(component, current));
        is_ours.then(|| current.less(self.before)).flatten()
    }

    /// Returns `true` if this component of `current` is the previous value or a value that Azel
    /// wrote. The components of one write may take effect one after the other.
    fn may_hold(&self, component: fn(TrackOffsets) -> Angle, current: TrackOffsets) -> bool {
        let mut candidates = self.put.iter().chain([&self.before]);
        candidates.any(|offsets| component(*offsets) == component(current))
    }

    /// Removes each component that somebody else has set according to `current`, because Azel
    /// leaves such a component alone. Returns `None` if none remains.
    pub(in crate::driver) fn drop_foreign(self, current: TrackOffsets) -> Option<Self> {
        let restored = |component: fn(TrackOffsets) -> Angle| {
            component(if self.may_hold(component, current) { self.before } else { current })
        };
        let before = TrackOffsets::NONE
            .plus(Offset::Azimuth(restored(TrackOffsets::azimuth)))?
            .plus(Offset::Elevation(restored(TrackOffsets::elevation)))?;
        Some(Self { before, ..self })
    }

    /// Records that the unit may have `offsets` from now on.
    pub(in crate::driver) fn record(&mut self, offsets: TrackOffsets) {
        self.put.retain(|other| *other != offsets);
        if self.put.len() >= MAX_PUT {
            self.put.remove(0);
        }
        self.put.push(offsets);
    }
}

impl Debts {
    pub(in crate::driver) fn shifted(&self, unit: &Unit) -> Option<ShiftedTrack> {
        self.ledger().shifted.get(unit).cloned()
    }

    /// Returns the units that may still have offsets of a track.
    pub fn with_offsets(&self) -> Vec<Unit> {
        self.ledger().shifted.keys().cloned().collect()
    }

    /// Requests a file with the offsets that Azel wrote or is about to write to the unit; `None`
    /// after they are restored. A worker writes the file.
    pub(in crate::driver) fn set_shifted(&self, unit: &Unit, shifted: Option<ShiftedTrack>) {
        let mut ledger = self.ledger();
        let state = match &shifted {
            Some(shifted) => file(unit, shifted),
            None => Ok(FileState::Absent),
        };
        match shifted {
            Some(shifted) => drop(ledger.shifted.insert(unit.clone(), shifted)),
            None => drop(ledger.shifted.remove(unit)),
        }
        if let Some(path) = self.path(unit, OFFSETS) {
            match state {
                Ok(state) => self.promises.put(&path, state),
                Err(error) => tracing::error!(error, "the file of offsets is out of date"),
            }
        }
    }

    /// Returns the progress of the offsets file.
    pub(in crate::driver) fn shifted_kept(&self, unit: &Unit) -> PromisedFile {
        self.path(unit, OFFSETS).map_or(PromisedFile::OnDisk, |path| self.promises.promised(&path))
    }

    /// Searches again for offsets of an earlier run, because another Azel may have driven the unit
    /// since. Keeps the record of offsets that this run wrote. Blocks.
    pub(in crate::driver) fn find_shifted(&self, unit: &Unit) {
        let Some(path) = self.path(unit, OFFSETS) else { return };
        let found =
            match self.promises.read(&path).map(|text| text.map(|text| toml::from_str(&text))) {
                Ok(None) => None,
                Ok(Some(Ok(DebtRecord { unit, debt }))) => {
                    Some(ShiftedTrack::mark_found((unit, debt)).1)
                }
                // An unreadable file contains no new information.
                Ok(Some(Err(_))) | Err(_) => return,
            };
        let mut ledger = self.ledger();
        if ledger.shifted.get(unit).is_none_or(|shifted| shifted.is_found) {
            match found {
                Some(shifted) => drop(ledger.shifted.insert(unit.clone(), shifted)),
                None => drop(ledger.shifted.remove(unit)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::{super::file_name, *};

    fn azimuth(degrees: f64) -> TrackOffsets {
        TrackOffsets::NONE.plus(Offset::Azimuth(Angle::from_degrees(degrees))).unwrap()
    }

    fn pair(azimuth_deg: f64, elevation_deg: f64) -> TrackOffsets {
        let elevation = Offset::Elevation(Angle::from_degrees(elevation_deg));
        azimuth(azimuth_deg).plus(elevation).unwrap()
    }

    fn build(before: TrackOffsets, put: &[TrackOffsets]) -> ShiftedTrack {
        let start = Timestamp::UNIX_EPOCH;
        ShiftedTrack { start, before, put: put.to_vec(), track: None, is_found: false }
    }

    fn unit() -> Unit {
        Unit { make: "satrak".to_owned(), address: "10.0.0.5:4001".to_owned() }
    }

    #[test]
    fn what_was_written_outlives_the_program_until_it_is_taken_back() {
        let folder = tempfile::tempdir().unwrap();
        let debts = || Debts::marked_in(Some(folder.path().join("marks")));
        let track = Some(AddedTo { catalog_number: 25_544, end: Timestamp::UNIX_EPOCH });
        let shifted = ShiftedTrack { track, ..build(azimuth(-0.1), &[azimuth(0.1), azimuth(0.2)]) };
        let first = debts();
        first.set_shifted(&unit(), Some(shifted.clone()));
        assert_eq!(first.shifted_kept(&unit()), PromisedFile::OnDisk);
        let second = debts();
        let found = ShiftedTrack { is_found: true, ..shifted };
        assert_eq!(second.shifted(&unit()), Some(found.clone()));
        assert_eq!(second.with_offsets(), [unit()]);
        assert_eq!(found.added(azimuth(0.2)), Some(azimuth(0.3)));
        assert_eq!(found.added(azimuth(-0.1)), Some(TrackOffsets::NONE));
        assert_eq!(found.added(azimuth(0.5)), None, "somebody else's");
        for _ in 0..2 {
            second.set_shifted(&unit(), None);
        }
        assert_eq!(debts().shifted(&unit()), None);
    }

    #[test]
    fn each_component_is_taken_back_by_itself() {
        let shifted = build(pair(0.25, -0.1), &[pair(0.25, -0.1), pair(0.45, 0.0)]);
        // The unit has restored the azimuth but not yet the elevation.
        assert_eq!(shifted.added(pair(0.25, 0.0)), Some(pair(0.0, 0.1)));
        assert_eq!(shifted.clone().drop_foreign(pair(0.25, 0.0)), Some(shifted.clone()));
        // Somebody else has set the azimuth.
        assert_eq!(shifted.added(pair(0.7, 0.0)), None);
        let left = shifted.drop_foreign(pair(0.7, 0.0)).unwrap();
        assert_eq!(left.added(pair(0.7, 0.0)), Some(pair(0.0, 0.1)));
    }

    #[test]
    fn what_another_azel_has_recorded_or_taken_back_meanwhile_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let [here, other] = [(); 2].map(|()| Debts::marked_in(Some(folder.path().to_owned())));
        let shifted = |degrees| build(TrackOffsets::NONE, &[azimuth(degrees)]);
        other.set_shifted(&unit(), Some(shifted(0.1)));
        here.find_shifted(&unit());
        let found = ShiftedTrack { is_found: true, ..shifted(0.1) };
        assert_eq!(here.shifted(&unit()), Some(found));
        other.set_shifted(&unit(), None);
        here.find_shifted(&unit());
        assert_eq!(here.shifted(&unit()), None);
        here.set_shifted(&unit(), Some(shifted(0.2)));
        here.find_shifted(&unit());
        assert_eq!(here.shifted(&unit()), Some(shifted(0.2)), "it is about to be recorded");
    }

    #[test]
    fn a_record_that_cannot_be_read_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(file_name(&unit(), OFFSETS));
        fs::write(&path, "since = ").unwrap();
        assert_eq!(Debts::marked_in(Some(folder.path().to_owned())).shifted(&unit()), None);
        assert!(path.exists());
    }
}
