//! Passes as comma-separated values.

use std::io::{self, Write};

use super::{ExportedPass, PassList, Seen, degrees, rfc3339};

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

pub(super) fn write(out: &mut impl Write, list: &PassList<'_>) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let has_doppler = list.carrier_hz.is_some();
    let doppler: &[&str] = if has_doppler { &DOPPLER_HEADER } else { &[] };
    table.write_record(HEADER.iter().chain(doppler)).map_err(io_error)?;
    for row in list.rows {
        let ExportedPass { satellite, pass } = row;
        let elements = &satellite.elements;
        let mut fields = vec![elements.catalog_number().to_string(), plain(elements.name())];
        for point in [pass.aos, pass.tca, pass.los] {
            fields.push(rfc3339(point.time));
            fields.push(degrees(point.direction.azimuth_deg()).to_string());
            fields.push(degrees(point.direction.elevation_deg()).to_string());
        }
        fields.push(degrees(pass.max_elevation().degrees()).to_string());
        fields.push(format!("{:.3}", pass.duration_s()));
        fields.push(pass.starts_before.to_string());
        fields.push(pass.ends_after.to_string());
        fields.push(satellite.epoch.clone());
        fields.push(satellite.age_days(pass.aos.time).to_string());
        let tca = list.seen(row, pass.tca.time);
        fields.push(text_of(tca.map(|seen| seen.range_km)));
        fields.push(text_of(tca.map(|seen| seen.is_sunlit)));
        fields.push(plain(elements.international_designator().unwrap_or_default()));
        if has_doppler {
            let seen = [list.seen(row, pass.aos.time), tca, list.seen(row, pass.los.time)];
            let doppler_hz = |seen: Option<Seen>| text_of(seen.and_then(|seen| seen.doppler_hz));
            fields.extend(seen.map(doppler_hz));
        }
        table.write_record(fields).map_err(io_error)?;
    }
    table.flush()
}

/// The original error of the output: its kind distinguishes a reader that has stopped
/// from a full disk.
pub(in crate::plan) fn io_error(error: csv::Error) -> io::Error {
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
pub(in crate::plan) fn plain(text: &str) -> String {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{text}")
    } else {
        text.to_owned()
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
