//! A halt from the first byte to proved standstill.

use std::time::{Duration, Instant};

use super::{Event, Intent, Session};
use crate::{
    controller::{Extent, Moment},
    driver::StopState,
};

/// A stop that is not proved after this long is told as such.
const PROOF: Duration = Duration::from_secs(3);
/// For how long the button shows that all is stopped.
const SHOWN: Duration = Duration::from_secs(10);

/// A halt under way.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Halting {
    since: Instant,
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
        self.jog = None;
        self.stepping = None;
        self.waiting = None;
        self.pending = None;
        self.aim = None;
        self.target = None;
        self.following = None;
        self.doubt = None;
        self.stopped_at = None;
        let extent = if pressed { Extent::Everything } else { Extent::Motion };
        self.urgent = self.gate.device().halt(extent, now);
        // Pressing again does not put off the word that standstill is not proved.
        let running = self.halting.take();
        self.halting = Some(Halting {
            since: running.as_ref().map_or(now.steady, |halting| halting.since),
            sent_at: now.steady,
            again_at: now.steady + self.gate.device().halt_patience(),
            pressed: pressed || running.as_ref().is_some_and(|halting| halting.pressed),
            told: running.is_some_and(|halting| halting.told),
        });
    }

    /// Looks whether the antenna stands, and keeps at it while it does not.
    pub(super) fn watch_halt(&mut self, now: Moment) {
        let Some(halting) = &mut self.halting else { return };
        let state = self.gate.state();
        let stands = state
            .measured
            .is_some_and(|measured| measured.asked > halting.sent_at && !measured.moving())
            && state.program.is_none_or(|program| !program.enabled);
        if stands {
            let pressed = halting.pressed;
            self.halting = None;
            self.prove_still();
            if pressed {
                self.stopped_at = Some(now.steady);
                self.tell(Event::Stopped);
                if self.gate.state().program.is_some_and(|program| program.auto == Some(true)) {
                    self.tell(Event::AutoTrackStillOn);
                }
            }
            return;
        }
        let unproved = now.steady.saturating_duration_since(halting.since) >= PROOF;
        let newly_unproved = unproved && !std::mem::replace(&mut halting.told, unproved);
        let again = now.steady >= halting.again_at;
        // Without a link the first thing sent on the next one is the halt.
        if again && self.link.is_open() {
            halting.sent_at = now.steady;
            halting.again_at = now.steady + self.gate.device().halt_patience();
            self.urgent = self.gate.device().halt(Extent::Everything, now);
        }
        if newly_unproved {
            self.tell(Event::StopNotConfirmed);
        }
    }

    /// When a halt has to be looked at again.
    pub(super) fn halt_due(&self) -> Option<Instant> {
        if let Some(halting) = &self.halting {
            let proof = (!halting.told).then_some(halting.since + PROOF);
            let again = self.link.is_open().then_some(halting.again_at);
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
