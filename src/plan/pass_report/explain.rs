//! What would explain the pointing error of a pass: each cause is fitted alone, by least squares
//! on the sphere, to all positions near the satellite.

#[cfg(test)]
mod tests;

use glam::DVec3;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{
        Angle, AzEl, Site,
        time::{add_seconds, seconds_between},
    },
    orbit::Propagator,
};

/// Positions further from the satellite are a slew, or no track at all, degrees.
const NEAR_DEG: f64 = 10.0;
/// Least time between two positions that are used, seconds.
const STEP_S: f64 = 0.95;
/// Fewer positions explain nothing.
const FEWEST: usize = 20;
/// Most rounds of a fit; most need three.
const ROUNDS: usize = 8;
/// A cause that explains less is none.
const LEAST_SHARE: f64 = 0.3;
/// A cause that explains as much is told while a pass goes on.
const WELL: f64 = 0.8;
/// Two causes whose sums of squares differ by less than this many times the square of the noise
/// are not told apart: one in a hundred by chance (chi-squared, two degrees of freedom).
const ALIKE: f64 = 9.2;
/// A cause that improves the sum of squares by less than this many times the square of the noise may
/// be chance, of which there are several causes' worth.
const SURE: f64 = 30.0;
/// Slowest and fastest drive that is looked for, degrees per second.
const RATES_DEG_S: (f64, f64) = (0.05, 20.0);

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
    /// The drives turn no faster.
    SlowDrives {
        rate_deg_s: f64,
    },
}

/// How well a cause explains the error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    #[serde(flatten)]
    pub cause: Cause,
    /// Root mean square of what is left, degrees.
    pub left_deg: f64,
    /// Share of the mean square that it explains of what is not noise, 0 to 1.
    pub share: f64,
    /// These positions do not tell it from the best one.
    pub is_alike: bool,
}

/// The one cause that explains an error well, while a pass goes on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Explained {
    pub cause: Cause,
    /// Share of the error that it explains, 0 to 1.
    pub share: f64,
    /// The error, root mean square, degrees.
    pub error_deg: f64,
}

/// A position with its satellite.
#[derive(Debug, Clone, Copy)]
struct Point {
    time: Timestamp,
    satellite: AzEl,
    /// Azimuth of the satellite, continued over north, degrees.
    azimuth_deg: f64,
    /// Measured minus predicted direction, as vectors of the sphere.
    error: DVec3,
    measured: AzEl,
}

/// The positions of a pass, and what the satellite did.
pub struct Evidence<'a> {
    propagator: &'a Propagator,
    site: Site,
    points: Vec<Point>,
    has_elevation: bool,
}

/// A family of causes with up to two sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    Late,
    Azimuth,
    Elevation,
    Tilt,
    AzimuthScale,
    ElevationScale,
}

impl Family {
    const ALL: [Self; 6] = [
        Self::Late,
        Self::Azimuth,
        Self::Elevation,
        Self::Tilt,
        Self::AzimuthScale,
        Self::ElevationScale,
    ];

    /// Small steps of its sizes.
    fn steps(self) -> &'static [f64] {
        match self {
            Self::Late => &[0.01],
            Self::Tilt => &[1e-3, 1e-3],
            _ => &[1e-3],
        }
    }

    fn needs_elevation(self) -> bool {
        matches!(self, Self::Elevation | Self::Tilt | Self::ElevationScale)
    }

    fn cause(self, sizes: [f64; 2]) -> Cause {
        let [first, second] = sizes;
        match self {
            Self::Late => Cause::Late { late_s: first },
            Self::Azimuth => Cause::AzimuthOffset { offset_deg: first },
            Self::Elevation => Cause::ElevationOffset { offset_deg: first },
            Self::Tilt => Cause::Tilt { north_deg: first, east_deg: second },
            Self::AzimuthScale => Cause::AzimuthScale { per_mille: first },
            Self::ElevationScale => Cause::ElevationScale { per_mille: first },
        }
    }
}

