//! Passes as a table. A `<` or `>` marks a pass that the time window cuts off at that end.

use std::io::{self, Write};

use jiff::{Timestamp, Unit};

use super::{ExportedPass, turn};
use crate::{export::civil, orbit::Pass};

const DATE_AND_TIME: &str = "%Y-%m-%d %H:%M:%S";

pub(super) fn write(out: &mut impl Write, rows: &[ExportedPass<'_>]) -> io::Result<()> {
    // A column is as wide as its widest entry.
    let time_width = |time: fn(&Pass) -> Timestamp| {
        if rows.iter().any(|row| is_of_another_day(&row.pass, time(&row.pass))) { 19 } else { 8 }
    };
    let tca_width = time_width(|pass| pass.tca.time);
    let los_width = time_width(|pass| pass.los.time);
    let names = rows.iter().map(|row| row.satellite.elements.name().chars().count());
    let name_width = names.max().unwrap_or(0).max(4);
    writeln!(
        out,
        "{:<20} {:>5}   {:<tca_width$} {:>5} {:>5}   {:<los_width$} {:>5}   {:>8}  {:>9}  {:<name_width$}  {:>7}",
        "AOS (UTC)", "az", "TCA", "az", "el", "LOS", "az", "lasts", "number", "name", "age"
    )?;
    for row in rows {
        let ExportedPass { satellite, pass } = row;
        let [aos, tca, los] = [pass.aos, pass.tca, pass.los];
        writeln!(
            out,
            "{}{} {:>5.1}   {:>tca_width$} {:>5.1} {:>5.1}   {:>los_width$}{} {:>4.1}   {:>8}  {:>9}  {:<name_width$}  {:>5.1} d",
            if pass.starts_before { '<' } else { ' ' },
            civil(aos.time, DATE_AND_TIME),
            turn(aos.direction.azimuth_deg()),
            later(pass, tca.time),
            turn(tca.direction.azimuth_deg()),
            tca.direction.elevation_deg(),
            later(pass, los.time),
            if pass.ends_after { '>' } else { ' ' },
            turn(los.direction.azimuth_deg()),
            lasts(pass.duration_s()),
            satellite.elements.catalog_number(),
            satellite.elements.name(),
            satellite.age_days(aos.time),
        )?;
    }
    Ok(())
}

/// Returns the time, with its date if it differs from the date of AOS.
fn later(pass: &Pass, time: Timestamp) -> String {
    civil(time, if is_of_another_day(pass, time) { DATE_AND_TIME } else { "%H:%M:%S" })
}

fn is_of_another_day(pass: &Pass, time: Timestamp) -> bool {
    let day = |time: Timestamp| {
        let shown = time.round(Unit::Second).unwrap_or(time);
        shown.as_second().div_euclid(86_400)
    };
    day(time) != day(pass.aos.time)
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
    use jiff::SignedDuration;

    use super::super::testing::{example, written};
    use crate::export::EventFormat;

    #[test]
    fn columns_stand_below_their_heads() {
        let (elements, mut pass) = example();
        pass.starts_before = true;
        let text = written(EventFormat::Table, elements, &[pass]);
        assert_eq!(
            text,
            "AOS (UTC)               az   TCA         az    el   LOS         az      lasts     number  name                   age\n\
             <2026-08-12 01:02:03 350.5   01:07:00  80.2  45.1   01:12:00> 170.0       9:57      25544  ISS, (ZARYA); \"1\"    1.0 d\n\
             Elevations are geometric, without refraction.\n"
        );
    }

    #[test]
    fn a_time_of_another_day_has_its_date() {
        let (elements, mut pass) = example();
        pass.los.time += SignedDuration::from_hours(47);
        let text = written(EventFormat::Table, elements, &[pass]);
        assert_eq!(
            text,
            "AOS (UTC)               az   TCA         az    el   LOS                    az      lasts     number  name                   age\n \
             2026-08-12 01:02:03 350.5   01:07:00  80.2  45.1   2026-08-14 00:12:00> 170.0   47:09:57      25544  ISS, (ZARYA); \"1\"    1.0 d\n\
             Elevations are geometric, without refraction.\n"
        );
    }
}
