//! What the operator answers for by a hold: that the antenna stands, and that it may
//! move without a dead-man.

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
/// That it may move without a dead-man.
pub(super) const UNGUARDED: &str = "Hold 1 s to move without dead-man";

/// Shows `why` and the button below it. Returns true once, when it was held.
pub(super) fn show(
    ui: &Ui,
    at: &mut Cursor,
    why: &str,
    label: &str,
    state: &mut HoldState,
) -> bool {
    let t = theme::tokens(ui);
    let taken = paint::paragraph(ui, at.at(), at.width(), why, text::small(), t.warn);
    paint::name_text(ui, ("why", label), taken, why);
    at.y = taken.bottom() + 4.0;
    let done = hold_button::show(ui, at.take(button::HEIGHT), label, state);
    at.skip(6.0);
    done
}
