//! Passes of nearly round near-earth orbits: the places to look at follow from
//! geometry, with no search.
//!
//! [`Arcs`] tells when the site is near enough to the orbit plane. Within an arc,
//! let u be the angle of the satellite in the plane, from the ascending node,
//! and alpha the same angle of the site. Satellites of these orbits go around
//! at least six times a day, so u - alpha only grows; whenever it is a whole
//! number of turns, the satellite goes by, and there is at most one pass about
//! each such instant. The exact state there tells whether there is one.
//!
//! The greatest elevation comes where u - alpha is not quite 0, because the site
//! moves across the plane as well: with x = u - alpha and the angle d from the
//! plane, the angle between site and satellite has the cosine cos d cos x, which
//! is greatest where x' sin x cos d = -d' sin d cos x.

use std::f64::consts::TAU;

use super::{
    Pass,
    arcs::Arcs,
    local_series::{Bend, LocalSeries, Place},
    track::Track,
    two_body::TwoBody,
};
use crate::{
    astro::frames::EARTH_RATE_RAD_S,
    orbit::propagator::{Secular, WGS72_RADIUS_KM, expand},
};

/// Rounder orbits than this are worked by geometry.
const MOST_ECCENTRICITY: f64 = 0.05;
/// The mean distance may change by this share within a window; more is a decay.
const MOST_SHRINKING: f64 = 0.05;
/// Orbits that come lower than this, in Earth radii, are about to decay.
const LOWEST_PERIGEE: f64 = 1.012;
/// Sites further than this from below the satellite, in radians, see it for so
/// long that the counting of passes by turns ends.
const FARTHEST_REACH: f64 = 1.3;
/// The waves that are left out, the difference between geodetic and geocentric
/// zenith included, move a satellite by less than this, in radians.
const MARGIN: f64 = 0.012;
/// The waves in the distance that are left out, in km.
const RADIUS_MARGIN_KM: f64 = 15.0;

/// The track of a satellite that geometry can be trusted with.
pub(super) struct Circular<'a> {
    track: &'a Track<'a>,
    secular: &'a Secular,
    sin_inclination: f64,
    cos_inclination: f64,
    arcs: Arcs,
    /// How far outside the window a pass may have its middle and still reach in.
    half_pass_s: f64,
}

