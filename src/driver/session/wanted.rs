//! A device that is left to others, and taken again on the operator's word.

use tokio::time::sleep_until;

use super::{
    Event, Intent, Session,
    converse::{LEAST_WAIT, Turn, next_word},
};
use crate::driver::{LinkState, Refusal};

/// What a link is wanted for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    /// The device is left to others.
    No,
    /// For a stop alone: it is let go again once standstill is proved.
    ForStop,
    /// For everything.
    Yes,
}

impl Session {
    /// Waits for the operator to want a link; `false` when the session is to end.
    /// A stop wants one: it is its first word.
    pub(super) async fn is_sent_for(&mut self) -> bool {
        self.link = LinkState::Off;
        self.away_since = None;
        self.told_lost = false;
        while self.wanted == Wanted::No {
            let now = self.now();
            self.forget_old_stop(now);
            self.publish(now);
            let due = self.halt_due();
            let word = next_word(&self.wires);
            let turn = match due {
                None => word.await,
                Some(due) => tokio::select! {
                    turn = word => turn,
                    () = sleep_until(due.max(now.steady + LEAST_WAIT).into()) => Turn::Time,
                },
            };
            // The word may have come hours later.
            let now = self.now();
            match turn {
                Turn::Over => return false,
                Turn::Stop => {
                    self.halt_and_forget(now);
                    self.wanted = Wanted::ForStop;
                }
                Turn::Command(command) => self.turn_down(command, now),
                Turn::Sleep(_) | Turn::Bytes(_) | Turn::Lost(_) | Turn::Time => {}
            }
        }
        self.link = LinkState::Connecting { since: self.now().steady };
        true
    }

    /// The operator leaves the device to others. What is owed to safety comes
    /// first.
    pub(super) fn let_go(&mut self) -> bool {
        if self.halting.is_some() {
            self.tell(Event::NotSent(Refusal::Stopping));
            return false;
        }
        self.wanted = Wanted::No;
        self.forget_silence();
        self.intent = Intent::Standby;
        self.following = None;
        true
    }

    /// The stop for which the link was opened is proved.
    pub(super) fn let_go_quietly(&mut self) -> bool {
        self.halting.is_none() && self.let_go()
    }
}
