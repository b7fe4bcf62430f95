//! Azimuth, elevation and error over time, above the events of the pass.

use egui::{Align2, Color32, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use jiff::{SignedDuration, Timestamp};

use super::{PADDING, RecordState, cursor, events, lock, report};
use crate::{
    astro::time::add_seconds,
    contract::record::OpenedPass,
    model::{Model, UiCommand},
    plan::pass_report::{PointingError, TrackPoint},
    ui::{
        format,
        profile::{
            dashes,
            scale::{self, AZIMUTH_TOP_DEG, ELEVATION_TOP_DEG},
        },
        recorded_track, text, theme,
        time_axis::TimeAxis,
        tokens::Tokens,
        widgets::paint,
    },
};

/// Time shown before AOS and after LOS.
const MARGIN: SignedDuration = SignedDuration::from_secs(60);
const TITLE: f32 = 28.0;
/// Min heights of the two plots, points.
const DIRECTION: f32 = 78.0;
const ERROR: f32 = 104.0;
/// Widths for the numbers at the left and at the right, points.
const LEFT: f32 = 60.0;
const RIGHT: f32 = 120.0;
const GAP: f32 = 6.0;
const DOTS: (f32, f32) = (1.5, 3.5);
const DASH: (f32, f32) = (6.0, 4.0);
/// Width of the readout at the cursor, points.
const READOUT: f32 = 176.0;

/// Function that returns one error of a point, degrees.
type Part = fn(&PointingError, &TrackPoint) -> f64;

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    opened: &OpenedPass,
    state: &mut RecordState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let report = &opened.pass.report;
    let plots = rect.with_min_x(rect.left() + LEFT).with_max_x(rect.right() - RIGHT);
    let (Ok(start), Ok(end)) = (report.start.checked_sub(MARGIN), report.end.checked_add(MARGIN))
    else {
        return;
    };
    let Some(axis) = TimeAxis::new(start, end, plots.x_range()) else { return };
    let mut y = rect.top();
    let mut part = |height: f32| {
        y += height;
        plots.with_min_y(y - height).with_max_y(y)
    };
    let titled =
        |place: Rect| place.with_min_x(rect.left() + PADDING).with_max_x(rect.right() - PADDING);
    let head = titled(part(TITLE));
    let entries = [("elevation", t.sat, false), ("azimuth", t.t2, true), ("actual", t.ant, false)];
    title(ui, head, "Azimuth and elevation", "", &entries);
    let spare = (rect.height() - super::DRAWINGS).max(0.0);
    let direction = part(DIRECTION + DIRECTION / (DIRECTION + ERROR) * spare);
    directions(ui, direction, &axis, opened);
    let head = titled(part(TITLE));
    let entries = [("off axis", t.ant, false), ("el", t.sat, false), ("cross-el", t.t2, true)];
    title(ui, head, "Pointing error, degrees", "off the beam axis, and by axis", &entries);
    let error = part(ERROR + ERROR / (DIRECTION + ERROR) * spare);
    errors(ui, error, &axis, opened);
    let head = titled(part(TITLE));
    let note = "Full log: azel log";
    title(ui, head, "Events", note, &[]);
    let lanes = Rect::from_min_max(pos2(rect.left(), head.bottom()), rect.max);
    let whole = plots.with_min_y(direction.top()).with_max_y(error.bottom());
    let replays = follow_pointer(ui, whole, &axis, opened, model.now, state);
    events::show(ui, lanes, plots, &axis, model, opened, state);

    if replays && lock(model).is_none() {
        commands.push(report::replay_of(&opened.pass, state.cursor));
    }
    let point = cursor::point(opened, state);
    if let Some(time) = state.cursor.or(point.map(|point| point.time)) {
        let x = axis.x(time);
        let line = whole.with_max_y(rect.bottom() - 20.0);
        ui.painter().vline(x, line.y_range(), (1.5, t.t1));
        if let Some(point) = point {
            readout(ui, direction, x, point, model.now);
        }
    }
}

