//! A button that the operator must hold for a second: Park, Unlock, SSPA on.

use std::time::Duration;

use egui::{Align2, Key, Rect, Response, Stroke, StrokeKind, Ui, ViewportId, pos2, vec2};

use super::{button::RADIUS, paint};
use crate::ui::{text, theme};

/// Time for which the operator must hold the button, seconds.
pub const HOLD_S: f64 = 1.0;
const FRAME: Duration = Duration::from_millis(33);

/// Progress of the hold.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum HoldState {
    #[default]
    Released,
    /// Held since this time, seconds of the window's clock.
    Since(f64),
    /// Held to the end, but not released yet.
    Done,
}

impl HoldState {
    /// Advances by one frame. Returns `true` once, at the end of the hold.
    fn step(&mut self, is_held: bool, now_s: f64) -> bool {
        *self = match (*self, is_held) {
            (_, false) => Self::Released,
            (Self::Released, true) => Self::Since(now_s),
            (Self::Since(since_s), true) if now_s - since_s >= HOLD_S => {
                *self = Self::Done;
                return true;
            }
            (state, true) => state,
        };
        false
    }

    /// Returns the elapsed part of the hold, 0 to 1.
    fn part(self, now_s: f64) -> f32 {
        match self {
            Self::Released => 0.0,
            Self::Since(since_s) => ((now_s - since_s) / HOLD_S).clamp(0.0, 1.0) as f32,
            Self::Done => 1.0,
        }
    }
}

/// Shows the button in `rect`. Returns `true` once, at the end of the hold; an earlier release does
/// nothing. `text` must mention the hold, such as "Hold 1 s to park".
pub fn show(ui: &Ui, rect: Rect, text: &str, state: &mut HoldState) -> bool {
    let t = theme::tokens(ui);
    let (response, done) = draw_held(ui, rect, text, true, state);
    ui.painter().rect_filled(rect, RADIUS, t.warnbg);
    let edge = rect.left() + part(ui, state) * rect.width();
    ui.painter_at(rect.with_max_x(edge)).rect_filled(rect, RADIUS, t.bgsel);
    ui.painter().rect_stroke(rect, RADIUS, Stroke::new(1.0, t.warn), StrokeKind::Inside);
    if edge > rect.left() {
        let y = rect.bottom() - 2.0;
        ui.painter().line_segment([pos2(rect.left() + 2.0, y), pos2(edge, y)], (2.0, t.warn));
    }
    let room = rect.shrink2(vec2(6.0, 0.0));
    paint::text_in(ui, room, Align2::CENTER_CENTER, text, text::body_medium(), t.t1);
    paint::focus_ring(ui, &response, RADIUS);
    done
}

/// Handles a control in `rect` that must be held for a second, by pointer or key; the caller draws
/// it. Returns `true` once, at the end of the hold. `name` must mention the hold.
pub fn draw_held(
    ui: &Ui,
    rect: Rect,
    name: &str,
    enabled: bool,
    state: &mut HoldState,
) -> (Response, bool) {
    let response = paint::held_control(ui, ("hold", name), rect, enabled, name);
    let (now_s, keys, window_has_focus) = ui.input(|input| {
        (input.time, input.key_down(Key::Space) || input.key_down(Key::Enter), input.focused)
    });
    let is_held = enabled
        && window_has_focus
        && (response.is_pointer_button_down_on() || (response.has_focus() && keys));
    let done = state.step(is_held, now_s);
    if matches!(state, HoldState::Since(_)) {
        ui.ctx().request_repaint_after_for(FRAME, ViewportId::ROOT);
    }
    (response, done)
}

/// Returns the elapsed part of the hold, 0 to 1.
pub fn part(ui: &Ui, state: &HoldState) -> f32 {
    state.part(ui.input(|input| input.time))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn a_whole_second_counts_once() {
        let mut state = HoldState::default();
        assert!(!state.step(true, 10.0));
        assert!(!state.step(true, 10.9));
        assert!(state.step(true, 11.0));
        assert!(!state.step(true, 12.5));
        assert!(!state.step(false, 12.6));
        assert_eq!(state, HoldState::Released);
    }

    #[test]
    fn releasing_early_starts_again() {
        let mut state = HoldState::default();
        state.step(true, 10.0);
        state.step(false, 10.9);
        assert!(!state.step(true, 10.95));
        assert!(!state.step(true, 11.5));
    }

    #[test]
    fn the_pointer_holds_the_button() {
        let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(140.0, 32.0));
        let mut window =
            testing::window([200.0, 80.0], (HoldState::default(), 0), |ui, (state, done)| {
                if show(ui, rect, "Hold 1 s to park", state) {
                    *done += 1;
                }
            });
        window.get_by_label("Hold 1 s to park");
        window.drag_at(rect.center());
        // Each step is a quarter of a second.
        window.run_steps(3);
        assert_eq!(window.state().1, 0);
        window.run_steps(4);
        assert_eq!(window.state().1, 1);
        window.drop_at(rect.center());
        window.run_steps(2);
        assert_eq!(*window.state(), (HoldState::Released, 1));
    }
}
