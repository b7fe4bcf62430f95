//! A halt from the first byte to proved standstill.

use std::time::{Duration, Instant};

use super::{
    Event, Intent, Session,
    standstill::{Looks, Proof},
};
use crate::{
    controller::{Extent, Moment},
    driver::{Safety, StopState},
};

/// A stop that is not proved after this long is told as such.
const PROOF: Duration = Duration::from_secs(3);
/// Where the proof itself takes long, it may take this much longer.
const BEYOND_PROOF: Duration = Duration::from_secs(1);
/// For how long the button shows that all is stopped.
const SHOWN: Duration = Duration::from_secs(10);

/// A halt under way.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Halting {
    since: Instant,
    /// The looks that were asked for since it was sent.
    looks: Looks,
    /// When it went out first.
    sent_at: Instant,
    /// A stop is harmless, so it is sent again until it is proved.
    again_at: Instant,
    /// The operator pressed STOP, rather than let go of a key.
    pressed: bool,
    /// It was told that standstill is not proved.
    told: bool,
}

/// The state of the stop button.
pub(super) fn shown(
    halting: Option<&Halting>,
    stopped_at: Option<Instant>,
    now: Instant,
) -> StopState {
    match (halting, stopped_at) {
        (Some(&Halting { since, told: true, .. }), _) => StopState::NotConfirmed { since },
        (Some(&Halting { since, pressed: true, .. }), _) => StopState::Stopping { since },
        (_, Some(at)) if now.saturating_duration_since(at) < SHOWN => StopState::Stopped { at },
        _ => StopState::Ready,
    }
}

impl Session {
    /// The operator wants everything to stand still. Never refused.
    pub(super) fn halt(&mut self, now: Moment) {
        self.intent = Intent::Standby;
        self.gate.device().disarm();
        self.begin_halt(true, now);
    }

    /// Stops the motion without leaving the intent, as at the end of a jog.
    pub(super) fn halt_quietly(&mut self, now: Moment) {
        self.begin_halt(false, now);
    }

    fn begin_halt(&mut self, pressed: bool, now: Moment) {
        if self.halting.is_none() {
            self.begin_run_out(now);
        }
        if pressed && let Some(jog) = &self.jog {
            self.ended_hold = Some(jog.rates_deg_s);
        }
        self.jog = None;
        self.stepping = None;
        self.waiting = None;
        self.pending = None;
        self.aim = None;
        self.leg = None;
        self.target = None;
        self.following = None;
        self.doubt = None;
        self.stopped_at = None;
        let extent = if pressed { Extent::Everything } else { Extent::Motion };
        self.urgent = self.gate.device().halt(extent, now);
        // Pressing again does not put off the word that standstill is not proved.
        let running = self.halting.take();
        self.debts.owe(&self.unit);
        self.halting = Some(Halting {
            since: running.as_ref().map_or(now.steady, |halting| halting.since),
            looks: running.as_ref().map_or_else(Looks::default, |halting| halting.looks),
            sent_at: running.as_ref().map_or(now.steady, |halting| halting.sent_at),
            again_at: now.steady + self.gate.device().halt_patience(),
            pressed: pressed || running.as_ref().is_some_and(|halting| halting.pressed),
            told: running.is_some_and(|halting| halting.told),
        });
    }

    /// Looks whether the antenna stands, and keeps at it while it does not.
    pub(super) fn watch_halt(&mut self, now: Moment) {
        let figures = self.figures;
        let proof_after = PROOF.max(figures.gap() + BEYOND_PROOF);
        let is_at_rest = self.is_at_rest();
        let Some(halting) = &mut self.halting else { return };
        let state = self.gate.state();
        // A halt that is not the operator's leaves alone what else turns.
        let is_at_rest = is_at_rest && !(halting.pressed && state.turns_besides);
        let look = state.measured.filter(|measured| measured.asked >= halting.sent_at);
        let proof =
            look.and_then(|look| halting.looks.take(look, is_at_rest, state.link_since, figures));
        if let Some(proof) = proof {
            return self.end_halt(proof, now);
        }
        let unproved = now.steady.saturating_duration_since(halting.since) >= proof_after;
        let newly_unproved = unproved && !std::mem::replace(&mut halting.told, unproved);
        // While looks agree, another STOP would tell the unit nothing.
        let again = now.steady >= halting.again_at && halting.looks.next(figures).is_none();
        let looks_again = halting.looks.is_due(figures, now.steady);
        // Without a link the first thing sent on the next one is the halt.
        if again && self.link.is_open() {
            halting.again_at = now.steady + self.gate.device().halt_patience();
            self.urgent = self.gate.device().halt(Extent::Everything, now);
        }
        if looks_again {
            self.gate.device().look(now);
        }
        if newly_unproved {
            self.tell(Event::StopNotConfirmed);
        }
    }

    fn end_halt(&mut self, proof: Proof, now: Moment) {
        let is_pressed = self.halting.take().is_some_and(|halting| halting.pressed);
        self.settle_debt();
        self.prove_still();
        self.end_run_out();
        if is_pressed {
            self.stopped_at = Some(now.steady);
            self.tell(Event::Stopped);
            if let Proof::Flags { axis } = proof {
                let axes = self.make.capabilities.axes;
                let axis = axes.get(axis).copied().unwrap_or_default();
                self.tell(Event::Safety(Safety::StoppedByFlags { axis }));
            }
            if self.gate.state().program.is_some_and(|program| program.auto == Some(true)) {
                self.tell(Event::AutoTrackStillOn);
            }
        }
    }

    /// The operator has seen that it stands.
    pub(super) fn take_word_for_standstill(&mut self) {
        tracing::warn!(antenna = self.name, "standstill by the operator's word");
        self.halting = None;
        self.forget_silence();
        self.urgent.clear();
        self.settle_debt();
        self.prove_still();
    }

    /// Whether the flags of the unit say that both axes are at rest.
    fn is_at_rest(&self) -> bool {
        let state = self.gate.state();
        state.measured.is_some_and(|measured| !measured.moving())
            && state.program.is_none_or(|program| !program.enabled)
    }

    /// Tells of an antenna that turns although its unit says that it stands.
    pub(super) fn watch_rest(&mut self) {
        let is_at_rest = self.is_at_rest() && self.halting.as_ref().is_none_or(|it| it.told);
        let Some(look) = self.gate.state().measured else { return };
        if self.looked == Some(look.received) {
            return;
        }
        self.looked = Some(look.received);
        if let Some((axis, turned_deg)) = self.rest.take(look, is_at_rest, self.figures) {
            let axis = self.make.capabilities.axes.get(axis).copied().unwrap_or_default();
            self.tell(Event::Safety(Safety::FlagsContradict { axis, turned_deg }));
        }
    }

    /// When a halt has to be looked at again.
    pub(super) fn halt_due(&self) -> Option<Instant> {
        let proof_after = PROOF.max(self.figures.gap() + BEYOND_PROOF);
        if let Some(halting) = &self.halting {
            let proof = (!halting.told).then_some(halting.since + proof_after);
            let again = match halting.looks.next(self.figures) {
                Some(at) => halting.looks.awaits_look().then_some(at),
                None => Some(halting.again_at),
            };
            let again = again.filter(|_| self.link.is_open());
            return proof.into_iter().chain(again).min();
        }
        self.stopped_at.map(|at| at + SHOWN)
    }

    /// The outline of the button fades after a while.
    pub(super) fn forget_old_stop(&mut self, now: Moment) {
        if self.stopped_at.is_some_and(|at| now.steady.saturating_duration_since(at) >= SHOWN) {
            self.stopped_at = None;
        }
    }
}
