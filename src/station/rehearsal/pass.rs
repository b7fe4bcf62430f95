//! Outcome of each pass of the plan.

use jiff::Timestamp;

use super::Rehearsal;
use crate::{
    astro::time::seconds_between,
    contract::{
        Snapshot,
        automatic::{DayEvent, DayLine, Flown},
        rehearsal::{Rehearsed, RehearsedPass},
    },
    plan::schedule::{Entry, PassKey},
    record::PassNote,
    station::{AntennaId, Station},
};

/// Max difference in AOS of the same pass after newer elements or another search, seconds.
const SAME_AOS_S: f64 = 60.0;
/// Max delay of the report after the end of a pass, seconds.
const REPORTED_AFTER_S: f64 = 10.0;

fn is_pass(pass: &RehearsedPass, antenna: AntennaId, satellite: u32, aos: Timestamp) -> bool {
    let is_same_aos = || seconds_between(pass.aos, aos).abs() < SAME_AOS_S;
    pass.antenna == antenna && pass.satellite == satellite && is_same_aos()
}

/// Passes of a running rehearsal.
pub(super) struct Passes {
    start: Timestamp,
    end: Timestamp,
    list: Vec<RehearsedPass>,
    /// Revision of the last plan that was read.
    revision: u64,
    /// Lines in which an antenna's automatic operation ended or was suspended.
    interruptions: Vec<DayLine>,
    /// Time of the last line of the day that was read.
    day_until: Option<Timestamp>,
}

impl Passes {
    pub(super) fn new(start: Timestamp, end: Timestamp) -> Self {
        Self {
            start,
            end,
            list: Vec::new(),
            revision: 0,
            interruptions: Vec::new(),
            day_until: None,
        }
    }

    pub(super) fn end(&self) -> Timestamp {
        self.end
    }

    /// Returns `true` if no pass is under way at `now`.
    pub(super) fn are_over(&self, now: Timestamp) -> bool {
        let is_over = |rehearsed_pass: &RehearsedPass| {
            rehearsed_pass.is_given_up
                || seconds_between(rehearsed_pass.end.max(rehearsed_pass.los), now)
                    > REPORTED_AFTER_S
        };
        self.list.iter().all(is_over)
    }

    /// Adopts the passes of a new plan.
    pub(super) fn take_plan(&mut self, snapshot: &Snapshot) {
        let planned = &snapshot.schedule;
        if planned.revision == self.revision {
            return;
        }
        self.revision = planned.revision;
        for pass in self.list.iter_mut().filter(|pass| pass.start > snapshot.moment.utc) {
            pass.is_given_up = true;
        }
        let entries = planned.schedule.entries.iter();
        for entry in entries.filter(|entry| self.start <= entry.start && entry.start < self.end) {
            let PassKey { satellite, aos } = entry.pass;
            match self
                .list
                .iter_mut()
                .find(|rehearsed_pass| is_pass(rehearsed_pass, entry.antenna, satellite, aos))
            {
                Some(recorded) => {
                    (recorded.start, recorded.end) = (entry.start, entry.end);
                    recorded.is_given_up = false;
                }
                None => self.list.push(planned_pass(entry, snapshot)),
            }
        }
    }

    /// Reads the new lines of the day.
    pub(super) fn take_day(&mut self, day: &[DayLine]) {
        // Lines of one turn have the same time and arrive together.
        let start = self.day_until;
        let news = day.iter().filter(|line| start.is_none_or(|start| line.time > start));
        for line in news {
            match &line.event {
                DayEvent::SwitchedOff(_) | DayEvent::Suspended(_) => {
                    self.interruptions.push(line.clone());
                }
                DayEvent::SwitchedOn
                | DayEvent::WentOn
                | DayEvent::ClockSet { .. }
                | DayEvent::ClockNotSet { .. }
                | DayEvent::ElementsUploaded { .. }
                | DayEvent::ElementsNotUploaded { .. } => {}
                DayEvent::Flown(flown) => self.take_flown(line.antenna, flown),
            }
        }
        self.day_until = day.last().map(|line| line.time).or(start);
    }

    fn take_flown(&mut self, antenna: AntennaId, flown: &Flown) {
        let (satellite, aos) = flown.pass;
        if let Some(pass) = self
            .list
            .iter_mut()
            .find(|rehearsed_pass| is_pass(rehearsed_pass, antenna, satellite, aos))
        {
            pass.flown = Some(flown.clone());
        }
    }

    pub(super) fn take_report(&mut self, note: PassNote) {
        let report = note.report;
        let is_its = |rehearsed_pass: &&mut RehearsedPass| {
            rehearsed_pass.antenna == note.antenna
                && rehearsed_pass.satellite == report.elements.catalog_number()
                && rehearsed_pass.start < report.end
                && report.start < rehearsed_pass.end
        };
        if let Some(pass) = self.list.iter_mut().find(is_its) {
            pass.report = Some(report);
        }
    }

    pub(super) fn rehearsed(
        self,
        rehearsal: &Rehearsal,
        station: &Station,
        left_out: Vec<String>,
    ) -> Rehearsed {
        let Self { list: mut passes, interruptions, .. } = self;
        for pass in &mut passes {
            let antenna = station.antennas.iter().find(|antenna| antenna.id == pass.antenna);
            let lines = interruptions.iter().filter(|line| line.antenna == pass.antenna);
            let reasons =
                lines.filter(|line| line.time <= pass.end).filter_map(|line| match line.event {
                    DayEvent::SwitchedOff(because) => Some(because),
                    _ => None,
                });
            pass.off_reason = reasons.reduce(|_, later| later).filter(|_| pass.flown.is_none());
            pass.antenna_name = antenna.map(|antenna| antenna.name.clone()).unwrap_or_default();
        }
        passes.sort_by_key(|pass| (pass.start, pass.antenna, pass.satellite));
        Rehearsed {
            start: rehearsal.start,
            hours: rehearsal.hours,
            seed: rehearsal.seed,
            passes,
            interruptions,
            left_out,
        }
    }
}

fn planned_pass(entry: &Entry, snapshot: &Snapshot) -> RehearsedPass {
    let PassKey { satellite, aos } = entry.pass;
    let predicted = snapshot.pass_lists.find((satellite, aos));
    let name = predicted.map(|predicted| predicted.satellite.short_name().to_owned());
    RehearsedPass {
        antenna: entry.antenna,
        antenna_name: String::new(),
        satellite,
        satellite_name: name.unwrap_or_else(|| satellite.to_string()),
        aos,
        los: predicted.map_or(entry.end, |predicted| predicted.pass.los.time),
        start: entry.start,
        end: entry.end,
        promised_s: entry.counted_s,
        is_given_up: false,
        flown: None,
        off_reason: None,
        report: None,
    }
}
