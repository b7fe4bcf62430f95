//! Recorded passes for the views of the record.

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

/// Selection of recorded passes.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct PassQuery {
    pub antenna: Option<AntennaId>,
    pub kind: Option<ListedKind>,
    /// Part of the satellite's name, its catalog number, or the beginning of a date.
    pub text: String,
    /// Max number of passes; the newest count.
    pub count: u32,
}

/// Kind of passes that a query selects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ListedKind {
    /// Tracked passes with this verdict.
    Tracked(PassVerdict),
    /// Passes that automatic operation should have tracked, but did not.
    NotTracked,
}

/// A tracked pass of the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordedPass {
    /// Number in the record.
    pub id: i64,
    pub antenna: AntennaId,
    /// Name of the antenna at the time.
    pub antenna_name: String,
    pub report: RecordedReport,
}

/// Result of a query, newest pass first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PassPage {
    pub passes: Vec<RecordedPass>,
    /// Number of passes that match the query, without its limit.
    pub matching: u32,
    /// Number of all passes in the record.
    pub all: u32,
    /// LOS of the first pass in the record.
    #[serde(rename = "since")]
    pub start: Option<Timestamp>,
    /// Number of passes of the page with an unreadable report.
    pub unreadable: u32,
}

/// A pass with its track and its events.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenedPass {
    pub pass: RecordedPass,
    /// Measured and predicted track, about one point a second.
    pub track: Vec<TrackPoint>,
    /// The predicted path from AOS to LOS.
    pub path: Vec<Sample>,
    /// Entries of the antenna, from five minutes before the start of its track to one minute after
    /// LOS. A gap in this period carries the time of its end, which may be later.
    pub entries: Vec<Row>,
}

/// Times of a pass for a time line.
#[derive(Debug, Clone, PartialEq)]
pub struct PassTimes {
    /// Short name of the satellite.
    pub name: String,
    pub aos: Timestamp,
    /// Time of closest approach; `None` if the elements cannot be propagated.
    pub tca: Option<Timestamp>,
    pub los: Timestamp,
    /// Intervals with the satellite outside half the beamwidth, or without measurements.
    pub lost: Vec<(Timestamp, Timestamp)>,
}

/// Common causes of the errors of several passes of an antenna.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExplainedPasses {
    pub passes: usize,
    /// LOS of the first of these passes; `None` without passes.
    #[serde(rename = "since")]
    pub start: Option<Timestamp>,
    /// Cause that these passes share, or up to three causes that they cannot separate, best first.
    pub explanations: Vec<Explanation>,
}

/// A row of the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Time, UTC.
    pub time: Timestamp,
    /// Number of the run of the program.
    pub run: i64,
    /// Seconds of the steady clock since the start of that run; `None` for lines on a link.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady_s: Option<f64>,
    /// Name of the antenna at the time, if the row concerns an antenna.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub antenna: Option<String>,
    pub kind: String,
    /// Content, depending on the kind; see `docs/record.md`.
    pub data: Value,
}

impl Row {
    /// Returns the time of the last entry before a gap.
    pub fn gap_since(&self) -> Option<Timestamp> {
        self.data.get("since")?.as_str()?.parse().ok()
    }
}
