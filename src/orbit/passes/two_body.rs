//! Approximate times at which a satellite rises and sets, from its state in between.
//!
//! For the minutes of a pass, a satellite stays close to the ellipse of its state. With E the
//! change of the eccentric anomaly since that state (at distance r0, semi-major axis a, mean motion
//! n, sigma = r·v / sqrt(mu a)),
//!
//! n tau = E - (1 - r0/a) sin E + sigma (1 - cos E)
//!
//! so the time follows from E without solving an equation. The height of the satellite above the
//! horizon is nearly a cosine of E around the crest. AOS and LOS found in this way are off by a
//! second or two, hardly ever by ten. One exact state corrects the error.

use super::{
    local_series::{GRAVITY_KM3_S2, LocalSeries, LocalState},
    window::Window,
};
use crate::simd::Number;

/// The ellipse of a state near a crest.
pub(super) struct TwoBody<N> {
    /// Symbols of the formula: 1/n, sigma and 1 - r0/a.
    period: N,
    sigma: N,
    narrow: N,
    /// E at the crest, and its change from the crest to the horizon on either side.
    crest: N,
    half: N,
}

impl<N: Number> TwoBody<N> {
    /// Creates the ellipse of a series whose crest is at `crest`.
    #[inline(always)]
    pub(super) fn new(window: &Window, series: &LocalSeries<N>, crest: &LocalState<N>) -> Self {
        let (r, v) = (series.state.position_km, series.state.velocity_km_s);
        let inverse_r0 = N::splat(1.0) / r.length();
        let inverse_a = inverse_r0 * 2.0 - v.length_squared() * (1.0 / GRAVITY_KM3_S2);
        let root = (inverse_a * GRAVITY_KM3_S2).sqrt();
        let rad_s = root * inverse_r0;
        // The second derivative of the range, which is least near the crest.
        let range_curve = (series.velocity.length_squared()
            + crest.enu_km.dot(series.acceleration))
            / crest.range_km;
        let above_km = (crest.height.sine - window.sin_aos_elevation) * crest.range_km;
        let falling_km_s2 = range_curve * window.sin_aos_elevation - series.acceleration.z;
        // The half is the angle whose cosine is less than 1 by `share`.
        let share = above_km * rad_s * rad_s / falling_km_s2;
        let half = (share * 2.0).sqrt() * (share * (share * 0.03 + 1.0 / 12.0) + 1.0);
        Self {
            period: N::splat(1.0) / (inverse_a * root),
            sigma: r.dot(v) * inverse_a / root,
            narrow: -(inverse_a / inverse_r0) + 1.0,
            crest: (crest.at_s - series.at_s) * rad_s,
            half,
        }
    }

    /// Returns the time, in seconds from the state, at which the satellite crosses the horizon. A
    /// `side` of -1 is before the crest, 1 is after it. The result is NaN if the ellipse does not
    /// reach the horizon.
    #[inline(always)]
    pub(super) fn crossing_tau(&self, side: f64) -> N {
        let e = self.crest + self.half * side;
        let (sin_e, cos_e) = e.sin_cos();
        (e - self.narrow * sin_e + self.sigma * (-cos_e + 1.0)) * self.period
    }
}
