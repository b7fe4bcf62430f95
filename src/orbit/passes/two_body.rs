//! Where a satellite comes up and goes down, from its state in between.
//!
//! For the minutes of a pass a satellite keeps nearly to the ellipse of its
//! state. With E the change of the eccentric anomaly since that state (at
//! distance r0, semi-major axis a, mean motion n, sigma = r·v / sqrt(mu a)),
//!
//! n tau = E - (1 - r0/a) sin E + sigma (1 - cos E)
//! r(tau) = f r0 + g v0, f = 1 - (a/r0)(1 - cos E), g = tau - (E - sin E)/n
//!
//! so time and place both follow from E without solving an equation. What the
//! flattening does in the meantime shifts AOS by some tenths of a second; one
//! exact state puts that right.

use glam::DVec3;

use super::{
    local_series::{GRAVITY_KM3_S2, LocalSeries, Place},
    window::Window,
};
use crate::{astro::frames::EARTH_RATE_RAD_S, orbit::State};

/// The parabola is good to a second for a correction as small as this, in
/// radians of E.
const NEAR_RAD: f64 = 0.03;

/// The ellipse of a state, seen from the turning site.
pub(super) struct TwoBody<'a> {
    window: &'a Window,
    state: State,
    /// The letters of the formulas; `a_r0` is a/r0.
    a_r0: f64,
    n: f64,
    sigma: f64,
    /// The crest: E there, and by how many km the satellite stands above the
    /// horizon.
    crest: f64,
    above_km: f64,
    /// How fast that falls off on both sides: a cosine of this size in km.
    swing_km: f64,
}

impl<'a> TwoBody<'a> {
    /// From the series whose crest is at `crest`.
    pub(super) fn new(window: &'a Window, series: &LocalSeries, crest: &Place) -> Self {
        let state = series.state;
        let (r, v) = (state.position_km, state.velocity_km_s);
        let inverse_r0 = r.length_recip();
        let inverse_a = 2.0 * inverse_r0 - v.length_squared() / GRAVITY_KM3_S2;
        let root = (inverse_a * GRAVITY_KM3_S2).sqrt();
        let rad_s = root * inverse_r0;
        let inverse_range = crest.enu_km.length_recip();
        // The change of the range, which is least near the crest.
        let range_curve = inverse_range
            * (series.velocity.length_squared() + crest.enu_km.dot(series.acceleration));
        Self {
            window,
            state,
            a_r0: inverse_r0 / inverse_a,
            n: inverse_a * root,
            sigma: r.dot(v) * inverse_a / root,
            crest: (crest.at_s - series.at_s) * rad_s,
            above_km: (crest.height.sine - window.sin_horizon) / inverse_range,
            swing_km: (window.sin_horizon * range_curve - series.acceleration.z) / (rad_s * rad_s),
        }
    }

    /// When, in seconds from the state, the satellite passes the horizon:
    /// before the crest for a `side` of -1, after it for 1. Not a number when
    /// the ellipse does not say.
    pub(super) fn crossing_tau(&self, side: f64) -> f64 {
        let mut from_crest = (1.0 - self.above_km / self.swing_km).max(-1.0).acos();
        for _ in 0..4 {
            let there = self.at(self.crest + side * from_crest);
            // The parabola through the crest and this point.
            let better = from_crest * (self.above_km / (self.above_km - there.above_km)).sqrt();
            let step = better - from_crest;
            if step.abs() < NEAR_RAD {
                return there.tau + side * step * there.tau_per_rad;
            }
            from_crest = better;
        }
        f64::NAN
    }

    /// Where the ellipse leads at the anomaly `e`.
    fn at(&self, e: f64) -> Ahead {
        let (sin_e, cos_e) = e.sin_cos();
        let narrow = 1.0 - 1.0 / self.a_r0;
        let tau = (e - narrow * sin_e + self.sigma * (1.0 - cos_e)) / self.n;
        let f = 1.0 - self.a_r0 * (1.0 - cos_e);
        let g = tau - (e - sin_e) / self.n;
        let position_km = f * self.state.position_km + g * self.state.velocity_km_s;
        // Sine and cosine of the Earth's turn: it is small.
        let turn = EARTH_RATE_RAD_S * tau;
        let turn2 = turn * turn;
        let sin_turn = turn * (1.0 - turn2 / 6.0 * (1.0 - turn2 / 20.0));
        let cos_turn = 1.0 - turn2 / 2.0 * (1.0 - turn2 / 12.0 * (1.0 - turn2 / 30.0));
        let line = DVec3::new(
            cos_turn * position_km.x + sin_turn * position_km.y,
            cos_turn * position_km.y - sin_turn * position_km.x,
            position_km.z,
        ) - self.window.site_ecef_km;
        Ahead {
            tau,
            tau_per_rad: (1.0 - narrow * cos_e + self.sigma * sin_e) / self.n,
            above_km: line.dot(self.window.up) - self.window.sin_horizon * line.length(),
        }
    }
}

/// A point of the ellipse.
struct Ahead {
    /// Seconds from the state.
    tau: f64,
    /// Its change with the anomaly.
    tau_per_rad: f64,
    /// Above the horizon.
    above_km: f64,
}
