//! A halt, from its first byte to proved standstill.

use std::time::Duration;

use super::{
    Session,
    activity::Activity,
    standstill::{Figures, Looks, Proof},
};
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Event, Safety, StopState},
    device::Extent,
};

/// A halt that is not proved by then is reported.
const PROOF: Duration = Duration::from_secs(3);
/// Additional time where the proof itself takes long.
const BEYOND_PROOF: Duration = Duration::from_secs(1);
/// How long the STOP button shows that everything has stopped.
const SHOWN: Duration = Duration::from_secs(10);

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Halting {
    since: Instant,
    /// The positions asked for since it was sent.
    looks: Looks,
    sent_at: Instant,
    /// When to send it again; a repeated STOP is harmless.
    again_at: Instant,
    /// The operator pressed STOP; otherwise it ends a motion.
    pressed: bool,
    /// Azel has reported that standstill is not proved.
    told: bool,
}

impl Halting {
    fn extent_again(&self) -> Extent {
        if self.pressed { Extent::Everything } else { Extent::Track }
    }

    /// Time from STOP until Azel reports that standstill is not proved. While all positions agree,
    /// only late replies delay the proof.
    fn told_after(&self, figures: Figures) -> Duration {
        let usual = PROOF.max(figures.gap() + BEYOND_PROOF);
        if self.looks.want_stop() { usual } else { usual + BEYOND_PROOF }
    }
}

/// STOP of an antenna, pressed or at the end of a motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Stop {
    /// No halt is under way.
    Ready,
    /// Sent, and standstill is not proved.
    UnderWay(Box<Halting>),
    /// Standstill was proved at this time, after a pressed STOP.
    Proved { at: Instant },
}

impl Stop {
    pub(super) fn is_under_way(&self) -> bool {
        matches!(self, Self::UnderWay(_))
    }

    /// Returns `true` while a STOP that the operator pressed is not proved.
    pub(super) fn is_pressed(&self) -> bool {
        self.halting().is_some_and(|halting| halting.pressed)
    }

    /// Extent with which to send the current halt again.
    pub(super) fn extent(&self) -> Option<Extent> {
        self.halting().map(Halting::extent_again)
    }

    fn halting(&self) -> Option<&Halting> {
        match self {
            Self::UnderWay(halting) => Some(halting),
            Self::Ready | Self::Proved { .. } => None,
        }
    }

    pub(super) fn shown(&self, now: Instant) -> StopState {
        match self {
            Self::UnderWay(halting) if halting.told => {
                StopState::NotConfirmed { since: halting.since }
            }
            Self::UnderWay(halting) if halting.pressed => {
                StopState::Stopping { since: halting.since }
            }
            &Self::Proved { at } if now.saturating_duration_since(at) < SHOWN => {
                StopState::Stopped { at }
            }
            _ => StopState::Ready,
        }
    }

    /// A motion begins: the earlier proof no longer counts.
    pub(super) fn forget(&mut self) {
        if let Self::Proved { .. } = self {
            *self = Self::Ready;
        }
    }
}

impl Session {
    /// The operator wants everything to stand still. Never refused.
    pub(super) fn halt(&mut self, now: Moment) {
        self.activity = Activity::Standby;
        self.gate.device().disarm();
        self.begin_halt(true, now);
    }

    /// Stops the motion without leaving the mode, as at the end of a jog.
    pub(super) fn halt_quietly(&mut self, now: Moment) {
        self.begin_halt(false, now);
    }

    fn begin_halt(&mut self, pressed: bool, now: Moment) {
        if !self.stop.is_under_way() {
            self.begin_overrun(now);
        }
        if pressed {
            self.key.spend();
        }
        self.key.end();
        self.stepping = None;
        self.doubt = None;
        self.judging.drop_waiting();
        self.void_shift();
        self.gate.halted();
        self.activity.halt();
        if pressed {
            self.end_auto_track();
        }
        self.queue_halt(if pressed { Extent::Everything } else { Extent::Motion }, now);
        self.owed.debts().owe_stop();
        let again_at = now.steady + self.gate.device().halt_patience();
        match &mut self.stop {
            // Pressing again does not delay the report that standstill is not proved.
            Stop::UnderWay(halting) => {
                halting.again_at = again_at;
                halting.pressed |= pressed;
            }
            stop => {
                *stop = Stop::UnderWay(Box::new(Halting {
                    since: now.steady,
                    looks: Looks::default(),
                    sent_at: now.steady,
                    again_at,
                    pressed,
                    told: false,
                }));
            }
        }
        // Its bytes go out first, if there is a link.
        if !self.contact.is_open() {
            self.record_debt(now);
        }
    }

