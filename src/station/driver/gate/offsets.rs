//! Judgement of the offsets of a program track.

use glam::DQuat;
use jiff::Timestamp;

use super::{Gate, rules};
use crate::{
    astro::{Angle, AzEl},
    clock::Moment,
    contract::driver::{Intent, Refusal},
    device::Motion,
    station::Mount,
};

/// Directions of a program track with some offsets at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::driver) struct Demand {
    pub(in crate::driver) time: Timestamp,
    /// Direction of the axes with all offsets.
    pub(in crate::driver) axes: AzEl,
    /// Direction on the sky, if the axis offsets and the pointing model correct errors of the
    /// mount.
    pub(in crate::driver) sky: AzEl,
    /// Direction of the axes with only the time offset.
    pub(in crate::driver) plain: AzEl,
}

impl Gate {
    /// Returns the rotation from the modelled beam direction of a tracking antenna to the true one
    /// on the sky, if axis offsets apply.
    pub(in crate::driver) fn to_sky(&self) -> Option<DQuat> {
        self.to_sky
    }

    /// Returns [`Self::to_sky`] for a motion with this intent: only a track has offsets.
    pub(super) fn to_sky_in(&self, intent: Intent) -> Option<DQuat> {
        self.to_sky.filter(|_| intent == Intent::Track)
    }

    /// Returns `true` if the antenna can point in this direction.
    pub(in crate::driver) fn reaches(&self, direction: AzEl, now: Moment) -> bool {
        let AzEl { azimuth, elevation } = direction;
        let motion = Motion::Position { azimuth: Some(azimuth), elevation: Some(elevation) };
        let situation = self.situation(Intent::Track, false, now);
        self.nearest(motion).is_ok_and(|motion| rules::within_reach(&motion, &situation).is_ok())
    }

    pub(in crate::driver) fn set_to_sky(&mut self, to_sky: Option<DQuat>) {
        self.to_sky = to_sky;
    }

    /// Checks the target of a program track with new offsets. A plan waits at the edge of the
    /// bounds, so an offset step across the edge must fail here.
    pub(in crate::driver) fn demand_is_clear(
        &self,
        demand: Demand,
        now: Moment,
    ) -> Result<(), Refusal> {
        let Demand { time, axes, sky, plain } = demand;
        // The demand contains both directions.
        let bounds = self.bounds_in(Intent::Track).at_time(time).without_model();
        for direction in [axes, sky] {
            if let Some(barrier) = bounds.forbids(direction) {
                return Err(Refusal::Forbidden { barrier, direction });
            }
        }
        let has_elevation = self.variant.capabilities.has_elevation();
        // A pass begins and ends below the minimum elevation of some antennas.
        let lowest_deg = self.limits.minimum_elevation_deg;
        let floor_deg = lowest_deg.min(plain.elevation_deg());
        if has_elevation && axes.elevation_deg() < floor_deg - 1e-9 {
            return Err(Refusal::Elevation { asked_deg: axes.elevation_deg(), lowest_deg });
        }
        let Mount::AzEl { elevation_from_deg, .. } = self.mount else {
            // The axes wait at the minimum elevation if a pass begins below it.
            let elevation = Angle::from_degrees(axes.elevation_deg().max(lowest_deg));
            let motion =
                Motion::Position { azimuth: Some(axes.azimuth), elevation: Some(elevation) };
            return rules::within_reach(&motion, &self.situation(Intent::Track, false, now));
        };
        let mount = self.mount.clipped(self.state().travel_deg);
        let wanted_deg = if has_elevation { axes.elevation_deg() } else { elevation_from_deg };
        let elevation = Angle::from_degrees(wanted_deg.max(lowest_deg).max(elevation_from_deg));
        if mount.reaches(AzEl { elevation, ..axes }) {
            return Ok(());
        }
        let asked_deg = [mount.axis_azimuth(axes.azimuth, None).degrees(), elevation.degrees()];
        let angles = asked_deg.into_iter().zip(mount.travel_deg());
        let mut angles = angles.zip(self.variant.capabilities.axes);
        let is_out = |((asked_deg, (from_deg, to_deg)), _): &((f64, (f64, f64)), _)| {
            !(*from_deg..=*to_deg).contains(asked_deg)
        };
        angles.find(is_out).map_or(Ok(()), |((asked_deg, (from_deg, to_deg)), axis)| {
            Err(Refusal::Travel { axis, asked_deg, from_deg, to_deg })
        })
    }
}
