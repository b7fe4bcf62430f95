//! Hooks: the calls that are due, their results, and the trial of a hook in Preferences.

mod runner;
mod timetable;
mod values;

use std::collections::BTreeMap;

use jiff::Timestamp;

use self::{
    runner::{Call, MAX_CALLS},
    timetable::{DueCall, Matter, Occurrence, Timetable},
    values::{HookPass, PlanState, ReportValues, Values},
};
use super::{Antenna, Engine, StationClaim};
use crate::{
    astro::time::add_seconds,
    clock::Moment,
    contract::{
        alarms::Priority,
        automatic::Flown,
        hooks::{HookOutcome, HookRun, HookState, NotRun},
        passes::{PassList, PassListKey, PredictedPass},
    },
    job::Job,
    plan::schedule::Entry,
    record::PassNote,
    station::{AntennaId, Hook, HookEvent},
};

/// Max number of calls in the snapshot.
const MAX_SHOWN: usize = 50;

/// Time before AOS from which hooks follow a pass, seconds: the max lead and some time for a plan
/// that changes.
const AHEAD_S: f64 = 660.0;

/// State of the hooks of a station.
pub(super) struct Hooks {
    /// `false` in a rehearsal, which calls nothing.
    is_enabled: bool,
    timetable: Timetable,
    /// Calls under way.
    calls: Vec<(HookRun, Option<Job<HookOutcome>>)>,
    /// Last calls, the newest last.
    shown: Vec<HookRun>,
    next_number: u64,
    /// Second of the last look at the plan.
    looked_at: i64,
    /// Id of the newest alarm that the hooks know.
    newest_alarm: Option<u64>,
    /// Satellite that each antenna tracks.
    tracked: BTreeMap<AntennaId, u32>,
}

impl Hooks {
    pub(super) fn new(begun: Timestamp) -> Self {
        Self {
            is_enabled: false,
            timetable: Timetable::new(begun),
            calls: Vec::new(),
            shown: Vec::new(),
            next_number: 0,
            looked_at: 0,
            newest_alarm: None,
            tracked: BTreeMap::new(),
        }
    }

    /// Lets the hooks call. Rehearsals never do this.
    pub(super) fn enable(&mut self) {
        self.is_enabled = true;
    }

    /// Returns the last calls, the newest last.
    pub(super) fn shown(&self) -> &Vec<HookRun> {
        &self.shown
    }

    fn show(&mut self, run: HookRun) {
        match self.shown.iter_mut().find(|shown| shown.number == run.number) {
            Some(shown) => *shown = run,
            None => self.shown.push(run),
        }
        let excess = self.shown.len().saturating_sub(MAX_SHOWN);
        self.shown.drain(..excess);
    }
}

impl Engine {
    /// Takes the results of ended calls, and makes the calls that are due.
    pub(super) fn run_hooks(&mut self) {
        self.take_hook_results();
        let events = self.hook_events();
        // The demo has no hooks of the operator, and another Azel that has the station calls them.
        let is_ours = self.demo.is_none() && !matches!(self.station_claim, StationClaim::Theirs(_));
        if !self.hooks.is_enabled || !is_ours || self.station.hooks.is_empty() {
            return;
        }
        let moment = Moment { utc: self.now, steady: self.steady };
        for event in &events {
            self.hooks.timetable.note(event, &self.station, moment);
        }
        // Calls start within a second of their time; a check of the plan in each turn costs more.
        let second = self.now.as_second();
        if events.is_empty() && second == self.hooks.looked_at {
            return;
        }
        self.hooks.looked_at = second;
        let passes = self.hook_passes();
        self.hooks.timetable.follow(passes, self.now);
        for DueCall { hook, occurrence, is_too_late } in
            self.hooks.timetable.due(&self.station, moment)
        {
            let reason = is_too_late.then_some(NotRun::TooLate);
            self.call_hook(&hook, &occurrence, false, reason);
        }
    }

