//! A halt, from its first byte to proved standstill.

use std::time::Duration;

use super::{
    guard::Guard,
    standstill::{Figures, Looks, Proof},
};
use crate::{
    clock::Instant,
    contract::driver::StopState,
    device::{AntennaState, Extent},
    driver::before_sleep::Awake,
};

/// A halt that is not proved by then is reported.
const PROOF: Duration = Duration::from_secs(3);
/// Additional time where the proof itself takes long.
const BEYOND_PROOF: Duration = Duration::from_secs(1);
/// How long the STOP button shows that everything has stopped.
const SHOWN: Duration = Duration::from_secs(10);

#[derive(Debug, Clone, PartialEq)]
struct Halting {
    begun: Instant,
    /// The positions asked for since it was sent.
    looks: Looks,
    sent_at: Instant,
    /// When to send it again; a repeated STOP is harmless.
    again_at: Instant,
    /// The operator pressed STOP; otherwise it ends a motion.
    pressed: bool,
    /// Azel has reported that standstill is not proved.
    is_reported: bool,
}

impl Halting {
    fn extent_again(&self) -> Extent {
        // A halt that has to be repeated no longer trusts the known state: a track may be on that
        // was read as off.
        if self.pressed { Extent::Everything } else { Extent::Track }
    }

    /// Time from STOP until Azel reports that standstill is not proved. While all positions agree,
    /// only late replies delay the proof.
    fn reported_after(&self, figures: Figures) -> Duration {
        let default = PROOF.max(figures.gap() + BEYOND_PROOF);
        if self.looks.want_stop() { default } else { default + BEYOND_PROOF }
    }
}

#[derive(Debug, Clone, PartialEq, Default)]
enum Stage {
    /// No halt is under way.
    #[default]
    Ready,
    /// Sent, and standstill is not proved.
    UnderWay(Box<Halting>),
    /// Standstill was proved at this time, after a pressed STOP.
    Proved { at: Instant },
}

/// What a look at a halt calls for.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct HaltLook {
    /// The halt is over.
    pub(super) proof: Option<Proof>,
    /// The halt must be sent again.
    pub(super) send_again: Option<Extent>,
    /// Another position must be requested.
    pub(super) asks_position: bool,
    /// The operator must know that standstill is not proved.
    pub(super) is_overdue: bool,
}

/// STOP of an antenna, pressed or at the end of a motion.
pub(super) struct Stop {
    stage: Stage,
    /// Bytes of a halt, to be written before anything else.
    bytes: Vec<u8>,
    /// Delays the computer's sleep while a halt is under way.
    awake: Option<Awake>,
    pub(super) guard: Guard,
}

impl Stop {
    pub(super) fn new(guard: Guard) -> Self {
        Self { stage: Stage::Ready, bytes: Vec::new(), awake: None, guard }
    }

    pub(super) fn is_under_way(&self) -> bool {
        matches!(self.stage, Stage::UnderWay(_))
    }

    /// Returns `true` while a STOP that the operator pressed is not proved.
    pub(super) fn is_pressed(&self) -> bool {
        self.halting().is_some_and(|halting| halting.pressed)
    }

    /// Returns `true` unless a halt is under way that is not overdue yet: until then the axes may
    /// run out.
    pub(super) fn has_run_out(&self) -> bool {
        self.halting().is_none_or(|halting| halting.is_reported)
    }

    /// Extent with which to send the current halt again.
    pub(super) fn extent(&self) -> Option<Extent> {
        self.halting().map(Halting::extent_again)
    }

    fn halting(&self) -> Option<&Halting> {
        match &self.stage {
            Stage::UnderWay(halting) => Some(halting),
            Stage::Ready | Stage::Proved { .. } => None,
        }
    }

    pub(super) fn shown(&self, now: Instant) -> StopState {
        match &self.stage {
            Stage::UnderWay(halting) if halting.is_reported => {
                StopState::NotConfirmed { start: halting.begun }
            }
            Stage::UnderWay(halting) if halting.pressed => {
                StopState::Stopping { start: halting.begun }
            }
            &Stage::Proved { at } if now.saturating_duration_since(at) < SHOWN => {
                StopState::Stopped { time: at }
            }
            Stage::UnderWay(_) | Stage::Proved { .. } | Stage::Ready => StopState::Ready,
        }
    }

    /// Begins a halt, or joins the one that is under way. `patience`: time after which the halt is
    /// sent again.
    pub(super) fn begin(&mut self, pressed: bool, patience: Duration, now: Instant) {
        let again_at = now + patience;
        match &mut self.stage {
            // Pressing again does not delay the report that standstill is not proved.
            Stage::UnderWay(halting) => {
                halting.again_at = again_at;
                halting.pressed |= pressed;
            }
            stage @ (Stage::Ready | Stage::Proved { .. }) => {
                *stage = Stage::UnderWay(Box::new(Halting {
                    begun: now,
                    looks: Looks::default(),
                    sent_at: now,
                    again_at,
                    pressed,
                    is_reported: false,
                }));
            }
        }
    }

