//! The motion that waits to be sent, and the list of faults that Azel reads before it.

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
    /// `true` if Azel requested the list of faults after the motion, and the list forbids nothing.
    are_faults_read: bool,
}

impl WaitingMotion {
    pub(super) fn new(motion: Motion) -> Self {
        Self { motion, are_faults_read: false }
    }
}

impl Satrak {
    /// Returns the next request for the waiting motion. A fault sets the flag of the status, which
    /// the gate needs fresh, so Azel sends a motion without the flag immediately. A flag that is
    /// already set, for example by a warning, cannot announce another fault: Azel reads the list
    /// first.
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

    /// Judges the waiting motion by the list of faults that has come for it.
    pub(super) fn judge_waiting_motion(&mut self) {
        if self.state.motion_lock != Some(false) {
            self.drop_waiting_motion("that a fault forbids motion");
        } else if let Some(waiting) = &mut self.motion {
            waiting.are_faults_read = true;
        }
    }

    /// Refuses the waiting motion. `answer` completes the sentence "the unit answered".
    pub(super) fn drop_waiting_motion(&mut self, answer: &str) {
        if let Some(waiting) = self.motion.take() {
            let refused = ControllerEvent::Refused(waiting.motion.into(), answer.to_owned());
            self.events.push_back(refused);
        }
    }
}
