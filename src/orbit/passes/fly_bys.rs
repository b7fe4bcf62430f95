//! When a satellite goes by a site that is near its orbit plane.
//!
//! With the angle u of the satellite in the plane and alpha of the site, both
//! from the ascending node, that is where x = u - alpha is a whole number of
//! turns. The greatest elevation comes where x is not quite 0, because the site
//! moves across the plane as well: with the angle d of the site from the plane,
//! the angle between site and satellite has the cosine cos d cos x, which is
//! greatest where x' sin x cos d = -d' sin d cos x.

use std::f64::consts::TAU;

use super::circular::Circular;
use crate::{
    astro::frames::EARTH_RATE_RAD_S,
    orbit::lanes::{LANES, Lanes, Number, lanes_of, series},
};

/// Newton's method squares its error: after a step this small, in radians, what
/// is left is some seconds of the satellite's way.
const LAST_STEP_RAD: f64 = 0.15;
const MOST_STEPS: usize = 4;
/// Touching pieces both look this share of a revolution beyond, and what both
/// find is taken once.
const OVERLAP: f64 = 0.02;
/// Satellites come again after more than this share of a revolution.
const LEAST_GAP: f64 = 0.3;

/// Satellite and site in the plane of the orbit, in radians from the ascending
/// node.
struct InPlane<N> {
    /// From 0 on at the epoch, less the lead at which the elevation is greatest.
    satellite: N,
    /// -pi to pi.
    site: N,
    /// Change of the difference per second.
    rate: N,
}

impl Circular<'_> {
    /// All instants at which the satellite goes by near the window, to some
    /// seconds, in order.
    pub(super) fn fly_bys(&self, cancelled: &dyn Fn() -> bool) -> Vec<f64> {
        let revolution_s = TAU * 60.0 / self.secular.argument[1];
        let overlap_s = OVERLAP * revolution_s;
        let mut guesses = Vec::with_capacity(LANES);
        let mut pieces = self.pieces();
        while !cancelled() {
            let mut ends = [0.0; LANES];
            let mut count = 0;
            for (ends, (start_s, end_s)) in ends.chunks_exact_mut(2).zip(pieces.by_ref()) {
                ends.copy_from_slice(&[start_s - overlap_s, end_s + overlap_s]);
                count += 2;
            }
            self.guess(ends.get(..count).unwrap_or_default(), &mut guesses);
            if count < LANES {
                break;
            }
        }
        for guesses in guesses.chunks_mut(LANES) {
            let refined = self.refined(lanes_of(guesses));
            guesses.copy_from_slice(refined.as_array().get(..guesses.len()).unwrap_or_default());
        }
        guesses.dedup_by(|next_s, last_s| *next_s - *last_s < LEAST_GAP * revolution_s);
        guesses
    }

    /// Guesses from the starts and ends of up to half as many pieces as there
    /// are lanes: x grows steadily from end to end.
    fn guess(&self, ends: &[f64], guesses: &mut Vec<f64>) {
        let InPlane { satellite, site, .. } = self.in_plane(lanes_of(ends));
        let (satellite, site) = (satellite.as_array(), site.as_array());
        for ((times, satellite), site) in
            ends.chunks_exact(2).zip(satellite.chunks_exact(2)).zip(site.chunks_exact(2))
        {
            let ([start_s, end_s], [from, to], [site_from, site_to]) = (times, satellite, site)
            else {
                return;
            };
            // A piece is a quarter of a turn of the Earth or less: the site goes
            // less than half a turn.
            let growth = to - from - wrapped(site_to - site_from);
            let first = from - site_from;
            let turn = (first / TAU).ceil();
            let count = ((first + growth) / TAU).floor() - turn + 1.0;
            guesses.extend((0..count as u32).map(|index| {
                let share = (TAU * (turn + f64::from(index)) - first) / growth;
                start_s + share * (end_s - start_s)
            }));
        }
    }

    /// By Newton's method.
    fn refined(&self, guesses_s: Lanes) -> Lanes {
        let mut at_s = guesses_s;
        for _ in 0..MOST_STEPS {
            let InPlane { satellite, site, rate } = self.in_plane(at_s);
            let ahead = wrapped(satellite - site);
            at_s -= ahead / rate;
            if !Number::abs(ahead).any_reaches(LAST_STEP_RAD) {
                break;
            }
        }
        at_s
    }

    fn in_plane<N: Number>(&self, at_s: N) -> InPlane<N> {
        let Self { secular, sin_inclination, cos_inclination, .. } = *self;
        let window = self.track.window;
        let (sin_latitude, cos_latitude) = (window.sin_latitude, window.cos_latitude);
        let minutes = self.minutes(at_s);
        let beta = window.sidereal_at(at_s) - series(&secular.node, minutes) + window.longitude;
        let (sin_beta, cos_beta) = beta.sin_cos();
        let beta_rate = EARTH_RATE_RAD_S - secular.node[1] / 60.0;

        // The site in the axes of the plane: to the node, across it, and along
        // the normal.
        let along = cos_beta * cos_latitude;
        let across = sin_beta * (cos_latitude * cos_inclination) + sin_latitude * sin_inclination;
        let normal = sin_beta * (-cos_latitude * sin_inclination) + sin_latitude * cos_inclination;
        let in_plane2 = -(normal * normal) + 1.0;
        let site_rate = (sin_beta * (sin_latitude * sin_inclination)
            + cos_latitude * cos_inclination)
            * (beta_rate * cos_latitude)
            / in_plane2;

        let argument = series(&secular.argument, minutes);
        let (sin_anomaly, cos_anomaly) = (argument - series(&secular.perigee, minutes)).sin_cos();
        let eccentricity = series(&secular.eccentricity, minutes);
        let (e_sin, e_cos) = (eccentricity * sin_anomaly, eccentricity * cos_anomaly);
        let [_, argument_rate, half_acceleration, ..] = secular.argument;
        let mean_rate = (minutes * (2.0 * half_acceleration) + argument_rate) * (1.0 / 60.0);
        let rate = mean_rate * (e_cos * 2.0 + 1.0) - site_rate;
        let toward = cos_beta * (cos_latitude * sin_inclination * beta_rate);
        let lead = normal * toward / (in_plane2 * rate);
        InPlane {
            satellite: argument + e_sin * 2.0 * (e_cos * 1.25 + 1.0) - lead,
            site: across.atan2(along),
            rate,
        }
    }
}

/// The angle less whole turns, -pi to pi.
fn wrapped<N: Number>(angle: N) -> N {
    angle - (angle * (1.0 / TAU)).nearest() * TAU
}
