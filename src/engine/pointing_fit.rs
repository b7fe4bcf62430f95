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

impl Engine {
    /// Publishes the pointing model that fits the recorded passes of `antenna`.
    pub(super) fn fit_pointing(&mut self, antenna: AntennaId) {
        let tell = |found| Some(Arc::new(PointingFitted { antenna, found }));
        let Some(path) = self.record_file() else {
            let found = Err("this user has no folder for records".to_owned());
            self.pointing_fitted = tell(Some(found));
            return;
        };
        self.pointing_fitted = tell(None);
        let site = self.station.site;
        let job = Job::start("azel-fit-pointing", Arc::clone(&self.wake), move |_| {
            let all = Timestamp::MIN..Timestamp::MAX;
            let fit = record::fit_pointing(&path, antenna, site, all, Vec::new());
            PointingFitted { antenna, found: Some(fit.map_err(|error| error.to_string())) }
        });
        match job {
            Ok(job) => self.pointing_job = Some(job),
            Err(error) => self.pointing_fitted = tell(Some(Err(error.to_string()))),
        }
    }

    pub(super) fn take_pointing_fit(&mut self) {
        if let Some(Ok(fitted)) = Job::take(&mut self.pointing_job) {
            self.pointing_fitted = Some(Arc::new(fitted));
        }
    }
}
