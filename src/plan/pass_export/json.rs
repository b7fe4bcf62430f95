//! Passes as a list of JSON objects.

use std::io::{self, Write};

use serde::Serialize;

use super::{ExportedPass, PassList, View, degrees, rfc3339, rounded, rows::write_rows};
use crate::orbit::{PassPoint, State, is_sunlit};

#[derive(Serialize)]
struct Point {
    time: String,
    azimuth_deg: f64,
    elevation_deg: f64,
    range_km: Option<f64>,
    range_rate_km_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    doppler_hz: Option<f64>,
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
    epoch: &'a str,
    age_days: f64,
    designator: Option<&'a str>,
    sunlit: Option<bool>,
    dark_at_site: bool,
}

fn point(view: &View, point: PassPoint, state: Option<State>) -> Point {
    let seen = state.map(|state| view.seen(&state, point.time));
    Point {
        time: rfc3339(point.time),
        azimuth_deg: degrees(point.direction.azimuth_deg()),
        elevation_deg: degrees(point.direction.elevation_deg()),
        range_km: seen.map(|seen| seen.range_km),
        range_rate_km_s: seen.map(|seen| seen.range_rate_km_s),
        doppler_hz: seen.and_then(|seen| seen.doppler_hz),
    }
}

impl<'a> Row<'a> {
    fn new(list: &PassList<'_>, view: &View, row: &ExportedPass<'a>) -> Self {
        let ExportedPass { satellite, pass } = row;
        let elements = &satellite.elements;
        let state = |point: PassPoint| satellite.propagator.state_at(point.time).ok();
        let tca = state(pass.tca);
        Self {
            catalog_number: elements.catalog_number(),
            name: elements.name(),
            aos: point(view, pass.aos, state(pass.aos)),
            tca: point(view, pass.tca, tca),
            los: point(view, pass.los, state(pass.los)),
            max_elevation_deg: degrees(pass.max_elevation().degrees()),
            duration_s: rounded(pass.duration_s(), 1e3),
            starts_before: pass.starts_before,
            ends_after: pass.ends_after,
            epoch: &satellite.epoch,
            age_days: satellite.age_days(pass.aos.time),
            designator: elements.international_designator(),
            sunlit: tca.map(|state| is_sunlit(&state, pass.tca.time)),
            dark_at_site: list.is_dark(pass.tca.time),
        }
    }
}

/// Writes one object per line, so that the list can also be compared and cut by lines.
pub(super) fn write(out: &mut impl Write, list: &PassList<'_>) -> io::Result<()> {
    let view = list.view();
    let push = |text: &mut Vec<u8>, before: &[u8], row: &ExportedPass<'_>| {
        text.extend_from_slice(before);
        Ok(serde_json::to_writer(text, &Row::new(list, &view, row))?)
    };
    write!(out, "[")?;
    if let Some((first, rest)) = list.rows.split_first() {
        let mut text = Vec::new();
        push(&mut text, b"\n", first)?;
        out.write_all(&text)?;
        write_rows(out, rest, |text, row| push(text, b",\n", row))?;
    }
    writeln!(out, "\n]")
}

/// Writes a list of `rows`, one per line.
pub(super) fn write_lines(
    out: &mut impl Write,
    rows: impl Iterator<Item = impl Serialize>,
) -> io::Result<()> {
    write!(out, "[")?;
    for (index, row) in rows.enumerate() {
        writeln!(out, "{}", if index == 0 { "" } else { "," })?;
        serde_json::to_writer(&mut *out, &row)?;
    }
    writeln!(out, "\n]")
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::super::testing::{example, written, written_with};
    use crate::plan::pass_export::PassFormat;

    /// Returns `true` if `whole` contains all of `part` unchanged.
    fn holds(whole: &Value, part: &Value) -> bool {
        match (whole, part) {
            (Value::Object(whole), Value::Object(part)) => part
                .iter()
                .all(|(key, part)| whole.get(key).is_some_and(|whole| holds(whole, part))),
            _ => whole == part,
        }
    }

    #[test]
    fn rows_hold_what_others_rely_on() {
        let (elements, pass) = example();
        let text = written_with(PassFormat::Json, elements, &[pass, pass], Some(145.8e6));
        let rows: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(rows.as_array().unwrap().len(), 2);
        let row = serde_json::json!({
            "catalog_number": 25_544, "name": "ISS, (ZARYA); \"1\"",
            "aos": { "time": "2026-08-12T01:02:03.457Z", "azimuth_deg": 350.5, "elevation_deg": 0.0 },
            "tca": { "time": "2026-08-12T01:07:00.000Z", "azimuth_deg": 80.25, "elevation_deg": 45.123_457 },
            "los": { "time": "2026-08-12T01:12:00.000Z", "azimuth_deg": 170.0, "elevation_deg": 0.0 },
            "max_elevation_deg": 45.123_457, "duration_s": 596.543,
            "starts_before": false, "ends_after": true,
            "epoch": "2026-08-11T01:21:00.000000Z", "age_days": 0.9868, "designator": "1998-067A",
            // Before sunrise in Istanbul.
            "dark_at_site": true
        });
        assert!(holds(&rows[1], &row), "{}", rows[1]);
        assert!(rows[1]["sunlit"].is_boolean());
        for point in ["aos", "tca", "los"] {
            let number = |key: &str| rows[1][point][key].as_f64().unwrap();
            assert!((400.0..14_000.0).contains(&number("range_km")), "{}", rows[1]);
            let shift_hz = -number("range_rate_km_s") / 299_792.458 * 145.8e6;
            assert!((number("doppler_hz") - shift_hz).abs() < 1.0, "{}", rows[1]);
        }
    }

    #[test]
    fn no_pass_is_an_empty_list() {
        let (elements, _) = example();
        let text = written(PassFormat::Json, elements, &[]);
        assert_eq!(serde_json::from_str::<Vec<u8>>(&text).unwrap(), Vec::<u8>::new());
    }
}
