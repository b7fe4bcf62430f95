//! Passes of the record that a client views.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    automatic::Flown,
    record::{ExplainedPasses, OpenedPass, PassPage, PassQuery},
    station::AntennaId,
};

/// Request of a client for recorded passes.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RecordLook {
    pub query: PassQuery,
    /// Number of the pass whose track the client shows.
    pub opened: Option<i64>,
}

/// Content of the record for a request.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    pub look: RecordLook,
    /// Content, or the reason why the record cannot be read.
    pub found: Result<Found, String>,
    /// Common causes for the opened pass and the passes before it. Their computation takes longer
    /// than the rest.
    #[serde(rename = "together")]
    pub combined: Option<ExplainedPasses>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    pub page: PassPage,
    /// Passes in the period of the page that automatic operation should have tracked but did not,
    /// newest first.
    pub missed: Vec<MissedPass>,
    pub opened: Option<OpenedPass>,
}

/// A pass that automatic operation should have tracked but did not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissedPass {
    /// Number of the entry in the record.
    pub id: i64,
    /// Time at which the pass was over for the antenna.
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub antenna: AntennaId,
    /// Name of the antenna at the time.
    pub antenna_name: String,
    pub flown: Flown,
}
