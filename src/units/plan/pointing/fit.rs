//! Fit of a pointing model to points, by least squares on the sphere.
//!
//! An interval allows for noise that successive points of a pass share and for a time error of each
//! pass. Passes count as independent of each other.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    least_squares::{Estimate, LeftOutTerm, Normal, Square},
    run::{Noise, PointRun},
};
use crate::astro::{AzEl, PointingModel, Site, Term, sun_moon};

/// Number of rounds of a fit: each round leaves less than a tenth of the previous error, and finds
/// terms of some degrees to a millionth.
const ROUNDS: usize = 12;
/// Min number of points that determine the noise besides eight terms.
const MIN_POINTS: usize = 8;
/// Max elevation of points that determine the azimuth, degrees.
const HIGHEST_DEG: f64 = 88.0;
/// Min noise of a point, degrees: a smaller value would exceed the precision of the arithmetic.
const MIN_NOISE_DEG: f64 = 1e-7;
/// Max change of a term by an omitted term, as a share of its standard deviation, for which its
/// interval still holds.
const HIDDEN: f64 = 0.3;
/// Min number of peaks that can prove a noise below [`BY_HAND_DEG`].
const FEW: usize = 5;
const BY_HAND_DEG: f64 = 0.1;
/// Max difference between the log-likelihoods of a plausible noise and the most likely noise.
const PLAUSIBLE: f64 = 1.0;
/// Quantile of the normal distribution that contains 95 % on both sides.
const NORMAL_95: f64 = 1.959_963_985;

/// Object at which a point was measured. Each kind has its own noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Satellite at one moment of a pass.
    Satellite,
    /// Peak of the Sun's noise.
    Sun,
    /// Peak of the Moon's noise.
    Moon,
}

/// Direction of the beam, and the axis readings at that direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Point {
    pub kind: Kind,
    #[serde(rename = "at")]
    pub time: Timestamp,
    #[serde(rename = "wanted")]
    pub direction: AzEl,
    pub measured: AzEl,
    /// Weight among the points of its kind.
    pub weight: f64,
}

impl Point {
    /// Creates a point at the peak of the Sun's noise, with the direction at this time.
    pub fn of_sun(site: Site, time: Timestamp, measured: AzEl, weight: f64) -> Self {
        Self { kind: Kind::Sun, time, direction: sun_moon::sun(site, time), measured, weight }
    }

    /// Creates a point at the peak of the Moon's noise, with the direction at this time.
    pub fn of_moon(site: Site, time: Timestamp, measured: AzEl, weight: f64) -> Self {
        Self { kind: Kind::Moon, time, direction: sun_moon::moon(site, time), measured, weight }
    }

    /// Returns measured minus modelled angle, of the azimuth on the sky and of the elevation,
    /// degrees.
    pub(super) fn rest_deg(&self, model: &PointingModel) -> Option<[f64; 2]> {
        let reading = model.reading(self.direction)?;
        let azimuth = (self.measured.azimuth - reading.azimuth).wrapped_180().degrees();
        let elevation_deg = (self.measured.elevation - reading.elevation).degrees();
        Some([azimuth * self.direction.elevation.radians().cos(), elevation_deg])
    }

    pub(super) fn is_usable(&self) -> bool {
        let weighs = self.weight.is_finite() && self.weight > 0.0;
        let angles = [self.direction, self.measured]
            .map(|direction| [direction.azimuth, direction.elevation]);
        let is_known = angles.as_flattened().iter().all(|angle| angle.is_finite());
        weighs && is_known && self.direction.elevation_deg().abs() <= HIGHEST_DEG
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CannotFit {
    #[error("{0} usable points are too few")]
    TooFew(usize),
    #[error("no model fits the points; remove peaks of the Sun or the Moon that are far off")]
    Diverges,
}

/// Term with an interval that contains it in at least 95 of 100 cases, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    pub value: f64,
    /// Half width of the interval, in the unit of the term.
    pub half: f64,
}

/// Term that the points cannot distinguish from the named others together. The term counts as zero.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Alike {
    pub term: Term,
    pub others: Vec<Term>,
}

/// Noise of all points of one kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KindNoise {
    pub kind: Kind,
    pub points: usize,
    /// Standard deviation of one axis at the weight 1, degrees, without the time error of each
    /// pass.
    pub noise_deg: f64,
}

impl KindNoise {
    /// Returns the min noise of a point, degrees. A few peaks do not determine their noise.
    fn min_deg(&self) -> f64 {
        let are_few_peaks = self.kind != Kind::Satellite && self.points < FEW;
        if are_few_peaks { BY_HAND_DEG } else { MIN_NOISE_DEG }
    }
}

