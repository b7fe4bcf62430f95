//! Program track: sends one position after another on the session's own clock. The track survives a
//! lost link, and ends with any other operator command.

use std::time::Duration;

use super::{
    Session,
    activity::{Activity, GoTo},
    likeness::Recheck,
    tracking::{TrackConfig, Tracking},
};
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Command, Event, Intent, Refusal, Safety, TrackProblem, Unlike},
    device::Motion,
    plan::{
        Bounds, ProgramTrack, Target, TrackPhase,
        program_track::{Next, PathOrder, Planner},
    },
    station::AfterPass,
};

/// Reason why a program track has not begun.
pub(super) enum NotFollowed {
    Refused,
    /// Pending judgement of its path.
    Waits,
}

impl Session {
    /// Starts program track of a target after stopping other motions. An error was already
    /// reported.
    pub(super) fn follow(&mut self, follow: ProgramTrack, now: Moment) -> Result<(), NotFollowed> {
        let name = follow.target.name().into_owned();
        tracing::info!(antenna = self.setup.name(), name, passes = follow.passes.len(), "follow");
        let TrackConfig { mut drives, settings, model } = self.setup.track_config();
        // The unit's own limits may be tighter than the limits in the station file.
        drives.mount = drives.mount.clipped(self.gate.state().travel_deg);
        let follow =
            if settings.after == AfterPass::Next { follow } else { follow.one_pass(now.utc) };
        let phase = follow.phase(now.utc);
        let planned = if phase == TrackPhase::Over {
            Err(TrackProblem::NoPass)
        } else {
            let bounds = self.gate.bounds_in(Intent::Track).clone();
            let planner = Planner::new(follow, drives, settings, bounds);
            planner.map(|planner| planner.with_model(model)).map_err(TrackProblem::Orbit)
        };
        // The gate must judge the first position with the initial offsets of its pass.
        let sky_before = self.gate.to_sky();
        if let Ok(planner) = &planned {
            let to_sky = planner.to_sky(phase.begins(now.utc), planner.offsets());
            self.gate.set_to_sky(to_sky);
        }
        // Check the position before ending any motion.
        let checked = planned.and_then(|planner| self.check_first(planner, now));
        let planner = match checked {
            Ok(planner) => planner,
            Err(problem) => {
                self.gate.set_to_sky(sky_before);
                if matches!(problem, TrackProblem::Refused(Refusal::BeingJudged)) {
                    return Err(NotFollowed::Waits);
                }
                self.tell(Event::CannotProgramTrack(name, problem));
                return Err(NotFollowed::Refused);
            }
        };
        // A change of target needs no stop.
        if self.commanded.activity.last_program().is_none() && self.may_move() {
            self.halt_quietly(now);
        }
        self.gate.begin_track();
        let track = Tracking::new(planner, phase, now.steady);
        self.commanded.activity = Activity::ProgramTrack(Box::new(track));
        self.tell_phase(phase, name);
        Ok(())
    }

    /// Checks whether the gate allows the first position.
    fn check_first(&mut self, mut planner: Planner, now: Moment) -> Result<Planner, TrackProblem> {
        let axes = Tracking::turning(self.gate.state().measured);
        if let Some(order) = self.judging.open_order(&mut planner, axes, now)? {
            self.judging.plan(order);
            return Err(Refusal::BeingJudged.into());
        }
        if let Some(next) = planner.update(now.utc, axes)? {
            self.route(motion(next), now)?;
        }
        Ok(planner)
    }

    fn tell_phase(&self, phase: TrackPhase, name: String) {
        match phase {
            TrackPhase::Waiting { aos } => self.tell(Event::Awaits { name, aos }),
            TrackPhase::Tracking => self.tell(Event::ProgramTracks(name)),
            TrackPhase::Over => {}
        }
    }

    /// Returns `true` while the target is up and tracked.
    pub(super) fn follows_now(&self) -> bool {
        self.commanded.activity.program().is_some_and(Tracking::follows_now)
    }

    /// Returns the time of the next planner update.
    pub(super) fn follow_due(&self) -> Option<Instant> {
        self.commanded.activity.program()?.due()
    }

