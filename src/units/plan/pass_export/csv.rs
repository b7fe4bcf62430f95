//! Passes as comma-separated values.

use std::{
    borrow::Cow,
    io::{self, Write},
};

use super::{
    ExportedPass, PassList, View,
    digits::{parts, push_fixed, push_shortest, push_time, push_time_us, push_whole},
    rows::write_rows,
    times,
};
use crate::{
    astro::sun_moon,
    orbit::{Distance, OverGround, Pass, is_lit},
};

/// New columns are added at the end, so that programs that count columns keep working.
const HEADER: [&str; 20] = [
    "catalog_number",
    "name",
    "aos_time",
    "aos_azimuth_deg",
    "aos_elevation_deg",
    "tca_time",
    "tca_azimuth_deg",
    "tca_elevation_deg",
    "los_time",
    "los_azimuth_deg",
    "los_elevation_deg",
    "max_elevation_deg",
    "duration_s",
    "starts_before",
    "ends_after",
    "epoch",
    "age_days",
    "range_km",
    "sunlit",
    "designator",
];
const DOPPLER_HEADER: [&str; 3] = ["aos_doppler_hz", "tca_doppler_hz", "los_doppler_hz"];

pub(super) fn write<'a>(
    out: &mut impl Write,
    list: &PassList<'_>,
    rows: impl Iterator<Item = ExportedPass<'a>>,
) -> io::Result<()> {
    let doppler: &[&str] = if list.carrier_hz.is_some() { &DOPPLER_HEADER } else { &[] };
    let names: Vec<&str> = HEADER.iter().chain(doppler).copied().collect();
    writeln!(out, "{}", names.join(","))?;
    let view = list.view();
    if view.carrier_hz.is_some() {
        write_rows(out, rows, times, |text, row, places| push_row(text, &view, row, places))
    } else {
        let at_tca = |pass: &Pass| [pass.tca.time];
        write_rows(out, rows, at_tca, |text, row, [tca]| {
            push_row(text, &view, row, [None, tca, None]);
        })
    }
}

/// Appends a row, with the places at AOS, TCA and LOS; those at AOS and LOS are for their Doppler
/// shifts.
fn push_row(
    text: &mut Vec<u8>,
    view: &View,
    row: &ExportedPass<'_>,
    [aos, tca, los]: [Option<OverGround>; 3],
) {
    let ExportedPass { satellite, pass } = row;
    let elements = &satellite.elements;
    push_whole(text, elements.catalog_number().into());
    push_text(next(text), elements.name());
    for point in [pass.aos, pass.tca, pass.los] {
        push_time(next(text), point.time);
        push_shortest::<6>(next(text), point.direction.azimuth_deg());
        push_shortest::<6>(next(text), point.direction.elevation_deg());
    }
    push_shortest::<6>(next(text), pass.max_elevation().degrees());
    push_fixed::<3>(next(text), pass.duration_s());
    push_flag(next(text), pass.starts_before);
    push_flag(next(text), pass.ends_after);
    push_time_us(next(text), elements.epoch());
    push_shortest::<4>(next(text), satellite.age_days(pass.aos.time));
    next(text);
    if let Some(place) = &tca {
        let written = |distance: Distance| parts::<3>(distance.range_km);
        let distance = view.distance(satellite, place, pass.tca.time, written);
        push_shortest::<3>(text, distance.range_km);
    }
    next(text);
    if let Some(place) = &tca {
        push_flag(text, is_lit(place.position_km, sun_moon::sun_ecef_km(pass.tca.time)));
    }
    push_text(next(text), elements.international_designator().unwrap_or_default());
    if let Some(carrier_hz) = view.carrier_hz {
        let doppler_hz = |distance: Distance| distance.doppler_hz(carrier_hz);
        let written = |distance| parts::<1>(doppler_hz(distance));
        for (place, at) in [aos, tca, los].iter().zip(times(pass)) {
            next(text);
            if let Some(place) = place {
                let distance = view.distance(satellite, place, at, written);
                push_shortest::<1>(text, doppler_hz(distance));
            }
        }
    }
    text.push(b'\n');
}

