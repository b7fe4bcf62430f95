//! Watches over the intent: what the device answered, whether it does what was
//! wanted, and when it ends.

use std::time::{Duration, Instant};

use super::{Event, Session, command::Waiting};
use crate::{
    controller::{Asked, Happening, Moment, Motion, Phase},
    driver::{Found, Intent},
};

/// A command that the device took must show in its state within this.
const EFFECT: Duration = Duration::from_secs(5);
/// For tracking there are several steps to it.
const TRACK_EFFECT: Duration = Duration::from_secs(15);
/// An axis that has turned by less may not have been moved at all, degrees.
const TURNED_DEG: f64 = 0.05;

/// A motion or action whose answer was lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Doubt {
    asked: Asked,
    since: Instant,
    /// Angles of the two axes before it, degrees.
    before_deg: Option<[f64; 2]>,
}

impl Session {
    /// Looks at everything once. Called after every byte, command and timer.
    pub(super) fn supervise(&mut self, now: Moment) {
        while let Some(happening) = self.gate.device().next_happening() {
            self.take(happening, now);
        }
        self.greet(now);
        self.watch_likeness(now);
        self.watch_program();
        self.resolve_doubt(now);
        self.watch_jog(now);
        self.watch_step();
        self.watch_halt(now);
        self.let_sleep();
        self.watch_rest();
        self.watch_place(now);
        self.watch_bounds(now);
        self.watch_standstill();
        self.watch_lock_out(now);
        self.forget_old_stop(now);
        self.start_waiting(now);
        match self.intent {
            Intent::Position | Intent::Park => self.watch_position(now),
            Intent::Track if self.follows() => self.watch_follow(now),
            Intent::Track => self.watch_track(now),
            Intent::Standby | Intent::Manual => {}
        }
        self.watch_on_board(now);
        self.watch_silence(now);
    }

    /// When [`Self::supervise`] is to be called at the latest.
    pub(super) fn supervise_due(&self) -> Option<Instant> {
        let jog = self.jog.as_ref().map(|jog| jog.until);
        // A motion to a position is judged whenever a state comes in.
        let by_timer =
            self.intent == Intent::Track && self.waiting.is_none() && self.halting.is_none();
        let effect = self.pending.filter(|_| by_timer).map(|since| since + TRACK_EFFECT);
        let look = self.follow_due();
        jog.into_iter()
            .chain(effect)
            .chain(look)
            .chain(self.halt_due())
            .chain(self.beat_due())
            .min()
    }

    fn take(&mut self, happening: Happening, now: Moment) {
        match happening {
            Happening::Prepared(target) => {
                if self.intent == Intent::Track && self.target.as_ref() == Some(&target) {
                    if let Some(objection) = self.objection_to_pass() {
                        return self.give_up(objection, now);
                    }
                    self.pending = Some(now.steady);
                    self.waiting = Some(Waiting::Motion(Motion::StartProgram));
                }
            }
            Happening::NotPrepared(target, reason) => {
                // A target that was given up since then needs no word.
                if self.target.as_ref() == Some(&target) {
                    self.give_up(Event::CannotTrack(target, reason), now);
                }
            }
            Happening::Accepted(Asked::Motion(Motion::Position { .. })) => self.position_taken(),
            Happening::Accepted(_) => {}
            Happening::Refused(asked, code) => {
                self.forget(asked, Event::Refused(asked, code), now);
            }
            Happening::Unanswered(asked) => {
                let before_deg = self.gate.started_from_deg();
                self.doubt = Some(Doubt { asked, since: now.steady, before_deg });
            }
            Happening::HaltRefused(code) => self.tell(Event::StopRefused(code)),
            Happening::AutoStaysOn => self.tell(Event::AutoStaysOn),
        }
    }

    /// Ends what was wanted of a motion or action that does not come about.
    fn forget(&mut self, asked: Asked, event: Event, now: Moment) {
        let motion = match asked {
            Asked::Motion(motion) => motion,
            Asked::Action(_) => return self.tell(event),
        };
        match motion {
            Motion::Jog { .. } => {
                self.halt_quietly(now);
                self.tell(event);
            }
            Motion::Step { .. } => {
                self.stepping = None;
                self.tell(event);
            }
            Motion::EnableAuto => self.tell(event),
            Motion::Position { .. } | Motion::StartProgram => self.give_up(event, now),
        }
    }

