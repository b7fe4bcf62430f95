//! Report of a unit that does not answer during a motion of Azel.

use super::Session;
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Event, LinkState, Safety},
};

impl Session {
    pub(super) fn note_write(&mut self, now: Moment) {
        self.contact.silence.note_write(self.gate.state().traffic.replies, now.steady);
    }

    /// Returns `true` while a motion of Azel may run. Until STOP is proved, a motion may run even
    /// if the last position shows rest.
    fn is_in_motion(&mut self) -> bool {
        self.is_unproved()
            && (self.follows_now()
                || self.stop.is_under_way()
                || self.is_turning()
                || self.gate.state().program.is_some_and(|program| program.enabled)
                || self.commanded.is_pending()
                || self.gate.device().motion_under_way())
    }

    /// Reports a unit that does not answer during its motion, once until its next reply.
    pub(super) fn watch_silence(&mut self, now: Moment) {
        let is_watched = self.is_in_motion();
        let replies = self.gate.state().traffic.replies;
        self.contact.silence.watch(is_watched, replies, now.steady);
        // A jog that has not begun waits for its position.
        self.gate.device().watch_closely(is_watched || self.commanded.key.pressed().is_some());
        if self.silence_due().is_some_and(|time| now.steady >= time) {
            self.tell_silence();
        }
    }

    /// Reports silence if the link is lost during a motion.
    pub(super) fn tell_silence_of_lost_link(&mut self) {
        if self.is_in_motion() {
            self.tell_silence();
        }
    }

    fn tell_silence(&mut self) {
        if self.contact.silence.report() {
            self.tell(Event::Safety(Safety::SilentInMotion));
        }
    }

    /// Returns the time at which silence must be reported.
    pub(super) fn silence_due(&mut self) -> Option<Instant> {
        // A lost link raises its own alarm.
        let is_open = matches!(self.contact.link(), LinkState::Up { .. } | LinkState::Stale { .. });
        self.contact.silence.due(self.gate.device().prompt()).filter(|_| is_open)
    }
}