impl<'a> Evidence<'a> {
    /// Evidence of measured directions, oldest first. `has_elevation`: the antenna measures its
    /// elevation; else that of the satellite stands in its place.
    pub fn new(
        propagator: &'a Propagator,
        site: Site,
        measured: impl Iterator<Item = (Timestamp, AzEl)>,
        has_elevation: bool,
    ) -> Self {
        let mut points: Vec<Point> = Vec::new();
        for (time, mut measured) in measured {
            if points.last().is_some_and(|last| seconds_between(last.time, time) < STEP_S) {
                continue;
            }
            let Ok(look) = propagator.look_from(site, time) else { continue };
            let satellite = look.direction;
            if !has_elevation {
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
            points.push(Point { time, satellite, azimuth_deg, error, measured });
        }
        Self { propagator, site, points, has_elevation }
    }

    /// All causes that explain a good part of the error, the best first; empty where none does.
    /// `others`: other elements of the satellite with their epochs.
    pub fn explanations(&self, others: &[(Timestamp, Propagator)]) -> Vec<Explanation> {
        let whole = self.sum(|point| Some(point.satellite));
        if self.points.len() < FEWEST || whole <= 0.0 {
            return Vec::new();
        }
        let mut found: Vec<(Cause, f64)> = Family::ALL
            .into_iter()
            .filter(|family| self.has_elevation || !family.needs_elevation())
            .map(|family| {
                let sizes = self.fitted(family);
                (family.cause(sizes), self.sum(|point| self.modelled(family, sizes, point)))
            })
            .collect();
        found.extend(others.iter().map(|(epoch, other)| {
            let look = |point: &Point| Some(other.look_from(self.site, point.time).ok()?.direction);
            (Cause::OtherElements { epoch: *epoch }, self.sum(look))
        }));
        let rate_deg_s = self.fitted_rate();
        found.push((Cause::SlowDrives { rate_deg_s }, self.sum_of_slow(rate_deg_s)));
        found.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        let count = self.points.len() as f64;
        let best = found.first().map_or(whole, |(_, left)| *left);
        let noise = self.noise().min(best);
        let systematic = whole - noise;
        // Of one of two measured angles of a position; what no cause explains blurs as noise does.
        let square = best / (2.0 * count);
        let sure = found.into_iter().filter(|(_, left)| whole - left > SURE * square);
        let explained = sure.map(|(cause, left)| Explanation {
            cause,
            left_deg: (left / count).sqrt().to_degrees(),
            share: if systematic > 0.0 { (whole - left) / systematic } else { 0.0 },
            is_alike: left - best <= ALIKE * square,
        });
        explained.filter(|it| it.share >= LEAST_SHARE).collect()
    }

    /// The cause of an error of at least `least_deg`, if there is one that explains it well and
    /// that the positions tell from all others.
    pub fn explained(&self, least_deg: f64) -> Option<Explained> {
        let square = self.sum(|point| Some(point.satellite)) / self.points.len().max(1) as f64;
        let error_deg = square.sqrt().to_degrees();
        if error_deg < least_deg {
            return None;
        }
        let found = self.explanations(&[]);
        let (best, others) = found.split_first()?;
        let is_alone = best.share >= WELL && !others.iter().any(|other| other.is_alike);
        is_alone.then_some(Explained { cause: best.cause, share: best.share, error_deg })
    }

    /// Sum of the squares of what differs from one position to the next: an error that lasts
    /// hardly does.
    fn noise(&self) -> f64 {
        let pairs = self.points.windows(2);
        let between = pairs.filter_map(|pair| match pair {
            [before, after] => Some((after.error - before.error).length_squared() / 2.0),
            _ => None,
        });
        between.sum()
    }

    /// Sum of the squares that are left where the antenna is taken to point as `model` says.
    fn sum(&self, model: impl Fn(&Point) -> Option<AzEl>) -> f64 {
        let left = |point: &Point| {
            let model = model(point).unwrap_or(point.satellite);
            (point.error - (model.to_enu() - point.satellite.to_enu())).length_squared()
        };
        self.points.iter().map(left).sum()
    }

    /// Direction in which an antenna with this cause points.
    fn modelled(&self, family: Family, sizes: [f64; 2], point: &Point) -> Option<AzEl> {
        let [first, second] = sizes;
        let AzEl { azimuth, elevation } = point.satellite;
        let deg = Angle::from_degrees;
        let to = |azimuth: Angle, elevation: Angle| Some(AzEl { azimuth, elevation });
        match family {
            Family::Late => {
                let look = self.propagator.look_from(self.site, add_seconds(point.time, -first));
                look.ok().map(|look| look.direction)
            }
            Family::Azimuth => to(azimuth + deg(first), elevation),
            Family::Elevation => to(azimuth, elevation + deg(first)),
            Family::Tilt => {
                // The axis leans: what it reads is the sky turned about the horizontal.
                let (north, east) = (deg(first).radians(), deg(second).radians());
                let lean = DVec3::new(-north, east, 0.0);
                let at = point.satellite.to_enu();
                Some(AzEl::from_enu(at + lean.cross(at)))
            }
            Family::AzimuthScale => {
                to(azimuth + deg(point.azimuth_deg * first / 1000.0), elevation)
            }
            Family::ElevationScale => {
                to(azimuth, elevation + deg(elevation.degrees() * first / 1000.0))
            }
        }
    }

    /// Sizes of a cause by least squares (Gauss and Newton).
    fn fitted(&self, family: Family) -> [f64; 2] {
        let mut sizes = [0.0; 2];
        let steps = family.steps();
        for _ in 0..ROUNDS {
            let mut normal = [[0.0; 2]; 2];
            let mut right = [0.0; 2];
            for point in &self.points {
                let model = |sizes: [f64; 2]| {
                    let direction = self.modelled(family, sizes, point);
                    direction.unwrap_or(point.satellite).to_enu() - point.satellite.to_enu()
                };
                let here = model(sizes);
                let left = point.error - here;
                let slope = |place: usize| {
                    let step = steps.get(place)?;
                    let mut ahead = sizes;
                    *ahead.get_mut(place)? += step;
                    Some((model(ahead) - here) / *step)
                };
                let slopes = [slope(0), slope(1)].map(Option::unwrap_or_default);
                for (row, of) in normal.iter_mut().zip(slopes) {
                    for (cell, with) in row.iter_mut().zip(slopes) {
                        *cell += of.dot(with);
                    }
                }
                for (cell, of) in right.iter_mut().zip(slopes) {
                    *cell += of.dot(left);
                }
            }
            let [change, other] = solved(normal, right);
            sizes = [sizes[0] + change, sizes[1] + other];
            let is_still = |change: f64, place: usize| {
                steps.get(place).is_none_or(|step| change.abs() < step / 10.0)
            };
            if is_still(change, 0) && is_still(other, 1) {
                break;
            }
        }
        sizes
    }

    /// The rate of drives that explains most, degrees per second.
    fn fitted_rate(&self) -> f64 {
        let (mut low, mut high) = (RATES_DEG_S.0.ln(), RATES_DEG_S.1.ln());
        // Coarse, because the sum has flat parts; then between the neighbours of the best.
        let count = 40;
        let at = |step: u32, low: f64, high: f64| {
            low + (high - low) * f64::from(step) / f64::from(count)
        };
        for _ in 0..3 {
            let sums = (0..=count).map(|step| (step, self.sum_of_slow(at(step, low, high).exp())));
            let best = sums.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(step, _)| step);
            let around = (best.saturating_sub(1), (best + 1).min(count));
            (low, high) = (at(around.0, low, high), at(around.1, low, high));
        }
        f64::midpoint(low, high).exp()
    }

