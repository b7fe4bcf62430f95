//! Operator commands to an antenna, and their execution by the session.

use std::sync::Arc;

use super::{
    Session,
    activity::{Activity, GoTo, Leg, OnBoardStage, OnBoardTrack, Queued, Slew, SlewStage},
    contact::LinkNeed,
};
use crate::{
    clock::Moment,
    contract::{
        control::Answer,
        driver::{Command, Event, Intent, Refusal},
    },
    device::{Motion, panel::Act, settings::WriteError},
    driver::{
        Numbered,
        gate::{NextPass, NoRoute},
    },
    plan::OnBoardPass,
};

impl Session {
    /// Executes a command, and shows its answer if a sender waits for it.
    pub(super) fn carry_out_numbered(
        &mut self,
        numbered: Numbered,
        now: Moment,
        carry_out: fn(&mut Self, Command, Moment),
    ) {
        let Numbered { command, number, wants_answer } = numbered;
        self.wires.take_problem();
        carry_out(self, command, now);
        if wants_answer {
            self.answer = Some(Answer { number, problem: self.wires.take_problem() });
        }
    }

    pub(super) fn carry_out(&mut self, command: Command, now: Moment) {
        if let Some(command) = self.judging.take_turn(command) {
            self.carry_out_now(command, now);
        }
    }

    pub(super) fn carry_out_now(&mut self, command: Command, now: Moment) {
        // Log no jog, because the window renews it many times a second. `write_settings` logs
        // settings without their values; a target appears by its name.
        let quiet = matches!(
            command,
            Command::Jog { .. }
                | Command::WriteSettings(_)
                | Command::Preview(_)
                | Command::ProgramTrack(_)
                | Command::ProgramTrackIntoSun(_)
                | Command::Track(_)
        );
        let line = (!quiet && tracing::enabled!(tracing::Level::INFO)).then(|| command.clone());
        if self.lock_out_forbids(&command) {
            return;
        }
        match command {
            Command::LockOut(lock_out) => self.lock_out(lock_out, now),
            Command::Unlock => self.unlock(),
            Command::Jog { rates_deg_s } => self.hold_jog(rates_deg_s, now),
            Command::EndJog => self.release_jog(now),
            Command::AllowUnguarded => self.stop.guard.allow_unguarded(now.steady),
            Command::AllowWayOut => self.allow_way_out(now),
            Command::ForgetDrives => self.gate.forget_lessons(),
            Command::MoveAway => self.move_away(now),
            Command::SeenStanding => self.accept_operator_standstill(),
            Command::Resume => self.resume(),
            Command::Offset(change) => self.change_offsets(change, now),
            Command::FirstOffsets(offsets) => self.begin_with(offsets),
            Command::EndAtTarget => self.end_at_target(now),
            Command::Standby => self.leave_for(Activity::Standby, now),
            Command::Manual => self.leave_for(Activity::Manual, now),
            Command::Hold => self.leave_for(Activity::Hold(None), now),
            Command::Step { steps_deg } => self.step(steps_deg, now),
            Command::Position { azimuth, elevation } => {
                self.go_to(Motion::Position { azimuth, elevation }, Intent::Position, now);
            }
            Command::Park => {
                let motion = self.setup.park_motion();
                self.go_to(motion, Intent::Park, now);
            }
            Command::Preview(target) => self.commanded.preview = target,
            Command::Track(pass) => self.track(*pass, now),
            Command::TakeOver => self.take_over(now),
            Command::ProgramTrack(follow) => self.follow_as_agreed(*follow, false, now),
            Command::ProgramTrackIntoSun(follow) => self.follow_as_agreed(*follow, true, now),
            Command::AutoTrack(true) => {
                let next_pass = self.next_pass(now);
                if let NextPass::Pass(judge) = &next_pass {
                    let unit = self.gate.state().on_board.clone();
                    if !self.is_judged(judge, &[unit]) {
                        return self.wait_for_judgement(Command::AutoTrack(true));
                    }
                }
                self.gate.set_next_pass(next_pass);
                if self.start(Motion::EnableAuto, now) {
                    self.owed.debts().settle_auto_track();
                }
            }
            Command::AutoTrack(false) => self.end_auto_track(),
            Command::ReadGroup(group) => self.gate.device().read_group(group),
            Command::WriteSettings(change) => self.write_settings(change, now),
            Command::Ask(question) => self.gate.device().ask(&question),
            Command::Act(act) => self.act(act, false, now),
            Command::ActUnseen(act) => self.act(act, true, now),
            Command::Connect => self.contact.want(LinkNeed::Yes),
            // The I/O loop handles this command.
            Command::Disconnect => {}
        }
        // Execute first, so that the action does not wait for its log line.
        if let Some(command) = line {
            tracing::info!(antenna = self.setup.name(), ?command, "command");
        }
    }

