//! The line below the sentence that offers to track again after STOP, to take over what the unit
//! tracks by itself, or to take back offsets that were left on it.

use egui::{Align2, Rect, Ui, vec2};

use super::CardAction;
use crate::{
    contract::driver::OffsetChange,
    ui::{
        text, theme,
        widgets::{
            button::{self, Button},
            paint,
        },
    },
};

/// Action that one click takes; a track is given by the name of its target.
#[derive(Debug, Clone, Copy)]
pub enum Offer<'a> {
    /// It was tracked until STOP.
    TrackAgain(&'a str),
    /// The unit tracks it by itself.
    TakeOver(&'a str),
    /// The unit still adds these offsets of an earlier pass.
    TakeBack(&'a str),
}

/// Height of the line, with the space above it.
pub(super) const HEIGHT: f32 = button::SMALL_HEIGHT + 6.0;

/// Shows the line in the lowest part of `block`.
pub(super) fn show(ui: &Ui, block: Rect, offer: Offer<'_>, actions: &mut Vec<CardAction>) {
    let t = theme::tokens(ui);
    let inside = block.shrink2(vec2(12.0, 6.0));
    let inside = inside.with_min_x(block.left() + if block.width() < 300.0 { 13.0 } else { 15.0 });
    let row = inside.with_min_y(inside.bottom() - button::SMALL_HEIGHT);
    let (words, key_words, said, action) = match offer {
        Offer::TrackAgain(name) => (
            format!("Was tracking {name}."),
            "Track again",
            format!("Track {name} again"),
            CardAction::TrackAgain,
        ),
        Offer::TakeBack(added) => (
            format!("Left on the unit: {added}."),
            "Take back",
            format!("Take back {added}"),
            CardAction::Offset(OffsetChange::Zero),
        ),
        Offer::TakeOver(name) => (
            "Not by this console.".to_owned(),
            "Take over",
            format!("Take over the track of {name}"),
            CardAction::TakeOver,
        ),
    };
    let button = Button::normal(key_words);
    let key = row.with_min_x(row.right() - button.width(ui));
    let room = row.with_max_x(key.left() - 8.0);
    paint::named_text_in(
        ui,
        "offered track",
        room,
        Align2::LEFT_CENTER,
        &words,
        text::body(),
        t.t2,
    );
    let response = button.show(ui, "take the offer", key);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &said));
    if response.clicked() {
        actions.push(action);
    }
}
