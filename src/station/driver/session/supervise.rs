//! Supervision of the intent: the unit's answers, its actual behaviour, and the end of the intent.

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

/// Max time until an accepted track command must show in the unit's state.
const TRACK_EFFECT: Duration = Duration::from_secs(15);
/// Min turn that proves a motion of an axis, degrees.
const TURNED_DEG: f64 = 0.05;

/// One check of [`Session::supervise`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Check {
    #[cfg(test)]
    name: &'static str,
    look: fn(&mut Session, Moment),
}

/// Builds a list of checks, each with the name of its function.
macro_rules! checks {
    ($($check:ident,)*) => {
        &[$(Check {
            #[cfg(test)]
            name: stringify!($check),
            look: |session, now| session.$check(now),
        },)*]
    };
}

/// All checks in order: reports of the unit, ending motions, debts, beginning motions. A check may
/// rely on the checks above it; every check is necessary (`supervise/tests.rs`).
pub(super) const CHECKS: &[Check] = checks![
    watch_judging,
    take_events,
    // After an outage, compare the unit before any activity continues.
    report_found,
    watch_likeness,
    watch_program,
    watch_hands,
    resolve_doubt,
    // These checks end motions.
    watch_jog,
    watch_effect,
    watch_step,
    watch_halt,
    let_sleep,
    watch_rest,
    watch_place,
    // The gate and the monitor use the direction of the axes on the sky.
    watch_offsets,
    watch_bounds,
    watch_standstill,
    // These checks settle debts to the unit.
    watch_lock_out,
    watch_auto_track,
    watch_unit_offsets,
    forget_old_stop,
    // Begin motions only after every check that may forbid them.
    start_queued,
    watch_slew,
    watch_tracking,
    watch_on_board,
    watch_pointing,
    watch_silence,
];

impl Session {
    /// Runs every check once; the session calls this after every byte, command and timer.
    pub(super) fn supervise(&mut self, now: Moment) {
        for check in self.checks {
            (check.look)(self, now);
        }
    }

    /// Takes the controller's findings from the answers of the unit.
    fn take_events(&mut self, now: Moment) {
        while let Some(event) = self.gate.device().next_event() {
            self.take(event, now);
        }
    }

    /// Continues the current track.
    fn watch_tracking(&mut self, now: Moment) {
        match self.commanded.activity {
            Activity::ProgramTrack(_) => self.watch_follow(now),
            Activity::OnBoardTrack(_) => self.watch_track(now),
            Activity::Standby | Activity::Manual | Activity::Hold(_) | Activity::GoTo(_) => {}
        }
    }

