//! The time that the operator marks with the pointer or the arrow keys, or that another view marks.

use egui::{EventFilter, Key, Modifiers, Rect, Response, Stroke, StrokeKind, Ui, pos2, vec2};
use jiff::Timestamp;

use super::{
    ProfileModel,
    scale::{self, ELEVATION_TOP_DEG},
};
use crate::{
    astro::time::{add_seconds, seconds_between},
    ui::{along, format, text, theme, time_axis::TimeAxis, widgets::paint},
};

/// Step of an arrow key without and with Shift, seconds.
const STEPS_S: [f64; 2] = [10.0, 60.0];
/// Max time between a mark and the measured error that it shows, seconds.
const NEAR_S: f64 = 3.0;
/// Gap between the line and its words, points.
const GAP: f32 = 6.0;
/// Radius of the mark on the elevation curve, points.
const MARK: f32 = 4.0;

/// Returns the time that the operator marks with the pointer over `plots` or with the arrow keys.
/// `cursor` is the time of the arrow keys.
pub(super) fn requested_time(
    ui: &Ui,
    response: &Response,
    plots: Rect,
    axis: &TimeAxis,
    now: Timestamp,
    cursor: &mut Option<Timestamp>,
) -> Option<Timestamp> {
    if response.has_focus() {
        let start = if axis.contains(now) { now } else { axis.start() };
        let current = cursor.filter(|time| axis.contains(*time)).unwrap_or(start);
        let moved = add_seconds(current, keys_s(ui, response));
        *cursor = Some(moved.clamp(axis.start(), axis.end()));
    } else {
        *cursor = None;
    }
    let hovered = response.hover_pos().filter(|position| plots.contains(*position));
    hovered.map(|position| axis.time(position.x)).or(*cursor)
}

/// Returns the time by which the arrow keys of this frame move the mark, seconds.
fn keys_s(ui: &Ui, response: &Response) -> f64 {
    let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let [step_s, far_s] = STEPS_S;
    ui.input_mut(|input| {
        let mut moved_s = 0.0;
        for (modifiers, by_s) in [(Modifiers::SHIFT, far_s), (Modifiers::NONE, step_s)] {
            for (key, sign) in [(Key::ArrowLeft, -1.0), (Key::ArrowRight, 1.0)] {
                let count = input.count_and_consume_key(modifiers, key);
                moved_s += sign * by_s * count as f64;
            }
        }
        moved_s
    })
}

/// Paints the marked time through `plots`, and the values of the pass at that time. `curves` are
/// the upper plots.
pub(super) fn paint(
    ui: &Ui,
    plots: Rect,
    curves: Rect,
    axis: &TimeAxis,
    model: &ProfileModel<'_>,
    time: Timestamp,
) {
    let Some(sample) = along::sample_at(model.track, time).filter(|_| axis.contains(time)) else {
        return;
    };
    let t = theme::tokens(ui);
    let x = axis.x(time);
    ui.painter().vline(x, plots.y_range(), Stroke::new(1.0, t.t1));
    let elevation_deg = sample.direction.elevation_deg();
    let on_curve = pos2(x, scale::y(curves, elevation_deg, ELEVATION_TOP_DEG));
    ui.painter().circle(on_curve, MARK, t.bg0, Stroke::new(2.0, t.sat));

    let azimuth = format::azimuth(sample.direction.azimuth_deg());
    let elevation = format::degrees(elevation_deg, 1);
    let error = error_at(model, time);
    let deviation_text = error.map(|deg| format!("  err {}", format::degrees(f64::from(deg), 2)));
    let time_text = format::moment(time, model.now);
    let words =
        format!("{time_text}  el {elevation}  az {azimuth}{}", deviation_text.unwrap_or_default());
    let galley = ui.painter().layout_no_wrap(words, text::caption(), t.t1);
    let size = galley.size() + vec2(8.0, 2.0);
    let right = x + GAP + size.x <= plots.right();
    let left = if right { x + GAP } else { (x - GAP - size.x).max(plots.left()) };
    let place = Rect::from_min_size(pos2(left, curves.bottom() - size.y - 2.0), size);
    ui.painter().rect(place, 3.0, t.bg2, Stroke::new(1.0, t.line), StrokeKind::Inside);
    ui.painter().galley(place.min + vec2(4.0, 1.0), galley, t.t1);
    let deviation_text = error.map(|deg| format!(", error {}", format::degrees(f64::from(deg), 2)));
    let deviation_text = deviation_text.unwrap_or_default();
    let name =
        format!("Profile at {time_text}: elevation {elevation}, azimuth {azimuth}{deviation_text}");
    paint::name_text(ui, "marked", place, &name);
}

/// Returns the measured error nearest to `time`, degrees.
fn error_at(model: &ProfileModel<'_>, time: Timestamp) -> Option<f32> {
    let away_s = |moment: Timestamp| seconds_between(moment, time).abs();
    let near =
        model.errors.iter().filter(|(moment, deg)| deg.is_finite() && away_s(*moment) <= NEAR_S);
    let nearest = near.min_by(|(a, _), (b, _)| away_s(*a).total_cmp(&away_s(*b)));
    nearest.map(|(_, deg)| *deg)
}
