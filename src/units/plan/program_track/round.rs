//! Paths with detours round the keep-outs that permit them.
//!
//! The path is one line. If the target is behind an edge of a keep-out, the line follows the
//! margin. The position of the antenna on the line at each time minimises the pointing error and
//! never moves faster than the axes turn. On a long detour, the axes set out early and arrive late.

use crate::{
    astro::AzEl,
    plan::{
        Bounds, Sample,
        az_el::Start,
        detour::{self, AxisLimits},
        rate_limited::rate_limited,
    },
};

/// Share of their rate at which the axes turn along a detour: a faster motion counts as a slew,
/// which is one command.
const SHARE_OF_RATE: f64 = 0.95;
/// Max distance between two points of a detour, degrees.
const STEP_DEG: f64 = 0.5;

/// Returns the positions of both axes along `samples`, `step_s` seconds apart, with detours round
/// the keep-outs; `None` if none is in the way. `axes_deg` contains the positions without detours;
/// a stretch without a detour stays unchanged.
pub(super) fn round(
    axes_deg: &[Vec<f64>; 2],
    samples: &[Sample],
    step_s: f64,
    start: Start,
    limits: AxisLimits,
    bounds: &Bounds,
) -> Option<[Vec<f64>; 2]> {
    let places_deg = || axes_deg[0].iter().zip(&axes_deg[1]).map(|(a, b)| [*a, *b]);
    let is_behind: Vec<bool> =
        places_deg().map(|axes_deg| bounds.is_gone_round(axes_deg, limits.room_deg)).collect();
    if !is_behind.contains(&true) {
        return None;
    }
    let mut line = Polyline { points: Vec::new(), limits, max_s: step_s * SHARE_OF_RATE };
    let mut wanted_s = Vec::with_capacity(samples.len());
    if let (Some(true), [Some(first), Some(second)]) = (is_behind.first(), start.axes_deg) {
        // The axes may already be in the middle of a detour; before a pass, they wait at its end.
        let stands = [first, second];
        let is_outside = !bounds.is_gone_round(stands, 0.0);
        if start.lead_s <= 0.0 && is_outside {
            line.begin(stands);
        }
    }
    let mut index = 0;
    let places_deg: Vec<[f64; 2]> = places_deg().collect();
    while let Some(place_deg) = places_deg.get(index) {
        let count = is_behind.iter().skip(index).take_while(|is_hidden| **is_hidden).count();
        if count == 0 {
            line.go_to(*place_deg);
            wanted_s.push(line.end_s());
            index += 1;
            continue;
        }
        let stretch = index..index + count;
        let targets = samples.get(stretch.clone()).unwrap_or_default();
        let comes_out = places_deg.get(stretch.end).copied();
        let detour = match (line.end_deg(), comes_out) {
            (Some(entry_deg), Some(end)) => {
                // A search takes long, so use the bounds of this moment for the whole stretch.
                let middle_time = targets.get(count / 2).map(|sample| sample.time);
                middle_time
                    .and_then(|time| detour::route(&bounds.at_time(time), &limits, entry_deg, end))
            }
            // The target rises or sets behind the keep-out.
            (Some(one), None) | (None, Some(one)) => Some(vec![one]),
            (None, None) => None,
        };
        if let Some(detour) = detour {
            wanted_s.extend(line.detour(&detour, targets, bounds));
        } else {
            for place_deg in places_deg.get(stretch.clone()).unwrap_or_default() {
                line.go_to(*place_deg);
                wanted_s.push(line.end_s());
            }
        }
        index = stretch.end;
    }
    let line = &line;
    let cost = |index: usize| {
        let target = samples.get(index).map(|sample| sample.direction);
        move |at_s: &f64| target.map_or(0.0, |target| line.cost(target, *at_s, bounds))
    };
    let way_s = rate_limited(&wanted_s, step_s * SHARE_OF_RATE, None, |at_s| at_s, cost);
    let places = way_s.into_iter().map(|at_s| line.position_deg(at_s));
    let (first, second) = places.map(|[first, second]| (first, second)).unzip();
    Some([first, second])
}

/// Path as a line, measured in seconds at full rate.
struct Polyline {
    /// Seconds from the start, and positions in degrees as the mount counts.
    points: Vec<(f64, [f64; 2])>,
    limits: AxisLimits,
    /// Max stretch between two samples, seconds.
    max_s: f64,
}

impl Polyline {
    fn begin(&mut self, at_deg: [f64; 2]) {
        self.points.push((0.0, at_deg));
    }

    fn end_s(&self) -> f64 {
        self.points.last().map_or(0.0, |(at_s, _)| *at_s)
    }

    fn end_deg(&self) -> Option<[f64; 2]> {
        self.points.last().map(|(_, at_deg)| *at_deg)
    }

    fn add(&mut self, to_deg: [f64; 2], max_s: f64) {
        let Some((before_s, before_deg)) = self.points.last().copied() else {
            return self.begin(to_deg);
        };
        let way_s = self.limits.seconds(before_deg, to_deg).min(max_s);
        self.points.push((before_s + way_s, to_deg));
    }

    /// Extends the line to a position that the axes can reach in time.
    fn go_to(&mut self, to_deg: [f64; 2]) {
        self.add(to_deg, self.max_s);
    }

    /// Extends the line along a detour. Returns the nearest point of the line to each of `targets`,
    /// without going back.
    fn detour(&mut self, turns_deg: &[[f64; 2]], targets: &[Sample], bounds: &Bounds) -> Vec<f64> {
        let mut first = self.points.len().saturating_sub(1);
        let from_deg = self.end_deg().or(turns_deg.first().copied());
        let turns_deg: Vec<_> = from_deg.into_iter().chain(turns_deg.iter().copied()).collect();
        for place_deg in detour::in_steps(&turns_deg, STEP_DEG) {
            self.add(place_deg, f64::INFINITY);
        }
        let directions: Vec<_> =
            self.points.iter().map(|(_, at_deg)| bounds.direction(*at_deg)).collect();
        let nearest = |sample: &Sample| {
            let rest = directions.iter().enumerate().skip(first);
            let separations = rest.map(|(index, direction)| {
                (index, direction.separation(sample.direction).degrees())
            });
            let found = separations.min_by(|a, b| a.1.total_cmp(&b.1));
            first = found.map_or(first, |(index, _)| index);
            self.points.get(first).map_or(0.0, |(at_s, _)| *at_s)
        };
        targets.iter().map(nearest).collect()
    }

    /// Returns the position at `at_s`, degrees as the mount counts.
    fn position_deg(&self, at_s: f64) -> [f64; 2] {
        let after = self.points.partition_point(|(point_s, _)| *point_s < at_s);
        let end = self.points.get(after).or(self.points.last());
        let Some((end_s, end_deg)) = end.copied() else { return [0.0; 2] };
        let before = after.checked_sub(1).and_then(|before| self.points.get(before));
        let (start_s, start_deg) = before.copied().unwrap_or((end_s, end_deg));
        if end_s - start_s <= 0.0 {
            return end_deg;
        }
        let share = ((at_s - start_s) / (end_s - start_s)).clamp(0.0, 1.0);
        let [a, b] = [end_deg[0] - start_deg[0], end_deg[1] - start_deg[1]];
        [start_deg[0] + a * share, start_deg[1] + b * share]
    }

    /// Returns the cost of a position on the line.
    fn cost(&self, target: AzEl, at_s: f64, bounds: &Bounds) -> f64 {
        1.0 - bounds.direction(self.position_deg(at_s)).separation(target).radians().cos()
    }
}
