//! Several satellites at one instant each, one a lane.

use super::{
    circular::Circular,
    local_series::{EarthFixed, LocalSeries},
    track::Exactness,
    window::Window,
};
use crate::orbit::{
    lanes::{LANES, Lanes, set},
    propagator::Secular,
};

/// A satellite at an instant.
#[derive(Clone, Copy)]
pub(super) struct Occasion<'a> {
    pub(super) satellite: &'a Circular<'a>,
    pub(super) at_s: f64,
}

/// What is computed with of several satellites.
#[derive(Default)]
pub(super) struct Abreast {
    pub(super) secular: Secular<Lanes>,
    start_since_epoch_s: Lanes,
    pub(super) half_pass_s: Lanes,
    pub(super) exactness: Exactness<Lanes>,
}

impl Abreast {
    /// Takes the satellites of up to as many occasions as there are lanes, and
    /// gives the instants; the last one fills the rest.
    pub(super) fn take(&mut self, occasions: &[Occasion<'_>]) -> Lanes {
        for (lane, Occasion { satellite, .. }) in in_lanes(occasions) {
            self.secular.set(lane, satellite.secular);
            set(&mut self.half_pass_s, lane, satellite.half_pass_s);
            set(&mut self.exactness.drift_km_s, lane, satellite.track.exactness.drift_km_s);
        }
        self.instants(occasions)
    }

    /// The same, but only what tells where they fly in their planes.
    pub(super) fn take_planes(&mut self, occasions: &[Occasion<'_>]) -> Lanes {
        for (lane, Occasion { satellite, .. }) in in_lanes(occasions) {
            self.secular.plane.set(lane, &satellite.secular.plane);
        }
        self.instants(occasions)
    }

    fn instants(&mut self, occasions: &[Occasion<'_>]) -> Lanes {
        let mut instants = Lanes::ZERO;
        for (lane, Occasion { satellite, at_s }) in in_lanes(occasions) {
            set(&mut self.start_since_epoch_s, lane, satellite.track.start_since_epoch_s);
            set(&mut instants, lane, *at_s);
        }
        instants
    }

    /// Minutes since the epochs.
    pub(super) fn minutes(&self, at_s: Lanes) -> Lanes {
        (at_s + self.start_since_epoch_s) * (1.0 / 60.0)
    }

    /// The series around exact states. Whoever uses them
    /// [counts](super::track::Track::count) them.
    pub(super) fn series(&self, window: &Window, at_s: Lanes) -> LocalSeries<Lanes> {
        let turn = window.sidereal_at(at_s);
        let (position_km, velocity_km_s) = self.secular.motion(self.minutes(at_s), turn);
        LocalSeries::new(window, at_s, EarthFixed { position_km, velocity_km_s })
    }
}

fn in_lanes<'a, 'b>(
    occasions: &'a [Occasion<'b>],
) -> impl Iterator<Item = (usize, &'a Occasion<'b>)> {
    let rest = occasions.last().into_iter().cycle();
    occasions.iter().chain(rest).take(LANES).enumerate()
}
