//! Schedule of the station: a thread makes a new one whenever its inputs change.

use std::sync::Arc;

use jiff::Timestamp;
use rayon::prelude::*;

use super::{Engine, automatic::is_same_pass};
use crate::{
    astro::time::{DAY_S, add_seconds, seconds_between},
    contract::{
        alarms::{AlarmKind, Work},
        antenna::AntennaModel,
        driver::LinkState,
        passes::{PassListKey, PredictedPass},
        schedule::{Planned, Swap},
    },
    engine::alarms::KeepAlarms,
    job::Job,
    plan::schedule::{
        self, AntennaOff, Candidate, Common, Entry, Partial, PlannedAntenna, Reach, Request,
        Schedule, Steadiness, changes, plan,
    },
    station::{AntennaId, Station, Take},
};

/// Min gain of a schedule change, so that a shift of a minute does not change the schedule.
const STEADINESS: Steadiness = Steadiness { percent: 3, seconds: 10 };

/// Max difference in the end of two equal entries, seconds.
const MOVED_S: f64 = 1.0;

/// Inputs of a schedule, besides the time.
#[derive(Clone)]
pub(super) struct Inputs {
    station: Arc<Station>,
    passes: Arc<Vec<PredictedPass>>,
    /// Revision of `passes`.
    revision: u64,
    /// Antennas that take no passes.
    disabled: Vec<(AntennaId, AntennaOff)>,
    /// Satellites that antennas track without automatic operation.
    tracked: Vec<Tracked>,
    /// Passes that antennas were taking before the start of this run and may resume.
    interrupted: Vec<(AntennaId, PassListKey)>,
    /// Antennas with known positions, with their learned axis rates in degrees per second.
    placed: Vec<(AntennaId, Option<[f64; 2]>)>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Tracked {
    antenna: AntennaId,
    satellite: u32,
    /// Start of the pass that the unit was commanded to track.
    start: Option<Timestamp>,
}

impl PartialEq for Inputs {
    fn eq(&self, other: &Self) -> bool {
        self.revision == other.revision
            && self.disabled == other.disabled
            && self.tracked == other.tracked
            && self.interrupted == other.interrupted
            && self.placed == other.placed
            && (Arc::ptr_eq(&self.station, &other.station) || self.station == other.station)
    }
}

/// Current or last run of the scheduler.
struct Begun {
    inputs: Inputs,
    time: Timestamp,
    /// Entries that the schedule must keep.
    fixed: Vec<Entry>,
}

/// Scheduler that makes one schedule at a time.
#[derive(Default)]
pub(super) struct Scheduler {
    running: Option<Job<Schedule>>,
    begun: Option<Begun>,
    swap_running: Option<Job<Swap>>,
    swap: Option<Arc<Swap>>,
}

impl Scheduler {
    pub(super) fn swap(&self) -> Option<Arc<Swap>> {
        self.swap.clone()
    }

    /// Returns `true` while a schedule is being made.
    pub(super) fn is_at_work(&self) -> bool {
        self.running.is_some()
    }
}

impl Engine {
    /// Adopts a finished schedule, and starts a new one if the inputs have changed.
    pub(super) fn look_after_schedule(&mut self) {
        self.take_schedule();
        if self.scheduler.running.is_some() {
            return;
        }
        let Some(inputs) = self.schedule_inputs() else { return };
        if self.scheduler.begun.as_ref().is_some_and(|begun| begun.inputs == inputs) {
            return;
        }
        let antennas = self.planned_antennas(&inputs);
        let (search_inputs, now) = (inputs.clone(), self.now);
        let (previous, fixed) = (Arc::clone(&self.schedule), self.fixed());
        let entries = fixed.clone();
        let job = Job::start("azel-schedule", Arc::clone(&self.wake), move |_| {
            make(&search_inputs, &antennas, &previous.schedule, &entries, now)
        });
        self.scheduler.running = Some(job);
        self.scheduler.begun = Some(Begun { inputs, time: now, fixed });
    }