    /// Keeps the antenna on its target.
    pub(super) fn watch_follow(&mut self, now: Moment) {
        let measured = self.gate.state().measured;
        let half_beam = self.setup.ability().half_beam;
        let on_target = self.setup.on_target(self.figures());
        let axis_count = self.setup.can().axis_count();
        let Some(track) = self.commanded.activity.program_mut() else { return };
        if let Some(measured) = measured {
            track.compare(measured, axis_count, half_beam, on_target);
            // Keep the rates for the next target, too.
            self.setup.learn_rates(track.planner.rates_deg_s());
            if track.is_blind() {
                let name = track.name();
                return self.give_up(Event::CannotProgramTrack(name, TrackProblem::NoAngle), now);
            }
        }
        let phase = track.planner.track().phase(now.utc);
        if phase != track.phase() {
            self.enter_phase(phase, now);
        }
        self.update_program(now);
    }

    fn enter_phase(&mut self, phase: TrackPhase, now: Moment) {
        let Some(track) = self.commanded.activity.program_mut() else { return };
        let name = track.name();
        let stats = track.enter(phase);
        if let Some(stats) = stats {
            self.tell(Event::ProgramTrackOver { name: name.clone(), stats });
        }
        self.tell_phase(phase, name);
        if phase == TrackPhase::Over {
            self.end_program(now);
        }
    }

    /// Ends the track after its last pass. Does not park an antenna that waits for the operator.
    fn end_program(&mut self, now: Moment) {
        let awaits = self.commanded.activity.program().is_some_and(Tracking::asks);
        self.commanded.activity =
            match std::mem::replace(&mut self.commanded.activity, Activity::Standby) {
                Activity::ProgramTrack(track) => Activity::Hold(Some(track)),
                activity => activity,
            };
        if self.setup.track_config().settings.after == AfterPass::Park && !awaits {
            self.carry_out(Command::Park, now);
        }
    }

    /// Sends the next position when it is due.
    fn update_program(&mut self, now: Moment) {
        let is_busy = self.stop.is_under_way()
            || self.commanded.is_in_doubt()
            || self.contact.is_unread()
            || self.gate.device().motion_under_way();
        let measured = self.gate.state().measured.filter(|_| !is_busy);
        let Some(track) = self.commanded.activity.program_mut() else { return };
        if !track.is_due(now.steady) {
            return;
        }
        if track.asks() {
            track.look_at(now.steady + self.setup.track_config().settings.period());
            return;
        }
        track.hold_up(measured.is_none());
        let Some(measured) = measured else { return };
        let TrackConfig { settings, .. } = self.setup.track_config();
        track.look_at(now.steady + settings.period());
        let latency = Duration::try_from_secs_f64(settings.latency_s).unwrap_or_default();
        let axes = track.axes(measured, latency);
        // The answer triggers the next update.
        if let Some(order) = track.planner.path_order(now.utc, axes).filter(PathOrder::may_detour) {
            return self.judging.plan(order);
        }
        match track.planner.update(now.utc, axes) {
            Ok(None) => {}
            Ok(Some(next)) => self.send_next(next, now),
            Err(error) => self.end_follow(TrackProblem::Orbit(error), now),
        }
    }

    fn send_next(&mut self, next: Next, now: Moment) {
        let motion = motion(next);
        let routed = self.route(motion, now);
        let started = routed.and_then(|route| {
            self.gate.start(route.first, Intent::Track, self.stop.is_under_way(), now)?;
            Ok(route)
        });
        match started {
            Ok(route) => {
                let aim = self.gate.aim(&route.first);
                self.stop.forget();
                if let Some(track) = self.commanded.activity.program_mut() {
                    track.sent(next, aim, route.second.is_some(), now.steady);
                }
            }
            // The track waits at the edge, and continues once the path is free.
            Err(Refusal::Forbidden { barrier, direction }) => {
                let track = self.commanded.activity.program_mut();
                if track.is_some_and(|track| track.block(now.steady)) {
                    self.tell(Event::NotSent(Refusal::Forbidden { barrier, direction }));
                }
            }
            // The missing information will arrive later.
            Err(
                Refusal::BeingJudged
                | Refusal::PositionUnknown
                | Refusal::PositionOld(_)
                | Refusal::FaultsUnknown
                | Refusal::Stopping,
            ) => {}
            Err(refusal) => self.end_follow(refusal.into(), now),
        }
    }

