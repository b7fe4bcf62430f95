//! The slider for the jog rate.

use egui::{
    Align2, EventFilter, Key, Modifiers, Rect, Response, Sense, Stroke, Ui, WidgetInfo,
    accesskit::Action, pos2, vec2,
};

use super::paint;
use crate::ui::{text, theme};

const KNOB: f32 = 6.0;

/// Returns the selectable rates, degrees per second: 1, 2, 5, 10 and so on from 0.01 up, and the
/// max rate of the unit.
pub fn steps(max_deg_s: f64) -> Vec<f64> {
    let mut rates = Vec::new();
    for decade in [0.01, 0.1, 1.0, 10.0] {
        for digit in [1.0, 2.0, 5.0] {
            let rate = decade * digit;
            if rate < max_deg_s - 1e-9 {
                rates.push(rate);
            }
        }
    }
    rates.push(max_deg_s);
    rates
}

/// Returns the rate `step` steps away, degrees per second, clamped to the first and the last.
pub fn stepped(rate_deg_s: f64, step: i32, max_deg_s: f64) -> f64 {
    let rates = steps(max_deg_s);
    let now = nearest(&rates, rate_deg_s);
    let by_places = step.unsigned_abs() as usize;
    let requested = if step < 0 { now.saturating_sub(by_places) } else { now + by_places };
    rates.get(requested).copied().unwrap_or(max_deg_s)
}

fn nearest(rates: &[f64], rate: f64) -> usize {
    let mut best = (0, f64::INFINITY);
    for (index, candidate) in rates.iter().enumerate() {
        let distance = (candidate - rate).abs();
        if distance < best.1 {
            best = (index, distance);
        }
    }
    best.0
}

/// Shows name, slider and value in `rect`. Changes `rate_deg_s` and keeps it within the rates of
/// the unit.
pub fn show(ui: &Ui, rect: Rect, max_deg_s: f64, locked: bool, rate_deg_s: &mut f64) {
    let t = theme::tokens(ui);
    *rate_deg_s = rate_deg_s.min(max_deg_s);
    let rates = steps(max_deg_s);
    let y = rect.center().y;
    paint::text(ui, rect.left_center(), Align2::LEFT_CENTER, "Rate", text::small(), t.t2);
    let track = rect.with_min_x(rect.left() + 40.0).with_max_x(rect.right() - 68.0);
    let id = ui.make_persistent_id("rate");
    let sense = if locked { Sense::hover() } else { Sense::click_and_drag() };
    let response = ui.interact(track.expand2(vec2(KNOB, 0.0)), id, sense);
    if !locked {
        operate(ui, &response, track, &rates, rate_deg_s);
    }
    let value = *rate_deg_s;
    response.widget_info(|| WidgetInfo::slider(!locked, value, "Jog rate, degrees per second"));
    ui.ctx().accesskit_node_builder(id, |node| {
        node.set_min_numeric_value(rates.first().copied().unwrap_or_default());
        node.set_max_numeric_value(max_deg_s);
        node.add_action(Action::Increment);
        node.add_action(Action::Decrement);
    });
    let part = nearest(&rates, value) as f32 / (rates.len() - 1).max(1) as f32;
    let x = track.left() + part * track.width();
    let line = |start: f32, end: f32| {
        Rect::from_min_max(pos2(start, y - 1.5), pos2(end.max(start), y + 1.5))
    };
    ui.painter().rect_filled(line(track.left(), track.right()), 1.0, t.bg3);
    ui.painter().rect_filled(line(track.left(), x), 1.0, t.edge);
    let stroke = Stroke::new(2.0, if response.hovered() { t.t1 } else { t.t3 });
    ui.painter().circle(pos2(x, y), KNOB, t.bg1, stroke);
    let words = format!("{value:.2} °/s");
    let colour = if locked { t.t2 } else { t.t1 };
    paint::text(ui, rect.right_center(), Align2::RIGHT_CENTER, words, text::small(), colour);
    paint::focus_ring(ui, &response, 3);
}

fn operate(ui: &Ui, response: &Response, track: Rect, rates: &[f64], rate_deg_s: &mut f64) {
    let max = rates.last().copied().unwrap_or_default();
    if (response.is_pointer_button_down_on() || response.clicked())
        && let Some(position) = response.interact_pointer_pos()
    {
        let part = ((position.x - track.left()) / track.width().max(1.0)).clamp(0.0, 1.0);
        let index = (part * (rates.len() - 1) as f32).round() as usize;
        *rate_deg_s = rates.get(index).copied().unwrap_or(max);
    }
    let mut step = ui.input(|input| {
        i32::from(input.has_accesskit_action_request(response.id, Action::Increment))
            - i32::from(input.has_accesskit_action_request(response.id, Action::Decrement))
    });
    if response.has_focus() {
        let filter = EventFilter { horizontal_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        step += ui.input_mut(|input| {
            i32::from(input.consume_key(Modifiers::NONE, Key::ArrowRight))
                - i32::from(input.consume_key(Modifiers::NONE, Key::ArrowLeft))
        });
    }
    if step != 0 {
        *rate_deg_s = stepped(*rate_deg_s, step, max);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui::Role;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn steps_end_at_what_the_unit_does() {
        assert_eq!(steps(3.0).last(), Some(&3.0));
        assert_eq!(steps(1.0).last_chunk(), Some(&[0.5, 1.0]));
        assert!((stepped(0.5, 1, 3.0) - 1.0).abs() < 1e-9);
        assert!((stepped(3.0, 1, 3.0) - 3.0).abs() < 1e-9);
        assert!((stepped(0.01, -4, 3.0) - 0.01).abs() < 1e-9);
    }

    #[test]
    fn the_slider_is_worked_by_pointer_and_by_keys() {
        let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(155.0, 24.0));
        let mut window = testing::window([200.0, 60.0], 0.5, move |ui, rate| {
            show(ui, rect, 3.0, false, rate);
        });
        let slider = window.get_by_role(Role::Slider).rect();
        window.drag_at(slider.right_center() - vec2(2.0, 0.0));
        window.step();
        window.drop_at(slider.right_center() - vec2(2.0, 0.0));
        window.step();
        assert!((window.state() - 3.0).abs() < 1e-9);
        window.get_by_role(Role::Slider).focus();
        window.run();
        window.key_press(Key::ArrowLeft);
        window.run();
        assert!((window.state() - 2.0).abs() < 1e-9);
    }
}