/// Moves the cursor with the pointer and the arrow keys. Returns `true` when the operator starts a
/// replay at the cursor with a double click or Enter.
fn follow_pointer(
    ui: &Ui,
    rect: Rect,
    axis: &TimeAxis,
    opened: &OpenedPass,
    now: Timestamp,
    state: &mut RecordState,
) -> bool {
    let id = ui.make_persistent_id("record cursor");
    let response = ui.interact(rect, id, Sense::click_and_drag());
    if let Some(position) = response.hover_pos().or(response.interact_pointer_pos()) {
        state.cursor = Some(axis.time(position.x));
    }
    let read_at = state.cursor.or(cursor::point(opened, state).map(|point| point.time));
    if response.has_focus()
        && let Some(time) = read_at
    {
        let by_s = ui.input(|input| {
            let step = if input.modifiers.shift { 10.0 } else { 1.0 };
            step * f64::from(
                i32::from(input.key_pressed(egui::Key::ArrowRight))
                    - i32::from(input.key_pressed(egui::Key::ArrowLeft)),
            )
        });
        if by_s != 0.0 {
            state.cursor = Some(add_seconds(time, by_s).clamp(axis.start(), axis.end()));
        }
        let filter = egui::EventFilter { horizontal_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
    }
    let words = match cursor::point(opened, state) {
        Some(point) => format!(
            "Time in the pass, {}: off the beam axis {}",
            format::moment(point.time, now),
            format::degrees(point.error.off_deg, 2)
        ),
        None => "Time in the pass".to_owned(),
    };
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, &words));
    paint::focus_ring(ui, &response, 2);
    let enter = response.has_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
    let response = response.on_hover_text("Double-click, or Enter: replay from this moment");
    response.double_clicked() || enter
}

fn title(ui: &Ui, rect: Rect, words: &str, note: &str, legend: &[(&str, Color32, bool)]) {
    let t = theme::tokens(ui);
    let mut right = rect.right();
    for (word, colour, is_dotted) in legend.iter().rev() {
        let room = rect.with_max_x(right);
        let drawn = paint::text_in(ui, room, Align2::RIGHT_CENTER, word, text::caption(), t.t2);
        let line =
            [pos2(drawn.left() - 22.0, rect.center().y), pos2(drawn.left() - 6.0, rect.center().y)];
        let stroke = Stroke::new(2.0, *colour);
        if *is_dotted {
            dashes::paint(ui.painter(), &line, stroke, DOTS);
        } else {
            ui.painter().line_segment(line, stroke);
        }
        right = drawn.left() - 34.0;
    }
    let room = rect.with_max_x(right);
    let drawn = paint::text_in(ui, room, Align2::LEFT_CENTER, words, text::small_strong(), t.t1);
    let room = room.with_min_x((drawn.right() + 8.0).min(right));
    paint::text_in(ui, room, Align2::LEFT_CENTER, note, text::caption(), t.t3);
}

fn grid(ui: &Ui, rect: Rect, axis: &TimeAxis) {
    let t = theme::tokens(ui);
    for minute in minutes(axis) {
        ui.painter().vline(axis.x(minute), rect.y_range(), (1.0, t.line));
    }
}

/// Returns the full minutes for grid lines, at most eight.
pub(super) fn minutes(axis: &TimeAxis) -> Vec<Timestamp> {
    let every_s = [60, 120, 300, 600, 1800, 3600, 7200]
        .into_iter()
        .find(|every| axis.seconds() / f64::from(*every) <= 8.0)
        .unwrap_or(14_400);
    axis.multiples(i64::from(every_s)).take(9).filter(|time| *time < axis.end()).collect()
}

fn directions(ui: &Ui, rect: Rect, axis: &TimeAxis, opened: &OpenedPass) {
    let t = theme::tokens(ui);
    grid(ui, rect, axis);
    for third in 0..=3_u8 {
        let part = f64::from(third) / 3.0;
        let y = scale::y(rect, part, 1.0);
        ui.painter().hline(rect.x_range(), y, (1.0, t.line));
        let number = |top: f64| format::number(part * top, 0);
        let position = pos2(rect.left() - GAP, y);
        paint::text(
            ui,
            position,
            Align2::RIGHT_CENTER,
            number(ELEVATION_TOP_DEG),
            text::caption(),
            t.sat,
        );
        let position = pos2(rect.right() + GAP, y);
        paint::text(
            ui,
            position,
            Align2::LEFT_CENTER,
            number(AZIMUTH_TOP_DEG),
            text::caption(),
            t.t2,
        );
    }
    let painter = ui.painter_at(rect);
    let predicted = || opened.path.iter().map(|sample| (axis.x(sample.time), sample.direction));
    let azimuths = predicted().map(|(x, direction)| (x, direction.azimuth_deg()));
    let azimuths = scale::broken_at_north(azimuths);
    for piece in scale::pieces(azimuths.into_iter(), rect, AZIMUTH_TOP_DEG) {
        dashes::paint(&painter, &piece, Stroke::new(1.5, t.t2), DOTS);
    }
    let elevations = predicted().map(|(x, direction)| (x, direction.elevation_deg()));
    for piece in scale::pieces(elevations, rect, ELEVATION_TOP_DEG) {
        dashes::paint(&painter, &piece, Stroke::new(2.0, t.sat), DASH);
    }
    let flown = |part: Part| with_breaks(axis, &opened.track, part);
    let azimuths =
        scale::broken_at_north(flown(|_, point| point.antenna.azimuth_deg()).into_iter());
    for piece in scale::pieces(azimuths.into_iter(), rect, AZIMUTH_TOP_DEG) {
        painter.line(piece, Stroke::new(1.0, t.ant.gamma_multiply(0.7)));
    }
    let elevations = flown(|_, point| point.antenna.elevation_deg());
    for piece in scale::pieces(elevations.into_iter(), rect, ELEVATION_TOP_DEG) {
        painter.line(piece, Stroke::new(1.5, t.ant));
    }
}