    /// Notes a pass that automatic operation should have tracked but did not.
    pub(super) fn note_missed_for_hooks(&mut self, antenna: AntennaId, flown: &Flown) {
        if flown.in_beam_s > 0.0 {
            return;
        }
        let (number, aos) = flown.pass;
        let pass = self.hooks.timetable.pass(antenna, number, aos).cloned();
        let pass = pass.or_else(|| self.hook_pass(antenna, flown.pass));
        let occurrence = Occurrence {
            event: HookEvent::MissedPass,
            time: self.now,
            antenna: Some(antenna),
            pass,
            matter: Matter::Missed(Box::new(flown.clone())),
        };
        let moment = Moment { utc: self.now, steady: self.steady };
        self.hooks.timetable.note(&occurrence, &self.station, moment);
        // The next turn makes the call.
        self.hooks.looked_at = 0;
    }

    /// Gives the report of a pass to the hooks of its LOS.
    pub(super) fn report_to_hooks(&mut self, note: &PassNote) {
        let report = ReportValues::new(&note.report);
        let satellite = note.report.elements.catalog_number();
        let span = (note.report.start, note.report.end);
        self.hooks.timetable.add_report(note.antenna, satellite, span, &report);
    }

    /// Calls a hook once with values of a sample pass. Only the operator at this machine may do so.
    pub(super) fn try_hook(&mut self, hook: &Hook) {
        if !self.hooks.is_enabled {
            return;
        }
        let antenna = hook.antenna.or_else(|| Some(self.antennas.first()?.shown.id()));
        let satellites = &self.pass_lists.favourites;
        let next = satellites.upcoming(self.now).iter().find(|predicted| {
            hook.matches(&self.station, hook.event, antenna, Some(predicted.number()))
        });
        let sample_antenna = antenna.unwrap_or(AntennaId::FIRST);
        let pass = match next {
            Some(predicted) => HookPass::new(predicted, sample_antenna, PlanState::Automatic),
            None => HookPass::sample(sample_antenna, self.now),
        };
        let pass = Some(pass).filter(|_| hook.event != HookEvent::Alarm);
        let event = hook.event;
        let occurrence = Occurrence { event, time: self.now, antenna, pass, matter: Matter::None };
        self.call_hook(hook, &occurrence, true, None);
    }

    fn call_hook(
        &mut self,
        hook: &Hook,
        occurrence: &Occurrence,
        is_trial: bool,
        mut reason: Option<NotRun>,
    ) {
        let calls = self.hooks.calls.iter().filter(|(run, _)| run.hook == hook.name).count();
        if reason.is_none() && calls >= MAX_CALLS {
            reason = Some(NotRun::Busy);
        }
        let number = self.hooks.next_number;
        self.hooks.next_number += 1;
        let pass = occurrence.pass.as_ref();
        let run = HookRun {
            number,
            hook: hook.name.clone(),
            event: occurrence.event,
            time: occurrence.time,
            started: self.now,
            antenna: occurrence.antenna,
            pass: pass.map(|pass| (pass.satellite, pass.aos)),
            satellite: pass.map(|pass| pass.name.clone()),
            is_trial,
            state: reason.map_or(HookState::Running, HookState::NotRun),
        };
        self.hooks.show(run.clone());
        if let Some(reason) = reason {
            tracing::warn!(hook = run.hook, ?reason, "a hook is not called");
            return self.recording.hook(&run, self.clock.now());
        }
        let antennas = self.antennas.iter().map(|antenna| &antenna.shown);
        let values = Values::new(&self.station, antennas, hook, occurrence, is_trial);
        let call = Call {
            action: hook.action.clone(),
            timeout: hook.timeout(),
            environment: values.environment(),
            json: values.json(),
        };
        tracing::info!(hook = run.hook, event = run.event.word(), is_trial, "a hook is called");
        self.hooks.calls.push((run, Some(runner::start(call, &self.wake))));
    }

    fn take_hook_results(&mut self) {
        let moment = self.clock.now();
        for (run, job) in &mut self.hooks.calls {
            if let Some(end) = Job::take(job) {
                run.state = HookState::Ended(runner::outcome(end));
            }
        }
        let ended: Vec<_> = self.hooks.calls.extract_if(.., |(_, job)| job.is_none()).collect();
        for (run, _) in ended {
            if run.is_failure() {
                tracing::warn!(hook = run.hook, state = ?run.state, "a hook has failed");
            }
            self.recording.hook(&run, moment);
            self.hooks.show(run);
        }
    }

