//! Alarms about a source that keeps failing, and about elements too old for the planned automatic
//! passes.

use std::collections::BTreeSet;

use jiff::Timestamp;

use super::{CatalogState, Engine, alarms::AlarmKind};
use crate::{
    astro::time::DAY_S,
    orbit::{Catalog, SourceReport},
    plan::schedule::Entry,
};

/// A source raises an alarm after this many requests in a row that brought nothing.
const FAILURES: u32 = 2;
/// Age of elements at a pass from which they raise an alarm, days.
const MAX_AGE_DAYS: f64 = 7.0;

impl Engine {
    /// Raises an alarm for each source that keeps failing, and clears the alarm once a request succeeds.
    pub(super) fn watch_sources(&mut self) {
        let is_failing =
            |report: &SourceReport| report.failures >= FAILURES || report.awaits_operator();
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

    /// Raises an alarm while the elements of passes that automatic operation will take are too old.
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
        let is_automatic = |entry: &&Entry| {
            let mut antennas = self.antennas.iter().map(|antenna| &antenna.shown);
            antennas.any(|shown| shown.id() == entry.antenna && shown.operation.is_on())
        };
        let entries = self.schedule.schedule.entries.iter().filter(is_automatic);
        elements_old_alarm(catalog, entries.map(|entry| (entry.pass.satellite, entry.from)))
    }
}

/// Returns an alarm if elements are too old for their passes.
fn elements_old_alarm(
    catalog: &Catalog,
    passes: impl Iterator<Item = (u32, Timestamp)>,
) -> Option<AlarmKind> {
    let is_old = |(satellite, from): &(u32, Timestamp)| {
        let elements = catalog.get(*satellite);
        elements.is_some_and(|elements| elements.age_s(*from) > MAX_AGE_DAYS * DAY_S)
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
        orbit::{FetchProblem, bundled},
    };

    #[test]
    fn a_source_alarm_ends_with_a_successful_request() {
        let folder = tempfile::tempdir().unwrap();
        let (mut engine, _) = station(folder.path());
        let refused = Some(FetchProblem::LogIn);
        for (failures, fetch_problem, wanted) in [
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
                not_before: None,
                is_set_aside: false,
            }];
            engine.watch_sources();
            let is_source_alarm = |kind: &AlarmKind| matches!(kind, AlarmKind::SourceFails { .. });
            let mut alarms = engine.alarms.list().iter();
            let stands = alarms.any(|alarm| is_source_alarm(&alarm.kind) && !alarm.is_over());
            assert_eq!(stands, wanted, "{failures}");
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
                passes.iter().map(|(satellite, days)| after(*satellite, *days)),
            )
        };
        assert_eq!(alarm(&[(NOAA_20, 6.9), (SUOMI_NPP, 0.0)]), None);
        let both = [(NOAA_20, 6.0), (NOAA_20, 7.1), (SUOMI_NPP, 8.0), (NOAA_20, 9.0)];
        let Some(AlarmKind::ElementsOld { others: 1, .. }) = alarm(&both) else {
            panic!("{:?}", alarm(&both));
        };
        assert_eq!(alarm(&[(1, 100.0); 0]), None);
    }
}
