//! Automatic operation: each antenna takes the passes of its schedule without the operator.

mod at_start;
mod auto_track;
mod clock_stop;
mod day;
mod observation;
mod operation;
mod resumption;
mod upkeep;

use std::path::PathBuf;

pub use self::operation::Duty;
pub(super) use self::{
    at_start::LastRun,
    day::Flight,
    operation::{Operate, is_same_pass},
    upkeep::RuleUpload,
};
use self::{
    clock_stop::ClockStop,
    observation::observe,
    operation::{Act, LATE_S, Observation, Outcome, WINDOW_STEP_S, Wishes},
    resumption::Resumption,
    upkeep::UpkeepWork,
};
use super::{Antenna, CurrentRequest, Engine, StationClaim, handle::Stopped};
use crate::{
    astro::time::seconds_between,
    contract::{
        Command, CommandOrigin,
        alarms::AlarmKind,
        antenna::AntennaModel,
        automatic::{DayEvent, DayLine, Doing, Flown, Interruption, OffBecause, On, Operation},
        driver::{
            self, Event, Found, Refusal, Response, Safety, StopState, TakesControl, TrackProblem,
            Unit,
        },
        passes::PassListKey,
    },
    device::{Motion, MotionRequest},
    engine::{alarms::KeepAlarms, automatic::operation::is_alarming},
    plan::schedule::{Entry, between_passes, parks_within_s, sets_out},
    promises::FileState,
    station::{AntennaId, BetweenPasses},
};

/// Working state of an antenna's automatic operation, besides its state in the snapshot.
#[derive(Default)]
pub(super) struct AtWork {
    /// Current or next pass of the schedule, from the time when the antenna should set out.
    flight: Option<Flight>,
    /// Last reported state.
    operation: Option<Operation>,
    /// `true` while auto-track is on for the pass in the unit and no client has changed it.
    has_auto_track_on: bool,
    /// Pending resumption after a crash.
    resumption: Option<Resumption>,
    /// Pass that the last run was taking, until the antenna takes a pass in this run.
    interrupted: Option<PassListKey>,
    clock_stop: ClockStop,
    upkeep: UpkeepWork,
}

impl AtWork {
    /// Returns the state that stays valid when the antenna gets another unit.
    pub(super) fn without_unit(self) -> Self {
        let (clock_stop, upkeep) = Default::default();
        Self {
            has_auto_track_on: false,
            resumption: None,
            interrupted: None,
            clock_stop,
            upkeep,
            ..self
        }
    }

    /// Returns the current or next pass of the schedule.
    pub(super) fn duty(&self) -> Option<Duty> {
        self.flight.as_ref().map(|flight| flight.duty)
    }

    /// Returns the pass that the last run was taking, if automatic operation is on or waits to
    /// resume.
    pub(super) fn interrupted(&self, operation: &Operation) -> Option<PassListKey> {
        self.interrupted.filter(|_| operation.is_on() || self.resumption.is_some())
    }
}

