//! Tally of each pass: the promise of the plan at its start, and the time in beam.

use std::{
    collections::{BTreeMap, BTreeSet},
    iter::Sum,
    ops::Add,
};

use azel::{
    astro::time::{add_seconds, seconds_between},
    contract::{
        Snapshot,
        automatic::{DayEvent, Flown},
        driver::Event,
        passes::PassListKey,
    },
    plan::schedule::Entry,
    station::AntennaId,
};
use jiff::Timestamp;

use super::faults::{Faults, Span};

/// Max age of a measured direction, seconds; an older one counts as none.
const FRESH_S: f64 = 3.0;
/// Max change of an AOS between two plans with the same pass, seconds.
const SAME_AOS_S: f64 = 60.0;
/// Loss above which the test prints a pass, seconds.
const PRINTED_S: f64 = 2.0;

/// Promised and delivered time in beam, seconds.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Total {
    promised_s: f64,
    delivered_s: f64,
    passes: usize,
}

impl Total {
    pub(super) fn share(&self) -> f64 {
        self.delivered_s / self.promised_s
    }
}

impl Add for Total {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            promised_s: self.promised_s + other.promised_s,
            delivered_s: self.delivered_s + other.delivered_s,
            passes: self.passes + other.passes,
        }
    }
}

impl Sum for Total {
    fn sum<I: Iterator<Item = Self>>(totals: I) -> Self {
        totals.fold(Self::default(), Add::add)
    }
}

/// A pass that has begun.
struct Begun {
    antenna: AntennaId,
    pass: PassListKey,
    during: Span,
    /// Time in beam that the plan promised as the pass began, seconds.
    promised_s: f64,
    /// Time of faults during the pass, seconds.
    excused_s: f64,
    /// Time in beam outside the faults as this test measures it, seconds.
    measured_s: f64,
    /// Result of the pass in the station's own report.
    flown: Option<Flown>,
}

impl Begun {
    fn total(&self) -> Total {
        let promised_s = (self.promised_s - self.excused_s).max(0.0);
        let reported_s = self.flown.as_ref().map_or(0.0, |flown| flown.in_beam_s);
        let delivered_s = if self.excused_s > 0.0 { self.measured_s } else { reported_s };
        Total { promised_s, delivered_s: delivered_s.min(promised_s), passes: 1 }
    }

    fn lost_s(&self) -> f64 {
        let total = self.total();
        total.promised_s - total.delivered_s
    }

    /// Returns `true` if the key names this pass. A pass under way at a start of the station has
    /// that start as AOS.
    fn covers(&self, antenna: AntennaId, (satellite, aos): PassListKey) -> bool {
        let from = add_seconds(self.pass.1, -SAME_AOS_S);
        self.antenna == antenna && self.pass.0 == satellite && from < aos && aos < self.during.to
    }
}

pub(super) struct Tally {
    from: Timestamp,
    excused: BTreeMap<AntennaId, Vec<Span>>,
    begun: Vec<Begun>,
    names: BTreeMap<AntennaId, String>,
    seen_to: Option<Timestamp>,
    takes_no_more: bool,
    /// Printed refusals, by antenna and time.
    refused: BTreeSet<(AntennaId, Timestamp)>,
    day_until: Option<Timestamp>,
    /// Alarms by id and time, because each run of the station counts from the same id.
    alarms: BTreeSet<(u64, Timestamp)>,
}

impl Tally {
    pub(super) fn new(from: Timestamp, faults: &Faults) -> Self {
        let excused = (1..).zip(0..3).map(|(id, antenna)| (AntennaId(id), faults.excused(antenna)));
        Self {
            from,
            excused: excused.collect(),
            begun: Vec::new(),
            names: BTreeMap::new(),
            seen_to: None,
            takes_no_more: false,
            refused: BTreeSet::new(),
            day_until: None,
            alarms: BTreeSet::new(),
        }
    }

    /// Ignores all passes that begin later.
    pub(super) fn take_no_more(&mut self) {
        self.takes_no_more = true;
    }

    pub(super) fn last_end(&self) -> Timestamp {
        self.begun.iter().map(|begun| begun.during.to).max().unwrap_or(self.from)
    }

    /// Counts the passes that begin before `until`. The plan in force at a power cut stays until
    /// then.
    pub(super) fn expect(&mut self, snapshot: &Snapshot, until: Timestamp) {
        let now = snapshot.moment.utc;
        let is_due = |entry: &&Entry| entry.start < until && now < entry.end;
        for entry in snapshot.schedule.schedule.entries.iter().filter(is_due) {
            self.begin(entry);
        }
        self.seen_to = None;
    }

    fn begin(&mut self, entry: &Entry) {
        let (antenna, pass) = (entry.antenna, (entry.pass.satellite, entry.pass.aos));
        if entry.start < self.from || self.begun.iter().any(|begun| begun.covers(antenna, pass)) {
            return;
        }
        let during = Span { from: entry.start, to: entry.end };
        let excused = self.excused.get(&antenna).into_iter().flatten();
        let excused_s = excused.map(|span| span.overlap_s(during)).sum();
        let promised_s = entry.counted_s;
        self.begun.push(Begun {
            antenna,
            pass,
            during,
            promised_s,
            excused_s,
            measured_s: 0.0,
            flown: None,
        });
    }

