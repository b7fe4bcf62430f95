//! Hold buttons by which the operator takes responsibility: for an antenna at rest, for a motion
//! without a dead-man, for an action into an unknown direction, or for the way out of a forbidden
//! zone.

use egui::Ui;

use super::{Card, CardState, Cursor};
use crate::{
    contract::{
        antenna::AntennaModel,
        driver::{Command, Intent},
    },
    plan::Barrier,
    ui::{
        text, theme,
        widgets::{
            button,
            hold_button::{self, HoldState},
            paint,
        },
        words,
    },
};

/// Label of the button that confirms that the antenna stands still.
const STANDSTILL_LABEL: &str = "Hold 1 s: I have seen it at rest";

/// Shows the note on the open question about the track, and the hold buttons for the operator.
pub(super) fn show(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>, state: &mut CardState) {
    let (model, antenna) = (card.model, card.antenna);
    let snapshot = &antenna.snapshot;
    if let Some(words) = state.track.question_note(card) {
        show_note(ui, cursor, &words);
    }
    if let Some(reason) = words::asks_standing(snapshot, model.now)
        && show_hold(ui, cursor, &reason, STANDSTILL_LABEL, &mut state.standing_hold)
    {
        card.queue(Command::SeenStanding);
    }
    show_way_out(ui, cursor, card, &mut state.way_out_hold);
    if let Some(act) = &antenna.asks_unseen
        && let Some(action) = antenna.variant().action(act.action)
        && show_hold(ui, cursor, action.description, words::HOLD_UNSEEN, &mut state.unseen_hold)
    {
        card.queue(Command::ActUnseen(act.clone()));
    }
    if snapshot.unguarded
        && antenna.asks_unguarded
        && show_hold(ui, cursor, words::UNGUARDED, words::HOLD_UNGUARDED, &mut state.unguarded_hold)
    {
        card.queue(Command::AllowUnguarded);
    }
}

/// Shows the allowed motions of an antenna that points, or may point, into a forbidden direction.
/// Offers the button that allows them until the operator has pressed it.
fn show_way_out(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>, state: &mut HoldState) {
    let AntennaModel { config, snapshot, .. } = card.antenna;
    let can_be_asked =
        snapshot.link.is_open() && snapshot.lock_out.is_none() && snapshot.intent != Intent::Track;
    let Some(breach) = snapshot.breach.as_ref().filter(|_| can_be_asked) else { return };
    let words = words::way_out(&config.name, breach);
    if breach.may_leave {
        return show_note(ui, cursor, &words);
    }
    let is_unchecked =
        breach.unknown_axis.is_some() || matches!(breach.barrier, Barrier::Unread(_));
    let label = if is_unchecked { words::HOLD_UNCHECKED } else { words::HOLD_WAY_OUT };
    if show_hold(ui, cursor, &words, label, state) {
        card.queue(Command::AllowWayOut);
    }
}

/// Shows `reason` and the button below it. Returns `true` once, when the hold is complete.
fn show_hold(
    ui: &Ui,
    cursor: &mut Cursor,
    reason: &str,
    label: &str,
    state: &mut HoldState,
) -> bool {
    show_note(ui, cursor, reason);
    let is_complete = hold_button::show(ui, cursor.take(button::HEIGHT), label, state);
    cursor.skip(6.0);
    is_complete
}

fn show_note(ui: &Ui, cursor: &mut Cursor, words: &str) {
    let t = theme::tokens(ui);
    let place =
        paint::paragraph(ui, cursor.position(), cursor.width(), words, text::small(), t.warn);
    paint::name_text(ui, ("asked", words), place, words);
    cursor.y = place.bottom() + 4.0;
}
