//! Halt, from its first byte to proved standstill.

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

/// Max time until the proof of a halt; Azel reports a later one.
const PROOF: Duration = Duration::from_secs(3);
/// Additional time for a proof that itself takes long.
const BEYOND_PROOF: Duration = Duration::from_secs(1);
/// Duration for which the STOP button shows that everything has stopped.
const SHOWN: Duration = Duration::from_secs(10);

#[derive(Debug, Clone, PartialEq)]
struct Halting {
    begun: Instant,
    /// Positions requested since the halt was sent.
    looks: Looks,
    sent_at: Instant,
    /// Time of the next repetition; a repeated STOP is harmless.
    again_at: Instant,
    /// `true` if the operator pressed STOP; `false` for the end of a motion.
    pressed: bool,
    /// `true` if Azel has reported that standstill is not proved.
    is_reported: bool,
}

impl Halting {
    fn repeat_extent(&self) -> Extent {
        // A repeated halt no longer trusts the known state: a track that read as off may be on.
        if self.pressed { Extent::Everything } else { Extent::Track }
    }

    /// Returns the time from STOP until Azel reports that standstill is not proved. While all
    /// positions agree, only late replies delay the proof.
    fn reported_after(&self, figures: Figures) -> Duration {
        let default = PROOF.max(figures.gap() + BEYOND_PROOF);
        if self.looks.want_stop() { default } else { default + BEYOND_PROOF }
    }
}

#[derive(Debug, Clone, PartialEq, Default)]
enum Stage {
    /// No current halt.
    #[default]
    Ready,
    /// Sent halt without proved standstill.
    UnderWay(Box<Halting>),
    /// Standstill proved at this time, after an operator's STOP.
    Proved { time: Instant },
}

/// Outcome of a check of a halt.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct HaltLook {
    /// Proof of standstill, which ends the halt.
    pub(super) proof: Option<Proof>,
    /// Extent of a required repetition of the halt.
    pub(super) send_again: Option<Extent>,
    /// `true` if the session must request another position.
    pub(super) asks_position: bool,
    /// `true` if the operator must learn that standstill is not proved.
    pub(super) is_overdue: bool,
}

/// STOP of an antenna, by the operator or at the end of a motion.
pub(super) struct Stop {
    stage: Stage,
    /// Bytes of a halt that the session writes before anything else.
    bytes: Vec<u8>,
    /// Token that delays the computer's sleep during a halt.
    awake: Option<Awake>,
    /// The session has not yet written the last pressed STOP.
    awaits_write: bool,
    /// Time of the first write of the last pressed STOP.
    written: Option<Instant>,
    pub(super) guard: Guard,
}

impl Stop {
    pub(super) fn new(guard: Guard) -> Self {
        Self {
            stage: Stage::Ready,
            bytes: Vec::new(),
            awake: None,
            awaits_write: false,
            written: None,
            guard,
        }
    }

    pub(super) fn is_under_way(&self) -> bool {
        matches!(self.stage, Stage::UnderWay(_))
    }

    /// Returns `true` until an operator's STOP is proved.
    pub(super) fn is_pressed(&self) -> bool {
        self.halting().is_some_and(|halting| halting.pressed)
    }

    /// Returns `true` unless a halt runs that is not overdue yet: until then, the axes may coast.
    pub(super) fn has_run_out(&self) -> bool {
        self.halting().is_none_or(|halting| halting.is_reported)
    }

    /// Returns the extent with which to repeat the current halt.
    pub(super) fn extent(&self) -> Option<Extent> {
        self.halting().map(Halting::repeat_extent)
    }

    fn halting(&self) -> Option<&Halting> {
        match &self.stage {
            Stage::UnderWay(halting) => Some(halting),
            Stage::Ready | Stage::Proved { .. } => None,
        }
    }

    pub(super) fn state(&self, now: Instant) -> StopState {
        match &self.stage {
            Stage::UnderWay(halting) if halting.is_reported => {
                StopState::NotConfirmed { start: halting.begun }
            }
            Stage::UnderWay(halting) if halting.pressed => {
                StopState::Stopping { start: halting.begun }
            }
            &Stage::Proved { time } if now.saturating_duration_since(time) < SHOWN => {
                StopState::Stopped { time }
            }
            Stage::UnderWay(_) | Stage::Proved { .. } | Stage::Ready => StopState::Ready,
        }
    }

    /// Begins a halt, or joins the current one. `patience`: time until the repetition.
    pub(super) fn begin(&mut self, pressed: bool, patience: Duration, now: Instant) {
        let again_at = now + patience;
        self.awaits_write |= pressed;
        match &mut self.stage {
            // A second press must not delay the report that standstill is not proved.
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

    /// Checks the last state of the unit for a proof of standstill. `is_at_rest`: the unit's flags
    /// report its axes and program at rest.
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
        // A halt that the operator did not press ignores other motions of the unit.
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
        // Without a link, the session sends the halt first on the next link.
        let sends_again = is_due && is_open;
        if sends_again {
            halting.again_at = now + patience;
        }
        let send_again = sends_again.then(|| halting.repeat_extent());
        HaltLook { proof: None, send_again, asks_position, is_overdue }
    }

    /// Ends the halt after proved standstill. Returns `true` if the operator had pressed STOP.
    pub(super) fn end(&mut self, now: Instant) -> bool {
        let is_pressed = self.is_pressed();
        self.stage = if is_pressed { Stage::Proved { time: now } } else { Stage::Ready };
        is_pressed
    }

    /// Ends the halt after the operator has confirmed standstill; drops all remaining output.
    pub(super) fn end_unproved(&mut self) {
        if self.is_under_way() {
            self.stage = Stage::Ready;
        }
        self.bytes.clear();
    }

    /// Forgets an earlier proof, because a motion begins.
    pub(super) fn forget(&mut self) {
        if let Stage::Proved { .. } = self.stage {
            self.stage = Stage::Ready;
        }
    }

    /// Removes the outline of the STOP button after a while.
    pub(super) fn forget_old(&mut self, now: Instant) {
        if let Stage::Proved { time } = self.stage
            && now.saturating_duration_since(time) >= SHOWN
        {
            self.stage = Stage::Ready;
        }
    }

    /// Returns the time of the next check of the halt.
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
            &Stage::Proved { time } => Some(time + SHOWN),
            Stage::Ready => None,
        }
    }

    /// Queues these bytes as the next to write. They replace older ones, because one halt is
    /// enough.
    pub(super) fn queue(&mut self, bytes: Vec<u8>) {
        self.bytes = bytes;
    }

    pub(super) fn has_bytes(&self) -> bool {
        !self.bytes.is_empty()
    }

    pub(super) fn take_bytes(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }

    /// Notes that the bytes of a halt are on the link.
    pub(super) fn note_written(&mut self, now: Instant) {
        if std::mem::take(&mut self.awaits_write) {
            self.written = Some(now);
        }
    }

    /// Returns the time of the first write of the last pressed STOP.
    pub(super) fn written(&self) -> Option<Instant> {
        self.written
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
