//! Supervises the intent: the unit's answers, whether it does what was requested, and when
//! that ends.

use std::time::Duration;

use super::{
    Session,
    activity::{Activity, Arrival, GoTo, OnBoardStage, OnBoardTrack, Slew, SlewStage},
    commanded::Doubt,
    jog_key::Jog,
    likeness::Recheck,
};
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    contract::driver::{Event, Found, Intent, Refusal},
    device::{AxisMotion, ControllerEvent, Motion, MotionRequest, Phase, Pointing, TrackTarget},
};

/// Time within which an accepted command to track must show in the unit's state.
const TRACK_EFFECT: Duration = Duration::from_secs(15);
/// An axis that has turned by less may not have been moved at all, degrees.
const TURNED_DEG: f64 = 0.05;

/// One check of [`Session::supervise`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Check {
    #[cfg(test)]
    name: &'static str,
    look: fn(&mut Session, Moment),
}

/// A list of checks, each named after its function.
macro_rules! checks {
    ($($check:ident,)*) => {
        &[$(Check {
            #[cfg(test)]
            name: stringify!($check),
            look: |session, now| session.$check(now),
        },)*]
    };
}

/// All checks, in their order: first reports of the unit, then motions that have to end, then
/// debts, then motions that begin. A check may rely on those above it; none may be left out
/// (`supervise/tests.rs`).
pub(super) const CHECKS: &[Check] = checks![
    watch_judging,
    take_events,
    // A unit that is found after an outage is compared before anything goes on.
    report_found,
    watch_likeness,
    watch_program,
    watch_hands,
    resolve_doubt,
    // Motions that have to end.
    watch_jog,
    watch_effect,
    watch_step,
    watch_halt,
    let_sleep,
    watch_rest,
    watch_place,
    // The gate and the monitor judge by where the axes point on the sky.
    watch_offsets,
    watch_bounds,
    watch_standstill,
    // Debts to the unit.
    watch_lock_out,
    watch_auto_track,
    watch_unit_offsets,
    forget_old_stop,
    // Motions that begin, after everything that may forbid them.
    start_queued,
    watch_slew,
    watch_tracking,
    watch_on_board,
    watch_pointing,
    watch_silence,
];

impl Session {
    /// Carries out every check once; called after every byte, command and timer.
    pub(super) fn supervise(&mut self, now: Moment) {
        for check in self.checks {
            (check.look)(self, now);
        }
    }

    /// Takes what the controller has found in the answers of the unit.
    fn take_events(&mut self, now: Moment) {
        while let Some(event) = self.gate.device().next_event() {
            self.take(event, now);
        }
    }

    /// Keeps a track going.
    fn watch_tracking(&mut self, now: Moment) {
        match self.commanded.activity {
            Activity::ProgramTrack(_) => self.watch_follow(now),
            Activity::OnBoardTrack(_) => self.watch_track(now),
            Activity::Standby | Activity::Manual | Activity::Hold(_) | Activity::GoTo(_) => {}
        }
    }

    /// The latest time for the next call of [`Self::supervise`].
    pub(super) fn supervise_due(&self) -> Option<Instant> {
        let jog = self.commanded.key.pressed().map(Jog::end);
        // A motion to a position is judged whenever a state comes in.
        let effect = match self.commanded.activity.on_board().map(|track| track.stage) {
            Some(OnBoardStage::Loading { begun } | OnBoardStage::Starting { begun })
                if !self.stop.is_under_way() =>
            {
                Some(begun + TRACK_EFFECT)
            }
            _ => None,
        };
        let look = self.follow_due();
        jog.into_iter()
            .chain(effect)
            .chain(look)
            .chain(self.halt_due())
            .chain(self.stop.guard.due())
            .min()
    }

    fn take(&mut self, event: ControllerEvent, now: Moment) {
        match event {
            ControllerEvent::Prepared(target) => self.loaded(&target, now),
            ControllerEvent::NotPrepared(target, reason) => {
                // A target given up since then needs no report.
                if self.commanded.activity.on_board().is_some_and(|track| track.target == target) {
                    self.give_up(Event::CannotTrack(target, reason), now);
                }
            }
            ControllerEvent::Accepted(asked) => {
                self.gate.motion_accepted(now);
                if let MotionRequest::Motion(Motion::Position { .. }) = asked {
                    self.position_taken();
                }
            }
            ControllerEvent::Refused(asked, code) => {
                self.gate.motion_not_accepted();
                self.forget(asked, Event::Refused(asked, code), now);
            }
            ControllerEvent::Unanswered(asked) => {
                self.gate.motion_not_accepted();
                let before_deg = self.gate.started_from_deg();
                self.commanded.doubt(asked, before_deg, now.steady);
            }
            ControllerEvent::HaltRefused(code) => self.tell(Event::StopRefused(code)),
            ControllerEvent::AutoStaysOn => {
                if self.owed.auto_stays_on() {
                    self.tell(Event::AutoStaysOn);
                }
            }
        }
    }

