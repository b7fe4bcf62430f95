//! Passes as events of a calendar.

use std::io::{self, Write};

use icalendar::{Calendar, Component as _, Event};
use jiff::{Timestamp, tz::TimeZone};

use super::ExportedPass;

pub(super) fn write(
    out: &mut impl Write,
    rows: &[ExportedPass<'_>],
    now: Timestamp,
) -> io::Result<()> {
    let mut calendar = Calendar::empty();
    calendar.append_property(("VERSION", "2.0"));
    calendar.append_property(("PRODID", "-//Azel//Passes//EN"));
    calendar.append_property(("CALSCALE", "GREGORIAN"));
    for row in rows {
        calendar.push(event(row, now));
    }
    write!(out, "{calendar}")
}

fn event(ExportedPass { elements, pass }: &ExportedPass<'_>, now: Timestamp) -> Event {
    let number = elements.catalog_number();
    let maximum_deg = pass.max_elevation().degrees();
    let azimuth = |point: crate::orbit::PassPoint| point.direction.azimuth_deg();
    let mut event = Event::new();
    // The same pass is the same event, whenever it is written.
    event.uid(&format!("{number}-{}@azel", pass.aos.time.as_millisecond()));
    event.add_property("DTSTAMP", date_time(now));
    event.add_property("DTSTART", date_time(pass.aos.time));
    event.add_property("DTEND", date_time(pass.los.time));
    event.add_property("SUMMARY", format!("{} {maximum_deg:.0}°", elements.label()));
    event.add_property(
        "DESCRIPTION",
        format!(
            "Catalogue number {number}\nAOS at azimuth {:.0}°\nHighest {maximum_deg:.1}° at azimuth {:.0}°\nLOS at azimuth {:.0}°",
            azimuth(pass.aos),
            azimuth(pass.tca),
            azimuth(pass.los),
        ),
    );
    event.done()
}

/// UTC to the nearest second, in the basic form of the format.
fn date_time(time: Timestamp) -> String {
    let rounded = time.round(jiff::Unit::Second).unwrap_or(time);
    rounded.to_zoned(TimeZone::UTC).strftime("%Y%m%dT%H%M%SZ").to_string()
}

#[cfg(test)]
mod tests {
    use super::super::testing::{example, written};
    use crate::plan::pass_export::PassFormat;

    #[test]
    fn an_event_has_its_times_and_one_identity() {
        let (elements, pass) = example();
        let text = written(PassFormat::Ics, &elements, &[pass]);
        for line in [
            "BEGIN:VCALENDAR",
            "VERSION:2.0",
            "BEGIN:VEVENT",
            "UID:25544-1786496523456@azel",
            "DTSTAMP:20260811T000000Z",
            "DTSTART:20260812T010203Z",
            "DTEND:20260812T011200Z",
            "SUMMARY:ISS\\, (ZARYA)\\; \"1\" 45°",
            "END:VEVENT",
            "END:VCALENDAR",
        ] {
            assert_eq!(text.matches(&format!("{line}\r\n")).count(), 1, "{line} in {text}");
        }
        assert!(text.lines().all(|line| line.len() <= 76), "{text}");
    }
}
