//! The way of an azimuth axis through a pass: an axis with ends cannot follow
//! every turn of the sky, so the turn on which it starts decides whether it has
//! to swing all the way round in the middle.

use jiff::Timestamp;

use super::Sample;
use crate::astro::Angle;

/// A full turn, degrees.
const TURN_DEG: f64 = 360.0;

/// The ends of an azimuth axis, in degrees from north over east as the axis
/// counts: 0 to 360 for most, 0 to 450 or -180 to 540 for others, or less than a
/// turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AzimuthRange {
    from_deg: f64,
    to_deg: f64,
}

/// Ends between which nothing lies, or that are no numbers.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("an azimuth axis does not travel from {from_deg} to {to_deg}")]
pub struct NoTravel {
    from_deg: f64,
    to_deg: f64,
}

impl AzimuthRange {
    /// An axis from `from_deg` to `to_deg`, which is the greater.
    pub fn new(from_deg: f64, to_deg: f64) -> Result<Self, NoTravel> {
        let is_one = from_deg.is_finite() && to_deg > from_deg && to_deg.is_finite();
        is_one.then_some(Self { from_deg, to_deg }).ok_or(NoTravel { from_deg, to_deg })
    }

    fn holds(self, axis_deg: f64) -> bool {
        (self.from_deg..=self.to_deg).contains(&axis_deg)
    }

    /// All positions of the axis that point to `azimuth_deg`, from the lowest on.
    fn positions(self, azimuth_deg: f64) -> impl Iterator<Item = f64> {
        let lowest = self.from_deg + (azimuth_deg - self.from_deg).rem_euclid(TURN_DEG);
        let turns = (0..).map(move |turn: u32| lowest + TURN_DEG * f64::from(turn));
        turns.take_while(move |position| *position <= self.to_deg)
    }

    /// The position that points to `azimuth` and is nearest to `near_deg`. Where
    /// none does, the end that points there best.
    pub fn nearest(self, azimuth: Angle, near_deg: f64) -> f64 {
        let positions = self.positions(azimuth.degrees());
        let by_distance = |a: &f64, b: &f64| (a - near_deg).abs().total_cmp(&(b - near_deg).abs());
        positions.min_by(by_distance).unwrap_or_else(|| self.nearest_end(azimuth))
    }

    fn nearest_end(self, azimuth: Angle) -> f64 {
        let off = |end_deg: f64| (azimuth - Angle::from_degrees(end_deg)).wrapped_180().abs();
        if off(self.to_deg) < off(self.from_deg) { self.to_deg } else { self.from_deg }
    }
}

/// The positions of an azimuth axis along a pass.
#[derive(Debug, Clone, PartialEq)]
pub struct AzimuthRoute {
    range: AzimuthRange,
    /// When, and where the axis is then, degrees.
    points: Vec<(Timestamp, f64)>,
    /// When the axis swings round because it is at an end.
    swings: Vec<Timestamp>,
}

impl AzimuthRoute {
    /// The route along `samples`, which are oldest first and a few degrees apart,
    /// with the fewest swings. `axis_now_deg` is where the axis stands: of two
    /// routes with as many swings the one that begins nearer is taken.
    pub fn along(samples: &[Sample], range: AzimuthRange, axis_now_deg: Option<f64>) -> Self {
        let unwrapped = unwrapped(samples);
        let mut route =
            Self { range, points: Vec::with_capacity(samples.len()), swings: Vec::new() };
        let mut start = 0;
        while let Some((_, first)) = unwrapped.get(start) {
            let rest = unwrapped.get(start..).unwrap_or_default();
            if range.positions(*first).next().is_none() {
                route.wait_at_end(samples.get(start));
                start += 1;
                continue;
            }
            let near = route.points.last().map(|(_, axis)| *axis).or(axis_now_deg);
            let mut best: Option<(usize, f64, f64)> = None;
            for position in range.positions(*first) {
                let shift = position - first;
                let lasts = rest.iter().take_while(|(_, at)| range.holds(at + shift)).count();
                let way = near.map_or(0.0, |near| (position - near).abs());
                let is_better = best.is_none_or(|(most, _, shortest)| {
                    lasts > most || (lasts == most && way < shortest)
                });
                if is_better {
                    best = Some((lasts, shift, way));
                }
            }
            // Rounding may put a position just outside an end.
            let (lasts, shift, _) = best.unwrap_or((1, 0.0, 0.0));
            let leg = rest.iter().take(lasts.max(1));
            for (time, at) in leg {
                route.go_on(*time, at + shift);
            }
            start += lasts.max(1);
        }
        route
    }

