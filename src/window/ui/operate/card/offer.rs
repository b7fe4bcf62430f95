//! Line below the sentence with an offer: track again after STOP, take over the unit's own track,
//! or take back offsets left on the unit.

use egui::{Align2, Rect, Ui, vec2};

use super::offsets;
use crate::{
    contract::{
        antenna::AntennaModel,
        driver::{Command, OffsetChange},
    },
    model::UiCommand,
    ui::{
        state_sentence::short,
        text, theme,
        widgets::{
            button::{self, Button},
            paint,
        },
    },
};

/// Command with its texts: before the button, on it, and its accessible name.
pub(super) struct Offer {
    words: String,
    button: &'static str,
    name: String,
    command: UiCommand,
}

/// Height of the line with the space above it, points.
pub(super) const HEIGHT: f32 = button::SMALL_HEIGHT + 6.0;

/// Returns the first available offer: take back offsets, track again, or take over a track.
pub(super) fn available_offer(antenna: &AntennaModel) -> Option<Offer> {
    if let Some(remaining) = offsets::describe_remaining(antenna) {
        return Some(Offer {
            words: format!("Left on the unit: {remaining}."),
            button: "Take back",
            name: format!("Take back {remaining}"),
            command: UiCommand::antenna(antenna.id(), Command::Offset(OffsetChange::Zero)),
        });
    }
    if let Some(track_again) = &antenna.track_again {
        let name = short(&track_again.name);
        return Some(Offer {
            words: format!("Was tracking {name}."),
            button: "Track again",
            name: format!("Track {name} again"),
            command: UiCommand::Station(track_again.command.clone()),
        });
    }
    // Without the elements, Azel cannot watch the track.
    let can_watch = antenna.tracks_unasked() && antenna.snapshot.on_board.is_some();
    let name = antenna.tracked_name().filter(|_| can_watch).map(short)?;
    Some(Offer {
        words: "Not by this console.".to_owned(),
        button: "Take over",
        name: format!("Take over the track of {name}"),
        command: UiCommand::antenna(antenna.id(), Command::TakeOver),
    })
}

/// Shows the line in the lowest part of `block`.
pub(super) fn show(ui: &Ui, block: Rect, offer: Offer, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let inner = block.shrink2(vec2(12.0, 6.0));
    let inner = inner.with_min_x(block.left() + if block.width() < 300.0 { 13.0 } else { 15.0 });
    let row = inner.with_min_y(inner.bottom() - button::SMALL_HEIGHT);
    let Offer { words, button, name, command } = offer;
    let button = Button::normal(button);
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
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
    if response.clicked() {
        commands.push(command);
    }
}
