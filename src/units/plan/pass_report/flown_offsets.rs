//! The offsets with which a pass was tracked.

use glam::DQuat;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::MeasuredPosition;
use crate::{
    astro::{AzEl, Site, TrackOffsets},
    device::Pointing,
    orbit::Propagator,
};

/// Offsets of a pass, each with the time from which it was on, the oldest first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FlownOffsets(Vec<(Timestamp, TrackOffsets)>);

impl FlownOffsets {
    /// Notes the offsets that are on at `now`.
    pub fn note(&mut self, now: Timestamp, offsets: TrackOffsets) {
        if self.offsets_at(now) != offsets {
            self.0.push((now, offsets));
        }
    }

    /// Each change.
    pub fn changes(&self) -> &[(Timestamp, TrackOffsets)] {
        &self.0
    }

    fn offsets_at(&self, time: Timestamp) -> TrackOffsets {
        let before = self.0.iter().take_while(|(start, _)| *start <= time);
        before.last().map_or(TrackOffsets::NONE, |(_, offsets)| *offsets)
    }

    /// A position as it would have been measured without offsets: as far from the satellite as it
    /// was from where the antenna should have pointed, and to the same side.
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

    /// `None` where there is nothing to take off.
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