    /// Records the state of the station at a true time, which its clock may not show.
    pub(super) fn look(&mut self, snapshot: &Snapshot, true_time: Timestamp) {
        let now = snapshot.moment.utc;
        let is_under_way = |entry: &&Entry| entry.start <= now && now < entry.end;
        if !self.takes_no_more {
            for entry in snapshot.schedule.schedule.entries.iter().filter(is_under_way) {
                self.begin(entry);
            }
        }
        let seen_to = self.seen_to.replace(now).unwrap_or(now);
        let passed = Span { from: seen_to, to: now };
        for shown in &snapshot.antennas {
            let id = shown.id();
            if let Some((event @ (Event::NotSent(_) | Event::CannotTrack(..)), at)) = &shown.news
                && self.refused.insert((id, *at))
            {
                println!("{at} antenna {}: {event:?}", id.0);
            }
            self.names.entry(id).or_insert_with(|| shown.config.name.clone());
            let is_fresh = |at| seconds_between(at, now) < FRESH_S;
            let error = shown.error().filter(|error| is_fresh(error.time));
            let is_in_beam = error
                .is_some_and(|error| error.off_beam.degrees() <= shown.config.beam_width_deg / 2.0);
            let mut excused = self.excused.get(&id).into_iter().flatten();
            let is_excused = excused.any(|span| span.contains(true_time));
            let predicted = shown.prediction.and_then(|prediction| prediction.catalog_number);
            let is_its =
                |begun: &&mut Begun| begun.antenna == id && Some(begun.pass.0) == predicted;
            if is_in_beam && !is_excused {
                for begun in self.begun.iter_mut().rev().take(20).filter(is_its) {
                    begun.measured_s += begun.during.overlap_s(passed);
                }
            }
        }
        self.take_day(snapshot);
        let alarms = snapshot.alarms.list().iter();
        self.alarms.extend(alarms.map(|alarm| (alarm.id, alarm.raised)));
    }

    fn take_day(&mut self, snapshot: &Snapshot) {
        for line in snapshot.day.iter() {
            let is_new = self.day_until.is_none_or(|until| line.time > until);
            match &line.event {
                DayEvent::Flown(flown) => {
                    let is_its = |begun: &&mut Begun| begun.covers(line.antenna, flown.pass);
                    if let Some(begun) = self.begun.iter_mut().rev().take(60).find(is_its) {
                        begun.flown.get_or_insert_with(|| flown.clone());
                    }
                }
                what if is_new => println!("{} antenna {}: {what:?}", line.time, line.antenna.0),
                _ => {}
            }
        }
        self.day_until = snapshot.day.last().map(|line| line.time).or(self.day_until);
    }

    /// Returns `true` if the station has reported each pass that met no fault.
    pub(super) fn is_over(&self) -> bool {
        self.begun.iter().all(|begun| begun.flown.is_some() || begun.excused_s > 0.0)
    }

    pub(super) fn print_passes(&self) {
        for begun in self.begun.iter().filter(|begun| begun.lost_s() > PRINTED_S) {
            let Begun { promised_s, excused_s, measured_s, .. } = begun;
            let flown = begun.flown.as_ref();
            println!(
                "{} {} {}: {promised_s:.0} s promised, {excused_s:.0} s excused, {:.0} s told, \
                 {measured_s:.0} s seen, {:.1} s lost: {:?}",
                begun.during.from,
                self.names.get(&begun.antenna).map_or("", |name| name),
                flown.map_or_else(|| begun.pass.0.to_string(), |flown| flown.name.clone()),
                flown.map_or(0.0, |flown| flown.in_beam_s),
                begun.lost_s(),
                flown.and_then(|flown| flown.cause),
            );
        }
    }

    /// Prints the totals of each antenna and returns their sum.
    pub(super) fn print_totals(&self) -> Total {
        let mut causes: BTreeMap<String, f64> = BTreeMap::new();
        for begun in &self.begun {
            let cause = begun.flown.as_ref().and_then(|flown| flown.cause);
            *causes.entry(format!("{cause:?}")).or_default() += begun.lost_s();
        }
        println!("{} alarms; seconds lost, by main cause: {causes:.0?}", self.alarms.len());
        let plain = self.begun.iter().filter(|begun| begun.excused_s <= 0.0);
        let apart_s =
            plain.filter_map(|begun| Some(begun.flown.as_ref()?.in_beam_s - begun.measured_s));
        let apart_s = apart_s.map(f64::abs).fold(0.0, f64::max);
        println!("the station's account and that of the test differ by at most {apart_s:.1} s");
        for (id, name) in &self.names {
            let own = self.begun.iter().filter(|begun| begun.antenna == *id);
            print_total(name, own.map(Begun::total).sum());
        }
        let total = self.begun.iter().map(Begun::total).sum();
        print_total("all", total);
        total
    }
}

fn print_total(name: &str, total: Total) {
    let Total { promised_s, delivered_s, passes } = total;
    let percent = 100.0 * total.share();
    println!(
        "{name}: {passes} passes, {promised_s:.0} s promised outside the faults, {delivered_s:.0} s \
         delivered: {percent:.3} %"
    );
}
