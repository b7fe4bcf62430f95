//! SGP4 and SDP4: the state of a satellite at a time.

mod near_circular;
mod secular;
mod waves;

use std::{
    f64::consts::TAU,
    fmt,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicU32, Ordering},
    },
};

use glam::DVec3;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub(super) use self::secular::{Plane, Secular, expand};
use super::{
    Elements, OverGround,
    simd::{LANES, Lanes},
};
use crate::astro::time;

/// Equatorial radius in WGS72, the constants with which SGP4 is defined, in km.
pub(super) const WGS72_RADIUS_KM: f64 = 6_378.135;
/// Further than this from its epoch, a set says nothing, and the resonance integrator, which
/// advances in half days, would take seconds for a far century.
const FARTHEST_DAYS: f64 = 36_525.0;
/// SGP4's velocity is not quite the rate of change of its position. It neglects the drag and higher
/// powers of the flattening, which matter more for more eccentric orbits. Measured over the bundled
/// catalog, in km/s.
const DRIFT_KM_S: f64 = 3e-5;
const ECCENTRIC_DRIFT_KM_S: f64 = 0.01;

/// A state this many times as far from the Earth as the apogee at the epoch is none of the object:
/// far from the epoch, the polynomials of the drag lead to any distance. No state of SGP4's
/// verification is as far.
const MAX_GROWTH: f64 = 10.0;

/// A deep-space orbit decays within weeks only from a perigee below this height, in km.
const LOW_PERIGEE_KM: f64 = 120.0;
/// The first missing state is searched for in these steps, a sixteenth of a low revolution, and
/// over ten weeks: a near-earth orbit that touches the atmosphere decays in days.
const DOWN_STEP_MIN: f64 = 5.0;
const MAX_DOWN_LOOKS: u32 = 20_000;
/// The place from which an integration is resumed stays where it is for a state up to this much
/// later, so that whoever asks for an earlier one need not begin at the epoch: twenty steps.
const RESUMED_MIN: f64 = 14_400.0;

/// From this mean motion on, Sun and Moon are left out of the orbit: periods below 225 minutes.
const CLOSE_REV_DAY: f64 = 6.5;
/// Orbits rounder than [`SMALL_ECCENTRICITY`] with a perigee above this height stay above the ground
/// in all waves of the gravity field, which move them by some 15 km.
const HIGH_PERIGEE_KM: f64 = 100.0;
const SMALL_ECCENTRICITY: f64 = 0.05;

/// Position and velocity of a satellite in TEME.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// From the centre of the Earth, km.
    pub position_km: DVec3,
    /// Inertial, km/s.
    pub velocity_km_s: DVec3,
}

/// The reason why there is no state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum PropagationError {
    /// SGP4 cannot start from these elements.
    #[error("the elements describe no orbit")]
    Elements,
    /// The orbit has met the ground, or SGP4 has no solution any more.
    #[error("the object has decayed")]
    Decayed,
    /// More than a century, or so far that SGP4 leads away from the Earth.
    #[error("the time is too far from the epoch of the elements")]
    TooFarFromEpoch,
}

/// Computes states of one satellite; can be shared between threads.
#[derive(Debug, Clone)]
pub struct Propagator {
    constants: sgp4::Constants,
    epoch: Timestamp,
    secular: Option<Secular>,
    drift_km_s: f64,
    /// The orbit may have met the ground from this time on, minutes after the epoch.
    low_after_min: f64,
    /// Maximum distance from the centre of the Earth, km.
    farthest_km: f64,
    descent: Descent,
    resonance: Resonance,
}

/// How far it is known that an orbit that may have met the ground has not: the number of looks, in
/// steps of [`DOWN_STEP_MIN`] from `low_after_min` on, that have found a state. They go as far as
/// somebody has asked.
#[derive(Debug, Default)]
struct Descent(AtomicU32);

impl Clone for Descent {
    fn clone(&self) -> Self {
        Self(self.0.load(Ordering::Relaxed).into())
    }
}

/// How far the integration of a resonant orbit has come, so that the next state need not start from
/// the epoch. Other orbits leave it untouched.
#[derive(Clone, Copy, Default)]
pub(super) struct Resumable(Option<sgp4::ResonanceState>);

