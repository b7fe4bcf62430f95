//! The motion of a satellite across the sky around one instant, from one state.
//!
//! Seen from the site, in axes that turn with the Earth, the satellite moves by gravity (the
//! Earth's mass and its flattening J2) and the two apparent accelerations of a turning frame. With
//! the position q, the velocity v, the acceleration a and its change j known at one instant,
//!
//! q(tau) = q + v tau + a tau²/2 + j tau³/6
//!
//! is accurate to centimetres for half a minute. The first neglected term is about n⁴ r tau⁴/24,
//! with n the angular speed and r the distance from the centre.
//!
//! Height in this module means the sine of the elevation. The sine is smooth even when a satellite
//! passes the zenith and its azimuth jumps.

use super::window::Window;
use crate::{
    astro::frames::EARTH_RATE_RAD_S,
    propagator::WGS72_RADIUS_KM,
    simd::{Lanes, Number, Vector},
};

/// Gravitational parameter of the Earth in WGS72, km³/s².
pub(super) const GRAVITY_KM3_S2: f64 = 398_600.8;
/// Flattening of the gravity field in WGS72.
const J2: f64 = 0.001_082_616;

/// Max last step of Newton's method for an extreme, seconds. The method squares its error, so after
/// a step this small, the next step would be below a tenth of a millisecond.
const LAST_STEP_S: f64 = 0.1;
/// Max last share of the rate that a step of Halley's method for a crossing changes. The method
/// cubes this share, so the remaining error is less than a tenth of a millisecond.
const LAST_SHARE: f64 = 8e-3;
/// Max number of steps. Only a search without a solution needs more.
const MAX_STEPS: usize = 8;

/// Series of the motion around one instant. Vectors are east, north, up from the site, in km and
/// seconds.
#[derive(Debug, Clone, Copy)]
pub(super) struct LocalSeries<N = f64> {
    /// Instant of the series, seconds from the start of the window.
    pub(super) at_s: N,
    /// State from which the series is made.
    pub(super) state: EarthFixed<N>,
    pub(super) position: Vector<N>,
    pub(super) velocity: Vector<N>,
    pub(super) acceleration: Vector<N>,
    jerk: Vector<N>,
}

/// A state in the Earth-fixed axes of its instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct EarthFixed<N = f64> {
    pub(super) position_km: Vector<N>,
    /// Inertial velocity, km/s.
    pub(super) velocity_km_s: Vector<N>,
}

/// Sine of the elevation with its first and second derivative with respect to time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height<N = f64> {
    pub(super) sine: N,
    pub(super) rate: N,
    pub(super) curve: N,
}

/// Sense in which the height turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bend {
    /// Rise, then fall.
    Crest,
    /// Fall, then rise.
    Trough,
}

impl Bend {
    #[inline(always)]
    fn fits<N: Number>(self, curve: N) -> N::Answer {
        match self {
            Self::Crest => curve.is_less(N::splat(0.0)),
            Self::Trough => N::splat(0.0).is_less(curve),
        }
    }
}

/// Position and motion of the satellite at one instant, as seen from the site.
#[derive(Debug, Clone, Copy)]
pub(super) struct LocalState<N = f64> {
    pub(super) at_s: N,
    /// East, north and up, km.
    pub(super) enu_km: Vector<N>,
    velocity: Vector<N>,
    acceleration: Vector<N>,
    pub(super) range_km: N,
    pub(super) height: Height<N>,
}

impl<N: Number> LocalState<N> {
    /// Returns the angular speed of the satellite across the sky, radians per second.
    pub(super) fn angular_rate(&self) -> N {
        self.enu_km.cross(self.velocity).length() / self.enu_km.length_squared()
    }

    /// Tests whether the height turns here in the sense of `bend`.
    #[inline(always)]
    pub(super) fn turns(&self, bend: Bend) -> N::Answer {
        let Height { rate, curve, .. } = self.height;
        bend.fits(curve) & rate.abs().is_less(curve.abs() * LAST_STEP_S)
    }

