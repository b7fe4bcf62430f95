//! Recorded passes: the points of their tracks as CSV, and their reports as JSON.

use std::{
    borrow::Cow,
    io::{self, Write},
};

use serde::Serialize;

use super::{FORMAT_VERSION, RowFormat, Time, rounded, write_rows};
use crate::{
    contract::record::{OpenedPass, RecordedReport, Row as Entry},
    plan::pass_report::TrackPoint,
};

/// A point of a track with its columns. New columns go at the end.
#[derive(Default, Serialize)]
struct Point<'a> {
    antenna: Cow<'a, str>,
    satellite: u32,
    name: Cow<'a, str>,
    time: Time,
    azimuth_deg: f64,
    elevation_deg: f64,
    satellite_azimuth_deg: f64,
    satellite_elevation_deg: f64,
    off_deg: f64,
    azimuth_error_deg: f64,
    elevation_error_deg: f64,
    along_deg: f64,
    across_deg: f64,
}

/// A pass with its report and its events.
#[derive(Serialize)]
struct Pass<'a> {
    antenna: &'a str,
    satellite: u32,
    name: &'a str,
    report: &'a RecordedReport,
    entries: &'a [Entry],
}

#[derive(Serialize)]
struct Whole<'a> {
    format_version: u32,
    program: &'static str,
    passes: Vec<Pass<'a>>,
}

/// Writes the points of the tracks of these passes as comma-separated values.
pub fn points(out: &mut impl Write, passes: &[OpenedPass]) -> io::Result<()> {
    let points = passes.iter().flat_map(|opened| {
        let (antenna, elements) = (&opened.pass.antenna_name, &opened.pass.report.elements);
        let [antenna, name] = [antenna, elements.name()].map(|text| RowFormat::Csv.text(text));
        let satellite = elements.catalog_number();
        opened.track.iter().map(move |point| Point {
            antenna: antenna.clone(),
            satellite,
            name: name.clone(),
            ..Point::new(point)
        })
    });
    write_rows(out, RowFormat::Csv, ("points", &[]), &Point::default(), points)
}

/// Writes the reports of these passes with their entries as JSON; `docs/record.md` describes the
/// fields.
pub fn reports(out: &mut impl Write, passes: &[OpenedPass]) -> io::Result<()> {
    let passes = passes.iter().map(|opened| Pass {
        antenna: &opened.pass.antenna_name,
        satellite: opened.pass.report.elements.catalog_number(),
        name: opened.pass.report.elements.name(),
        report: &opened.pass.report,
        entries: &opened.entries,
    });
    let whole = Whole {
        format_version: FORMAT_VERSION,
        program: concat!("Azel ", env!("CARGO_PKG_VERSION")),
        passes: passes.collect(),
    };
    serde_json::to_writer_pretty(&mut *out, &whole)?;
    writeln!(out)
}

impl Point<'_> {
    fn new(point: &TrackPoint) -> Self {
        let TrackPoint { time, antenna, satellite, error } = point;
        let degrees = |value_deg| rounded(value_deg, 1e4);
        Self {
            time: Time(*time),
            azimuth_deg: degrees(antenna.azimuth_deg()),
            elevation_deg: degrees(antenna.elevation_deg()),
            satellite_azimuth_deg: degrees(satellite.azimuth_deg()),
            satellite_elevation_deg: degrees(satellite.elevation_deg()),
            off_deg: degrees(error.off_deg),
            azimuth_error_deg: degrees(error.azimuth_deg),
            elevation_error_deg: degrees(error.elevation_deg),
            along_deg: degrees(error.along_deg),
            across_deg: degrees(error.across_deg),
            ..Self::default()
        }
    }
}
