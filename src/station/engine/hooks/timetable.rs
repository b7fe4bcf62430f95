//! Times of the calls of hooks, without I/O: the plan and the events of a station come in, and the
//! calls that are due come out.
//!
//! Each hook calls once for an event. AOS and LOS follow the plan until the call: a pass that moves
//! takes its calls along, and a pass that the plan drops before AOS loses them. Once a hook has
//! called for a pass, the LOS of that pass also calls, so that a program that started something can
//! end it.

use std::collections::VecDeque;

use jiff::Timestamp;

use super::values::{HookPass, PlanState};
use crate::{
    astro::time::{add_seconds, seconds_between},
    clock::{Instant, Moment},
    contract::{alarms::AlarmKind, automatic::Flown},
    station::{AntennaId, Hook, HookEvent, Station},
};

/// Max delay of a call, seconds. A clock that jumps further drops the call.
const LATE_S: f64 = 30.0;
/// Max time from a pass to an event that belongs to it, seconds.
const NEAR_S: f64 = 600.0;
/// Max number of remembered calls: the calls of a day with many hooks.
const MAX_CALLED: usize = 4096;
/// Max number of calls that wait for their lag.
const MAX_WAITING: usize = 1000;

/// Event for which a hook calls.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Occurrence {
    pub(super) event: HookEvent,
    pub(super) time: Timestamp,
    pub(super) antenna: Option<AntennaId>,
    pub(super) pass: Option<HookPass>,
    pub(super) matter: Matter,
}

/// Content of an event besides its pass.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) enum Matter {
    #[default]
    None,
    Missed(Box<Flown>),
    Alarm(Box<AlarmKind>),
}

/// Call of a hook that is due now.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DueCall {
    pub(super) hook: Hook,
    pub(super) occurrence: Occurrence,
    /// The time of the call has passed by more than the max delay: the hook does not call.
    pub(super) is_too_late: bool,
}

/// Pass with calls to come.
struct Armed {
    pass: HookPass,
    known_since: Timestamp,
    /// `true` once a hook has called for the pass.
    has_called: bool,
    /// `true` if the plan has dropped the pass before AOS.
    is_dropped: bool,
}

/// Call that a hook has made, so that it does not call again.
struct Called {
    hook: String,
    event: HookEvent,
    /// Antenna of the pass; `None` for a hook of all antennas, which calls once for a pass.
    antenna: Option<AntennaId>,
    satellite: u32,
    aos: Timestamp,
    los: Timestamp,
}

/// Call after an event that no plan contains.
struct Waiting {
    hook: String,
    due: Instant,
    occurrence: Occurrence,
}

pub(super) struct Timetable {
    /// Start of the station. An earlier run has made the calls that were due before.
    begun: Timestamp,
    passes: Vec<Armed>,
    called: VecDeque<Called>,
    waiting: Vec<Waiting>,
}

impl Timetable {
    pub(super) fn new(begun: Timestamp) -> Self {
        Self { begun, passes: Vec::new(), called: VecDeque::new(), waiting: Vec::new() }
    }

    /// Returns the pass of an antenna's satellite that is up at `time`, or not long before or after.
    pub(super) fn pass(
        &self,
        antenna: AntennaId,
        satellite: u32,
        time: Timestamp,
    ) -> Option<&HookPass> {
        let passes = self.passes.iter().map(|armed| &armed.pass);
        let own = passes.filter(|pass| pass.antenna == antenna && pass.satellite == satellite);
        let away_s = |pass: &HookPass| {
            seconds_between(time, pass.aos).max(seconds_between(pass.los, time)).max(0.0)
        };
        let near = own.filter(|pass| away_s(pass) <= NEAR_S);
        near.min_by(|one, other| away_s(one).total_cmp(&away_s(other)))
    }

    /// Adds the report of a pass to the calls to come.
    pub(super) fn add_report(
        &mut self,
        antenna: AntennaId,
        satellite: u32,
        (start, end): (Timestamp, Timestamp),
        report: &super::values::ReportValues,
    ) {
        let is_its = |pass: &HookPass| {
            let is_own = pass.antenna == antenna && pass.satellite == satellite;
            is_own && pass.aos < end && start < pass.los
        };
        let waiting = self.waiting.iter_mut().filter_map(|wait| wait.occurrence.pass.as_mut());
        let armed = self.passes.iter_mut().map(|armed| &mut armed.pass);
        for pass in armed.chain(waiting).filter(|pass| is_its(pass)) {
            pass.report = Some(report.clone());
        }
    }