    /// Ends the track of a fixed direction: the antenna goes there and stays without further
    /// corrections.
    pub(super) fn end_at_target(&mut self, now: Moment) {
        let measured = self.gate.state().measured;
        let Some(track) = self.commanded.activity.program_mut() else { return };
        if !matches!(track.planner.track().target, Target::Fixed(_)) {
            return;
        }
        track.planner.forget_sent();
        let next = track.planner.update(now.utc, Tracking::turning(measured));
        let slew = match next {
            Ok(Some(next)) => self.slew(motion(next), Intent::Position, now).ok(),
            Ok(None) | Err(_) => None,
        };
        match slew {
            // The slew replaces the running motion, like each position of the track.
            Some(slew) => self.commanded.activity = Activity::GoTo(GoTo { parks: false, slew }),
            None => self.leave_for(Activity::Hold(None), now),
        }
    }

    pub(super) fn end_follow(&mut self, problem: TrackProblem, now: Moment) {
        let Some(name) = self.commanded.activity.program().map(Tracking::name) else { return };
        self.give_up(Event::CannotProgramTrack(name, problem), now);
    }

    /// Records a position without an answer or effect. Returns `true` if the track may send another
    /// position.
    pub(super) fn may_send_another(&mut self) -> bool {
        self.commanded.activity.last_program_mut().is_some_and(Tracking::lose)
    }

    /// Plans the next position of these axes from their current angles, and ignores sent positions.
    pub(super) fn replan(&mut self, axes: [bool; 2]) {
        if let Some(track) = self.commanded.activity.last_program_mut() {
            track.planner.forget_sent_of(axes);
        }
    }

    /// Records that the unit accepted a position.
    pub(super) fn note_position(&mut self) {
        if let Some(track) = self.commanded.activity.last_program_mut() {
            track.is_taken();
        }
    }

    /// Applies new bounds of the antenna.
    pub(super) fn keep_within(&mut self, bounds: Bounds) {
        self.gate.keep_within(bounds);
        if let Some(track) = self.commanded.activity.program_mut() {
            track.planner.keep_within(self.gate.bounds_in(Intent::Track).clone());
        }
    }

    /// Resumes the track after the first reading since an outage of length `lost`: commands on the
    /// earlier link may be lost, and somebody may have changed the antenna.
    pub(super) fn follow_on(&mut self, lost: Duration, now: Moment) {
        let Some(track) = self.commanded.activity.program_mut() else { return };
        // A pending comparison stays pending.
        let unchecked = track.interrupt();
        if self.setup.resumes_at_once(lost) && unchecked.is_none() {
            return;
        }
        // A second short outage must not skip the comparison after the first.
        let lost = lost + unchecked.unwrap_or_default();
        if !self.gate.explains_position() {
            return self.await_operator(lost, Some(Unlike::Position));
        }
        if self.setup.asks_to_resume() {
            return self.await_operator(lost, None);
        }
        if let Some(track) = self.commanded.activity.program_mut() {
            track.begin_recheck(Recheck { begun: now.steady, lost });
        }
    }

    pub(super) fn await_operator(&mut self, lost: Duration, unlike: Option<Unlike>) {
        let Some(track) = self.commanded.activity.program_mut() else { return };
        track.await_operator();
        let name = track.name();
        self.tell(Event::Safety(Safety::AsksToResume { name, lost, unlike }));
    }

    /// Stops the antenna and keeps its target until the operator decides.
    pub(super) fn suspend_following(&mut self, lost: Duration, now: Moment) {
        if self.commanded.activity.program().is_none() {
            return;
        }
        // A halt would end the track, so keep it aside for the operator's answer.
        let program = std::mem::replace(&mut self.commanded.activity, Activity::Standby);
        self.halt_quietly(now);
        self.commanded.activity = program;
        if let Some(tracking) = self.commanded.activity.program_mut() {
            tracking.forget_aim();
        }
        self.await_operator(lost, None);
    }

    /// Resumes the track on the operator's decision.
    pub(super) fn resume(&mut self) {
        if let Some(track) = self.commanded.activity.program_mut() {
            track.resume();
        }
    }
}

pub(super) fn motion(next: Next) -> Motion {
    Motion::Position { azimuth: next.set_point.azimuth, elevation: next.set_point.elevation }
}
