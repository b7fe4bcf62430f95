//! A change of the offsets of a track that the unit computes, from the request to the read-back.

use std::time::Duration;

use jiff::Timestamp;

use crate::{
    astro::TrackOffsets,
    clock::Instant,
    contract::driver::{LeftOffsets, SESSION_TICKETS},
};

/// Interval at which the write of a record is checked.
const LOOK: Duration = Duration::from_millis(2);
/// Azel's own assumption: a unit applies a setting within this time, or not at all.
const APPLIED: Duration = Duration::from_mins(1);
/// First and longest wait before offsets that were not taken back are written again.
const AGAIN: Duration = Duration::from_secs(10);
const MAX_AGAIN: Duration = Duration::from_mins(10);

/// Offsets of the unit's own track, and the change of them that is under way.
#[derive(Default)]
pub(in crate::driver::session) struct Shifting {
    step: Step,
    /// Offsets that the operator wants, until they are in force.
    wanted: Option<TrackOffsets>,
    /// Earlier values of `wanted`, for undo, the oldest first.
    earlier: Vec<TrackOffsets>,
    /// Time of the last read when a change failed to read back: the offsets are unknown until a later
    /// read.
    unread_since: Option<Timestamp>,
    /// Until then the unit may still apply a change that did not read back.
    doubt_ends: Option<Instant>,
    /// Why what was written is still there.
    left: Option<LeftOffsets>,
    /// When taking back is tried again, and the wait before that.
    again: Option<(Instant, Duration)>,
    tickets: u64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum Step {
    #[default]
    None,
    /// Azel is recording on disk what the unit held before, and what it will hold with `wanted`.
    Marking { wanted: TrackOffsets },
    /// On its way to the unit.
    Writing { ticket: u64 },
}

/// Knowledge of what the unit holds after a change that did not read back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Certainty {
    Sure,
    /// The unit may still apply the change.
    Unsure,
    /// The unit applies it no more, and must be read again.
    MustRead,
}

impl Shifting {
    pub(super) fn step(&self) -> Step {
        self.step
    }

    pub(super) fn is_idle(&self) -> bool {
        self.step == Step::None
    }

    pub(in crate::driver::session) fn is_writing(&self) -> bool {
        matches!(self.step, Step::Writing { .. })
    }

    pub(super) fn is_changing(&self) -> bool {
        self.wanted.is_some() || !self.is_idle()
    }

    pub(super) fn wanted(&self) -> Option<TrackOffsets> {
        self.wanted
    }

    /// Returns `true` while all that was added is to be taken back, by the operator or at the end of the
    /// track.
    pub(super) fn is_taking_back(&self) -> bool {
        self.wanted.is_some_and(TrackOffsets::is_none)
    }

    /// Offsets before the last change.
    pub(super) fn last_earlier(&self) -> Option<TrackOffsets> {
        self.earlier.last().copied()
    }

    /// Keeps the offsets before a change, for undo.
    pub(super) fn remember(&mut self, before: TrackOffsets) {
        self.earlier.push(before);
    }

    pub(super) fn drop_last_earlier(&mut self) {
        self.earlier.pop();
    }

    pub(super) fn forget_earlier(&mut self) {
        self.earlier.clear();
    }

    /// The operator wants these offsets. Earlier failures no longer count.
    pub(super) fn request(&mut self, wanted: TrackOffsets) {
        self.forget_failures();
        self.wanted = Some(wanted);
    }

    /// The track is over: all that was added is to be taken back.
    pub(super) fn take_back(&mut self) {
        self.wanted = Some(TrackOffsets::NONE);
    }

    pub(super) fn forget_failures(&mut self) {
        (self.left, self.again) = (None, None);
    }

    pub(super) fn begin_marking(&mut self, wanted: TrackOffsets) {
        self.step = Step::Marking { wanted };
    }

    pub(super) fn begin_writing(&mut self, ticket: u64) {
        self.step = Step::Writing { ticket };
    }

    pub(super) fn end_step(&mut self) {
        self.step = Step::None;
    }

    /// What was wanted is in force.
    pub(super) fn is_in_force(&mut self) {
        self.wanted = None;
    }