    /// Sum of the squares that are left beside an antenna whose axes follow the satellite at this
    /// rate at most.
    fn sum_of_slow(&self, rate_deg_s: f64) -> f64 {
        let mut before: Option<(Timestamp, f64, f64)> = None;
        let mut sum = 0.0;
        for point in &self.points {
            let aim = (point.azimuth_deg, point.satellite.elevation_deg());
            let (azimuth_deg, elevation_deg) = match before {
                None => {
                    let off = (point.measured.azimuth - point.satellite.azimuth).wrapped_180();
                    (aim.0 + off.degrees(), point.measured.elevation_deg())
                }
                Some((time, azimuth_deg, elevation_deg)) => {
                    let most = rate_deg_s * seconds_between(time, point.time);
                    let turned = |from: f64, to: f64| from + (to - from).clamp(-most, most);
                    (turned(azimuth_deg, aim.0), turned(elevation_deg, aim.1))
                }
            };
            before = Some((point.time, azimuth_deg, elevation_deg));
            let direction = AzEl {
                azimuth: Angle::from_degrees(azimuth_deg),
                elevation: Angle::from_degrees(elevation_deg),
            };
            let model = direction.to_enu() - point.satellite.to_enu();
            sum += (point.error - model).length_squared();
        }
        sum
    }
}

/// Solution of two equations, or of the first alone where the second is empty.
fn solved([[a, b], [c, d]]: [[f64; 2]; 2], [right, other]: [f64; 2]) -> [f64; 2] {
    let determinant = a * d - b * c;
    if d == 0.0 {
        return [if a > 0.0 { right / a } else { 0.0 }, 0.0];
    }
    if determinant.abs() < 1e-12 * a * d {
        return [0.0; 2];
    }
    [(right * d - b * other) / determinant, (a * other - c * right) / determinant]
}
