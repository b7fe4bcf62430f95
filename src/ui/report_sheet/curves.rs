//! Elevation, azimuth and error over the time of the pass.

use jiff::{Timestamp, ToSpan as _};

use crate::{
    astro::{AzEl, time::seconds_between},
    plan::{Sample, pass_report::TrackPoint},
    record::OpenedPass,
    ui::{
        format, recorded_track,
        sheet::{
            CAPTION, LEFT, RIGHT, SMALL, section,
            svg::{Anchor, Svg},
        },
    },
};

/// Room for the numbers at the left, and for words at the right.
const NUMBERS: f64 = 30.0;
const WORDS: f64 = 62.0;
const DIRECTION: f64 = 62.0;
const ERROR: f64 = 92.0;
const BETWEEN: f64 = 10.0;
const DASH: [f64; 2] = [3.0, 2.0];
const DOTS: [f64; 2] = [0.8, 1.6];
/// Most minutes that are named below the curves.
const MOST_MINUTES: i64 = 12;

/// A plot: a range of values over the time of the pass.
struct Plot {
    from: Timestamp,
    until: Timestamp,
    top: f64,
    height: f64,
    /// Values at the bottom and at the top.
    values: [f64; 2],
}

impl Plot {
    fn x(&self, time: Timestamp) -> f64 {
        let whole_s = seconds_between(self.from, self.until).max(1e-3);
        let part = (seconds_between(self.from, time) / whole_s).clamp(0.0, 1.0);
        LEFT + NUMBERS + part * (RIGHT - WORDS - LEFT - NUMBERS)
    }

    fn y(&self, value: f64) -> f64 {
        let [bottom, top] = self.values;
        let part = ((value - bottom) / (top - bottom)).clamp(0.0, 1.0);
        self.top + (1.0 - part) * self.height
    }

    /// A line across the plot with its number.
    fn line(&self, svg: &mut Svg, value: f64, decimals: usize) {
        let (left, y) = (LEFT + NUMBERS, self.y(value));
        svg.line([left, y], [RIGHT - WORDS, y], 0.2);
        let number = format::number(value, decimals);
        svg.text([left - 4.0, y + 2.3], NUMBERS, CAPTION.anchored(Anchor::End), &number);
    }
}

/// Words at the right of a plot.
fn beside(svg: &mut Svg, y: f64, words: &str) {
    svg.text([RIGHT - WORDS + 5.0, y], WORDS - 5.0, SMALL, words);
}

/// Returns where the curves end.
pub(super) fn draw(svg: &mut Svg, y: f64, opened: &OpenedPass) -> f64 {
    let said = "dashed: predicted; solid: actual";
    let mut y = section(svg, y, "Over time", said) + 4.0;
    let report = &opened.pass.report;
    let plot =
        |top, height, values| Plot { from: report.from, until: report.until, top, height, values };
    let elevation = plot(y, DIRECTION, [0.0, 90.0]);
    direction(svg, &elevation, "elevation °", opened, AzEl::elevation_deg);
    y += DIRECTION + BETWEEN;
    let azimuth = plot(y, DIRECTION, [0.0, 360.0]);
    direction(svg, &azimuth, "azimuth °", opened, AzEl::azimuth_deg);
    y += DIRECTION + BETWEEN;
    let half_beam_deg = report.half_beam_deg.max(1e-3);
    let top_deg = recorded_track::error_top_deg(half_beam_deg, &opened.track);
    let error = plot(y, ERROR, [-top_deg, top_deg]);
    errors(svg, &error, half_beam_deg, opened);
    y += ERROR;
    times(svg, &error);
    y + 10.0
}

fn direction(svg: &mut Svg, plot: &Plot, words: &str, opened: &OpenedPass, value: fn(AzEl) -> f64) {
    let [bottom, top] = plot.values;
    for third in 0..=3_u8 {
        plot.line(svg, bottom + (top - bottom) * f64::from(third) / 3.0, 0);
    }
    beside(svg, plot.top + 7.0, words);
    // The azimuth jumps at north.
    let is_joined = |a: f64, b: f64| (a - b).abs() < 180.0;
    let place = |time, value| [plot.x(time), plot.y(value)];
    let of_path = |sample: &Sample| value(sample.direction);
    for piece in opened.path.chunk_by(|a, b| is_joined(of_path(a), of_path(b))) {
        let points: Vec<_> = piece.iter().map(|it| place(it.time, of_path(it))).collect();
        svg.dashed(&points, 0.6, DASH);
    }
    let of_track = |point: &TrackPoint| value(point.antenna);
    for piece in recorded_track::pieces(&opened.track) {
        for piece in piece.chunk_by(|a, b| is_joined(of_track(a), of_track(b))) {
            let points: Vec<_> = piece.iter().map(|it| place(it.time, of_track(it))).collect();
            svg.path(&points, 0.8);
        }
    }
}

fn errors(svg: &mut Svg, plot: &Plot, half_beam_deg: f64, opened: &OpenedPass) {
    let [_, top] = plot.values;
    let step = recorded_track::nice_step(top);
    let decimals = recorded_track::decimals(step);
    let lines = (top / step).floor() as i32;
    for line in -lines..=lines {
        plot.line(svg, f64::from(line) * step, decimals);
    }
    let edge = plot.y(half_beam_deg);
    svg.dashed(&[[LEFT + NUMBERS, edge], [RIGHT - WORDS, edge]], 0.8, [6.0, 3.0]);
    beside(svg, edge + 2.3, &format!("half beam {}", format::degrees(half_beam_deg, 2)));
    for (line, words) in [(0, "solid: off axis"), (1, "dashed: el"), (2, "dots: cross-el")] {
        beside(svg, plot.y(0.0) + 9.0 * f64::from(line) + 2.3, words);
    }
    for piece in recorded_track::pieces(&opened.track) {
        let curve = |part: fn(&TrackPoint) -> f64| -> Vec<_> {
            piece.iter().map(|point| [plot.x(point.time), plot.y(part(point))]).collect()
        };
        let across = |point: &TrackPoint| {
            point.error.azimuth_deg * point.satellite.elevation.radians().cos()
        };
        svg.dashed(&curve(across), 0.7, DOTS);
        svg.dashed(&curve(|point| point.error.elevation_deg), 0.6, DASH);
        svg.path(&curve(|point| point.error.off_deg), 1.0);
    }
}

/// The full minutes below the last plot.
fn times(svg: &mut Svg, plot: &Plot) {
    let minutes = seconds_between(plot.from, plot.until) / 60.0;
    let every = (minutes / MOST_MINUTES as f64).ceil().max(1.0) as i64;
    let from = plot.from.as_second();
    let first = (from + 60 * every - 1).div_euclid(60 * every) * 60 * every;
    let mut at = Timestamp::from_second(first).ok();
    while let Some(time) = at.filter(|time| *time <= plot.until) {
        let (x, bottom) = (plot.x(time), plot.top + plot.height);
        svg.line([x, bottom], [x, bottom + 2.5], 0.4);
        let face = CAPTION.anchored(Anchor::Middle);
        svg.text([x, bottom + 9.5], 40.0, face, &format::minute_of_day(time));
        at = time.checked_add(every.minutes()).ok();
    }
}
