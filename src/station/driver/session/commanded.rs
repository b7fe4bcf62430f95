//! State of the operator's requests to an antenna, and their progress.

use super::{
    activity::{Activity, SlewStage},
    jog_key::JogKey,
};
use crate::{
    clock::Instant,
    contract::driver::Mover,
    device::{Measured, MotionRequest, Pointing},
};

/// Step that may not be over yet.
#[derive(Debug, Clone, Copy, PartialEq)]
struct StepMotion {
    /// Signed step sizes of the two axes, degrees.
    steps_deg: [f64; 2],
    begun: Instant,
}

/// Motion with a lost answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Doubt {
    pub(super) request: MotionRequest,
    begun: Instant,
    /// Angles of the two axes before the motion, degrees.
    pub(super) before_deg: Option<[f64; 2]>,
}

pub(super) struct Commanded {
    pub(super) activity: Activity,
    pub(super) key: JogKey,
    step: Option<StepMotion>,
    /// `true` after an action of the make, until standstill is proved.
    acts: bool,
    doubt: Option<Doubt>,
    /// Direction that the operator previews.
    pub(super) preview: Option<Pointing>,
}

impl Commanded {
    pub(super) fn new() -> Self {
        Self {
            activity: Activity::Standby,
            key: JogKey::default(),
            step: None,
            acts: false,
            doubt: None,
            preview: None,
        }
    }

    /// Returns `true` if a command moves the antenna, or may do so at any time.
    pub(super) fn may_move(&self) -> bool {
        self.activity.may_move() || self.key.pressed().is_some() || self.step.is_some()
    }

    /// Returns `true` if a sent or queued motion must show in the unit's state.
    pub(super) fn is_pending(&self) -> bool {
        self.activity.is_pending() || self.key.pressed().is_some() || self.step.is_some()
    }

    /// Returns the party that moves the antenna if it moves.
    pub(super) fn mover(&self, program_is_on: bool) -> Mover {
        let is_led = match &self.activity {
            Activity::ProgramTrack(_) => true,
            Activity::Standby
            | Activity::Manual
            | Activity::Hold(_)
            | Activity::GoTo(_)
            | Activity::OnBoardTrack(_) => {
                self.activity.slew().is_some_and(|slew| !matches!(slew.stage, SlewStage::Over))
            }
        };
        if is_led || self.acts || self.key.pressed().is_some() || self.step.is_some() {
            Mover::Azel
        } else if program_is_on {
            Mover::Program
        } else {
            Mover::Somebody
        }
    }

    /// Ends the current motion. A STOP by the operator also ends a key that is still down.
    pub(super) fn halt(&mut self, is_pressed: bool) {
        if is_pressed {
            self.key.spend();
        }
        self.key.end();
        self.step = None;
        self.doubt = None;
        self.activity.halt();
    }

    /// Records a moving action of the make.
    pub(super) fn act(&mut self) {
        self.acts = true;
    }

    pub(super) fn note_standstill(&mut self) {
        self.acts = false;
    }

    pub(super) fn begin_step(&mut self, steps_deg: [f64; 2], now: Instant) {
        self.step = Some(StepMotion { steps_deg, begun: now });
    }

    /// Returns the sizes of a step that may not be over yet, degrees.
    pub(super) fn steps_deg(&self) -> Option<[f64; 2]> {
        self.step.map(|step| step.steps_deg)
    }

    pub(super) fn end_step(&mut self) {
        self.step = None;
    }

    /// Ends a step when a state requested after it shows standstill. `waits`: the motion has not
    /// been sent or answered.
    pub(super) fn follow_step(&mut self, measured: Option<Measured>, waits: bool) {
        let Some(StepMotion { begun, .. }) = self.step else { return };
        // A state from before the step shows the earlier standstill.
        let stands =
            measured.is_some_and(|measured| measured.requested > begun && !measured.moving());
        if stands && !waits {
            self.step = None;
        }
    }

    /// Records a motion with a lost answer.
    pub(super) fn doubt(
        &mut self,
        request: MotionRequest,
        before_deg: Option<[f64; 2]>,
        now: Instant,
    ) {
        self.doubt = Some(Doubt { request, begun: now, before_deg });
    }

    pub(super) fn is_in_doubt(&self) -> bool {
        self.doubt.is_some()
    }

    /// Takes the doubt if a state requested after it can resolve it.
    pub(super) fn take_doubt(&mut self, measured: Option<Measured>) -> Option<Doubt> {
        // An older state cannot show the motion.
        let is_newer =
            |doubt: &mut Doubt| measured.is_some_and(|measured| measured.requested > doubt.begun);
        self.doubt.take_if(is_newer)
    }
}
