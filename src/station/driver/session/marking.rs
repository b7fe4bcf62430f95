//! Promise on disk that an operator moves an antenna manually, or that Azel owes it a STOP. If this
//! program ends before standstill is proved, the next start sends STOP first.

use std::time::Duration;

use jiff::Timestamp;

use super::unit_debts::UnitDebts;
use crate::{
    astro::time::seconds_between,
    clock::{Instant, Moment},
    driver::debts::Mark,
    promises::PromisedFile,
};

/// Max wait for the disk: a slower disk must not keep the operator from moving the antenna.
pub(super) const MAX: Duration = Duration::from_millis(300);
/// Interval between two checks of the write.
const LOOK: Duration = Duration::from_millis(2);
/// Max age of a mark that needs no question to the operator, seconds: later, the state of the
/// antenna may have changed.
const OLD_S: f64 = 600.0;
/// Interval at which a session with a pending STOP refreshes its mark. The age of a mark counts
/// from the refresh.
const REFRESH: Duration = Duration::from_mins(1);
/// Interval between retries of a mark that the disk refused.
const AGAIN: Duration = Duration::from_secs(10);

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Marking(MarkState);

#[derive(Debug, Clone, Copy, Default)]
enum MarkState {
    #[default]
    None,
    /// Mark of an earlier run.
    Found { begun: Option<Timestamp> },
    /// Mark requested by this session.
    Put {
        begun: Option<Timestamp>,
        first: Instant,
        /// Time of the last request.
        last: Instant,
        /// `true` if the operator knows that the mark is not on disk.
        is_reported: bool,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MarkProgress {
    Pending,
    /// Settled mark: it is on disk, or the operator knows that it is not.
    Settled,
    /// Refused or slow write that the operator does not know of yet.
    Failed,
}

/// Returns `true` for a mark that needs a question to the operator.
pub(super) fn is_old(mark: Mark, now: Timestamp) -> bool {
    // A wrong clock wrote a mark from the future, so its age is unknown.
    mark.last_attempt().is_none_or(|time| seconds_between(time, now).abs() > OLD_S)
}

impl Marking {
    pub(super) fn found(begun: Option<Timestamp>) -> Self {
        Self(MarkState::Found { begun })
    }

    /// Follows the progress of the mark to the disk. Requests the mark if this session has not yet.
    pub(super) fn follow(&mut self, debts: &UnitDebts, now: Moment) -> MarkProgress {
        let MarkState::Put { first, is_reported, .. } = &mut self.0 else {
            self.request(debts, now);
            return MarkProgress::Pending;
        };
        let is_late = now.steady.saturating_duration_since(*first) >= MAX;
        match debts.mark_kept() {
            PromisedFile::OnDisk => {
                *is_reported = false;
                MarkProgress::Settled
            }
            PromisedFile::Pending if !is_late => MarkProgress::Pending,
            PromisedFile::Pending | PromisedFile::Failed(_) => {
                if std::mem::replace(is_reported, true) {
                    MarkProgress::Settled
                } else {
                    MarkProgress::Failed
                }
            }
        }
    }

    /// Requests the mark with the current time.
    pub(super) fn request(&mut self, debts: &UnitDebts, now: Moment) {
        let (begun, first, is_reported) = match self.0 {
            MarkState::None => (Some(now.utc), now.steady, false),
            // The debt began in the earlier run; only the attempt is new.
            MarkState::Found { begun } => (begun, now.steady, false),
            MarkState::Put { begun, first, is_reported, .. } => (begun, first, is_reported),
        };
        debts.mark(Mark { start: begun, tried: Some(now.utc) });
        self.0 = MarkState::Put { begun, first, last: now.steady, is_reported };
    }

    /// Records that the session still attends to a unit that may be moving.
    pub(super) fn refresh(&mut self, debts: &UnitDebts, now: Moment) {
        let MarkState::Put { last, .. } = self.0 else { return };
        let after = match debts.mark_kept() {
            PromisedFile::OnDisk => REFRESH,
            PromisedFile::Failed(_) => AGAIN,
            PromisedFile::Pending => return,
        };
        if now.steady.saturating_duration_since(last) >= after {
            self.request(debts, now);
        }
    }

    /// Returns the reason why the mark is not on disk.
    pub(super) fn not_on_disk(&self, debts: &UnitDebts, now: Instant) -> Option<String> {
        let MarkState::Put { first, .. } = self.0 else { return None };
        let is_late = now.saturating_duration_since(first) >= MAX;
        match debts.mark_kept() {
            PromisedFile::OnDisk => None,
            PromisedFile::Pending => is_late.then(|| "the disk has not taken it yet".to_owned()),
            PromisedFile::Failed(reason) => Some(reason),
        }
    }

    /// Returns the time of the next check whether the mark is on disk.
    pub(super) fn due(&self, debts: &UnitDebts, now: Instant) -> Option<Instant> {
        let MarkState::Put { first, .. } = self.0 else { return None };
        let is_awaited = now.saturating_duration_since(first) < MAX
            && debts.mark_kept() == PromisedFile::Pending;
        is_awaited.then_some(now + LOOK)
    }

    /// Removes the mark, because Azel owes the unit nothing any more.
    pub(super) fn remove(&mut self, debts: &UnitDebts) {
        match std::mem::take(&mut self.0) {
            MarkState::None => {}
            MarkState::Found { .. } | MarkState::Put { .. } => debts.unmark(),
        }
    }
}

#[cfg(test)]
mod tests;
