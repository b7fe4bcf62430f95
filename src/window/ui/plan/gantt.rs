//! The passes of each satellite over the whole plan.

use egui::{
    Align2, EventFilter, Key, Modifiers, Rect, Response, Role, ScrollArea, Sense, Stroke,
    StrokeKind, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use jiff::Timestamp;

use super::{LABELS, PADDING, PlanState, show_focus};
use crate::{
    contract::passes::PredictedPass,
    model::{
        Model, UiCommand,
        plan::{PlannedPass, PlannedSatellite},
    },
    station::Take,
    ui::{
        format,
        text::{self, Weight},
        theme,
        time_axis::TimeAxis,
        widgets::paint,
        words,
    },
};

const HEAD: f32 = 40.0;
/// Height of the middle of the hours above the rows, points. The grip of the lanes needs the room
/// below them.
const HOURS_UP: f32 = 14.0;
const ROW: f32 = 21.0;
/// Heights of the bars for 0° and 90° of maximum elevation, points.
const BARS: std::ops::RangeInclusive<f32> = 7.0..=19.0;
/// Min distance between two labelled hours, points.
const HOUR_APART: f32 = 36.0;
const DAY_S: i64 = 86_400;
/// Time by which an arrow key moves the section of the lanes, seconds.
const KEY_S: f64 = 3600.0;

pub(super) fn height(rows: usize) -> f32 {
    HEAD + rows.max(1) as f32 * ROW
}

/// Returns the time axis of the whole plan.
fn axis(model: &Model, place: Rect) -> TimeAxis {
    TimeAxis::lasting(model.now, model.station.scheduling.span_h * 3600.0, place.x_range())
}

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    satellites: &[PlannedSatellite<'_>],
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (head, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    ui.painter().rect_filled(head, 0.0, t.bg1);
    let time = |place: Rect| place.with_min_x(rect.left() + LABELS);
    let axis = axis(model, time(rect));
    heads(ui, head, time(head), axis);
    let framed = time(rect).with_min_y(head.bottom());
    let frame = if satellites.is_empty() { None } else { frame(ui, framed, model, axis, state) };
    // The list is one Tab stop; arrow keys move through the passes.
    let list = ui.interact(body, ui.make_persistent_id("plan passes"), Sense::FOCUSABLE);
    list.widget_info(|| WidgetInfo::labeled(Role::ListBox, true, "Passes by satellite"));
    if satellites.is_empty() {
        let words = "No satellite is planned. Mark favourites in Elements.";
        let position = body.left_top() + vec2(PADDING, 8.0);
        let place = paint::paragraph(ui, position, body.width() - 32.0, words, text::body(), t.t2);
        paint::name_text(ui, "nothing planned", place, words);
        return;
    }
    day_and_night(ui, time(body), model, axis);
    ui.scope_builder(UiBuilder::new().id_salt("plan rows").max_rect(body), |ui| {
        ui.set_clip_rect(body.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        let area = ScrollArea::vertical().id_salt("plan gantt").auto_shrink(false);
        area.show_rows(ui, ROW, satellites.len(), |ui, rows| {
            for index in rows {
                let (_, row) = ui.allocate_space(vec2(body.width(), ROW));
                let before = index.checked_sub(1).and_then(|before| satellites.get(before));
                let Some(satellite) = satellites.get(index) else { continue };
                let is_first = before.is_none_or(|before| before.priority != satellite.priority);
                show_row(ui, row, time(row), model, satellite, is_first, axis, commands);
            }
        });
    });
    if let Some(frame) = frame {
        let stroke = Stroke::new(1.0, theme::tokens(ui).sat);
        ui.painter().rect_stroke(frame, 0.0, stroke, StrokeKind::Inside);
    }
    let x = axis.x(model.now);
    ui.painter().vline(x, body.y_range(), (1.75, t.t1));
    show_focus(ui, &list);
}

/// Draws day and night; the day is slightly lighter.
fn day_and_night(ui: &Ui, place: Rect, model: &Model, axis: TimeAxis) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(place, 0.0, t.bg0);
    for day in model.sky.sun_spans.iter().filter(|span| span.up) {
        if let Some(x) = axis.range(day.start, day.end) {
            ui.painter().rect_filled(Rect::from_x_y_ranges(x, place.y_range()), 0.0, t.bg1);
        }
    }
}

/// Draws the heads: days above hours.
fn heads(ui: &Ui, head: Rect, place: Rect, axis: TimeAxis) {
    let t = theme::tokens(ui);
    ui.painter().hline(head.x_range(), head.bottom() - 0.5, (1.0, t.line));
    let labels = head.with_max_x(place.left());
    let inner = labels.shrink2(vec2(PADDING, 0.0)).with_min_y(labels.bottom() - 2.0 * HOURS_UP);
    let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
    paint::text_in(ui, inner, left, "Priority", text::caption(), t.t3);
    paint::text_in(ui, inner, right, "taken", text::caption(), t.t3);
    let hour_width = axis.hour_width();
    let every = [1, 2, 3, 6, 12].into_iter().find(|hours| hour_width * *hours as f32 >= HOUR_APART);
    for time in axis.multiples(every.unwrap_or(24) * 3600) {
        let x = axis.x(time);
        let (word, y) = (format::hour_of_day(time), head.bottom() - HOURS_UP);
        if x + 10.0 < place.right() {
            let centre = Align2::CENTER_CENTER;
            paint::text(ui, pos2(x, y), centre, word, text::caption(), t.t3);
        }
    }
    let font = text::sized(12.0, Weight::SemiBold);
    let y = head.top() + HEAD / 4.0;
    let days = std::iter::once(axis.start()).chain(axis.multiples(DAY_S));
    let labels: Vec<_> = days
        .map(|time| {
            let word = format::weekday(time);
            let width = paint::text_width(ui, &word, font.clone());
            (axis.x(time).max(place.left()), width, word)
        })
        .collect();
    // If the labels of two days overlap, the later label stays. Without it, its times would lack
    // their day.
    let mut end = place.right();
    for (x, width, word) in labels.into_iter().rev() {
        if x + width <= end {
            paint::text(ui, pos2(x, y), left, &word, font.clone(), t.t1);
            end = x - 8.0;
        }
    }
}

#[allow(clippy::too_many_arguments)]
fn show_row(
    ui: &Ui,
    row: Rect,
    place: Rect,
    model: &Model,
    satellite: &PlannedSatellite<'_>,
    is_first: bool,
    axis: TimeAxis,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let selected = model.selected_pass().map(PredictedPass::key);
    let is_selected = selected.is_some_and(|(number, _)| number == satellite.number);
    let line = if is_first { t.edge } else { t.line };
    let labels = row.with_max_x(place.left());
    if is_selected {
        ui.painter().rect_filled(labels, 0.0, t.bgsel);
    }
    for time in axis.multiples(DAY_S) {
        ui.painter().vline(axis.x(time), row.y_range(), (1.0, t.edge));
    }
    ui.painter().hline(row.x_range(), row.top() + 0.5, (1.0, line));
    let inner = labels.shrink2(vec2(PADDING, 0.0));
    if is_first {
        let badge = Rect::from_min_size(inner.left_center() - vec2(0.0, 7.0), vec2(22.0, 14.0));
        ui.painter().rect_stroke(badge, 3.0, Stroke::new(1.0, t.edge), StrokeKind::Inside);
        let word = satellite.priority.number().to_string();
        paint::text(ui, badge.center(), Align2::CENTER_CENTER, word, text::caption(), t.t1);
    }
    let used =
        satellite.passes.iter().filter(|planned_pass| !planned_pass.entries.is_empty()).count();
    let count = format!("{used} / {}", satellite.passes.len());
    let drawn = paint::text_in(ui, inner, Align2::RIGHT_CENTER, &count, text::small(), t.t2);
    let room = inner.with_min_x(inner.left() + 36.0).with_max_x(drawn.left() - 6.0);
    let font = text::sized(12.0, Weight::Medium);
    paint::name_in(ui, room, Align2::LEFT_CENTER, satellite.name, font, t.t1);
    let spoken = format!(
        "{}, priority {}, {used} of {} passes taken",
        satellite.name,
        satellite.priority.number(),
        satellite.passes.len()
    );
    paint::name_text(ui, ("plan row", satellite.number), labels, &spoken);
    for planned in &satellite.passes {
        bar(ui, row, model, planned, selected, axis, commands);
    }
}

#[allow(clippy::too_many_arguments)]
fn bar(
    ui: &Ui,
    row: Rect,
    model: &Model,
    planned: &PlannedPass<'_>,
    selected: Option<(u32, Timestamp)>,
    axis: TimeAxis,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let predicted = planned.predicted;
    let pass = &predicted.pass;
    let Some(x) = axis.range(pass.aos.time, pass.los.time) else { return };
    let share = (pass.max_elevation().degrees() / 90.0).clamp(0.0, 1.0) as f32;
    let height = egui::lerp(BARS, share);
    let bottom = row.bottom() - 1.0;
    let rect = Rect::from_x_y_ranges(x, bottom - height..=bottom);
    let is_selected = selected == Some(predicted.key());
    let name = spoken(model, planned);
    let id = ui.make_persistent_id(("plan bar", predicted.key()));
    let response = ui.interact(rect.expand(1.0), id, Sense::CLICK);
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_selected, &name));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_selected(is_selected));
    if planned.entries.is_empty() {
        ui.painter().rect_stroke(rect, 0.0, Stroke::new(1.0, t.other), StrokeKind::Inside);
    } else {
        ui.painter().rect_filled(rect, 0.0, t.sat);
    }
    if planned.choice.is_some() {
        let corner = Rect::from_min_size(rect.right_top() - vec2(3.0, 0.0), vec2(3.0, 3.0));
        ui.painter().rect_filled(corner, 0.0, t.onsat);
    }
    if planned.entries.iter().any(|entry| entry.lost.is_some()) {
        let tip = pos2(rect.center().x, rect.top() - 5.0);
        let foot = rect.top() - 1.0;
        let points = vec![tip, pos2(tip.x + 3.5, foot), pos2(tip.x - 3.5, foot)];
        ui.painter().add(egui::Shape::convex_polygon(points, t.warn, Stroke::NONE));
    }
    if is_selected {
        let frame = rect.expand(2.5);
        ui.painter().rect_stroke(frame, 1.0, Stroke::new(1.5, t.ant), StrokeKind::Outside);
    }
    if response.clicked() {
        commands.push(UiCommand::SelectPass(predicted.key()));
    }
    response.on_hover_text(name);
}

