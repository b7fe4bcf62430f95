//! Sentences while the unit does not answer.

use super::{Spoken, short};
use crate::{
    contract::{
        antenna::{Answers, AntennaModel},
        claim::HeldBy,
        driver::{LinkLoss, LinkState, StopState},
    },
    model::Model,
    ui::{format, widgets::sentence::SentenceKind, words},
};

pub(super) fn sentence(model: &Model, antenna: &AntennaModel) -> Option<Spoken> {
    let name = &antenna.config.name;
    let address = &antenna.config.connection.address;
    let state = &antenna.snapshot.state;
    let unreadable =
        state.unreadable.and_then(|explanation| unreadable(model, antenna, explanation));
    if unreadable.is_some() {
        return unreadable;
    }
    match antenna.answers(model.steady) {
        Answers::InTime if state.measured.is_none() => Some(
            Spoken::new(SentenceKind::Holding)
                .plain(format!("{name} is connected and is being read.")),
        ),
        Answers::InTime => None,
        Answers::Off => Some(Spoken::new(SentenceKind::Holding).plain(switched_off(antenna))),
        Answers::Connecting => Some(
            Spoken::new(SentenceKind::Holding).plain(format!("Connecting to {name} at {address}.")),
        ),
        Answers::Late(_) | Answers::Silent(_) if is_stopping(antenna) => None,
        answers @ Answers::Late(_) => {
            let age = format::age(answers.overdue()?.as_secs_f64());
            let words = format!("{name} answers late: its position is {age} old. ");
            let spoken = Spoken::new(SentenceKind::Caution).plain(words);
            Some(what_it_did(spoken, antenna).plain("Check its cable and the network."))
        }
        // The sentence states no current state, because Azel does not know it.
        Answers::Silent(age) => {
            let silence = format!("No reply from {name} for {}. ", format::age(age.as_secs_f64()));
            let spoken = Spoken::new(SentenceKind::Caution).plain(silence);
            let next = "Azel connects again if it stays silent.";
            Some(what_it_did(spoken, antenna).plain(next))
        }
        Answers::Lost(age) => {
            let LinkState::Lost { reason, retry_at, .. } = &antenna.snapshot.link else {
                return None;
            };
            let retry_s = retry_at.saturating_duration_since(model.steady).as_secs_f64();
            let spoken = Spoken::new(SentenceKind::Fault).plain(format!(
                "No reply from {name} for {}: {}. ",
                format::age(age.as_secs_f64()),
                words::link_loss(reason)
            ));
            // A connection that the unit closes immediately may appear as a reset.
            let is_turned_away =
                matches!(reason, LinkLoss::Refused(_) | LinkLoss::Closed | LinkLoss::Broken(_));
            let spoken = match antenna.spec().closed_note.filter(|_| is_turned_away) {
                Some(note) => spoken.plain(format!("{note} ")),
                None => spoken,
            };
            Some(
                what_it_did(spoken, antenna)
                    .plain(format!("Next try in {}.", format::age(retry_s.ceil()))),
            )
        }
    }
}

/// Returns `true` for an unconfirmed stop, which is more severe than a lost link.
fn is_stopping(antenna: &AntennaModel) -> bool {
    matches!(antenna.snapshot.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. })
}

/// Returns the sentence for a link that is off: the reason, and how to connect.
fn switched_off(antenna: &AntennaModel) -> String {
    let name = &antenna.config.name;
    if let Some(HeldBy::Unknown(reason)) = &antenna.held_by {
        return format!(
            "{name} is not connected: Azel could not lock it ({reason}), so another program may be driving \
             it. Free disk space or fix the permissions of the folder of locks."
        );
    }
    if let Some(holder) = &antenna.held_by {
        return format!("{name} is driven by {holder}. Nothing goes to it from here.");
    }
    if antenna.variant().capabilities.waits_for_word {
        return format!(
            "{name} is not connected. Azel sends it nothing until you press Connect: connecting \
             may lock out somebody at its panel."
        );
    }
    format!(
        "{name} is not connected, so another program can use it. Press Connect to open the link \
         again."
    )
}

/// Returns the sentence for a unit whose values Azel cannot read.
fn unreadable(model: &Model, antenna: &AntennaModel, reason: &str) -> Option<Spoken> {
    let again = match antenna.snapshot.link {
        LinkState::Off | LinkState::Connecting { .. } => return None,
        LinkState::Lost { retry_at, .. } => {
            let retry_s = retry_at.saturating_duration_since(model.steady).as_secs_f64();
            format!(" Next try in {}.", format::age(retry_s.ceil()))
        }
        LinkState::Up { .. } | LinkState::Stale { .. } if is_stopping(antenna) => return None,
        LinkState::Up { .. } | LinkState::Stale { .. } => String::new(),
    };
    let spoken = Spoken::new(SentenceKind::Fault)
        .plain(format!("The position of {} cannot be read. ", antenna.config.name));
    Some(what_it_did(spoken, antenna).plain(format!("{reason}{again}")))
}

/// Appends the last known activity, which may continue.
fn what_it_did(spoken: Spoken, antenna: &AntennaModel) -> Spoken {
    let state = &antenna.snapshot.state;
    let moving = state.measured.is_some_and(|measured| measured.moving());
    if state.program.is_some_and(|program| program.enabled) {
        // A new link has no satellite until the unit reports it again.
        let current = state.on_board.satellite.as_ref().map(|satellite| satellite.name.as_str());
        let name = current.or(antenna.errors_of.as_deref());
        return spoken
            .plain("It was tracking ")
            .bold(name.map_or("a satellite", short))
            .plain(" and is probably still moving. ");
    }
    if moving {
        return spoken.plain("It was moving and is probably still moving. ");
    }
    spoken
}
