//! Passes as a list of JSON objects.

use std::io::{self, Write};

use serde::Serialize;

use super::{ExportedPass, degrees, rfc3339};
use crate::orbit::PassPoint;

#[derive(Serialize)]
struct Point {
    time: String,
    azimuth_deg: f64,
    elevation_deg: f64,
}

#[derive(Serialize)]
struct Row<'a> {
    catalog_number: u32,
    name: &'a str,
    aos: Point,
    tca: Point,
    los: Point,
    max_elevation_deg: f64,
    duration_s: f64,
    starts_before: bool,
    ends_after: bool,
}

impl From<PassPoint> for Point {
    fn from(point: PassPoint) -> Self {
        Self {
            time: rfc3339(point.time),
            azimuth_deg: degrees(point.direction.azimuth_deg()),
            elevation_deg: degrees(point.direction.elevation_deg()),
        }
    }
}

impl<'a> From<&ExportedPass<'a>> for Row<'a> {
    fn from(ExportedPass { elements, pass }: &ExportedPass<'a>) -> Self {
        Self {
            catalog_number: elements.catalog_number(),
            name: elements.name(),
            aos: pass.aos.into(),
            tca: pass.tca.into(),
            los: pass.los.into(),
            max_elevation_deg: degrees(pass.max_elevation().degrees()),
            duration_s: (pass.duration_s() * 1000.0).round() / 1000.0,
            starts_before: pass.starts_before,
            ends_after: pass.ends_after,
        }
    }
}

/// One object a line, so that the list can be compared and cut by lines too.
pub(super) fn write(out: &mut impl Write, rows: &[ExportedPass<'_>]) -> io::Result<()> {
    write!(out, "[")?;
    for (index, row) in rows.iter().enumerate() {
        writeln!(out, "{}", if index == 0 { "" } else { "," })?;
        serde_json::to_writer(&mut *out, &Row::from(row))?;
    }
    writeln!(out, "\n]")
}

#[cfg(test)]
mod tests {
    use super::super::testing::{example, written};
    use crate::plan::pass_export::PassFormat;

    #[test]
    fn rows_hold_what_others_rely_on() {
        let (elements, pass) = example();
        let text = written(PassFormat::Json, &elements, &[pass, pass]);
        let rows: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(rows.as_array().unwrap().len(), 2);
        let row = serde_json::json!({
            "catalog_number": 25_544, "name": "ISS, (ZARYA); \"1\"",
            "aos": { "time": "2026-08-12T01:02:03.457Z", "azimuth_deg": 350.5, "elevation_deg": 0.0 },
            "tca": { "time": "2026-08-12T01:07:00.000Z", "azimuth_deg": 80.25, "elevation_deg": 45.123_457 },
            "los": { "time": "2026-08-12T01:12:00.000Z", "azimuth_deg": 170.0, "elevation_deg": 0.0 },
            "max_elevation_deg": 45.123_457, "duration_s": 596.543,
            "starts_before": false, "ends_after": true
        });
        assert_eq!(rows[1], row);
    }

    #[test]
    fn no_pass_is_an_empty_list() {
        let (elements, _) = example();
        let text = written(PassFormat::Json, &elements, &[]);
        assert_eq!(serde_json::from_str::<Vec<u8>>(&text).unwrap(), Vec::<u8>::new());
    }
}
