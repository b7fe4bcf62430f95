//! Change of the offsets of a track that the unit computes, from the request to the read-back.

use std::time::Duration;

use jiff::Timestamp;

use crate::{
    astro::TrackOffsets,
    clock::Instant,
    contract::driver::{LeftOffsets, SESSION_TICKETS},
};

/// Interval between two checks of the write of a record.
const LOOK: Duration = Duration::from_millis(2);
/// Max time in which a unit applies a setting; an assumption of Azel.
const APPLIED: Duration = Duration::from_mins(1);
/// First and longest wait before Azel retries a removal.
const AGAIN: Duration = Duration::from_secs(10);
const MAX_AGAIN: Duration = Duration::from_mins(10);

/// Offsets of the unit's own track, and their current change.
#[derive(Default)]
pub(in crate::driver::session) struct Shifting {
    step: ShiftStep,
    /// Offsets that the operator wants, until they take effect.
    requested: Option<TrackOffsets>,
    /// Previous values of `requested`, for undo, the oldest first.
    earlier: Vec<TrackOffsets>,
    /// Time of the last reading before a change failed to read back: the offsets are unknown until
    /// a later reading.
    unread_since: Option<Timestamp>,
    /// Time until which the unit may still apply a change that did not read back.
    doubt_ends: Option<Instant>,
    /// Reason why the written offsets are still on the unit.
    left: Option<LeftOffsets>,
    /// Time of the next attempt of a removal, and the wait before it.
    again: Option<(Instant, Duration)>,
    tickets: u64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum ShiftStep {
    #[default]
    None,
    /// Record on disk, in progress, of the unit's previous offsets and of its offsets with
    /// `requested`.
    Marking { requested: TrackOffsets },
    /// Change on its way to the unit.
    Writing { ticket: u64 },
}

/// Certainty of the unit's offsets after a change that did not read back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OffsetCertainty {
    Sure,
    /// Change that the unit may still apply.
    Unsure,
    /// Change that the unit no longer applies; Azel must read the unit again.
    MustRead,
}

impl Shifting {
    pub(super) fn step(&self) -> ShiftStep {
        self.step
    }

    pub(super) fn is_idle(&self) -> bool {
        self.step == ShiftStep::None
    }

    pub(in crate::driver::session) fn is_writing(&self) -> bool {
        matches!(self.step, ShiftStep::Writing { .. })
    }

    pub(super) fn is_changing(&self) -> bool {
        self.requested.is_some() || !self.is_idle()
    }

    pub(super) fn requested(&self) -> Option<TrackOffsets> {
        self.requested
    }

    /// Returns `true` during the removal of all added offsets, by the operator or at the end of the
    /// track.
    pub(super) fn is_taking_back(&self) -> bool {
        self.requested.is_some_and(TrackOffsets::is_none)
    }

    /// Returns the offsets before the last change.
    pub(super) fn last_earlier(&self) -> Option<TrackOffsets> {
        self.earlier.last().copied()
    }

    /// Stores the offsets before a change, for undo.
    pub(super) fn remember(&mut self, before: TrackOffsets) {
        self.earlier.push(before);
    }

    pub(super) fn drop_last_earlier(&mut self) {
        self.earlier.pop();
    }

    pub(super) fn forget_earlier(&mut self) {
        self.earlier.clear();
    }

    /// Requests the offsets that the operator wants, and forgets earlier failures.
    pub(super) fn request(&mut self, requested: TrackOffsets) {
        self.forget_failures();
        self.requested = Some(requested);
    }

    /// Requests the removal of all added offsets after the track.
    pub(super) fn take_back(&mut self) {
        self.requested = Some(TrackOffsets::NONE);
    }

    pub(super) fn forget_failures(&mut self) {
        (self.left, self.again) = (None, None);
    }

    pub(super) fn begin_marking(&mut self, requested: TrackOffsets) {
        self.step = ShiftStep::Marking { requested };
    }

    pub(super) fn begin_writing(&mut self, ticket: u64) {
        self.step = ShiftStep::Writing { ticket };
    }

    pub(super) fn end_step(&mut self) {
        self.step = ShiftStep::None;
    }

    /// Clears the request, because the wanted offsets are in effect.
    pub(super) fn is_in_force(&mut self) {
        self.requested = None;
    }

    pub(super) fn next_ticket(&mut self) -> u64 {
        self.tickets += 1;
        SESSION_TICKETS + self.tickets
    }

    /// Drops the wanted offsets, and the undo steps that would change nothing.
    pub(super) fn forget_request(&mut self, in_force: Option<TrackOffsets>) {
        self.requested = None;
        while self.earlier.last().is_some_and(|last| Some(*last) == in_force) {
            self.earlier.pop();
        }
    }

    /// Voids a change after a halt, unless the change is already on its way to the unit.
    pub(in crate::driver::session) fn void(&mut self, in_force: Option<TrackOffsets>) {
        if let ShiftStep::Marking { .. } = self.step {
            self.step = ShiftStep::None;
        }
        self.forget_request(in_force);
    }