    /// Returns the events since the last turn that no plan contains.
    fn hook_events(&mut self) -> Vec<Occurrence> {
        let mut events = Vec::new();
        let now = self.now;
        for antenna in &self.antennas {
            let (shown, id) = (&antenna.shown, antenna.shown.id());
            let satellite = shown.tracked_number().filter(|_| shown.tracks());
            let previous = match satellite {
                Some(number) => self.hooks.tracked.insert(id, number),
                None => self.hooks.tracked.remove(&id),
            };
            if previous == satellite {
                continue;
            }
            let changes = [
                previous.map(|number| (HookEvent::TrackingEnd, number)),
                satellite.map(|number| (HookEvent::TrackingStart, number)),
            ];
            for (event, number) in changes.into_iter().flatten() {
                let pass = self.hooks.timetable.pass(id, number, now).cloned();
                let pass = pass.or_else(|| self.hook_pass(id, (number, now)));
                let matter = Matter::None;
                events.push(Occurrence { event, time: now, antenna: Some(id), pass, matter });
            }
        }
        let alarms = self.alarms.list();
        // Alarms of the start belong to this run too.
        let newest = self.hooks.newest_alarm;
        let is_new = |id: u64| newest.is_none_or(|newest| id > newest);
        let first = alarms.iter().filter(|alarm| is_new(alarm.id));
        for alarm in first.filter(|alarm| alarm.priority() == Priority::First) {
            events.push(Occurrence {
                event: HookEvent::Alarm,
                time: alarm.last,
                antenna: alarm.antenna,
                pass: None,
                matter: Matter::Alarm(Box::new(alarm.kind.clone())),
            });
        }
        self.hooks.newest_alarm = alarms.iter().map(|alarm| alarm.id).max().max(newest);
        events
    }

    /// Returns the passes that the plan gives to antennas, and the passes that antennas are
    /// commanded to track.
    fn hook_passes(&self) -> Vec<HookPass> {
        let last = add_seconds(self.now, AHEAD_S);
        let entries = self.schedule.schedule.entries.iter();
        let entries = entries.filter(|entry| entry.pass.aos <= last);
        let planned = entries.filter_map(|entry: &Entry| {
            let key = (entry.pass.satellite, entry.pass.aos);
            self.hook_pass(entry.antenna, key)
        });
        let mut passes: Vec<HookPass> = planned.collect();
        for antenna in &self.antennas {
            let (shown, id) = (&antenna.shown, antenna.shown.id());
            let Some(number) = shown.commanded_number().filter(|number| shown.takes(*number))
            else {
                continue;
            };
            let commanded = self.hook_pass(id, (number, self.now));
            let commanded = commanded.filter(|pass| pass.aos <= last);
            passes.extend(commanded.filter(|pass| !passes.iter().any(|other| other.is_same(pass))));
        }
        passes
    }

    /// Returns the pass of a satellite with this AOS, or else its current or next pass.
    fn hook_pass(&self, antenna: AntennaId, (number, aos): PassListKey) -> Option<HookPass> {
        let lists = &self.pass_lists;
        let predicted = lists.find((number, aos)).or_else(|| {
            let of_list = |list: &PassList| {
                list.passes.iter().position(|predicted| {
                    predicted.number() == number && predicted.pass.los.time > aos
                })
            };
            let first = of_list(&lists.favourites);
            let first = first.and_then(|place| lists.favourites.passes.get(place));
            first.or_else(|| lists.all.passes.get(of_list(&lists.all)?))
        })?;
        let place = self.place(antenna)?;
        let plan = self.antennas.get(place).map(|antenna| self.plan_state(antenna, predicted))?;
        Some(HookPass::new(predicted, antenna, plan))
    }

    fn plan_state(&self, antenna: &Antenna, predicted: &PredictedPass) -> PlanState {
        let (shown, id) = (&antenna.shown, antenna.shown.id());
        let pass = &predicted.pass;
        let is_planned = self.schedule.schedule.entries.iter().any(|entry| {
            let is_own = entry.antenna == id && entry.pass.satellite == predicted.number();
            is_own && entry.start < pass.los.time && pass.aos.time < entry.end
        });
        if is_planned && shown.operation.is_on() {
            PlanState::Automatic
        } else if shown.takes(predicted.number()) {
            PlanState::Commanded
        } else if is_planned {
            PlanState::Planned
        } else {
            PlanState::Dropped
        }
    }
}