    /// Tests whether the height is `sine` here, within a millisecond.
    #[inline(always)]
    pub(super) fn crosses(&self, sine: f64) -> N::Answer {
        (self.height.sine - sine).abs().is_less(self.height.rate.abs() * 1e-3)
    }

    /// Returns the state after a small `step_s`: less than [`LAST_STEP_S`], or less than
    /// [`LAST_SHARE`] of the time to an extreme.
    #[inline(always)]
    fn moved(self, step_s: N) -> Self {
        let Height { sine, rate, curve } = self.height;
        let height = Height {
            sine: sine + step_s * (rate + step_s * curve * 0.5),
            rate: rate + step_s * curve,
            curve,
        };
        let enu_km = self.enu_km + (self.velocity + self.acceleration * (step_s * 0.5)) * step_s;
        Self { at_s: self.at_s + step_s, enu_km, height, ..self }
    }
}

impl<N: Number> Height<N> {
    /// Returns the height of a satellite at `q`, at the distance `range`, with velocity `v` and
    /// acceleration `a`.
    #[inline(always)]
    pub(super) fn new(q: Vector<N>, range: N, v: Vector<N>, a: Vector<N>) -> Self {
        // One division serves all quotients, because division is the slowest operation here.
        let inverse_range = N::splat(1.0) / range;
        let range_rate = q.dot(v) * inverse_range;
        let range_curve = (v.length_squared() + q.dot(a) - range_rate * range_rate) * inverse_range;
        let sine = q.z * inverse_range;
        let rate = (v.z - sine * range_rate) * inverse_range;
        let curve = (a.z - rate * range_rate * 2.0 - sine * range_curve) * inverse_range;
        Self { sine, rate, curve }
    }
}

impl<N: Number> LocalSeries<N> {
    /// Creates the series around `at_s` from the state at that time.
    #[inline(always)]
    pub(super) fn new(window: &Window, at_s: N, state: EarthFixed<N>) -> Self {
        let EarthFixed { position_km, velocity_km_s } = state;
        // The frame turns, so the Coriolis and centrifugal accelerations appear.
        let over_ground = velocity_km_s + turned(position_km);
        let (pull, pull_change) = gravity(position_km, over_ground);
        let acceleration = pull + turned(over_ground + over_ground - turned(position_km));
        let jerk = pull_change + turned(acceleration + acceleration - turned(over_ground));
        Self {
            at_s,
            state,
            position: window.seen_from_site(position_km),
            velocity: window.to_enu(over_ground),
            acceleration: window.to_enu(acceleration),
            jerk: window.to_enu(jerk),
        }
    }

    /// Returns the same series with the velocity that leads to a second series.
    pub(super) fn mended(&self, second: &Self) -> Self {
        let span_s = second.at_s - self.at_s;
        // SGP4's velocity is not exactly the change of its position; a second position shows the
        // change.
        let missed_km = second.position - self.place(span_s).enu_km;
        let per_second = N::splat(1.0) / span_s;
        Self { velocity: self.velocity + missed_km * per_second, ..*self }
    }

    /// Returns the place `tau` seconds after the instant of the series.
    #[inline(always)]
    pub(super) fn place(&self, tau: N) -> LocalState<N> {
        let half = tau * 0.5;
        let acceleration = self.acceleration + self.jerk * tau;
        let velocity = self.velocity + (self.acceleration + acceleration) * half;
        // Horner's form: the cubic needs no powers of `tau`.
        let change = self.velocity + (self.acceleration + self.jerk * (tau * (1.0 / 3.0))) * half;
        let enu_km = self.position + change * tau;
        let range_km = enu_km.length();
        let height = Height::new(enu_km, range_km, velocity, acceleration);
        LocalState { at_s: self.at_s + tau, enu_km, velocity, acceleration, range_km, height }
    }

    /// Returns the place of the greatest or least height, by Newton's method from the instant of
    /// the series. If the method does not converge, [`LocalState::turns`] does not hold for the
    /// place.
    #[inline(always)]
    pub(super) fn turning(&self) -> LocalState<N> {
        let mut place = self.place(N::splat(0.0));
        for _ in 0..MAX_STEPS {
            let step_s = -place.height.rate / place.height.curve;
            // All lanes continue until the slowest has converged; further steps do not harm the
            // others.
            if !step_s.abs().any_reaches(LAST_STEP_S) {
                return place.moved(step_s);
            }
            place = self.place(place.at_s - self.at_s + step_s);
        }
        place
    }

