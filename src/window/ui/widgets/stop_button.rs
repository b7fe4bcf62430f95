//! The STOP button, clickable in every state and on every view.

use egui::{
    Align2, Color32, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2,
    vec2,
};

use super::paint;
use crate::ui::{
    icons::{self, Icon},
    text::{self, Weight},
    theme,
};

/// Size in a normal window, points.
pub const SIZE: Vec2 = Vec2::new(144.0, 40.0);
/// Size in a small window, points.
pub const SMALL_SIZE: Vec2 = Vec2::new(120.0, 32.0);
const RADIUS: u8 = 6;

/// Outcome of the last STOP.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StopLook<'a> {
    /// Nothing to report.
    #[default]
    Ready,
    /// A STOP without confirmation yet; rate zero is not measured.
    Stopping,
    /// A STOP that has stopped every antenna, shown for 10 s.
    AllStopped,
    /// A STOP after which an antenna still moves or does not answer.
    NotConfirmed {
        /// Sentence with the antennas that still move, and the remedy.
        text: &'a str,
    },
}

/// Shows STOP in `rect`; the response reports `clicked` in every state. The accessible name
/// contains the sentence of [`StopLook::NotConfirmed`], and the caller shows it next to the button.
/// `description` lists the antennas that STOP stops, as hover text and for screen readers.
pub fn show(ui: &Ui, rect: Rect, state: StopLook<'_>, description: &str) -> Response {
    let response = ui.interact(rect, ui.make_persistent_id("stop"), Sense::click());
    // In the frame of the click, the model does not contain the STOP yet.
    let is_told = matches!(state, StopLook::NotConfirmed { .. });
    let state = if response.clicked() && !is_told { StopLook::Stopping } else { state };
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name(state)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(description));
    let t = theme::tokens(ui);
    let outline = state == StopLook::AllStopped;
    let (fill, colour) = if outline { (Color32::TRANSPARENT, t.bad) } else { (t.stop, t.onstop) };
    ui.painter().rect(rect, RADIUS, fill, Stroke::new(2.0, t.stop), StrokeKind::Inside);
    let small = rect.height() < SIZE.y;
    let font = text::sized(if small { 16.0 } else { 18.0 }, Weight::Bold);
    if state == StopLook::Stopping {
        let inner = Stroke::new(3.0, t.onstop);
        ui.painter().rect_stroke(rect.shrink(3.0), 3.0, inner, StrokeKind::Inside);
        let font = text::sized(15.0, Weight::Bold);
        paint::text(ui, rect.center(), Align2::CENTER_CENTER, "STOPPING", font, colour);
    } else {
        let icon = if small || outline { 0.0 } else { 30.0 };
        let word = paint::text_width(ui, "STOP", font.clone());
        let cap = vec2(32.0, 18.0);
        let x = rect.center().x - (icon + word + 10.0 + cap.x) / 2.0;
        if icon > 0.0 {
            let area = paint::square(pos2(x + 9.0, rect.center().y), 20.0);
            icons::paint(ui.painter(), area, Icon::Octagon, colour);
        }
        let word_at = pos2(x + icon, rect.center().y);
        paint::text(ui, word_at, Align2::LEFT_CENTER, "STOP", font, colour);
        let left = x + icon + word + 10.0;
        let key = Rect::from_min_size(pos2(left, rect.center().y - cap.y / 2.0), cap);
        ui.painter().rect_stroke(key, 3.0, Stroke::new(1.0, colour), StrokeKind::Inside);
        let font = text::sized(11.0, Weight::Bold);
        paint::text(ui, key.center(), Align2::CENTER_CENTER, "Esc", font, colour);
    }
    paint::focus_ring(ui, &response, RADIUS);
    response.on_hover_text(description)
}

fn name(state: StopLook<'_>) -> String {
    match state {
        StopLook::Ready => "STOP".to_owned(),
        StopLook::Stopping => "STOP, stopping".to_owned(),
        StopLook::AllStopped => "STOP, all stopped".to_owned(),
        StopLook::NotConfirmed { text } => format!("STOP, not confirmed: {text}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn stop_is_clicked_in_every_state_and_size() {
        for state in [
            StopLook::Ready,
            StopLook::Stopping,
            StopLook::AllStopped,
            StopLook::NotConfirmed { text: "Satrak still moves 3 s after STOP." },
        ] {
            for size in [SIZE, SMALL_SIZE] {
                let mut window = testing::window([200.0, 80.0], 0, |ui, clicks| {
                    let rect = Rect::from_min_size(pos2(10.0, 10.0), size);
                    if show(ui, rect, state, "Stops all.").clicked() {
                        *clicks += 1;
                    }
                });
                window.get_by_role(Role::Button).click();
                window.run();
                assert_eq!(*window.state(), 1, "{state:?} {size:?}");
            }
        }
    }
}
