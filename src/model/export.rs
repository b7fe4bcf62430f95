//! What the operator saves to a file for other programs.

use std::sync::Arc;

use crate::{
    engine::passes::PassKey,
    plan::{
        pass_export::{LookFormat, PassFormat},
        schedule_export::ScheduleFormat,
    },
};

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Export {
    /// These passes.
    Passes { keys: Arc<[PassKey]>, format: PassFormat },
    /// Azimuth, elevation and range through one pass.
    Looks { pass: PassKey, format: LookFormat },
    /// The plan of all antennas.
    Schedule { format: ScheduleFormat },
    /// The page to print for the next shift.
    HandOverSheet,
}
