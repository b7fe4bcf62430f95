//! The motion that waits to be sent, and the list of faults that is read before it.

use super::{
    Satrak,
    exchange::{Purpose, unit_motion},
};
use crate::{
    clock::Moment,
    device::{ControllerEvent, Motion},
    protocol::satrak::{Query, Request},
};

#[derive(Debug, Clone, Copy)]
pub(super) struct WaitingMotion {
    motion: Motion,
    /// The list of faults was requested after the motion and forbids nothing.
    are_faults_read: bool,
}

impl WaitingMotion {
    pub(super) fn new(motion: Motion) -> Self {
        Self { motion, are_faults_read: false }
    }
}

impl Satrak {
    /// The next request for the waiting motion. A fault sets the flag of the status, which the gate
    /// needs fresh, so a motion without the flag goes out at once. While the flag is set, for
    /// example by a warning, it cannot announce another fault: the list comes first.
    pub(super) fn motion_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        let waiting = self.motion?;
        if self.reported.fault_flag && !waiting.are_faults_read {
            return Some((Request::Query(Query::Faults), Purpose::BeforeMotion));
        }
        self.motion = None;
        let motion = waiting.motion;
        if matches!(motion, Motion::StartProgram | Motion::EnableAuto) {
            self.program_switched_on = Some(now.steady);
        }
        match unit_motion(motion) {
            Ok(request) => Some((Request::Motion(request), Purpose::Motion(motion))),
            Err(error) => {
                self.events.push_back(ControllerEvent::Refused(motion.into(), error.to_string()));
                None
            }
        }
    }

    /// The list of faults has come that was requested before the motion.
    pub(super) fn judge_waiting_motion(&mut self) {
        if self.state.motion_lock != Some(false) {
            self.drop_waiting_motion("that a fault forbids motion");
        } else if let Some(waiting) = &mut self.motion {
            waiting.are_faults_read = true;
        }
    }

    /// `answer` reads on from "the unit answered".
    pub(super) fn drop_waiting_motion(&mut self, answer: &str) {
        if let Some(waiting) = self.motion.take() {
            let refused = ControllerEvent::Refused(waiting.motion.into(), answer.to_owned());
            self.events.push_back(refused);
        }
    }
}