    /// Returns the latest time for the next call of [`Self::supervise`].
    pub(super) fn supervise_due(&self) -> Option<Instant> {
        let jog = self.commanded.key.pressed().map(Jog::end);
        // The session judges a motion to a position at every new state, so it needs no deadline.
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
                // A target that was given up since then needs no report.
                if self.commanded.activity.on_board().is_some_and(|track| track.target == target) {
                    self.give_up(Event::CannotTrack(target, reason), now);
                }
            }
            ControllerEvent::Accepted(request) => {
                self.gate.note_acceptance(now);
                if let MotionRequest::Motion(Motion::Position { .. }) = request {
                    self.note_position();
                }
            }
            ControllerEvent::Refused(request, code) => {
                self.gate.note_refusal();
                self.forget(request, Event::Refused(request, code), now);
            }
            ControllerEvent::Unanswered(request) => {
                self.gate.note_refusal();
                let before_deg = self.gate.started_from_deg();
                self.commanded.doubt(request, before_deg, now.steady);
            }
            ControllerEvent::HaltRefused(code) => self.tell(Event::StopRefused(code)),
            ControllerEvent::AutoStaysOn => {
                if self.owed.auto_stays_on() {
                    self.tell(Event::AutoStaysOn);
                }
            }
        }
    }

    /// Starts the unit's program after the unit has received the target.
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

    /// Ends the activity of a failed motion or action.
    fn forget(&mut self, request: MotionRequest, event: Event, now: Moment) {
        let motion = match request {
            MotionRequest::Motion(motion) => motion,
            MotionRequest::Action(_) => return self.tell(event),
        };
        match motion {
            // The operator has already left the jog's mode, but its halt ends the new mode as well.
            Motion::Jog { .. } if self.commanded.activity.intent() == Intent::Track => {
                self.give_up(event, now);
            }
            Motion::Jog { .. } => {
                // The held key must not send the jog again.
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

    /// Resolves a command without an answer by a later state, because the unit may have received
    /// the command.
    fn resolve_doubt(&mut self, now: Moment) {
        let doubt = self.commanded.take_doubt(self.gate.state().measured);
        let Some(Doubt { request, before_deg, .. }) = doubt else { return };
        // A short motion may have ended before its answer was overdue.
        let turned = before_deg.zip(self.gate.axes_deg()).map_or([false; 2], |(before, after)| {
            let [first, second] = before;
            let [first_now, second_now] = after;
            [first_now - first, second_now - second].map(|deg| deg.abs() > TURNED_DEG)
        });
        if self.is_active() || turned.contains(&true) {
            // A controller that sends an order for each axis may have sent only the first order.
            let mut is_open = turned.map(|turned| !turned);
            let axes = self.gate.state().measured.into_iter().flat_map(|measured| measured.axes);
            for (is_open, axis) in is_open.iter_mut().zip(axes) {
                *is_open &= axis.motion == AxisMotion::Still;
            }
            self.replan(is_open);
        } else if !self.may_send_another() {
            self.forget(request, Event::Unanswered(request), now);
        }
    }

    /// Reports the state of the unit at the first reading of a new link.
    fn report_found(&mut self, now: Moment) {
        let state = self.gate.state();
        let tracks = match state.program {
            Some(program) => program.enabled,
            // Read the program first, because the unit may be tracking.
            None if self.setup.can().has_program => return,
            None => false,
        };
        if !self.contact.is_unread() || state.measured_on_link().is_none() {
            return;
        }
        let outage = self.contact.note_reading(tracks);
        let found = if tracks {
            Found::Tracking
        } else if self.is_turning() {
            Found::Moving
        } else {
            Found::Still
        };
        let absence =
            outage.away_since.map(|lost_at| now.steady.saturating_duration_since(lost_at));
        let lost = absence.unwrap_or_default() + outage.slept;
        let is_explained = self.explains(found, now);
        if absence.is_some() && self.commanded.activity.program().is_none() {
            self.contact.comparison.begin(Recheck { begun: now.steady, lost });
        }
        self.follow_on(lost, now);
        // Continue to watch a slew, whose outcome must still be reported.
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
                // A track that ended during the outage must not restart automatically.
                _ => self.commanded.activity = Activity::Standby,
            }
        }
        let event = match absence {
            None => Event::Connected(found),
            Some(after) => Event::Back { after, found, is_explained },
        };
        self.tell(event);
    }

    /// Returns `true` if Azel's commands explain the state and the position of the unit after an
    /// outage.
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

    /// Reports that the unit has started to track on its own, which may surprise a person beside
    /// it.
    fn watch_program(&mut self, _: Moment) {
        let Some(program) = self.gate.state().program.filter(|_| !self.contact.is_unread()) else {
            return;
        };
        let has_started = self.contact.program_has_started(program.enabled);
        if has_started && self.commanded.activity.intent() != Intent::Track {
            self.tell(Event::StartedByItself);
        }
    }

    /// Returns the rest of a path round a corner. Fails if the rest is blocked from beside the
    /// corner, because another path to the same corner would never end.
    fn next_leg(
        &self,
        motion: Motion,
        position: Pointing,
        tolerance: Angle,
        now: Moment,
    ) -> Result<Slew, Refusal> {
        let intent = self.commanded.activity.intent();
        let next = self.slew(motion, intent, now)?;
        if !next.leads_on(position, tolerance) {
            self.gate.check(motion, intent, now)?;
        }
        Ok(next)
    }

    /// Sends the next motion of a slew, or reports how it has ended.
    fn watch_slew(&mut self, now: Moment) {
        let (turns, within_deg) = (self.is_turning(), self.setup.can().arrives_within_deg);
        let turned = self.observed.effects.last_change();
        let Some(measured) = self.gate.state().measured else { return };
        let Some(position) = self.gate.pointing() else { return };
        let Some(slew) = self.commanded.activity.slew_mut() else { return };
        let tolerance = Angle::from_degrees(within_deg);
        if turns {
            return;
        }
        let arrival = slew.watch(position, measured.requested, turned, tolerance, now.steady);
        let Some(arrival) = arrival else { return };
        match arrival {
            Arrival::Leg(motion) => match self.next_leg(motion, position, tolerance, now) {
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
                let event = Event::EndedShort { aim, position };
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
            // The halt also disables a finished program that is still on and could restart.
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
