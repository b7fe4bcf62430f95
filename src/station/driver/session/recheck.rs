//! Comparison of a unit after an outage, before its track resumes.

use super::{
    Session,
    likeness::{Compared, Recheck},
    tracking::Tracking,
};
use crate::{
    clock::Moment,
    contract::driver::{Event, Safety},
};

impl Session {
    /// Stores the state of the unit at the end of its link, unless a comparison with an earlier
    /// state is pending.
    pub(super) fn remember_likeness(&mut self) {
        // After a link without a reading, compare the unit with its state before that link.
        if !self.contact.is_unread() && self.recheck().is_none() {
            self.contact.comparison.remember(self.gate.state());
        }
    }

    /// Returns the pending comparison.
    pub(super) fn recheck(&self) -> Option<Recheck> {
        let track = self.commanded.activity.program().and_then(Tracking::recheck);
        track.or(self.contact.comparison.pending())
    }

    /// Compares the unit after an outage. If the unit is unchanged, resumes the track; otherwise
    /// asks the operator.
    pub(super) fn watch_likeness(&mut self, now: Moment) {
        let recheck = self.recheck().filter(|_| !self.contact.is_unread());
        let Some(Recheck { begun, lost }) = recheck else { return };
        let compared = self.contact.comparison.compare(self.gate.state(), begun, now.steady);
        if compared == Compared::Pending {
            return;
        }
        self.contact.comparison.end();
        let track = self.commanded.activity.program_mut().and_then(Tracking::take_recheck);
        match (compared, track) {
            (Compared::Pending | Compared::AsBefore, _) => {}
            (Compared::Unlike(unlike), Some(_)) => self.await_operator(lost, Some(unlike)),
            (Compared::Unlike(unlike), None) => {
                self.tell(Event::Safety(Safety::UnitDiffers { unlike }));
            }
        }
    }
}
