//! The band that shows a lock-out for maintenance.

use egui::{Align2, Rect, Stroke, StrokeKind, Ui, pos2};

use super::CardAction;
use crate::ui::{
    icons::{self, Icon},
    text, theme,
    widgets::{button::Button, paint},
};

/// A lock-out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LockOutModel<'a> {
    /// Name of the person who locked the unit out.
    pub by: &'a str,
    /// The lock-out is not proved yet.
    pub locking: bool,
}

/// Shows the band below the sentence, with the button that ends the lock-out.
pub(super) fn band(ui: &Ui, rect: Rect, model: &LockOutModel<'_>, actions: &mut Vec<CardAction>) {
    let t = theme::tokens(ui);
    ui.painter().rect(rect, 5.0, t.warnbg, Stroke::new(1.0, t.warn), StrokeKind::Inside);
    let glyph = paint::square(pos2(rect.left() + 16.0, rect.center().y), 15.0);
    icons::paint(ui.painter(), glyph, Icon::Lock, t.warn);
    let button = Button::quiet("Remove…");
    let key = rect.shrink(4.0).with_min_x(rect.right() - 4.0 - button.width(ui));
    let state = if model.locking { "Being locked out" } else { "In maintenance" };
    let words = format!("{state} by {}", model.by);
    let room = rect.with_min_x(rect.left() + 30.0).with_max_x(key.left() - 6.0);
    paint::named_text_in(
        ui,
        "lock-out",
        room,
        Align2::LEFT_CENTER,
        &words,
        text::body_medium(),
        t.warn,
    );
    if button.show(ui, "take off", key).clicked() {
        actions.push(CardAction::Maintenance);
    }
}
