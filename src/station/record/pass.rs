//! A pass that an antenna tracked, as it is kept.

use crate::{
    contract::record::RecordedReport, plan::pass_report::MeasuredPosition, station::AntennaId,
};

/// A pass that an antenna has tracked, to be kept.
#[derive(Debug, Clone, PartialEq)]
pub struct PassNote {
    pub antenna: AntennaId,
    pub report: RecordedReport,
    /// The track, about a point a second.
    pub points: Vec<MeasuredPosition>,
}
