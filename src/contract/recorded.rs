//! Passes of the record that a client looks at.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    automatic::Flown,
    record::{ExplainedPasses, OpenedPass, PassPage, PassQuery},
    station::AntennaId,
};

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
    #[serde(rename = "together")]
    pub combined: Option<ExplainedPasses>,
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
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub antenna: AntennaId,
    /// Name of the antenna at the time.
    pub antenna_name: String,
    pub flown: Flown,
}
