//! Row below the sky plot with the slider of its time.

use egui::{
    Align2, EventFilter, Key, Modifiers, Rect, Response, Sense, Stroke, Ui, WidgetInfo,
    accesskit::Action, pos2, vec2,
};
use jiff::Timestamp;

use super::SkyTime;
use crate::{
    astro::time::{add_seconds, seconds_between},
    model::Model,
    ui::{
        operate::NEXT_FRAME,
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
    },
};

const EDGE: f32 = 16.0;
const GAP: f32 = 16.0;
const KNOB: f32 = 6.0;
/// Margin above and below the part of the row that takes the pointer, points.
const GRIP: f32 = 8.0;
/// Share of the row that the slider takes, 0 to 1.
const SLIDER: f32 = 0.4;
/// Step of an arrow key, seconds.
const STEP_S: f64 = 60.0;
/// Step of Page Up and Page Down, seconds.
pub const LONG_STEP_S: f64 = 600.0;

const MOVES_NOTHING: &str = "The slider moves no antenna. To point an antenna, go back to now.";

/// Shows the row in `rect`.
pub(in crate::ui::operate) fn show(ui: &Ui, rect: Rect, model: &Model, state: &mut SkyTime) {
    let t = theme::tokens(ui);
    let before = state.time;
    let ground = if before.is_some() { t.warnbg } else { t.bg1 };
    ui.painter().rect_filled(rect, 0.0, ground);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let track = Rect::from_x_y_ranges(
        rect.left() + EDGE + KNOB..=rect.left() + SLIDER * rect.width() - KNOB,
        rect.y_range(),
    );
    slider(ui, track, model, state);
    let mut room = rect.with_min_x(track.right() + KNOB + GAP).with_max_x(rect.right() - EDGE);
    if state.time.is_some() {
        let button = Button::normal("Now");
        let size = vec2(button.width(ui), SMALL_HEIGHT);
        let place = Align2::RIGHT_CENTER.align_size_within_rect(size, room);
        if button.show(ui, "sky of now", place).clicked() {
            state.return_to_now();
        }
        room.max.x = place.left() - GAP;
    }
    say(ui, room, model, state);
    if state.time != before {
        // Draw again: the plot came before the row in this frame.
        ui.request_repaint_after_for(NEXT_FRAME, egui::ViewportId::ROOT);
    }
}

/// Shows the time of the sky, and a note that the slider moves no antenna.
fn say(ui: &Ui, room: Rect, model: &Model, state: &SkyTime) {
    let t = theme::tokens(ui);
    let (upper, lower) = room.shrink2(vec2(0.0, 2.0)).split_top_bottom_at_fraction(0.5);
    let left = Align2::LEFT_CENTER;
    let Some(words) = state.words(model) else {
        let words = match model.schedule_until() {
            Some(_) => "Sky now. Drag to see what is planned.",
            None => "Sky now. There is no plan yet to look ahead with.",
        };
        paint::text_in(ui, room, left, words, text::small(), t.t2);
        paint::name_text(ui, "sky time", room, words);
        return;
    };
    paint::text_in(ui, upper, left, &words, text::small_strong(), t.warn);
    let colour = if state.is_click_refused { t.warn } else { t.t1 };
    paint::text_in(ui, lower, left, MOVES_NOTHING, text::caption(), colour);
    paint::name_text(ui, "sky time", room, &format!("{words}. {MOVES_NOTHING}"));
}

fn slider(ui: &Ui, track: Rect, model: &Model, state: &mut SkyTime) {
    let t = theme::tokens(ui);
    let end = model.schedule_until();
    let id = ui.make_persistent_id("sky time slider");
    let sense = if end.is_some() { Sense::click_and_drag() } else { Sense::hover() };
    let response = ui.interact(track.expand2(vec2(KNOB, -GRIP)), id, sense);
    if let Some(end) = end {
        operate(ui, &response, track, model, end, state);
    }
    state.has_focus = response.has_focus();
    let span_s = end.map_or(1.0, |end| seconds_between(model.now, end));
    let after_s = state.time.map_or(0.0, |time| seconds_between(model.now, time));
    let is_open = end.is_some();
    response.widget_info(|| WidgetInfo::slider(is_open, after_s, "Time of the sky"));
    ui.ctx().accesskit_node_builder(id, |node| {
        node.set_min_numeric_value(0.0);
        node.set_max_numeric_value(span_s);
        node.set_numeric_value_step(STEP_S);
        node.set_value(state.words(model).unwrap_or_else(|| "Now".to_owned()));
        node.add_action(Action::Increment);
        node.add_action(Action::Decrement);
    });
    let y = track.center().y;
    let x = track.left() + (after_s / span_s) as f32 * track.width();
    let line = |start: f32, last: f32| Rect::from_x_y_ranges(start..=last, y - 1.5..=y + 1.5);
    let base = if state.time.is_some() { t.edge } else { t.bg3 };
    ui.painter().rect_filled(line(track.left(), track.right()), 1.0, base);
    ui.painter().rect_filled(line(track.left(), x), 1.0, t.warn);
    if is_open {
        let colour = match (state.time.is_some(), response.hovered()) {
            (true, _) => t.warn,
            (false, true) => t.t1,
            (false, false) => t.t3,
        };
        ui.painter().circle(pos2(x, y), KNOB, t.bg1, Stroke::new(2.0, colour));
    }
    paint::focus_ring(ui, &response, 3);
}

fn operate(
    ui: &Ui,
    response: &Response,
    track: Rect,
    model: &Model,
    end: Timestamp,
    state: &mut SkyTime,
) {
    let pressed = response.is_pointer_button_down_on() || response.clicked();
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| pressed) {
        // Take the focus at the first touch: the keys then move the slider.
        response.request_focus();
        let share = f64::from((pointer.x - track.left()) / track.width().max(1.0));
        let span_s = seconds_between(model.now, end);
        state.show_at(model, add_seconds(model.now, share.clamp(0.0, 1.0) * span_s));
    }
    let mut steps = ui.input(|input| {
        i32::from(input.has_accesskit_action_request(response.id, Action::Increment))
            - i32::from(input.has_accesskit_action_request(response.id, Action::Decrement))
    });
    if response.has_focus() {
        let filter = EventFilter { horizontal_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        steps += ui.input_mut(|input| {
            i32::from(input.consume_key(Modifiers::NONE, Key::ArrowRight))
                - i32::from(input.consume_key(Modifiers::NONE, Key::ArrowLeft))
        });
        if ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::End)) {
            state.show_at(model, end);
        }
    }
    if steps != 0 {
        state.step(model, f64::from(steps) * STEP_S);
    }
}
