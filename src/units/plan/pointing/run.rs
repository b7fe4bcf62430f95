//! Points in order of time, and the noise that successive points share.

use glam::DVec3;

use super::{
    fit::{Kind, Point},
    least_squares::{Equation, Normal},
};
use crate::astro::{AzEl, PointingModel, Term, time::seconds_between};

/// Coefficients of a point in one axis: the terms, the time error, and the residual.
const COLUMNS: usize = Term::COUNT + 2;

/// Noise of each axis: an independent part in each point, and a part whose correlation decays
/// exponentially with time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Noise {
    /// Correlated share of the variance, from 0 to less than 1.
    share: f64,
    /// Time in which the correlation decays to 1/e, seconds.
    time_s: f64,
}

impl Noise {
    pub(super) const WHITE: Self = Self { share: 0.0, time_s: 1.0 };
    const SHARES: [f64; 6] = [0.1, 0.2, 0.4, 0.6, 0.8, 0.99];
    /// Correlation times, seconds, from the time between two points to longer than any pass in a
    /// low orbit.
    const TIMES_S: [f64; 7] = [5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 640.0];

    /// Returns the noises that a fit tries.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let correlated = Self::TIMES_S
            .into_iter()
            .flat_map(|time_s| Self::SHARES.into_iter().map(move |share| Self { share, time_s }));
        std::iter::once(Self::WHITE).chain(correlated)
    }
}

/// Usable points of one pass in order of time, or one peak.
#[derive(Debug)]
pub(super) struct PointRun(Vec<Timed>);

#[derive(Debug)]
struct Timed {
    point: Point,
    /// Time since the first point, seconds.
    at_s: f64,
    /// Rate of the wanted direction, azimuth on the sky and elevation, degrees a second.
    rate_deg_s: [f64; 2],
}

impl PointRun {
    pub(super) fn new(points: &[Point]) -> Self {
        let usable: Vec<Point> = points.iter().copied().filter(Point::is_usable).collect();
        let last = usable.len().saturating_sub(1);
        let timed = usable.iter().enumerate().filter_map(|(index, point)| {
            let at_s = seconds_between(usable.first()?.time, point.time);
            let (before, after) =
                (usable.get(index.saturating_sub(1))?, usable.get((index + 1).min(last))?);
            Some(Timed {
                point: *point,
                at_s,
                rate_deg_s: rate_deg_s(point.direction, before, after),
            })
        });
        Self(timed.collect())
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns the kind, the weight and the residuals of each point, without the best time error.
    /// The flag is `true` if the run has a time error.
    pub(super) fn residuals_deg(
        &self,
        model: &PointingModel,
    ) -> (Vec<(Kind, f64, [f64; 2])>, bool) {
        let rests = self.0.iter().filter_map(|timed| Some((timed, timed.point.rest_deg(model)?)));
        let (mut product, mut square) = (0.0, 0.0);
        for (Timed { point, rate_deg_s, .. }, rest_deg) in rests.clone() {
            for (rate, rest) in rate_deg_s.iter().zip(rest_deg) {
                product += point.weight * rate * rest;
                square += point.weight * rate * rate;
            }
        }
        let is_timed = square > 0.0;
        let late_s = if is_timed { product / square } else { 0.0 };
        let residual =
            |(Timed { point, rate_deg_s: [a, b], .. }, [first, second]): (&Timed, [f64; 2])| {
                (point.kind, point.weight, [first - late_s * a, second - late_s * b])
            };
        (rests.map(residual).collect(), is_timed)
    }

    /// Adds the equations of the run to `normal`, each of unit variance and independent of the
    /// others. `deviation_deg`: standard deviation of an axis at the weight 1. Returns the
    /// logarithm of the determinant of the scale.
    pub(super) fn add_to(
        &self,
        normal: &mut Normal<{ Term::COUNT }>,
        model: &PointingModel,
        noise: Noise,
        deviation_deg: impl Fn(Kind) -> f64,
    ) -> f64 {
        let mut filters = [NoiseFilter::new(noise), NoiseFilter::new(noise)];
        let mut equations = Vec::with_capacity(2 * self.0.len());
        for Timed { point, at_s, rate_deg_s } in &self.0 {
            let Some(rest_deg) = point.rest_deg(model) else { continue };
            let effects = Term::ALL.map(|term| term.effect(point.direction));
            let scale = point.weight.sqrt() / deviation_deg(point.kind);
            let axes = filters.iter_mut().zip(rate_deg_s).zip(rest_deg).enumerate();
            for (axis, ((filter, rate_deg_s), rest_deg)) in axes {
                let effect = |term: usize| effects.get(term).and_then(|axes| axes.get(axis));
                let mut columns: [f64; COLUMNS] =
                    std::array::from_fn(|column| effect(column).copied().unwrap_or_default());
                let [.., own, value] = &mut columns;
                (*own, *value) = (*rate_deg_s, rest_deg);
                equations.push(filter.take(*at_s, columns.map(|column| column * scale)));
            }
        }
        normal.add(&equations);
        filters.iter().map(|filter| filter.log_scale).sum()
    }
}

/// Returns the rate of `direction` between two points, azimuth on the sky and elevation, degrees a
/// second.
fn rate_deg_s(direction: AzEl, before: &Point, after: &Point) -> [f64; 2] {
    let span_s = seconds_between(before.time, after.time);
    if span_s <= 0.0 {
        return [0.0; 2];
    }
    let turned = (after.direction.to_enu() - before.direction.to_enu()) / span_s;
    let (sin_az, cos_az) = direction.azimuth.radians().sin_cos();
    let (sin_el, cos_el) = direction.elevation.radians().sin_cos();
    let clockwise = DVec3::new(cos_az, -sin_az, 0.0);
    let up = DVec3::new(-sin_az * sin_el, -cos_az * sin_el, cos_el);
    [clockwise, up].map(|side| turned.dot(side).to_degrees())
}

/// Filter that makes the successive values of an axis independent: a Kalman filter whose state is
/// the correlated part of the noise. The filter treats all columns equally.
struct NoiseFilter {
    noise: Noise,
    expected: [f64; COLUMNS],
    /// Variance of the expected value.
    variance: f64,
    last_s: Option<f64>,
    log_scale: f64,
}

impl NoiseFilter {
    fn new(noise: Noise) -> Self {
        Self {
            noise,
            expected: [0.0; COLUMNS],
            variance: noise.share,
            last_s: None,
            log_scale: 0.0,
        }
    }

    fn take(&mut self, at_s: f64, columns: [f64; COLUMNS]) -> Equation<{ Term::COUNT }> {
        let Noise { share, time_s } = self.noise;
        if let Some(last_s) = self.last_s.replace(at_s) {
            let decay = (-(at_s - last_s).abs() / time_s).exp();
            self.expected = self.expected.map(|value| value * decay);
            self.variance = share + decay * decay * (self.variance - share);
        }
        let total = self.variance + 1.0 - share;
        let gain = self.variance / total;
        self.log_scale += total.ln();
        let deviation = total.sqrt();
        let mut news = columns;
        for (new, expected) in news.iter_mut().zip(&mut self.expected) {
            *new -= *expected;
            *expected += gain * *new;
            *new /= deviation;
        }
        self.variance *= 1.0 - gain;
        let [row @ .., own, value] = news;
        Equation { row, own, value }
    }
}
