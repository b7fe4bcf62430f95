//! Offsets of a track, changed while the track runs.

use super::{Session, program_track::motion, tracking::Tracking};
use crate::{
    astro::{MAX_ANGLE_OFFSET, MAX_TIME_OFFSET, Offset, TrackOffsets},
    clock::Moment,
    contract::driver::{Command, Event, OffsetChange, Refusal},
    driver::gate::Demand,
};

impl Session {
    pub(super) fn change_offsets(&mut self, change: OffsetChange, now: Moment) {
        let changed = if self.commanded.activity.program().is_some() {
            self.try_offsets(change, now)
        } else {
            self.change_unit_offsets(change, now)
        };
        if let Err(refusal) = changed {
            self.tell(Event::OffsetRefused(refusal));
        }
    }

    /// Sets the offsets with which the remaining passes of the track begin.
    pub(super) fn begin_with(&mut self, offsets: TrackOffsets) {
        if let Some(track) = self.commanded.activity.program_mut() {
            track.planner.begin_with(offsets);
        }
    }

    fn try_offsets(&mut self, change: OffsetChange, now: Moment) -> Result<(), Refusal> {
        let track = self.commanded.activity.program().ok_or(Refusal::NoTrack)?;
        let before = track.planner.offsets();
        let offsets = match change {
            OffsetChange::Step(step) => {
                self.check_offer(step, track)?;
                before
                    .plus(step)
                    .ok_or_else(|| Refusal::OffsetTooLarge { max: max_offset(step) })?
            }
            OffsetChange::Zero => TrackOffsets::NONE,
            OffsetChange::Undo => track.last_earlier().ok_or(Refusal::Nothing)?,
        };
        let demand = demand(track, offsets, now).ok_or(Refusal::PassUnknown)?;
        // Without offsets, the track continues as requested, and waits at an edge.
        if !offsets.is_none() {
            self.gate.demand_is_clear(demand, now)?;
        }
        // Only a planner with the new offsets can predict their path. A refusal restores the
        // previous offsets.
        self.take_offsets(offsets, now);
        if let Err(refusal) = self.check_next(now)
            && !offsets.is_none()
        {
            self.take_offsets(before, now);
            if let Refusal::BeingJudged = refusal {
                self.wait_for_judgement(Command::Offset(change));
                return Ok(());
            }
            return Err(refusal);
        }
        let Some(track) = self.commanded.activity.program_mut() else { return Ok(()) };
        match change {
            OffsetChange::Undo => track.drop_last_earlier(),
            OffsetChange::Step(_) | OffsetChange::Zero if offsets == before => {}
            OffsetChange::Step(_) | OffsetChange::Zero => track.remember(before),
        }
        track.look_at(now.steady);
        Ok(())
    }

    /// Checks the path to the next position of the track.
    fn check_next(&mut self, now: Moment) -> Result<(), Refusal> {
        let axes = Tracking::turning(self.gate.state().measured);
        let Some(track) = self.commanded.activity.program_mut() else { return Ok(()) };
        let order = self.judging.open_order(&mut track.planner, axes, now);
        if let Some(order) = order.map_err(|_| Refusal::PassUnknown)? {
            self.judging.plan(order);
            return Err(Refusal::BeingJudged);
        }
        let next = track.planner.update(now.utc, axes).map_err(|_| Refusal::PassUnknown)?;
        next.map_or(Ok(()), |next| self.route(motion(next), now).map(drop))
    }

    /// Checks whether the track can have an offset of this kind.
    fn check_offer(&self, step: Offset, track: &Tracking) -> Result<(), Refusal> {
        let has_elevation = self.setup.can().has_elevation();
        match step {
            Offset::Along(_) | Offset::Across(_) if !track.planner.track().target.moves() => {
                Err(Refusal::TargetStands)
            }
            Offset::Elevation(_) if !has_elevation => Err(Refusal::NotOffered),
            _ => Ok(()),
        }
    }

    fn take_offsets(&mut self, offsets: TrackOffsets, now: Moment) {
        if let Some(track) = self.commanded.activity.program_mut() {
            track.planner.set_offsets(offsets);
        }
        self.watch_offsets(now);
    }

    /// Informs the gate about the direction of the axes on the sky.
    pub(super) fn watch_offsets(&mut self, now: Moment) {
        let track = self.commanded.activity.program();
        let to_sky = track.and_then(|track| {
            track.planner.to_sky(track.phase().begins(now.utc), track.planner.offsets())
        });
        self.gate.set_to_sky(to_sky.or_else(|| self.unit_to_sky(now)));
    }
}

pub(super) fn max_offset(step: Offset) -> Offset {
    match step {
        Offset::Time(_) => Offset::Time(MAX_TIME_OFFSET),
        Offset::Along(_) => Offset::Along(MAX_ANGLE_OFFSET),
        Offset::Across(_) => Offset::Across(MAX_ANGLE_OFFSET),
        Offset::Azimuth(_) => Offset::Azimuth(MAX_ANGLE_OFFSET),
        Offset::Elevation(_) => Offset::Elevation(MAX_ANGLE_OFFSET),
    }
}

/// Returns the direction of the track with these offsets, now or at the start of its pass.
fn demand(track: &Tracking, offsets: TrackOffsets, now: Moment) -> Option<Demand> {
    let time = track.phase().begins(now.utc);
    let [axes, plain] =
        [offsets, offsets.of_time()].map(|offsets| track.planner.demanded(time, offsets));
    let sky = track.planner.on_the_sky(time, offsets);
    Some(Demand { time, axes: axes?, sky: sky?, plain: plain? })
}