    /// Returns the current inputs of a schedule; `None` before the passes are known.
    fn schedule_inputs(&self) -> Option<Inputs> {
        let list = &self.pass_lists.favourites;
        list.made_at?;
        let disabled = self.antennas.iter().filter_map(|antenna| {
            let snapshot = &antenna.shown.snapshot;
            let antenna_off = match snapshot.link {
                _ if snapshot.lock_out.is_some() => AntennaOff::LockedOut,
                LinkState::Off => AntennaOff::SwitchedOff,
                _ => return None,
            };
            Some((antenna.shown.id(), antenna_off))
        });
        let tracked = self.antennas.iter().filter_map(|antenna| {
            let shown = &antenna.shown;
            let satellite = shown.tracked_number().filter(|number| shown.takes(*number))?;
            // Automatic operation's current pass is a fixed entry, and a pass that it has ended is
            // not tracked.
            let is_by_hand = !shown.operation.is_on() || shown.tracks_unasked();
            let target = shown.snapshot.target.as_ref();
            let target = target.filter(|target| target.catalog_number == satellite);
            let start = target.map(|target| target.start);
            is_by_hand.then_some(Tracked { antenna: shown.id(), satellite, start })
        });
        let is_placed = |antenna: &&super::Antenna| stands_deg(&antenna.shown).is_some();
        let placed = self.antennas.iter().filter(is_placed);
        let placed = placed.map(|antenna| (antenna.shown.id(), antenna.shown.snapshot.rates_deg_s));
        Some(Inputs {
            station: Arc::clone(&self.station),
            passes: Arc::clone(&list.passes),
            revision: list.revision,
            disabled: disabled.collect(),
            tracked: tracked.collect(),
            interrupted: self.interrupted_passes(),
            placed: placed.collect(),
        })
    }

    /// Starts computing the cost of always taking a pass: makes the schedule that would follow from
    /// that choice.
    pub(super) fn price_swap(&mut self, pass: PassListKey) {
        // Do not use the last schedule's inputs: an antenna may have begun to track since.
        let Some(mut inputs) = self.schedule_inputs() else { return };
        let mut listed = inputs.passes.iter();
        let Some(tca) = listed
            .find(|predicted| predicted.key() == pass)
            .map(|predicted| predicted.pass.tca.time)
        else {
            return;
        };
        let mut station = Station::clone(&inputs.station);
        station.choose_pass(pass.0, tca, Some(Take::Always), self.now);
        inputs.station = Arc::new(station);
        let antennas = self.planned_antennas(&inputs);
        let (planned, fixed, now) = (Arc::clone(&self.schedule), self.fixed(), self.now);
        let key = schedule::PassKey { satellite: pass.0, aos: pass.1 };
        let job = Job::start("azel-swap", Arc::clone(&self.wake), move |_| {
            let made = make(&inputs, &antennas, &planned.schedule, &fixed, now);
            let is_taken = made.entries_of(key).next().is_some();
            let changes = is_taken.then(|| changes(&planned.schedule, &made, now));
            Swap { pass, revision: planned.revision, changes }
        });
        self.scheduler.swap_running = Some(job);
    }

    fn take_schedule(&mut self) {
        if let Some(Ok(swap)) = Job::take(&mut self.scheduler.swap_running) {
            self.scheduler.swap = Some(Arc::new(swap));
        }
        let Some(end) = Job::take(&mut self.scheduler.running) else { return };
        let kind = AlarmKind::BrokeOff(Work::Schedule);
        let Ok(schedule) = end else {
            return self.alarms.raise(None, kind, self.now);
        };
        self.alarms.clear(None, self.now, |alarm_kind| *alarm_kind == kind);
        let fixed = self.fixed();
        let begun =
            self.scheduler.begun.take_if(|begun| gives_away(&schedule, &begun.fixed, &fixed));
        if begun.is_some() {
            // Make a new schedule that keeps the passes begun since.
            return;
        }
        let before = &self.schedule;
        let changes = if before.made_at.is_some() {
            changes(&before.schedule, &schedule, self.now)
        } else {
            Vec::new()
        };
        let begun = self.scheduler.begun.as_ref().map(|begun| begun.time);
        let span_s = self.station.scheduling.span_h * 3600.0;
        self.schedule = Arc::new(Planned {
            schedule,
            revision: before.revision + 1,
            made_at: begun,
            end: begun.map(|time| add_seconds(time, span_s)),
            changes,
        });
    }