impl fmt::Debug for Resumable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Resumable").field(&self.0.map(|state| state.t())).finish()
    }
}

/// Where the integration of a resonant orbit is resumed from: near the times that are asked for. Its
/// steps are the same from wherever it is resumed, and so are the states.
#[derive(Debug, Default)]
struct Resonance(Mutex<Resumable>);

impl Clone for Resonance {
    fn clone(&self) -> Self {
        Self(Mutex::new(self.get()))
    }
}

impl Resonance {
    fn get(&self) -> Resumable {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn reach(&self, reached: Resumable) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_near = kept.ahead_min(reached).is_some_and(|min| (0.0..=RESUMED_MIN).contains(&min));
        if !is_near {
            *kept = reached;
        }
    }
}

impl Resumable {
    /// How much further from the epoch `later` is, in minutes; `None` if it is on the other side.
    fn ahead_min(self, later: Self) -> Option<f64> {
        let (from_min, to_min) = (self.0?.t(), later.0?.t());
        (from_min * to_min >= 0.0).then_some(to_min.abs() - from_min.abs())
    }
}

impl Propagator {
    /// Prepares the propagation of `elements` with WGS72 and AFSPC sidereal time, with which the
    /// elements were fitted.
    pub fn new(elements: &Elements) -> Result<Self, PropagationError> {
        let numbers = elements.sgp4();
        let (orbit, constants) = start(&numbers)?;
        let secular = Secular::new(&orbit, numbers.drag_term);
        let eccentricity = elements.eccentricity();
        let drift_km_s = DRIFT_KM_S + ECCENTRIC_DRIFT_KM_S * eccentricity;
        let low_after_min = match &secular {
            Some(secular) => secular.low_after_min(),
            // Drag brings such an orbit down only if its perigee is in the atmosphere.
            None if lowest_km(&numbers) < LOW_PERIGEE_KM => 0.0,
            None => f64::INFINITY,
        };
        let (epoch, descent) = (elements.epoch(), Descent::default());
        let resonance = Resonance::default();
        Ok(Self {
            constants,
            epoch,
            secular,
            drift_km_s,
            low_after_min,
            farthest_km: MAX_GROWTH * axis_km(&numbers) * (1.0 + numbers.eccentricity),
            descent,
            resonance,
        })
    }

    /// Whether SGP4 finds the object above the ground at the epoch of `elements`.
    pub(super) fn is_up_at_epoch(elements: &Elements) -> bool {
        let numbers = elements.sgp4();
        if is_surely_up_at_epoch(&numbers) {
            return true;
        }
        let state = start(&numbers)
            .and_then(|(_, constants)| sgp4_state(&constants, 0.0, &mut Resumable::default()));
        state.is_ok()
    }

    /// The state at `at`, in TEME.
    pub fn state_at(&self, at: Timestamp) -> Result<State, PropagationError> {
        let mut resumable = self.resumable();
        let state = self.state_after(time::seconds_between(self.epoch, at), &mut resumable);
        if self.secular.is_none() {
            self.resonance.reach(resumable);
        }
        state
    }

    /// Where the integration for a series of states is resumed.
    pub(super) fn resumable(&self) -> Resumable {
        if self.secular.is_some() { Resumable::default() } else { self.resonance.get() }
    }

    /// The states at several times, each later than the one before. Those of near-circular orbits
    /// are computed eight at once, within 2e-8 km of [`Self::state_at`].
    pub fn states_at(&self, times: &[Timestamp]) -> Vec<Option<State>> {
        let is_round = |at: &Timestamp| self.near_circular_at(*at).is_some();
        let ends = times.first().into_iter().chain(times.last());
        match self.secular().filter(|_| ends.clone().all(is_round)) {
            Some(secular) => {
                let minutes = |at: &Timestamp| time::seconds_between(self.epoch, *at) / 60.0;
                let minutes: Vec<f64> = times.iter().map(minutes).collect();
                secular.states(&minutes).map(Some).collect()
            }
            None => times.iter().map(|at| self.state_at(*at).ok()).collect(),
        }
    }

