//! The slow motion of a near-earth orbit in SGP4.
//!
//! SGP4 first moves the mean elements by polynomials of the time since the epoch, and then adds
//! short waves. The Earth's flattening turns node and perigee, and the drag shrinks the orbit. The
//! polynomials alone show where in the sky to search, at a hundredth of the cost of a state.
//!
//! Source: Hoots and Roehrich, "Spacetrack Report No. 3", section 6, for the symbols of the
//! coefficients; WGS72. As in this source, times are in minutes and lengths in Earth radii.

use std::f64::consts::TAU;

use sgp4::WGS72;

use super::{
    MAX_GROWTH,
    waves::{DragWave, Waves},
};
use crate::simd::{Lanes, series, set_all};

/// Min period of orbits that follow other equations, minutes.
const DEEP_SPACE_PERIOD_MIN: f64 = 225.0;
/// Max eccentricity of orbits whose states are computed eight at a time.
const MAX_ECCENTRICITY: f64 = 0.05;
/// Min perigee distance, Earth radii. Orbits that come lower are about to decay.
const LOWEST_PERIGEE: f64 = 1.012;
/// Max wave of the eccentricity. Orbits with larger waves are about to decay.
const MAX_WAVE: f64 = 0.005;
/// Min eccentricity for the waves of perigee and anomaly.
const MIN_ECCENTRICITY: f64 = 1e-4;
/// Accuracy of the time at which an orbit gets low, minutes: one hour.
const FIRST_LOOK_MIN: f64 = 60.0;
const CENTURY_MIN: f64 = 36_525.0 * 1440.0;
/// Min perigee height for the full polynomials, Earth radii. Lower orbits get shorter polynomials.
const LOW_PERIGEE: f64 = 220.0 / 6_378.135;

/// Slow motion of one or several orbits, as polynomials of the minutes since the epoch, constant
/// term first.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Secular<N = f64> {
    pub(crate) plane: Plane<N>,
    /// Square root of the semi-major axis, in square roots of Earth radii.
    pub(crate) root_axis: [N; 5],
    pub(super) drag_wave: DragWave<N>,
    pub(super) waves: Waves<N>,
}

/// Plane of the orbit, and mean position of the satellite in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Plane<N = f64> {
    pub(crate) sin_inclination: N,
    pub(crate) cos_inclination: N,
    /// Right ascension of the ascending node, radians.
    pub(crate) node: [N; 3],
    /// Argument of perigee plus mean anomaly, radians.
    pub(crate) argument: [N; 6],
    /// Argument of perigee, radians.
    pub(crate) perigee: [N; 2],
    pub(crate) eccentricity: [N; 2],
}

impl Secular {
    /// Returns the slow motion of an orbit at its epoch; `None` for deep space.
    pub(super) fn new(orbit: &sgp4::Orbit, bstar: f64) -> Option<Self> {
        let is_near_earth = orbit.mean_motion > TAU / DEEP_SPACE_PERIOD_MIN;
        is_near_earth.then(|| Self::of_near_earth(orbit, bstar))
    }

    /// Returns the semi-major axis in Earth radii and the eccentricity, `minutes` after the epoch.
    pub(crate) fn size(&self, minutes: f64) -> (f64, f64) {
        let root_axis = series(&self.root_axis, minutes);
        (root_axis * root_axis, series(&self.plane.eccentricity, minutes))
    }

