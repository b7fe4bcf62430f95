//! Records on disk of manual motions and owed STOPs, and the check of an earlier run's records.

use super::{
    Session,
    auto_track::NextStep,
    marking::{self, MarkProgress, is_old},
};
use crate::{
    clock::Moment,
    contract::driver::{Event, Safety},
};

impl Session {
    /// Requests the mark. Returns `true` if the mark is on disk or cannot be stored.
    pub(super) fn is_marked(&mut self, now: Moment) -> bool {
        if self.setup.can().ends_jogs {
            return true;
        }
        let progress = self.owed.follow_mark(now);
        self.tell_failed_mark(progress);
        progress != MarkProgress::Pending
    }

    /// Records an owed STOP on disk after the bytes of the STOP, which wait for no disk.
    pub(super) fn record_debt(&mut self, now: Moment) {
        let is_out_of_reach = self.stop.is_under_way() && !self.contact.is_open();
        if self.stop.is_pressed() || is_out_of_reach {
            let progress = self.owed.follow_mark(now);
            self.tell_failed_mark(progress);
        }
        if self.stop.is_under_way() || self.commanded.key.started().is_some() {
            self.owed.refresh_mark(now);
        }
    }

    fn tell_failed_mark(&self, progress: MarkProgress) {
        if progress == MarkProgress::Failed {
            self.tell(Event::Safety(Safety::NoMark));
        }
    }

    /// Waits briefly until the disk has stored all requests, before the program ends.
    pub(super) async fn end_marking(&mut self) {
        // A remaining file costs no more than a STOP at the next start.
        let _ = self.clock.timeout(marking::MAX, self.owed.debts().settled()).await;
    }

    /// Checks the record of an earlier run. If the unit may be moving, sends STOP first, unless the
    /// operator must decide.
    pub(super) async fn look_for_mark(&mut self) {
        if !self.owed.debts().has_marks() {
            return;
        }
        let found = self.owed.debts().find().await;
        let now = self.now();
        self.doubt_found_offsets(now);
        let Some(mark) = found else { return };
        let begun = mark.start;
        let asks = self.setup.can().waits_for_word || is_old(mark, now.utc);
        self.owed.found_mark(begun, asks);
        if asks {
            self.publish(now);
        } else {
            self.halt(now);
        }
        self.tell(Event::Safety(Safety::LeftMoving { start: begun, asks }));
    }

    /// Records an owed STOP on disk, in case the program ends before standstill is proved. A slow
    /// disk delays the STOP only briefly; the worker continues to write the mark.
    pub(super) async fn mark_debt(&mut self) {
        let now = self.now();
        if self.owed.put_mark(now) {
            self.end_marking().await;
        }
    }

    /// Records that the unit must not start on its own.
    pub(super) fn end_auto_track(&mut self) {
        if self.setup.can().has_program {
            self.owed.owe_auto_track_off();
        }
    }

    /// Disables auto-track if owed, and reads it back.
    pub(super) fn watch_auto_track(&mut self, now: Moment) {
        match self.owed.next_for_auto_track(self.gate.state(), now.steady) {
            NextStep::Wait | NextStep::Proved => {}
            NextStep::SwitchOff => self.gate.device().disable_auto(),
            NextStep::Unreadable => self.tell(Event::AutoTrackNotKnown),
        }
    }
}