    fn planned_antennas(&self, inputs: &Inputs) -> Vec<PlannedAntenna> {
        let planned = |antenna: &super::Antenna| {
            let shown = &antenna.shown;
            let config = &shown.config;
            let disabled = inputs.disabled.iter().find(|(id, _)| *id == config.id);
            PlannedAntenna {
                stands_deg: stands_deg(shown),
                off_reason: disabled.map(|(_, antenna_off)| *antenna_off),
                reach: Reach::from_station(&self.station, config, shown.snapshot.rates_deg_s),
                ..PlannedAntenna::from_station(&self.station, config, self.now)
            }
        };
        self.antennas.iter().map(planned).collect()
    }

    /// Returns the passes that automatic operation was taking when the last run ended, except
    /// passes being tracked now.
    fn interrupted_passes(&self) -> Vec<(AntennaId, PassListKey)> {
        let own = self.antennas.iter().filter_map(|antenna| {
            let pass = antenna.at_work.interrupted(&antenna.shown.operation)?;
            let is_tracked = antenna.shown.tracked_number() == Some(pass.0);
            let is_listed = self.pass_lists.find(pass).is_some();
            (is_listed && !is_tracked).then(|| (antenna.shown.id(), pass))
        });
        own.collect()
    }

    /// Returns the entries that a new schedule must keep: the ones that automatic operation takes,
    /// from its first command to the unit.
    fn fixed(&self) -> Vec<Entry> {
        let entries = self.schedule.schedule.entries.iter();
        let is_taken = |entry: &&Entry| {
            let antenna = self.antennas.iter().find(|other| other.shown.id() == entry.antenna);
            let taking = antenna.and_then(|antenna| antenna.shown.operation.taking());
            taking.is_some_and(|taking| {
                is_same_pass(taking.pass, (entry.pass.satellite, entry.pass.aos))
            })
        };
        entries.filter(|entry| entry.end > self.now).filter(is_taken).cloned().collect()
    }
}

/// Returns the axis angles of an antenna for the schedule, degrees; `None` before they are known.
fn stands_deg(shown: &AntennaModel) -> Option<[f64; 2]> {
    let has_elevation = shown.variant().capabilities.has_elevation();
    let measured = shown.snapshot.state.measured?;
    measured.planned_axes_deg(shown.config.mount.travel_deg(), has_elevation)
}

/// Returns `true` if `schedule` drops an entry that its antenna has begun to take since the
/// schedule's start. `begun` has the entries fixed then, `fixed` the current ones.
fn gives_away(schedule: &Schedule, begun: &[Entry], fixed: &[Entry]) -> bool {
    let is_in = |entries: &[Entry], entry: &Entry| {
        entries.iter().any(|other| {
            let key = |one: &Entry| (one.pass.satellite, one.pass.aos);
            other.antenna == entry.antenna
                && is_same_pass(key(other), key(entry))
                && seconds_between(other.end, entry.end).abs() < MOVED_S
        })
    };
    fixed.iter().any(|entry| !is_in(begun, entry) && !is_in(&schedule.entries, entry))
}

fn make(
    inputs: &Inputs,
    antennas: &[PlannedAntenna],
    previous: &Schedule,
    fixed: &[Entry],
    now: Timestamp,
) -> Schedule {
    let station = &inputs.station;
    let scheduling = station.scheduling;
    let end = add_seconds(now, scheduling.span_h * 3600.0);
    let common = Common {
        site: station.site,
        floor: station.elevation_floor(),
        antennas,
        max_age_s: scheduling.max_element_age_d.map(|days| days * DAY_S),
    };
    let ahead = inputs
        .passes
        .iter()
        .filter(|listed| listed.pass.los.time > now && listed.pass.aos.time < end);
    // Skip satellites that never set.
    let ahead: Vec<&PredictedPass> = ahead.filter(|listed| !listed.is_always_up()).collect();
    let candidates: Vec<Candidate> = ahead
        .par_iter()
        .map(|predicted| {
            let satellite = &predicted.satellite;
            let (elements, propagator) = (&satellite.elements, &satellite.propagator);
            Candidate::from_station(station, elements, propagator, &predicted.pass, common)
        })
        .collect();
    let under_way = inputs.tracked.iter().filter_map(|tracked| {
        let antenna = antennas.iter().find(|antenna| antenna.id == tracked.antenna)?;
        let own =
            candidates.iter().filter(|candidate| candidate.key.satellite == tracked.satellite);
        let ahead = own.filter(|candidate| tracked.start.is_none_or(|start| candidate.los > start));
        let pass = ahead.min_by_key(|candidate| candidate.key.aos)?;
        pass.under_way(antenna, scheduling.choose_by, now)
    });
    // Schedules with partial passes handle the rest of a begun pass by their own rules.
    let is_whole = scheduling.partly.is_none();
    let interrupted = inputs.interrupted.iter().filter(|_| is_whole);
    let resumed = interrupted.filter_map(|(id, pass)| {
        let antenna = antennas.iter().find(|antenna| antenna.id == *id)?;
        // Azel announces the first motion after a start.
        let free_from = add_seconds(now, scheduling.warning_s);
        let antenna = PlannedAntenna { free_from, ..antenna.clone() };
        let key = |candidate: &&Candidate| {
            is_same_pass((candidate.key.satellite, candidate.key.aos), *pass)
        };
        candidates.iter().find(key)?.resumed(&antenna, scheduling.choose_by)
    });
    let is_kept =
        |entry: &Entry| fixed.iter().any(|fixed_entry| fixed_entry.antenna == entry.antenna);
    let resumed = resumed.filter(|entry| !is_kept(entry));
    let fixed: Vec<Entry> = fixed.iter().cloned().chain(under_way).chain(resumed).collect();
    plan(&Request {
        antennas,
        candidates: &candidates,
        choose_by: scheduling.choose_by,
        partial: Partial::from_scheduling(&scheduling),
        previous: (!previous.entries.is_empty()).then_some(previous),
        steadiness: STEADINESS,
        fixed: &fixed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::schedule::{Class, testing};

    fn time(second: f64) -> Timestamp {
        add_seconds(Timestamp::UNIX_EPOCH, second)
    }

    fn entry(antenna: u32, satellite: u32, to_s: f64) -> Entry {
        let pass = schedule::PassKey { satellite, aos: time(100.0) };
        Entry { class: Class::Fixed, ..testing::entry(AntennaId(antenna), pass, time(to_s)) }
    }

    #[test]
    fn a_schedule_gives_away_nothing_that_was_begun_while_it_was_made() {
        let schedule =
            |entries: &[Entry]| Schedule { entries: entries.to_vec(), ..Schedule::default() };
        let first_entry = entry(1, 7, 700.0);
        let fixed = [first_entry.clone()];
        assert!(!gives_away(&schedule(&fixed), &[], &fixed));
        let newer = entry(1, 7, 700.4);
        assert!(!gives_away(&schedule(&[newer]), &[], &fixed), "by newer elements");
        for other in [entry(2, 7, 700.0), entry(1, 8, 700.0), entry(1, 7, 400.0)] {
            assert!(gives_away(&schedule(&[other]), &[], &fixed));
        }
        assert!(!gives_away(&schedule(&[]), &fixed, &fixed), "it was known");
    }
}