    /// The bytes of a halt are the next to be written.
    pub(super) fn queue_halt(&mut self, extent: Extent, now: Moment) {
        self.stop_bytes = self.gate.device().halt(extent, now);
        if extent == Extent::Everything {
            self.owed.auto_track_asked(Some(now.steady));
        }
    }

    /// Checks whether the antenna stands, and repeats the halt while it does not.
    pub(super) fn watch_halt(&mut self, now: Moment) {
        if self.stop_bytes.is_empty() || !self.contact.is_open() {
            self.record_debt(now);
        }
        let figures = self.figures();
        let is_at_rest = self.is_at_rest();
        let Stop::UnderWay(halting) = &mut self.stop else { return };
        let state = self.gate.state();
        // A halt that the operator did not press leaves other things that the unit turns
        // alone.
        let is_at_rest = is_at_rest && !(halting.pressed && state.turns_besides);
        let look = state.measured.filter(|measured| measured.asked >= halting.sent_at);
        let proof =
            look.and_then(|look| halting.looks.take(look, is_at_rest, state.link_since, figures));
        if let Some(proof) = proof {
            return self.end_halt(proof, now);
        }
        let waited = now.steady.saturating_duration_since(halting.since);
        let unproved = waited >= halting.told_after(figures);
        let newly_unproved = unproved && !std::mem::replace(&mut halting.told, unproved);
        let again = now.steady >= halting.again_at && halting.looks.want_stop();
        let looks_again = halting.looks.is_due(figures, now.steady);
        // Without a link, the halt is the first thing sent on the next one.
        if again && self.contact.is_open() {
            halting.again_at = now.steady + self.gate.device().halt_patience();
            let extent = halting.extent_again();
            self.queue_halt(extent, now);
        }
        if looks_again {
            self.gate.device().ask_position(now);
        }
        if newly_unproved {
            self.tell(Event::StopNotConfirmed);
        }
    }

    fn end_halt(&mut self, proof: Proof, now: Moment) {
        let is_pressed = self.stop.halting().is_some_and(|halting| halting.pressed);
        self.stop = if is_pressed { Stop::Proved { at: now.steady } } else { Stop::Ready };
        self.owed.settle_stop();
        self.prove_still();
        self.gate.motions_over(now);
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

    /// The operator has seen that it stands.
    pub(super) fn take_word_for_standstill(&mut self) {
        tracing::warn!(antenna = self.setup.name(), "standstill by the operator's word");
        if self.stop.is_under_way() {
            self.stop = Stop::Ready;
        }
        self.contact.silence.forget();
        self.stop_bytes.clear();
        self.owed.settle_stop();
        self.prove_still();
    }

    /// Returns `true` if the unit's flags say that both axes are at rest.
    fn is_at_rest(&self) -> bool {
        let state = self.gate.state();
        state.measured.is_some_and(|measured| !measured.moving())
            && state.program.is_none_or(|program| !program.enabled)
    }

    /// Reports an antenna that turns although its unit says that it stands.
    pub(super) fn watch_rest(&mut self, _: Moment) {
        let is_at_rest =
            self.is_at_rest() && self.stop.halting().is_none_or(|halting| halting.told);
        let Some(look) = self.gate.state().measured else { return };
        if self.seen.looked == Some(look.received) {
            return;
        }
        self.seen.looked = Some(look.received);
        let (began, figures) = (self.gate.unproved_since(), self.alarm_figures());
        let turned = self.seen.rest.take(look, is_at_rest, began, figures);
        if let Some((axis, turned_deg)) = turned {
            let axis = self.setup.axis_name(axis);
            self.tell(Event::Safety(Safety::FlagsContradict { axis, turned_deg }));
        }
    }

    /// When the halt must be looked at again.
    pub(super) fn halt_due(&self) -> Option<Instant> {
        if let Some(halting) = self.stop.halting() {
            let told_at = halting.since + halting.told_after(self.figures());
            let proof = (!halting.told).then_some(told_at);
            let (looks, is_open) = (&halting.looks, self.contact.is_open());
            let look = looks.next(self.figures()).filter(|_| looks.awaits_look() && is_open);
            let again = (looks.want_stop() && is_open).then_some(halting.again_at);
            return proof.into_iter().chain(look).chain(again).min();
        }
        match self.stop {
            Stop::Proved { at } => Some(at + SHOWN),
            _ => None,
        }
    }

    /// The outline of the STOP button fades after a while.
    pub(super) fn forget_old_stop(&mut self, now: Moment) {
        if matches!(self.stop, Stop::Proved { at } if now.steady.saturating_duration_since(at) >= SHOWN)
        {
            self.stop = Stop::Ready;
        }
    }
}