    /// The places of several satellites, each at a time of its own. Those of near-circular orbits
    /// are computed eight at once, within 2e-8 km of [`Self::state_at`].
    pub fn over_ground(wanted: &[(&Self, Timestamp)]) -> Vec<Option<OverGround>> {
        let mut places = vec![None; wanted.len()];
        let mut near_circular = Vec::with_capacity(wanted.len());
        for ((propagator, at), place) in wanted.iter().zip(&mut places) {
            match propagator.near_circular_at(*at) {
                Some((secular, minutes)) => near_circular.push((secular, minutes, *at, place)),
                None => *place = propagator.state_at(*at).ok().map(|state| state.over_ground(*at)),
            }
        }
        let mut lanes = Secular::default();
        for chunk in near_circular.chunks_mut(LANES) {
            let (mut minutes, mut turn) = (Lanes::ZERO, Lanes::ZERO);
            for (lane, (secular, at_min, at, _)) in chunk.iter().enumerate() {
                lanes.set(lane, secular);
                minutes.set(lane, *at_min);
                turn.set(lane, time::gmst(*at).radians());
            }
            for ((.., place), of_lane) in chunk.iter_mut().zip(lanes.motions(minutes, turn)) {
                let (position_km, velocity_km_s) = of_lane;
                **place = Some(OverGround::of_inertial(position_km, velocity_km_s));
            }
        }
        places
    }

    /// The long-term motion, and the minutes since the epoch, if the orbit is near-circular at `at`.
    fn near_circular_at(&self, at: Timestamp) -> Option<(&Secular, f64)> {
        let since_epoch_s = time::seconds_between(self.epoch, at);
        let minutes = since_epoch_s / 60.0;
        let secular = self.secular().filter(|secular| secular.is_near_circular_at(minutes))?;
        let is_known = since_epoch_s.abs() <= FARTHEST_DAYS * time::DAY_S;
        (is_known && !self.may_be_down_at(since_epoch_s)).then_some((secular, minutes))
    }

    /// The instant that [`Self::state_after`] counts from.
    pub(super) fn epoch(&self) -> Timestamp {
        self.epoch
    }

    /// The long-term motion of the orbit; `None` for deep space.
    pub(super) fn secular(&self) -> Option<&Secular> {
        self.secular.as_ref()
    }

    /// How far the velocities may differ from the rate of change of the positions, `since_epoch_s`
    /// seconds after the epoch.
    pub(super) fn drift_km_s(&self, since_epoch_s: f64) -> f64 {
        let drag = |secular: &Secular| secular.drag_drift_km_s(since_epoch_s / 60.0);
        self.drift_km_s + self.secular.as_ref().map_or(0.0, drag)
    }

    /// The state `since_epoch_s` seconds after the epoch, in TEME. A series of calls with one
    /// `resumable` is fast if it leads away from the epoch, and correct in any order.
    pub(super) fn state_after(
        &self,
        since_epoch_s: f64,
        resumable: &mut Resumable,
    ) -> Result<State, PropagationError> {
        if since_epoch_s.abs() > FARTHEST_DAYS * time::DAY_S {
            return Err(PropagationError::TooFarFromEpoch);
        }
        let since_epoch_min = since_epoch_s / 60.0;
        if self.may_be_down_at(since_epoch_s) && self.is_down_at(since_epoch_min) {
            return Err(PropagationError::Decayed);
        }
        let state = sgp4_state(&self.constants, since_epoch_min, resumable)?;
        // Written so that NaN is refused too.
        if state.position_km.length() <= self.farthest_km {
            Ok(state)
        } else {
            Err(PropagationError::TooFarFromEpoch)
        }
    }

    /// Returns `true` if the orbit may have met the ground by this time.
    pub(super) fn may_be_down_at(&self, since_epoch_s: f64) -> bool {
        since_epoch_s > self.low_after_min * 60.0
    }

    /// Whether SGP4 has brought the object down by then. Later, its equations continue below the
    /// ground and may bring the object up again.
    fn is_down_at(&self, since_epoch_min: f64) -> bool {
        let at_min = |look: u32| self.low_after_min + f64::from(look) * DOWN_STEP_MIN;
        let Descent(looked) = &self.descent;
        let mut resumable = Resumable::default();
        (looked.load(Ordering::Relaxed) + 1..=MAX_DOWN_LOOKS)
            .take_while(|look| at_min(*look) <= since_epoch_min)
            .any(|look| {
                let is_down = sgp4_state(&self.constants, at_min(look), &mut resumable).is_err();
                if !is_down {
                    looked.fetch_max(look, Ordering::Relaxed);
                }
                is_down
            })
    }
}

