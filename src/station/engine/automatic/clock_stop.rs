//! Resumption of a program track that a clock step has stopped, once the time service confirms the
//! clock.

use std::time::Duration;

use crate::{
    clock::Instant,
    contract::{driver, driver::TimeSync},
    engine::Engine,
};

/// Max time between a session's report of the step and its question, which may arrive in two turns.
const SAME_STEP: Duration = Duration::from_secs(1);

/// Program track that waits for the operator after a clock step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ClockStop {
    stepped: Option<Instant>,
    requested: Option<Instant>,
}

impl ClockStop {
    pub(super) fn take_step(&mut self, instant: Instant) {
        self.stepped = Some(instant);
    }

    /// Notes the question of a session. An outage may also cause such a question.
    pub(super) fn take_question(&mut self, instant: Instant) {
        let is_by_step = self
            .stepped
            .is_some_and(|stepped| instant.saturating_duration_since(stepped) < SAME_STEP);
        if is_by_step {
            self.requested = Some(instant);
        }
    }
}

impl Engine {
    /// Resumes the track of a pass that automatic operation is taking, if the time service
    /// synchronises the clock.
    pub(super) fn resume_after_step(&mut self, index: usize) {
        let is_kept = self.time_sync == TimeSync::Synchronised;
        let (now, steady) = (self.now, self.steady);
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        // The clock watch of this turn may have run before the step.
        let is_later = |request_time: Instant| request_time < steady;
        if !antenna.at_work.clock_stop.requested.is_some_and(is_later) {
            return;
        }
        let track = antenna.shown.snapshot.program_track.as_ref();
        if !track.is_some_and(|track| track.awaits_operator) {
            antenna.at_work.clock_stop = ClockStop::default();
            return;
        }
        let taking = antenna.shown.operation.taking();
        let is_taken = taking.is_some_and(|taking| taking.given_up.is_none() && now < taking.end);
        if is_kept && is_taken {
            antenna.at_work.clock_stop = ClockStop::default();
            antenna.shown.track_again = None;
            self.send(index, driver::Command::Resume);
        }
    }
}
