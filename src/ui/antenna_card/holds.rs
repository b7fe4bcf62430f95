//! What the operator answers for by a hold: that the antenna stands, that it may move
//! without a dead-man, and that it may be moved out of where it must not point.

use egui::Ui;

use super::Cursor;
use crate::ui::{
    text, theme,
    widgets::{
        button,
        hold_button::{self, HoldState},
        paint,
    },
};

/// That the antenna stands.
pub(super) const SEEN_STANDING: &str = "Hold 1 s: I have seen that it stands";

/// An antenna that stands where it must not point.
#[derive(Debug, Clone, Copy)]
pub struct WayOutModel<'a> {
    /// Where, and what it may do.
    pub words: &'a str,
    /// The operator has allowed it.
    pub is_allowed: bool,
}

/// Shows `why` and the button below it. Returns true once, when it was held.
pub(super) fn show(
    ui: &Ui,
    at: &mut Cursor,
    why: &str,
    label: &str,
    state: &mut HoldState,
) -> bool {
    note(ui, at, why);
    let done = hold_button::show(ui, at.take(button::HEIGHT), label, state);
    at.skip(6.0);
    done
}

/// Shows `words` alone.
pub(super) fn note(ui: &Ui, at: &mut Cursor, words: &str) {
    let t = theme::tokens(ui);
    let taken = paint::paragraph(ui, at.at(), at.width(), words, text::small(), t.warn);
    paint::name_text(ui, ("asked", words), taken, words);
    at.y = taken.bottom() + 4.0;
}