    /// Ends a change after the loss of the link. Returns `false` without a current change.
    pub(super) fn lose(&mut self, now: Instant) -> bool {
        match std::mem::take(&mut self.step) {
            ShiftStep::None => return false,
            ShiftStep::Marking { .. } => {}
            ShiftStep::Writing { .. } => self.doubt(now),
        }
        true
    }

    /// Records that the unit may apply a change late.
    pub(super) fn doubt(&mut self, now: Instant) {
        self.doubt_ends = Some(now + APPLIED);
    }

    /// Returns `true` if Azel has read back every change, or has read the unit after the doubt
    /// ended.
    pub(super) fn is_sure(&self) -> bool {
        self.doubt_ends.is_none()
    }

    /// Returns `true` unless the unit may apply a change later than `now`.
    pub(super) fn is_settled(&self, now: Instant) -> bool {
        self.doubt_ends.is_none_or(|end| end <= now)
    }

    /// Ends a doubt whose time is over.
    pub(super) fn certainty(&mut self, now: Instant) -> OffsetCertainty {
        match self.doubt_ends {
            None => OffsetCertainty::Sure,
            Some(end) if end <= now => {
                self.doubt_ends = None;
                OffsetCertainty::MustRead
            }
            Some(_) => OffsetCertainty::Unsure,
        }
    }

    /// Marks the offsets as unknown until a reading later than `read_at`.
    pub(super) fn mark_unread(&mut self, read_at: Option<Timestamp>) {
        self.unread_since = read_at;
    }

    /// Returns `true` if the reading at `read_at` shows the offsets of the unit.
    pub(super) fn is_read(&self, read_at: Option<Timestamp>) -> bool {
        self.unread_since.is_none_or(|last| read_at != Some(last))
    }

    /// Records a failed removal. Each failure doubles the wait before the next attempt.
    pub(super) fn fail(&mut self, left: LeftOffsets, now: Instant) {
        self.left = Some(left);
        let wait = self.again.map_or(AGAIN, |(_, wait)| MAX_AGAIN.min(wait * 2));
        self.again = Some((now + wait, wait));
    }

    /// Returns `true` unless a removal has just failed. If the gate refused an attempt on the next
    /// track, Azel repeats it at the end of that track.
    pub(super) fn may_take_back(&self, may_track: bool, now: Instant) -> bool {
        match &self.left {
            None => true,
            Some(LeftOffsets::Refused(_)) if !may_track => true,
            Some(LeftOffsets::Refused(_) | LeftOffsets::Failed(_) | LeftOffsets::Found { .. }) => {
                self.again.is_none_or(|(time, _)| time <= now)
            }
        }
    }

    /// Returns the reason why the written offsets are still on the unit.
    pub(super) fn left(&self) -> Option<&LeftOffsets> {
        self.left.as_ref()
    }

    /// Resets the state, because the unit has no offset of Azel any more. Tickets stay unique.
    pub(super) fn reset(&mut self) {
        *self = Self { tickets: self.tickets, ..Self::default() };
    }

    /// Returns the time of the next check whether the record is on disk.
    pub(in crate::driver::session) fn due(&self, now: Instant) -> Option<Instant> {
        matches!(self.step, ShiftStep::Marking { .. }).then_some(now + LOOK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{Angle, Offset},
        contract::driver::Refusal,
    };

    fn azimuth(degrees: f64) -> TrackOffsets {
        TrackOffsets::NONE.plus(Offset::Azimuth(Angle::from_degrees(degrees))).unwrap()
    }

    #[test]
    fn each_failure_to_take_back_doubles_the_wait_up_to_ten_minutes() {
        let now = Instant::now();
        let mut shifting = Shifting::default();
        for wait_s in [10, 20, 40, 80, 160, 320, 600, 600] {
            shifting.fail(LeftOffsets::Refused(Refusal::Stopping), now);
            let wait = Duration::from_secs(wait_s);
            assert!(!shifting.may_take_back(true, now + wait - Duration::from_millis(1)));
            assert!(shifting.may_take_back(true, now + wait), "{wait_s} s");
        }
        assert!(shifting.may_take_back(false, now), "the next track is over");
    }

    #[test]
    fn a_halt_voids_a_record_and_not_what_is_on_its_way() {
        let mut shifting = Shifting::default();
        shifting.remember(TrackOffsets::NONE);
        shifting.request(azimuth(0.1));
        shifting.begin_marking(azimuth(0.1));
        shifting.void(Some(TrackOffsets::NONE));
        assert!(!shifting.is_changing() && shifting.last_earlier().is_none());
        shifting.begin_writing(1);
        shifting.void(Some(TrackOffsets::NONE));
        assert!(shifting.is_writing());
    }

    #[test]
    fn a_write_that_the_link_cut_off_is_in_doubt_for_a_minute_and_then_read_again() {
        let now = Instant::now();
        let mut shifting = Shifting::default();
        shifting.begin_writing(1);
        assert!(shifting.lose(now) && !shifting.lose(now));
        assert_eq!(shifting.certainty(now), OffsetCertainty::Unsure);
        assert_eq!(shifting.certainty(now + APPLIED), OffsetCertainty::MustRead);
        assert_eq!(shifting.certainty(now + APPLIED), OffsetCertainty::Sure);
    }
}
