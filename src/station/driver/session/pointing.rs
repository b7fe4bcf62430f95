//! Stop of an antenna that stays off its target, and the end of its pass.

use super::{Session, activity::Activity};
use crate::{
    clock::Moment,
    contract::driver::{Event, OffTargetCause, Safety},
};

impl Session {
    /// Stops an antenna that stays off its target for too long.
    pub(super) fn watch_pointing(&mut self, now: Moment) {
        let off_target = match &self.commanded.activity {
            Activity::ProgramTrack(track) => track.off_target(),
            // The operator has accepted that the unit may miss this pass.
            Activity::OnBoardTrack(track) if track.watch.judge().pass().is_agreed => return,
            Activity::OnBoardTrack(track) => track.watch.unexplained(),
            Activity::Standby | Activity::Manual | Activity::Hold(_) | Activity::GoTo(_) => return,
        };
        if let Some(error) = off_target.hopeless() {
            let cause =
                self.commanded.activity.on_board().and_then(|track| track.watch.cause(error));
            let cause = cause.map(|cause| Box::new(OffTargetCause::Reported(cause)));
            let off_deg = error.degrees();
            self.give_up(Event::Safety(Safety::OffTarget { off_deg, cause }), now);
        }
    }
}