    /// Returns the minutes after the epoch from which the orbit may be low enough to decay;
    /// infinity if it stays higher for a century.
    pub(super) fn low_after_min(&self) -> f64 {
        let is_low = |minutes: f64| {
            let root_axis = series(&self.root_axis, minutes);
            // The largest eccentricity of the orbit until then counts.
            let eccentricity =
                series(&self.plane.eccentricity, minutes).max(self.plane.eccentricity[0]);
            let lowest = root_axis * root_axis * (1.0 - eccentricity - self.eccentricity_wave());
            // Below zero, the polynomial has passed the centre of the Earth.
            root_axis <= 0.0 || lowest < LOWEST_PERIGEE
        };
        let mut high = 0.0;
        let mut low = FIRST_LOOK_MIN;
        while !is_low(low) {
            high = low;
            low *= 2.0;
            if low > CENTURY_MIN {
                return f64::INFINITY;
            }
        }
        while low - high > FIRST_LOOK_MIN {
            let middle = f64::midpoint(high, low);
            if is_low(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Returns the amplitude of the eccentricity around its polynomial, once a revolution.
    pub(crate) fn eccentricity_wave(&self) -> f64 {
        self.drag_wave.eccentricity[0].abs()
    }

    /// Returns `true` if [`Self::motion`] is valid `minutes` after the epoch.
    pub(crate) fn is_near_circular_at(&self, minutes: f64) -> bool {
        let (axis, eccentricity) = self.size(minutes);
        let wave = self.eccentricity_wave();
        // The test also refuses NaN.
        eccentricity < MAX_ECCENTRICITY
            && eccentricity - wave > 0.0
            && wave < MAX_WAVE
            && axis * (1.0 - eccentricity - wave) > LOWEST_PERIGEE
            && axis < 0.9 * MAX_GROWTH * self.size(0.0).0
    }

    /// Returns the speed, km/s, with which the drag carries the satellite away from SGP4's
    /// velocities, `minutes` after the epoch. SGP4's velocities are those of an orbit that keeps
    /// its size and shape.
    pub(super) fn drag_drift_km_s(&self, minutes: f64) -> f64 {
        let [root_axis, shrinking, _] = expand(&self.root_axis, minutes);
        let [_, rate, _] = expand(&self.plane.argument, minutes);
        let axis = root_axis * root_axis;
        let inward = 4.0 * (root_axis * shrinking).abs();
        // The angle grows by powers of the time; the speed follows from the size.
        let speed_up = WGS72.ke * (root_axis.powi(-3) - self.root_axis[0].powi(-3));
        let ahead = axis * (rate - self.plane.argument[1] - speed_up).abs();
        // Once a revolution, the drag changes the shape and changes it back.
        let DragWave { eta, angle, eccentricity, .. } = &self.drag_wave;
        let swing =
            eccentricity[0].abs() + 3.0 * (self.plane.eccentricity[0] * eta * angle[0]).abs();
        (inward + ahead + 2.0 * swing * axis * rate) * WGS72.ae / 60.0
    }

    fn of_near_earth(orbit: &sgp4::Orbit, bstar: f64) -> Self {
        let (n, e) = (orbit.mean_motion, orbit.eccentricity);
        let axis = (WGS72.ke / n).powf(2.0 / 3.0);
        let round = 1.0 - e * e;
        let (sin_inclination, cos_inclination) = orbit.inclination.sin_cos();
        let theta2 = cos_inclination.powi(2);
        let precession = Precession::new(orbit, axis);

        // The parameters of the density function depend on the height of the perigee.
        let perigee_km = WGS72.ae * (axis * (1.0 - e) - 1.0);
        let s_km = if perigee_km < 98.0 { 20.0 } else { (perigee_km - 78.0).min(78.0) };
        let s = 1.0 + s_km / WGS72.ae;
        let xi = 1.0 / (axis - s);
        let eta = axis * e * xi;
        let psi2 = (1.0 - eta * eta).abs();
        let density = ((120.0 - s_km) / WGS72.ae * xi).powi(4) / psi2.powf(3.5);

        let c1 = bstar
            * density
            * n
            * (axis * (1.0 + 1.5 * eta * eta + e * eta * (4.0 + eta * eta))
                + 0.375 * WGS72.j2 * xi / psi2
                    * (3.0 * theta2 - 1.0)
                    * (8.0 + 3.0 * eta * eta * (8.0 + eta * eta)));
        let flattening =
            -3.0 * (3.0 * theta2 - 1.0) * (1.0 - 2.0 * e * eta + eta * eta * (1.5 - 0.5 * e * eta))
                + 0.75
                    * (1.0 - theta2)
                    * (2.0 * eta * eta - e * eta * (1.0 + eta * eta))
                    * (2.0 * orbit.argument_of_perigee).cos();
        let c4 = 2.0
            * bstar
            * n
            * density
            * axis
            * round
            * (eta * (2.0 + 0.5 * eta * eta) + e * (0.5 + 2.0 * eta * eta)
                - WGS72.j2 * xi / (axis * psi2) * flattening);
        let c5 = 2.0
            * bstar
            * density
            * axis
            * round
            * (1.0 + 2.75 * (eta * eta + eta * e) + e * eta.powi(3));

        let thickness = ((120.0 - s_km) / WGS72.ae * xi).powi(4) * bstar;
        let odd = -2.0 * xi * (WGS72.j3 / WGS72.j2) * n * sin_inclination;
        let angle_wave = [
            -2.0 / 3.0 * thickness / (e * eta),
            (1.0 + eta * orbit.mean_anomaly.cos()).powi(3),
            thickness * odd / e * orbit.argument_of_perigee.cos(),
        ];

        let low = axis * (1.0 - e) < 1.0 + LOW_PERIGEE;
        let [d2, d3, d4] = if low { [0.0; 3] } else { shrinking(c1, axis, xi, s) };
        let root = axis.sqrt();
        let longer = if low { 0.0 } else { n };
        let plane = Plane {
            sin_inclination,
            cos_inclination,
            node: [
                orbit.right_ascension,
                precession.node,
                -3.5 * round * precession.first * cos_inclination * c1,
            ],
            argument: [
                orbit.argument_of_perigee + orbit.mean_anomaly,
                precession.perigee + precession.anomaly,
                n * 1.5 * c1,
                longer * (d2 + 2.0 * c1 * c1),
                longer * 0.25 * (3.0 * d3 + c1 * (12.0 * d2 + 10.0 * c1 * c1)),
                longer
                    * 0.2
                    * (3.0 * d4
                        + 12.0 * c1 * d3
                        + 6.0 * d2 * d2
                        + 15.0 * c1 * c1 * (2.0 * d2 + c1 * c1)),
            ],
            perigee: [orbit.argument_of_perigee, precession.perigee],
            eccentricity: [e, -c4],
        };
        Self {
            plane,
            root_axis: [root, -c1 * root, -d2 * root, -d3 * root, -d4 * root],
            drag_wave: DragWave {
                anomaly: [orbit.mean_anomaly, precession.anomaly],
                eta,
                angle: if low || e <= MIN_ECCENTRICITY { [0.0; 3] } else { angle_wave },
                eccentricity: [if low { 0.0 } else { c5 }, orbit.mean_anomaly.sin()],
            },
            waves: Waves::new(sin_inclination, cos_inclination),
        }
    }
}

impl Secular<Lanes> {
    /// Puts an orbit into a lane.
    pub(crate) fn set(&mut self, lane: usize, orbit: &Secular) {
        let Self { plane, root_axis, drag_wave, waves } = self;
        plane.set(lane, &orbit.plane);
        set_all(root_axis, lane, &orbit.root_axis);
        drag_wave.set(lane, &orbit.drag_wave);
        waves.set(lane, &orbit.waves);
    }
}

impl Plane<Lanes> {
    /// Puts the plane of an orbit into a lane.
    pub(crate) fn set(&mut self, lane: usize, plane: &Plane) {
        self.sin_inclination.set(lane, plane.sin_inclination);
        self.cos_inclination.set(lane, plane.cos_inclination);
        set_all(&mut self.node, lane, &plane.node);
        set_all(&mut self.argument, lane, &plane.argument);
        set_all(&mut self.perigee, lane, &plane.perigee);
        set_all(&mut self.eccentricity, lane, &plane.eccentricity);
    }
}

/// Returns D2, D3 and D4: the coefficients of the higher powers of the shrinking.
fn shrinking(c1: f64, axis: f64, xi: f64, s: f64) -> [f64; 3] {
    let d2 = 4.0 * axis * xi * c1 * c1;
    let third = d2 * xi * c1 / 3.0;
    let d3 = (17.0 * axis + s) * third;
    let d4 = 0.5 * third * axis * xi * (221.0 * axis + 31.0 * s) * c1;
    [d2, d3, d4]
}

/// Effect of the flattening on the angles, radians per minute.
struct Precession {
    /// Factor of the other terms: three halves of J2 n / p².
    first: f64,
    node: f64,
    perigee: f64,
    /// Change of the mean anomaly, including the mean motion itself.
    anomaly: f64,
}

impl Precession {
    fn new(orbit: &sgp4::Orbit, axis: f64) -> Self {
        let n = orbit.mean_motion;
        let round = 1.0 - orbit.eccentricity * orbit.eccentricity;
        let theta = orbit.inclination.cos();
        let theta2 = theta * theta;
        let theta4 = theta2 * theta2;
        let inverse_parameter2 = (axis * round).powi(-2);
        let first = 1.5 * WGS72.j2 * inverse_parameter2 * n;
        let second = 0.5 * first * WGS72.j2 * inverse_parameter2;
        let fourth = -0.468_75 * WGS72.j4 * inverse_parameter2 * inverse_parameter2 * n;
        Self {
            first,
            node: theta
                * (-first
                    + 0.5 * second * (4.0 - 19.0 * theta2)
                    + 2.0 * fourth * (3.0 - 7.0 * theta2)),
            perigee: -0.5 * first * (1.0 - 5.0 * theta2)
                + 0.0625 * second * (7.0 - 114.0 * theta2 + 395.0 * theta4)
                + fourth * (3.0 - 36.0 * theta2 + 49.0 * theta4),
            anomaly: n + round.sqrt()
                * (0.5 * first * (3.0 * theta2 - 1.0)
                    + 0.0625 * second * (13.0 - 78.0 * theta2 + 137.0 * theta4)),
        }
    }
}

/// Returns the value of a polynomial at `t`, its first derivative and half its second derivative.
pub(crate) fn expand<const N: usize>(polynomial: &[f64; N], t: f64) -> [f64; 3] {
    let start = [0.0; 3];
    polynomial.iter().rev().fold(start, |[value, slope, half_curve], coefficient| {
        [value * t + coefficient, slope * t + value, half_curve * t + slope]
    })
}
