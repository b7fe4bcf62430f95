//! Recorded passes that a client looks at, read from the record file.

use std::{path::Path, sync::Arc, time::Duration};

use jiff::Timestamp;

use super::Engine;
use crate::{
    astro::Site,
    clock::Instant,
    contract::{
        record::ExplainedPasses,
        recorded::{Found, MissedPass, RecordLook, Recorded},
    },
    job::Job,
    record::{self, MissedEntry, RecordError},
};

/// Time from the completion of a report until the file contains it.
const UNTIL_WRITTEN: Duration = Duration::from_secs(1);

/// Converts an entry; `None` if an older program wrote it in another form.
fn missed_pass(entry: MissedEntry) -> Option<MissedPass> {
    let MissedEntry { id, time, antenna, antenna_name, flown } = entry;
    let flown = serde_json::from_value(flown).ok()?;
    Some(MissedPass { id, time, antenna, antenna_name, flown })
}

/// Reads the record at `path`. Reports without a site belong to an antenna at `site`.
pub fn read_record(path: &Path, look: RecordLook, site: Site) -> Recorded {
    let found = read(path, &look, site).map_err(|error| error.to_string());
    Recorded { look, found, combined: None }
}

/// Returns `true` if both have the same opened pass and the same number of passes. Their combined
/// explanation is then the same.
fn have_same_passes(one: &Recorded, other: &Recorded) -> bool {
    let passes = |recorded: &Recorded| recorded.found.as_ref().ok().map(|found| found.page.all);
    one.look.opened == other.look.opened && passes(one) == passes(other)
}

/// Reading of a record for a client.
#[derive(Default)]
pub(super) struct RecordReading {
    pub(super) found: Option<Arc<Recorded>>,
    record_look: Option<RecordLook>,
    job: Option<Job<Recorded>>,
    explaining: Option<Job<Option<ExplainedPasses>>>,
    /// Time at which the file contains a new pass.
    due: Option<Instant>,
}

impl Engine {
    /// Publishes the part of the record that `look` selects, and keeps it up to date. `None`
    /// publishes nothing.
    pub(super) fn look_at_record(&mut self, look: Option<RecordLook>) {
        if look.is_none() {
            self.record_reading.found = None;
        }
        self.record_reading.record_look = look;
        self.read_record();
    }

    /// Schedules another read, because the record gets a new pass or another record is in use.
    pub(super) fn record_has_grown(&mut self) {
        self.record_reading.due = Some(self.steady + UNTIL_WRITTEN);
    }

    fn read_record(&mut self) {
        self.record_reading.due = None;
        let Some(look) = self.record_reading.record_look.clone() else {
            self.record_reading.job = None;
            return;
        };
        let Some(path) = self.record_file() else {
            let found = Err("this user has no folder for records".to_owned());
            self.record_reading.found = Some(Arc::new(Recorded { look, found, combined: None }));
            return;
        };
        let site = self.station.site;
        let job = Job::start("azel-look-back", Arc::clone(&self.wake), move |_| {
            read_record(&path, look, site)
        });
        self.record_reading.job = Some(job);
    }

    pub(super) fn take_recorded(&mut self) {
        if self.record_reading.due.is_some_and(|due| due <= self.steady) {
            self.read_record();
        }
        if let Some(Ok(mut recorded)) = Job::take(&mut self.record_reading.job) {
            let before = self.record_reading.found.take();
            let before = before.filter(|before| have_same_passes(before, &recorded));
            recorded.combined = before.as_ref().and_then(|before| before.combined.clone());
            self.record_reading.found = Some(Arc::new(recorded));
            if before.is_none() {
                self.explain_together();
            }
        }
        if let Some(Ok(combined)) = Job::take(&mut self.record_reading.explaining)
            && let Some(found) = &mut self.record_reading.found
        {
            Arc::make_mut(found).combined = combined;
        }
    }

    fn explain_together(&mut self) {
        let reading = &mut self.record_reading;
        reading.explaining = None;
        let found = reading.found.as_ref().and_then(|recorded| recorded.found.as_ref().ok());
        let Some(opened) = found.and_then(|found| found.opened.as_ref()) else { return };
        let (antenna, end) = (opened.pass.antenna, opened.pass.report.end);
        let configured = self.station.antennas.iter().find(|one| one.id == antenna);
        // Azel does not know the mount of an antenna that has left the station.
        let (Some(config), Some(path)) = (configured, self.record_file()) else { return };
        let (mount, site) = (config.mount, self.station.site);
        let job = Job::start("azel-explain-passes", Arc::clone(&self.wake), move |_| {
            let explained =
                record::explain_passes(&path, antenna, mount, site, &(Timestamp::MIN..=end));
            explained.inspect_err(|error| tracing::error!(%error, "passes not explained")).ok()
        });
        self.record_reading.explaining = Some(job);
    }
}

fn read(path: &Path, look: &RecordLook, site: Site) -> Result<Found, RecordError> {
    let page = record::passes(path, &look.query)?;
    let missed = record::missed(path, &look.query, &page)?;
    let missed = missed.into_iter().filter_map(missed_pass).collect();
    let opened = look.opened.map(|id| record::open_pass(path, id, site)).transpose()?.flatten();
    Ok(Found { page, missed, opened })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        clock::Clock,
        contract::{
            automatic::{DayEvent, DayLine, Flown, MissCause},
            record::PassQuery,
        },
        plan::pass_report::LossCause,
        record::{Entry, Kind, Recorder},
        station::{AntennaId, Retention},
    };

    #[test]
    fn a_line_of_the_day_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.sqlite");
        let clock = Clock::new(Timestamp::now);
        let now = clock.now();
        let missed = Flown {
            pass: (7, now.utc),
            name: "SAT".to_owned(),
            of_s: 600.0,
            in_beam_s: 0.0,
            proved_at: None,
            cause: Some(MissCause::Lost(LossCause::LinkLost)),
        };
        let in_part = Flown { pass: (8, now.utc), in_beam_s: 10.0, ..missed.clone() };
        let antenna = AntennaId(3);
        let recorder = Recorder::start(path.clone(), clock, Retention::default()).unwrap();
        for flown in [&missed, &in_part] {
            let line = DayLine { time: now.utc, antenna, event: DayEvent::Flown(flown.clone()) };
            recorder.note(Entry::new(now, Some(antenna), Kind::Day, &line));
        }
        recorder.flush();
        let query = PassQuery { count: 10, ..PassQuery::default() };
        let look = RecordLook { query, opened: None };
        let found = read_record(&path, look, Site::default()).found.unwrap();
        let [only] = &found.missed[..] else { panic!("{found:?}") };
        assert_eq!((only.antenna, &only.flown), (antenna, &missed));
    }
}