    /// Takes the passes of the present plan.
    pub(super) fn follow(&mut self, passes: Vec<HookPass>, now: Timestamp) {
        let mut is_planned = vec![false; self.passes.len()];
        for pass in passes {
            let place = self.passes.iter().position(|armed| armed.pass.is_same(&pass));
            let Some(place) = place else {
                if now < pass.los {
                    self.passes.push(Armed {
                        pass,
                        known_since: now,
                        has_called: false,
                        is_dropped: false,
                    });
                    is_planned.push(true);
                }
                continue;
            };
            if let Some(armed) = self.passes.get_mut(place) {
                // A list that begins during the pass does not have its AOS.
                let aos = if pass.has_aos { pass.aos } else { armed.pass.aos };
                let has_aos = pass.has_aos || armed.pass.has_aos;
                let report = armed.pass.report.take();
                armed.pass = HookPass { aos, has_aos, report, ..pass };
                armed.is_dropped = false;
            }
            if let Some(is_planned) = is_planned.get_mut(place) {
                *is_planned = true;
            }
        }
        let mut is_planned = is_planned.into_iter();
        self.passes.retain_mut(|armed| {
            if is_planned.next() == Some(true) {
                return true;
            }
            if now < armed.pass.los {
                armed.pass.plan = PlanState::Dropped;
                armed.is_dropped |= now < armed.pass.aos;
            }
            armed.has_called || armed.pass.aos <= now
        });
    }

    /// Takes an event that no plan contains.
    pub(super) fn note(&mut self, occurrence: &Occurrence, station: &Station, moment: Moment) {
        let satellite = occurrence.pass.as_ref().map(|pass| pass.satellite);
        let hooks = station
            .hooks
            .iter()
            .filter(|hook| hook.matches(station, occurrence.event, occurrence.antenna, satellite));
        for hook in hooks {
            if self.waiting.len() >= MAX_WAITING {
                return tracing::error!(hook = hook.name, "too many hooks wait for their lag");
            }
            let due = moment.steady + hook.lag();
            let (hook, occurrence) = (hook.name.clone(), occurrence.clone());
            self.waiting.push(Waiting { hook, due, occurrence });
        }
    }

    /// Returns the calls that are due, each of them once.
    pub(super) fn due(&mut self, station: &Station, moment: Moment) -> Vec<DueCall> {
        let mut due = self.due_after_lag(station, moment);
        let now = moment.utc;
        for place in 0..self.passes.len() {
            for event in [HookEvent::Aos, HookEvent::Los] {
                for hook in &station.hooks {
                    due.extend(self.due_call(place, event, hook, station, now));
                }
            }
        }
        let end_s = *Hook::DELAY_S.end() + LATE_S;
        self.passes.retain(|armed| seconds_between(armed.pass.los, now) <= end_s);
        due
    }

    fn due_after_lag(&mut self, station: &Station, moment: Moment) -> Vec<DueCall> {
        let is_due = |waiting: &mut Waiting| waiting.due <= moment.steady;
        let due = self.waiting.extract_if(.., is_due);
        let call = |Waiting { hook, due, occurrence }: Waiting| {
            // The operator may have changed or removed the hook.
            let hook = station.hooks.iter().find(|other| other.name == hook && other.is_on)?;
            let planned = add_seconds(occurrence.time, hook.delay_s);
            let late_s = seconds_between(planned, moment.utc);
            let steady_late_s = moment.steady.saturating_duration_since(due).as_secs_f64();
            let is_too_late = late_s.max(steady_late_s) > LATE_S;
            Some(DueCall { hook: hook.clone(), occurrence, is_too_late })
        };
        due.filter_map(call).collect()
    }

    /// Returns the call of a hook for AOS or LOS of a pass, if it is due.
    fn due_call(
        &mut self,
        place: usize,
        event: HookEvent,
        hook: &Hook,
        station: &Station,
        now: Timestamp,
    ) -> Option<DueCall> {
        let armed = self.passes.get_mut(place)?;
        let pass = &armed.pass;
        if !hook.matches(station, event, Some(pass.antenna), Some(pass.satellite)) {
            return None;
        }
        let (time, is_known) = if event == HookEvent::Aos {
            (pass.aos, pass.has_aos && !armed.is_dropped)
        } else {
            (pass.los, pass.has_los)
        };
        let planned = add_seconds(time, hook.delay_s);
        if !is_known || planned > now || planned < self.begun {
            return None;
        }
        let antenna = hook.antenna.map(|_| pass.antenna);
        let has_called = self.called.iter().any(|called| {
            let is_its = called.hook == hook.name && called.event == event;
            let is_pass = called.satellite == pass.satellite
                && called.antenna == antenna
                && called.aos < pass.los
                && pass.aos < called.los;
            is_its && is_pass
        });
        if has_called {
            return None;
        }
        // A pass that the plan takes within the lead still gets its call before the event.
        let latest = planned.max(time);
        let is_too_late = seconds_between(latest, now) > LATE_S;
        if is_too_late && seconds_between(latest, armed.known_since) > LATE_S {
            return None;
        }
        armed.has_called |= !is_too_late;
        let occurrence = Occurrence {
            event,
            time,
            antenna: Some(pass.antenna),
            pass: Some(pass.clone()),
            matter: Matter::None,
        };
        if self.called.len() >= MAX_CALLED {
            self.called.pop_front();
        }
        let (satellite, aos, los) = (pass.satellite, pass.aos, pass.los);
        self.called.push_back(Called {
            hook: hook.name.clone(),
            event,
            antenna,
            satellite,
            aos,
            los,
        });
        Some(DueCall { hook: hook.clone(), occurrence, is_too_late })
    }
}

#[cfg(test)]
mod tests;
