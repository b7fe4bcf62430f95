//! What a client looks back at: passes of the record, read from its file.

use std::{path::Path, sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::Engine;
use crate::{
    astro::Site,
    clock::Instant,
    job::Job,
    record::{self, ExplainedPasses, OpenedPass, PassPage, PassQuery, RecordError},
};

/// Time from the end of the work on a report until it can be read from the file.
const UNTIL_WRITTEN: Duration = Duration::from_secs(1);

/// What is looked at of the record.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RecordLook {
    pub query: PassQuery,
    /// Number of the pass whose track is shown.
    pub opened: Option<i64>,
}

/// What the record holds of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    pub look: RecordLook,
    /// Or why the record cannot be read.
    pub found: Result<Found, String>,
    /// What explains the opened pass and those before it together. It takes longer than the rest.
    pub together: Option<ExplainedPasses>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    pub page: PassPage,
    pub opened: Option<OpenedPass>,
}

impl Recorded {
    /// Reads the record at `path`. Reports without a site are of an antenna at `site`.
    pub fn read(path: &Path, look: RecordLook, site: Site) -> Self {
        let found = read(path, &look, site).map_err(|error| error.to_string());
        Self { look, found, together: None }
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

    /// A pass more is on its way into the record, or another record is in use.
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
        if let Some(Ok(recorded)) = Job::take(&mut self.record_reading.job) {
            self.record_reading.found = Some(Arc::new(recorded));
            self.explain_together();
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
        let Some(path) = self.record_file() else { return };
        let site = self.station.site;
        let job = Job::start("azel-explain-passes", Arc::clone(&self.wake), move |_| {
            let explained = record::explain_passes(&path, antenna, site, &(Timestamp::MIN..until));
            explained.inspect_err(|error| tracing::error!(%error, "passes not explained")).ok()
        });
        self.record_reading.explaining =
            job.inspect_err(|error| tracing::error!(%error, "no thread to explain passes")).ok();
    }
}

fn read(path: &Path, look: &RecordLook, site: Site) -> Result<Found, RecordError> {
    let page = record::passes(path, &look.query)?;
    let opened = look.opened.map(|id| record::open_pass(path, id, site)).transpose()?.flatten();
    Ok(Found { page, opened })
}
