//! Tests of links to units.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{claim::HeldBy, driver::LinkFinding, station::Antenna, written};

/// The last test of an antenna.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkTest {
    /// As it was tested.
    #[serde(with = "written::antenna")]
    pub antenna: Antenna,
    pub stage: LinkTestStage,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LinkTestStage {
    Working,
    /// Nothing was asked: an antenna of this station has the unit.
    InUse,
    /// Nothing was asked: another Azel has the unit.
    Elsewhere(HeldBy),
    Done {
        finding: LinkFinding,
        #[serde(rename = "at")]
        time: Timestamp,
    },
}
