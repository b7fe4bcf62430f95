//! What the operator can ask of an antenna, and what the session makes of it.

use serde::{Deserialize, Serialize};
use smol_str::SmolStr;

use super::{
    Event, Session,
    activity::{Activity, GoTo, GoToStage, Leg, OnBoardStage, OnBoardTrack, Queued},
    jog::JogKey,
    wanted::Wanted,
};
use crate::{
    astro::Angle,
    clock::Moment,
    device::{
        Motion,
        panel::Act,
        settings::{Change, WriteError},
    },
    driver::{Intent, Refusal},
    name::{self, Name},
    plan::{OnBoardPass, ProgramTrack},
    station::LockOut,
};

/// What the operator can ask of an antenna. STOP is no command: it goes past
/// this queue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// Nothing is to move: ends whatever runs.
    Standby,
    /// By hand: ends tracking.
    Manual,
    /// Stay where it is, ready to be sent to a direction: ends tracking.
    Hold,
    /// A jog key is down. To be repeated at least every 300 ms.
    Jog {
        /// Signed rates of the two axes, degrees a second.
        rates_deg_s: [f64; 2],
    },
    /// The jog key is up.
    EndJog,
    /// For a minute, move by hand although no dead-man can be had.
    AllowUnguarded,
    /// For a minute, move by hand out of where the antenna must not point.
    AllowWayOut,
    /// Go to the nearest direction that stays clear of the Sun.
    MoveAway,
    /// One step of the two axes.
    Step {
        /// Signed, degrees.
        steps_deg: [f64; 2],
    },
    /// To a direction of the sky.
    Position {
        /// `None` leaves it as it is.
        azimuth: Option<Angle>,
        /// `None` leaves it as it is.
        elevation: Option<Angle>,
    },
    /// Let the device track a pass by itself.
    Track(Box<OnBoardPass>),
    /// Take over what the unit tracks by itself, without a motion: its satellite is known
    /// here, and it points there.
    TakeOver,
    /// Follow a target position by position, also where the device could track by
    /// itself.
    ProgramTrack(Box<ProgramTrack>),
    /// Follow a target that leads to the Sun, by the operator's word: the avoidance of
    /// it is lifted for that alone.
    ProgramTrackIntoSun(Box<ProgramTrack>),
    /// Follow on, where that waits for the operator's word.
    Resume,
    /// The operator has seen that the antenna stands: no STOP is owed any more.
    SeenStanding,
    /// To the park position.
    Park,
    /// Open the link, and keep it.
    Connect,
    /// Close the link, and leave the device to others. A motion of its own goes
    /// on.
    Disconnect,
    /// Do what only this make of controller can do.
    Act(Act),
    /// The same, where the gate does not know where it leads and the operator answers
    /// for that.
    ActUnseen(Act),
    /// The device may start to follow by itself.
    AutoTrack(bool),
    /// Read the group of settings with this key anew.
    ReadGroup(#[serde(deserialize_with = "name::one")] Name),
    /// Put new values of a group of settings on the device. The outcome stands
    /// in the snapshot.
    WriteSettings(Change),
    /// Lock the unit out for maintenance: from now on nothing but questions and STOP
    /// goes to it. What moves is stopped first.
    LockOut(LockOut),
    /// The maintenance is over.
    Unlock,
    /// Ask the device something; the answer is in the log of the link.
    Ask(SmolStr),
}

impl Session {
    pub(super) fn carry_out(&mut self, command: Command, now: Moment) {
        // A hold is renewed many times a second; not worth a line each. Settings
        // are logged where they are made, without their values, and a target by its
        // name.
        let quiet = matches!(
            command,
            Command::Jog { .. }
                | Command::WriteSettings(_)
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
            Command::AllowUnguarded => self.allow_unguarded(now),
            Command::AllowWayOut => self.allow_way_out(now),
            Command::MoveAway => self.move_away(now),
            Command::SeenStanding => self.take_word_for_standstill(),
            Command::Resume => self.resume(),
            Command::Standby => self.leave_for(Activity::Standby, now),
            Command::Manual => self.leave_for(Activity::Manual, now),
            Command::Hold => self.leave_for(Activity::Hold(None), now),
            Command::Step { steps_deg } => self.step(steps_deg, now),
            Command::Position { azimuth, elevation } => {
                self.go_to(Motion::Position { azimuth, elevation }, Intent::Position, now);
            }
            Command::Park => {
                let has_elevation = self.variant.capabilities.has_elevation();
                let motion = Motion::Position {
                    azimuth: self.setup.park.azimuth,
                    elevation: self.setup.park.elevation.filter(|_| has_elevation),
                };
                self.go_to(motion, Intent::Park, now);
            }
            Command::Track(pass) => self.track(*pass, now),
            Command::TakeOver => self.take_over(now),
            Command::ProgramTrack(follow) => self.follow_as_agreed(*follow, false, now),
            Command::ProgramTrackIntoSun(follow) => self.follow_as_agreed(*follow, true, now),
            Command::AutoTrack(true) => {
                let held = self.held(now);
                self.gate.will_hold(held);
                self.start(Motion::EnableAuto, now);
            }
            Command::AutoTrack(false) => self.gate.device().disable_auto(),
            Command::ReadGroup(group) => self.gate.device().read_group(group),
            Command::WriteSettings(change) => self.write_settings(change, now),
            Command::Ask(question) => self.gate.device().ask(&question),
            Command::Act(act) => self.act(act, false, now),
            Command::ActUnseen(act) => self.act(act, true, now),
            Command::Connect => self.contact.wanted = Wanted::Yes,
            // The loop's.
            Command::Disconnect => {}
        }
        // The act comes first: nothing of it waits for its line.
        if let Some(command) = line {
            tracing::info!(antenna = self.name, ?command, "command");
        }
    }

