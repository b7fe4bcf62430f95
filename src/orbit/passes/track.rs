//! One satellite over one site: exact states, converted to the view from the site.

use std::cell::Cell;

use glam::DVec3;

use super::{
    compact::CompactPass,
    local_series::{Bend, EarthFixed, LocalSeries, LocalState},
    sighting::Sighting,
    window::Window,
};
use crate::{
    PropagationError, Propagator, State,
    astro::time,
    propagator::Resumable,
    simd::{Number, Vector},
};

/// Max time from its state for which a series is used, seconds.
pub(super) const LONGEST_STEP_S: f64 = 30.0;
/// Accuracy of AOS and LOS, seconds.
const TIME_TOLERANCE_S: f64 = 5e-4;
/// Accuracy of the greatest elevation, radians, and of its time, seconds.
const CREST_TOLERANCE: f64 = 3e-7;
const CREST_TIME_TOLERANCE_S: f64 = 8e-3;
/// Distance of the second state, seconds. It is used if one state does not show the speed well
/// enough.
const MENDING_STEP_S: f64 = 15.0;

/// Limits of the accuracy of a series made from a state.
#[derive(Default)]
pub(super) struct Exactness<N = f64> {
    /// Max difference between SGP4's velocity and the rate of change of its position.
    pub(super) drift_km_s: N,
}

impl<N: Number> Exactness<N> {
    /// Tests whether an extreme is exact enough, `tau` seconds from the state of its series.
    #[inline(always)]
    pub(super) fn is_crest(&self, tau: N, place: &LocalState<N>) -> N::Answer {
        let (tau, range_km) = (tau.abs(), place.range_km);
        tau.is_less(N::splat(LONGEST_STEP_S))
            & (tau * self.drift_km_s).is_less(range_km * CREST_TOLERANCE)
            & self.drift_km_s.is_less(place.height.curve.abs() * range_km * CREST_TIME_TOLERANCE_S)
    }

    /// Tests whether a place is an exact enough crossing of `sine`, `tau` seconds from the state of
    /// its series.
    #[inline(always)]
    pub(super) fn is_crossing(&self, sine: f64, tau: N, place: &LocalState<N>) -> N::Answer {
        let tau = tau.abs();
        let rise_km_s = place.height.rate.abs() * place.range_km;
        tau.is_less(N::splat(LONGEST_STEP_S))
            & place.crosses(sine)
            & ((tau * self.drift_km_s).is_less(rise_km_s * TIME_TOLERANCE_S)
                | tau.is_less(N::splat(TIME_TOLERANCE_S)))
    }
}

/// A satellite as seen from the site of a window.
pub(super) struct Track<'a> {
    pub(super) window: &'a Window,
    /// Index among the satellites of the search.
    pub(super) satellite: u32,
    pub(super) propagator: &'a Propagator,
    /// Time from the epoch of the elements to the start of the window.
    pub(super) start_since_epoch_s: f64,
    pub(super) exactness: Exactness,
    resumable: Cell<Resumable>,
    propagations: Cell<u64>,
}

impl<'a> Track<'a> {
    pub(super) fn new(window: &'a Window, satellite: u32, propagator: &'a Propagator) -> Self {
        let start_since_epoch_s = time::seconds_between(propagator.epoch(), window.start);
        Self {
            window,
            satellite,
            propagator,
            start_since_epoch_s,
            exactness: Exactness {
                // The drift changes over the window, so its worse end counts.
                drift_km_s: f64::max(
                    propagator.drift_km_s(start_since_epoch_s),
                    propagator.drift_km_s(start_since_epoch_s + window.length_s),
                ),
            },
            resumable: Cell::new(propagator.resumable()),
            propagations: Cell::new(0),
        }
    }

    /// Returns the number of computed states.
    pub(super) fn propagations(&self) -> u64 {
        self.propagations.get()
    }

