//! Passes as a table. A `<` or `>` marks a pass that the window cuts at that end.

use std::io::{self, Write};

use jiff::{Timestamp, tz::TimeZone};

use super::ExportedPass;

pub(super) fn write(out: &mut impl Write, rows: &[ExportedPass<'_>]) -> io::Result<()> {
    writeln!(
        out,
        "{:<20} {:>5}   {:<8} {:>5} {:>5}   {:<8} {:>5}   {:>8}  {:>9}  name",
        "AOS (UTC)", "az", "TCA", "az", "el", "LOS", "az", "lasts", "number"
    )?;
    for ExportedPass { elements, pass } in rows {
        let [aos, tca, los] = [pass.aos, pass.tca, pass.los];
        writeln!(
            out,
            "{}{} {:>5.1}   {} {:>5.1} {:>5.1}   {}{} {:>4.1}   {:>8}  {:>9}  {}",
            if pass.starts_before { '<' } else { ' ' },
            civil(aos.time, "%Y-%m-%d %H:%M:%S"),
            turn(aos.direction.azimuth_deg()),
            civil(tca.time, "%H:%M:%S"),
            turn(tca.direction.azimuth_deg()),
            tca.direction.elevation_deg(),
            civil(los.time, "%H:%M:%S"),
            if pass.ends_after { '>' } else { ' ' },
            turn(los.direction.azimuth_deg()),
            lasts(pass.duration_s()),
            elements.catalog_number(),
            elements.name()
        )?;
    }
    Ok(())
}

/// To the nearest second.
fn civil(time: Timestamp, format: &str) -> String {
    let rounded = time.round(jiff::Unit::Second).unwrap_or(time);
    rounded.to_zoned(TimeZone::UTC).strftime(format).to_string()
}

/// An azimuth that never shows as 360.0.
fn turn(azimuth_deg: f64) -> f64 {
    if azimuth_deg >= 359.95 { 0.0 } else { azimuth_deg }
}

fn lasts(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{example, written};
    use crate::plan::pass_export::PassFormat;

    #[test]
    fn columns_stand_below_their_heads() {
        let (elements, mut pass) = example();
        pass.starts_before = true;
        let text = written(PassFormat::Table, &elements, &[pass]);
        assert_eq!(
            text,
            "AOS (UTC)               az   TCA         az    el   LOS         az      lasts     number  name\n\
             <2026-08-12 01:02:03 350.5   01:07:00  80.2  45.1   01:12:00> 170.0       9:57      25544  ISS, (ZARYA); \"1\"\n"
        );
    }
}
