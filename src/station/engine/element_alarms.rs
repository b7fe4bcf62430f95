//! Alarms about a source that keeps failing, and about elements too old for the planned automatic
//! passes.

use std::collections::BTreeSet;

use jiff::Timestamp;

use super::Engine;
use crate::{
    astro::time::DAY_S,
    contract::{CatalogState, alarms::AlarmKind, antenna::AntennaModel},
    engine::alarms::KeepAlarms,
    orbit::{Catalog, SourceReport},
    plan::schedule::{LeftOut, LeftOutReason, Refusal, Schedule},
    station::{AntennaId, Scheduling},
};

/// Number of failed requests in a row that raises an alarm about a source.
const FAILURES: u32 = 2;
/// Min age of elements at a pass for an alarm, days.
const MAX_AGE_DAYS: f64 = 7.0;

impl Engine {
    /// Raises an alarm for each source that keeps failing, and clears the alarm once a request succeeds.
    pub(super) fn watch_sources(&mut self) {
        let failing = |name: &str| {
            let reports = self.sources.reports.iter();
            reports.into_iter().any(|report| report.source == name && is_failing(report))
        };
        self.alarms.clear(None, self.now, |kind| match kind {
            AlarmKind::SourceFails { source, .. } => !failing(source),
            _ => false,
        });
        for report in self.sources.reports.iter().filter(|report| is_failing(report)) {
            let kind =
                AlarmKind::SourceFails { source: report.source.clone(), as_of: report.as_of };
            self.alarms.raise(None, kind, self.now);
        }
    }

    /// Raises an alarm while elements are too old for passes that automatic operation will take, or
    /// leaves out for their age.
    pub(super) fn watch_element_age(&mut self) {
        let found = self.old_elements();
        match found {
            Some(kind) => self.alarms.raise(None, kind, self.now),
            None => self
                .alarms
                .clear(None, self.now, |kind| matches!(kind, AlarmKind::ElementsOld { .. })),
        }
    }

    fn old_elements(&self) -> Option<AlarmKind> {
        let CatalogState::Ready(catalog) = &self.catalog else { return None };
        // In the demo, old elements cost no pass: the simulated units use the same elements.
        if self.demo.is_some() {
            return None;
        }
        let antennas = self.antennas.iter().map(|antenna| &antenna.shown);
        let on = antennas.filter(|shown| shown.operation.is_on());
        let automatic: Vec<AntennaId> = on.map(AntennaModel::id).collect();
        let passes = concerned(&self.schedule.schedule, &automatic);
        elements_old_alarm(catalog, max_age_d(&self.station.scheduling), passes.into_iter())
    }
}

/// Returns `true` if the source needs an alarm.
pub(super) fn is_failing(report: &SourceReport) -> bool {
    let is_unread = report.files.iter().any(|file| file.problem.is_some());
    report.failures >= FAILURES || report.awaits_operator() || is_unread
}

/// Returns the min age of elements at a pass for an alarm, days.
fn max_age_d(scheduling: &Scheduling) -> f64 {
    scheduling.max_element_age_d.map_or(MAX_AGE_DAYS, |own| own.min(MAX_AGE_DAYS))
}

/// Returns the satellites and times of passes that `automatic` antennas will take, or would take
/// with newer elements.
fn concerned(schedule: &Schedule, automatic: &[AntennaId]) -> Vec<(u32, Timestamp)> {
    let entries = schedule.entries.iter().filter(|entry| automatic.contains(&entry.antenna));
    let passes = entries.map(|entry| (entry.pass.satellite, entry.start));
    let is_old = |reason: &LeftOutReason| {
        matches!(reason, LeftOutReason::Refused(Refusal::OldElements { .. }))
    };
    let is_left_out = |left: &&LeftOut| is_old(&left.reason) && !automatic.is_empty();
    let left_out = schedule.left_out.iter().filter(is_left_out);
    passes.chain(left_out.map(|left| (left.pass.satellite, left.pass.aos))).collect()
}