    pub(super) fn next_ticket(&mut self) -> u64 {
        self.tickets += 1;
        SESSION_TICKETS + self.tickets
    }

    /// Drops the wanted offsets, and the undo steps that would change nothing.
    pub(super) fn forget_wanted(&mut self, in_force: Option<TrackOffsets>) {
        self.wanted = None;
        while self.earlier.last().is_some_and(|last| Some(*last) == in_force) {
            self.earlier.pop();
        }
    }

    /// A halt voids a change that is not on its way to the unit.
    pub(in crate::driver::session) fn void(&mut self, in_force: Option<TrackOffsets>) {
        if let Step::Marking { .. } = self.step {
            self.step = Step::None;
        }
        self.forget_wanted(in_force);
    }

    /// The link is lost. Returns `false` if no change was under way.
    pub(super) fn lose(&mut self, now: Instant) -> bool {
        match std::mem::take(&mut self.step) {
            Step::None => return false,
            Step::Marking { .. } => {}
            Step::Writing { .. } => self.doubt(now),
        }
        true
    }

    /// The unit may apply a change late.
    pub(super) fn doubt(&mut self, now: Instant) {
        self.doubt_ends = Some(now + APPLIED);
    }

    /// Returns `true` if every change was read back, or read after the time of its doubt.
    pub(super) fn is_sure(&self) -> bool {
        self.doubt_ends.is_none()
    }

    /// Returns `true` unless the unit may apply a change later than `now`.
    pub(super) fn is_settled(&self, now: Instant) -> bool {
        self.doubt_ends.is_none_or(|end| end <= now)
    }

    /// Ends a doubt whose time is over.
    pub(super) fn certainty(&mut self, now: Instant) -> Certainty {
        match self.doubt_ends {
            None => Certainty::Sure,
            Some(end) if end <= now => {
                self.doubt_ends = None;
                Certainty::MustRead
            }
            Some(_) => Certainty::Unsure,
        }
    }

    /// The offsets are unknown until the unit is read later than at `read_at`.
    pub(super) fn unread(&mut self, read_at: Option<Timestamp>) {
        self.unread_since = read_at;
    }

    /// Returns `true` if what was read at `read_at` shows the offsets of the unit.
    pub(super) fn is_read(&self, read_at: Option<Timestamp>) -> bool {
        self.unread_since.is_none_or(|last| read_at != Some(last))
    }

    /// Taking back has failed. Each failure doubles the wait before the next try.
    pub(super) fn fail(&mut self, left: LeftOffsets, now: Instant) {
        self.left = Some(left);
        let wait = self.again.map_or(AGAIN, |(_, wait)| MAX_AGAIN.min(wait * 2));
        self.again = Some((now + wait, wait));
    }

    /// Returns `true` unless taking back has failed just before. An attempt that the gate refused
    /// on the next track is repeated at the end of that track.
    pub(super) fn may_take_back(&self, may_track: bool, now: Instant) -> bool {
        match &self.left {
            None => true,
            Some(LeftOffsets::Refused(_)) if !may_track => true,
            Some(LeftOffsets::Refused(_) | LeftOffsets::Failed(_) | LeftOffsets::Found { .. }) => {
                self.again.is_none_or(|(at, _)| at <= now)
            }
        }
    }

    /// Why what was written is still there.
    pub(super) fn left(&self) -> Option<&LeftOffsets> {
        self.left.as_ref()
    }

    /// The unit holds nothing of Azel any more. Tickets stay unique.
    pub(super) fn reset(&mut self) {
        *self = Self { tickets: self.tickets, ..Self::default() };
    }

    /// When to check again whether the record is on the disk.
    pub(in crate::driver::session) fn due(&self, now: Instant) -> Option<Instant> {
        matches!(self.step, Step::Marking { .. }).then_some(now + LOOK)
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
        assert_eq!(shifting.certainty(now), Certainty::Unsure);
        assert_eq!(shifting.certainty(now + APPLIED), Certainty::MustRead);
        assert_eq!(shifting.certainty(now + APPLIED), Certainty::Sure);
    }
}