    /// Looks at the last state of the unit for a proof of standstill. `is_at_rest`: the unit's
    /// flags for its axes and program.
    pub(super) fn look(
        &mut self,
        state: &AntennaState,
        is_at_rest: bool,
        is_open: bool,
        figures: Figures,
        patience: Duration,
        now: Instant,
    ) -> HaltLook {
        let Stage::UnderWay(halting) = &mut self.stage else { return HaltLook::default() };
        // A halt that the operator did not press leaves other things that the unit turns
        // alone.
        let is_at_rest = is_at_rest && !(halting.pressed && state.turns_besides);
        // A position from before the STOP proves nothing.
        let look = state.measured.filter(|measured| measured.requested >= halting.sent_at);
        let proof =
            look.and_then(|look| halting.looks.take(look, is_at_rest, state.link_since, figures));
        if proof.is_some() {
            return HaltLook { proof, ..HaltLook::default() };
        }
        let waited = now.saturating_duration_since(halting.begun);
        let is_late = waited >= halting.reported_after(figures);
        let is_overdue = is_late && !std::mem::replace(&mut halting.is_reported, true);
        let is_due = now >= halting.again_at && halting.looks.want_stop();
        let asks_position = halting.looks.is_due(figures, now);
        // Without a link, the halt is the first thing sent on the next one.
        let sends_again = is_due && is_open;
        if sends_again {
            halting.again_at = now + patience;
        }
        let send_again = sends_again.then(|| halting.extent_again());
        HaltLook { proof: None, send_again, asks_position, is_overdue }
    }

    /// Standstill is proved. Returns `true` if the operator had pressed STOP.
    pub(super) fn end(&mut self, now: Instant) -> bool {
        let is_pressed = self.is_pressed();
        self.stage = if is_pressed { Stage::Proved { at: now } } else { Stage::Ready };
        is_pressed
    }

    /// The operator has seen that the antenna stands: nothing is left to be sent or proved.
    pub(super) fn end_unproved(&mut self) {
        if self.is_under_way() {
            self.stage = Stage::Ready;
        }
        self.bytes.clear();
    }

    /// A motion begins: the earlier proof no longer counts.
    pub(super) fn forget(&mut self) {
        if let Stage::Proved { .. } = self.stage {
            self.stage = Stage::Ready;
        }
    }

    /// The outline of the STOP button fades after a while.
    pub(super) fn forget_old(&mut self, now: Instant) {
        if let Stage::Proved { at } = self.stage
            && now.saturating_duration_since(at) >= SHOWN
        {
            self.stage = Stage::Ready;
        }
    }

    /// When the halt must be looked at again.
    pub(super) fn due(&self, figures: Figures, is_open: bool) -> Option<Instant> {
        match &self.stage {
            Stage::UnderWay(halting) => {
                let reported_at = halting.begun + halting.reported_after(figures);
                let report = (!halting.is_reported).then_some(reported_at);
                let looks = &halting.looks;
                let look = looks.next(figures).filter(|_| looks.awaits_look() && is_open);
                let again = (looks.want_stop() && is_open).then_some(halting.again_at);
                report.into_iter().chain(look).chain(again).min()
            }
            &Stage::Proved { at } => Some(at + SHOWN),
            Stage::Ready => None,
        }
    }

    /// These bytes are the next to be written. They take the place of older ones: one halt is enough.
    pub(super) fn queue(&mut self, bytes: Vec<u8>) {
        self.bytes = bytes;
    }

    pub(super) fn has_bytes(&self) -> bool {
        !self.bytes.is_empty()
    }

    pub(super) fn take_bytes(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }

    /// Delays the computer's sleep.
    pub(super) fn keep_awake(&mut self, awake: Awake) {
        self.awake = Some(awake);
    }

    /// Lets the computer sleep once no halt is under way.
    pub(super) fn let_sleep(&mut self) {
        if !self.is_under_way() {
            self.awake = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::satrak;

    const PATIENCE: Duration = Duration::from_millis(300);

    fn look(stop: &mut Stop, is_open: bool, now: Instant) -> HaltLook {
        let figures = Figures::new(satrak::VARIANT.capabilities, 0.1);
        stop.look(&AntennaState::default(), false, is_open, figures, PATIENCE, now)
    }

    #[test]
    fn a_halt_without_a_reply_is_sent_again_and_reported_once() {
        let start = Instant::now();
        let mut stop = Stop::new(Guard::new(None));
        assert_eq!(look(&mut stop, true, start), HaltLook::default(), "no halt is under way");
        stop.begin(true, PATIENCE, start);
        let looks: Vec<HaltLook> =
            (0..60).map(|step| look(&mut stop, true, start + PATIENCE / 3 * step)).collect();
        let sent = looks.iter().filter(|look| look.send_again == Some(Extent::Everything));
        assert_eq!(sent.count(), 19);
        assert_eq!(looks.iter().filter(|look| look.is_overdue).count(), 1);
        assert!(stop.is_under_way() && looks.iter().all(|look| look.proof.is_none()));
    }

    #[test]
    fn without_a_link_a_halt_stays_owed_and_nothing_is_sent() {
        let start = Instant::now();
        let mut stop = Stop::new(Guard::new(None));
        stop.begin(false, PATIENCE, start);
        let later = start + Duration::from_mins(1);
        assert_eq!(look(&mut stop, false, later).send_again, None);
        assert_eq!(stop.extent(), Some(Extent::Track));
        stop.begin(true, PATIENCE, later);
        assert_eq!(stop.extent(), Some(Extent::Everything), "it was pressed since");
    }
}
