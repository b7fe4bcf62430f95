//! Records on disk that the antenna is moved by hand or is owed a STOP, and looks at what an
//! earlier run recorded.

use super::{
    Session,
    auto_track::NextStep,
    marking::{self, Progress, is_old},
};
use crate::{
    clock::Moment,
    contract::driver::{Event, Safety},
};

impl Session {
    /// Returns `true` if the mark is on the disk or cannot be had; requests it.
    pub(super) fn is_marked(&mut self, now: Moment) -> bool {
        if self.setup.can().ends_jogs {
            return true;
        }
        let progress = self.owed.follow_mark(now);
        self.tell_failed_mark(progress);
        progress != Progress::Pending
    }

    /// Records on disk that a STOP is owed. It comes after the bytes of the STOP, which wait for no
    /// disk.
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

    fn tell_failed_mark(&self, progress: Progress) {
        if progress == Progress::Failed {
            self.tell(Event::Safety(Safety::NoMark));
        }
    }

    /// Waits a moment until the disk has taken all requests, which the end of the program would
    /// cut off.
    pub(super) async fn end_marking(&mut self) {
        // A file that stays costs no more than a STOP at the next start.
        let _ = self.clock.timeout(marking::MAX, self.owed.debts().settled()).await;
    }

    /// Checks what an earlier run left on the unit. If that may be moving, STOP is sent first,
    /// unless the operator must decide.
    pub(super) async fn look_for_mark(&mut self) {
        if !self.owed.debts().has_marks() {
            return;
        }
        let found = self.owed.debts().find().await;
        let now = self.now();
        self.doubt_found_offsets(now);
        let Some(mark) = found else { return };
        let begun = mark.since;
        let asks = self.setup.can().waits_for_word || is_old(mark, now.utc);
        self.owed.found_mark(begun, asks);
        if asks {
            self.publish(now);
        } else {
            self.halt(now);
        }
        self.tell(Event::Safety(Safety::LeftMoving { start: begun, asks }));
    }

    /// Records on disk that a STOP is owed, for a program that ends before it is proved. A slow
    /// disk holds the STOP up only for a moment; the mark is written meanwhile.
    pub(super) async fn mark_debt(&mut self) {
        let now = self.now();
        if self.owed.put_mark(now) {
            self.end_marking().await;
        }
    }

    /// From now on the unit is not to start by itself.
    pub(super) fn end_auto_track(&mut self) {
        if self.setup.can().has_program {
            self.owed.owe_auto_track_off();
        }
    }

    /// Switches auto-track off where that is owed, and reads it back.
    pub(super) fn watch_auto_track(&mut self, now: Moment) {
        match self.owed.next_for_auto_track(self.gate.state(), now.steady) {
            NextStep::Wait | NextStep::Proved => {}
            NextStep::SwitchOff => self.gate.device().disable_auto(),
            NextStep::Unreadable => self.tell(Event::AutoTrackNotKnown),
        }
    }
}
