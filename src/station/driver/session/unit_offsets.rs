//! Offsets of a track that the unit computes: Azel adds them during the track, reads them back, and
//! removes them after the track.

mod added;
mod program;
mod shifting;

use std::sync::Arc;

use super::{Session, offsets::max_offset};
use crate::{
    astro::{Offset, TrackOffsets},
    clock::Moment,
    contract::driver::{Command, Event, LeftOffsets, OffsetChange, Refusal},
    device::{
        OnBoard, TrackOffsetFields,
        settings::{Change, WriteError},
    },
    driver::{debts::ShiftedTrack, gate::Shift},
    plan::{OnBoardPass, on_board::Judge},
    promises::PromisedFile,
};
pub(super) use shifting::Shifting;
use shifting::{OffsetCertainty, ShiftStep};

impl Session {
    /// Changes the offsets that Azel adds to the unit's own track.
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
        let before = self.unit_offsets.requested().or(in_force).ok_or(Refusal::OffsetsUnknown)?;
        let requested = match change {
            OffsetChange::Step(step) => {
                if !is_running || !matches!(step, Offset::Azimuth(_) | Offset::Elevation(_)) {
                    return Err(Refusal::NotOffered);
                }
                before
                    .plus(step)
                    .ok_or_else(|| Refusal::OffsetTooLarge { max: max_offset(step) })?
            }
            OffsetChange::Zero => TrackOffsets::NONE,
            OffsetChange::Undo => self.unit_offsets.last_earlier().ok_or(Refusal::Nothing)?,
        };
        if let Some(shift) = self.shift(requested, now)? {
            if !self.is_judged(&shift.judge, &[shift.axes.clone(), shift.sky.clone()]) {
                self.wait_for_judgement(Command::Offset(change));
                return Ok(());
            }
            self.gate.shift_is_clear(&shift, self.stop.is_under_way(), now)?;
        }
        match change {
            OffsetChange::Undo => self.unit_offsets.drop_last_earlier(),
            OffsetChange::Step(_) | OffsetChange::Zero if requested == before => return Ok(()),
            OffsetChange::Step(_) | OffsetChange::Zero => self.unit_offsets.remember(before),
        }
        self.unit_offsets.request(requested);
        if let Some(shifted) = self.owed.debts().shifted() {
            let shifted = ShiftedTrack { is_found: false, ..shifted };
            self.owed.debts().set_shifted(Some(shifted));
        }
        self.begin_shift(fields, now);
        Ok(())
    }

    /// Returns the motion of the unit with `requested` added; `None` if a removal moves nothing.
    fn shift(&self, requested: TrackOffsets, now: Moment) -> Result<Option<Shift>, Refusal> {
        if requested.is_none() && !self.may_track() {
            return Ok(None);
        }
        let unit = &self.gate.state().on_board;
        let current = self.current_offsets().ok_or(Refusal::OffsetsUnknown)?;
        let shifted = self.owed.debts().shifted();
        let before = shifted.map_or(current, |shifted| shifted.before);
        let after = before.checked_add(requested).ok_or(Refusal::NotOffered)?;
        let unit_with = |offsets| OnBoard {
            offsets: unit.offsets.map(|unit| unit.with_axes_of(offsets)),
            ..unit.clone()
        };
        let watch = self.on_board_watch().ok_or(Refusal::PassUnknown)?;
        let mut pass = OnBoardPass::clone(watch.judge().pass());
        // The unit runs through the window by its own clock.
        pass.target.start = pass.target.start.max(self.unit_time(now)).min(pass.target.end);
        let judge = Judge::new(pass, self.setup.ability()).map_err(|_| Refusal::PassUnknown)?;
        let judge = Arc::new(judge);
        Ok(Some(Shift { judge, axes: unit_with(after), sky: unit_with(before) }))
    }

    /// Records the offsets before their write. A return to the unit's previous offsets needs no
    /// record.
    fn begin_shift(&mut self, fields: &TrackOffsetFields, now: Moment) {
        let Some(requested) = self.unit_offsets.requested() else { return };
        if !self.unit_offsets.is_idle() {
            return;
        }
        let Some(current) = self.current_offsets() else { return self.forget_request() };
        if requested.is_none() {
            // The record of added offsets stays until the unit reads as before.
            return self.write_shift(fields, now);
        }
        let recorded = self.owed.debts().shifted();
        let new = ShiftedTrack {
            start: now.utc,
            before: current,
            put: Vec::new(),
            track: None,
            is_found: false,
        };
        let mut shifted = recorded.unwrap_or(new);
        let Some(after) = shifted.before.checked_add(requested) else {
            return self.forget_request();
        };
        shifted.track = self.reported_track();
        if self.unit_offsets.is_sure() {
            // The unit has the values that it read back, and no older ones.
            shifted.put.clear();
        }
        shifted.record(current);
        shifted.record(after);
        self.owed.debts().set_shifted(Some(shifted));
        if self.owed.debts().has_marks() {
            self.unit_offsets.begin_marking(requested);
        } else {
            self.write_shift(fields, now);
        }
    }

    /// Sends the wanted offsets through the gate.
    fn write_shift(&mut self, fields: &TrackOffsetFields, now: Moment) {
        self.unit_offsets.end_step();
        let written = self.try_write_shift(fields, now);
        match written {
            Ok(Some(ticket)) => self.unit_offsets.begin_writing(ticket),
            Ok(None) => self.unit_offsets.is_in_force(),
            Err(refusal) => {
                let is_taking_back = self.unit_offsets.is_taking_back();
                self.forget_request();
                if is_taking_back && self.added_track_is_over(now) {
                    self.unit_offsets.fail(LeftOffsets::Refused(refusal), now.steady);
                } else {
                    self.tell(Event::OffsetRefused(refusal));
                }
            }
        }
    }

    /// Returns the ticket of the change; `None` if the unit already has these offsets.
    fn try_write_shift(
        &mut self,
        fields: &TrackOffsetFields,
        now: Moment,
    ) -> Result<Option<u64>, Refusal> {
        let Some(requested) = self.unit_offsets.requested() else { return Ok(None) };
        let current = self.current_offsets().ok_or(Refusal::OffsetsUnknown)?;
        let Some(shifted) = self.owed.debts().shifted() else { return Ok(None) };
        let after = shifted.before.checked_add(requested).ok_or(Refusal::NotOffered)?;
        let values = fields.values(current, after);
        if values.is_empty() {
            return Ok(None);
        }
        let shift = self.shift(requested, now)?;
        let ticket = self.unit_offsets.next_ticket();
        let group = self.gate.state().groups.get(fields.group);
        let last_read = group.and_then(|group| Some(group.last_read.as_ref()?.values.clone()));
        let change =
            Change { ticket, group: fields.group, values, expected: last_read, is_unlocked: false };
        self.gate.shift_track(change, shift.as_ref(), self.stop.is_under_way(), now)?;
        Ok(Some(ticket))
    }

    /// Follows a change to its end, and removes the added offsets after the track.
    pub(super) fn watch_unit_offsets(&mut self, now: Moment) {
        let Some(fields) = self.setup.track_offsets() else { return };
        match self.unit_offsets.step() {
            ShiftStep::None => {}
            ShiftStep::Marking { requested } => match self.owed.debts().shifted_kept() {
                PromisedFile::Pending => return,
                PromisedFile::Failed(_) => {
                    self.unit_offsets.end_step();
                    self.forget_request();
                    self.tell(Event::OffsetRefused(Refusal::NoOffsetsRecord));
                }
                PromisedFile::OnDisk => {
                    self.unit_offsets.end_step();
                    if self.unit_offsets.requested() == Some(requested) {
                        self.write_shift(fields, now);
                    } else {
                        // The operator has requested another change since.
                        self.begin_shift(fields, now);
                    }
                }
            },
            ShiftStep::Writing { ticket } => self.watch_write(fields, ticket, now),
        }
        if self.unit_offsets.is_idle() {
            self.watch_shifted(fields, now);
        }
    }

    fn watch_write(&mut self, fields: &TrackOffsetFields, ticket: u64, now: Moment) {
        let group = self.gate.state().groups.get(fields.group);
        let written = group.and_then(|group| group.written.clone());
        let Some(written) = written.filter(|written| written.change.ticket == ticket) else {
            return;
        };
        self.unit_offsets.end_step();
        // During the track, the operator may retry, and the end of the track removes the offsets.
        let was_at_the_end = self.unit_offsets.is_taking_back() && self.added_track_is_over(now);
        match &written.result {
            Ok(()) if self.unit_offsets.requested() == self.added_offsets() => {
                self.unit_offsets.is_in_force();
            }
            // The operator has requested another change since.
            Ok(()) => self.begin_shift(fields, now),
            Err(error) => {
                if let WriteError::Differs(_) = error {
                    self.adopt_read_back();
                }
                if may_apply_late(error) {
                    self.unit_offsets.doubt(now.steady);
                }
                self.forget_request();
                if !matches!(error, WriteError::Stopped | WriteError::ChangedMeanwhile) {
                    self.read_offsets_again(fields);
                }
                match error {
                    // The gate did not send the change, so the debt stays.
                    WriteError::Stopped => {}
                    WriteError::ChangedMeanwhile if was_at_the_end => {}
                    error if was_at_the_end => {
                        self.unit_offsets.fail(LeftOffsets::Failed(error.clone()), now.steady);
                    }
                    error => self.tell(Event::OffsetNotTaken(error.clone())),
                }
            }
        }
    }

    /// Marks the offsets as unknown until the next reading of the unit.
    fn read_offsets_again(&mut self, fields: &TrackOffsetFields) {
        self.unit_offsets.mark_unread(self.last_read());
        self.gate.device().read_group(fields.group);
    }

    /// Doubts the offsets of an earlier run, which may have written them just before its end.
    pub(super) fn doubt_found_offsets(&mut self, now: Moment) {
        let shifted = self.owed.debts().shifted();
        if shifted.is_some_and(|shifted| shifted.is_found) {
            self.unit_offsets.doubt(now.steady);
        }
    }

    /// Ends a change after the loss of the link: the next reading of the unit shows its outcome.
    pub(super) fn lose_shift(&mut self, now: Moment) {
        if !self.unit_offsets.lose(now.steady) {
            return;
        }
        let is_taking_back = self.unit_offsets.is_taking_back();
        self.unit_offsets.mark_unread(self.last_read());
        self.forget_request();
        // The removal stays pending, so Azel reports no failure.
        if !is_taking_back {
            self.tell(Event::OffsetNotTaken(WriteError::LinkLost));
        }
    }

    /// Removes the added offsets after the track, and forgets them once they are gone.
    fn watch_shifted(&mut self, fields: &TrackOffsetFields, now: Moment) {
        let is_over = self.added_track_is_over(now);
        let Some(shifted) = self.owed.debts().shifted() else {
            if is_over {
                self.unit_offsets.forget_earlier();
            }
            return;
        };
        let Some(current) = self.current_offsets() else { return };
        let Some(added) = shifted.added(current) else {
            return self.leave_foreign(shifted, current, now);
        };
        if added.is_none() {
            let is_done = is_over || shifted.is_found;
            if is_done {
                self.unit_offsets.forget_earlier();
                self.unit_offsets.forget_failures();
                if self.is_sure(fields, now) {
                    self.forget_shifted();
                }
            }
            return;
        }
        // A halt would void the change, and a locked-out unit accepts no setting.
        let waits = self.stop.is_under_way() || self.gate.lock_out().is_some();
        if is_over && !waits && self.may_take_back(now) {
            // With auto-track on, the unit may begin its next track before the removal.
            if let Ok(Some(shift)) = self.shift(TrackOffsets::NONE, now)
                && !self.is_judged(&shift.judge, &[shift.axes, shift.sky])
            {
                return;
            }
            self.unit_offsets.take_back();
            self.begin_shift(fields, now);
        }
    }

    /// Handles an offset that somebody else has set: Azel removes only the others.
    fn leave_foreign(&mut self, shifted: ShiftedTrack, current: TrackOffsets, now: Moment) {
        tracing::warn!(antenna = self.setup.name(), "somebody else has set offsets of the unit");
        if !shifted.is_found {
            self.tell(Event::OffsetNotTaken(WriteError::ChangedMeanwhile));
        }
        let is_sure = self.unit_offsets.is_settled(now.steady);
        match shifted.drop_foreign(current) {
            Some(left) if left.before != current || !is_sure => {
                self.owed.debts().set_shifted(Some(left));
            }
            _ => self.forget_shifted(),
        }
    }

    /// Returns `true` if Azel has read the unit after the time in which it may apply a change late.
    fn is_sure(&mut self, fields: &TrackOffsetFields, now: Moment) -> bool {
        match self.unit_offsets.certainty(now.steady) {
            OffsetCertainty::Sure => true,
            OffsetCertainty::Unsure => false,
            OffsetCertainty::MustRead => {
                self.read_offsets_again(fields);
                false
            }
        }
    }

    /// Records offsets that read back differently from the written ones, because they also come
    /// from Azel.
    fn adopt_read_back(&self) {
        let debts = self.owed.debts();
        let current = self.current_offsets();
        let Some((mut shifted, current)) = debts.shifted().zip(current) else { return };
        if shifted.added(current).is_none() {
            shifted.record(current);
            debts.set_shifted(Some(shifted));
        }
    }

    /// Removes the record, because the unit has no offset of Azel any more.
    fn forget_shifted(&mut self) {
        self.owed.debts().set_shifted(None);
        self.unit_offsets.reset();
    }

    /// Drops the wanted offsets.
    fn forget_request(&mut self) {
        let in_force = self.added_offsets();
        self.unit_offsets.forget_request(in_force);
    }

    /// Voids a change after a halt, unless the change is already on its way to the unit.
    pub(super) fn void_shift(&mut self) {
        let in_force = self.added_offsets();
        self.unit_offsets.void(in_force);
    }

    /// Returns `true` while Azel removes the offsets of a track; the next track waits for the
    /// removal.
    pub(super) fn takes_offsets_back(&self) -> bool {
        !self.program_is_on() && self.unit_offsets.is_writing()
    }
}

/// Returns `true` if the unit may still apply a change that did not read back.
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
