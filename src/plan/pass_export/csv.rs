//! Passes as comma-separated values.

use std::io::{self, Write};

use super::{ExportedPass, degrees, rfc3339};

const HEADER: [&str; 15] = [
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
];

pub(super) fn write(out: &mut impl Write, rows: &[ExportedPass<'_>]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(HEADER)?;
    for ExportedPass { elements, pass } in rows {
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
        table.write_record(fields)?;
    }
    table.flush()
}

/// Text that no spreadsheet takes for a formula: names come from files of others.
///
/// Source: OWASP, "CSV Injection".
fn plain(text: &str) -> String {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{text}")
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{example, written};
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
        let text = written(PassFormat::Csv, &elements, &[pass]);
        let (header, row) = text.split_once('\n').unwrap();
        assert!(header.starts_with("catalog_number,name,aos_time,aos_azimuth_deg"), "{header}");
        assert_eq!(
            row,
            "25544,\"ISS, (ZARYA); \"\"1\"\"\",2026-08-12T01:02:03.457Z,350.5,0,\
             2026-08-12T01:07:00.000Z,80.25,45.123457,2026-08-12T01:12:00.000Z,170,0,\
             45.123457,596.543,false,true\n"
        );
    }
}