    /// A command without an answer may have come through all the same: the
    /// state that was asked for afterwards decides.
    fn resolve_doubt(&mut self, now: Moment) {
        let Some(Doubt { asked, since, before_deg }) = self.doubt else { return };
        if self.gate.state().measured.is_none_or(|measured| measured.asked <= since) {
            return;
        }
        self.doubt = None;
        // A short one may be over before it was in doubt.
        let turned = before_deg.zip(self.gate.axes_deg()).is_some_and(|(before, after)| {
            before.iter().zip(after).any(|(before, after)| (after - before).abs() > TURNED_DEG)
        });
        if !self.active() && !turned && !self.may_send_another() {
            self.forget(asked, Event::Unanswered(asked), now);
        }
    }

    /// Says what the device was found doing when the link came up.
    fn greet(&mut self, now: Moment) {
        let state = self.gate.state();
        let Some(measured) = state.measured else { return };
        let tracks = match state.program {
            Some(program) => program.enabled,
            None if self.make.capabilities.has_program => return,
            None => false,
        };
        if !self.unread || state.link_since.is_none_or(|since| measured.asked < since) {
            return;
        }
        self.unread = false;
        self.program_was_on = tracks;
        let found = if tracks {
            Found::Tracking
        } else if self.turns() {
            Found::Moving
        } else {
            Found::Still
        };
        let away = self
            .away_since
            .map_or(Duration::ZERO, |since| now.steady.saturating_duration_since(since));
        let lost = away + std::mem::take(&mut self.slept);
        self.follow_on(lost, measured.pointing, now);
        let by_device = self.intent == Intent::Track && !self.follows();
        if by_device && found != Found::Tracking {
            self.intent = Intent::Standby;
            self.target = None;
        }
        // A motion to a position is watched on; its outcome is still to be told.
        self.pending = self
            .pending
            .filter(|_| matches!(self.intent, Intent::Position | Intent::Park))
            .map(|_| now.steady);
        let event = match self.away_since.take() {
            None => Event::Connected(found),
            Some(away_since) => {
                Event::Back { after: now.steady.saturating_duration_since(away_since), found }
            }
        };
        self.tell(event);
    }

    /// A device that starts to track by itself surprises whoever stands beside it.
    fn watch_program(&mut self) {
        let Some(program) = self.gate.state().program.filter(|_| !self.unread) else { return };
        let was_on = std::mem::replace(&mut self.program_was_on, program.enabled);
        if program.enabled && !was_on && self.intent != Intent::Track {
            self.tell(Event::StartedByItself);
        }
    }

    fn watch_position(&mut self, now: Moment) {
        if self.waiting.is_some() {
            return;
        }
        let aim = self.leg.map(|leg| leg.aim).or(self.aim);
        let (Some(aim), Some(measured)) = (aim, self.gate.state().measured) else { return };
        let within_deg = self.make.capabilities.arrives_within_deg;
        let off = measured.pointing.separation(aim);
        let near = off.is_some_and(|off| off.degrees() <= within_deg);
        let Some(since) = self.pending else { return };
        let turns = self.turns();
        if measured.asked <= since || turns {
            // Under way: the clock for the first effect starts anew.
            if turns {
                self.pending = Some(now.steady);
            }
            return;
        }
        if near && let Some(leg) = self.leg.take() {
            self.pending = Some(now.steady);
            self.waiting = Some(Waiting::Motion(leg.then));
        } else if near {
            self.pending = None;
            self.tell(Event::Arrived(aim));
        } else if now.steady.saturating_duration_since(since) >= EFFECT {
            self.pending = None;
            self.leg = None;
            self.tell(Event::EndedShort { aim, at: measured.pointing });
        }
    }

    fn watch_track(&mut self, now: Moment) {
        let Some(program) = self.gate.state().program else { return };
        let ended = !program.enabled || program.phase == Phase::Completed;
        let Some(since) = self.pending else {
            if ended {
                // The halt that goes with it switches off a program that is
                // over but still on, and could start again.
                let completed = program.phase == Phase::Completed;
                self.give_up(Event::TrackingEnded { completed }, now);
            }
            return;
        };
        if self.waiting.is_some() || self.halting.is_some() {
            return;
        }
        let read_since = self.gate.state().measured.is_some_and(|read| read.asked > since);
        if !ended && read_since {
            self.pending = None;
            if let Some(target) = self.target.clone() {
                self.tell(Event::Tracking(target));
            }
        } else if now.steady.saturating_duration_since(since) >= TRACK_EFFECT {
            self.give_up(Event::TrackingEnded { completed: false }, now);
        }
    }
}
