//! What would explain the pointing error of one pass or of several: each cause is fitted alone,
//! and where none suffices with a second one, by least squares on the sphere, to all positions
//! near the satellite.

mod fit;
#[cfg(test)]
mod tests;

use std::mem::discriminant;

use glam::DVec3;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use self::fit::{Family, Found};
use crate::{
    astro::{AzEl, Site, time::seconds_between},
    orbit::Propagator,
    station::Mount,
};

/// Positions further from the satellite are a slew, or no track at all, degrees.
const NEAR_DEG: f64 = 10.0;
/// Least time between two positions that are used, seconds.
const STEP_S: f64 = 0.95;
/// Fewer positions explain nothing.
const FEWEST: usize = 20;
/// An antenna that comes closer to its satellite faster than this is on its way to it, degrees per
/// second. No cause changes an error so fast but drives, and those let it grow first.
const ARRIVES_DEG_S: f64 = 0.1;
/// A cause that explains less is none.
const LEAST_SHARE: f64 = 0.3;
/// A cause is shown during a pass from this share on.
const WELL: f64 = 0.8;
/// Two causes whose sums of squares differ by less than this many times the square of the noise
/// are not told apart: one in a hundred by chance (chi-squared, two degrees of freedom).
const ALIKE: f64 = 9.2;
/// An improvement of the sum of squares by less than this many times the variance of the noise may be
/// chance, since the best of several causes is taken.
const SURE: f64 = 30.0;
/// A second cause is offered where it makes what is left smaller by this share of the error.
const LEAST_MORE: f64 = 0.03;

/// A cause with its size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "cause")]
pub enum Cause {
    /// The antenna points where the satellite is at another time: the clock of the unit is late,
    /// or what is sent takes so long. Negative: early.
    Late {
        late_s: f64,
    },
    /// Of the azimuth: measured minus true.
    AzimuthOffset {
        offset_deg: f64,
    },
    ElevationOffset {
        offset_deg: f64,
    },
    /// The azimuth axis leans to the north and to the east.
    Tilt {
        north_deg: f64,
        east_deg: f64,
    },
    /// The azimuth grows by so much more for each degree that it turns, per thousand.
    AzimuthScale {
        per_mille: f64,
    },
    ElevationScale {
        per_mille: f64,
    },
    /// The antenna follows these elements.
    OtherElements {
        epoch: Timestamp,
    },
    /// The drives turn neither axis faster.
    SlowDrives {
        rate_deg_s: f64,
    },
}

/// How well a cause explains the error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    #[serde(flatten)]
    pub cause: Cause,
    /// What acts together with it; `None` where it was fitted alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with: Option<Cause>,
    /// Root mean square of what is left, degrees.
    pub left_deg: f64,
    /// Share of the mean square that it explains of what is not noise, 0 to 1.
    pub share: f64,
    /// These positions do not tell it from the best one.
    pub is_alike: bool,
}

impl Explanation {
    /// Its one cause or two.
    pub fn causes(&self) -> impl Iterator<Item = &Cause> {
        std::iter::once(&self.cause).chain(&self.with)
    }
}

/// The explanations as a table has them, each with its place among all: two causes together stand below
/// the better of the two, where that stands alone as well.
pub fn below_their_parts(explanations: &[Explanation]) -> Vec<(usize, &Explanation)> {
    let place_of_part = |of: &Explanation| {
        let is_part = |it: &Explanation| {
            let is_same = |cause: &Cause| discriminant(cause) == discriminant(&it.cause);
            it.with.is_none() && of.causes().any(is_same)
        };
        of.with.and_then(|_| explanations.iter().position(is_part))
    };
    let mut rows: Vec<_> = explanations.iter().enumerate().collect();
    rows.sort_by_key(|(place, of)| {
        let part = place_of_part(of);
        (part.unwrap_or(*place), part.is_some())
    });
    rows
}

/// What explains an error well, while a pass goes on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Explained {
    pub by: Explanation,
    /// A cause that the positions so far do not tell from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub or: Option<Cause>,
    /// The error, root mean square, degrees.
    pub error_deg: f64,
}

