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

/// Equatorial radius in WGS72, the constants with which SGP4 is defined, km.
pub(super) const WGS72_RADIUS_KM: f64 = 6_378.135;
/// Max distance from the epoch, days. Beyond it, a set has no meaning. The resonance integrator,
/// which advances in half days, would take seconds for a far century.
const FARTHEST_DAYS: f64 = 36_525.0;
/// Max difference between SGP4's velocity and the rate of change of its position, km/s, and its
/// increase with the eccentricity. The velocity neglects the drag and higher powers of the
/// flattening, which matter more for more eccentric orbits. Both values are measured over the
/// bundled catalog.
const DRIFT_KM_S: f64 = 3e-5;
const ECCENTRIC_DRIFT_KM_S: f64 = 0.01;

/// Max distance from the Earth in multiples of the apogee at the epoch. Far from the epoch, the
/// polynomials of the drag lead to any distance. All states of SGP4's verification are nearer.
const MAX_GROWTH: f64 = 10.0;

/// Max perigee height from which a deep-space orbit decays within weeks, km.
const LOW_PERIGEE_KM: f64 = 120.0;
/// Step of the search for the first missing state, minutes, and max number of steps. A step is a
/// sixteenth of a low revolution. The steps cover ten weeks, because a near-earth orbit that
/// touches the atmosphere decays in days.
const DOWN_STEP_MIN: f64 = 5.0;
const MAX_DOWN_LOOKS: u32 = 20_000;
/// Max time by which a state may be ahead of the stored integration without replacing it, minutes:
/// twenty steps. A request for an earlier state then need not begin at the epoch.
const RESUMED_MIN: f64 = 14_400.0;

/// Min mean motion at which the orbit neglects Sun and Moon, revolutions per day: periods below 225
/// minutes.
const CLOSE_REV_DAY: f64 = 6.5;
/// Min perigee height, km, and max eccentricity of orbits that stay above the ground in all waves
/// of the gravity field. The waves move the orbit by some 15 km.
const HIGH_PERIGEE_KM: f64 = 100.0;
const SMALL_ECCENTRICITY: f64 = 0.05;

/// Position and velocity of a satellite in TEME.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Position from the centre of the Earth, km.
    pub position_km: DVec3,
    /// Inertial velocity, km/s.
    pub velocity_km_s: DVec3,
}

/// Reason why there is no state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum PropagationError {
    /// SGP4 cannot start from these elements.
    #[error("the elements describe no orbit")]
    Elements,
    /// The orbit has met the ground, or SGP4 no longer has a solution.
    #[error("the object has decayed")]
    Decayed,
    /// The time is more than a century from the epoch, or so far that SGP4 leads away from the
    /// Earth.
    #[error("the time is too far from the epoch of the elements")]
    TooFarFromEpoch,
}

/// Propagator of one satellite; threads can share it.
#[derive(Debug, Clone)]
pub struct Propagator {
    constants: sgp4::Constants,
    epoch: Timestamp,
    secular: Option<Secular>,
    drift_km_s: f64,
    /// Minutes after the epoch from which the orbit may have met the ground.
    low_after_min: f64,
    /// Max distance from the centre of the Earth, km.
    farthest_km: f64,
    descent: Descent,
    resonance: Resonance,
}

/// Progress of the check that an orbit has not met the ground. The value is the number of
/// successive looks with a state, in steps of [`DOWN_STEP_MIN`] from `low_after_min` on. The looks
/// reach as far as the latest requested time.
#[derive(Debug, Default)]
struct Descent(AtomicU32);

impl Clone for Descent {
    fn clone(&self) -> Self {
        Self(self.0.load(Ordering::Relaxed).into())
    }
}

/// Progress of the integration of a resonant orbit, so that the next state need not start from the
/// epoch. Other orbits leave it unchanged.
#[derive(Clone, Copy, Default)]
pub(super) struct Resumable(Option<sgp4::ResonanceState>);

impl fmt::Debug for Resumable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Resumable").field(&self.0.map(|state| state.t())).finish()
    }
}

/// Stored progress of the integration of a resonant orbit, near the requested times. The steps are
/// the same from every start, so the states are the same.
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
        let mut resumable = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_near =
            resumable.ahead_min(reached).is_some_and(|min| (0.0..=RESUMED_MIN).contains(&min));
        if !is_near {
            *resumable = reached;
        }
    }
}

impl Resumable {
    /// Returns the distance by which `later` is farther from the epoch, minutes; `None` if it is on
    /// the other side.
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
            // Drag makes such an orbit decay only if its perigee is in the atmosphere.
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

    /// Returns `true` if SGP4 finds the object above the ground at the epoch of `elements`.
    pub(super) fn is_up_at_epoch(elements: &Elements) -> bool {
        let numbers = elements.sgp4();
        if is_surely_up_at_epoch(&numbers) {
            return true;
        }
        let state = start(&numbers)
            .and_then(|(_, constants)| sgp4_state(&constants, 0.0, &mut Resumable::default()));
        state.is_ok()
    }

    /// Returns the state at `time`, in TEME.
    pub fn state_at(&self, time: Timestamp) -> Result<State, PropagationError> {
        let mut resumable = self.resumable();
        let state = self.state_after(time::seconds_between(self.epoch, time), &mut resumable);
        if self.secular.is_none() {
            self.resonance.reach(resumable);
        }
        state
    }

    /// Returns the stored progress from which a series of states resumes the integration.
    pub(super) fn resumable(&self) -> Resumable {
        if self.secular.is_some() { Resumable::default() } else { self.resonance.get() }
    }