/// Best model, and its uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    pub model: PointingModel,
    /// Terms that the fit determined; all others are zero.
    pub fitted: Vec<Term>,
    pub alike: Vec<Alike>,
    /// Terms of `fitted` with an unknown uncertainty: a term of `alike`, of any typical size, would
    /// change them by more than a part of the noise.
    pub shared: Vec<Term>,
    pub noise: Vec<KindNoise>,
    covariance: Square<{ Term::COUNT }>,
    /// Largest variance of each term by any plausible noise.
    variances: [f64; Term::COUNT],
    /// Number of equations beyond the unknowns.
    freedom: usize,
}

impl Fit {
    /// Returns the interval of a term; `None` for a term that was not fitted, or that contains a
    /// part of such a term.
    pub fn interval(&self, term: Term) -> Option<Interval> {
        let is_kept = self.fitted.contains(&term) && !self.shared.contains(&term);
        let variance = is_kept.then(|| self.variances.get(term as usize).copied()).flatten()?;
        let half = student_95(self.freedom as f64) * variance.sqrt();
        Some(Interval { value: self.model.term(term), half })
    }

    pub fn covariance(&self, a: Term, b: Term) -> f64 {
        let row = self.covariance.get(a as usize);
        row.and_then(|row| row.get(b as usize)).copied().unwrap_or_default()
    }

    /// Returns the correlation from -1 to 1; `None` if one of the terms was not fitted.
    pub fn correlation(&self, a: Term, b: Term) -> Option<f64> {
        let is_kept = self.fitted.contains(&a) && self.fitted.contains(&b);
        let deviations = (self.covariance(a, a) * self.covariance(b, b)).sqrt();
        is_kept.then(|| self.covariance(a, b) / deviations)
    }
}

/// Fits the terms that the points can distinguish. The others are zero. Each of `runs` contains the
/// points of one pass in order of time, or one peak.
pub fn fit<'a>(
    runs: impl IntoIterator<Item = &'a [Point]>,
    terms: &[Term],
) -> Result<Fit, CannotFit> {
    let is_wanted = |term: &Term| terms.contains(term);
    let unknowns: Vec<usize> =
        (0..).zip(&Term::ALL).filter(|(_, term)| is_wanted(term)).map(|(place, _)| place).collect();
    let runs: Vec<PointRun> = runs.into_iter().map(PointRun::new).collect();
    let points = runs.iter().map(PointRun::len).sum();
    if points < MIN_POINTS {
        return Err(CannotFit::TooFew(points));
    }
    // A peak that is far off gets a small weight from the start; otherwise it would distort the
    // model.
    let noise = noise_of(&runs, &PointingModel::default(), 0);
    let start = Solved { noise, ..Solved::default() };
    let white = solve(&runs, Noise::WHITE, start, |normal| normal.told_apart(&unknowns));
    if !white.is_finite() {
        return Err(CannotFit::Diverges);
    }
    let tried: Vec<(Noise, Estimate<{ Term::COUNT }>)> =
        Noise::all().map(|noise| (noise, white.solution(&runs, noise))).collect();
    // The weights already assume the noise of independent points.
    let unit = tried.first().map_or(1.0, |(_, independent)| independent.variance);
    let is_less = |one: &Estimate<_>, other: &Estimate<_>| {
        one.log_likelihood.total_cmp(&other.log_likelihood)
    };
    let likeliest = tried.iter().max_by(|(_, one), (_, other)| is_less(one, other));
    let (noise, likeliest) = likeliest.ok_or(CannotFit::TooFew(points))?;
    let plausible: Vec<Square<{ Term::COUNT }>> = tried
        .iter()
        .filter(|(_, other)| other.log_likelihood >= likeliest.log_likelihood - PLAUSIBLE)
        .map(|(_, other)| other.scaled_covariance(unit))
        .collect();
    let variances = std::array::from_fn(|term| {
        let own = plausible.iter().filter_map(|covariance| covariance.get(term)?.get(term));
        own.copied().fold(0.0, f64::max)
    });
    let covariance = likeliest.scaled_covariance(unit);
    let solved =
        solve(&runs, *noise, white.clone(), |_| (white.retained.clone(), white.left_out.clone()));
    let solved = if solved.is_finite() { solved } else { white.clone() };
    let solved = Solved { covariance, ..solved };
    let Solved { model, retained, left_out, noise, freedom, .. } = &solved;
    let named = |places: &[usize]| -> Vec<Term> {
        places.iter().filter_map(|place| Term::ALL.get(*place).copied()).collect()
    };
    let alike = left_out.iter().filter_map(|out| {
        Some(Alike { term: *Term::ALL.get(out.unknown)?, others: named(&out.named) })
    });
    let shared: Vec<usize> =
        retained.iter().copied().filter(|unknown| solved.shares(*unknown)).collect();
    Ok(Fit {
        model: *model,
        fitted: named(retained),
        alike: alike.collect(),
        shared: named(&shared),
        noise: noise.clone(),
        covariance,
        variances,
        freedom: *freedom,
    })
}

