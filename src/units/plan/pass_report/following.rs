//! Times at which an antenna moved along with its satellite, on it or beside it.

use jiff::Timestamp;

use super::{TrackPoint, TrackedPass};
use crate::astro::time::seconds_between;

/// Max difference between the motions of an antenna and its satellite while it moves along, as a
/// share of the motion.
const SHARE: f64 = 0.25;
/// Min motion that counts, in half beamwidths: noise dominates a smaller motion.
const MIN_MOTION: f64 = 0.2;
/// Min path over which an antenna must move along, at least half the beamwidth, degrees. An axis
/// with a constant rate matches the rate of its satellite only for a moment.
const WAY_DEG: f64 = 5.0;
/// Max time over which Azel compares the motions of a slow satellite, seconds.
const MAX_S: f64 = 120.0;

/// Times at which an antenna reached and left its satellite; both are `None` for an antenna that
/// never did. An antenna that moves along beside its satellite has reached it: its error is a
/// pointing error. An antenna that follows from the first position, or to the last, gets the min or
/// max time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Following {
    pub(super) start: Option<Timestamp>,
    pub(super) end: Option<Timestamp>,
}

impl TrackedPass<'_> {
    /// Returns the times of following for `points`, in order.
    pub(super) fn following(&self, points: &[&TrackPoint]) -> Following {
        let backwards: Vec<&TrackPoint> = points.iter().rev().copied().collect();
        Following {
            start: self.first_on_track(points, Timestamp::MIN),
            end: self.first_on_track(&backwards, Timestamp::MAX),
        }
    }

    /// Returns the time of the first of `points` at which the antenna follows; `always` if that is
    /// the first of all points.
    fn first_on_track(&self, points: &[&TrackPoint], always: Timestamp) -> Option<Timestamp> {
        let half_deg = self.limits.half_beam.degrees();
        // The short path determines the time, and the long path excludes a coincidence.
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

    /// Returns `true` if antenna and satellite moved equally between two positions.
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

/// Returns the motion of the satellite between two positions, degrees.
fn moved_deg(one: &TrackPoint, other: &TrackPoint) -> f64 {
    one.satellite.separation(other.satellite).degrees()
}
