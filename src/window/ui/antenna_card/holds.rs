//! Buttons that the operator holds to take responsibility: the antenna stands still, it
//! may move without a dead-man, or it may leave a zone into which it must not point.

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

/// Confirms that the antenna stands still.
pub(super) const SEEN_STANDING: &str = "Hold 1 s: I have seen it at rest";

/// An antenna that points, or may point, where it must not.
#[derive(Debug, Clone, Copy)]
pub struct WayOutModel<'a> {
    /// The zone, and the motions that are allowed.
    pub words: &'a str,
    /// Label of the button that allows the motions; `None` once the operator has allowed them.
    pub hold: Option<&'static str>,
}

/// Shows `why` and the button below it. Returns `true` once, when the hold is complete.
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

pub(super) fn note(ui: &Ui, at: &mut Cursor, words: &str) {
    let t = theme::tokens(ui);
    let taken = paint::paragraph(ui, at.at(), at.width(), words, text::small(), t.warn);
    paint::name_text(ui, ("asked", words), taken, words);
    at.y = taken.bottom() + 4.0;
}