    /// Returns the states at several times in ascending order. Those of near-circular orbits are
    /// computed eight at once, within 2e-8 km of [`Self::state_at`].
    pub fn states_at(&self, times: &[Timestamp]) -> Vec<Option<State>> {
        let is_round = |time: &Timestamp| self.near_circular_at(*time).is_some();
        let ends = times.first().into_iter().chain(times.last());
        match self.secular().filter(|_| ends.clone().all(is_round)) {
            Some(secular) => {
                let minutes = |utc: &Timestamp| time::seconds_between(self.epoch, *utc) / 60.0;
                let minutes: Vec<f64> = times.iter().map(minutes).collect();
                secular.states(&minutes).map(Some).collect()
            }
            None => times.iter().map(|time| self.state_at(*time).ok()).collect(),
        }
    }

    /// Returns the places of several satellites, each at its own time. Those of near-circular
    /// orbits are computed eight at once, within 2e-8 km of [`Self::state_at`].
    pub fn over_ground(requests: &[(&Self, Timestamp)]) -> Vec<Option<OverGround>> {
        let mut places = vec![None; requests.len()];
        let mut near_circular = Vec::with_capacity(requests.len());
        for ((propagator, time), place) in requests.iter().zip(&mut places) {
            match propagator.near_circular_at(*time) {
                Some((secular, minutes)) => near_circular.push((secular, minutes, *time, place)),
                None => {
                    *place = propagator.state_at(*time).ok().map(|state| state.over_ground(*time));
                }
            }
        }
        let mut lanes = Secular::default();
        for chunk in near_circular.chunks_mut(LANES) {
            let (mut minutes, mut turn) = (Lanes::ZERO, Lanes::ZERO);
            for (lane, (secular, at_min, utc, _)) in chunk.iter().enumerate() {
                lanes.set(lane, secular);
                minutes.set(lane, *at_min);
                turn.set(lane, time::gmst(*utc).radians());
            }
            for ((.., place), of_lane) in chunk.iter_mut().zip(lanes.motions(minutes, turn)) {
                let (position_km, velocity_km_s) = of_lane;
                **place = Some(OverGround::of_inertial(position_km, velocity_km_s));
            }
        }
        places
    }

    /// Returns the long-term motion and the minutes since the epoch, if the orbit is near-circular
    /// at `time`.
    fn near_circular_at(&self, time: Timestamp) -> Option<(&Secular, f64)> {
        let since_epoch_s = time::seconds_between(self.epoch, time);
        let minutes = since_epoch_s / 60.0;
        let secular = self.secular().filter(|secular| secular.is_near_circular_at(minutes))?;
        let is_known = since_epoch_s.abs() <= FARTHEST_DAYS * time::DAY_S;
        (is_known && !self.may_be_down_at(since_epoch_s)).then_some((secular, minutes))
    }

    /// Returns the epoch, from which [`Self::state_after`] counts.
    pub(super) fn epoch(&self) -> Timestamp {
        self.epoch
    }

    /// Returns the long-term motion of the orbit; `None` for deep space.
    pub(super) fn secular(&self) -> Option<&Secular> {
        self.secular.as_ref()
    }

    /// Returns the max difference between the velocities and the rate of change of the positions,
    /// km/s, `since_epoch_s` seconds after the epoch.
    pub(super) fn drift_km_s(&self, since_epoch_s: f64) -> f64 {
        let drag = |secular: &Secular| secular.drag_drift_km_s(since_epoch_s / 60.0);
        self.drift_km_s + self.secular.as_ref().map_or(0.0, drag)
    }

    /// Returns the state `since_epoch_s` seconds after the epoch, in TEME. A series of calls with
    /// one `resumable` is fast if it leads away from the epoch, and correct in any order.
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
        // The test also refuses NaN.
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

    /// Returns `true` if the object has decayed by this time according to SGP4. Later, the
    /// equations continue below the ground and may bring the object up again.
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

/// Returns the orbit and the constants that SGP4 computes once for a set of elements.
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

/// Returns the state by SGP4, even if the object has decayed before.
fn sgp4_state(
    constants: &sgp4::Constants,
    since_epoch_min: f64,
    resumable: &mut Resumable,
) -> Result<State, PropagationError> {
    // The library panics if the time goes back towards or across the epoch.
    let resumed = resumable.0.take().filter(|state| {
        let reached_min = state.t();
        reached_min * since_epoch_min > 0.0 && since_epoch_min.abs() >= reached_min.abs()
    });
    resumable.0 = resumed.or_else(|| constants.initial_state());
    let minutes = sgp4::MinutesSinceEpoch(since_epoch_min);
    let prediction = constants
        .propagate_from_state(minutes, resumable.0.as_mut(), false)
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

/// Returns `true` if the perigee alone shows that the object is above the ground at its epoch. This
/// holds for nearly all of a catalogue. The drag has no effect at the epoch yet.
fn is_surely_up_at_epoch(elements: &sgp4::Elements) -> bool {
    elements.mean_motion > CLOSE_REV_DAY
        && elements.eccentricity < SMALL_ECCENTRICITY
        && lowest_km(elements) > HIGH_PERIGEE_KM
}

/// Returns the semi-major axis at the epoch, km.
fn axis_km(elements: &sgp4::Elements) -> f64 {
    let rate_rad_min = elements.mean_motion * (TAU / 1440.0);
    (sgp4::WGS72.ke / rate_rad_min).powf(2.0 / 3.0) * WGS72_RADIUS_KM
}

/// Returns the height of the perigee at the epoch, km.
fn lowest_km(elements: &sgp4::Elements) -> f64 {
    axis_km(elements) * (1.0 - elements.eccentricity) - WGS72_RADIUS_KM
}

#[cfg(test)]
mod tests;