    fn act(&mut self, act: Act, is_agreed: bool, now: Moment) {
        let (intent, stopping) = (self.commanded.activity.intent(), self.stop.is_under_way());
        match self.gate.act(act, is_agreed, intent, stopping, now) {
            Ok(action) if action.moves => {
                self.stop.forget();
                self.commanded.act();
            }
            Ok(_) => {}
            Err(refusal) => self.tell(Event::NotSent(refusal)),
        }
    }

    /// Ends the current activity for a new one in which no motion starts on its own.
    pub(super) fn leave_for(&mut self, activity: Activity, now: Moment) {
        // In Standby, the unit must not start on its own either.
        let is_standby = matches!(activity, Activity::Standby);
        if self.may_move() || (is_standby && self.is_active()) {
            self.halt_quietly(now);
        }
        self.commanded.key.release();
        self.commanded.activity = activity;
    }

    /// Sends a motion through the gate. Returns `false` after reporting a refusal.
    pub(super) fn start(&mut self, motion: Motion, now: Moment) -> bool {
        let (intent, stopping) = (self.commanded.activity.intent(), self.stop.is_under_way());
        match self.gate.start(motion, intent, stopping, now) {
            Ok(()) => {
                self.stop.forget();
                true
            }
            Err(refusal) => {
                self.tell(Event::NotSent(refusal));
                false
            }
        }
    }

    /// Starts a go-to. Checks the motion before ending the current activity.
    pub(super) fn go_to(&mut self, motion: Motion, intent: Intent, now: Moment) {
        let slew = match self.slew(motion, intent, now) {
            Ok(slew) => slew,
            Err(refusal) => return self.tell(Event::NotSent(refusal)),
        };
        if self.may_move() {
            self.halt_quietly(now);
        }
        self.commanded.activity = Activity::GoTo(GoTo { parks: intent == Intent::Park, slew });
    }

    /// Returns the unsent path to the end of `motion`.
    pub(super) fn slew(
        &self,
        motion: Motion,
        intent: Intent,
        now: Moment,
    ) -> Result<Slew, Refusal> {
        let motion = self.gate.nearest(motion)?;
        let route = self.gate.route(motion, intent, now).map_err(NoRoute::refusal)?;
        let first_aim = self.gate.aim(&route.first);
        let leg = first_aim.filter(|_| route.second.is_some());
        let leg = leg.map(|aim| Leg { aim, next: route.second });
        let stage = SlewStage::Queued { motion: route.first, leg };
        Ok(Slew { aim: self.gate.aim(&motion), stage })
    }

    fn track(&mut self, pass: OnBoardPass, now: Moment) {
        let target = pass.target.clone();
        tracing::info!(antenna = self.setup.name(), ?target, is_agreed = pass.is_agreed, "track");
        let (watch, slew) = match self.examine_pass(pass.clone(), now) {
            Ok(Some(examined)) => examined,
            Ok(None) => return self.wait_for_judgement(Command::Track(Box::new(pass))),
            Err(event) => return self.tell(event),
        };
        if self.may_move() {
            self.halt_quietly(now);
        }
        self.observed.unasked = None;
        let stage = slew.map_or(OnBoardStage::LoadQueued, OnBoardStage::Slewing);
        self.commanded.activity =
            Activity::OnBoardTrack(Box::new(OnBoardTrack { target, watch, stage }));
    }

    fn take_over(&mut self, now: Moment) {
        let is_on = self.gate.state().program.is_some_and(|program| program.enabled);
        let Some(watch) = self.observed.unasked.take().filter(|_| is_on) else {
            return self.tell(Event::NotSent(Refusal::PassUnknown));
        };
        let unit = self.gate.state().on_board.clone();
        if !self.is_judged(watch.judge(), &[unit]) {
            // Until Azel takes the unit's track over, watch it as a track of somebody else.
            self.observed.unasked = Some(watch);
            return self.wait_for_judgement(Command::TakeOver);
        }
        let checked = match watch.would_miss() {
            None => self.gate.check_pass(watch.judge(), now).map_err(Event::NotSent),
            Some(event) => Err(event),
        };
        if let Err(event) = checked {
            self.observed.unasked = Some(watch);
            return self.tell(event);
        }
        let target = watch.judge().pass().target.clone();
        self.commanded.key.release();
        let stage = OnBoardStage::Tracking;
        self.tell(Event::Tracking(target.clone()));
        self.commanded.activity =
            Activity::OnBoardTrack(Box::new(OnBoardTrack { target, watch, stage }));
    }