/// What SGP4 works out once for an orbit.
fn start(numbers: &sgp4::Elements) -> Result<(sgp4::Orbit, sgp4::Constants), PropagationError> {
    let orbit = sgp4::Orbit::from_kozai_elements(
        &sgp4::WGS72,
        numbers.inclination.to_radians(),
        numbers.right_ascension.to_radians(),
        numbers.eccentricity,
        numbers.argument_of_perigee.to_radians(),
        numbers.mean_anomaly.to_radians(),
        numbers.mean_motion * (TAU / 1440.0),
    )
    .map_err(|_| PropagationError::Elements)?;
    let constants = sgp4::Constants::new(
        sgp4::WGS72,
        sgp4::afspc_epoch_to_sidereal_time,
        numbers.epoch_afspc_compatibility_mode(),
        numbers.drag_term,
        orbit.clone(),
    )
    .map_err(|_| PropagationError::Elements)?;
    Ok((orbit, constants))
}

/// The state by SGP4, whether or not the object has decayed before.
fn sgp4_state(
    constants: &sgp4::Constants,
    since_epoch_min: f64,
    resumable: &mut Resumable,
) -> Result<State, PropagationError> {
    // The library ends the program when the time goes back towards or across the epoch.
    let resumed = resumable.0.take().filter(|state| {
        let reached_min = state.t();
        reached_min * since_epoch_min > 0.0 && since_epoch_min.abs() >= reached_min.abs()
    });
    resumable.0 = resumed.or_else(|| constants.initial_state());
    let at = sgp4::MinutesSinceEpoch(since_epoch_min);
    let prediction = constants
        .propagate_from_state(at, resumable.0.as_mut(), false)
        .map_err(|_| PropagationError::Decayed)?;
    let position_km = DVec3::from_array(prediction.position);
    let velocity_km_s = DVec3::from_array(prediction.velocity);
    let above_ground = position_km.length_squared() >= WGS72_RADIUS_KM * WGS72_RADIUS_KM;
    if above_ground && position_km.is_finite() && velocity_km_s.is_finite() {
        Ok(State { position_km, velocity_km_s })
    } else {
        Err(PropagationError::Decayed)
    }
}

/// Whether no more than the perigee is needed to know that the object is above the ground at its
/// epoch, as for nearly all of a catalogue. The drag has no effect there yet.
fn is_surely_up_at_epoch(elements: &sgp4::Elements) -> bool {
    elements.mean_motion > CLOSE_REV_DAY
        && elements.eccentricity < SMALL_ECCENTRICITY
        && lowest_km(elements) > HIGH_PERIGEE_KM
}

/// Semi-major axis at the epoch.
fn axis_km(elements: &sgp4::Elements) -> f64 {
    let rate_rad_min = elements.mean_motion * (TAU / 1440.0);
    (sgp4::WGS72.ke / rate_rad_min).powf(2.0 / 3.0) * WGS72_RADIUS_KM
}

