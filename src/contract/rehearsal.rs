//! Outcome of a rehearsal.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    automatic::{DayLine, Flown, OffBecause},
    record::RecordedReport,
    station::AntennaId,
};

/// A completed rehearsal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rehearsed {
    #[serde(rename = "from")]
    pub start: Timestamp,
    pub hours: f64,
    pub seed: u64,
    /// Passes by start, then by antenna.
    pub passes: Vec<RehearsedPass>,
    /// Ends and suspensions of automatic operation, with the reasons.
    pub interruptions: Vec<DayLine>,
    /// Names of the antennas whose make has no simulator.
    pub left_out: Vec<String>,
}

/// A pass of the plan, and its outcome.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RehearsedPass {
    pub antenna: AntennaId,
    pub antenna_name: String,
    pub satellite: u32,
    pub satellite_name: String,
    pub aos: Timestamp,
    pub los: Timestamp,
    /// Start of the planned track.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "to")]
    pub end: Timestamp,
    /// Seconds within half the beamwidth that the plan promised when it first named the pass.
    pub promised_s: f64,
    /// A newer plan left the pass out before it began.
    pub is_given_up: bool,
    /// Outcome that automatic operation reports; `None` if the antenna never set out.
    pub flown: Option<Flown>,
    /// Reason why automatic operation of the antenna was off; `None` if the antenna set out.
    #[serde(rename = "off")]
    pub off_reason: Option<OffBecause>,
    /// Report of the track; `None` if the antenna never tracked.
    pub report: Option<RecordedReport>,
}

impl RehearsedPass {
    /// Returns the seconds within half the beamwidth.
    pub fn got_s(&self) -> f64 {
        self.flown.as_ref().map_or(0.0, |flown| flown.in_beam_s)
    }

    /// Returns the promised seconds that were lost.
    pub fn lost_s(&self) -> f64 {
        (self.promised_s - self.got_s()).max(0.0)
    }

    pub fn rms_deg(&self) -> Option<f64> {
        self.report.as_ref()?.report.rms.map(|rms| rms.off_deg)
    }

    pub fn worst_deg(&self) -> Option<f64> {
        self.report.as_ref()?.report.worst.map(|worst| worst.error.off_deg)
    }
}