/// Returns an alarm if elements are too old for their passes.
fn elements_old_alarm(
    catalog: &Catalog,
    max_days: f64,
    passes: impl Iterator<Item = (u32, Timestamp)>,
) -> Option<AlarmKind> {
    let is_old = |(satellite, start): &(u32, Timestamp)| {
        let elements = catalog.get(*satellite);
        elements.is_some_and(|elements| elements.epoch_distance_s(*start) > max_days * DAY_S)
    };
    let old: BTreeSet<u32> = passes.filter(is_old).map(|(satellite, _)| satellite).collect();
    let name = catalog.get(*old.first()?)?.short_name().to_owned();
    Some(AlarmKind::ElementsOld { name, others: old.len() - 1 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::time::add_seconds,
        engine::automatic::tests::station,
        library::{Library, Limits},
        orbit::{FetchProblem, Source, SourcePlace, bundled},
        plan::schedule::PassKey,
    };

    #[test]
    fn a_source_alarm_ends_with_a_successful_request() {
        let folder = tempfile::tempdir().unwrap();
        let (mut engine, _) = station(folder.path());
        let refused = Some(FetchProblem::LogIn);
        for (failures, fetch_problem, is_expected) in [
            (0, None, false),
            (1, None, false),
            (2, None, true),
            (5, None, true),
            (0, None, false),
            (1, refused, true),
            (0, None, false),
        ] {
            engine.sources.reports = vec![SourceReport {
                source: "server".to_owned(),
                files: Vec::new(),
                as_of: None,
                newest_epoch: None,
                fetch_problem,
                failures,
                next_fetch: None,
                limits: Vec::new(),
                is_set_aside: false,
                newer_elsewhere: 0,
            }];
            engine.watch_sources();
            let is_source_alarm = |kind: &AlarmKind| matches!(kind, AlarmKind::SourceFails { .. });
            let mut alarms = engine.alarms.list().iter();
            let stands = alarms.any(|alarm| is_source_alarm(&alarm.kind) && !alarm.is_over());
            assert_eq!(stands, is_expected, "{failures}");
        }
    }

    #[test]
    fn the_age_at_the_pass_decides_about_old_elements() {
        const NOAA_20: u32 = 43_013;
        const SUOMI_NPP: u32 = 37_849;
        let catalog = bundled().unwrap();
        let after = |satellite: u32, days: f64| {
            let epoch = catalog.get(satellite).unwrap().epoch();
            (satellite, add_seconds(epoch, days * 86_400.0))
        };
        let alarm = |passes: &[(u32, f64)]| {
            elements_old_alarm(
                &catalog,
                max_age_d(&Scheduling::default()),
                passes.iter().map(|(satellite, days)| after(*satellite, *days)),
            )
        };
        assert_eq!(alarm(&[(NOAA_20, 6.9), (SUOMI_NPP, 0.0)]), None);
        let two_satellites = [(NOAA_20, 6.0), (NOAA_20, 7.1), (SUOMI_NPP, 8.0), (NOAA_20, 9.0)];
        let Some(AlarmKind::ElementsOld { others: 1, .. }) = alarm(&two_satellites) else {
            panic!("{:?}", alarm(&two_satellites));
        };
        assert_eq!(alarm(&[(1, 100.0); 0]), None);
    }

    #[test]
    fn a_file_that_cannot_be_read_raises_an_alarm() {
        let folder = tempfile::tempdir().unwrap();
        let list = [Source {
            name: "own".to_owned(),
            place: SourcePlace::File(folder.path().join("gone.tle")),
            refresh: None,
        }];
        let library = Library::open(folder.path(), Limits::default()).unwrap();
        let failing = || library.load(&list).1.iter().filter(|report| is_failing(report)).count();
        assert_eq!(failing(), 1);
        std::fs::write(folder.path().join("gone.tle"), "").unwrap();
        assert_eq!(failing(), 0);
    }

    #[test]
    fn a_pass_that_is_left_out_for_old_elements_raises_the_alarm() {
        const NOAA_20: u32 = 43_013;
        let catalog = bundled().unwrap();
        let aos = add_seconds(catalog.get(NOAA_20).unwrap().epoch(), 5.5 * DAY_S);
        let alarm = |refusal, automatic: &[AntennaId], max_element_age_d| {
            let left_out = vec![LeftOut {
                pass: PassKey { satellite: NOAA_20, aos },
                reason: LeftOutReason::Refused(refusal),
                by_antenna: Vec::new(),
            }];
            let schedule = Schedule { left_out, ..Schedule::default() };
            let scheduling = Scheduling { max_element_age_d, ..Scheduling::default() };
            let passes = concerned(&schedule, automatic);
            elements_old_alarm(&catalog, max_age_d(&scheduling), passes.into_iter()).is_some()
        };
        let old = Refusal::OldElements { age_s: 5.5 * DAY_S };
        let automatic = [AntennaId(1)];
        assert!(alarm(old, &automatic, Some(5.0)));
        assert!(!alarm(old, &automatic, Some(6.0)), "it will be taken");
        assert!(!alarm(old, &[], Some(5.0)), "nobody plans for it");
        assert!(!alarm(Refusal::Never, &automatic, Some(5.0)), "the operator's choice");
    }
}
