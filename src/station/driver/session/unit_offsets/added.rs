//! Offsets that Azel added to the unit, according to its reports.

use glam::DQuat;
use jiff::Timestamp;

use crate::{
    astro::{TrackOffsets, time::add_seconds},
    clock::Moment,
    contract::driver::{LeftOffsets, UnitOffsetsView},
    device::OnBoard,
    driver::session::Session,
};

/// Min difference between the window ends of two passes, seconds.
const APART_S: f64 = 30.0;

impl Session {
    /// Returns the difference between the last read offsets and those before Azel's change; `None`
    /// if unknown.
    pub(super) fn added_offsets(&self) -> Option<TrackOffsets> {
        let current = self.current_offsets()?;
        match self.owed.debts().shifted() {
            Some(shifted) => shifted.added(current),
            None => Some(TrackOffsets::NONE),
        }
    }

    /// Returns the last read offsets of the unit in azimuth and elevation; `None` if unknown.
    pub(super) fn current_offsets(&self) -> Option<TrackOffsets> {
        let is_read = self.unit_offsets.is_read(self.last_read());
        self.gate.state().on_board.offsets.filter(|_| is_read)?.of_the_axes()
    }

    /// Returns the time of the last reading of the unit's offsets.
    pub(super) fn last_read(&self) -> Option<Timestamp> {
        let group = self.gate.state().groups.get(self.setup.track_offsets()?.group)?;
        Some(group.last_read.as_ref()?.read_at)
    }

    /// Returns the desired offsets: the antenna should point this far off its target.
    pub(in crate::driver::session) fn desired_offsets(&self) -> TrackOffsets {
        // Leftover offsets of an earlier run, or offsets that Azel failed to remove, are an error
        // of this track.
        let is_meant = self.unit_offsets.left().is_none()
            && self.owed.debts().shifted().is_some_and(|shifted| !shifted.is_found);
        self.added_offsets().filter(|_| is_meant).unwrap_or_default()
    }

    /// Returns the reported state of the unit without the desired offsets.
    pub(in crate::driver::session) fn plain_unit(&self) -> OnBoard {
        self.gate.state().on_board.without_offsets(self.desired_offsets())
    }

    /// Returns the rotation from the modelled beam direction to the true one on the sky. Returns
    /// `None` unless the added offsets correct errors of the mount.
    pub(in crate::driver::session) fn unit_to_sky(&self, now: Moment) -> Option<DQuat> {
        let offsets = Some(self.desired_offsets()).filter(|offsets| !offsets.is_none())?;
        let judge = self.on_board_watch().filter(|_| self.program_is_on())?.judge();
        let axes = offsets.demanded(now.utc, |time| judge.direction(time))?;
        let beam = self.setup.track_config().model.direction(axes);
        Some(DQuat::from_rotation_arc(beam.to_enu(), judge.direction(now.utc)?.to_enu()))
    }

    pub(in crate::driver::session) fn unit_offsets_view(&self) -> Option<UnitOffsetsView> {
        let shifted = self.owed.debts().shifted();
        let offsets = self.added_offsets().unwrap_or_default();
        let is_changing = self.unit_offsets.is_changing();
        let can_undo = self.unit_offsets.last_earlier().is_some();
        let found = || {
            let shifted = shifted.filter(|shifted| shifted.is_found && !offsets.is_none())?;
            Some(LeftOffsets::Found { start: shifted.start })
        };
        let is_shown = is_changing || !offsets.is_none() || can_undo;
        is_shown.then(|| UnitOffsetsView {
            offsets,
            is_changing,
            can_undo,
            left: self.unit_offsets.left().cloned().or_else(found),
        })
    }

    /// Returns `true` once the unit has ended the track with the added offsets, or tracks another
    /// pass.
    pub(super) fn added_track_is_over(&self, now: Moment) -> bool {
        let added_to = self.owed.debts().shifted().and_then(|shifted| shifted.track);
        let is_another = self.reported_track().zip(added_to).is_some_and(|(track, added)| {
            // The unit may report the window of the same pass slightly differently.
            let is_later = add_seconds(added.end, APART_S) < track.end;
            track.catalog_number != added.catalog_number
                || is_later && added.end < self.unit_time(now)
        });
        !self.may_track()
            || is_another && self.program_is_on() && !self.commanded.activity.is_pending()
    }

    /// Returns `true` unless a removal has just failed.
    pub(super) fn may_take_back(&self, now: Moment) -> bool {
        self.unit_offsets.may_take_back(self.may_track(), now.steady)
    }

    /// Returns `true` if the track is over and its added offsets are still on the unit.
    pub(in crate::driver::session) fn owes_offsets(&self) -> bool {
        let now = self.now();
        let is_owed =
            self.owed.debts().shifted().is_some() && self.may_take_back(now) && !self.may_track();
        is_owed && self.added_offsets().is_some_and(|added| !added.is_none())
    }
}
