//! Passes that a client looks back at, read from the file of the record.

use std::{path::Path, sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Engine, automatic::Flown};
use crate::{
    astro::Site,
    clock::Instant,
    contract::record::{ExplainedPasses, OpenedPass, PassPage, PassQuery},
    job::Job,
    record::{self, MissedEntry, RecordError},
    station::AntennaId,
};

/// Time from the end of the work on a report until it can be read from the file.
const UNTIL_WRITTEN: Duration = Duration::from_secs(1);

/// Passes of the record that a client looks at.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RecordLook {
    pub query: PassQuery,
    /// Number of the pass whose track is shown.
    pub opened: Option<i64>,
}

/// Content of the record for a look.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    pub look: RecordLook,
    /// Or why the record cannot be read.
    pub found: Result<Found, String>,
    /// Causes that explain the opened pass and those before it together. Finding them takes longer
    /// than the rest.
    pub together: Option<ExplainedPasses>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    pub page: PassPage,
    /// Passes that automatic operation was to track in the time of the page, and that were not
    /// tracked, the newest first.
    pub missed: Vec<MissedPass>,
    pub opened: Option<OpenedPass>,
}

/// A pass that was to be tracked, and was not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissedPass {
    /// Number of its entry in the record.
    pub id: i64,
    /// When it was over for the antenna.
    pub at: Timestamp,
    pub antenna: AntennaId,
    /// Name of the antenna at the time.
    pub antenna_name: String,
    pub flown: Flown,
}

impl MissedPass {
    /// `None` where the entry has another form, as an older program wrote it.
    fn of(entry: MissedEntry) -> Option<Self> {
        let MissedEntry { id, at, antenna, antenna_name, flown } = entry;
        let flown = serde_json::from_value(flown).ok()?;
        Some(Self { id, at, antenna, antenna_name, flown })
    }
}

impl Recorded {
    /// Reads the record at `path`. Reports without a site are of an antenna at `site`.
    pub fn read(path: &Path, look: RecordLook, site: Site) -> Self {
        let found = read(path, &look, site).map_err(|error| error.to_string());
        Self { look, found, together: None }
    }

    /// Returns `true` if the same pass is opened and the record has as many passes, so that what
    /// explains them together is the same.
    fn has_same_passes(&self, other: &Self) -> bool {
        let passes = |of: &Self| of.found.as_ref().ok().map(|found| found.page.all);
        self.look.opened == other.look.opened && passes(self) == passes(other)
    }
}

/// The reading of a record.
#[derive(Default)]
pub(super) struct RecordReading {
    pub(super) found: Option<Arc<Recorded>>,
    wanted: Option<RecordLook>,
    job: Option<Job<Recorded>>,
    explaining: Option<Job<Option<ExplainedPasses>>>,
    /// When a new pass will be in the file.
    due: Option<Instant>,
}

impl Engine {
    /// Publishes what the record holds of `look`, and keeps it up to date; nothing for `None`.
    pub(super) fn look_at_record(&mut self, look: Option<RecordLook>) {
        if look.is_none() {
            self.record_reading.found = None;
        }
        self.record_reading.wanted = look;
        self.read_record();
    }

    /// A pass more, or one that was not tracked, is on its way into the record, or another record is in use.
    pub(super) fn record_has_grown(&mut self) {
        self.record_reading.due = Some(self.steady + UNTIL_WRITTEN);
    }

    fn read_record(&mut self) {
        self.record_reading.due = None;
        let Some(look) = self.record_reading.wanted.clone() else {
            self.record_reading.job = None;
            return;
        };
        let Some(path) = self.record_file() else {
            let found = Err("this user has no folder for records".to_owned());
            self.record_reading.found = Some(Arc::new(Recorded { look, found, together: None }));
            return;
        };
        let site = self.station.site;
        let job = Job::start("azel-look-back", Arc::clone(&self.wake), move |_| {
            Recorded::read(&path, look, site)
        });
        self.record_reading.job =
            job.inspect_err(|error| tracing::error!(%error, "no thread to read the record")).ok();
    }

    pub(super) fn take_recorded(&mut self) {
        if self.record_reading.due.is_some_and(|due| due <= self.steady) {
            self.read_record();
        }
        if let Some(Ok(mut recorded)) = Job::take(&mut self.record_reading.job) {
            let before = self.record_reading.found.take();
            let before = before.filter(|before| before.has_same_passes(&recorded));
            recorded.together = before.as_ref().and_then(|before| before.together.clone());
            self.record_reading.found = Some(Arc::new(recorded));
            if before.is_none() {
                self.explain_together();
            }
        }
        if let Some(Ok(together)) = Job::take(&mut self.record_reading.explaining)
            && let Some(found) = &mut self.record_reading.found
        {
            Arc::make_mut(found).together = together;
        }
    }

    fn explain_together(&mut self) {
        let reading = &mut self.record_reading;
        reading.explaining = None;
        let found = reading.found.as_ref().and_then(|of| of.found.as_ref().ok());
        let Some(opened) = found.and_then(|found| found.opened.as_ref()) else { return };
        let (antenna, until) = (opened.pass.antenna, opened.pass.report.until);
        let configured = self.station.antennas.iter().find(|of| of.id == antenna);
        // An antenna that has left the station has no known mount.
        let (Some(of), Some(path)) = (configured, self.record_file()) else { return };
        let (mount, site) = (of.mount, self.station.site);
        let job = Job::start("azel-explain-passes", Arc::clone(&self.wake), move |_| {
            let explained =
                record::explain_passes(&path, antenna, mount, site, &(Timestamp::MIN..=until));
            explained.inspect_err(|error| tracing::error!(%error, "passes not explained")).ok()
        });
        self.record_reading.explaining =
            job.inspect_err(|error| tracing::error!(%error, "no thread to explain passes")).ok();
    }
}

fn read(path: &Path, look: &RecordLook, site: Site) -> Result<Found, RecordError> {
    let page = record::passes(path, &look.query)?;
    let missed = record::missed(path, &look.query, &page)?;
    let missed = missed.into_iter().filter_map(MissedPass::of).collect();
    let opened = look.opened.map(|id| record::open_pass(path, id, site)).transpose()?.flatten();
    Ok(Found { page, missed, opened })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        clock::Clock,
        engine::automatic::{DayEvent, DayLine, MissCause},
        plan::pass_report::LossCause,
        record::{Entry, Kind, Recorder},
        station::Retention,
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
        for of in [&missed, &in_part] {
            let line = DayLine { at: now.utc, antenna, what: DayEvent::Flown(of.clone()) };
            recorder.note(Entry::new(now, Some(antenna), Kind::Day, &line));
        }
        recorder.flush();
        let query = PassQuery { count: 10, ..PassQuery::default() };
        let look = RecordLook { query, opened: None };
        let found = Recorded::read(&path, look, Site::default()).found.unwrap();
        let [only] = &found.missed[..] else { panic!("{found:?}") };
        assert_eq!((only.antenna, &only.flown), (antenna, &missed));
    }
}
