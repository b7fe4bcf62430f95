//! Leaves a unit to others, and takes it back when the operator says so.

use super::{
    Session,
    activity::Activity,
    io_loop::{Input, MIN_WAIT, next_input},
};
use crate::contract::driver::{Event, LinkState, Refusal};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    No,
    /// For a STOP only: the unit is let go again once standstill is proved.
    ForStop,
    Yes,
}

impl Session {
    /// Waits until the operator or a STOP wants a link; returns `false` to end the session.
    pub(super) async fn wait_until_wanted(&mut self) -> bool {
        self.contact.link = LinkState::Off;
        self.contact.away_since = None;
        self.gate.watch_anew();
        self.contact.loss_is_told = false;
        let clock = self.clock.clone();
        while self.contact.wanted == Wanted::No {
            let now = self.now();
            self.forget_old_stop(now);
            self.publish(now);
            let due = self.halt_due();
            let word = next_input(&mut self.wires);
            let turn = match due {
                None => word.await,
                Some(due) => tokio::select! {
                    biased;
                    turn = word => turn,
                    () = clock.sleep_until(due.max(now.steady + MIN_WAIT)) => Input::Time,
                },
            };
            // The command may have come hours later.
            let now = self.now();
            match turn {
                Input::Over => return false,
                Input::Stop => {
                    self.stop_and_void(now);
                    self.contact.wanted = Wanted::ForStop;
                }
                Input::Command(command) => self.carry_out_offline(command, now),
                Input::Bounds(bounds) => self.keep_within(*bounds),
                Input::Sleep(_) | Input::Bytes(_) | Input::Lost(_) | Input::Time => {}
            }
        }
        self.contact.link = LinkState::Connecting { since: self.now().steady };
        true
    }

    /// Leaves the unit to others, after what safety requires.
    pub(super) fn disconnect(&mut self) -> bool {
        if self.stop.is_under_way() {
            self.tell(Event::NotSent(Refusal::Stopping));
            return false;
        }
        // A motion that waits to be sent is wanted and not over, so end it.
        if self.activity.is_queued() {
            let now = self.now();
            self.halt_quietly(now);
        }
        self.contact.wanted = Wanted::No;
        self.forget_silence();
        self.activity = Activity::Standby;
        true
    }

    /// The STOP that the link was opened for is proved.
    pub(super) fn disconnect_after_stop(&mut self) -> bool {
        !self.stop.is_under_way() && self.disconnect()
    }
}
