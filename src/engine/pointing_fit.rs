//! The fit of a pointing model that a client asked for, and the peaks that count in it.

use std::{path::PathBuf, sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::Engine;
use crate::{
    astro::Term,
    clock::Instant,
    job::Job,
    record::{self, Peak, PeakChange, Peaks, PointingFit, RecordError},
    station::AntennaId,
};

/// Time until peaks that could not be read are read again.
const AGAIN: Duration = Duration::from_secs(5);

/// A fit to the record of an antenna. It changes nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointingFitted {
    pub antenna: AntennaId,
    /// Or why there is none. `None` while it is worked out.
    pub found: Option<Result<PointingFit, String>>,
}

/// The fit that is worked out, or was last.
#[derive(Default)]
pub(super) struct PointingWork {
    pub(super) fitted: Option<Arc<PointingFitted>>,
    job: Option<Job<PointingFitted>>,
    pub(super) peaks: Arc<Peaks>,
    /// The record that they are of, and the work of reading it.
    peaks_of: Option<PathBuf>,
    reading: Option<Job<Result<Peaks, RecordError>>>,
    /// Why they are not known, and when they are read again.
    unread: Option<(Instant, String)>,
}

impl PointingWork {
    fn tell(&mut self, antenna: AntennaId, found: Option<Result<PointingFit, String>>) {
        self.fitted = Some(Arc::new(PointingFitted { antenna, found }));
    }
}

impl Engine {
    /// Reads the peaks of the record in use, where that is another one.
    pub(super) fn read_peaks(&mut self) {
        let path = self.record_file();
        let work = &mut self.pointing_work;
        let is_due = work.unread.as_ref().is_some_and(|(due, _)| *due <= self.steady);
        if path == work.peaks_of && !is_due {
            return;
        }
        if path != work.peaks_of {
            work.peaks = Arc::default();
        }
        (work.reading, work.unread) = (None, None);
        work.peaks_of.clone_from(&path);
        let Some(path) = path else { return };
        let job = Job::start("azel-peaks", Arc::clone(&self.wake), move |_| Peaks::read(&path));
        self.pointing_work.reading =
            job.inspect_err(|error| tracing::error!(%error, "no thread to read the peaks")).ok();
    }

    /// Records a change of the peaks, from which on clients and fits see it.
    pub(super) fn change_peaks(&mut self, antenna: AntennaId, change: PeakChange) {
        if self.note_peak(antenna, change) {
            Arc::make_mut(&mut self.pointing_work.peaks).change(antenna, change);
        }
    }

    /// Publishes the pointing model that fits the recorded passes and the peaks of `antenna` best,
    /// `without` some terms.
    pub(super) fn fit_pointing(&mut self, antenna: AntennaId, without: Vec<Term>) {
        self.pointing_work.job = None;
        let Some(path) = self.record_file() else {
            let found = Err("this user has no folder for records".to_owned());
            return self.pointing_work.tell(antenna, Some(found));
        };
        if let Some((_, why)) = &self.pointing_work.unread {
            let found = Err(format!("the peaks of the Sun and the Moon cannot be read: {why}"));
            return self.pointing_work.tell(antenna, Some(found));
        }
        let site = self.station.site;
        let peaks: Vec<Peak> = self.pointing_work.peaks.of(antenna).copied().collect();
        let job = Job::start("azel-fit-pointing", Arc::clone(&self.wake), move |_| {
            let all = Timestamp::MIN..Timestamp::MAX;
            let fit = record::fit_pointing(&path, antenna, site, all, &peaks, without);
            PointingFitted { antenna, found: Some(fit.map_err(|error| error.to_string())) }
        });
        let found = job.as_ref().err().map(|error| Err(error.to_string()));
        self.pointing_work.job = job.ok();
        self.pointing_work.tell(antenna, found);
    }

    pub(super) fn take_pointing_fit(&mut self) {
        if self.pointing_work.unread.is_some() {
            self.read_peaks();
        }
        let again = self.steady + AGAIN;
        let work = &mut self.pointing_work;
        match Job::take(&mut work.reading) {
            None => {}
            Some(Ok(Ok(mut read))) => {
                // What was entered while it was read.
                read.extend(&work.peaks);
                work.peaks = Arc::new(read);
            }
            // The record may just be made.
            Some(Ok(Err(error))) => work.unread = Some((again, error.to_string())),
            Some(Err(error)) => work.unread = Some((again, error.to_string())),
        }
        match Job::take(&mut work.job) {
            None => {}
            Some(Ok(fitted)) => work.fitted = Some(Arc::new(fitted)),
            Some(Err(error)) => {
                if let Some(antenna) = work.fitted.as_ref().map(|fitted| fitted.antenna) {
                    work.tell(antenna, Some(Err(error.to_string())));
                }
            }
        }
    }
}