    fn act(&mut self, act: Act, is_agreed: bool, now: Moment) {
        let (intent, stopping) = (self.activity.intent(), self.stop.is_under_way());
        match self.gate.act(act, is_agreed, intent, stopping, now) {
            Ok(action) if action.moves => {
                self.stop.forget();
                self.acts = true;
            }
            Ok(_) => {}
            Err(refusal) => self.tell(Event::NotSent(refusal)),
        }
    }

    /// Ends what runs, for an activity in which nothing moves by itself.
    fn leave_for(&mut self, activity: Activity, now: Moment) {
        // In Standby nothing of the device is to move.
        let is_standby = matches!(activity, Activity::Standby);
        if self.may_move() || (is_standby && self.active()) {
            self.halt_quietly(now);
        }
        self.key = JogKey::Up;
        self.activity = activity;
    }

    /// Whether the motion went through the gate; if not, the reason was told.
    pub(super) fn start(&mut self, motion: Motion, now: Moment) -> bool {
        let (intent, stopping) = (self.activity.intent(), self.stop.is_under_way());
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

    /// Checked before anything that runs is ended for it.
    pub(super) fn go_to(&mut self, motion: Motion, intent: Intent, now: Moment) {
        let checked = self.gate.nearest(motion).and_then(|motion| {
            let route = self.gate.route(motion, intent, now)?;
            Ok((motion, route))
        });
        let (motion, route) = match checked {
            Ok(checked) => checked,
            Err(refusal) => return self.tell(Event::NotSent(refusal)),
        };
        let aim = self.gate.aim(&motion);
        let first_aim = self.gate.aim(&route.first);
        if self.may_move() {
            self.halt_quietly(now);
        }
        let leg = first_aim.zip(route.then).map(|(aim, then)| Leg { aim, then });
        let stage = GoToStage::Queued { motion: route.first, leg };
        self.activity = Activity::GoTo(GoTo { parks: intent == Intent::Park, aim, stage });
    }

    fn track(&mut self, pass: OnBoardPass, now: Moment) {
        let target = pass.target.clone();
        tracing::info!(antenna = self.name, ?target, is_agreed = pass.is_agreed, "track");
        let watch = match self.examine_pass(pass, now) {
            Ok(watch) => watch,
            Err(event) => return self.tell(event),
        };
        if self.may_move() {
            self.halt_quietly(now);
        }
        self.unasked = None;
        let stage = OnBoardStage::LoadQueued;
        self.activity = Activity::OnBoardTrack(Box::new(OnBoardTrack { target, watch, stage }));
    }

    fn take_over(&mut self, now: Moment) {
        let is_on = self.gate.state().program.is_some_and(|program| program.enabled);
        let Some(watch) = self.unasked.take().filter(|_| is_on) else {
            return self.tell(Event::NotSent(Refusal::PassUnknown));
        };
        let checked = match watch.would_miss() {
            None => self.gate.check_pass(watch.judge(), now).map_err(Event::NotSent),
            Some(event) => Err(event),
        };
        if let Err(event) = checked {
            self.unasked = Some(watch);
            return self.tell(event);
        }
        let target = watch.judge().pass().target.clone();
        self.key = JogKey::Up;
        let stage = OnBoardStage::Tracking;
        self.tell(Event::Tracking(target.clone()));
        self.activity = Activity::OnBoardTrack(Box::new(OnBoardTrack { target, watch, stage }));
    }

    /// Sends what waited for a halt to end.
    pub(super) fn start_queued(&mut self, now: Moment) {
        if self.stop.is_under_way() {
            return;
        }
        let intent = self.activity.intent();
        let started = match self.activity.take_queued(now.steady) {
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

    /// The intent cannot be had, or is over: back to Standby, with the reason.
    /// A halt makes sure that nothing of it is left.
    pub(super) fn give_up(&mut self, reason: Event, now: Moment) {
        self.activity = Activity::Standby;
        self.halt_quietly(now);
        self.tell(reason);
    }

    /// A command while there is no link.
    pub(super) fn carry_out_offline(&mut self, command: Command, now: Moment) {
        if self.lock_out_forbids(&command) {
            return;
        }
        match command {
            Command::WriteSettings(change) => {
                self.gate.device().refuse_change(change, WriteError::NoLink, now);
            }
            // A group is read when the link is back and somebody looks; that
            // nothing can be asked is told by the link itself.
            Command::ReadGroup(_) | Command::Ask(_) => {}
            Command::Connect => self.contact.wanted = Wanted::Yes,
            Command::LockOut(lock_out) => self.lock_out(lock_out, now),
            Command::Unlock => self.unlock(),
            // Told by the link itself; the keys are locked anyway.
            Command::Jog { rates_deg_s } => self.key = JogKey::Spent(rates_deg_s),
            Command::EndJog => self.key = JogKey::Up,
            Command::AllowUnguarded => self.allow_unguarded(now),
            Command::AllowWayOut => self.allow_way_out(now),
            Command::SeenStanding => self.take_word_for_standstill(),
            Command::Resume => self.resume(),
            Command::Standby => self.activity = Activity::Standby,
            _ => {
                // Whoever wants something else does not want this to go on.
                if self.activity.program().is_some() {
                    self.activity = Activity::Standby;
                }
                self.tell(Event::NotSent(Refusal::PositionUnknown));
            }
        }
    }
}
