//! Debts of Azel to a unit: a STOP, disabled auto-track, and the record of both.

use std::sync::Arc;

use jiff::Timestamp;
use tokio::sync::Notify;

use super::{
    auto_track::{AutoTrackOff, NextStep},
    locking::Locking,
    marking::{MarkProgress, Marking},
    unit_debts::UnitDebts,
};
use crate::{
    clock::{Instant, Moment},
    contract::driver::{LeftMoving, Unit},
    device::AntennaState,
    driver::debts::Debts,
};

pub(super) struct Owed {
    debts: UnitDebts,
    auto_track: AutoTrackOff,
    marking: Marking,
    /// Possible motion from an earlier run, with its start, during the question to the operator.
    left_moving: Option<LeftMoving>,
    /// Progress of a lock-out.
    pub(super) locking: Locking,
}

impl Owed {
    /// Begins a session of `unit`; notifies `stop` at once if Azel owes the unit a STOP.
    pub(super) fn begin(debts: Debts, unit: Unit, stop: Arc<Notify>) -> Self {
        Self {
            debts: UnitDebts::begin(debts, unit, stop),
            auto_track: AutoTrackOff::default(),
            marking: Marking::default(),
            left_moving: None,
            locking: Locking::default(),
        }
    }

    pub(super) fn debts(&self) -> &UnitDebts {
        &self.debts
    }

    pub(super) fn left_moving(&self) -> Option<LeftMoving> {
        self.left_moving
    }

    pub(super) fn keep_unproved(&mut self, moved_at: Option<Instant>) {
        self.debts.keep_unproved(moved_at);
    }

    /// Requests the mark of a moving unit, unless this session already has.
    pub(super) fn follow_mark(&mut self, now: Moment) -> MarkProgress {
        if !self.debts.has_marks() {
            return MarkProgress::Settled;
        }
        self.marking.follow(&self.debts, now)
    }

    /// Refreshes the mark from time to time while the session attends to the unit.
    pub(super) fn refresh_mark(&mut self, now: Moment) {
        if self.debts.has_marks() {
            self.marking.refresh(&self.debts, now);
        }
    }

    /// Requests the mark with the current time. Returns `false` without a folder for marks.
    pub(super) fn put_mark(&mut self, now: Moment) -> bool {
        let has_marks = self.debts.has_marks();
        if has_marks {
            self.marking.request(&self.debts, now);
        }
        has_marks
    }

    /// Records a mark of an earlier run. `asks`: the operator must decide.
    pub(super) fn found_mark(&mut self, begun: Option<Timestamp>, asks: bool) {
        self.marking = Marking::found(begun);
        self.left_moving = asks.then_some(LeftMoving { start: begun });
    }

    /// Returns the reason why the next start would not know of the owed STOP.
    pub(super) fn not_on_disk(&self, now: Instant) -> Option<String> {
        if !self.debts.has_marks() {
            return Some("this user has no folder for it".to_owned());
        }
        self.marking.not_on_disk(&self.debts, now)
    }

    /// Returns the time of the next check whether the mark is on disk.
    pub(super) fn marking_due(&self, now: Instant) -> Option<Instant> {
        self.marking.due(&self.debts, now)
    }

    /// Clears the owed STOP after proved standstill.
    pub(super) fn settle_stop(&mut self) {
        self.debts.settle_stop();
        self.left_moving = None;
        self.marking.remove(&self.debts);
    }

    /// Records that the unit must not start on its own.
    pub(super) fn owe_auto_track_off(&mut self) {
        self.debts.owe_auto_track_off();
        self.auto_track = AutoTrackOff::default();
    }

    /// Records a request on this link to disable auto-track; `None` for a new link.
    pub(super) fn record_auto_track_request(&mut self, time: Option<Instant>) {
        self.auto_track.record_request(time);
    }

    /// Records that the unit has refused to disable auto-track or has not answered. Returns `true`
    /// if the operator must know.
    pub(super) fn auto_stays_on(&mut self) -> bool {
        self.auto_track.is_first_report() || !self.debts.owes_auto_track_off()
    }

    /// Returns the next step to disable auto-track, if owed.
    pub(super) fn next_for_auto_track(&mut self, state: &AntennaState, now: Instant) -> NextStep {
        if !self.debts.owes_auto_track_off() {
            return NextStep::Wait;
        }
        let next = self.auto_track.next(state, now);
        match next {
            NextStep::Wait | NextStep::SwitchOff => {}
            NextStep::Proved | NextStep::Unreadable => self.debts.settle_auto_track(),
        }
        next
    }
}