/// Fits the terms that `select` keeps to points with this noise, starting at `solved`.
fn solve(
    runs: &[PointRun],
    noise: Noise,
    mut solved: Solved,
    select: impl Fn(&Normal<{ Term::COUNT }>) -> (Vec<usize>, Vec<LeftOutTerm>),
) -> Solved {
    for _ in 0..ROUNDS {
        let (normal, log_scale) = solved.normal(runs, noise);
        let (retained, left_out) = select(&normal);
        let solution = normal.solve(&retained, log_scale);
        for (index, (term, step)) in Term::ALL.into_iter().zip(solution.values).enumerate() {
            let place = solved.model.place(term);
            *place = if retained.contains(&index) { *place + step } else { 0.0 };
        }
        solved.noise = noise_of(runs, &solved.model, retained.len());
        solved.freedom = normal.freedom(retained.len());
        let typical_change =
            |out: &LeftOutTerm| Term::ALL.get(out.unknown).map_or(0.0, |term| typical_size(*term));
        let moves = |out: &LeftOutTerm| {
            let moves = normal.moves(&retained, out).into_iter();
            moves.map(|(unknown, share)| (unknown, share * typical_change(out))).collect::<Vec<_>>()
        };
        solved.moves = left_out.iter().flat_map(moves).collect();
        (solved.retained, solved.left_out) = (retained, left_out);
    }
    solved
}

#[derive(Debug, Clone, Default)]
struct Solved {
    model: PointingModel,
    retained: Vec<usize>,
    left_out: Vec<LeftOutTerm>,
    /// Retained unknowns, and the plausible change of each by an omitted term.
    moves: Vec<(usize, f64)>,
    noise: Vec<KindNoise>,
    covariance: Square<{ Term::COUNT }>,
    freedom: usize,
}

impl Solved {
    /// Returns `false` if the fit has diverged.
    fn is_finite(&self) -> bool {
        Term::ALL.into_iter().all(|term| self.model.term(term).is_finite())
    }

    /// Returns the equations at the current model, and the logarithm of the determinant of their
    /// scale.
    fn normal(&self, runs: &[PointRun], noise: Noise) -> (Normal<{ Term::COUNT }>, f64) {
        let deviation_deg = |kind: Kind| {
            let found = self.noise.iter().find(|found| found.kind == kind);
            found.map_or(1.0, |found| found.noise_deg.max(found.min_deg()))
        };
        let mut normal = Normal::new();
        let add = |run: &PointRun| run.add_to(&mut normal, &self.model, noise, deviation_deg);
        let log_scale = runs.iter().map(add).sum();
        (normal, log_scale)
    }

    /// Runs one more round with another noise.
    fn solution(&self, runs: &[PointRun], noise: Noise) -> Estimate<{ Term::COUNT }> {
        let (normal, log_scale) = self.normal(runs, noise);
        normal.solve(&self.retained, log_scale)
    }

    /// Returns `true` if an omitted term may change the unknown `index` by more than the noise
    /// hides.
    fn shares(&self, index: usize) -> bool {
        let variance = self.covariance.get(index).and_then(|row| row.get(index)).copied();
        let hidden = HIDDEN * variance.unwrap_or_default().sqrt();
        self.moves.iter().any(|(unknown, moved)| *unknown == index && moved.abs() > hidden)
    }
}

/// Returns a typical size of a term, in its unit.
fn typical_size(term: Term) -> f64 {
    if term == Term::ElevationScale { 0.005 } else { 0.5 }
}

/// Returns the noise of each kind, corrected for its share of the unknowns.
fn noise_of(runs: &[PointRun], model: &PointingModel, unknowns: usize) -> Vec<KindNoise> {
    let points: usize = runs.iter().map(PointRun::len).sum();
    let free_share = 1.0 - unknowns as f64 / (2 * points) as f64;
    let residuals: Vec<_> = runs.iter().map(|run| run.residuals_deg(model)).collect();
    let noise_of_kind = |kind: Kind| {
        let (mut count, mut times, mut sum) = (0, 0, 0.0);
        for (points, is_timed) in &residuals {
            let own = || points.iter().filter(|(other, ..)| *other == kind);
            times += usize::from(*is_timed && own().next().is_some());
            for (_, weight, [a, b]) in own() {
                count += 1;
                sum += weight * (a * a + b * b);
            }
        }
        let free = 2.0 * count as f64 * free_share - times as f64;
        let noise_deg = (sum / free.max(1.0)).sqrt();
        (count > 0).then_some(KindNoise { kind, points: count, noise_deg })
    };
    [Kind::Satellite, Kind::Sun, Kind::Moon].into_iter().filter_map(noise_of_kind).collect()
}

/// Returns the quantile of Student's distribution that contains 95 % on both sides, by its
/// expansion for many degrees of freedom.
fn student_95(freedom: f64) -> f64 {
    let z = NORMAL_95;
    let first = (z.powi(3) + z) / 4.0;
    let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
    z + first / freedom + second / freedom.powi(2)
}
