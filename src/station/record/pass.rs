//! Pass that an antenna tracked, in the form of the record.

use crate::{
    contract::record::RecordedReport, plan::pass_report::MeasuredPosition, station::AntennaId,
};

/// Report of a tracked pass with its track, for the record.
#[derive(Debug, Clone, PartialEq)]
pub struct PassNote {
    pub antenna: AntennaId,
    pub report: RecordedReport,
    /// Track, about one point a second.
    pub points: Vec<MeasuredPosition>,
}
