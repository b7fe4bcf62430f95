//! Offsets of a track that the unit computes: added from here while it tracks, read back, and taken
//! back once the track is over.

mod added;
mod program;

use std::{io, sync::Arc, time::Duration};

use jiff::Timestamp;
use tokio::task::{JoinHandle, spawn_blocking};

use super::{Command, Event, OffsetChange, Session, marking::take_now, offsets::most};
use crate::{
    astro::{Offset, TrackOffsets},
    clock::{Instant, Moment},
    device::{
        OnBoard, TrackOffsetFields,
        settings::{Change, WriteError},
    },
    driver::{LeftOffsets, Refusal, debts::ShiftedTrack, gate::Shift},
    plan::{OnBoardPass, on_board::Judge},
};

/// Tickets from here on are those of sessions.
const TICKETS: u64 = 1 << 62;

/// Returns `true` for the ticket of a change that a session makes by itself, as it does to add offsets
/// for a pass and to take them back.
pub fn is_ticket_of_session(ticket: u64) -> bool {
    ticket >= TICKETS
}

/// Interval at which the write of a record is checked.
const LOOK: Duration = Duration::from_millis(2);

/// What is under way.
#[derive(Default)]
pub(super) struct UnitOffsets {
    step: Step,
    /// What the operator wants to be added, until it is.
    wanted: Option<TrackOffsets>,
    /// Earlier values of `wanted`, for undo, the oldest first.
    earlier: Vec<TrackOffsets>,
    /// Time of the last read when a change failed to read back: the offsets are unknown until a later
    /// read.
    unread_since: Option<Timestamp>,
    /// The track to which something was added: the satellite, and when the unit ends it by its own
    /// clock.
    added_to: Option<(u32, Timestamp)>,
    /// Why what was written is still there.
    left: Option<LeftOffsets>,
    tickets: u64,
}

