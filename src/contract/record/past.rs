//! Passes of a record, as somebody looks back at them.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{
    plan::{
        Sample,
        pass_report::{Explanation, PassVerdict, TrackPoint},
    },
    record::RecordedReport,
    station::AntennaId,
};

/// Which passes are looked at.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct PassQuery {
    pub antenna: Option<AntennaId>,
    pub kind: Option<ListedKind>,
    /// Part of the name of the satellite, its catalog number, or the beginning of a date.
    pub text: String,
    /// So many at most, the newest.
    pub count: u32,
}

/// A kind of passes in a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ListedKind {
    /// Tracked, with this verdict.
    Tracked(PassVerdict),
    /// To be tracked by automatic operation, and not tracked.
    NotTracked,
}

/// A pass of the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordedPass {
    /// Number in the record.
    pub id: i64,
    pub antenna: AntennaId,
    /// Name of the antenna at the time.
    pub antenna_name: String,
    pub report: RecordedReport,
}

/// The passes that a query finds, the newest first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PassPage {
    pub passes: Vec<RecordedPass>,
    /// Number of passes that the query finds without its limit.
    pub matching: u32,
    /// Number of all passes in the record.
    pub all: u32,
    /// LOS of the first pass in the record.
    #[serde(rename = "since")]
    pub start: Option<Timestamp>,
    /// Passes of the page whose report cannot be read.
    pub unreadable: u32,
}

/// A pass with its track and what happened in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenedPass {
    pub pass: RecordedPass,
    /// The measured track beside the predicted one, about a point a second.
    pub track: Vec<TrackPoint>,
    /// The predicted path from AOS to LOS.
    pub path: Vec<Sample>,
    /// Entries of the antenna, from five minutes before its track began to a minute after LOS; a gap
    /// in that time has its own time at its end, which may be later.
    pub entries: Vec<Row>,
}

/// The times of a pass that are marked on a time line.
#[derive(Debug, Clone, PartialEq)]
pub struct PassTimes {
    /// Short name of the satellite.
    pub name: String,
    pub aos: Timestamp,
    /// `None` where the elements cannot be propagated.
    pub tca: Option<Timestamp>,
    pub los: Timestamp,
    /// When the satellite was outside half the beamwidth, or nothing was measured.
    pub lost: Vec<(Timestamp, Timestamp)>,
}

/// Causes of the errors of several passes of an antenna together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExplainedPasses {
    /// Number of passes.
    pub passes: usize,
    /// LOS of the first of them; `None` where there is none.
    #[serde(rename = "since")]
    pub start: Option<Timestamp>,
    /// The cause that these passes share, or up to three that they do not tell apart, the best first.
    pub explanations: Vec<Explanation>,
}

/// A row of the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// UTC.
    pub time: Timestamp,
    /// Number of the run of the program.
    pub run: i64,
    /// Seconds of the steady clock since that run began; `None` for lines on a link.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady_s: Option<f64>,
    /// Name of the antenna at the time, if the row has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub antenna: Option<String>,
    pub kind: String,
    /// Content, according to the kind; see `docs/record.md`.
    pub data: Value,
}

impl Row {
    /// When something was written last before a gap.
    pub fn gap_since(&self) -> Option<Timestamp> {
        self.data.get("since")?.as_str()?.parse().ok()
    }
}
