//! The line below the sentence that offers to track again after STOP.

use egui::{Align2, Rect, Ui, vec2};

use super::CardAction;
use crate::ui::{
    text, theme,
    widgets::{
        button::{self, Button},
        paint,
    },
};

/// Height of the line, with the space above it.
pub(super) const HEIGHT: f32 = button::SMALL_HEIGHT + 6.0;

/// Shows the line in the lowest part of `block`.
pub(super) fn show(ui: &Ui, block: Rect, name: &str, actions: &mut Vec<CardAction>) {
    let t = theme::tokens(ui);
    let inside = block.shrink2(vec2(12.0, 6.0));
    let inside = inside.with_min_x(block.left() + if block.width() < 300.0 { 13.0 } else { 15.0 });
    let row = inside.with_min_y(inside.bottom() - button::SMALL_HEIGHT);
    let button = Button::normal("Track again");
    let key = row.with_min_x(row.right() - button.width(ui));
    let room = row.with_max_x(key.left() - 8.0);
    let words = format!("Was tracking {name}.");
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::body(), t.t2);
    paint::name_text(ui, "was tracking", room, &words).on_hover_text(&words);
    let response = button.show(ui, "track again", key);
    let said = format!("Track {name} again");
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &said));
    if response.clicked() {
        actions.push(CardAction::TrackAgain);
    }
}
