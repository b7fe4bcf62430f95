//! Passes as a list of JSON objects.

use std::io::{self, Write};

use serde::Serialize;

use super::{
    ExportedPass, PassList, Satellite, View,
    digits::{parts, push_at_least, push_time, push_time_us, push_whole},
    rows::write_rows,
    times,
};
use crate::{
    astro::sun_moon,
    orbit::{Distance, OverGround, PassPoint, is_lit},
};

/// Writes one object per line, so that the list can also be compared and cut by lines.
pub(super) fn write<'a>(
    out: &mut impl Write,
    list: &PassList<'_>,
    mut rows: impl Iterator<Item = ExportedPass<'a>>,
) -> io::Result<()> {
    let view = list.view();
    write!(out, "[")?;
    // No comma stands before the first.
    for (before, count) in [(&b"\n"[..], 1), (b",\n", usize::MAX)] {
        write_rows(out, rows.by_ref().take(count), times, |text, row, places| {
            text.extend_from_slice(before);
            push_row(text, &view, row, places);
        })?;
    }
    writeln!(out, "\n]")
}

fn push_row(
    text: &mut Vec<u8>,
    view: &View,
    row: &ExportedPass<'_>,
    [aos, tca, los]: [Option<OverGround>; 3],
) {
    let ExportedPass { satellite, pass } = row;
    let elements = &satellite.elements;
    text.extend_from_slice(br#"{"catalog_number":"#);
    push_whole(text, elements.catalog_number().into());
    text.extend_from_slice(br#","name":"#);
    push_text(text, Some(elements.name()));
    text.extend_from_slice(br#","aos":"#);
    push_point(text, view, satellite, pass.aos, aos);
    text.extend_from_slice(br#","tca":"#);
    push_point(text, view, satellite, pass.tca, tca);
    text.extend_from_slice(br#","los":"#);
    push_point(text, view, satellite, pass.los, los);
    text.extend_from_slice(br#","max_elevation_deg":"#);
    push_number::<6>(text, Some(pass.max_elevation().degrees()));
    text.extend_from_slice(br#","duration_s":"#);
    push_number::<3>(text, Some(pass.duration_s()));
    text.extend_from_slice(br#","starts_before":"#);
    push_flag(text, Some(pass.starts_before));
    text.extend_from_slice(br#","ends_after":"#);
    push_flag(text, Some(pass.ends_after));
    text.extend_from_slice(br#","epoch":""#);
    push_time_us(text, elements.epoch());
    text.extend_from_slice(br#"","age_days":"#);
    push_number::<4>(text, Some(satellite.age_days(pass.aos.time)));
    text.extend_from_slice(br#","designator":"#);
    push_text(text, elements.international_designator());
    text.extend_from_slice(br#","sunlit":"#);
    let sun_km = sun_moon::sun_ecef_km(pass.tca.time);
    push_flag(text, tca.map(|place| is_lit(place.position_km, sun_km)));
    text.extend_from_slice(br#","dark_at_site":"#);
    push_flag(text, Some(view.is_dark(sun_km)));
    text.push(b'}');
}

fn push_point(
    text: &mut Vec<u8>,
    view: &View,
    satellite: &Satellite,
    point: PassPoint,
    place: Option<OverGround>,
) {
    let written = |distance: Distance| {
        let doppler_hz = view.carrier_hz.map(|carrier_hz| distance.doppler_hz(carrier_hz));
        let Distance { range_km, range_rate_km_s } = distance;
        (parts::<3>(range_km), parts::<6>(range_rate_km_s), doppler_hz.map(parts::<1>))
    };
    let distance = place.map(|place| view.distance(satellite, &place, point.time, written));
    text.extend_from_slice(br#"{"time":""#);
    push_time(text, point.time);
    text.extend_from_slice(br#"","azimuth_deg":"#);
    push_number::<6>(text, Some(point.direction.azimuth_deg()));
    text.extend_from_slice(br#","elevation_deg":"#);
    push_number::<6>(text, Some(point.direction.elevation_deg()));
    text.extend_from_slice(br#","range_km":"#);
    push_number::<3>(text, distance.map(|distance| distance.range_km));
    text.extend_from_slice(br#","range_rate_km_s":"#);
    push_number::<6>(text, distance.map(|distance| distance.range_rate_km_s));
    if let (Some(distance), Some(carrier_hz)) = (distance, view.carrier_hz) {
        text.extend_from_slice(br#","doppler_hz":"#);
        push_number::<1>(text, Some(distance.doppler_hz(carrier_hz)));
    }
    text.push(b'}');
}

const NULL: &[u8] = b"null";

/// Appends a number as `serde_json` writes it once it is rounded to this number of decimals.
fn push_number<const DECIMALS: usize>(text: &mut Vec<u8>, number: Option<f64>) {
    let Some(number) = number else { return text.extend_from_slice(NULL) };
    match parts::<DECIMALS>(number) {
        // Below a hundred-thousandth, it writes a power of ten.
        millionths @ (-9..=-1 | 1..=9) if DECIMALS == 6 => {
            text.extend_from_slice(format!("{millionths}e-6").as_bytes());
        }
        _ => push_at_least::<DECIMALS>(text, number, 1),
    }
}

fn push_flag(text: &mut Vec<u8>, flag: Option<bool>) {
    text.extend_from_slice(match flag {
        Some(true) => b"true",
        Some(false) => b"false",
        None => NULL,
    });
}

/// Appends a text that others wrote, escaped.
fn push_text(text: &mut Vec<u8>, given: Option<&str>) {
    // Appending to a buffer cannot fail.
    let _ = serde_json::to_writer(text, &given);
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
    use proptest::prelude::*;
    use serde_json::Value;

    use super::{
        super::{
            rounded,
            testing::{example, written, written_with},
        },
        *,
    };
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

    proptest! {
        #[test]
        fn numbers_are_those_of_their_library(
            value in prop_oneof![-1e6..1e6_f64, -1.5e-5..1.5e-5, Just(0.0), Just(-0.0), Just(350.0)],
        ) {
            let written = |push: fn(&mut Vec<u8>, Option<f64>)| {
                let mut text = Vec::new();
                push(&mut text, Some(value));
                String::from_utf8(text).unwrap()
            };
            let expected = |parts| serde_json::to_string(&rounded(value, parts)).unwrap();
            prop_assert_eq!(written(push_number::<1>), expected(1e1));
            prop_assert_eq!(written(push_number::<3>), expected(1e3));
            prop_assert_eq!(written(push_number::<4>), expected(1e4));
            prop_assert_eq!(written(push_number::<6>), expected(1e6));
        }
    }
}