    /// Adds to the number of computed states.
    pub(super) fn count(&self, states: usize) {
        self.propagations.set(self.propagations.get() + states as u64);
    }

    /// Returns the series around an exact state; `None` if there is no state.
    pub(super) fn series(&self, at_s: f64) -> Option<LocalSeries> {
        self.count(1);
        // SDP4 integrates from the last state, so near instants are much cheaper in a row.
        let mut resumable = self.resumable.take();
        let state = self.propagator.state_after(self.start_since_epoch_s + at_s, &mut resumable);
        self.resumable.set(resumable);
        Some(LocalSeries::new(self.window, at_s, self.earth_fixed(at_s, &state.ok()?)))
    }

    fn earth_fixed(&self, at_s: f64, teme: &State) -> EarthFixed {
        let (sin_turn, cos_turn) = self.window.sidereal_at(at_s).sin_cos();
        let fixed = |v: DVec3| {
            Vector::new(cos_turn * v.x + sin_turn * v.y, cos_turn * v.y - sin_turn * v.x, v.z)
        };
        EarthFixed {
            // The velocity stays inertial and only gets new axes; the series adds the rotation.
            position_km: fixed(teme.position_km),
            velocity_km_s: fixed(teme.velocity_km_s),
        }
    }

    /// Returns `true` if the object has decayed by `at_s`, after its epoch. SGP4 continues below
    /// the ground and may bring the object up again.
    pub(super) fn has_decayed_at(&self, at_s: f64) -> bool {
        let since_epoch_s = self.start_since_epoch_s + at_s;
        let state = self.propagator.state_after(since_epoch_s, &mut Resumable::default());
        since_epoch_s > 0.0 && state == Err(PropagationError::Decayed)
    }

    /// Returns the place of the satellite at `at_s`.
    pub(super) fn place(&self, at_s: f64) -> Option<LocalState> {
        Some(self.series(at_s)?.place(0.0))
    }

    /// Returns the greatest or least height near `guess_s`, and the series from which it was taken.
    /// Newton's method takes a new state if the last state is too far away, and the speed of two
    /// states if one is not exact enough. Returns `None` if the method does not converge within
    /// `max_s` of the guess.
    pub(super) fn extreme(
        &self,
        guess_s: f64,
        max_s: f64,
        bend: Bend,
    ) -> Option<(LocalSeries, LocalState)> {
        self.extreme_from(self.series(guess_s)?, max_s, bend)
    }

    /// Returns the same as [`Self::extreme`], from an existing series.
    pub(super) fn extreme_from(
        &self,
        series: LocalSeries,
        max_s: f64,
        bend: Bend,
    ) -> Option<(LocalSeries, LocalState)> {
        let guess_s = series.at_s;
        let (mut series, mut is_mended) = (series, false);
        for _ in 0..8 {
            let place = series.extreme(bend, max_s)?;
            if (place.at_s - guess_s).abs() > max_s {
                return None;
            }
            let tau = (place.at_s - series.at_s).abs();
            let is_exact = self.exactness.is_crest(tau, &place);
            // A mended series is as good as two states allow.
            if is_exact || (is_mended && tau <= 2.0 * LONGEST_STEP_S) {
                return Some((series, place));
            }
            // Beyond this time, the neglected terms of the series matter.
            if tau > LONGEST_STEP_S {
                series = self.series(place.at_s)?;
            } else {
                is_mended = true;
            }
            if is_mended {
                series = self.mended(&series)?;
            }
        }
        None
    }

