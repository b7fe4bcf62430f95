//! Passes of the record for other programs.

use std::fmt::Write as _;

use serde::Serialize;

use super::{OpenedPass, RecordedReport, Row};
use crate::plan::{pass_export::quoted, pass_report::TrackPoint};

/// Columns of the points. New ones stand at the end.
const COLUMNS: &str = "time,azimuth_deg,elevation_deg,satellite_azimuth_deg,\
    satellite_elevation_deg,off_deg,azimuth_error_deg,elevation_error_deg,along_deg,across_deg";

/// Columns of the points of several passes.
const SEVERAL: &str = "antenna,satellite,name";

/// A report with the program that wrote it.
#[derive(Serialize)]
struct Whole<'a> {
    program: &'static str,
    #[serde(flatten)]
    pass: Told<'a>,
}

#[derive(Serialize)]
struct Several<'a> {
    program: &'static str,
    passes: Vec<Told<'a>>,
}

#[derive(Serialize)]
struct Told<'a> {
    antenna: &'a str,
    satellite: u32,
    name: &'a str,
    report: &'a RecordedReport,
    entries: &'a [Row],
}

const PROGRAM: &str = concat!("Azel ", env!("CARGO_PKG_VERSION"));

impl OpenedPass {
    /// The points of the track as comma-separated values, a line each; lines end with LF.
    pub fn csv(&self) -> String {
        let mut text = format!("{COLUMNS}\n");
        for point in &self.track {
            push_point(&mut text, point);
        }
        text
    }

    /// The report with its entries as JSON; `docs/record.md` tells the fields.
    pub fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(&Whole { program: PROGRAM, pass: self.told() })
    }

    fn told(&self) -> Told<'_> {
        let report = &self.pass.report;
        Told {
            antenna: &self.pass.antenna_name,
            satellite: report.elements.catalog_number(),
            name: report.elements.name(),
            report,
            entries: &self.entries,
        }
    }
}

/// [`OpenedPass::csv`] of several passes, with what each point is of before it.
pub fn csv_of_several(passes: &[OpenedPass]) -> String {
    let mut text = format!("{SEVERAL},{COLUMNS}\n");
    for pass in passes {
        let Told { antenna, satellite, name, .. } = pass.told();
        let of = format!("{},{satellite},{},", quoted(antenna), quoted(name));
        for point in &pass.track {
            text += &of;
            push_point(&mut text, point);
        }
    }
    text
}

/// [`OpenedPass::json`] of several passes.
pub fn json_of_several(passes: &[OpenedPass]) -> serde_json::Result<String> {
    let passes = passes.iter().map(OpenedPass::told).collect();
    serde_json::to_string_pretty(&Several { program: PROGRAM, passes })
}

fn push_point(text: &mut String, point: &TrackPoint) {
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