/// A position with its satellite.
#[derive(Debug, Clone, Copy)]
struct Point<'a> {
    propagator: &'a Propagator,
    site: Site,
    time: Timestamp,
    satellite: AzEl,
    /// Azimuth of the satellite, continued over north, degrees.
    azimuth_deg: f64,
    /// Measured minus predicted direction, as vectors of the sphere.
    error: DVec3,
    measured: AzEl,
}

/// The positions of passes, and what their satellites did.
pub struct Evidence<'a> {
    /// Each in the order of time.
    passes: Vec<Vec<Point<'a>>>,
    mount: Mount,
    has_elevation: bool,
}

impl<'a> Evidence<'a> {
    /// No evidence yet. `has_elevation`: the antenna measures its elevation; else that of the
    /// satellite stands in its place.
    pub fn new(mount: Mount, has_elevation: bool) -> Self {
        Self { passes: Vec::new(), mount, has_elevation }
    }

    /// The same with the measured directions of one more pass, oldest first.
    #[must_use]
    pub fn with_pass(
        mut self,
        propagator: &'a Propagator,
        site: Site,
        measured: impl Iterator<Item = (Timestamp, AzEl)>,
    ) -> Self {
        let mut points: Vec<Point<'a>> = Vec::new();
        for (time, mut measured) in measured {
            if points.last().is_some_and(|last| seconds_between(last.time, time) < STEP_S) {
                continue;
            }
            let Ok(look) = propagator.look_from(site, time) else { continue };
            let satellite = look.direction;
            if !self.has_elevation {
                measured.elevation = satellite.elevation;
            }
            if measured.separation(satellite).degrees() > NEAR_DEG {
                continue;
            }
            let azimuth_deg = match points.last() {
                None => satellite.azimuth.degrees(),
                Some(last) => {
                    let turned = (satellite.azimuth - last.satellite.azimuth).wrapped_180();
                    last.azimuth_deg + turned.degrees()
                }
            };
            let error = measured.to_enu() - satellite.to_enu();
            points.push(Point { propagator, site, time, satellite, azimuth_deg, error, measured });
        }
        let arrives = |pair: &&[Point<'_>]| {
            let [before, after] = pair else { return false };
            let closer = before.error.length() - after.error.length();
            closer.to_degrees() > ARRIVES_DEG_S * seconds_between(before.time, after.time)
        };
        let on_its_way = points.windows(2).take_while(arrives).count();
        self.passes.push(points.split_off(on_its_way));
        self
    }