    /// The unit holds the target: starts its program on it.
    fn loaded(&mut self, target: &TrackTarget, now: Moment) {
        let awaits_it = |track: &OnBoardTrack| {
            track.target == *target && matches!(track.stage, OnBoardStage::Loading { .. })
        };
        if !self.commanded.activity.on_board().is_some_and(awaits_it) {
            return;
        }
        if let Some(objection) = self.objection_to_pass() {
            return self.give_up(objection, now);
        }
        if let Some(track) = self.commanded.activity.on_board_mut() {
            track.stage = OnBoardStage::StartQueued;
        }
    }

    /// Ends the activity of a motion or action that does not come about.
    fn forget(&mut self, asked: MotionRequest, event: Event, now: Moment) {
        let motion = match asked {
            MotionRequest::Motion(motion) => motion,
            MotionRequest::Action(_) => return self.tell(event),
        };
        match motion {
            // The jog belongs to a mode that has been left, but its halt ends the new one as
            // well.
            Motion::Jog { .. } if self.commanded.activity.intent() == Intent::Track => {
                self.give_up(event, now);
            }
            Motion::Jog { .. } => {
                // The key that is still down must not send it again.
                self.commanded.key.spend();
                self.halt_quietly(now);
                self.tell(event);
            }
            Motion::Step { .. } => {
                self.commanded.end_step();
                self.tell(event);
            }
            Motion::EnableAuto => self.tell(event),
            Motion::Position { .. } | Motion::StartProgram => self.give_up(event, now),
        }
    }

    /// A command without an answer may have reached the unit all the same: a state asked for
    /// afterwards decides.
    fn resolve_doubt(&mut self, now: Moment) {
        let doubt = self.commanded.take_doubt(self.gate.state().measured);
        let Some(Doubt { asked, before_deg, .. }) = doubt else { return };
        // A short motion may be over before it was in doubt.
        let turned = before_deg.zip(self.gate.axes_deg()).map_or([false; 2], |(before, after)| {
            let [first, second] = before;
            let [first_now, second_now] = after;
            [first_now - first, second_now - second].map(|deg| deg.abs() > TURNED_DEG)
        });
        if self.active() || turned.contains(&true) {
            // A controller that sends an order for each axis may have sent only the first.
            let mut is_open = turned.map(|turned| !turned);
            let axes = self.gate.state().measured.into_iter().flat_map(|measured| measured.axes);
            for (is_open, axis) in is_open.iter_mut().zip(axes) {
                *is_open &= axis.motion == AxisMotion::Still;
            }
            self.plan_anew(is_open);
        } else if !self.may_send_another() {
            self.forget(asked, Event::Unanswered(asked), now);
        }
    }

    /// Reports what the unit was found doing when the link came up.
    fn report_found(&mut self, now: Moment) {
        let state = self.gate.state();
        let tracks = match state.program {
            Some(program) => program.enabled,
            // A unit that tracks is found tracking, so its program has to be read first.
            None if self.setup.can().has_program => return,
            None => false,
        };
        if !self.contact.is_unread() || state.measured_on_link().is_none() {
            return;
        }
        let outage = self.contact.read(tracks);
        let found = if tracks {
            Found::Tracking
        } else if self.turns() {
            Found::Moving
        } else {
            Found::Still
        };
        let away = outage.away_since.map(|lost_at| now.steady.saturating_duration_since(lost_at));
        let lost = away.unwrap_or_default() + outage.slept;
        let is_explained = self.explains(found, now);
        if away.is_some() && self.commanded.activity.program().is_none() {
            self.contact.comparison.begin(Recheck { begun: now.steady, lost });
        }
        self.follow_on(lost, now);
        // A slew is watched further; its outcome is still to be reported.
        if let Some(Slew { stage: SlewStage::UnderWay { begun, .. }, .. }) =
            self.commanded.activity.slew_mut()
        {
            *begun = now.steady;
        }
        if let Activity::OnBoardTrack(track) = &mut self.commanded.activity {
            match track.stage {
                _ if found == Found::Tracking => track.stage = OnBoardStage::Tracking,
                OnBoardStage::Slewing(slew) => {
                    self.commanded.activity = Activity::GoTo(GoTo { parks: false, slew });
                }
                // A track that ended during the outage is not started again by itself.
                _ => self.commanded.activity = Activity::Standby,
            }
        }
        let event = match away {
            None => Event::Connected(found),
            Some(after) => Event::Back { after, found, is_explained },
        };
        self.tell(event);
    }

