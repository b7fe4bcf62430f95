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
    orbit::{
        lanes::{Number, series},
        propagator::expand,
    },
};

/// The slow motion around one instant, linear but for the drag.
pub(super) struct Piece<'a> {
    circular: &'a Circular<'a>,
    middle_s: f64,
    beta: f64,
    beta_rate: f64,
    /// Mean angle in the plane, its rate, and half its acceleration.
    argument: [f64; 3],
    /// Eccentricity along the direction of the node, and across.
    toward_node: f64,
    across_node: f64,
    pub(super) revolution_s: f64,
}

impl<'a> Piece<'a> {
    pub(super) fn new(circular: &'a Circular<'a>, middle_s: f64) -> Self {
        let secular = circular.secular;
        let minutes = circular.minutes(middle_s);
        let [node, node_rate, _] = expand(&secular.node, minutes);
        let [argument, argument_rate, half_acceleration] = expand(&secular.argument, minutes);
        let (sin_perigee, cos_perigee) = series(&secular.perigee, minutes).sin_cos();
        let eccentricity = series(&secular.eccentricity, minutes);
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
    pub(super) fn fly_bys(&self, start_s: f64, end_s: f64) -> impl Iterator<Item = f64> {
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
        let (sin_beta, cos_beta) = Number::sin_cos(self.beta + self.beta_rate * since_s);
        let [argument, argument_rate, half_acceleration] = self.argument;
        let mean_rate = argument_rate + 2.0 * half_acceleration * since_s;
        let (sin_mean, cos_mean) =
            Number::sin_cos(argument + (argument_rate + half_acceleration * since_s) * since_s);

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
