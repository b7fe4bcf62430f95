//! A pass of the record for other programs.

use std::fmt::Write as _;

use serde::Serialize;

use super::{OpenedPass, RecordedReport, Row};
use crate::plan::pass_report::TrackPoint;

/// Columns of the points. New ones stand at the end.
const COLUMNS: &str = "time,azimuth_deg,elevation_deg,satellite_azimuth_deg,\
    satellite_elevation_deg,off_deg,azimuth_error_deg,elevation_error_deg,along_deg,across_deg";

#[derive(Serialize)]
struct Whole<'a> {
    program: &'static str,
    antenna: &'a str,
    satellite: u32,
    name: &'a str,
    report: &'a RecordedReport,
    entries: &'a [Row],
}

impl OpenedPass {
    /// The points of the track as comma-separated values, a line each; lines end with LF.
    pub fn csv(&self) -> String {
        let mut text = format!("{COLUMNS}\n");
        for point in &self.track {
            let TrackPoint { time, antenna, satellite, error } = point;
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{time:.3},{:.4},{:.4},{:.4},{:.4},{:.4},{:.4},{:.4},{:.4},{:.4}",
                antenna.azimuth_deg(),
                antenna.elevation_deg(),
                satellite.azimuth_deg(),
                satellite.elevation_deg(),
                error.off_deg,
                error.azimuth_deg,
                error.elevation_deg,
                error.along_deg,
                error.across_deg,
            );
        }
        text
    }

    /// The report with its entries as JSON; `docs/record.md` tells the fields.
    pub fn json(&self) -> serde_json::Result<String> {
        let report = &self.pass.report;
        serde_json::to_string_pretty(&Whole {
            program: concat!("Azel ", env!("CARGO_PKG_VERSION")),
            antenna: &self.pass.antenna_name,
            satellite: report.elements.catalog_number(),
            name: report.elements.name(),
            report,
            entries: &self.entries,
        })
    }
}
