//! Stops an antenna that stays off its target, and gives up its pass.

use super::{Session, activity::Activity};
use crate::{
    astro::Angle,
    clock::Moment,
    contract::driver::{Event, OffTargetCause, Safety},
};

impl Session {
    /// Stops an antenna that stays off its target for too long.
    pub(super) fn watch_pointing(&mut self, now: Moment) {
        let off_target = match &self.activity {
            Activity::ProgramTrack(track) => track.off_target,
            // The operator knows that the unit may miss this pass.
            Activity::OnBoardTrack(track) if track.watch.judge().pass().is_agreed => return,
            Activity::OnBoardTrack(track) => track.watch.unexplained(),
            Activity::Standby | Activity::Manual | Activity::Hold(_) | Activity::GoTo(_) => return,
        };
        if let Some(off) = off_target.hopeless() {
            let cause = self.activity.on_board().and_then(|track| track.watch.cause(off));
            let cause = cause.map(|cause| Box::new(OffTargetCause::Reported(cause)));
            let off_deg = off.degrees();
            self.give_up(Event::Safety(Safety::OffTarget { off_deg, cause }), now);
        }
    }

    /// Largest angle off target of an antenna whose beam holds it: half the beam, and what rounding
    /// both angles to their resolution makes at most, with the noise.
    pub(super) fn in_beam(&self) -> Angle {
        let resolution_deg = self.variant.capabilities.standstill.resolution_deg;
        let error_deg = resolution_deg + self.figures().tolerance_deg();
        self.setup.ability.half_beam + Angle::from_degrees(error_deg)
    }

    /// Largest angle off target of a working antenna: that, the tolerance of an arrival, and as much
    /// again of rounding, for a unit that cuts its angles off.
    pub(super) fn on_target(&self) -> Angle {
        let can = self.variant.capabilities;
        let more_deg = can.standstill.resolution_deg + can.arrives_within_deg;
        self.in_beam() + Angle::from_degrees(more_deg)
    }
}
