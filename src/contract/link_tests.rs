//! Tests of links to units.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{claim::HeldBy, driver::LinkFinding, station::Antenna, written};

/// Last test of an antenna's link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkTest {
    /// The antenna as tested.
    #[serde(with = "written::antenna")]
    pub antenna: Antenna,
    pub stage: LinkTestStage,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LinkTestStage {
    Working,
    /// Azel asked nothing, because an antenna of this station uses the unit.
    InUse,
    /// Azel asked nothing, because another Azel uses the unit.
    Elsewhere(HeldBy),
    Done {
        finding: LinkFinding,
        #[serde(rename = "at")]
        time: Timestamp,
    },
}
