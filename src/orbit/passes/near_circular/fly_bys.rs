//! Times at which a satellite goes by a site near its orbit plane.
//!
//! Let u be the angle of the satellite in the plane and alpha the angle of the site, both from the
//! ascending node. The satellite goes by when x = u - alpha is a whole number of turns. At the
//! greatest elevation, x is not exactly 0, because the site also moves across the plane. With the
//! angle d of the site from the plane, the cosine of the angle between site and satellite is cos d
//! cos x. This cosine is greatest at x' sin x cos d = -d' sin d cos x.

use std::{f64::consts::TAU, ptr};

use super::{
    NearCircular,
    batch::{Batch, SatelliteAt},
};
use crate::{
    astro::frames::EARTH_RATE_RAD_S,
    passes::window::Window,
    propagator::Plane,
    simd::{LANES, Lanes, Number, series},
};

/// Max last step of Newton's method, radians. The method squares its error, so after a step this
/// small, the remaining error is some seconds of the satellite's motion.
const LAST_STEP_RAD: f64 = 0.15;
const MAX_STEPS: usize = 4;
/// Overlap of touching pieces beyond their ends, as a share of a revolution. A fly-by found in both
/// pieces is used once.
const OVERLAP: f64 = 0.02;
/// Max number of revolutions in a piece. The lowest orbit makes fewer in the longest piece, a
/// quarter of a day. An object with more revolutions has no orbit, and must not determine the
/// memory in use.
const MAX_IN_PIECE: u32 = 8;
/// Min share of a revolution before a satellite returns.
const MIN_GAP: f64 = 0.3;

/// Satellite and site in the plane of the orbit, radians from the ascending node.
struct InPlane {
    /// Angle counted from 0 at the epoch, minus the lead at the greatest elevation.
    satellite: Lanes,
    /// Angle from -pi to pi.
    site: Lanes,
    /// Change of the difference between the two angles, per second.
    rate: Lanes,
}

/// Returns approximate times at which satellites go by near the window, ordered by satellite, then
/// by time. If pieces touch, the list may contain a fly-by twice.
#[inline(always)]
pub(super) fn guesses<'a>(
    window: &Window,
    satellites: impl Iterator<Item = &'a NearCircular<'a>>,
    batch: &mut Batch,
    cancelled: &dyn Fn() -> bool,
) -> Vec<SatelliteAt<'a>> {
    let mut ends = Vec::new();
    for satellite in satellites {
        let overlap_s = OVERLAP * TAU / satellite.rate_rad_s();
        for (start_s, end_s) in satellite.pieces() {
            if cancelled() {
                return Vec::new();
            }
            let end = |at_s: f64| SatelliteAt { satellite, at_s };
            ends.extend([end(start_s - overlap_s), end(end_s + overlap_s)]);
        }
    }
    let mut guesses = Vec::with_capacity(2 * ends.len());
    for ends in ends.chunks(LANES) {
        let at_s = batch.take_planes(ends);
        guess(ends, &batch.in_plane(window, at_s), &mut guesses);
    }
    guesses
}

impl SatelliteAt<'_> {
    /// Returns `true` if both are the same fly-by.
    pub(super) fn is_same(&self, before: &Self) -> bool {
        ptr::eq(self.satellite, before.satellite)
            && (self.at_s - before.at_s) * self.satellite.rate_rad_s() < MIN_GAP * TAU
    }
}

/// Guesses fly-bys from the starts and ends of pieces: x grows steadily from start to end.
fn guess<'a>(ends: &[SatelliteAt<'a>], in_plane: &InPlane, guesses: &mut Vec<SatelliteAt<'a>>) {
    let (satellite, site) = (in_plane.satellite.as_array(), in_plane.site.as_array());
    for ((ends, satellite), site) in
        ends.chunks_exact(2).zip(satellite.chunks_exact(2)).zip(site.chunks_exact(2))
    {
        let ([start, end], [begin, last], [site_from, site_to]) = (ends, satellite, site) else {
            return;
        };
        // A piece is at most a quarter of a turn of the Earth, so the site moves by less
        // than half a turn.
        let growth = last - begin - wrapped(site_to - site_from);
        let first = begin - site_from;
        let turn = (first / TAU).ceil();
        let count = ((first + growth) / TAU).floor() - turn + 1.0;
        guesses.extend((0..(count as u32).min(MAX_IN_PIECE)).map(|index| {
            let share = (TAU * (turn + f64::from(index)) - first) / growth;
            SatelliteAt { at_s: start.at_s + share * (end.at_s - start.at_s), ..*start }
        }));
    }
}

impl Batch {
    /// Returns the instants of the fly-bys, accurate to some seconds, by Newton's method.
    #[inline(always)]
    pub(super) fn refined(&self, window: &Window, guesses_s: Lanes) -> Lanes {
        let mut at_s = guesses_s;
        for _ in 0..MAX_STEPS {
            let InPlane { satellite, site, rate } = self.in_plane(window, at_s);
            let ahead = wrapped(satellite - site);
            at_s = at_s - ahead / rate;
            if !Number::abs(ahead).any_reaches(LAST_STEP_RAD) {
                break;
            }
        }
        at_s
    }

    #[inline(always)]
    fn in_plane(&self, window: &Window, at_s: Lanes) -> InPlane {
        let Plane { sin_inclination, cos_inclination, node, argument, perigee, eccentricity } =
            &self.secular.plane;
        let (sin_inclination, cos_inclination) = (*sin_inclination, *cos_inclination);
        let (sin_latitude, cos_latitude) = (window.sin_latitude, window.cos_latitude);
        let minutes = self.minutes(at_s);
        let beta = window.sidereal_at(at_s) - series(node, minutes) + window.longitude;
        let (sin_beta, cos_beta) = Number::sin_cos(beta);
        let beta_rate = node[1] * (-1.0 / 60.0) + EARTH_RATE_RAD_S;

        // The axes of the plane are towards the node, across it, and along the normal.
        let along = cos_beta * cos_latitude;
        let across = sin_beta * cos_inclination * cos_latitude + sin_inclination * sin_latitude;
        let normal = cos_inclination * sin_latitude - sin_beta * sin_inclination * cos_latitude;
        let in_plane2 = -(normal * normal) + 1.0;
        let site_rate = (sin_beta * sin_inclination * sin_latitude
            + cos_inclination * cos_latitude)
            * beta_rate
            * cos_latitude
            / in_plane2;

        let latitude = series(argument, minutes);
        let anomaly = latitude - series(perigee, minutes);
        let (sin_anomaly, cos_anomaly) = Number::sin_cos(anomaly);
        let eccentricity = series(eccentricity, minutes);
        let (e_sin, e_cos) = (eccentricity * sin_anomaly, eccentricity * cos_anomaly);
        let [_, argument_rate, half_acceleration, ..] = *argument;
        let mean_rate = (minutes * half_acceleration * 2.0 + argument_rate) * (1.0 / 60.0);
        let rate = mean_rate * (e_cos * 2.0 + 1.0) - site_rate;
        let approach = cos_beta * sin_inclination * beta_rate * cos_latitude;
        let lead = normal * approach / (in_plane2 * rate);
        InPlane {
            satellite: latitude + e_sin * 2.0 * (e_cos * 1.25 + 1.0) - lead,
            site: Number::atan2(across, along),
            rate,
        }
    }
}

/// Returns the angle minus whole turns, -pi to pi.
#[inline(always)]
fn wrapped<N: Number>(angle: N) -> N {
    angle - (angle * (1.0 / TAU)).nearest() * TAU
}
