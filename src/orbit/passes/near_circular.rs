//! Passes of near-circular near-earth orbits, whose times follow from geometry without a search.
//!
//! [`Arcs`] gives the times at which the site is near enough to the orbit plane. Within an arc, let
//! u be the angle of the satellite in the plane, from the ascending node, and alpha the same angle
//! of the site. Satellites on these orbits make at least six revolutions a day, so u - alpha only
//! grows. Whenever u - alpha is a whole number of turns, the satellite goes by. There is at most
//! one pass around each such instant, and the exact state at the instant confirms or excludes it.

mod arcs;
mod batch;
mod fly_bys;
mod search;

use self::arcs::Arcs;
pub(super) use self::search::passes;
use super::track::Track;
use crate::{
    astro::{frames::EARTH_RATE_RAD_S, time},
    propagator::{Plane, Secular, WGS72_RADIUS_KM, expand},
};

/// Max share by which the mean distance may change within a window. A greater change is a decay.
const MAX_SHRINKING: f64 = 0.05;
/// Max angle between the site and the point below the satellite, radians. Sites farther away see
/// the satellite for so long that its passes cannot be counted by turns.
const FARTHEST_REACH: f64 = 1.3;
/// Max shift of a satellite by the neglected waves, radians. It includes the difference between
/// geodetic and geocentric zenith.
const MARGIN: f64 = 0.012;
/// Cosine of the max inclination, 179 degrees. Towards 180 degrees, the long-period wave of the
/// latitude grows without bounds.
const MIN_COS_INCLINATION: f64 = -0.999_848;
/// Max shift of the distance by the neglected waves, km.
const RADIUS_MARGIN_KM: f64 = 15.0;

/// Track of a satellite on a near-circular orbit.
pub(super) struct NearCircular<'a> {
    pub(super) track: &'a Track<'a>,
    pub(super) secular: &'a Secular,
    arcs: Arcs,
    /// Max time outside the window of the middle of a pass that still reaches into it, seconds.
    pub(super) half_pass_s: f64,
}

impl<'a> NearCircular<'a> {
    /// Creates the track. Returns `None` if the orbit does not stay near-circular and near-earth
    /// within the window, or if the horizon is too low.
    pub(super) fn new(track: &'a Track<'a>) -> Option<Self> {
        let window = track.window;
        let secular = track.propagator.secular()?;
        if track.propagator.may_be_down_at(track.start_since_epoch_s + window.length_s) {
            return None;
        }
        let minutes = |at_s: f64| (track.start_since_epoch_s + at_s) / 60.0;
        let mut highest = 0.0_f64;
        let (first_axis, _) = secular.size(0.0);
        let wave = secular.eccentricity_wave();
        for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let minutes = minutes(share * window.length_s);
            let (axis, eccentricity) = secular.size(minutes);
            let is_steady = (axis / first_axis - 1.0).abs() < MAX_SHRINKING;
            if !(is_steady && secular.is_near_circular_at(minutes)) {
                return None;
            }
            highest = highest.max(axis * (1.0 + eccentricity + wave));
        }
        let farthest_km = highest * WGS72_RADIUS_KM + RADIUS_MARGIN_KM;
        // This is the lowest angular speed.
        let rate_rad_s = 0.95 * secular.plane.argument[1] / 60.0;
        let turning = EARTH_RATE_RAD_S / rate_rad_s;
        let reach = |elevation: f64| {
            let angle = (window.radius_km * elevation.cos() / farthest_km).acos() - elevation;
            angle + MARGIN + 1.5 * angle * turning * turning
        };
        let Plane { sin_inclination, cos_inclination, .. } = secular.plane;
        let visible = reach(window.aos_elevation);
        let possible = (0.0..FARTHEST_REACH).contains(&visible)
            && sin_inclination >= 0.0
            && cos_inclination > MIN_COS_INCLINATION;
        possible.then(|| Self {
            track,
            secular,
            arcs: Arcs::new(
                window.sin_latitude * cos_inclination,
                window.cos_latitude * sin_inclination,
                reach(window.floor),
            ),
            half_pass_s: visible / (rate_rad_s - 2.0 * EARTH_RATE_RAD_S),
        })
    }

    /// Returns the intervals in which the site is near enough to the plane, in pieces.
    pub(super) fn pieces(&self) -> impl Iterator<Item = (f64, f64)> {
        let end_s = self.track.window.length_s + self.half_pass_s;
        let beta_at = |at_s: f64| {
            let [node, node_rate, _] = expand(&self.secular.plane.node, self.minutes(at_s));
            let beta = self.track.window.sidereal_at(at_s) + self.track.window.longitude - node;
            (beta, EARTH_RATE_RAD_S - node_rate / 60.0)
        };
        let (first, rate) = beta_at(-self.half_pass_s);
        let time_of = move |beta: f64| {
            let guess_s = (beta - first) / rate - self.half_pass_s;
            // The node does not move evenly, so one step of Newton's method follows.
            let (beta_then, rate_there) = beta_at(guess_s);
            guess_s + (beta - beta_then) / rate_there
        };
        // There are two arcs of at most four pieces each in every turn of the Earth, and a turn
        // takes at least three quarters of a day.
        let turns = (end_s + self.half_pass_s) / (0.75 * time::DAY_S) + 3.0;
        self.arcs
            .starting_at(first)
            .take(8 * turns as usize)
            .map(move |(start, end)| {
                (time_of(start).max(-self.half_pass_s), time_of(end).min(end_s))
            })
            .take_while(move |(start_s, _)| *start_s < end_s)
    }

    /// Returns the mean rate from node to node, radians per second.
    pub(super) fn rate_rad_s(&self) -> f64 {
        self.secular.plane.argument[1] / 60.0
    }

    /// Returns the minutes since the epoch.
    fn minutes(&self, at_s: f64) -> f64 {
        (at_s + self.track.start_since_epoch_s) / 60.0
    }
}
