//! A batch of satellites, each at an instant of its own, one per lane.

use super::NearCircular;
use crate::{
    passes::{
        local_series::{EarthFixed, LocalSeries},
        track::Exactness,
        window::Window,
    },
    propagator::Secular,
    simd::{LANES, Lanes},
};

#[derive(Clone, Copy)]
pub(super) struct SatelliteAt<'a> {
    pub(super) satellite: &'a NearCircular<'a>,
    pub(super) at_s: f64,
}

/// Up to [`LANES`] satellites, prepared for the computation.
#[derive(Default)]
pub(super) struct Batch {
    pub(super) secular: Secular<Lanes>,
    start_since_epoch_s: Lanes,
    pub(super) half_pass_s: Lanes,
    pub(super) exactness: Exactness<Lanes>,
}

impl Batch {
    /// Loads up to [`LANES`] satellites and returns their instants. The last satellite fills the
    /// remaining lanes.
    #[inline(always)]
    pub(super) fn take(&mut self, satellites: &[SatelliteAt<'_>]) -> Lanes {
        for (lane, SatelliteAt { satellite, .. }) in in_lanes(satellites) {
            self.secular.set(lane, satellite.secular);
            self.half_pass_s.set(lane, satellite.half_pass_s);
            self.exactness.drift_km_s.set(lane, satellite.track.exactness.drift_km_s);
        }
        self.instants(satellites)
    }

    /// Loads only the orbit planes.
    #[inline(always)]
    pub(super) fn take_planes(&mut self, satellites: &[SatelliteAt<'_>]) -> Lanes {
        for (lane, SatelliteAt { satellite, .. }) in in_lanes(satellites) {
            self.secular.plane.set(lane, &satellite.secular.plane);
        }
        self.instants(satellites)
    }

    #[inline(always)]
    fn instants(&mut self, satellites: &[SatelliteAt<'_>]) -> Lanes {
        let mut instants = Lanes::ZERO;
        for (lane, SatelliteAt { satellite, at_s }) in in_lanes(satellites) {
            self.start_since_epoch_s.set(lane, satellite.track.start_since_epoch_s);
            instants.set(lane, *at_s);
        }
        instants
    }

    /// Returns the minutes since the epochs.
    #[inline(always)]
    pub(super) fn minutes(&self, at_s: Lanes) -> Lanes {
        (at_s + self.start_since_epoch_s) * (1.0 / 60.0)
    }

    /// Returns the series around exact states. The caller
    /// [counts](crate::passes::track::Track::count) them.
    #[inline(always)]
    pub(super) fn series(&self, window: &Window, at_s: Lanes) -> LocalSeries<Lanes> {
        let turn = window.sidereal_at(at_s);
        let (position_km, velocity_km_s) = self.secular.motion(self.minutes(at_s), turn);
        LocalSeries::new(window, at_s, EarthFixed { position_km, velocity_km_s })
    }
}

fn in_lanes<'a, 'b>(
    satellites: &'a [SatelliteAt<'b>],
) -> impl Iterator<Item = (usize, &'a SatelliteAt<'b>)> {
    let rest = satellites.last().into_iter().cycle();
    satellites.iter().chain(rest).take(LANES).enumerate()
}
