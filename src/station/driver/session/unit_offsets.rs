//! Offsets of a track that the unit computes: added from here while it tracks, read back, and taken
//! back once the track is over.

mod added;
mod program;

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;

use super::{Session, offsets::most};
use crate::{
    astro::{Offset, TrackOffsets},
    clock::{Instant, Moment},
    contract::driver::{Command, Event, LeftOffsets, OffsetChange, Refusal, SESSION_TICKETS},
    device::{
        OnBoard, TrackOffsetFields,
        settings::{Change, WriteError},
    },
    driver::{debts::ShiftedTrack, gate::Shift},
    plan::{OnBoardPass, on_board::Judge},
    promises::Kept,
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
pub(super) struct UnitOffsets {
    step: Step,
    /// Offsets that the operator wants, until they are in force.
    wanted: Option<TrackOffsets>,
    /// Earlier values of `wanted`, for undo, the oldest first.
    earlier: Vec<TrackOffsets>,
    /// Time of the last read when a change failed to read back: the offsets are unknown until a later
    /// read.
    unread_since: Option<Timestamp>,
    /// Until then the unit may still apply a change that did not read back.
    unsure_until: Option<Instant>,
    /// Why what was written is still there.
    left: Option<LeftOffsets>,
    /// When taking back is tried again, and the wait before that.
    again: Option<(Instant, Duration)>,
    tickets: u64,
}

#[derive(Default)]
enum Step {
    #[default]
    None,
    /// Azel is recording on disk what the unit held before, and what it will hold with `wanted`.
    Marking { wanted: TrackOffsets },
    /// On its way to the unit.
    Writing { ticket: u64 },
}

impl Session {
    /// Changes what is added to the offsets of the unit's own track.
    pub(super) fn change_unit_offsets(
        &mut self,
        change: OffsetChange,
        now: Moment,
    ) -> Result<(), Refusal> {
        let fields = self.setup.track_offsets().ok_or(Refusal::NoTrack)?;
        let in_force = self.added_offsets();
        let is_running = self.on_board_is_running();
        if !is_running && in_force.is_none_or(TrackOffsets::is_none) {
            return Err(Refusal::NoTrack);
        }
        let before = self.unit_offsets.wanted.or(in_force).ok_or(Refusal::OffsetsUnknown)?;
        let wanted = match change {
            OffsetChange::Step(step) => {
                if !is_running || !matches!(step, Offset::Azimuth(_) | Offset::Elevation(_)) {
                    return Err(Refusal::NotOffered);
                }
                before.plus(step).ok_or_else(|| Refusal::OffsetTooLarge { most: most(step) })?
            }
            OffsetChange::Zero => TrackOffsets::NONE,
            OffsetChange::Undo => {
                self.unit_offsets.earlier.last().copied().ok_or(Refusal::Nothing)?
            }
        };
        if let Some(shift) = self.shift(wanted, now)? {
            if !self.is_judged(&shift.judge, &[shift.axes.clone(), shift.sky.clone()]) {
                self.wait_for_judgement(Command::Offset(change));
                return Ok(());
            }
            self.gate.shift_is_clear(&shift, self.stop.is_under_way(), now)?;
        }
        match change {
            OffsetChange::Undo => drop(self.unit_offsets.earlier.pop()),
            _ if wanted == before => return Ok(()),
            _ => self.unit_offsets.earlier.push(before),
        }
        (self.unit_offsets.left, self.unit_offsets.again) = (None, None);
        self.unit_offsets.wanted = Some(wanted);
        if let Some(shifted) = self.owed.debts().shifted() {
            let shifted = ShiftedTrack { is_found: false, ..shifted };
            self.owed.debts().set_shifted(Some(shifted));
        }
        self.begin_shift(fields, now);
        Ok(())
    }

    /// Returns what the unit would do with `wanted` added; `None` where taking back moves nothing.
    fn shift(&self, wanted: TrackOffsets, now: Moment) -> Result<Option<Shift>, Refusal> {
        if wanted.is_none() && !self.may_track() {
            return Ok(None);
        }
        let unit = &self.gate.state().on_board;
        let held = self.held_offsets().ok_or(Refusal::OffsetsUnknown)?;
        let shifted = self.owed.debts().shifted();
        let before = shifted.map_or(held, |shifted| shifted.before);
        let after = before.checked_add(wanted).ok_or(Refusal::NotOffered)?;
        let with = |offsets| OnBoard {
            offsets: unit.offsets.map(|unit| unit.with_axes_of(offsets)),
            ..unit.clone()
        };
        let watch = self.on_board_watch().ok_or(Refusal::PassUnknown)?;
        let mut pass = OnBoardPass::clone(watch.judge().pass());
        // The unit runs through the window by its own clock.
        pass.target.from = pass.target.from.max(self.unit_time(now)).min(pass.target.until);
        let judge = Judge::new(pass, self.setup.ability()).map_err(|_| Refusal::PassUnknown)?;
        let judge = Arc::new(judge);
        Ok(Some(Shift { judge, axes: with(after), sky: with(before) }))
    }

    /// Records what is about to be written. Back to what the unit held before needs no record.
    fn begin_shift(&mut self, fields: &TrackOffsetFields, now: Moment) {
        let Some(wanted) = self.unit_offsets.wanted else { return };
        if !matches!(self.unit_offsets.step, Step::None) {
            return;
        }
        let Some(held) = self.held_offsets() else { return self.forget_wanted() };
        if wanted.is_none() {
            return self.write_shift(fields, now);
        }
        let known = self.owed.debts().shifted();
        let new = ShiftedTrack {
            since: now.utc,
            before: held,
            put: Vec::new(),
            track: None,
            is_found: false,
        };
        let mut shifted = known.unwrap_or(new);
        let Some(after) = shifted.before.checked_add(wanted) else { return self.forget_wanted() };
        shifted.track = self.told_track();
        if self.unit_offsets.unsure_until.is_none() {
            // The unit holds what was read back, and nothing older.
            shifted.put.clear();
        }
        shifted.may_be(held);
        shifted.may_be(after);
        self.owed.debts().set_shifted(Some(shifted));
        if self.owed.debts().has_marks() {
            self.unit_offsets.step = Step::Marking { wanted };
        } else {
            self.write_shift(fields, now);
        }
    }

    /// Sends what is wanted through the gate.
    fn write_shift(&mut self, fields: &TrackOffsetFields, now: Moment) {
        self.unit_offsets.step = Step::None;
        let written = self.try_write_shift(fields, now);
        match written {
            Ok(Some(ticket)) => self.unit_offsets.step = Step::Writing { ticket },
            Ok(None) => self.unit_offsets.wanted = None,
            Err(refusal) => {
                let is_taking_back = self.is_taking_back();
                self.forget_wanted();
                if is_taking_back && self.added_track_is_over(now) {
                    self.unit_offsets.left = Some(LeftOffsets::Refused(refusal));
                    self.try_again_later(now);
                } else {
                    self.tell(Event::OffsetRefused(refusal));
                }
            }
        }
    }

    /// Returns the ticket of the change; `None` where the unit holds that already.
    fn try_write_shift(
        &mut self,
        fields: &TrackOffsetFields,
        now: Moment,
    ) -> Result<Option<u64>, Refusal> {
        let Some(wanted) = self.unit_offsets.wanted else { return Ok(None) };
        let held = self.held_offsets().ok_or(Refusal::OffsetsUnknown)?;
        let Some(shifted) = self.owed.debts().shifted() else { return Ok(None) };
        let after = shifted.before.checked_add(wanted).ok_or(Refusal::NotOffered)?;
        let values = fields.values(held, after);
        if values.is_empty() {
            return Ok(None);
        }
        let shift = self.shift(wanted, now)?;
        self.unit_offsets.tickets += 1;
        let ticket = SESSION_TICKETS + self.unit_offsets.tickets;
        let group = self.gate.state().held.get(fields.group);
        let seen = group.and_then(|group| Some(group.held.as_ref()?.values.clone()));
        let change = Change { ticket, group: fields.group, values, seen, is_unlocked: false };
        self.gate.shift_track(change, shift.as_ref(), self.stop.is_under_way(), now)?;
        Ok(Some(ticket))
    }

    /// Follows a change to its end, and takes back what is added once the track is over.
    pub(super) fn watch_unit_offsets(&mut self, now: Moment) {
        let Some(fields) = self.setup.track_offsets() else { return };
        match self.unit_offsets.step {
            Step::None => {}
            Step::Marking { wanted } => match self.owed.debts().shifted_kept() {
                Kept::Pending => return,
                Kept::Failed(_) => {
                    self.unit_offsets.step = Step::None;
                    self.forget_wanted();
                    self.tell(Event::OffsetRefused(Refusal::NoOffsetsRecord));
                }
                Kept::OnDisk => {
                    self.unit_offsets.step = Step::None;
                    if self.unit_offsets.wanted == Some(wanted) {
                        self.write_shift(fields, now);
                    } else {
                        // Another change has been requested since.
                        self.begin_shift(fields, now);
                    }
                }
            },
            Step::Writing { ticket } => self.watch_write(fields, ticket, now),
        }
        if matches!(self.unit_offsets.step, Step::None) {
            self.watch_shifted(fields, now);
        }
    }

    fn watch_write(&mut self, fields: &TrackOffsetFields, ticket: u64, now: Moment) {
        let group = self.gate.state().held.get(fields.group);
        let written = group.and_then(|group| group.written.clone());
        let Some(written) = written.filter(|written| written.change.ticket == ticket) else {
            return;
        };
        self.unit_offsets.step = Step::None;
        // In mid-track the operator may try again, and the end of the track takes it back.
        let was_at_the_end = self.is_taking_back() && self.added_track_is_over(now);
        match &written.result {
            Ok(()) if self.unit_offsets.wanted == self.added_offsets() => {
                self.unit_offsets.wanted = None;
            }
            // Another change has been requested since.
            Ok(()) => self.begin_shift(fields, now),
            Err(error) => {
                if let WriteError::Differs(_) = error {
                    self.own_read_back();
                }
                if may_apply_late(error) {
                    self.unit_offsets.unsure_until = Some(now.steady + APPLIED);
                }
                self.forget_wanted();
                if !matches!(error, WriteError::Stopped | WriteError::ChangedMeanwhile) {
                    self.read_offsets_again(fields);
                }
                match error {
                    // It was not sent, and is owed as before.
                    WriteError::Stopped => {}
                    WriteError::ChangedMeanwhile if was_at_the_end => {}
                    error if was_at_the_end => {
                        self.unit_offsets.left = Some(LeftOffsets::Failed(error.clone()));
                        self.try_again_later(now);
                    }
                    error => self.tell(Event::OffsetNotTaken(error.clone())),
                }
            }
        }
    }

    /// The offsets are unknown until the unit is read again.
    fn read_offsets_again(&mut self, fields: &TrackOffsetFields) {
        self.unit_offsets.unread_since = self.read_at();
        self.gate.device().read_group(fields.group);
    }

    /// Each failure to take offsets back doubles the wait before the next try.
    fn try_again_later(&mut self, now: Moment) {
        let wait = self.unit_offsets.again.map_or(AGAIN, |(_, wait)| MAX_AGAIN.min(wait * 2));
        self.unit_offsets.again = Some((now.steady + wait, wait));
    }

    /// An earlier run may have written offsets just before it ended.
    pub(super) fn doubt_found_offsets(&mut self, now: Moment) {
        let shifted = self.owed.debts().shifted();
        if shifted.is_some_and(|shifted| shifted.is_found) {
            self.unit_offsets.unsure_until = Some(now.steady + APPLIED);
        }
    }

    /// The link is lost: the next read of the unit shows the outcome of a change.
    pub(super) fn lose_shift(&mut self, now: Moment) {
        match std::mem::take(&mut self.unit_offsets.step) {
            Step::None => return,
            Step::Marking { .. } => {}
            Step::Writing { .. } => {
                self.unit_offsets.unsure_until = Some(now.steady + APPLIED);
            }
        }
        let is_taking_back = self.is_taking_back();
        self.unit_offsets.unread_since = self.read_at();
        self.forget_wanted();
        // Taking back stays owed, so it is no failure to report.
        if !is_taking_back {
            self.tell(Event::OffsetNotTaken(WriteError::LinkLost));
        }
    }

    /// Takes back what is added once the track is over, and forgets what is taken back.
    fn watch_shifted(&mut self, fields: &TrackOffsetFields, now: Moment) {
        let is_over = self.added_track_is_over(now);
        let Some(shifted) = self.owed.debts().shifted() else {
            if is_over {
                self.unit_offsets.earlier.clear();
            }
            return;
        };
        let Some(held) = self.held_offsets() else { return };
        let Some(added) = shifted.added(held) else {
            return self.leave_foreign(shifted, held, now);
        };
        if added.is_none() {
            let is_done = is_over || shifted.is_found;
            if is_done {
                self.unit_offsets.earlier.clear();
                (self.unit_offsets.left, self.unit_offsets.again) = (None, None);
                if self.is_sure(fields, now) {
                    self.forget_shifted();
                }
            }
            return;
        }
        let waits = self.stop.is_under_way() || self.gate.lock_out().is_some();
        if is_over && !waits && self.may_take_back(now) {
            // With auto-track on, the unit may begin its next track before that.
            if let Ok(Some(shift)) = self.shift(TrackOffsets::NONE, now)
                && !self.is_judged(&shift.judge, &[shift.axes, shift.sky])
            {
                return;
            }
            self.unit_offsets.wanted = Some(TrackOffsets::NONE);
            self.begin_shift(fields, now);
        }
    }

    /// Somebody else has set an offset of the unit: only the others are still to be taken back.
    fn leave_foreign(&mut self, shifted: ShiftedTrack, held: TrackOffsets, now: Moment) {
        tracing::warn!(antenna = self.setup.name(), "somebody else has set offsets of the unit");
        if !shifted.is_found {
            self.tell(Event::OffsetNotTaken(WriteError::ChangedMeanwhile));
        }
        let is_sure = self.unit_offsets.unsure_until.is_none_or(|until| until <= now.steady);
        match shifted.without_foreign(held) {
            Some(left) if left.before != held || !is_sure => {
                self.owed.debts().set_shifted(Some(left));
            }
            _ => self.forget_shifted(),
        }
    }

    /// Returns `true` if the unit was read after the time in which it may apply a change late.
    fn is_sure(&mut self, fields: &TrackOffsetFields, now: Moment) -> bool {
        let Some(until) = self.unit_offsets.unsure_until else { return true };
        if until <= now.steady {
            self.unit_offsets.unsure_until = None;
            self.read_offsets_again(fields);
        }
        false
    }

    /// Records offsets that read back differently from those written: they are from here too.
    fn own_read_back(&self) {
        let debts = self.owed.debts();
        let held = self.held_offsets();
        let Some((mut shifted, held)) = debts.shifted().zip(held) else { return };
        if shifted.added(held).is_none() {
            shifted.may_be(held);
            debts.set_shifted(Some(shifted));
        }
    }

    /// The unit holds nothing of ours any more.
    fn forget_shifted(&mut self) {
        self.owed.debts().set_shifted(None);
        let tickets = self.unit_offsets.tickets;
        self.unit_offsets = UnitOffsets { tickets, ..UnitOffsets::default() };
    }

    /// Returns `true` while all that was added is to be taken back, by the operator or at the end of the
    /// track.
    fn is_taking_back(&self) -> bool {
        self.unit_offsets.wanted.is_some_and(TrackOffsets::is_none)
    }

    /// Drops the wanted offsets, and the undo steps that would change nothing.
    fn forget_wanted(&mut self) {
        self.unit_offsets.wanted = None;
        let in_force = self.added_offsets();
        let earlier = &mut self.unit_offsets.earlier;
        while earlier.last().is_some_and(|last| Some(*last) == in_force) {
            earlier.pop();
        }
    }

    /// A halt voids a change that is not on its way to the unit.
    pub(super) fn void_shift(&mut self) {
        if let Step::Marking { .. } = self.unit_offsets.step {
            self.unit_offsets.step = Step::None;
        }
        self.forget_wanted();
    }

    /// Returns `true` while what was added for a track is being taken back: the next one waits for
    /// that.
    pub(super) fn takes_offsets_back(&self) -> bool {
        !self.program_is_on() && matches!(self.unit_offsets.step, Step::Writing { .. })
    }

    /// When to check again whether the record is on the disk.
    pub(super) fn shift_due(&self, now: Instant) -> Option<Instant> {
        matches!(self.unit_offsets.step, Step::Marking { .. }).then_some(now + LOOK)
    }
}

/// Returns `true` if the unit may apply a change although it did not read back.
fn may_apply_late(error: &WriteError) -> bool {
    match error {
        WriteError::LinkLost
        | WriteError::Unanswered
        | WriteError::NotReadBack(_)
        | WriteError::Differs(_) => true,
        WriteError::NoLink
        | WriteError::NoSuchSetting
        | WriteError::Locked
        | WriteError::LockedOut
        | WriteError::Moving
        | WriteError::Stopped
        | WriteError::Hindered { .. }
        | WriteError::Unread(_)
        | WriteError::ChangedMeanwhile
        | WriteError::CannotBeSent { .. }
        | WriteError::Refused(_)
        | WriteError::Useless(_) => false,
    }
}

#[cfg(test)]
mod tests;
