//! The way of a satellite across the sky around one instant, from one state.
//!
//! Seen from the site, in axes that turn with the Earth, the satellite moves by
//! gravity (the Earth's mass and its flattening J2) and the two apparent
//! accelerations of a turning frame. With the position q, the velocity v, the
//! acceleration a and its change j known at one instant,
//!
//! q(tau) = q + v tau + a tau²/2 + j tau³/6
//!
//! is right to centimetres for half a minute: the first term left out is about
//! n⁴ r tau⁴/24, with n the angular speed and r the distance from the centre.
//!
//! Height here always means the sine of the elevation. It is smooth even where
//! a satellite passes the zenith and its azimuth jumps.

use glam::DVec3;

use super::window::Window;
use crate::{
    astro::frames::EARTH_RATE_RAD_S,
    orbit::{State, propagator::WGS72_RADIUS_KM},
};

/// Gravity of the Earth in WGS72, km³/s².
pub(super) const GRAVITY_KM3_S2: f64 = 398_600.8;
/// Flattening of the gravity field in WGS72.
const J2: f64 = 0.001_082_616;

/// Newton's method for an extreme squares its error: after a step this small,
/// in seconds, the next one would be below a tenth of a millisecond.
const LAST_STEP_S: f64 = 0.1;

/// Vectors east, north, up from the site, in km and seconds.
#[derive(Debug, Clone, Copy)]
pub(super) struct LocalSeries {
    /// The instant the series is made for.
    pub(super) at_s: f64,
    /// The state it is made from, in Earth-fixed axes of that instant; the
    /// velocity is the inertial one.
    pub(super) state: State,
    pub(super) position: DVec3,
    pub(super) velocity: DVec3,
    pub(super) acceleration: DVec3,
    jerk: DVec3,
}

/// Sine of the elevation with its first and second derivative by time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height {
    pub(super) sine: f64,
    pub(super) rate: f64,
    pub(super) curve: f64,
}

/// Which way the height turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bend {
    /// Up, then down.
    Crest,
    /// Down, then up.
    Trough,
}

impl Bend {
    fn fits(self, curve: f64) -> bool {
        match self {
            Self::Crest => curve < 0.0,
            Self::Trough => curve > 0.0,
        }
    }
}

/// Where the satellite is at one instant, seen from the site.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) at_s: f64,
    /// East, north, up in km.
    pub(super) enu_km: DVec3,
    velocity: DVec3,
    pub(super) height: Height,
}

impl Place {
    /// How fast the satellite moves across the sky, in radians per second.
    pub(super) fn angular_rate(&self) -> f64 {
        self.enu_km.cross(self.velocity).length() / self.enu_km.length_squared()
    }

    /// A little later: less than [`LAST_STEP_S`], or as little of the way to an
    /// extreme.
    fn moved(self, step_s: f64) -> Self {
        let Height { sine, rate, curve } = self.height;
        let height = Height {
            sine: sine + step_s * (rate + 0.5 * step_s * curve),
            rate: rate + step_s * curve,
            curve,
        };
        let enu_km = self.enu_km + step_s * self.velocity;
        Self { at_s: self.at_s + step_s, enu_km, height, ..self }
    }
}

impl Height {
    /// Of a satellite at `q` with velocity `v` and acceleration `a`.
    pub(super) fn new(q: DVec3, v: DVec3, a: DVec3) -> Self {
        let inverse_range = q.length_recip();
        let range_rate = q.dot(v) * inverse_range;
        let range_curve = (v.length_squared() + q.dot(a) - range_rate * range_rate) * inverse_range;
        let sine = q.z * inverse_range;
        let rate = (v.z - sine * range_rate) * inverse_range;
        let curve = (a.z - 2.0 * rate * range_rate - sine * range_curve) * inverse_range;
        Self { sine, rate, curve }
    }
}