/// Returns a curve along the track, with breaks where measurements are missing.
fn with_breaks(axis: &TimeAxis, track: &[TrackPoint], part: Part) -> Vec<(f32, f64)> {
    let mut curve = Vec::new();
    for piece in recorded_track::pieces(track) {
        curve.extend(piece.iter().map(|point| (axis.x(point.time), part(&point.error, point))));
        curve.push((f32::NAN, f64::NAN));
    }
    curve
}

fn errors(ui: &Ui, rect: Rect, axis: &TimeAxis, opened: &OpenedPass) {
    let t = theme::tokens(ui);
    let half_beam_deg = opened.pass.report.half_beam_deg.max(1e-3);
    let top = recorded_track::error_top_deg(half_beam_deg, &opened.track);
    let y = |value: f64| {
        let part = f64::midpoint(value.clamp(-top, top) / top, 1.0);
        egui::lerp(rect.bottom()..=rect.top(), part as f32)
    };
    let outside = rect.with_max_y(y(half_beam_deg));
    ui.painter().rect_filled(outside, 0.0, t.badbg);
    grid(ui, rect, axis);
    let step = recorded_track::nice_step(top);
    let lines = (top / step).floor() as i32;
    let decimals = recorded_track::decimals(step);
    for line in -lines..=lines {
        let value = f64::from(line) * step;
        ui.painter().hline(rect.x_range(), y(value), (1.0, t.line));
        let number = format::number(value, decimals);
        let position = pos2(rect.left() - GAP, y(value));
        paint::text(ui, position, Align2::RIGHT_CENTER, number, text::caption(), t.t3);
    }
    let edge = y(half_beam_deg);
    let line = [pos2(rect.left(), edge), pos2(rect.right(), edge)];
    dashes::paint(ui.painter(), &line, Stroke::new(1.5, t.cmd), DASH);
    let words = format!("{} half beam", format::number(half_beam_deg, 2));
    let room = Rect::from_min_size(
        pos2(rect.right() + GAP, edge - 8.0),
        vec2(RIGHT - GAP - PADDING, 16.0),
    );
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::caption(), t.cmd);
    let painter = ui.painter_at(rect);
    let curve = |part: Part| -> Vec<Vec<egui::Pos2>> {
        let points = with_breaks(axis, &opened.track, part);
        let pieces = points.split(|(_, value)| !value.is_finite());
        pieces.map(|piece| piece.iter().map(|(x, value)| pos2(*x, y(*value))).collect()).collect()
    };
    for piece in curve(|error, point| error.azimuth_deg * point.satellite.elevation.radians().cos())
    {
        dashes::paint(&painter, &piece, Stroke::new(1.5, t.t2), DOTS);
    }
    for piece in curve(|error, _| error.elevation_deg) {
        painter.line(piece, Stroke::new(1.5, t.sat));
    }
    for piece in curve(|error, _| error.off_deg) {
        painter.line(piece, Stroke::new(2.0, t.ant));
    }
}

/// Draws the predicted and the measured values at the cursor.
fn readout(ui: &Ui, rect: Rect, x: f32, point: &TrackPoint, now: Timestamp) {
    let t: &Tokens = theme::tokens(ui);
    let is_right = x + READOUT + 20.0 < rect.right() + RIGHT - 8.0;
    let left = if is_right { x + 10.0 } else { x - 10.0 - READOUT };
    let place = Rect::from_min_size(pos2(left, rect.top() + 4.0), vec2(READOUT, 56.0));
    ui.painter().rect_filled(place, 4.0, t.bg2.gamma_multiply(0.92));
    let samples = |name: &str, satellite: f64, antenna: f64| {
        let two = |value| format::degrees(value, 2);
        format!("{name} {}  actual {}", two(satellite), two(antenna))
    };
    let lines = [
        (format::moment(point.time, now), text::small_strong()),
        (samples("az", point.satellite.azimuth_deg(), point.antenna.azimuth_deg()), text::small()),
        (
            samples("el", point.satellite.elevation_deg(), point.antenna.elevation_deg()),
            text::small(),
        ),
    ];
    let mut top = place.top() + 4.0;
    for (words, font) in lines {
        let line = Rect::from_min_size(pos2(place.left() + 8.0, top), vec2(READOUT - 12.0, 16.0));
        paint::text_in(ui, line, Align2::LEFT_CENTER, &words, font, t.t1);
        top += 16.0;
    }
}
