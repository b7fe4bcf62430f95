//! Fit of a pointing model for a client, and the peaks that count in the fit.

use std::{path::PathBuf, sync::Arc, time::Duration};

use jiff::Timestamp;

use super::Engine;
use crate::{
    astro::Term,
    clock::Instant,
    contract::record::{Peak, PeakChange, Peaks, PointingFit, PointingFitted},
    job::Job,
    record::{self, RecordError, read_peaks},
    station::AntennaId,
};

/// Pause before Azel reads peaks again after a failure.
const AGAIN: Duration = Duration::from_secs(5);

/// Current or last fit, and the peaks of the record.
#[derive(Default)]
pub(super) struct PointingWork {
    pub(super) fitted: Option<Arc<PointingFitted>>,
    job: Option<Job<PointingFitted>>,
    /// Pending fit that starts once the peaks are read.
    waiting: Option<(AntennaId, Vec<Term>)>,
    pub(super) peaks: Arc<Peaks>,
    /// Record that `peaks` belongs to.
    peaks_of: Option<PathBuf>,
    peaks_state: PeaksState,
}

/// Reading state of the record's peaks.
#[derive(Default)]
enum PeaksState {
    /// No record is in use.
    #[default]
    None,
    Reading(Job<Result<Peaks, RecordError>>),
    Unread {
        again: Instant,
        reason: String,
    },
    Known,
}

/// Peaks that count in a fit.
#[derive(Debug, PartialEq)]
enum Counting {
    Peaks(Vec<Peak>),
    /// The peaks are still being read.
    NotYet,
    Unread(String),
}

impl PointingWork {
    fn tell(&mut self, antenna: AntennaId, found: Option<Result<PointingFit, String>>) {
        self.fitted = Some(Arc::new(PointingFitted { antenna, found }));
    }

    fn counting(&self, antenna: AntennaId) -> Counting {
        match &self.peaks_state {
            PeaksState::None | PeaksState::Known => {
                Counting::Peaks(self.peaks.for_antenna(antenna).copied().collect())
            }
            PeaksState::Reading(_) => Counting::NotYet,
            PeaksState::Unread { reason, .. } => Counting::Unread(reason.clone()),
        }
    }

    fn take_peaks(&mut self, again: Instant) {
        let PeaksState::Reading(job) = &self.peaks_state else { return };
        let reason = match job.end() {
            None => return,
            Some(Ok(Ok(mut read))) => {
                // Add the peaks that were entered during the read.
                read.extend(&self.peaks);
                self.peaks = Arc::new(read);
                self.peaks_state = PeaksState::Known;
                return;
            }
            // The read may fail while the record is being created, so Azel tries again.
            Some(Ok(Err(error))) => error.to_string(),
            Some(Err(error)) => error.to_string(),
        };
        self.peaks_state = PeaksState::Unread { again, reason };
    }
}

impl Engine {
    /// Reads the peaks of the record in use if the record changed or a retry is due.
    pub(super) fn read_peaks(&mut self) {
        let path = self.record_file();
        let work = &mut self.pointing_work;
        let is_due =
            matches!(&work.peaks_state, PeaksState::Unread { again, .. } if *again <= self.steady);
        if path == work.peaks_of && !is_due {
            return;
        }
        if path != work.peaks_of {
            work.peaks = Arc::default();
        }
        work.peaks_state = PeaksState::None;
        work.peaks_of.clone_from(&path);
        let Some(path) = path else { return };
        work.peaks_state =
            PeaksState::Reading(Job::start("azel-peaks", Arc::clone(&self.wake), move |_| {
                read_peaks(&path)
            }));
    }

    /// Records a change of the peaks; clients and fits then see the change.
    pub(super) fn change_peaks(&mut self, antenna: AntennaId, change: PeakChange) {
        if self.note_peak(antenna, change) {
            Arc::make_mut(&mut self.pointing_work.peaks).change(antenna, change);
        }
    }