impl<'a> Circular<'a> {
    /// `None` when the orbit, or what it becomes within the window, is not round
    /// and near, or when the horizon lies too low.
    pub(super) fn new(track: &'a Track<'a>) -> Option<Self> {
        let window = track.window;
        let secular = track.propagator.secular()?;
        let minutes = |at_s: f64| (track.start_since_epoch_s + at_s) / 60.0;
        let mut highest = 0.0_f64;
        for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let (axis, eccentricity) = secular.size(minutes(share * window.length_s));
            let first = secular.size(0.0).0;
            let wave = secular.eccentricity_wave;
            // Written so that NaN falls out as well.
            let steady = (axis / first - 1.0).abs() < MOST_SHRINKING
                && eccentricity < MOST_ECCENTRICITY
                && eccentricity - wave > 0.0
                && axis * (1.0 - eccentricity - wave) > LOWEST_PERIGEE
                && wave < 0.005;
            if !steady {
                return None;
            }
            highest = highest.max(axis * (1.0 + eccentricity + wave));
        }
        let farthest_km = highest * WGS72_RADIUS_KM + RADIUS_MARGIN_KM;
        // Angular speed at its least.
        let rate_rad_s = 0.95 * secular.argument[1] / 60.0;
        let turning = EARTH_RATE_RAD_S / rate_rad_s;
        let reach = |elevation: f64| {
            let angle = (window.radius_km * elevation.cos() / farthest_km).acos() - elevation;
            angle + MARGIN + 1.5 * angle * turning * turning
        };
        let (sin_inclination, cos_inclination) = secular.inclination.sin_cos();
        let visible = reach(window.horizon);
        let possible = (0.0..FARTHEST_REACH).contains(&visible) && sin_inclination >= 0.0;
        possible.then(|| Self {
            track,
            secular,
            sin_inclination,
            cos_inclination,
            arcs: Arcs::new(
                window.sin_latitude * cos_inclination,
                window.cos_latitude * sin_inclination,
                reach(window.floor),
            ),
            half_pass_s: visible / (rate_rad_s - 2.0 * EARTH_RATE_RAD_S),
        })
    }

    /// All passes of the window, in order.
    pub(super) fn passes(&self, cancelled: &dyn Fn() -> bool) -> Vec<Pass> {
        let mut found = Vec::new();
        let end_s = self.track.window.length_s + self.half_pass_s;
        let mut last_s = f64::NEG_INFINITY;
        for (start_s, piece_end_s) in self.pieces(end_s) {
            if cancelled() {
                break;
            }
            let piece = Piece::new(self, f64::midpoint(start_s, piece_end_s));
            // Touching pieces differ by some hundredths of a turn: both look a
            // little beyond, and what both find is taken once.
            let least_gap_s = 0.3 * piece.revolution_s;
            let overlap_s = 0.02 * piece.revolution_s;
            for guess_s in piece.candidates(start_s - overlap_s, piece_end_s + overlap_s) {
                if guess_s - last_s > least_gap_s {
                    last_s = guess_s;
                    found.extend(self.pass_at(guess_s));
                }
            }
        }
        found
    }

    /// The times in which the site is near enough to the plane, in pieces.
    fn pieces(&self, end_s: f64) -> impl Iterator<Item = (f64, f64)> {
        let beta_at = |at_s: f64| {
            let [node, node_rate, _] = expand(&self.secular.node, self.minutes(at_s));
            let beta = self.track.window.sidereal_at(at_s) + self.track.window.longitude - node;
            (beta, EARTH_RATE_RAD_S - node_rate / 60.0)
        };
        let (first, rate) = beta_at(-self.half_pass_s);
        let time_of = move |beta: f64| {
            let guess_s = (beta - first) / rate - self.half_pass_s;
            // The node does not move quite evenly: one step of Newton's method.
            let (there, rate_there) = beta_at(guess_s);
            guess_s + (beta - there) / rate_there
        };
        self.arcs
            .from(first)
            .map(move |(start, end)| {
                (time_of(start).max(-self.half_pass_s), time_of(end).min(end_s))
            })
            .take_while(move |(start_s, _)| *start_s < end_s)
    }

    fn minutes(&self, at_s: f64) -> f64 {
        (self.track.start_since_epoch_s + at_s) / 60.0
    }

    /// The pass with its middle near `guess_s`, cut to the window.
    fn pass_at(&self, guess_s: f64) -> Option<Pass> {
        let track = self.track;
        let (series, crest) = track.extreme(guess_s, self.half_pass_s, Bend::Crest)?;
        if crest.height.sine < track.window.sin_floor {
            return None;
        }
        let ellipse = TwoBody::new(track.window, &series, &crest);
        let aos = self.edge(&series, &crest, &ellipse, -1.0)?;
        let los = self.edge(&series, &crest, &ellipse, 1.0)?;
        track.cut(&aos, &crest, &los)
    }

    /// AOS for a `side` of -1, LOS for 1.
    fn edge(
        &self,
        series: &LocalSeries,
        crest: &Place,
        ellipse: &TwoBody<'_>,
        side: f64,
    ) -> Option<Place> {
        let guess_tau = ellipse.crossing_tau(side);
        // A grazing pass is over before the series of its crest has worn out.
        if let Some(place) = self.track.crossing_on(series, guess_tau)
            && (place.at_s - crest.at_s) * side > 0.0
        {
            return Some(place);
        }
        let outside_s = crest.at_s + side * 1.1 * self.half_pass_s;
        self.track.crossing(outside_s, series.at_s + guess_tau, crest.at_s)
    }
}

/// The slow motion around one instant, linear but for the drag.
struct Piece<'a> {
    circular: &'a Circular<'a>,
    middle_s: f64,
    beta: f64,
    beta_rate: f64,
    /// Mean angle in the plane, its rate, and half its acceleration.
    argument: [f64; 3],
    /// Eccentricity along the direction of the node, and across.
    toward_node: f64,
    across_node: f64,
    revolution_s: f64,
}

