//! Elevation, azimuth and error over the time of the pass.

use egui::Rangef;
use jiff::Timestamp;
use maud::{Markup, html};

use crate::{
    astro::{AzEl, time::seconds_between},
    contract::record::OpenedPass,
    plan::{Sample, pass_report::TrackPoint},
    ui::{
        format,
        page::{plot, section},
        recorded_track,
        time_axis::TimeAxis,
    },
};

/// Size of the curves, points on paper.
const WIDTH: f64 = 539.0;
const HEIGHT: f64 = 255.0;
const TOP: f64 = 8.0;
/// Room for the numbers at the left, and for words at the right, points on paper.
const NUMBERS: f64 = 30.0;
const WORDS: f64 = 62.0;
const DIRECTION: f64 = 62.0;
const ERROR: f64 = 92.0;
const GAP_S: f64 = 10.0;
/// Max number of labelled minutes below the curves.
const MAX_MINUTES: i64 = 12;

/// A plot: a range of values over the time of the pass.
struct Plot {
    axis: TimeAxis,
    top: f64,
    height: f64,
    /// Values at the bottom and at the top of the plot, degrees.
    values: [f64; 2],
}

impl Plot {
    fn x(&self, time: Timestamp) -> f64 {
        self.axis.x_within(time).into()
    }

    fn y(&self, value: f64) -> f64 {
        let [bottom, top] = self.values;
        let part = ((value - bottom) / (top - bottom)).clamp(0.0, 1.0);
        self.top + (1.0 - part) * self.height
    }

    /// Returns a line across the plot with its number.
    fn line(&self, value: f64, decimals: usize) -> Markup {
        let y = self.y(value);
        let number = format::number(value, decimals);
        html! {
            (plot::line("hair", &[[NUMBERS, y], [WIDTH - WORDS, y]]))
            (plot::text("quiet end", [NUMBERS - 4.0, y + 2.3], &number))
        }
    }
}

/// Returns words at the right of a plot.
fn note(y: f64, words: &str) -> Markup {
    plot::text("", [WIDTH - WORDS + 5.0, y], words)
}

pub(super) fn html(opened: &OpenedPass) -> Markup {
    let report = &opened.pass.report;
    let x = Rangef::new(NUMBERS as f32, (WIDTH - WORDS) as f32);
    let axis = TimeAxis::lasting(report.start, seconds_between(report.start, report.end), x);
    let plot = |top, height, values| Plot { axis, top, height, values };
    let half_beam_deg = report.half_beam_deg.max(1e-3);
    let top_deg = recorded_track::error_top_deg(half_beam_deg, &opened.track);
    let elevation = plot(TOP, DIRECTION, [0.0, 90.0]);
    let azimuth = plot(TOP + DIRECTION + GAP_S, DIRECTION, [0.0, 360.0]);
    let error = plot(TOP + 2.0 * (DIRECTION + GAP_S), ERROR, [-top_deg, top_deg]);
    let content = html! {
        svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) {
            (direction(&elevation, "elevation °", opened, AzEl::elevation_deg))
            (direction(&azimuth, "azimuth °", opened, AzEl::azimuth_deg))
            (errors(&error, half_beam_deg, opened))
            (times(&error))
        }
    };
    section("curves", "Over time", "dashed: predicted; solid: actual", &content)
}

fn direction(plot: &Plot, words: &str, opened: &OpenedPass, value: fn(AzEl) -> f64) -> Markup {
    let [bottom, top] = plot.values;
    // The azimuth jumps at north.
    let is_joined = |a: f64, b: f64| (a - b).abs() < 180.0;
    let place = |time, value| [plot.x(time), plot.y(value)];
    let of_path = |sample: &Sample| value(sample.direction);
    let of_track = |point: &TrackPoint| value(point.antenna);
    let predicted = opened.path.chunk_by(|a, b| is_joined(of_path(a), of_path(b)));
    let measured = recorded_track::pieces(&opened.track)
        .flat_map(|piece| piece.chunk_by(|a, b| is_joined(of_track(a), of_track(b))));
    html! {
        @for third in 0..=3_u8 {
            (plot.line(bottom + (top - bottom) * f64::from(third) / 3.0, 0))
        }
        (note(plot.top + 7.0, words))
        @for piece in predicted {
            @let points: Vec<_> = piece.iter().map(|sample| place(sample.time, of_path(sample))).collect();
            (plot::line("thin dashed", &points))
        }
        @for piece in measured {
            @let points: Vec<_> = piece.iter().map(|sample| place(sample.time, of_track(sample))).collect();
            (plot::line("thin", &points))
        }
    }
}

fn errors(plot: &Plot, half_beam_deg: f64, opened: &OpenedPass) -> Markup {
    let [_, top] = plot.values;
    let step = recorded_track::nice_step(top);
    let decimals = recorded_track::decimals(step);
    let lines = (top / step).floor() as i32;
    let edge = plot.y(half_beam_deg);
    let across =
        |point: &TrackPoint| point.error.azimuth_deg * point.satellite.elevation.radians().cos();
    let curve = |piece: &[TrackPoint], part: &dyn Fn(&TrackPoint) -> f64| -> Vec<_> {
        piece.iter().map(|point| [plot.x(point.time), plot.y(part(point))]).collect()
    };
    html! {
        @for line in -lines..=lines { (plot.line(f64::from(line) * step, decimals)) }
        (plot::line("thin long", &[[NUMBERS, edge], [WIDTH - WORDS, edge]]))
        (note(edge + 2.3, &format!("half beam {}", format::degrees(half_beam_deg, 2))))
        @for (row, words) in [(0, "solid: off axis"), (1, "dashed: el"), (2, "dots: cross-el")] {
            (note(plot.y(0.0) + 9.0 * f64::from(row) + 2.3, words))
        }
        @for piece in recorded_track::pieces(&opened.track) {
            (plot::line("thin dotted", &curve(piece, &across)))
            (plot::line("thin dashed", &curve(piece, &|point| point.error.elevation_deg)))
            (plot::line("thick", &curve(piece, &|point| point.error.off_deg)))
        }
    }
}

/// Returns the full minutes below the last plot.
fn times(plot: &Plot) -> Markup {
    let minutes = plot.axis.seconds() / 60.0;
    let every = (minutes / MAX_MINUTES as f64).ceil().max(1.0) as i64;
    let bottom = plot.top + plot.height;
    html! {
        @for time in plot.axis.multiples(60 * every) {
            @let x = plot.x(time);
            (plot::line("thin", &[[x, bottom], [x, bottom + 2.5]]))
            (plot::text("quiet middle", [x, bottom + 9.5], &format::minute_of_day(time)))
        }
    }
}
