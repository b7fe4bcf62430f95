//! Offsets during a tracked pass.

use glam::DQuat;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::MeasuredPosition;
use crate::{
    astro::{AzEl, Site, TrackOffsets},
    device::Pointing,
    orbit::Propagator,
};

/// Offsets of a pass, each with its start time, the oldest first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FlownOffsets(Vec<(Timestamp, TrackOffsets)>);

impl FlownOffsets {
    /// Records the current offsets at `now`.
    pub fn note(&mut self, now: Timestamp, offsets: TrackOffsets) {
        if self.offsets_at(now) != offsets {
            self.0.push((now, offsets));
        }
    }

    /// Returns the changes of the offsets, each with its start time, the oldest first.
    pub fn changes(&self) -> &[(Timestamp, TrackOffsets)] {
        &self.0
    }

    fn offsets_at(&self, time: Timestamp) -> TrackOffsets {
        let before = self.0.iter().take_while(|(start, _)| *start <= time);
        before.last().map_or(TrackOffsets::NONE, |(_, offsets)| *offsets)
    }

    /// Returns the position that the antenna would have measured without offsets. Its distance and
    /// direction from the satellite equal those between the measured and the desired direction.
    #[must_use]
    pub fn taken_off(
        &self,
        propagator: &Propagator,
        site: Site,
        flown: MeasuredPosition,
    ) -> MeasuredPosition {
        let pointing = self.turned_back(propagator, site, flown);
        MeasuredPosition { pointing: pointing.unwrap_or(flown.pointing), ..flown }
    }

    /// Returns the corrected pointing; `None` without offsets to remove.
    fn turned_back(
        &self,
        propagator: &Propagator,
        site: Site,
        MeasuredPosition { time, pointing }: MeasuredPosition,
    ) -> Option<Pointing> {
        let offsets = Some(self.offsets_at(time)).filter(|offsets| !offsets.is_none())?;
        let satellite = |utc| Some(propagator.look_from(site, utc).ok()?.direction);
        let demanded = offsets.demanded(time, satellite)?;
        let back = DQuat::from_rotation_arc(demanded.to_enu(), satellite(time)?.to_enu());
        let elevation = pointing.elevation.unwrap_or(demanded.elevation);
        let measured = AzEl { azimuth: pointing.azimuth?, elevation };
        let plain = AzEl::from_enu(back * measured.to_enu());
        let elevation = pointing.elevation.map(|_| plain.elevation);
        Some(Pointing { azimuth: Some(plain.azimuth), elevation })
    }
}