    /// Publishes the pointing model that best fits the recorded passes and peaks of `antenna`,
    /// without the `excluded` terms.
    pub(super) fn fit_pointing(&mut self, antenna: AntennaId, excluded: Vec<Term>) {
        let path = self.record_file();
        let work = &mut self.pointing_work;
        (work.job, work.waiting) = (None, None);
        let Some(path) = path else {
            let found = Err("this user has no folder for records".to_owned());
            return work.tell(antenna, Some(found));
        };
        let peaks = match work.counting(antenna) {
            Counting::Peaks(peaks) => peaks,
            Counting::NotYet => {
                work.waiting = Some((antenna, excluded));
                return work.tell(antenna, None);
            }
            Counting::Unread(reason) => {
                let found =
                    Err(format!("the peaks of the Sun and the Moon cannot be read: {reason}"));
                return work.tell(antenna, Some(found));
            }
        };
        let site = self.station.site;
        let job = Job::start("azel-fit-pointing", Arc::clone(&self.wake), move |_| {
            let all = Timestamp::MIN..=Timestamp::MAX;
            let fit = record::fit_pointing(&path, antenna, site, &all, &peaks, excluded);
            PointingFitted { antenna, found: Some(fit.map_err(|error| error.to_string())) }
        });
        work.job = Some(job);
        work.tell(antenna, None);
    }

    pub(super) fn take_pointing_fit(&mut self) {
        if matches!(self.pointing_work.peaks_state, PeaksState::Unread { .. }) {
            self.read_peaks();
        }
        self.pointing_work.take_peaks(self.steady + AGAIN);
        if !matches!(self.pointing_work.peaks_state, PeaksState::Reading(_))
            && let Some((antenna, excluded)) = self.pointing_work.waiting.take()
        {
            self.fit_pointing(antenna, excluded);
        }
        let work = &mut self.pointing_work;
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

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;
    use crate::{clock::Clock, contract::record::PeakBody, job::BrokeOff};

    const ANTENNA: AntennaId = AntennaId(3);

    fn peaks() -> (Peak, Peaks) {
        let time = Timestamp::UNIX_EPOCH;
        let peak = Peak { body: PeakBody::Sun, time, azimuth_deg: 100.0, elevation_deg: 20.0 };
        let mut peaks = Peaks::default();
        peaks.change(ANTENNA, PeakChange::Added(peak));
        (peak, peaks)
    }

    #[test]
    fn a_fit_leaves_out_no_peak_that_is_still_being_read() {
        let again = Clock::new(Timestamp::now).now().steady;
        let (peak, peaks) = peaks();
        let mut work = PointingWork::default();
        assert_eq!(work.counting(ANTENNA), Counting::Peaks(Vec::new()), "there is no record");
        let (go_on, waits) = mpsc::sync_channel(1);
        let (woken, wakes) = mpsc::sync_channel(1);
        let wake: crate::job::Wake = Arc::new(move || woken.send(()).unwrap());
        let job = Job::start("peaks", wake, move |_| {
            waits.recv().unwrap();
            Ok(peaks)
        });
        work.peaks_state = PeaksState::Reading(job);
        work.take_peaks(again);
        assert_eq!(work.counting(ANTENNA), Counting::NotYet);
        go_on.send(()).unwrap();
        wakes.recv().unwrap();
        work.take_peaks(again);
        assert_eq!(work.counting(ANTENNA), Counting::Peaks(vec![peak]));
    }

    #[test]
    fn peaks_whose_reading_breaks_off_are_unread() {
        let again = Clock::new(Timestamp::now).now().steady;
        let (woken, wakes) = mpsc::sync_channel(1);
        let wake: crate::job::Wake = Arc::new(move || woken.send(()).unwrap());
        let job = Job::start("peaks", wake, |_| panic!("on purpose"));
        let mut work =
            PointingWork { peaks_state: PeaksState::Reading(job), ..PointingWork::default() };
        wakes.recv().unwrap();
        work.take_peaks(again);
        assert_eq!(work.counting(ANTENNA), Counting::Unread(BrokeOff.to_string()));
    }
}
