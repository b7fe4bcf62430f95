//! When an antenna moved along with its satellite, on it or beside it.

use jiff::Timestamp;

use super::{TrackPoint, TrackedPass};
use crate::astro::time::seconds_between;

/// An antenna that moves along with its satellite differs from its motion by no more than this share
/// of it.
const SHARE: f64 = 0.25;
/// Least motion that counts, in half beamwidths: below it, noise would decide.
const MIN_MOTION: f64 = 0.2;
/// Way over which an antenna moves along, at least half the beamwidth, degrees: an axis that turns
/// evenly has the rate of its satellite for a moment only.
const WAY_DEG: f64 = 5.0;
/// Longest time in which the motions of a slow satellite are compared, seconds.
const MAX_S: f64 = 120.0;

/// When an antenna reached its satellite, and when it left it. Both are `None` for an antenna that never
/// did. An antenna that moves along beside its satellite has reached it: its error is one of pointing.
/// One that did so from the first position on, or to the last, has no such time of its own.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Following {
    pub(super) start: Option<Timestamp>,
    pub(super) end: Option<Timestamp>,
}

impl TrackedPass<'_> {
    /// How the antenna followed at `points`, in order.
    pub(super) fn following(&self, points: &[&TrackPoint]) -> Following {
        let backwards: Vec<&TrackPoint> = points.iter().rev().copied().collect();
        Following {
            start: self.first_on_track(points, Timestamp::MIN),
            end: self.first_on_track(&backwards, Timestamp::MAX),
        }
    }

    /// The time of the first of `points` from which on the antenna follows; `always` if that is the
    /// first of all.
    fn first_on_track(&self, points: &[&TrackPoint], always: Timestamp) -> Option<Timestamp> {
        let half_deg = self.limits.half_beam.degrees();
        // The short way tells the moment, and the long one that it was no coincidence.
        let mut ways = [(half_deg, 0), (half_deg.max(WAY_DEG), 0)];
        let on_track = points.iter().enumerate().find(|(index, point)| {
            self.is_in_beam(point)
                || ways.iter_mut().all(|(way_deg, end)| {
                    *end = (*index).max(*end);
                    let is_far = |other: &TrackPoint| {
                        moved_deg(point, other) >= *way_deg
                            || seconds_between(point.time, other.time).abs() >= MAX_S
                    };
                    while points.get(*end).is_some_and(|other| !is_far(other)) {
                        *end += 1;
                    }
                    let last = points
                        .last()
                        .filter(|last| moved_deg(point, last) >= MIN_MOTION * half_deg);
                    points.get(*end).or(last).is_some_and(|other| self.moves_along(point, other))
                })
        });
        on_track.map(|(index, point)| if index == 0 { always } else { point.time })
    }

    /// Returns `true` if antenna and satellite made the same way between two positions.
    fn moves_along(&self, one: &TrackPoint, other: &TrackPoint) -> bool {
        let min_deg = MIN_MOTION * self.limits.half_beam.degrees();
        let moved_deg = moved_deg(one, other).max(min_deg);
        let azimuth_deg = (one.error.azimuth_deg - other.error.azimuth_deg).rem_euclid(360.0);
        let azimuth_deg = azimuth_deg.min(360.0 - azimuth_deg);
        let cosine = |point: &TrackPoint| point.satellite.elevation.radians().cos();
        let across_deg = azimuth_deg * cosine(one).max(cosine(other));
        let up_deg = one.error.elevation_deg - other.error.elevation_deg;
        across_deg.hypot(up_deg) <= SHARE * moved_deg
    }
}

/// The way of the satellite between two positions, degrees.
fn moved_deg(one: &TrackPoint, other: &TrackPoint) -> f64 {
    one.satellite.separation(other.satellite).degrees()
}