/// Describes a pass for screen readers.
fn spoken(model: &Model, planned: &PlannedPass<'_>) -> String {
    let predicted = planned.predicted;
    let pass = &predicted.pass;
    let name = predicted.satellite.short_name();
    let times = format::stretch(pass.aos.time, pass.los.time, model.now);
    let max = format::degrees(pass.max_elevation().degrees(), 0);
    let choice = match planned.choice.map(|choice| choice.take) {
        Some(Take::Always) => " Always.",
        Some(Take::Never) => " Never.",
        None => "",
    };
    let antennas: Vec<&str> = planned
        .entries
        .iter()
        .map(|entry| words::schedule::antenna_name(model, entry.antenna))
        .collect();
    let subject = match planned.left_out {
        _ if !antennas.is_empty() => format!("Taken by {}.", format::list(&antennas)),
        Some(left_out) => {
            format!("Left out: {}.", words::schedule::why_left_out(model, &left_out.reason))
        }
        None => "Not planned yet.".to_owned(),
    };
    format!("{name}, {times}, {max}. {subject}{choice}")
}

/// Draws the grip above the frame of the section in the lanes. Dragging the grip or pressing arrow
/// keys moves the section. Returns the frame.
fn frame(
    ui: &Ui,
    place: Rect,
    model: &Model,
    axis: TimeAxis,
    state: &mut PlanState,
) -> Option<Rect> {
    let t = theme::tokens(ui);
    let lanes = super::lanes::axis(model, place, state);
    let x = axis.range(lanes.start(), lanes.end())?;
    let rect = Rect::from_x_y_ranges(x, place.y_range()).shrink(0.5);
    // The grip lies completely above the rows. The bars stay clickable, and screen readers read the
    // grip first.
    let grip = rect.with_max_y(rect.top() + 8.0);
    let grip = grip.expand2(vec2(4.0, 0.0)).translate(vec2(0.0, -8.5));
    let id = ui.make_persistent_id("lanes frame");
    let response = ui.interact(grip, id, Sense::drag());
    let words = format!("Part of the lanes, from {}", format::moment(lanes.start(), model.now));
    response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, &words));
    ui.painter().rect_filled(grip.shrink2(vec2(4.0, 2.0)), 2.0, t.sat);
    let by_s = if response.dragged() {
        axis.seconds_across(response.drag_delta().x)
    } else {
        f64::from(by_keys(ui, &response)) * KEY_S
    };
    if by_s != 0.0 {
        let max = (axis.seconds() - lanes.seconds()).max(0.0);
        state.lanes_after_s = (state.lanes_after_s + by_s).clamp(0.0, max);
        ui.ctx().request_repaint_after_for(
            std::time::Duration::from_millis(16),
            egui::ViewportId::ROOT,
        );
    }
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
    }
    paint::focus_ring(ui, &response, 2);
    Some(rect)
}

/// Returns the number of steps by which keys have moved the grip while it has the focus.
fn by_keys(ui: &Ui, response: &Response) -> i32 {
    if !response.has_focus() {
        return 0;
    }
    let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    ui.input_mut(|input| {
        i32::from(input.consume_key(Modifiers::NONE, Key::ArrowRight))
            - i32::from(input.consume_key(Modifiers::NONE, Key::ArrowLeft))
    })
}