impl<'a> Piece<'a> {
    fn new(circular: &'a Circular<'a>, middle_s: f64) -> Self {
        let secular = circular.secular;
        let minutes = circular.minutes(middle_s);
        let [node, node_rate, _] = expand(&secular.node, minutes);
        let [argument, argument_rate, half_acceleration] = expand(&secular.argument, minutes);
        let (sin_perigee, cos_perigee) = expand(&secular.perigee, minutes)[0].sin_cos();
        let eccentricity = expand(&secular.eccentricity, minutes)[0];
        let window = circular.track.window;
        Self {
            circular,
            middle_s,
            beta: window.sidereal_at(middle_s) + window.longitude - node,
            beta_rate: EARTH_RATE_RAD_S - node_rate / 60.0,
            argument: [argument, argument_rate / 60.0, half_acceleration / 3600.0],
            toward_node: eccentricity * cos_perigee,
            across_node: eccentricity * sin_perigee,
            revolution_s: TAU * 60.0 / argument_rate,
        }
    }

    /// All instants from `start_s` to `end_s` at which the satellite goes by.
    fn candidates(&self, start_s: f64, end_s: f64) -> impl Iterator<Item = f64> {
        let first = self.offset(start_s);
        let behind = if first.angle > 0.0 { TAU - first.angle } else { -first.angle };
        let mut next_s = start_s + behind / first.mean_rate;
        std::iter::from_fn(move || {
            let mut offset = self.offset(next_s);
            // So far off the rates have changed: once more.
            for _ in 0..4 {
                if offset.angle.abs() < 0.15 {
                    break;
                }
                next_s -= offset.angle / offset.rate;
                offset = self.offset(next_s);
            }
            let at_s = next_s - (offset.angle - offset.lead) / offset.rate;
            next_s = at_s + TAU / offset.mean_rate;
            (at_s <= end_s).then_some(at_s)
        })
    }

    /// How far the satellite is ahead of the site in the plane.
    fn offset(&self, at_s: f64) -> Offset {
        let Circular { sin_inclination, cos_inclination, track, .. } = self.circular;
        let (sin_latitude, cos_latitude) = (track.window.sin_latitude, track.window.cos_latitude);
        let since_s = at_s - self.middle_s;
        let (sin_beta, cos_beta) = (self.beta + self.beta_rate * since_s).sin_cos();
        let [argument, argument_rate, half_acceleration] = self.argument;
        let mean_rate = argument_rate + 2.0 * half_acceleration * since_s;
        let (sin_mean, cos_mean) =
            (argument + (argument_rate + half_acceleration * since_s) * since_s).sin_cos();

        // The site in the axes of the plane: to the node, across it, and along
        // the normal.
        let along = cos_latitude * cos_beta;
        let across = cos_latitude * sin_beta * cos_inclination + sin_latitude * sin_inclination;
        let normal = sin_latitude * cos_inclination - cos_latitude * sin_inclination * sin_beta;
        let in_plane2 = 1.0 - normal * normal;
        let site_rate = self.beta_rate
            * cos_latitude
            * (cos_latitude * cos_inclination + sin_latitude * sin_inclination * sin_beta)
            / in_plane2;

        let (e_sin, e_cos) = (
            self.toward_node * sin_mean - self.across_node * cos_mean,
            self.toward_node * cos_mean + self.across_node * sin_mean,
        );
        let ahead =
            angle(sin_mean * along - cos_mean * across, cos_mean * along + sin_mean * across);
        let rate = mean_rate * (1.0 + 2.0 * e_cos) - site_rate;
        let toward = cos_latitude * sin_inclination * cos_beta * self.beta_rate;
        Offset {
            angle: ahead + 2.0 * e_sin * (1.0 + 1.25 * e_cos),
            rate,
            mean_rate: mean_rate - site_rate,
            lead: normal * toward / (in_plane2 * rate),
        }
    }
}

/// Angle from the site to the satellite in the plane, in radians.
struct Offset {
    angle: f64,
    /// Its change per second, now and over a revolution.
    rate: f64,
    mean_rate: f64,
    /// The angle at which the elevation is greatest.
    lead: f64,
}

/// The angle with this sine and cosine, or multiples of them: the series where
/// it is small, which it nearly always is.
fn angle(sine: f64, cosine: f64) -> f64 {
    if sine.abs() < 0.15 * cosine {
        let tangent = sine / cosine;
        let square = tangent * tangent;
        tangent * (1.0 - square * (1.0 / 3.0 - square * (1.0 / 5.0)))
    } else {
        sine.atan2(cosine)
    }
}