    /// No position points to `sample`: the end that does so best is kept.
    fn wait_at_end(&mut self, sample: Option<&Sample>) {
        if let Some(Sample { time, direction }) = sample {
            self.go_on(*time, self.range.nearest_end(direction.azimuth));
        }
    }

    fn go_on(&mut self, time: Timestamp, axis_deg: f64) {
        let before = self.points.last().map(|(_, before_deg)| *before_deg);
        if before.is_some_and(|before_deg| (axis_deg - before_deg).abs() > TURN_DEG / 2.0) {
            self.swings.push(time);
        }
        self.points.push((time, axis_deg));
    }

    /// Where the axis is to be at the samples it was made of, degrees.
    pub fn positions_deg(&self) -> impl Iterator<Item = f64> {
        self.points.iter().map(|(_, axis_deg)| *axis_deg)
    }

    /// Where the axis is to be at `time` to point to `azimuth`, degrees as the
    /// axis counts.
    pub fn position(&self, time: Timestamp, azimuth: Angle) -> f64 {
        let after = self.points.partition_point(|(at, _)| *at <= time);
        let near = self.points.get(after.saturating_sub(1)).map(|(_, axis)| *axis);
        self.range.nearest(azimuth, near.unwrap_or(self.range.from_deg))
    }

    /// Where the axis waits for the beginning, degrees; `None` for an empty route.
    pub fn start_deg(&self) -> Option<f64> {
        self.points.first().map(|(_, axis)| *axis)
    }

    /// When the axis swings round, during which it does not point.
    pub fn swings(&self) -> &[Timestamp] {
        &self.swings
    }
}

