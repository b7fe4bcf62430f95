//! Release of a unit to others, and its return on the operator's request.

use super::{
    Session, activity::Activity, contact::LinkNeed, io_loop::MIN_WAIT, wires::SessionInput,
};
use crate::contract::driver::{Event, Refusal};

impl Session {
    /// Waits until the operator or a STOP wants a link; returns `false` to end the session.
    pub(super) async fn wait_until_wanted(&mut self) -> bool {
        self.contact.release();
        self.gate.restart_watch();
        let clock = self.clock.clone();
        while self.contact.link_need() == LinkNeed::No {
            let now = self.now();
            self.forget_old_stop(now);
            self.publish(now);
            let due = self.halt_due();
            let word = self.wires.next();
            let turn = match due {
                None => word.await,
                Some(due) => tokio::select! {
                    biased;
                    turn = word => turn,
                    () = clock.sleep_until(due.max(now.steady + MIN_WAIT)) => SessionInput::Time,
                },
            };
            // The command may have arrived hours later.
            let now = self.now();
            match turn {
                SessionInput::Over => return false,
                SessionInput::Stop => {
                    self.stop_and_void(now);
                    self.contact.want(LinkNeed::ForStop);
                }
                SessionInput::Command(numbered) => {
                    self.carry_out_numbered(numbered, now, Self::carry_out_offline);
                }
                SessionInput::Bounds(bounds) => self.keep_within(*bounds),
                // Dropping the token lets the computer sleep: a released unit needs no STOP.
                SessionInput::Sleep(_)
                | SessionInput::Bytes(_)
                | SessionInput::Lost(_)
                | SessionInput::Time => {}
            }
        }
        let now = self.now();
        self.contact.set_connecting(now.steady);
        true
    }

    /// Releases the unit to others, after all required safety steps.
    pub(super) fn disconnect(&mut self) -> bool {
        if self.stop.is_under_way() {
            self.tell(Event::NotSent(Refusal::Stopping));
            return false;
        }
        // A queued motion is not over, so end it.
        if self.commanded.activity.is_queued() {
            let now = self.now();
            self.halt_quietly(now);
        }
        self.contact.want(LinkNeed::No);
        self.contact.silence.forget();
        self.commanded.activity = Activity::Standby;
        true
    }

    /// Closes a link opened only for a STOP, after the proof of that STOP.
    pub(super) fn disconnect_after_stop(&mut self) -> bool {
        !self.stop.is_under_way() && self.disconnect()
    }
}
