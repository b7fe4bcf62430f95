//! The unit's own program: its state and its target.

use jiff::Timestamp;

use crate::{
    astro::time::add_seconds,
    clock::Moment,
    device::Phase,
    driver::{
        debts::AddedTo,
        session::{Session, activity::OnBoardStage},
    },
};

impl Session {
    /// Returns `true` while the unit tracks on its own or is about to, and Azel knows its pass.
    pub(super) fn on_board_is_running(&self) -> bool {
        self.program_is_on()
            && !self.commanded.activity.is_pending()
            && self.on_board_watch().is_some()
    }

    pub(super) fn program_is_on(&self) -> bool {
        let program = self.gate.state().program.filter(|_| !self.contact.is_unread());
        program.is_some_and(|program| program.enabled && program.phase != Phase::Completed)
    }

    /// Returns `true` unless Azel knows that the unit does not track: other offsets would move the
    /// antenna.
    pub(super) fn may_track(&self) -> bool {
        let stage = self.commanded.activity.on_board().map(|track| track.stage);
        let is_starting = matches!(stage, Some(OnBoardStage::Starting { .. }));
        self.contact.is_unread() || self.program_is_on() || is_starting
    }

    /// Returns the satellite that the unit reports to track, and the end of its track by its own
    /// clock.
    pub(super) fn reported_track(&self) -> Option<AddedTo> {
        let report = &self.gate.state().on_board;
        let catalog_number = report.satellite.as_ref()?.catalog_number;
        Some(AddedTo { catalog_number, end: report.window?.1 })
    }

    /// Returns UTC by the clock of the unit.
    pub(super) fn unit_time(&self, now: Moment) -> Timestamp {
        let clock = self.gate.state().on_board.clock;
        add_seconds(now.utc, clock.map_or(0.0, |clock| clock.ahead_s))
    }
}
