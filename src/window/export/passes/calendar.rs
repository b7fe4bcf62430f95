//! Passes as calendar events.

use std::io::{self, Write};

use chrono::TimeDelta;
use icalendar::{Alarm, Calendar, Component as _, Event, EventLike as _, Trigger};
use jiff::{SignedDuration, Timestamp, Unit};

use super::{ExportedPass, PassList, about_elevations, event_ids::event_ids};
use crate::{astro::Site, export::civil, orbit::PassPoint};

pub(super) fn write(
    out: &mut impl Write,
    list: &PassList<'_>,
    rows: &[ExportedPass<'_>],
) -> io::Result<()> {
    let mut calendar = Calendar::empty();
    calendar.append_property(("VERSION", "2.0"));
    calendar.append_property(("PRODID", "-//Azel//Passes//EN"));
    calendar.append_property(("CALSCALE", "GREGORIAN"));
    let location = list.place.map_or_else(|| coordinates(list.site()), str::to_owned);
    for (row, id) in rows.iter().zip(event_ids(rows, list.query)) {
        calendar.push(event(list, row, &format!("{id}@azel"), &location));
    }
    write!(out, "{calendar}")
}

fn event(list: &PassList<'_>, row: &ExportedPass<'_>, id: &str, location: &str) -> Event {
    let ExportedPass { satellite, pass } = row;
    let (elements, site) = (&satellite.elements, list.site());
    let number = elements.catalog_number();
    let maximum_deg = pass.max_elevation().degrees();
    let azimuth = |point: PassPoint| point.direction.azimuth_deg();
    let start = second(pass.aos.time);
    // RFC 5545, 3.8.2.2: the end is later than the start.
    let end = second(pass.los.time).max(start + SignedDuration::from_secs(1));
    let mut event = Event::new();
    event.uid(id);
    event.add_property("DTSTAMP", date_time(list.now));
    event.add_property("DTSTART", date_time(start));
    event.add_property("DTEND", date_time(end));
    let summary = format!("{} {maximum_deg:.0}°", elements.label());
    event.add_property("SUMMARY", &summary);
    event.add_property(
        "DESCRIPTION",
        format!(
            "Catalogue number {number}\nAOS at azimuth {:.0}°\nHighest {maximum_deg:.1}° at azimuth {:.0}°\nLOS at azimuth {:.0}°\n{}\nElements of {}, age {:.1} days at AOS",
            azimuth(pass.aos),
            azimuth(pass.tca),
            azimuth(pass.los),
            about_elevations(list.is_apparent()),
            civil(elements.epoch(), "%Y-%m-%d %H:%M:%SZ"),
            satellite.age_days(pass.aos.time),
        ),
    );
    event.add_property("LOCATION", location);
    let (latitude_deg, longitude_deg) = (site.latitude().degrees(), site.longitude().degrees());
    event.add_property("GEO", format!("{latitude_deg:.6};{longitude_deg:.6}"));
    if let Some(before_s) = list.alarm_before_s {
        let before = TimeDelta::seconds(before_s.round() as i64);
        let mut alarm = Alarm::display(&summary, Trigger::before_start(before));
        // The library would otherwise add a random UID and the time of writing.
        alarm.uid(&format!("alarm-{id}")).add_property("DTSTAMP", date_time(list.now));
        event.alarm(alarm);
    }
    event.done()
}

fn coordinates(site: Site) -> String {
    let (latitude_deg, longitude_deg) = (site.latitude().degrees(), site.longitude().degrees());
    let north = if latitude_deg < 0.0 { 'S' } else { 'N' };
    let east = if longitude_deg < 0.0 { 'W' } else { 'E' };
    let (latitude_deg, longitude_deg) = (latitude_deg.abs(), longitude_deg.abs());
    format!("{latitude_deg:.4}° {north}, {longitude_deg:.4}° {east}, {:.0} m", site.altitude_m())
}

fn second(time: Timestamp) -> Timestamp {
    time.round(Unit::Second).unwrap_or(time)
}

/// Returns UTC to the nearest second, in the basic form of the format.
fn date_time(time: Timestamp) -> String {
    civil(time, "%Y%m%dT%H%M%SZ")
}

#[cfg(test)]
mod tests {
    use jiff::SignedDuration;

    use super::super::testing::{example, written};
    use crate::export::EventFormat;

    #[test]
    fn an_event_has_its_times_and_one_identity() {
        let (elements, pass) = example();
        let text = written(EventFormat::Ics, elements, &[pass]);
        for line in [
            "BEGIN:VCALENDAR",
            "VERSION:2.0",
            "BEGIN:VEVENT",
            "UID:25544-47189-12-436156@azel",
            "DTSTAMP:20260811T000000Z",
            "DTSTART:20260812T010203Z",
            "DTEND:20260812T011200Z",
            "GEO:41.020000;29.170000",
            "LOCATION:41.0200° N\\, 29.1700° E\\, 100 m",
            "SUMMARY:ISS\\, (ZARYA)\\; \"1\" 45°",
            "END:VEVENT",
            "END:VCALENDAR",
        ] {
            assert_eq!(text.matches(&format!("{line}\r\n")).count(), 1, "{line} in {text}");
        }
        assert!(text.lines().all(|line| line.len() <= 76), "{text}");
    }

    #[test]
    fn an_event_lasts_a_second_at_least_and_tells_its_elements() {
        let (elements, mut pass) = example();
        pass.los.time = pass.aos.time + SignedDuration::from_millis(40);
        let text = written(EventFormat::Ics, elements, &[pass]);
        assert!(text.contains("DTSTART:20260812T010203Z\r\n"), "{text}");
        assert!(text.contains("DTEND:20260812T010204Z\r\n"), "{text}");
        let unfolded = text.replace("\r\n ", "");
        let spoken = "Elements of 2026-08-11 01:21:00Z\\, age 1.0 days at AOS";
        assert!(unfolded.contains(spoken), "{unfolded}");
    }
}