/// The azimuths without jumps, degrees: each one the short way from the one
/// before.
fn unwrapped(samples: &[Sample]) -> Vec<(Timestamp, f64)> {
    let mut before: Option<Angle> = None;
    let azimuth = |sample: &Sample| {
        let azimuth = sample.direction.azimuth;
        let at = before.map_or(azimuth, |before| before + (azimuth - before).wrapped_180());
        before = Some(at);
        (sample.time, at.degrees())
    };
    samples.iter().map(azimuth).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::{AzEl, time::add_seconds};

    const PLAIN: (f64, f64) = (0.0, 360.0);
    const OVERLAP: (f64, f64) = (0.0, 450.0);

    /// A pass whose azimuth runs through these degrees, one a second.
    fn pass(azimuths: impl IntoIterator<Item = f64>) -> Vec<Sample> {
        let sample = |(second, azimuth): (u32, f64)| Sample {
            time: add_seconds(Timestamp::UNIX_EPOCH, f64::from(second)),
            direction: AzEl::from_degrees(azimuth.rem_euclid(360.0), 30.0),
        };
        (0..).zip(azimuths).map(sample).collect()
    }

    fn route(samples: &[Sample], (from, to): (f64, f64), now: Option<f64>) -> AzimuthRoute {
        AzimuthRoute::along(samples, AzimuthRange::new(from, to).unwrap(), now)
    }

    /// Degrees from `from` to `to`, both among them.
    fn sweep(from: i32, to: i32) -> Vec<f64> {
        let step = if from < to { 1 } else { -1 };
        (0..=(to - from).abs()).map(|count| f64::from(from + step * count)).collect()
    }

    #[test]
    fn a_pass_through_north_swings_once_on_a_plain_axis_and_not_with_an_overlap() {
        for azimuths in [sweep(300, 420), sweep(60, -60)] {
            let samples = pass(azimuths);
            let plain = route(&samples, PLAIN, None);
            assert_eq!(plain.swings().len(), 1);
            let overlap = route(&samples, OVERLAP, None);
            assert!(overlap.swings().is_empty(), "{overlap:?}");
            let jump = overlap.points.windows(2).map(|two| (two[1].1 - two[0].1).abs());
            assert!(jump.fold(0.0, f64::max) < 1.01);
        }
    }

    #[test]
    fn the_turn_that_lasts_is_taken_even_when_it_begins_further_away() {
        // From 80 down through north to 300: begun at 440, it needs no swing.
        let samples = pass(sweep(80, -60));
        let route = route(&samples, OVERLAP, Some(75.0));
        assert_eq!(route.start_deg().map(f64::round), Some(440.0));
        assert!(route.swings().is_empty());
    }

    #[test]
    fn of_two_turns_that_last_the_nearer_is_taken() {
        let samples = pass(sweep(20, 60));
        for (now, start) in [(10.0, 20.0), (400.0, 380.0)] {
            let route = route(&samples, OVERLAP, Some(now));
            assert_eq!(route.start_deg().map(f64::round), Some(start), "{now}");
        }
    }

    #[test]
    fn between_two_samples_the_position_stays_on_the_route() {
        let samples = pass(sweep(350, 380));
        let route = route(&samples, OVERLAP, None);
        let time = add_seconds(Timestamp::UNIX_EPOCH, 14.5);
        let position = route.position(time, Angle::from_degrees(4.5));
        assert!((position - 364.5).abs() < 1e-9, "{position}");
    }

    #[test]
    fn every_position_is_within_the_ends_and_points_where_it_should() {
        for (from, to) in [PLAIN, OVERLAP, (-180.0, 180.0), (-180.0, 540.0), (90.0, 480.0)] {
            for start in (-720..720).step_by(37) {
                for way in [-500, -123, 7, 200, 500] {
                    let samples = pass(sweep(start, start + way));
                    let route = route(&samples, (from, to), None);
                    assert_eq!(route.points.len(), samples.len());
                    for ((_, axis), sample) in route.points.iter().zip(&samples) {
                        assert!((from - 1e-6..=to + 1e-6).contains(axis), "{axis}");
                        let off = Angle::from_degrees(*axis) - sample.direction.azimuth;
                        assert!(off.wrapped_180().degrees().abs() < 1e-6);
                    }
                }
            }
        }
    }

    #[test]
    fn an_axis_of_less_than_a_turn_waits_at_the_better_end() {
        let samples = pass(sweep(280, 440));
        let route = route(&samples, (0.0, 300.0), None);
        let degrees: Vec<i32> = route.positions_deg().map(|axis| axis.round() as i32).collect();
        assert_eq!(degrees[..=20], (280..=300).collect::<Vec<_>>());
        assert!(degrees[20..50].iter().all(|axis| *axis == 300), "{degrees:?}");
        assert!(degrees[51..=80].iter().all(|axis| *axis == 0), "{degrees:?}");
        assert_eq!(degrees[80..], (0..=80).collect::<Vec<_>>());
        assert_eq!(route.swings().len(), 1);
    }

    #[test]
    fn an_axis_must_travel() {
        assert!(AzimuthRange::new(10.0, 10.0).is_err());
        assert!(AzimuthRange::new(f64::NAN, 360.0).is_err());
        assert!(AzimuthRange::new(0.0, f64::INFINITY).is_err());
        assert!(route(&[], PLAIN, None).start_deg().is_none());
    }
}