/// Height of the perigee at the epoch.
fn lowest_km(elements: &sgp4::Elements) -> f64 {
    axis_km(elements) * (1.0 - elements.eccentricity) - WGS72_RADIUS_KM
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::bundled;

    #[test]
    fn any_time_gives_a_state_or_a_reason() {
        let catalog = bundled().unwrap();
        // Orbits that are low, of half a day, geosynchronous, and far and eccentric.
        let propagators: Vec<Propagator> = [25_544, 24_876, 54_743, 25_867]
            .map(|number| Propagator::new(catalog.get(number).unwrap()).unwrap())
            .into();
        let times = Timestamp::MIN.as_second()..Timestamp::MAX.as_second();
        proptest!(|(second in times, near_s in -4e9..4e9_f64)| {
            for propagator in &propagators {
                let far = Timestamp::from_second(second).unwrap();
                let near = time::add_seconds(propagator.epoch, near_s);
                for at in [far, near, Timestamp::MIN, Timestamp::MAX] {
                    if let Ok(state) = propagator.state_at(at) {
                        prop_assert!(state.position_km.length() >= WGS72_RADIUS_KM);
                    }
                }
            }
        });
        for propagator in &propagators {
            assert_eq!(propagator.state_at(Timestamp::MAX), Err(PropagationError::TooFarFromEpoch));
        }
    }

    #[test]
    fn far_from_its_epoch_no_object_is_away_from_the_earth() {
        let catalog = bundled().unwrap();
        let (mut known, mut refused) = (0, 0);
        for elements in catalog.iter().step_by(29) {
            let Ok(propagator) = Propagator::new(elements) else { continue };
            let apogee_km = elements.heights().apogee_km + 6378.0;
            for years in [-90.0, -40.0, -20.0, -10.0, -3.0, -0.1, 0.1, 3.0, 10.0, 40.0, 90.0] {
                let at = time::add_seconds(elements.epoch(), years * 365.25 * time::DAY_S);
                let one = propagator.state_at(at);
                refused += u32::from(one == Err(PropagationError::TooFarFromEpoch));
                for state in [one.ok(), propagator.states_at(&[at])[0]].into_iter().flatten() {
                    known += 1;
                    let times = state.position_km.length() / apogee_km;
                    assert!(times < 10.5, "{} at {years} years: {times}", elements.name());
                }
            }
        }
        assert!(known > 5_000 && refused > 100, "{known} {refused}");
    }

    #[test]
    fn what_is_surely_up_has_a_state_at_its_epoch() {
        let known = bundled().unwrap().get(25_544).unwrap().sgp4();
        let taken = std::cell::Cell::new(0);
        let angles = (0.0..=180.0_f64, 0.0..360.0_f64, 0.0..360.0_f64, 0.0..360.0_f64);
        let sizes = (CLOSE_REV_DAY..17.5, 0.0..SMALL_ECCENTRICITY, -10.0..10.0_f64);
        proptest!(ProptestConfig::with_cases(20_000), |(angles in angles, sizes in sizes)| {
            let (inclination, right_ascension, argument_of_perigee, mean_anomaly) = angles;
            let (mean_motion, eccentricity, drag_term) = sizes;
            let numbers = sgp4::Elements {
                inclination, right_ascension, argument_of_perigee, mean_anomaly, mean_motion,
                eccentricity, drag_term, ..known.clone()
            };
            if is_surely_up_at_epoch(&numbers) {
                let (_, constants) = start(&numbers).unwrap();
                prop_assert!(sgp4_state(&constants, 0.0, &mut Resumable::default()).is_ok());
                taken.set(taken.get() + 1);
            }
        });
        assert!(taken.get() > 10_000, "{}", taken.get());
        let all = bundled().unwrap();
        let surely = all.iter().filter(|elements| is_surely_up_at_epoch(&elements.sgp4())).count();
        assert!(surely * 10 > all.len() * 8, "{surely} of {}", all.len());
    }

    #[test]
    fn velocities_drift_from_the_change_of_positions_as_fast_as_is_said() {
        for elements in bundled().unwrap().iter() {
            let propagator = Propagator::new(elements).unwrap();
            let Some(secular) = propagator.secular() else { continue };
            for hour in [1.0, 37.3, 101.7, 160.1] {
                let at_s = hour * 3600.0;
                if !secular.is_near_circular_at(at_s / 60.0) {
                    continue;
                }
                let state = |offset_s: f64| {
                    propagator.state_after(at_s + offset_s, &mut Resumable::default()).unwrap()
                };
                let moved_km = state(0.5).position_km - state(-0.5).position_km;
                let drift_km_s = (moved_km - state(0.0).velocity_km_s).length();
                let said_km_s = propagator.drift_km_s(at_s);
                // One set in five hundred drifts faster than `said_km_s`.
                assert!(drift_km_s < 2.5 * said_km_s, "{elements:?}: {drift_km_s} {said_km_s}");
            }
        }
    }

    #[test]
    fn states_of_a_resonant_orbit_do_not_depend_on_what_was_asked_before() {
        let catalog = bundled().unwrap();
        let numbers = [24_876, 54_743, 44_334, 25_867];
        let days = proptest::collection::vec(-400.0..400.0_f64, 1..30);
        proptest!(|(days in days, number in 0..numbers.len())| {
            let elements = catalog.get(numbers[number]).unwrap();
            let asked = Propagator::new(elements).unwrap();
            for day in days {
                let at = time::add_seconds(asked.epoch, day * time::DAY_S);
                let fresh = Propagator::new(elements).unwrap();
                prop_assert_eq!(asked.state_at(at), fresh.state_at(at), "{}", day);
            }
        });
    }

    #[test]
    fn an_integration_is_resumed_near_what_is_asked_for() {
        let elements = bundled().unwrap().get(44_334).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let resumed_after = |day: f64| {
            propagator.state_at(time::add_seconds(propagator.epoch, day * time::DAY_S)).unwrap();
            propagator.resonance.get().0.unwrap().t() as i32 / 720
        };
        let halves =
            [(100.2, 200), (107.0, 200), (101.0, 200), (130.0, 260), (99.7, 199), (-3.2, -6)];
        for (day, half_days) in halves {
            assert_eq!(resumed_after(day), half_days, "{day}");
        }
    }

    #[test]
    fn several_states_are_those_of_each_time() {
        // Low, and about to come down; of half a day, geosynchronous, and far and eccentric.
        for number in [25_544, 43_881, 24_876, 54_743, 25_867] {
            let catalog = bundled().unwrap();
            let propagator = Propagator::new(catalog.get(number).unwrap()).unwrap();
            for (days, count) in [(-2.0, 1), (0.0, 8), (1.5, 13), (60.0, 3), (40_000.0, 2)] {
                let at = |step: u32| {
                    let seconds = days * time::DAY_S + f64::from(step) * 500.0;
                    time::add_seconds(propagator.epoch, seconds)
                };
                let times: Vec<Timestamp> = (0..count).map(at).collect();
                let several = propagator.states_at(&times);
                assert_eq!(several.len(), times.len());
                for (at, several) in times.iter().zip(several) {
                    let one = propagator.state_at(*at).ok();
                    assert_eq!(several.is_some(), one.is_some(), "{number} {at}");
                    let off_km = several.zip(one).map(|(a, b)| a.position_km - b.position_km);
                    assert!(off_km.is_none_or(|off| off.length() < 2e-8), "{number} {at}");
                }
            }
        }
    }

    #[test]
    fn an_orbit_starts_as_the_library_starts_it() {
        for elements in bundled().unwrap().iter() {
            let numbers = elements.sgp4();
            let (_, constants) = start(&numbers).unwrap();
            let theirs = sgp4::Constants::from_elements_afspc_compatibility_mode(&numbers);
            assert_eq!(constants, theirs.unwrap());
        }
    }

    #[test]
    fn places_of_several_satellites_are_those_of_each() {
        let catalog = bundled().unwrap();
        let propagators: Vec<Propagator> = [25_544, 43_881, 24_876, 54_743, 25_867]
            .into_iter()
            .chain(catalog.iter().map(Elements::catalog_number).step_by(1000))
            .map(|number| Propagator::new(catalog.get(number).unwrap()).unwrap())
            .collect();
        let near = propagators.iter().zip(0..).map(|(propagator, hour)| {
            (propagator, time::add_seconds(propagator.epoch, 5000.0 * f64::from(hour)))
        });
        let wanted: Vec<_> = near.chain([(&propagators[0], Timestamp::MAX)]).collect();
        let places = Propagator::over_ground(&wanted);
        assert_eq!(places.len(), wanted.len());
        for ((propagator, at), found) in wanted.into_iter().zip(places) {
            let one = propagator.state_at(at).ok().map(|state| state.over_ground(at));
            assert_eq!(found.is_some(), one.is_some(), "{at}");
            let Some((found, one)) = found.zip(one) else { continue };
            let off_km = (found.position_km - one.position_km).length();
            assert!(off_km < 2e-8, "{at} {off_km}");
            let off_km_s = (found.velocity_km_s - one.velocity_km_s).length();
            assert!(off_km_s < 1e-10, "{at} {off_km_s}");
        }
    }

    #[test]
    fn time_may_turn_back_over_the_epoch() {
        let catalog = bundled().unwrap();
        let elements = catalog.get(54_743).unwrap();
        let propagator = Propagator::new(elements).unwrap();
        let at = |days: f64| time::add_seconds(elements.epoch(), days * time::DAY_S);
        let first = propagator.state_at(at(3.0));
        assert!(propagator.state_at(at(-3.0)).is_ok());
        assert_eq!(propagator.state_at(at(3.0)), first);
    }
}