    fn points(&self) -> impl Iterator<Item = &Point<'a>> {
        self.passes.iter().flatten()
    }

    /// All causes that explain a good part of the error, the best first; empty where none does.
    /// Two causes together are among them only where they explain more than any single one.
    /// `others`: other elements of the satellite with their epochs.
    pub fn explanations(&self, others: &[(Timestamp, Propagator)]) -> Vec<Explanation> {
        let count = self.points().count();
        let whole = self.sum(|point| Some(point.satellite));
        if count < FEWEST || whole <= 0.0 {
            return Vec::new();
        }
        let count = count as f64;
        let families = Family::ALL.into_iter();
        let families = families.filter(|of| self.has_elevation || !of.needs_elevation());
        let families = families.chain(others.iter().map(Family::Elements));
        let mut alone: Vec<(Family<'_>, Found)> =
            families.map(|family| (family, self.fitted(family, None))).collect();
        alone.sort_by(|(_, a), (_, b)| a.left.total_cmp(&b.left));
        let mut found: Vec<Found> = alone.iter().map(|(_, found)| *found).collect();
        found.push(self.slow_drives());
        let single = found.iter().fold(whole, |best, found| best.min(found.left));
        let noise = self.noise();
        let is_less = |left: f64| single.sqrt() - left.sqrt() > LEAST_MORE * whole.sqrt();
        if is_less(noise.min(single)) {
            let mixed = self.mixed(&alone);
            let best = mixed.iter().fold(single, |best, found| best.min(found.left));
            let square = best / (2.0 * count);
            if is_less(best) && single - best > SURE * square {
                found.extend(mixed.into_iter().filter(|it| it.left - best <= ALIKE * square));
            }
        }
        found.sort_by(|a, b| a.left.total_cmp(&b.left));
        let best = found.first().map_or(whole, |best| best.left);
        let systematic = whole - noise.min(best);
        // Of one of two measured angles of a position; what no cause explains blurs as noise does.
        let square = best / (2.0 * count);
        let sure = found.into_iter().filter(|it| whole - it.left > SURE * square);
        let explained = sure.map(|it| Explanation {
            cause: it.cause,
            with: it.with,
            left_deg: (it.left / count).sqrt().to_degrees(),
            share: if systematic > 0.0 { (whole - it.left) / systematic } else { 0.0 },
            is_alike: it.left - best <= ALIKE * square,
        });
        explained.filter(|it| it.share >= LEAST_SHARE).collect()
    }

    /// Two causes together, each pair once. `alone`: what each explains, the best first.
    fn mixed(&self, alone: &[(Family<'_>, Found)]) -> Vec<Found> {
        let is_set = |family: &Family<'_>| matches!(family, Family::Elements(_));
        // An antenna follows one set of elements: only the one that explains most alone is paired.
        let set = alone.iter().map(|(family, _)| *family).find(is_set);
        let families = alone.iter().map(|(family, _)| *family).filter(|of| !is_set(of));
        let families: Vec<Family<'_>> = set.into_iter().chain(families).collect();
        let pairs = families.iter().enumerate().flat_map(|(place, first)| {
            families.iter().skip(place + 1).map(move |second| (*first, *second))
        });
        pairs.map(|(first, second)| self.fitted(first, Some(second))).collect()
    }

    /// What explains an error of at least `least_deg` well, if the positions tell it from all
    /// else, or from all but one. Where they leave several pairs open, it is the cause that all of
    /// these share. `others` as for [`Self::explanations`].
    pub fn explained(
        &self,
        least_deg: f64,
        others: &[(Timestamp, Propagator)],
    ) -> Option<Explained> {
        let square = self.sum(|point| Some(point.satellite)) / self.points().count().max(1) as f64;
        let error_deg = square.sqrt().to_degrees();
        if error_deg < least_deg {
            return None;
        }
        let found = self.explanations(others);
        let mut alike: Vec<&Explanation> = Vec::new();
        for it in found.iter().filter(|it| it.is_alike) {
            // Of several other sets the best one counts.
            let is_same = |of: &&Explanation| {
                [of.with, it.with] == [None; 2]
                    && discriminant(&of.cause) == discriminant(&it.cause)
            };
            if !alike.iter().any(is_same) {
                alike.push(it);
            }
        }
        let mut or = None;
        let by = match alike[..] {
            [one] => one,
            [one, other] if one.with.is_none() && other.with.is_none() => {
                or = Some(other.cause);
                one
            }
            _ => found.iter().find(|it| {
                let is_same = |other: &Cause| discriminant(other) == discriminant(&it.cause);
                it.with.is_none() && alike.iter().all(|alike| alike.causes().any(is_same))
            })?,
        };
        (by.share >= WELL).then_some(Explained { by: *by, or, error_deg })
    }

    /// Sum of the squares of what differs from one position to the next: an error that lasts
    /// hardly does.
    fn noise(&self) -> f64 {
        let pairs = self.passes.iter().flat_map(|points| points.windows(2));
        let between = pairs.filter_map(|pair| match pair {
            [before, after] => Some((after.error - before.error).length_squared() / 2.0),
            _ => None,
        });
        between.sum()
    }

    /// Sum of the squares that are left where the antenna is taken to point as `model` says.
    fn sum(&self, model: impl Fn(&Point<'_>) -> Option<AzEl>) -> f64 {
        let left = |point: &Point<'_>| {
            let model = model(point).unwrap_or(point.satellite);
            (point.error - (model.to_enu() - point.satellite.to_enu())).length_squared()
        };
        self.points().map(left).sum()
    }
}