    /// Returns the extreme within `max_s` of the guess, by halving; `None` if the height does not
    /// turn there. It serves satellites so close, or with a height so constant, that Newton's
    /// method does not converge. The rate comes from exact places. SGP4's velocity lacks the pull
    /// of Sun and Moon, which alone moves some geosynchronous satellites.
    pub(super) fn extreme_by_halves(
        &self,
        guess_s: f64,
        max_s: f64,
        bend: Bend,
    ) -> Option<LocalState> {
        let sine = |at_s: f64| Some(self.place(at_s)?.height.sine);
        let rises = |at_s: f64| {
            // The height itself is flat at its crest, but its difference has a sign.
            let beside_s = 0.5 * CREST_TIME_TOLERANCE_S;
            Some((sine(at_s + beside_s)? > sine(at_s - beside_s)?) == (bend == Bend::Crest))
        };
        let (mut before_s, mut after_s) = (guess_s - max_s, guess_s + max_s);
        if !rises(before_s)? || rises(after_s)? {
            return None;
        }
        while after_s - before_s > CREST_TIME_TOLERANCE_S {
            let middle_s = f64::midpoint(before_s, after_s);
            if rises(middle_s)? {
                before_s = middle_s;
            } else {
                after_s = middle_s;
            }
        }
        self.place(f64::midpoint(before_s, after_s))
    }

    /// Returns the same series, with the speed that follows from a second state.
    fn mended(&self, series: &LocalSeries) -> Option<LocalSeries> {
        Some(series.mended(&self.series(series.at_s + MENDING_STEP_S)?))
    }

    /// Returns the crossing of the horizon between `below_s`, with a lower height, and `above_s`,
    /// with a greater height. The search starts from `guess_s` in between. Returns `None` only
    /// without states.
    pub(super) fn crossing(&self, below_s: f64, guess_s: f64, above_s: f64) -> Option<LocalState> {
        let sine = self.window.sin_aos_elevation;
        let (mut below_s, mut above_s) = (below_s, above_s);
        let mut at_s = guess_s;
        for round in 0.. {
            let width_s = (above_s - below_s).abs();
            let is_between = |at_s: f64| (at_s - below_s) * (at_s - above_s) < 0.0;
            // If the method does not converge, halving does.
            if round > 6 || !is_between(at_s) {
                at_s = f64::midpoint(below_s, above_s);
            }
            let series = self.series(at_s)?;
            let near = Some(series.crossing(sine, 0.0)).filter(|place| is_between(place.at_s));
            if let Some(place) = near
                && self.exactness.is_crossing(sine, place.at_s - at_s, &place)
            {
                return Some(place);
            }
            let here = series.place(0.0);
            if width_s < 1e-4 {
                return Some(here);
            }
            if here.height.sine < sine {
                below_s = at_s;
            } else {
                above_s = at_s;
            }
            at_s = near.map_or(below_s, |place| place.at_s);
        }
        None
    }

    /// Returns the part within the window of a pass that rises, culminates and sets at these
    /// places. Returns `None` without such a part, or if the part stays below the floor.
    pub(super) fn cut(
        &self,
        aos: &LocalState,
        crest: &LocalState,
        los: &LocalState,
    ) -> Option<CompactPass> {
        let length_s = self.window.length_s;
        if los.at_s <= 0.0 || aos.at_s >= length_s {
            return None;
        }
        let cuts = [aos.at_s < 0.0, los.at_s > length_s];
        let aos = if cuts[0] { &self.place(0.0)? } else { aos };
        let los = if cuts[1] { &self.place(length_s)? } else { los };
        let crest = match crest.at_s {
            at_s if at_s < 0.0 => aos,
            at_s if at_s > length_s => los,
            _ => crest,
        };
        (crest.height.sine >= self.window.sin_floor)
            .then(|| self.pass([aos, crest, los].map(Sighting::new).each_ref(), cuts))
    }

    pub(super) fn pass(
        &self,
        [aos, tca, los]: [&Sighting; 3],
        [starts_before, ends_after]: [bool; 2],
    ) -> CompactPass {
        let satellite = self.satellite;
        let [aos, tca, los] = [aos, tca, los].map(|sighting| self.window.point(sighting));
        CompactPass { satellite, starts_before, ends_after, aos, tca, los }
    }
}
