//! The promise on disk that an antenna is moved by hand, or is owed a STOP: if this program ends
//! before standstill is proved, the next start sends STOP first.

use std::time::Duration;

use jiff::Timestamp;
use tokio::task::spawn_blocking;

use super::Session;
use crate::{
    astro::time::seconds_between,
    clock::{Instant, Moment},
    contract::driver::{Event, LeftMoving, Safety},
    driver::debts::Mark,
    promises::Kept,
};

/// A slower disk must not keep the operator from moving the antenna.
const MAX: Duration = Duration::from_millis(300);
/// Interval at which the write is checked.
const LOOK: Duration = Duration::from_millis(2);
/// Above this age the operator is asked: much may have been done at the antenna since.
const OLD_S: f64 = 600.0;
/// Interval at which a session that still tries says so in its mark. The age of a mark counts from
/// then.
const REFRESH: Duration = Duration::from_mins(1);
/// Interval at which a mark that the disk did not take is written again.
const AGAIN: Duration = Duration::from_secs(10);

/// The mark of one antenna.
#[derive(Debug, Clone, Copy)]
pub(super) enum Marking {
    None,
    /// An earlier run left it.
    Found {
        since: Option<Timestamp>,
    },
    /// Requested by this session.
    Put {
        since: Option<Timestamp>,
        first: Instant,
        /// The last request.
        last: Instant,
        /// The operator knows that it is not on the disk.
        is_told: bool,
    },
}

impl Session {
    /// Returns `true` if the mark is on the disk or cannot be had; requests it.
    pub(super) fn is_marked(&mut self, now: Moment) -> bool {
        if self.variant.capabilities.ends_jogs || !self.owed.debts.has_marks() {
            return true;
        }
        self.follow_marking(now)
    }

    /// Records on disk that a STOP is owed. It comes after the bytes of the STOP, which wait for no
    /// disk.
    pub(super) fn record_debt(&mut self, now: Moment) {
        if !self.owed.debts.has_marks() {
            return;
        }
        let is_out_of_reach = self.stop.is_under_way() && !self.contact.link.is_open();
        if self.stop.is_pressed() || is_out_of_reach {
            self.follow_marking(now);
        }
        self.refresh_mark(now);
    }

    /// Returns `true` if the mark is on the disk, or the disk has refused it or is slow. Requests
    /// it if this session has not yet.
    fn follow_marking(&mut self, now: Moment) -> bool {
        let Marking::Put { first, is_told, .. } = &mut self.owed.marking else {
            self.put_mark(now);
            return false;
        };
        let is_late = now.steady.saturating_duration_since(*first) >= MAX;
        match self.owed.debts.mark_kept(&self.owed.unit) {
            Kept::OnDisk => {
                *is_told = false;
                true
            }
            Kept::Pending if !is_late => false,
            Kept::Pending | Kept::Failed(_) => {
                if !std::mem::replace(is_told, true) {
                    self.tell(Event::Safety(Safety::NoMark));
                }
                true
            }
        }
    }

    /// Requests the mark, as of now.
    fn put_mark(&mut self, now: Moment) {
        let (since, first, is_told) = match self.owed.marking {
            Marking::None => (Some(now.utc), now.steady, false),
            Marking::Found { since } => (since, now.steady, false),
            Marking::Put { since, first, is_told, .. } => (since, first, is_told),
        };
        let mark = Mark { since, tried: Some(now.utc) };
        self.owed.debts.mark(&self.owed.unit, self.owed.number, mark);
        self.owed.marking = Marking::Put { since, first, last: now.steady, is_told };
    }

    /// Records that a unit that may be moving is still attended to.
    fn refresh_mark(&mut self, now: Moment) {
        let Marking::Put { last, .. } = self.owed.marking else { return };
        if !self.stop.is_under_way() && self.key.started().is_none() {
            return;
        }
        let after = match self.owed.debts.mark_kept(&self.owed.unit) {
            Kept::OnDisk => REFRESH,
            Kept::Failed(_) => AGAIN,
            Kept::Pending => return,
        };
        if now.steady.saturating_duration_since(last) >= after {
            self.put_mark(now);
        }
    }

    /// Why the next start would not know that a STOP is owed.
    pub(super) fn not_on_disk(&self, now: Moment) -> Option<String> {
        if !self.stop.is_pressed() {
            return None;
        }
        if !self.owed.debts.has_marks() {
            return Some("this user has no folder for it".to_owned());
        }
        let Marking::Put { first, .. } = self.owed.marking else { return None };
        let is_late = now.steady.saturating_duration_since(first) >= MAX;
        match self.owed.debts.mark_kept(&self.owed.unit) {
            Kept::OnDisk => None,
            Kept::Pending => is_late.then(|| "the disk has not taken it yet".to_owned()),
            Kept::Failed(why) => Some(why),
        }
    }

    /// When to check again whether the mark is on the disk.
    pub(super) fn marking_due(&self, now: Instant) -> Option<Instant> {
        let Marking::Put { first, .. } = self.owed.marking else { return None };
        let is_awaited = now.saturating_duration_since(first) < MAX
            && self.owed.debts.mark_kept(&self.owed.unit) == Kept::Pending;
        is_awaited.then_some(now + LOOK)
    }

    /// Standstill is proved: nothing is owed to the unit any more.
    pub(super) fn settle_debt(&mut self) {
        self.owed.debts.settle(&self.owed.unit);
        self.owed.left_moving = None;
        match std::mem::replace(&mut self.owed.marking, Marking::None) {
            Marking::None => {}
            Marking::Found { .. } | Marking::Put { .. } => {
                self.owed.debts.unmark(&self.owed.unit, self.owed.number);
            }
        }
    }

    /// Waits a moment until the disk has taken all requests, which the end of the program would
    /// cut off.
    pub(super) async fn end_marking(&mut self) {
        // A file that stays costs no more than a STOP at the next start.
        let _ = self.clock.timeout(MAX, self.owed.debts.settled(&self.owed.unit)).await;
    }

    /// Checks what an earlier run left on the unit. If that may be moving, STOP is sent first,
    /// unless the operator must decide.
    pub(super) async fn look_for_mark(&mut self) {
        if !self.owed.debts.has_marks() {
            return;
        }
        let (debts, unit, number) =
            (self.owed.debts.clone(), self.owed.unit.clone(), self.owed.number);
        let looking = spawn_blocking(move || {
            debts.find_shifted(&unit);
            debts.take_over_mark(&unit, number)
        });
        let found = looking.await;
        let now = self.now();
        self.doubt_found_offsets(now);
        let Ok(Some(mark)) = found else { return };
        let since = mark.since;
        let asks = self.variant.capabilities.waits_for_word
            || mark.last_tried().is_none_or(|at| seconds_between(at, now.utc).abs() > OLD_S);
        self.owed.marking = Marking::Found { since };
        if asks {
            self.owed.left_moving = Some(LeftMoving { since });
            self.publish(now);
        } else {
            self.halt(now);
        }
        self.tell(Event::Safety(Safety::LeftMoving { since, asks }));
    }

    /// Records on disk that a STOP is owed, for a program that ends before it is proved. A slow
    /// disk holds the STOP up only for a moment; the mark is written meanwhile.
    pub(super) async fn mark_debt(&mut self) {
        if self.owed.debts.has_marks() {
            let now = self.now();
            self.put_mark(now);
            self.end_marking().await;
        }
    }
}

#[cfg(test)]
mod tests;
