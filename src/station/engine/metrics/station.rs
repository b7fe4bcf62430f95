//! Metrics of the station as a whole, from its snapshot.

use super::{
    antenna,
    families::{Families, Labels, Metric},
};
use crate::{
    astro::time::seconds_between,
    clock::Moment,
    contract::{
        CatalogState, Snapshot,
        alarms::{Alarm, Priority},
        driver::TimeSync,
    },
    engine::element_alarms::is_failing,
    orbit::Elements,
    station::AntennaId,
};

const BUILD: Metric = Metric::info("azel_build", "Version of Azel.");
const STATION: Metric = Metric::info("azel_station", "Name of the station.");
const SNAPSHOT_AGE: Metric =
    Metric::gauge("azel_snapshot_age", "Age of the state that all metrics show.")
        .in_unit("seconds");
const TIME_SYNC: Metric =
    Metric::gauge("azel_time_synchronised", "1 while a time service keeps this computer's clock.");
const ALARMS: Metric = Metric::gauge("azel_alarms", "Alarms whose cause persists.");
const UNACKNOWLEDGED: Metric =
    Metric::gauge("azel_alarms_unacknowledged", "Alarms that nobody acknowledged or shelved.");
const OBJECTS: Metric = Metric::gauge("azel_elements_objects", "Objects in the catalogue.");
const MAX_AGE: Metric =
    Metric::gauge("azel_elements_max_age", "Age of the oldest elements of the favourites.")
        .in_unit("seconds");
const MIN_AGE: Metric =
    Metric::gauge("azel_elements_min_age", "Age of the newest elements of the favourites.")
        .in_unit("seconds");
const MISSING: Metric = Metric::gauge("azel_elements_missing", "Favourites without elements.");
const SOURCES: Metric = Metric::gauge("azel_element_sources", "Sources of elements, by state.");
const RECORD_SIZE: Metric =
    Metric::gauge("azel_record_size", "Size of the record on disk.").in_unit("bytes");
const RECORD_GAP: Metric =
    Metric::gauge("azel_record_gap", "Time since the last write while Azel cannot write, else 0.")
        .in_unit("seconds");
const RECORD_GAPS: Metric =
    Metric::counter("azel_record_gaps", "Gaps that Azel has marked in the record.");
const RECORD_WAITING: Metric =
    Metric::gauge("azel_record_waiting", "Entries that wait while Azel cannot write.");

pub(super) const METRICS: [Metric; 15] = [
    BUILD,
    STATION,
    SNAPSHOT_AGE,
    TIME_SYNC,
    ALARMS,
    UNACKNOWLEDGED,
    OBJECTS,
    MAX_AGE,
    MIN_AGE,
    MISSING,
    SOURCES,
    RECORD_SIZE,
    RECORD_GAP,
    RECORD_GAPS,
    RECORD_WAITING,
];

/// Adds the metrics of the station.
pub(super) fn add(families: &mut Families, snapshot: &Snapshot, now: Moment) {
    families.add(BUILD, vec![("version", env!("CARGO_PKG_VERSION").to_owned())], 1.0);
    let mode = if snapshot.demo { "demo" } else { "live" };
    let name = snapshot.station.name.clone();
    families.add(STATION, vec![("station", name), ("mode", mode.to_owned())], 1.0);
    let age = now.steady.saturating_duration_since(snapshot.moment.steady);
    families.add(SNAPSHOT_AGE, Labels::new(), age.as_secs_f64());
    let is_synchronised = match snapshot.time_sync {
        TimeSync::Synchronised => Some(1.0),
        TimeSync::NotSynchronised => Some(0.0),
        TimeSync::NotKnown => None,
    };
    families.add(TIME_SYNC, Labels::new(), is_synchronised);
    add_alarms(families, snapshot);
    add_elements(families, snapshot, now);
    add_record(families, snapshot, now);
}

fn add_alarms(families: &mut Families, snapshot: &Snapshot) {
    const PRIORITIES: [(Priority, &str); 3] = [
        (Priority::First, "first"),
        (Priority::Warning, "warning"),
        (Priority::Caution, "caution"),
    ];
    let antennas = &snapshot.antennas;
    let is_present = |id: AntennaId| antennas.iter().any(|antenna| antenna.id() == id);
    let scopes = antennas.iter().map(|antenna| (Some(antenna.id()), antenna::labels(antenna)));
    for (scope, labels) in std::iter::once((None, Labels::new())).chain(scopes) {
        for (priority, name) in PRIORITIES {
            let is_counted = |alarm: &&Alarm| {
                alarm.antenna.filter(|id| is_present(*id)) == scope && alarm.priority() == priority
            };
            let count = |is_meant: fn(&Alarm) -> bool| {
                let alarms = snapshot.alarms.list().iter().filter(is_counted);
                alarms.filter(|alarm| is_meant(alarm)).count() as f64
            };
            let mut labels = labels.clone();
            labels.push(("priority", name.to_owned()));
            families.add(ALARMS, labels.clone(), count(|alarm| !alarm.is_over()));
            let is_new = |alarm: &Alarm| !alarm.acknowledged && alarm.shelved_until.is_none();
            families.add(UNACKNOWLEDGED, labels, count(is_new));
        }
    }
}

fn add_elements(families: &mut Families, snapshot: &Snapshot, now: Moment) {
    let failing = snapshot.sources.reports.iter().filter(|report| is_failing(report)).count();
    let working = snapshot.sources.reports.len() - failing;
    for (state, count) in [("working", working), ("failing", failing)] {
        families.add(SOURCES, vec![("state", state.to_owned())], count as f64);
    }
    let CatalogState::Ready(catalog) = &snapshot.catalog else { return };
    families.add(OBJECTS, Labels::new(), catalog.len() as f64);
    let favourites = snapshot.station.favourites.iter();
    let sets: Vec<Option<&Elements>> =
        favourites.map(|favourite| catalog.get(favourite.satellite)).collect();
    let ages = || sets.iter().flatten().map(|elements| elements.age_s(now.utc));
    families.add(MAX_AGE, Labels::new(), ages().reduce(f64::max));
    families.add(MIN_AGE, Labels::new(), ages().reduce(f64::min));
    let missing = sets.iter().filter(|elements| elements.is_none()).count();
    families.add(MISSING, Labels::new(), missing as f64);
}

fn add_record(families: &mut Families, snapshot: &Snapshot, now: Moment) {
    let Some(record) = &snapshot.record else { return };
    families.add(RECORD_SIZE, Labels::new(), record.bytes as f64);
    let failing = record.failing.as_ref();
    let gap_s = failing.map(|failing| seconds_between(failing.last_write, now.utc).max(0.0));
    families.add(RECORD_GAP, Labels::new(), gap_s.unwrap_or_default());
    families.add(RECORD_GAPS, Labels::new(), record.gaps as f64);
    families.add(RECORD_WAITING, Labels::new(), failing.map(|failing| failing.waiting as f64));
}
