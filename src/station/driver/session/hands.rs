//! End of Azel's motions when somebody else moves the antenna.

use super::{Session, tracking::Tracking};
use crate::{
    clock::Moment,
    contract::driver::{Event, Safety},
    driver::motion_watch::Foreign,
};

impl Session {
    fn asks_to_resume(&self) -> bool {
        self.commanded.activity.program().is_some_and(Tracking::asks)
    }

    /// Ends a motion of Azel on an antenna that somebody else has moved, because two operators must
    /// not work against each other.
    pub(super) fn watch_hands(&mut self, now: Moment) {
        let Some(Foreign { axis, evidence }) = self.gate.look_for_hands(now) else { return };
        let axis = self.setup.axis_name(axis);
        let event = Event::Safety(Safety::ForeignHands { axis, evidence });
        if self.commanded.key.pressed().is_some() {
            self.commanded.key.spend();
            self.halt_quietly(now);
            self.tell(event);
        } else if self.asks_to_resume() {
            // The operator's answer still counts.
            self.tell(event);
        } else if self.commanded.activity.may_move() || self.commanded.steps_deg().is_some() {
            self.give_up(event, now);
        } else {
            self.tell(event);
        }
    }
}
