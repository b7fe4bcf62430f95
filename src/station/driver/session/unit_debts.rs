//! Debts of one unit, from the view of its session.

use std::sync::Arc;

use tokio::{sync::Notify, task::spawn_blocking};

use crate::{
    clock::Instant,
    contract::driver::Unit,
    driver::debts::{Debts, Mark, ShiftedTrack},
    promises::PromisedFile,
};

/// Debts to the unit, including debts from other sessions and earlier runs.
pub(super) struct UnitDebts {
    debts: Debts,
    unit: Unit,
    /// Number of this session among the sessions of the unit.
    number: u64,
    /// Start of the recorded motion without proved standstill.
    kept_unproved: Option<Instant>,
}

impl UnitDebts {
    /// Begins a session of `unit`; notifies `stop` at once if Azel owes the unit a STOP.
    pub(super) fn begin(debts: Debts, unit: Unit, stop: Arc<Notify>) -> Self {
        let number = debts.begin(&unit, stop);
        let kept_unproved = debts.unproved_since(&unit);
        Self { debts, unit, number, kept_unproved }
    }

    /// Returns the start of the unit's motion without proved standstill.
    pub(super) fn unproved_since(&self) -> Option<Instant> {
        self.kept_unproved
    }

    /// Records the motion for the unit's next session, whose antenna may have other settings.
    pub(super) fn keep_unproved(&mut self, moved_at: Option<Instant>) {
        if moved_at != self.kept_unproved {
            self.kept_unproved = moved_at;
            self.debts.keep_unproved(&self.unit, self.number, moved_at);
        }
    }

    pub(super) fn owe_stop(&self) {
        self.debts.owe(&self.unit);
    }

    pub(super) fn settle_stop(&self) {
        self.debts.settle(&self.unit);
    }

    /// Returns `true` if another session of the unit has begun and takes over the debts.
    pub(super) fn is_relieved(&self, owes_stop: bool) -> bool {
        if owes_stop {
            self.debts.hand_over(&self.unit, self.number)
        } else {
            self.debts.is_followed(&self.unit, self.number)
        }
    }

    pub(super) fn owe_auto_track_off(&self) {
        self.debts.owe_auto_track_off(&self.unit);
    }

    pub(super) fn settle_auto_track(&self) {
        self.debts.settle_auto_track(&self.unit);
    }

    pub(super) fn owes_auto_track_off(&self) -> bool {
        self.debts.owes_auto_track_off(&self.unit)
    }

    /// Returns `true` if a folder for marks exists.
    pub(super) fn has_marks(&self) -> bool {
        self.debts.has_marks()
    }

    pub(super) fn mark(&self, mark: Mark) {
        self.debts.mark(&self.unit, self.number, mark);
    }

    pub(super) fn mark_kept(&self) -> PromisedFile {
        self.debts.mark_kept(&self.unit)
    }

    pub(super) fn unmark(&self) {
        self.debts.unmark(&self.unit, self.number);
    }

    /// Reads the records of an earlier run from disk. Returns its mark.
    pub(super) async fn find(&self) -> Option<Mark> {
        let (debts, unit, number) = (self.debts.clone(), self.unit.clone(), self.number);
        let finding = spawn_blocking(move || {
            debts.find_shifted(&unit);
            debts.take_over_mark(&unit, number)
        });
        finding.await.ok().flatten()
    }

    /// Waits until the disk has stored all requests for this unit.
    pub(super) async fn settled(&self) {
        self.debts.wait_for_disk(&self.unit).await;
    }

    /// Returns the offsets that Azel added for a track of the unit.
    pub(super) fn shifted(&self) -> Option<ShiftedTrack> {
        self.debts.shifted(&self.unit)
    }

    pub(super) fn set_shifted(&self, shifted: Option<ShiftedTrack>) {
        self.debts.set_shifted(&self.unit, shifted);
    }

    pub(super) fn shifted_kept(&self) -> PromisedFile {
        self.debts.shifted_kept(&self.unit)
    }
}
