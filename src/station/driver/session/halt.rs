//! Halt of the antenna, and proof that it stands.

use super::{Session, activity::Activity, standstill::Proof, stop::HaltLook};
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Event, Safety},
    device::Extent,
};

impl Session {
    /// Stops everything on the operator's request. The gate never refuses a halt.
    pub(super) fn halt(&mut self, now: Moment) {
        self.commanded.activity = Activity::Standby;
        self.gate.device().disarm();
        self.begin_halt(true, now);
    }

    /// Stops the motion without leaving the mode, as at the end of a jog.
    pub(super) fn halt_quietly(&mut self, now: Moment) {
        self.begin_halt(false, now);
    }

    fn begin_halt(&mut self, pressed: bool, now: Moment) {
        if !self.stop.is_under_way() {
            // During a repeated STOP the axes already slow down, which shows no overrun.
            self.begin_overrun(now);
        }
        self.commanded.halt(pressed);
        self.judging.drop_waiting();
        self.void_shift();
        self.gate.note_halt();
        if pressed {
            // After an operator's STOP, no motion may start on its own. The halt at the end of a
            // motion keeps the operator's auto-track setting.
            self.end_auto_track();
        }
        self.queue_halt(if pressed { Extent::Everything } else { Extent::Motion }, now);
        self.owed.debts().owe_stop();
        self.stop.begin(pressed, self.gate.device().halt_patience(), now.steady);
        // If a link is open, write the STOP bytes first.
        if !self.contact.is_open() {
            self.record_debt(now);
        }
    }

    /// Queues the bytes of a halt as the next bytes to write.
    pub(super) fn queue_halt(&mut self, extent: Extent, now: Moment) {
        let bytes = self.gate.device().halt(extent, now);
        self.stop.queue(bytes);
        if extent == Extent::Everything {
            self.owed.record_auto_track_request(Some(now.steady));
        }
    }

    /// Checks whether the antenna stands, and repeats the halt until it does.
    pub(super) fn watch_halt(&mut self, now: Moment) {
        let is_open = self.contact.is_open();
        if !self.stop.has_bytes() || !is_open {
            self.record_debt(now);
        }
        let (figures, is_at_rest) = (self.figures(), self.is_at_rest());
        let patience = self.gate.device().halt_patience();
        let state = self.gate.state();
        let look = self.stop.look(state, is_at_rest, is_open, figures, patience, now.steady);
        let HaltLook { proof, send_again, asks_position, is_overdue } = look;
        if let Some(proof) = proof {
            return self.end_halt(proof, now);
        }
        if let Some(extent) = send_again {
            self.queue_halt(extent, now);
        }
        if asks_position {
            self.gate.device().ask_position(now);
        }
        if is_overdue {
            self.tell(Event::StopNotConfirmed);
        }
    }

    fn end_halt(&mut self, proof: Proof, now: Moment) {
        let is_pressed = self.stop.end(now.steady);
        self.owed.settle_stop();
        self.prove_still();
        self.gate.note_standstill(now);
        self.end_overrun();
        if is_pressed {
            self.tell(Event::Stopped);
            if let Proof::Flags { axis } = proof {
                let axis = self.setup.axis_name(axis);
                self.tell(Event::Safety(Safety::StoppedByFlags { axis }));
            }
            if self.gate.state().program.is_some_and(|program| program.auto == Some(true)) {
                self.tell(Event::AutoTrackStillOn);
            }
        }
    }

    /// Accepts the operator's confirmation that the antenna stands.
    pub(super) fn accept_operator_standstill(&mut self) {
        tracing::warn!(antenna = self.setup.name(), "standstill by the operator's word");
        // Motion flags or a missing angle may prevent the proof for ever.
        self.stop.end_unproved();
        self.contact.silence.forget();
        self.owed.settle_stop();
        self.prove_still();
    }

    /// Returns `true` if the unit's flags report both axes at rest.
    fn is_at_rest(&self) -> bool {
        let state = self.gate.state();
        state.measured.is_some_and(|measured| !measured.moving())
            && state.program.is_none_or(|program| !program.enabled)
    }

    /// Reports an antenna that turns although its unit reports standstill.
    pub(super) fn watch_rest(&mut self, _: Moment) {
        let is_at_rest = self.is_at_rest() && self.stop.has_run_out();
        let Some(look) = self.gate.state().measured else { return };
        let (began, figures) = (self.gate.unproved_since(), self.alarm_figures());
        let turned = self.observed.turned_at_rest(look, is_at_rest, began, figures);
        if let Some((axis, turned_deg)) = turned {
            let axis = self.setup.axis_name(axis);
            self.tell(Event::Safety(Safety::FlagsContradict { axis, turned_deg }));
        }
    }

    /// Records the rates of the axes when a STOP goes out.
    fn begin_overrun(&mut self, now: Moment) {
        // Motions other than a jog may already slow down.
        let jog = self.commanded.key.started();
        let rates = jog.map(|_| self.observed.monitor.last_rates_deg_s());
        self.observed.overrun.begin(self.gate.state().measured.zip(rates), now.steady);
    }

    /// Learns the overrun from a STOP that has ended.
    fn end_overrun(&mut self) {
        let Some(rest) = self.gate.state().measured else { return };
        let fastest_deg_s = self.setup.track_config().fastest_deg_s();
        if let Some(overrun_s) = self.observed.overrun.end(&rest, fastest_deg_s) {
            self.gate.set_overrun(overrun_s);
        }
    }

    /// Returns the time of the next check of the halt.
    pub(super) fn halt_due(&self) -> Option<Instant> {
        self.stop.due(self.figures(), self.contact.is_open())
    }

    /// Removes the outline of the STOP button after a while.
    pub(super) fn forget_old_stop(&mut self, now: Moment) {
        self.stop.forget_old(now.steady);
    }
}
