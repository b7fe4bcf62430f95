//! Offsets that the operator has saved.

use serde::{Deserialize, Serialize};

use super::{AntennaId, Station};
use crate::astro::TrackOffsets;

/// Offsets with which tracks begin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct KeptOffsets {
    #[serde(flatten)]
    pub subject: OffsetsSubject,
    #[serde(flatten)]
    pub offsets: TrackOffsets,
}

/// Source of the error that the offsets correct.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OffsetsSubject {
    /// The elements of a satellite, by its catalog number: time, along and across.
    Satellite(u32),
    /// The mount of an antenna: azimuth and elevation.
    Antenna(AntennaId),
}

impl OffsetsSubject {
    /// Returns the part of `offsets` that corrects this source.
    #[must_use]
    pub fn part(self, offsets: TrackOffsets) -> TrackOffsets {
        match self {
            Self::Satellite(_) => offsets.on_the_sky(),
            Self::Antenna(_) => offsets.of_the_axes(),
        }
    }
}

impl Station {
    /// Returns the saved offsets of a satellite or an antenna.
    pub fn kept_offsets(&self, offsets_of: OffsetsSubject) -> TrackOffsets {
        let entry = self.offsets.iter().find(|kept_offsets| kept_offsets.subject == offsets_of);
        offsets_of.part(entry.map(|kept_offsets| kept_offsets.offsets).unwrap_or_default())
    }

    /// Returns the offsets with which an antenna begins a track.
    pub fn first_offsets(&self, antenna: AntennaId, satellite: Option<u32>) -> TrackOffsets {
        let of_satellite =
            satellite.map(|number| self.kept_offsets(OffsetsSubject::Satellite(number)));
        let of_antenna = self.kept_offsets(OffsetsSubject::Antenna(antenna));
        of_satellite.unwrap_or_default().with_axes_of(of_antenna)
    }

    /// Saves these offsets in place of earlier ones; removes the entry if they are zero.
    pub fn keep_offsets(&mut self, offsets_of: OffsetsSubject, offsets: TrackOffsets) {
        self.offsets.retain(|kept_offsets| kept_offsets.subject != offsets_of);
        let offsets = offsets_of.part(offsets);
        self.offsets
            .extend((!offsets.is_none()).then_some(KeptOffsets { subject: offsets_of, offsets }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::{Angle, Offset};

    #[test]
    fn a_track_begins_with_those_of_its_satellite_and_of_its_antenna() {
        let deg = Angle::from_degrees;
        let offsets = |steps: &[Offset]| {
            steps.iter().copied().try_fold(TrackOffsets::NONE, TrackOffsets::plus).unwrap()
        };
        let all = offsets(&[Offset::Along(deg(0.1)), Offset::Elevation(deg(0.2))]);
        let mut station = Station::default();
        let (antenna, other) = (AntennaId(1), AntennaId(2));
        station.keep_offsets(OffsetsSubject::Satellite(25_544), all);
        station.keep_offsets(OffsetsSubject::Antenna(antenna), all);
        assert_eq!(station.first_offsets(antenna, Some(25_544)), all, "not twice");
        let along = offsets(&[Offset::Along(deg(0.1))]);
        assert_eq!(station.first_offsets(other, Some(25_544)), along);
        let elevation = offsets(&[Offset::Elevation(deg(0.2))]);
        assert_eq!(station.first_offsets(antenna, None), elevation);
        station.keep_offsets(OffsetsSubject::Satellite(25_544), TrackOffsets::NONE);
        assert_eq!(station.offsets.len(), 1, "forgotten");
    }
}
