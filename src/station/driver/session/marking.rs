//! The promise on disk that an antenna is moved by hand, or is owed a STOP: if this program ends
//! before standstill is proved, the next start sends STOP first.

use std::time::Duration;

use jiff::Timestamp;

use super::unit_debts::UnitDebts;
use crate::{
    astro::time::seconds_between,
    clock::{Instant, Moment},
    driver::debts::Mark,
    promises::PromisedFile,
};

/// A slower disk must not keep the operator from moving the antenna.
pub(super) const MAX: Duration = Duration::from_millis(300);
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
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Marking(State);

#[derive(Debug, Clone, Copy, Default)]
enum State {
    #[default]
    None,
    /// An earlier run left it.
    Found { begun: Option<Timestamp> },
    /// Requested by this session.
    Put {
        begun: Option<Timestamp>,
        first: Instant,
        /// The last request.
        last: Instant,
        /// The operator knows that it is not on the disk.
        is_reported: bool,
    },
}

/// Progress of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Progress {
    Pending,
    /// It is on the disk, or the operator knows that it is not.
    Settled,
    /// The disk has refused it or is slow, and the operator does not know yet.
    Failed,
}

/// Returns `true` for a mark about which the operator must be asked.
pub(super) fn is_old(mark: Mark, now: Timestamp) -> bool {
    // A mark from the future was written by a clock that was wrong, so its age is unknown.
    mark.last_tried().is_none_or(|at| seconds_between(at, now).abs() > OLD_S)
}

impl Marking {
    pub(super) fn found(begun: Option<Timestamp>) -> Self {
        Self(State::Found { begun })
    }

    /// Follows the mark to the disk. Requests it if this session has not yet.
    pub(super) fn follow(&mut self, debts: &UnitDebts, now: Moment) -> Progress {
        let State::Put { first, is_reported, .. } = &mut self.0 else {
            self.put(debts, now);
            return Progress::Pending;
        };
        let is_late = now.steady.saturating_duration_since(*first) >= MAX;
        match debts.mark_kept() {
            PromisedFile::OnDisk => {
                *is_reported = false;
                Progress::Settled
            }
            PromisedFile::Pending if !is_late => Progress::Pending,
            PromisedFile::Pending | PromisedFile::Failed(_) => {
                if std::mem::replace(is_reported, true) {
                    Progress::Settled
                } else {
                    Progress::Failed
                }
            }
        }
    }

    /// Requests the mark, as of now.
    pub(super) fn put(&mut self, debts: &UnitDebts, now: Moment) {
        let (begun, first, is_reported) = match self.0 {
            State::None => (Some(now.utc), now.steady, false),
            // The debt began in the earlier run; only the try is new.
            State::Found { begun } => (begun, now.steady, false),
            State::Put { begun, first, is_reported, .. } => (begun, first, is_reported),
        };
        debts.mark(Mark { since: begun, tried: Some(now.utc) });
        self.0 = State::Put { begun, first, last: now.steady, is_reported };
    }

    /// Records that a unit that may be moving is still attended to.
    pub(super) fn refresh(&mut self, debts: &UnitDebts, now: Moment) {
        let State::Put { last, .. } = self.0 else { return };
        let after = match debts.mark_kept() {
            PromisedFile::OnDisk => REFRESH,
            PromisedFile::Failed(_) => AGAIN,
            PromisedFile::Pending => return,
        };
        if now.steady.saturating_duration_since(last) >= after {
            self.put(debts, now);
        }
    }

    /// Why the mark is not on the disk.
    pub(super) fn not_on_disk(&self, debts: &UnitDebts, now: Instant) -> Option<String> {
        let State::Put { first, .. } = self.0 else { return None };
        let is_late = now.saturating_duration_since(first) >= MAX;
        match debts.mark_kept() {
            PromisedFile::OnDisk => None,
            PromisedFile::Pending => is_late.then(|| "the disk has not taken it yet".to_owned()),
            PromisedFile::Failed(reason) => Some(reason),
        }
    }

    /// When to check again whether the mark is on the disk.
    pub(super) fn due(&self, debts: &UnitDebts, now: Instant) -> Option<Instant> {
        let State::Put { first, .. } = self.0 else { return None };
        let is_awaited = now.saturating_duration_since(first) < MAX
            && debts.mark_kept() == PromisedFile::Pending;
        is_awaited.then_some(now + LOOK)
    }

    /// Nothing is owed to the unit any more.
    pub(super) fn remove(&mut self, debts: &UnitDebts) {
        match std::mem::take(&mut self.0) {
            State::None => {}
            State::Found { .. } | State::Put { .. } => debts.unmark(),
        }
    }
}

#[cfg(test)]
mod tests;
