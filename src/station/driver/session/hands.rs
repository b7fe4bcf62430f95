//! Ends motions of Azel when somebody else moves the antenna.

use super::{Event, Session};
use crate::{
    clock::Moment,
    driver::{Safety, motion_watch::Foreign},
};

impl Session {
    /// Ends a motion of Azel on an antenna that somebody else has moved: two must not work against
    /// each other.
    pub(super) fn watch_hands(&mut self, now: Moment) {
        let Some(Foreign { axis, by_deg }) = self.gate.look_for_hands(now) else { return };
        let axis = self.variant.capabilities.axes.get(axis).copied().unwrap_or_default();
        let event = Event::Safety(Safety::ForeignHands { axis, off_deg: by_deg });
        if self.key.held().is_some() {
            self.key.spend();
            self.halt_quietly(now);
            self.tell(event);
        } else if self.activity.may_move() || self.stepping.is_some() {
            self.give_up(event, now);
        } else {
            self.tell(event);
        }
    }
}
