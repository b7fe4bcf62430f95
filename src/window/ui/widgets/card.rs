//! A card on the background of a form.

use egui::{Frame, Margin, Stroke, Ui};

use crate::ui::theme;

/// Shows `content` in a card at most `max` points wide.
pub fn show<R>(ui: &mut Ui, max: f32, content: impl FnOnce(&mut Ui) -> R) -> R {
    let t = theme::tokens(ui);
    Frame::new()
        .fill(t.bg1)
        .stroke(Stroke::new(1.0, t.line))
        .corner_radius(6)
        .inner_margin(Margin::same(16))
        .outer_margin(Margin { bottom: 8, ..Margin::ZERO })
        .show(ui, |ui| {
            ui.set_width(max.min(ui.available_width()));
            content(ui)
        })
        .inner
}
