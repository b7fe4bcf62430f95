//! The fit of a pointing model that a client asked for.

use std::sync::Arc;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::Engine;
use crate::{
    job::Job,
    record::{self, PointingFit},
    station::AntennaId,
};

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
}

impl PointingWork {
    fn tell(&mut self, antenna: AntennaId, found: Option<Result<PointingFit, String>>) {
        self.fitted = Some(Arc::new(PointingFitted { antenna, found }));
    }
}

impl Engine {
    /// Publishes the pointing model that fits the recorded passes of `antenna`.
    pub(super) fn fit_pointing(&mut self, antenna: AntennaId) {
        self.pointing_work.job = None;
        let Some(path) = self.record_file() else {
            let found = Err("this user has no folder for records".to_owned());
            return self.pointing_work.tell(antenna, Some(found));
        };
        let site = self.station.site;
        let job = Job::start("azel-fit-pointing", Arc::clone(&self.wake), move |_| {
            let all = Timestamp::MIN..Timestamp::MAX;
            let fit = record::fit_pointing(&path, antenna, site, all, Vec::new());
            PointingFitted { antenna, found: Some(fit.map_err(|error| error.to_string())) }
        });
        let found = job.as_ref().err().map(|error| Err(error.to_string()));
        self.pointing_work.job = job.ok();
        self.pointing_work.tell(antenna, found);
    }

    pub(super) fn take_pointing_fit(&mut self) {
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