    /// Returns `true` if what was asked from here explains what the unit does and where it points after
    /// an outage.
    fn explains(&self, found: Found, now: Moment) -> bool {
        let slew = self.commanded.activity.slew();
        let is_under_way =
            slew.is_some_and(|slew| matches!(slew.stage, SlewStage::UnderWay { .. }));
        match (found, &self.commanded.activity) {
            // Azel compares a program track separately.
            (_, Activity::ProgramTrack(_)) => true,
            // Azel starts the unit's program only after the slew.
            (Found::Tracking, activity) => {
                matches!(activity, Activity::OnBoardTrack(_)) && !is_under_way
            }
            (_, Activity::OnBoardTrack(track)) if matches!(track.stage, OnBoardStage::Tracking) => {
                found == Found::Still && now.utc >= track.target.end
            }
            // Until a STOP reaches the unit, its last command explains the motion.
            (Found::Moving, _) => {
                (is_under_way || self.stop.is_under_way()) && self.gate.explains_position()
            }
            (Found::Still, _) => self.gate.explains_position(),
        }
    }

    /// Reports that the unit has started to track on its own, which surprises anyone standing
    /// beside it.
    fn watch_program(&mut self, _: Moment) {
        let Some(program) = self.gate.state().program.filter(|_| !self.contact.is_unread()) else {
            return;
        };
        let has_started = self.contact.program_has_started(program.enabled);
        if has_started && self.commanded.activity.intent() != Intent::Track {
            self.tell(Event::StartedByItself);
        }
    }

    /// The rest of a way round a corner. From beside the corner the rest may be blocked: a way that
    /// leads to the same corner again would have no end.
    fn next_leg(
        &self,
        then: Motion,
        at: Pointing,
        within: Angle,
        now: Moment,
    ) -> Result<Slew, Refusal> {
        let intent = self.commanded.activity.intent();
        let next = self.slew(then, intent, now)?;
        if !next.leads_on(at, within) {
            self.gate.check(then, intent, now)?;
        }
        Ok(next)
    }

    /// Sends the next motion of a slew, or reports how it has ended.
    fn watch_slew(&mut self, now: Moment) {
        let (turns, within_deg) = (self.turns(), self.setup.can().arrives_within_deg);
        let turned = self.observed.effects.last_change();
        let Some(measured) = self.gate.state().measured else { return };
        let Some(at) = self.gate.pointing() else { return };
        let Some(slew) = self.commanded.activity.slew_mut() else { return };
        let within = Angle::from_degrees(within_deg);
        if turns {
            return;
        }
        let arrival = slew.watch(at, measured.requested, turned, within, now.steady);
        let Some(arrival) = arrival else { return };
        match arrival {
            Arrival::Leg(then) => match self.next_leg(then, at, within, now) {
                Ok(next) => {
                    if let Some(slew) = self.commanded.activity.slew_mut() {
                        *slew = next;
                    }
                }
                Err(refusal) => self.give_up(Event::NotSent(refusal), now),
            },
            Arrival::At(aim) => match self.commanded.activity.on_board_mut() {
                Some(track) => track.stage = OnBoardStage::LoadQueued,
                None => self.tell(Event::Arrived(aim)),
            },
            Arrival::Short { aim } => {
                let event = Event::EndedShort { aim, position: at };
                match self.commanded.activity.on_board() {
                    Some(_) => self.give_up(event, now),
                    None => self.tell(event),
                }
            }
        }
    }

    fn watch_track(&mut self, now: Moment) {
        let Some(program) = self.gate.state().program else { return };
        let read = self.gate.state().measured;
        let Some(track) = self.commanded.activity.on_board_mut() else { return };
        let completed = program.phase == Phase::Completed;
        let ended = !program.enabled || completed;
        match track.stage {
            // The halt also switches off a program that is over but still on, and could start
            // again.
            OnBoardStage::Tracking if ended => {
                self.give_up(Event::TrackingEnded { completed }, now);
            }
            OnBoardStage::Tracking
            | OnBoardStage::Slewing(_)
            | OnBoardStage::LoadQueued
            | OnBoardStage::StartQueued => {}
            OnBoardStage::Loading { .. } | OnBoardStage::Starting { .. }
                if self.stop.is_under_way() => {}
            OnBoardStage::Starting { begun }
                if !ended && read.is_some_and(|read| read.requested > begun) =>
            {
                track.stage = OnBoardStage::Tracking;
                let target = track.target.clone();
                self.tell(Event::Tracking(target));
            }
            OnBoardStage::Loading { begun } | OnBoardStage::Starting { begun } => {
                if now.steady.saturating_duration_since(begun) >= TRACK_EFFECT {
                    self.give_up(Event::TrackingEnded { completed: false }, now);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
