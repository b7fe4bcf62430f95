//! Single steps: the gate judges the next step by a position that shows the last one.

use super::Session;
use crate::{
    clock::Moment,
    contract::driver::{Event, Refusal},
    device::Motion,
};

impl Session {
    /// Starts a step. Refuses while the antenna moves, or while the last step may still start.
    pub(super) fn step(&mut self, steps_deg: [f64; 2], now: Moment) {
        let [x_deg, y_deg] = steps_deg;
        let motion = Motion::Step { x_deg, y_deg };
        let allowed = self.gate.check(motion, self.commanded.activity.intent(), now);
        if allowed.is_ok() && !self.stop.is_under_way() && self.may_move() {
            self.tell(Event::NotSent(Refusal::StillMoving));
        } else if self.start(motion, now) {
            self.commanded.begin_step(steps_deg, now.steady);
        }
    }

    /// Ends a step when a state requested after it shows standstill.
    pub(super) fn watch_step(&mut self, _: Moment) {
        let waits = self.gate.device().motion_under_way();
        self.commanded.follow_step(self.gate.state().measured, waits);
    }
}