#[derive(Default)]
enum Step {
    #[default]
    None,
    /// What the unit held before, and what it will hold with `wanted`, is being recorded on disk.
    Marking { wanted: TrackOffsets, writing: JoinHandle<io::Result<()>> },
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
        let fields = self.variant.track_offsets.ok_or(Refusal::NoTrack)?;
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
        self.unit_offsets.left = None;
        self.unit_offsets.wanted = Some(wanted);
        if let Some(shifted) = self.owed.debts.shifted(&self.owed.unit) {
            let shifted = ShiftedTrack { is_found: false, ..shifted };
            self.owed.debts.set_shifted(&self.owed.unit, Some(shifted));
        }
        self.begin_shift(fields, now);
        Ok(())
    }

    /// What the unit would do with `wanted` added; `None` where taking back moves nothing.
    fn shift(&self, wanted: TrackOffsets, now: Moment) -> Result<Option<Shift>, Refusal> {
        if wanted.is_none() && !self.may_track() {
            return Ok(None);
        }
        let unit = &self.gate.state().on_board;
        let held = self.held_offsets().ok_or(Refusal::OffsetsUnknown)?;
        let shifted = self.owed.debts.shifted(&self.owed.unit);
        let before = shifted.map_or(held, |shifted| shifted.before);
        let after = before.and(wanted).ok_or(Refusal::NotOffered)?;
        let with = |offsets| OnBoard {
            offsets: unit.offsets.map(|unit| unit.with_axes_of(offsets)),
            ..unit.clone()
        };
        let watch = self.on_board_watch().ok_or(Refusal::PassUnknown)?;
        let mut pass = OnBoardPass::clone(watch.judge().pass());
        // The unit runs through the window by its own clock.
        pass.target.from = pass.target.from.max(self.unit_time(now)).min(pass.target.until);
        let judge = Judge::new(pass, self.setup.ability).map_err(|_| Refusal::PassUnknown)?;
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
        let (debts, unit) = (self.owed.debts.clone(), self.owed.unit.clone());
        let before = debts.shifted(&unit).map(|shifted| (shifted.since, shifted.before));
        let (since, before) = before.unwrap_or((now.utc, held));
        if wanted.is_none() {
            return self.write_shift(fields, now);
        }
        let Some(after) = before.and(wanted) else { return self.forget_wanted() };
        self.unit_offsets.added_to = self.told_track();
        let put = vec![held, after];
        debts.set_shifted(&unit, Some(ShiftedTrack { since, before, put, is_found: false }));
        if debts.has_marks() {
            let writing = spawn_blocking(move || debts.keep_shifted(&unit));
            self.unit_offsets.step = Step::Marking { wanted, writing };
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
        let Some(shifted) = self.owed.debts.shifted(&self.owed.unit) else { return Ok(None) };
        let after = shifted.before.and(wanted).ok_or(Refusal::NotOffered)?;
        let values = fields.values(held, after);
        if values.is_empty() {
            return Ok(None);
        }
        let shift = self.shift(wanted, now)?;
        self.unit_offsets.tickets += 1;
        let ticket = TICKETS + self.unit_offsets.tickets;
        let group = self.gate.state().held.get(fields.group);
        let seen = group.and_then(|group| Some(group.held.as_ref()?.values.clone()));
        let change = Change { ticket, group: fields.group, values, seen, is_unlocked: false };
        self.gate.shift_track(change, shift.as_ref(), self.stop.is_under_way(), now)?;
        Ok(Some(ticket))
    }

    /// Follows a change to its end, and takes back what is added once the track is over.
    pub(super) fn watch_unit_offsets(&mut self, now: Moment) {
        let Some(fields) = self.variant.track_offsets else { return };
        match &mut self.unit_offsets.step {
            Step::None => {}
            Step::Marking { writing, .. } if !writing.is_finished() => return,
            Step::Marking { wanted, writing } => {
                let (marked, is_marked) = (*wanted, matches!(take_now(writing), Some(Ok(()))));
                self.unit_offsets.step = Step::None;
                if !is_marked {
                    self.forget_wanted();
                    self.tell(Event::OffsetRefused(Refusal::NoOffsetsRecord));
                } else if self.unit_offsets.wanted == Some(marked) {
                    self.write_shift(fields, now);
                } else {
                    // Another step has come meanwhile.
                    self.begin_shift(fields, now);
                }
            }
            &mut Step::Writing { ticket } => self.watch_write(fields, ticket, now),
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
            // Another step has come meanwhile.
            Ok(()) => self.begin_shift(fields, now),
            Err(error) => {
                if let WriteError::Differs(_) = error {
                    self.own_read_back();
                }
                self.forget_wanted();
                if !matches!(error, WriteError::Stopped | WriteError::ChangedMeanwhile) {
                    self.unit_offsets.unread_since = self.read_at();
                    self.gate.device().read_group(fields.group);
                }
                match error {
                    // It was not sent, and is owed as before.
                    WriteError::Stopped => {}
                    WriteError::ChangedMeanwhile if was_at_the_end => {}
                    error if was_at_the_end => {
                        self.unit_offsets.left = Some(LeftOffsets::Failed(error.clone()));
                    }
                    error => self.tell(Event::OffsetNotTaken(error.clone())),
                }
            }
        }
    }

    /// The link is lost: what became of a change shows when the unit is read again.
    pub(super) fn lose_shift(&mut self) {
        if matches!(std::mem::take(&mut self.unit_offsets.step), Step::None) {
            return;
        }
        let is_taking_back = self.is_taking_back();
        self.unit_offsets.unread_since = self.read_at();
        self.forget_wanted();
        // What is to be taken back is owed as before.
        if !is_taking_back {
            self.tell(Event::OffsetNotTaken(WriteError::LinkLost));
        }
    }

    /// Takes back what is added once the track is over, and forgets what is taken back.
    fn watch_shifted(&mut self, fields: &TrackOffsetFields, now: Moment) {
        let (debts, unit) = (self.owed.debts.clone(), self.owed.unit.clone());
        let is_over = self.added_track_is_over(now);
        let Some(shifted) = debts.shifted(&unit) else {
            if is_over {
                self.unit_offsets.earlier.clear();
            }
            return;
        };
        let Some(held) = self.held_offsets() else { return };
        let Some(added) = shifted.added(held) else {
            tracing::warn!(antenna = self.name, "somebody else has set the offsets of the unit");
            if !shifted.is_found {
                self.tell(Event::OffsetNotTaken(WriteError::ChangedMeanwhile));
            }
            return self.forget_shifted();
        };
        if added.is_none() {
            if is_over || shifted.is_found {
                self.forget_shifted();
            }
            return;
        }
        let waits = self.stop.is_under_way() || self.gate.lock_out().is_some();
        if is_over && !waits && !shifted.is_found && self.may_take_back() {
            // With auto-track on, the unit may begin its next track meanwhile.
            if let Ok(Some(shift)) = self.shift(TrackOffsets::NONE, now)
                && !self.is_judged(&shift.judge, &[shift.axes, shift.sky])
            {
                return;
            }
            self.unit_offsets.left = None;
            self.unit_offsets.wanted = Some(TrackOffsets::NONE);
            self.begin_shift(fields, now);
        }
    }

    /// What the unit has made of what was written is from here too.
    fn own_read_back(&self) {
        let (debts, unit) = (&self.owed.debts, &self.owed.unit);
        let held = self.held_offsets();
        let Some((mut shifted, held)) = debts.shifted(unit).zip(held) else { return };
        if shifted.added(held).is_none() {
            shifted.put.push(held);
            debts.set_shifted(unit, Some(shifted));
            self.keep_shifted();
        }
    }

    /// The unit holds nothing of ours any more.
    fn forget_shifted(&mut self) {
        self.owed.debts.set_shifted(&self.owed.unit, None);
        let tickets = self.unit_offsets.tickets;
        self.unit_offsets = UnitOffsets { tickets, ..UnitOffsets::default() };
        self.keep_shifted();
    }

    /// Makes the record on disk say what is known now.
    fn keep_shifted(&self) {
        let (debts, unit) = (self.owed.debts.clone(), self.owed.unit.clone());
        if debts.has_marks() {
            drop(spawn_blocking(move || {
                debts.keep_shifted(&unit).inspect_err(|error| {
                    tracing::error!(%error, "the record of offsets on the disk is out of date");
                })
            }));
        }
    }

    /// Returns `true` while all that was added is to be taken back, by the operator or at the end of the
    /// track.
    fn is_taking_back(&self) -> bool {
        self.unit_offsets.wanted.is_some_and(TrackOffsets::is_none)
    }

    /// What was wanted does not come about.
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

#[cfg(test)]
mod tests;