impl Engine {
    /// Switches automatic operation on or off. A lock-out or another Azel prevents switching it on.
    pub(super) fn set_automatic(&mut self, index: usize, is_on: bool) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let antenna_id = Some(antenna.shown.id());
        antenna.at_work.resumption = None;
        let operation = &mut antenna.shown.operation;
        if !is_on {
            operation.switch_off(OffBecause::Operator);
            let is_that = |kind: &AlarmKind| matches!(kind, AlarmKind::AutomaticOff(_));
            self.alarms.clear(antenna_id, self.now, is_that);
        } else if operation.is_on() {
            // Automatic operation is already on.
        } else if antenna.shown.held_by.is_none() && antenna.shown.snapshot.lock_out.is_none() {
            *operation = Operation::switched_on();
            let is_that = |kind: &AlarmKind| matches!(kind, AlarmKind::AutomaticOff(_));
            self.alarms.clear(antenna_id, self.now, is_that);
        }
    }

    /// Resumes the schedule of a suspended antenna.
    pub(super) fn go_on(&mut self, index: usize) {
        let now = self.now;
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.shown.operation.go_on(now);
        }
    }

    /// Switches automatic operation on where the station file says so and the last run permits it.
    pub(super) fn start_automatic(&mut self) {
        let path = self.last_run_path();
        let last = path.as_deref().map(LastRun::load).unwrap_or_default();
        for index in 0..self.antennas.len() {
            let Some(antenna) = self.antennas.get(index) else { continue };
            let config = &antenna.shown.config;
            let is_free = antenna.shown.held_by.is_none()
                && self.lock_outs.find(&config.connection).is_none()
                && self.driver.debts().units().is_empty()
                && !self.driver.debts().is_marked(&Unit::new(config))
                && !self.station.unread.iter().any(|unread| unread.concerns(config.id));
            let (id, is_on_at_start) = (config.id, config.automatic.is_on_at_start);
            if is_on_at_start && is_free && last.allows(id) {
                self.set_automatic(index, true);
            } else if !last.allows(id) {
                // The last run may have left auto-track on.
                self.end_auto_track(index);
            }
        }
        for antenna in &mut self.antennas {
            antenna.at_work.interrupted = last.held_by(antenna.shown.id());
        }
        self.last_run = last.clone().next_run();
        self.prepare_resumption(&last);
        self.keep_last_run();
    }

    /// Adopts the state of automatic operation from an Azel that has ended. Automatic operation
    /// stays off; antennas switched off there stay off at the next start.
    pub(super) fn take_over_last_run(&mut self) {
        let last = self.last_run_path().as_deref().map(LastRun::load).unwrap_or_default();
        self.last_run = last.next_run();
        self.keep_last_run();
    }

    /// Notes that the station ends in order, unless a STOP is owed.
    pub(super) fn end_automatic(&mut self) {
        let owes = |antenna: &Antenna| {
            let stop = antenna.handle.snapshot().stop;
            matches!(stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. })
        };
        self.last_run.is_orderly = !self.antennas.iter().any(owes);
        // A deliberate end is not a crash, even if a STOP is owed.
        self.last_run.forget_switched_on();
        self.keep_last_run();
    }

    /// Returns the path beside the station file with this extension. `None` for the demo station,
    /// and if another Azel holds the station.
    pub(super) fn beside_station(&self, extension: &str) -> Option<PathBuf> {
        let is_ours = self.demo.is_none() && !matches!(self.station_claim, StationClaim::Theirs(_));
        let path = self.settings_path.as_deref().filter(|_| is_ours)?;
        Some(path.with_extension(extension))
    }

    fn last_run_path(&self) -> Option<PathBuf> {
        self.beside_station(at_start::EXTENSION)
    }

    fn keep_last_run(&self) {
        let Some(path) = self.last_run_path() else { return };
        let text = self.last_run.text().map_err(|error| error.to_string());
        let promises = self.driver.debts().promises();
        let result = text.and_then(|text| promises.put_and_wait(&path, FileState::Holds(text)));
        if let Err(error) = result {
            tracing::error!(error, "automatic operation will be off at the next start");
            // A full disk still permits removing files.
            if let Err(error) = std::fs::remove_file(&path) {
                tracing::error!(%error, "the state of automatic operation on disk is out of date");
            }
        }
    }

    /// Leaves an antenna to the operator after a client's command.
    pub(super) fn leave_to_operator(&mut self, command: &Command) {
        let Some(place) = command.antenna().and_then(|id| self.place(id)) else { return };
        if matches!(command, Command::Antenna(_, driver::Command::AutoTrack(_)))
            && let Some(antenna) = self.antennas.get_mut(place)
        {
            antenna.at_work.has_auto_track_on = false;
        }
        if command.row().takes_control == TakesControl::FromAll {
            self.suspend_for_operator(place);
        }
        self.take_control_by(place, command);
    }

    /// Suspends automatic operation of an antenna while the operator has it.
    pub(super) fn suspend_for_operator(&mut self, index: usize) {
        let now = self.now;
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.shown.operation.suspend(Interruption::ByHand, now);
        }
        self.cancel_resumption(index);
    }

    /// Switches automatic operation off for every antenna that the STOP was meant for.
    pub(super) fn end_automatic_by_stop(&mut self, stopped: &Stopped) {
        for index in 0..self.antennas.len() {
            let Some(antenna) = self.antennas.get_mut(index) else { continue };
            let is_meant = stopped.is_for_all || stopped.antennas.contains(&antenna.shown.id());
            if !is_meant {
                continue;
            }
            let id = antenna.shown.id();
            let was_off = matches!(antenna.shown.operation, Operation::Off(_));
            antenna.shown.operation.switch_off(OffBecause::Stop);
            self.cancel_resumption(index);
            self.end_auto_track(index);
            if !was_off {
                // Save now: the program may end before the next turn.
                self.keep_switched_off(id, true);
            }
        }
    }

    /// Handles a session's event about a pass or about safety.
    pub(super) fn take_automatic_event(&mut self, index: usize, event: &Event) {
        let (now, steady) = (self.now, self.steady);
        if resumption::ends_with(event) {
            self.cancel_resumption(index);
        }
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let uses_auto_track = antenna.shown.config.automatic.uses_auto_track;
        let operation = &mut antenna.shown.operation;
        match event {
            // The pass goes on without auto-track, and waits at the edge of a keep-out.
            Event::Refused(MotionRequest::Motion(Motion::EnableAuto), _)
            | Event::Unanswered(MotionRequest::Motion(Motion::EnableAuto))
            | Event::NotSent(Refusal::Forbidden { .. }) => {}
            Event::NotSent(_) if operation.is_proved() => {}
            Event::NotSent(Refusal::Path(_))
            | Event::CannotProgramTrack(
                _,
                TrackProblem::Refused(Refusal::Path(_) | Refusal::Forbidden { .. }),
            ) => operation.take_outcome(Outcome::Blocked),
            Event::WouldMiss { .. } => operation.take_outcome(Outcome::WouldMiss),
            Event::CannotTrack(..)
            | Event::CannotProgramTrack(..)
            | Event::NotSent(_)
            | Event::Refused(MotionRequest::Motion(_), _)
            | Event::Unanswered(MotionRequest::Motion(_)) => {
                operation.take_outcome(Outcome::Failed);
            }
            // The next step requests a motion to the start of a pass again.
            Event::EndedShort { .. } if operation.is_idle() => operation.ended_by_unit(now),
            Event::TrackingEnded { completed: false } => operation.ended_by_unit(now),
            Event::StartedByItself if !uses_auto_track => {
                operation.suspend(Interruption::Elsewhere, now);
            }
            Event::Safety(Safety::ClockStepped { .. }) => {
                antenna.at_work.clock_stop.take_step(steady);
            }
            Event::Safety(Safety::AsksToResume { unlike: None, .. }) => {
                antenna.at_work.clock_stop.take_question(steady);
            }
            Event::Safety(Safety::OffTarget { .. }) => {
                operation.take_outcome(Outcome::OffTarget);
            }
            Event::Safety(Safety::ForeignHands { .. }) => {
                operation.suspend(Interruption::Elsewhere, now);
            }
            Event::Safety(
                Safety::DeadManFired
                | Safety::SessionBroke
                | Safety::NoEffect { .. }
                | Safety::Forbidden { response: Response::Stopped, .. },
            ) => operation.switch_off(OffBecause::Safety),
            // Auto-track starts the pass in the unit.
            Event::Back { found: Found::Tracking, .. } if uses_auto_track => {}
            Event::Safety(
                Safety::AsksToResume { unlike: Some(_), .. } | Safety::UnitDiffers { .. },
            )
            | Event::Back { is_explained: false, .. } => {
                operation.switch_off(OffBecause::NotAsLeft);
            }
            _ => {}
        }
    }

    /// Runs automatic operation of all antennas. A STOP after `turn` was drawn voids the commands
    /// of this call.
    pub(super) fn run_automatic(&mut self, turn: u64) {
        self.current_request =
            Some(CurrentRequest { number: turn, origin: CommandOrigin::Station });
        self.limit_rule_upload();
        for index in 0..self.antennas.len() {
            self.run_automatic_of(index);
        }
        self.current_request = None;
        for index in 0..self.antennas.len() {
            self.tell_automatic(index);
        }
    }

    fn run_automatic_of(&mut self, index: usize) {
        self.resume_after_crash(index);
        let Some(antenna) = self.antennas.get(index) else { return };
        let duties = self.duties(&antenna.shown);
        let wishes = self.wishes(&antenna.shown);
        let mut observation = observe(&antenna.shown, self.steady);
        observation.may_be_planned = observation.offers.is_some() && self.scheduler.is_at_work();
        self.fly(index, &duties, observation);
        let now = self.now;
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        // While the station closes, the operator's choice decides what each antenna does. Before
        // the first schedule, Azel cannot tell why a unit moves.
        if self.closing.is_some() || self.schedule.made_at.is_none() || self.clock_watch.is_in_doubt
        {
            return;
        }
        let operation = &mut antenna.shown.operation;
        let was_proved = operation.is_proved();
        let act = operation.step(&duties, observation, wishes, now);
        if operation.taking().is_some() {
            // From here on, the schedule keeps the pass being taken.
            antenna.at_work.interrupted = None;
        }
        let newly_proved =
            operation.taking().filter(|taking| taking.proved_at.is_some() && !was_proved);
        let newly_proved = newly_proved.map(|taking| taking.pass);
        let id = antenna.shown.id();
        match act {
            Some(Act::Take(duty)) => self.take_pass(index, &duty),
            Some(Act::TakeOver(_)) => self.send(index, driver::Command::TakeOver),
            Some(Act::Park) => self.send(index, driver::Command::Park),
            None => {}
        }
        // The unit now has the pass and may start it on its own.
        if let Some(pass) = newly_proved {
            self.last_run.holds(id, pass);
            self.keep_last_run();
            self.switch_auto_track_on(index);
        }
        self.resume_after_step(index);
        self.run_upkeep(index);
    }

    /// Returns the passes that the schedule gives to an antenna.
    fn duties(&self, antenna: &AntennaModel) -> Vec<Duty> {
        let id = antenna.id();
        let entries = self.schedule.schedule.entries.iter().filter(|entry| entry.antenna == id);
        let between_passes = self.between_passes(antenna);
        entries.map(|entry| duty(entry, between_passes)).collect()
    }

    fn between_passes(&self, antenna: &AntennaModel) -> BetweenPasses {
        between_passes(&self.station, &antenna.config, self.now)
    }

    fn wishes(&self, antenna: &AntennaModel) -> Wishes {
        let scheduling = self.station.scheduling;
        let parks = self.between_passes(antenna) == BetweenPasses::Park && antenna.can_park();
        Wishes {
            parks_within_s: parks.then(|| parks_within_s(&antenna.config)),
            longest_rest_s: scheduling.warn_after_rest_min * 60.0,
            announced_for_s: scheduling.warning_s,
            pass_list_key: self.last_run.held_by(antenna.id()),
        }
    }

    /// Follows the current pass of the schedule and raises an alarm if the antenna is late.
    fn fly(&mut self, index: usize, duties: &[Duty], observation: Observation) {
        let now = self.now;
        let name = |pass: PassListKey| {
            let found = self.pass_lists.find(pass);
            found.map_or_else(
                || pass.0.to_string(),
                |predicted| predicted.satellite.short_name().to_owned(),
            )
        };
        let is_due = |duty: &&Duty| duty.go_at <= now && now < duty.end;
        let due = duties.iter().find(is_due).map(|duty| (*duty, name(duty.pass)));
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let (shown, flight) = (&antenna.shown, &mut antenna.at_work.flight);
        let reason = shown.operation.not_ready().or(observation.not_ready);
        if let Some(flight) = flight {
            flight.see(&shown.operation, observation, now);
        }
        // The departure lies in the future again only after the clock was set back. A pass that the
        // schedule drops before its start is not missed.
        let is_planned =
            |flight: &Flight| duties.iter().any(|duty| is_same_pass(duty.pass, flight.duty.pass));
        flight.take_if(|flight| {
            now < flight.duty.go_at || now < flight.duty.start && !is_planned(flight)
        });
        let ended = flight.take_if(|flight| now >= flight.duty.end);
        let is_off = matches!(shown.operation, Operation::Off(_));
        if flight.is_none() && (!is_off || ended.is_some()) {
            *flight = due.map(|(duty, name)| Flight::new(duty, name));
        }
        let late = flight.as_ref().filter(|flight| {
            let until_s = seconds_between(now, flight.duty.start);
            let is_on_its_way = observation.takes == Some(flight.duty.pass.0);
            let has_time_left = seconds_between(now, flight.duty.end) > WINDOW_STEP_S;
            let is_late = until_s <= LATE_S || reason.is_some();
            shown.operation.is_on() && is_late && has_time_left && !is_on_its_way
        });
        let late = late.map(|flight| (flight.duty.pass, flight.name().to_owned()));
        let antenna_id = Some(shown.id());
        self.alarms.clear(antenna_id, now, |kind| match kind {
            AlarmKind::NotOnItsWay { pass, reason: raised, .. } => {
                *raised != reason
                    || late.as_ref().is_none_or(|(late, _)| !is_same_pass(*late, *pass))
            }
            _ => false,
        });
        if let Some((pass, name)) = late {
            self.alarms.raise(antenna_id, AlarmKind::NotOnItsWay { pass, name, reason }, now);
        }
        if let (Some(flight), Some(id)) = (ended, antenna_id) {
            self.end_flight(id, flight);
        }
    }

    /// Notes the outcome of a pass of the schedule.
    pub(super) fn note_flown(&mut self, antenna: AntennaId, flown: Flown) {
        if let Some(index) = self.place(antenna)
            && let Some(antenna) = self.antennas.get_mut(index)
        {
            antenna.shown.tally.passes.count(&flown);
        }
        self.note_missed_for_hooks(antenna, &flown);
        self.note_day(antenna, DayEvent::Flown(flown));
        self.record_has_grown();
    }

    /// Reports changes of automatic operation since the last turn.
    fn tell_automatic(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let id = antenna.shown.id();
        let operation = antenna.shown.operation.clone();
        let before = antenna.at_work.operation.replace(operation.clone());
        let announced = match &operation {
            Operation::On(On { doing: Doing::Announces { moves_at, pass }, .. }) => {
                Some((*moves_at, *pass))
            }
            _ => None,
        };
        self.alarms.clear(Some(id), self.now, |kind| {
            matches!(kind, AlarmKind::AutomaticMoves { .. }) && announced.is_none()
        });
        if let Some((time, pass)) = announced {
            let name = self.pass_lists.find(pass);
            let name = name
                .map_or_else(String::new, |predicted| predicted.satellite.short_name().to_owned());
            self.alarms.raise(Some(id), AlarmKind::AutomaticMoves { time, name }, self.now);
        }
        if !matches!(operation, Operation::Suspended { .. }) {
            let is_that = |kind: &AlarmKind| matches!(kind, AlarmKind::AutomaticSuspended(_));
            self.alarms.clear(Some(id), self.now, is_that);
        }
        let Some(before) = before else { return };
        let event = match (&before, &operation) {
            (Operation::On(_), Operation::On(_))
            | (Operation::Suspended { .. }, Operation::Suspended { .. }) => return,
            (Operation::Suspended { .. }, Operation::On(_)) => DayEvent::WentOn,
            (_, Operation::On(_)) => DayEvent::SwitchedOn,
            (_, Operation::Suspended { interruption, .. }) => {
                if *interruption != Interruption::ByHand {
                    self.alarms.raise(
                        Some(id),
                        AlarmKind::AutomaticSuspended(*interruption),
                        self.now,
                    );
                }
                DayEvent::Suspended(*interruption)
            }
            (Operation::Off(before), Operation::Off(now)) if before == now => return,
            (_, Operation::Off(because)) => {
                if is_alarming(*because) {
                    self.alarms.raise(Some(id), AlarmKind::AutomaticOff(*because), self.now);
                }
                DayEvent::SwitchedOff(*because)
            }
        };
        match &event {
            DayEvent::SwitchedOn | DayEvent::WentOn => self.keep_switched_off(id, false),
            // The end of the station switches nothing off at the next start.
            DayEvent::SwitchedOff(_) | DayEvent::Suspended(_) if self.closing.is_none() => {
                self.keep_switched_off(id, true);
            }
            _ => {}
        }
        self.note_day(id, event);
        // Azel no longer watches the unit, so the unit must not start its pass on its own.
        if before.is_on() && !operation.is_on() {
            self.end_auto_track(index);
        }
    }

    /// Notes that a new session begins with automatic operation off.
    pub(super) fn note_reopened(&mut self, index: usize) {
        let Some(id) = self.antennas.get(index).map(|antenna| antenna.shown.id()) else { return };
        if self.last_run.is_switched_on(id) {
            self.keep_switched_off(id, true);
        }
    }

    pub(super) fn keep_switched_off(&mut self, id: AntennaId, is_off: bool) {
        self.last_run.note_switch(id, !is_off);
        self.last_run.station = resumption::fingerprint(&self.station);
        self.keep_last_run();
    }

    fn note_day(&mut self, antenna: AntennaId, day_event: DayEvent) {
        tracing::info!(?antenna, ?day_event, "automatic operation");
        let line = DayLine { time: self.now, antenna, event: day_event };
        self.recording.day_line(&line, self.clock.now());
        day::add(&mut self.day, line);
    }
}

fn duty(entry: &Entry, between_passes: BetweenPasses) -> Duty {
    Duty {
        pass: (entry.pass.satellite, entry.pass.aos),
        start: entry.start,
        end: entry.end,
        go_at: sets_out(entry, between_passes),
        counted_s: entry.counted_s,
        lost_at: entry.lost.map(|lost| lost.loss),
        begins_late: entry.late_s > 0.0,
        ends_early: entry.early_s > 0.0,
    }
}

#[cfg(test)]
pub(super) mod tests;