    /// Returns the place with the height `sine`, by Halley's method from `tau`. If the method does
    /// not converge, [`LocalState::crosses`] does not hold for the place.
    #[inline(always)]
    pub(super) fn crossing(&self, sine: f64, tau: N) -> LocalState<N> {
        let mut place = self.place(tau);
        for _ in 0..MAX_STEPS {
            let Height { sine: height, rate, curve } = place.height;
            let newton_s = (-height + sine) / rate;
            // Near a crest, Newton's method overshoots; the curve shows by how much.
            let share = newton_s * curve / rate;
            let step_s = newton_s / (share * 0.5 + 1.0);
            if !share.abs().any_reaches(LAST_SHARE) {
                return place.moved(step_s);
            }
            place = self.place(place.at_s - self.at_s + step_s);
        }
        place
    }
}

impl LocalSeries {
    /// Returns the place of the greatest or least height. Returns `None` if the place is more than
    /// `max_s` away or if the height bends the other way.
    pub(super) fn extreme(&self, bend: Bend, max_s: f64) -> Option<LocalState> {
        let place = self.turning();
        let is_near = (place.at_s - self.at_s).abs() <= max_s;
        (is_near && place.turns(bend)).then_some(place)
    }
}

impl LocalSeries<Lanes> {
    pub(super) fn lane(&self, lane: usize) -> LocalSeries {
        LocalSeries {
            at_s: self.at_s.lane(lane),
            state: EarthFixed {
                position_km: self.state.position_km.lane(lane),
                velocity_km_s: self.state.velocity_km_s.lane(lane),
            },
            position: self.position.lane(lane),
            velocity: self.velocity.lane(lane),
            acceleration: self.acceleration.lane(lane),
            jerk: self.jerk.lane(lane),
        }
    }
}

impl LocalState<Lanes> {
    pub(super) fn lane(&self, lane: usize) -> LocalState {
        let Height { sine, rate, curve } = &self.height;
        let lane_value = |numbers: &Lanes| numbers.lane(lane);
        LocalState {
            at_s: lane_value(&self.at_s),
            enu_km: self.enu_km.lane(lane),
            velocity: self.velocity.lane(lane),
            acceleration: self.acceleration.lane(lane),
            range_km: lane_value(&self.range_km),
            height: Height {
                sine: lane_value(sine),
                rate: lane_value(rate),
                curve: lane_value(curve),
            },
        }
    }
}

/// Returns the cross product of the vector with the Earth's rotation: `v × omega`.
#[inline(always)]
fn turned<N: Number>(v: Vector<N>) -> Vector<N> {
    Vector::new(v.y * EARTH_RATE_RAD_S, v.x * -EARTH_RATE_RAD_S, N::splat(0.0))
}

/// Returns the acceleration at `r` due to the Earth's mass and flattening, and its change for a
/// body that moves with `v`. The change covers only the mass, whose effect is a thousand times
/// larger.
#[inline(always)]
fn gravity<N: Number>(r: Vector<N>, v: Vector<N>) -> (Vector<N>, Vector<N>) {
    let inverse2 = N::splat(1.0) / r.length_squared();
    let mass = inverse2 * inverse2.sqrt() * -GRAVITY_KM3_S2;
    let bulge = inverse2 * (1.5 * J2 * WGS72_RADIUS_KM * WGS72_RADIUS_KM);
    let rise2 = r.z * r.z * inverse2 * 5.0;
    let across = mass * (bulge * (-rise2 + 1.0) + 1.0);
    // The bulge pulls towards the equator, so the polar component has another factor.
    let along = mass * (bulge * (-rise2 + 3.0) + 1.0);
    let pull = Vector::new(across * r.x, across * r.y, along * r.z);
    (pull, (v - r * (r.dot(v) * inverse2 * 3.0)) * mass)
}
