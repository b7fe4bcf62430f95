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

use super::{
    local_series::{EarthFixed, GRAVITY_KM3_S2, LocalSeries, Place},
    window::Window,
};
use crate::{
    astro::frames::EARTH_RATE_RAD_S,
    orbit::lanes::{Number, Vector},
};

/// Times the parabola through the crest is put right.
const ROUNDS: usize = 2;

/// The ellipse of a state, seen from the turning site.
pub(super) struct TwoBody<'a, N> {
    window: &'a Window,
    state: EarthFixed<N>,
    /// The letters of the formulas; `a_r0` is a/r0, and `period` 1/n.
    a_r0: N,
    period: N,
    sigma: N,
    /// 1 - r0/a.
    narrow: N,
    /// The crest: E there, and by how many km the satellite stands above the
    /// horizon.
    crest: N,
    above_km: N,
    /// How fast that falls off on both sides: a cosine of this size in km.
    swing_km: N,
}

impl<'a, N: Number> TwoBody<'a, N> {
    /// From the series whose crest is at `crest`.
    pub(super) fn new(window: &'a Window, series: &LocalSeries<N>, crest: &Place<N>) -> Self {
        let state = series.state;
        let (r, v) = (state.position_km, state.velocity_km_s);
        let inverse_r0 = N::of(1.0) / r.length();
        let inverse_a = inverse_r0 * 2.0 - v.length_squared() / GRAVITY_KM3_S2;
        let root = (inverse_a * GRAVITY_KM3_S2).sqrt();
        let rad_s = root * inverse_r0;
        let range = crest.enu_km.length();
        // The change of the range, which is least near the crest.
        let range_curve =
            (series.velocity.length_squared() + crest.enu_km.dot(series.acceleration)) / range;
        let narrow = -(inverse_a / inverse_r0) + 1.0;
        Self {
            window,
            state,
            a_r0: inverse_r0 / inverse_a,
            period: N::of(1.0) / (inverse_a * root),
            sigma: r.dot(v) * inverse_a / root,
            narrow,
            crest: (crest.at_s - series.at_s) * rad_s,
            above_km: (crest.height.sine - window.sin_horizon) * range,
            swing_km: (range_curve * window.sin_horizon - series.acceleration.z) / (rad_s * rad_s),
        }
    }

    /// When, in seconds from the state, the satellite passes the horizon:
    /// before the crest for a `side` of -1, after it for 1. Not a number when
    /// the ellipse does not say.
    pub(super) fn crossing_tau(&self, side: f64) -> N {
        let mut from_crest = (-(self.above_km / self.swing_km) + 1.0).within(-1.0, 1.0).acos();
        let mut tau = N::of(f64::NAN);
        for _ in 0..ROUNDS {
            let there = self.at(self.crest + from_crest * side);
            // The parabola through the crest and this point.
            let better = from_crest * (self.above_km / (self.above_km - there.above_km)).sqrt();
            tau = there.tau + (better - from_crest) * there.tau_per_rad * side;
            from_crest = better;
        }
        tau
    }

    /// Where the ellipse leads at the anomaly `e`.
    fn at(&self, e: N) -> Ahead<N> {
        let (sin_e, cos_e) = e.sin_cos();
        let less = -cos_e + 1.0;
        let tau = (e - self.narrow * sin_e + self.sigma * less) * self.period;
        let f = -(self.a_r0 * less) + 1.0;
        let g = tau - (e - sin_e) * self.period;
        let position_km = self.state.position_km * f + self.state.velocity_km_s * g;
        // Sine and cosine of the Earth's turn: it is small.
        let turn = tau * EARTH_RATE_RAD_S;
        let turn2 = turn * turn;
        let sin_turn = turn * (-(turn2 * (1.0 / 6.0)) * (-(turn2 * 0.05) + 1.0) + 1.0);
        let cos_turn = -(turn2 * 0.5)
            * (-(turn2 * (1.0 / 12.0)) * (-(turn2 * (1.0 / 30.0)) + 1.0) + 1.0)
            + 1.0;
        let line = Vector::new(
            cos_turn * position_km.x + sin_turn * position_km.y,
            cos_turn * position_km.y - sin_turn * position_km.x,
            position_km.z,
        ) - self.window.site_ecef_km.into();
        Ahead {
            tau,
            tau_per_rad: (-(self.narrow * cos_e) + self.sigma * sin_e + 1.0) * self.period,
            above_km: line.dot(self.window.up.into()) - line.length() * self.window.sin_horizon,
        }
    }
}

/// A point of the ellipse.
struct Ahead<N> {
    /// Seconds from the state.
    tau: N,
    /// Its change with the anomaly.
    tau_per_rad: N,
    /// Above the horizon.
    above_km: N,
}