    /// Sends the step that waited for the end of a halt.
    pub(super) fn start_queued(&mut self, now: Moment) {
        // Remaining offsets of the last track would shift the next one.
        if self.stop.is_under_way() || self.takes_offsets_back() {
            return;
        }
        if let Some(track) =
            self.commanded.activity.on_board().filter(|track| track.stage.starts_program())
        {
            let (judge, unit) =
                (Arc::clone(track.watch.judge()), self.gate.state().on_board.clone());
            // The unit's report may have changed since the judgement of the command.
            if !self.is_judged(&judge, &[unit]) {
                return;
            }
        }
        let intent = self.commanded.activity.intent();
        let started = match self.commanded.activity.take_queued(now.steady) {
            None => return,
            Some(Queued::Load(target)) => self.gate.prepare(target, intent, now),
            Some(Queued::Motion(motion)) => {
                self.gate.start(motion, intent, false, now).inspect(|()| self.stop.forget())
            }
        };
        if let Err(refusal) = started {
            self.give_up(Event::NotSent(refusal), now);
        }
    }

    /// Gives up the intent and returns to Standby with the reason. A halt ends any remaining
    /// motion.
    pub(super) fn give_up(&mut self, reason: Event, now: Moment) {
        self.commanded.activity = Activity::Standby;
        self.halt_quietly(now);
        self.tell(reason);
    }

    /// Executes a command without a link.
    pub(super) fn carry_out_offline(&mut self, command: Command, now: Moment) {
        if self.lock_out_forbids(&command) {
            return;
        }
        match command {
            Command::WriteSettings(change) => {
                self.gate.device().refuse_change(change, WriteError::NoLink, now);
            }
            // The session reads a group after the link is back, if the window shows it. The link
            // state shows that no query is possible. The I/O loop handles a disconnect.
            Command::ReadGroup(_) | Command::Ask(_) | Command::Disconnect => {}
            Command::Preview(target) => self.commanded.preview = target,
            Command::Connect => self.contact.want(LinkNeed::Yes),
            Command::LockOut(lock_out) => self.lock_out(lock_out, now),
            Command::Unlock => self.unlock(),
            // The link state shows the failure; the window locks the keys anyway.
            Command::Jog { rates_deg_s } => self.commanded.key.spend_rates(rates_deg_s),
            Command::EndJog => self.commanded.key.release(),
            Command::AllowUnguarded => self.stop.guard.allow_unguarded(now.steady),
            Command::AllowWayOut => self.allow_way_out(now),
            Command::ForgetDrives => self.gate.forget_lessons(),
            Command::SeenStanding => self.accept_operator_standstill(),
            Command::Resume => self.resume(),
            Command::Standby => self.leave_for(Activity::Standby, now),
            Command::AutoTrack(false) => self.end_auto_track(),
            // The track would continue on the next link.
            Command::EndAtTarget => self.end_at_target(now),
            Command::FirstOffsets(offsets) => self.begin_with(offsets),
            // The track continues with its current offsets.
            Command::Offset(_) => self.tell(Event::OffsetRefused(Refusal::PositionUnknown)),
            // Another motion ends the current one, so Azel owes it a STOP as soon as the link is
            // back. Azel refuses the new motion, because the unit's position is unknown.
            Command::Manual
            | Command::Hold
            | Command::MoveAway
            | Command::Step { .. }
            | Command::Position { .. }
            | Command::Park
            | Command::Track(_)
            | Command::TakeOver
            | Command::ProgramTrack(_)
            | Command::ProgramTrackIntoSun(_) => {
                self.leave_for(Activity::Standby, now);
                self.tell(Event::NotSent(Refusal::PositionUnknown));
            }
            Command::Act(_) | Command::ActUnseen(_) | Command::AutoTrack(true) => {
                self.tell(Event::NotSent(Refusal::PositionUnknown));
            }
        }
    }
}