impl LocalSeries {
    /// The series around `at_s` from the state in TEME there.
    pub(super) fn new(window: &Window, at_s: f64, teme: &State) -> Self {
        let (sin_turn, cos_turn) = window.sidereal_at(at_s).sin_cos();
        let to_ecef = |v: DVec3| {
            DVec3::new(cos_turn * v.x + sin_turn * v.y, cos_turn * v.y - sin_turn * v.x, v.z)
        };
        let position_km = to_ecef(teme.position_km);
        let velocity_km_s = to_ecef(teme.velocity_km_s);
        let over_ground = velocity_km_s + turned(position_km);
        let (pull, pull_change) = gravity(position_km, over_ground);
        let acceleration = pull + turned(2.0 * over_ground - turned(position_km));
        let jerk = pull_change + turned(2.0 * acceleration - turned(over_ground));
        Self {
            at_s,
            state: State { position_km, velocity_km_s },
            position: window.seen_from_site(position_km),
            velocity: window.to_enu * over_ground,
            acceleration: window.to_enu * acceleration,
            jerk: window.to_enu * jerk,
        }
    }

    /// The same with the speed that leads to a second series.
    pub(super) fn mended(&self, second: &Self) -> Self {
        let span_s = second.at_s - self.at_s;
        let missed_km = second.position - self.place(span_s).enu_km;
        Self { velocity: self.velocity + missed_km / span_s, ..*self }
    }

    /// The place `tau` seconds after the series' instant.
    pub(super) fn place(&self, tau: f64) -> Place {
        let acceleration = self.acceleration + tau * self.jerk;
        let velocity = self.velocity + (0.5 * tau) * (self.acceleration + acceleration);
        let change =
            self.velocity + tau * (0.5 * self.acceleration + (tau * (1.0 / 6.0)) * self.jerk);
        let enu_km = self.position + tau * change;
        let height = Height::new(enu_km, velocity, acceleration);
        Place { at_s: self.at_s + tau, enu_km, velocity, height }
    }

    /// Where the height is greatest or least, by Newton's method; `None` when
    /// that leads more than `most_s` away or the height bends the other way.
    pub(super) fn extreme(&self, bend: Bend, most_s: f64) -> Option<Place> {
        let mut tau = 0.0;
        for _ in 0..8 {
            let place = self.place(tau);
            let Height { rate, curve, .. } = place.height;
            let step_s = -rate / curve;
            // Written so that NaN falls out as well.
            if !(bend.fits(curve) && (tau + step_s).abs() <= most_s) {
                return None;
            }
            if step_s.abs() < LAST_STEP_S {
                return Some(place.moved(step_s));
            }
            tau += step_s;
        }
        None
    }

    /// Where the height is `sine`, by Halley's method from `tau`; `None` when
    /// that leads more than `most_s` away.
    pub(super) fn crossing(&self, sine: f64, tau: f64, most_s: f64) -> Option<Place> {
        let mut tau = tau;
        for _ in 0..8 {
            let place = self.place(tau);
            let Height { sine: height, rate, curve } = place.height;
            let newton_s = (sine - height) / rate;
            let step_s = newton_s / (1.0 + 0.5 * newton_s * curve / rate);
            if (tau + step_s).abs() > most_s || step_s.is_nan() {
                return None;
            }
            // The method cubes the share of the rate that a step changes.
            if (newton_s * curve).abs() < 2e-3 * rate.abs() {
                return Some(place.moved(step_s));
            }
            tau += step_s;
        }
        None
    }
}

/// The cross product of the vector with the Earth's rotation: `v × omega`.
fn turned(v: DVec3) -> DVec3 {
    DVec3::new(v.y * EARTH_RATE_RAD_S, -v.x * EARTH_RATE_RAD_S, 0.0)
}

/// The acceleration by the Earth's mass and flattening at `r`, and its change
/// for a body that moves with `v`; the change is that of the mass alone, which
/// is a thousand times more.
fn gravity(r: DVec3, v: DVec3) -> (DVec3, DVec3) {
    let inverse2 = 1.0 / r.length_squared();
    let mass = -GRAVITY_KM3_S2 * inverse2 * inverse2.sqrt();
    let bulge = 1.5 * J2 * WGS72_RADIUS_KM * WGS72_RADIUS_KM * inverse2;
    let rise2 = 5.0 * r.z * r.z * inverse2;
    let across = mass * (1.0 + bulge * (1.0 - rise2));
    let along = mass * (1.0 + bulge * (3.0 - rise2));
    let pull = DVec3::new(across * r.x, across * r.y, along * r.z);
    (pull, mass * (v - (3.0 * r.dot(v) * inverse2) * r))
}