/// Begins the next field.
fn next(text: &mut Vec<u8>) -> &mut Vec<u8> {
    text.push(b',');
    text
}

fn push_flag(text: &mut Vec<u8>, flag: bool) {
    text.extend_from_slice(if flag { b"true" } else { b"false" });
}

/// Appends a field that others wrote.
fn push_text(text: &mut Vec<u8>, field: &str) {
    text.extend_from_slice(quoted(field).as_bytes());
}

/// The original error of the output: its kind distinguishes a reader that has stopped
/// from a full disk.
pub fn io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// An empty text for `None`.
pub(super) fn text_of<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Text that no spreadsheet takes for a formula: names come from files that others wrote.
///
/// Source: OWASP, "CSV Injection".
pub fn plain(text: &str) -> Cow<'_, str> {
    if matches!(text.as_bytes(), [b'=' | b'+' | b'-' | b'@' | b'\t' | b'\r', ..]) {
        Cow::Owned(format!("'{text}"))
    } else {
        Cow::Borrowed(text)
    }
}

/// The same as a field of comma-separated values, in quotation marks where it needs them.
pub fn quoted(text: &str) -> Cow<'_, str> {
    let text = plain(text);
    if text.bytes().any(|byte| matches!(byte, b'"' | b',' | b'\r' | b'\n')) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, Write};

    use super::super::testing::{example, write_to, written, written_with};
    use crate::plan::pass_export::PassFormat;

    #[test]
    fn a_name_is_no_formula() {
        for name in ["=1+1", "+1", "-1", "@SUM(A1)"] {
            assert_eq!(super::plain(name), format!("'{name}"));
        }
        for name in ["ISS (ZARYA)", "NOAA-20", ""] {
            assert_eq!(super::plain(name), name);
        }
    }

    #[test]
    fn a_row_quotes_what_it_must() {
        let (elements, pass) = example();
        let text = written(PassFormat::Csv, elements, &[pass]);
        let (header, row) = text.split_once('\n').unwrap();
        assert!(header.starts_with("catalog_number,name,aos_time,aos_azimuth_deg"), "{header}");
        assert!(
            header.ends_with("ends_after,epoch,age_days,range_km,sunlit,designator"),
            "{header}"
        );
        let before = "25544,\"ISS, (ZARYA); \"\"1\"\"\",2026-08-12T01:02:03.457Z,350.5,0,\
             2026-08-12T01:07:00.000Z,80.25,45.123457,2026-08-12T01:12:00.000Z,170,0,\
             45.123457,596.543,false,true,2026-08-11T01:21:00.000000Z,0.9868,";
        let rest = row.strip_prefix(before).unwrap_or_else(|| panic!("{row}"));
        let fields: Vec<&str> = rest.trim_end().split(',').collect();
        let [range_km, sunlit, designator] = fields[..] else { panic!("{row}") };
        assert!((400.0..14_000.0).contains(&range_km.parse::<f64>().unwrap()), "{row}");
        assert!(sunlit.parse::<bool>().is_ok(), "{row}");
        assert_eq!(designator, "1998-067A");
    }

    #[test]
    fn doppler_comes_last_where_it_is_asked_for() {
        let (elements, pass) = example();
        let text = written_with(PassFormat::Csv, elements, &[pass], Some(145.8e6));
        let (header, row) = text.split_once('\n').unwrap();
        assert!(
            header.ends_with("designator,aos_doppler_hz,tca_doppler_hz,los_doppler_hz"),
            "{header}"
        );
        let shifts: Vec<f64> =
            row.trim_end().rsplit(',').take(3).map(|text| text.parse().unwrap()).collect();
        // The shift at 8 km/s.
        assert!(shifts.iter().all(|shift| shift.abs() < 3_900.0), "{row}");
    }

    #[test]
    fn a_reader_that_stops_is_told_by_its_kind() {
        struct Closed;
        impl Write for Closed {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::BrokenPipe.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let (elements, pass) = example();
        // More than the writer buffers.
        let passes = vec![pass; 1000];
        let error = write_to(&mut Closed, PassFormat::Csv, elements, &passes, None).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::BrokenPipe);
    }
}
