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
const SEEN_STANDING: &str = "Hold 1 s: I have seen it at rest";

/// Shows the note on the open question about the track, and the hold buttons for the operator.
pub(super) fn show(ui: &Ui, at: &mut Cursor, card: &mut Card<'_>, state: &mut CardState) {
    let (model, antenna) = (card.model, card.antenna);
    let snapshot = &antenna.snapshot;
    if let Some(words) = state.track.about_the_question(card) {
        note(ui, at, &words);
    }
    if let Some(why) = words::asks_standing(snapshot, model.now)
        && hold(ui, at, &why, SEEN_STANDING, &mut state.standing)
    {
        card.ask(Command::SeenStanding);
    }
    way_out(ui, at, card, &mut state.way_out);
    if let Some(act) = &antenna.asks_unseen
        && let Some(action) = antenna.variant().action(act.action)
        && hold(ui, at, action.description, words::HOLD_UNSEEN, &mut state.unseen)
    {
        card.ask(Command::ActUnseen(act.clone()));
    }
    if snapshot.unguarded
        && antenna.asks_unguarded
        && hold(ui, at, words::UNGUARDED, words::HOLD_UNGUARDED, &mut state.unguarded)
    {
        card.ask(Command::AllowUnguarded);
    }
}

/// Shows the allowed motions of an antenna that points, or may point, into a forbidden direction.
/// Offers the button that allows them until the operator has pressed it.
fn way_out(ui: &Ui, at: &mut Cursor, card: &mut Card<'_>, state: &mut HoldState) {
    let AntennaModel { config, snapshot, .. } = card.antenna;
    let can_be_asked =
        snapshot.link.is_open() && snapshot.lock_out.is_none() && snapshot.intent != Intent::Track;
    let Some(inside) = snapshot.breach.as_ref().filter(|_| can_be_asked) else { return };
    let words = words::way_out(&config.name, inside);
    if inside.may_leave {
        return note(ui, at, &words);
    }
    let is_unchecked =
        inside.unknown_axis.is_some() || matches!(inside.barrier, Barrier::Unread(_));
    let label = if is_unchecked { words::HOLD_UNCHECKED } else { words::HOLD_WAY_OUT };
    if hold(ui, at, &words, label, state) {
        card.ask(Command::AllowWayOut);
    }
}

/// Shows `why` and the button below it. Returns `true` once, when the hold is complete.
fn hold(ui: &Ui, at: &mut Cursor, why: &str, label: &str, state: &mut HoldState) -> bool {
    note(ui, at, why);
    let done = hold_button::show(ui, at.take(button::HEIGHT), label, state);
    at.skip(6.0);
    done
}

fn note(ui: &Ui, at: &mut Cursor, words: &str) {
    let t = theme::tokens(ui);
    let taken = paint::paragraph(ui, at.at(), at.width(), words, text::small(), t.warn);
    paint::name_text(ui, ("asked", words), taken, words);
    at.y = taken.bottom() + 4.0;
}
