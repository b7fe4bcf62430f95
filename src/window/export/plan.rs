//! A plan as a table, CSV, JSON or iCalendar.

use std::{
    borrow::Cow,
    collections::BTreeMap,
    io::{self, Write},
};

use chrono::TimeDelta;
use icalendar::{Alarm, Calendar, Component as _, Event, EventLike as _, Trigger};
use jiff::Timestamp;
use serde::Serialize;

use super::{
    EventFormat, ExportedPass, PassQuery, RowFormat, Time, civil, minutes, passes::event_ids,
    rounded, write_rows,
};
use crate::{
    astro::time::{add_seconds, seconds_between},
    plan::schedule::{Entry, LeftOut, Proof, Schedule},
    station::AntennaId,
};

/// A schedule with the names of its antennas and satellites.
pub struct PlanList<'a> {
    pub schedule: &'a Schedule,
    /// Names of satellites by catalog number.
    pub satellites: &'a BTreeMap<u32, String>,
    pub antennas: &'a BTreeMap<AntennaId, String>,
    /// Function that words the reason why a pass is left out.
    pub reason: &'a dyn Fn(&LeftOut) -> String,
    /// The planned passes, ordered by AOS, and the search that found them. They identify the
    /// events.
    pub passes: &'a [ExportedPass<'a>],
    pub query: &'a PassQuery,
    /// Time stamp of the events.
    pub now: Timestamp,
}

/// A planned pass with its columns.
#[derive(Default, Serialize)]
struct Row<'a> {
    /// `taken` or `left out`.
    state: &'static str,
    antenna: Option<Cow<'a, str>>,
    catalog_number: u32,
    name: Cow<'a, str>,
    aos_time: Time,
    from_time: Option<Time>,
    to_time: Option<Time>,
    counted_s: Option<f64>,
    late_s: Option<f64>,
    early_s: Option<f64>,
    slew_s: Option<f64>,
    spare_s: Option<f64>,
    reason: Option<String>,
    antenna_id: Option<u32>,
    set_up_s: Option<f64>,
}

/// An entry, or a pass that the schedule leaves out.
enum Planned<'a> {
    Taken(&'a Entry),
    LeftOut(&'a LeftOut),
}

impl PlanList<'_> {
    /// Writes the passes by AOS, taken or left out. A calendar contains only the taken passes.
    pub fn write(&self, out: &mut impl Write, format: EventFormat) -> io::Result<()> {
        match format {
            EventFormat::Table => self.table(out),
            EventFormat::Csv => self.write_rows(out, RowFormat::Csv),
            EventFormat::Json => self.write_rows(out, RowFormat::Json),
            EventFormat::Ics => self.calendar(out),
        }
    }

    /// Returns all passes by AOS.
    fn planned(&self) -> Vec<Planned<'_>> {
        let entries = self.schedule.entries.iter().map(Planned::Taken);
        let mut rows: Vec<Planned<'_>> =
            entries.chain(self.schedule.left_out.iter().map(Planned::LeftOut)).collect();
        rows.sort_by_key(|row| match row {
            Planned::Taken(entry) => (entry.pass.aos, entry.pass.satellite, entry.start),
            Planned::LeftOut(left) => (left.pass.aos, left.pass.satellite, left.pass.aos),
        });
        rows
    }

    fn satellite(&self, number: u32) -> String {
        self.satellites.get(&number).cloned().unwrap_or_else(|| number.to_string())
    }

    fn antenna(&self, id: AntennaId) -> &str {
        self.antennas.get(&id).map_or("", String::as_str)
    }

    fn table(&self, out: &mut impl Write) -> io::Result<()> {
        let width = |names: &mut dyn Iterator<Item = &String>| {
            names.map(|name| name.chars().count()).max().unwrap_or(0).max(9)
        };
        let names = width(&mut self.satellites.values());
        let antennas = width(&mut self.antennas.values());
        writeln!(
            out,
            "{:<antennas$}  {:<names$}  {:<19}  {:<8}  {:>6}  {:>5}  {:>6}",
            "Antenna", "Satellite", "From (UTC)", "To", "counts", "slew", "spare"
        )?;
        for planned in self.planned() {
            match planned {
                Planned::Taken(entry) => writeln!(
                    out,
                    "{:<antennas$}  {:<names$}  {}  {}  {:>6}  {:>5}  {:>6}",
                    self.antenna(entry.antenna),
                    self.satellite(entry.pass.satellite),
                    civil(entry.start, "%Y-%m-%d %H:%M:%S"),
                    civil(entry.end, "%H:%M:%S"),
                    minutes(entry.counted_s),
                    minutes(entry.slew_s),
                    entry.spare_s.map(minutes).unwrap_or_default(),
                )?,
                Planned::LeftOut(left) => writeln!(
                    out,
                    "{:<antennas$}  {:<names$}  {}  {}",
                    "-",
                    self.satellite(left.pass.satellite),
                    civil(left.pass.aos, "%Y-%m-%d %H:%M:%S"),
                    (self.reason)(left),
                )?,
            }
        }
        Ok(())
    }

    fn write_rows(&self, out: &mut impl Write, format: RowFormat) -> io::Result<()> {
        let is_best = self.schedule.worth.iter().all(|class| class.proof == Proof::Best);
        let fields = [("is_proved_best", is_best.into())];
        let planned = self.planned();
        let rows = planned.iter().map(|planned| self.row(format, planned));
        write_rows(out, format, ("passes", &fields), &Row::default(), rows)
    }

    fn row(&self, format: RowFormat, planned: &Planned<'_>) -> Row<'_> {
        let pass = match planned {
            Planned::Taken(entry) => entry.pass,
            Planned::LeftOut(left) => left.pass,
        };
        let name = self.satellite(pass.satellite);
        let row = Row {
            catalog_number: pass.satellite,
            name: Cow::Owned(format.text(&name).into_owned()),
            aos_time: Time(pass.aos),
            ..Row::default()
        };
        let seconds = |value_s: f64| Some(rounded(value_s, 1e3));
        match planned {
            Planned::Taken(entry) => Row {
                state: "taken",
                antenna: Some(format.text(self.antenna(entry.antenna))),
                antenna_id: Some(entry.antenna.0),
                from_time: Some(Time(entry.start)),
                to_time: Some(Time(entry.end)),
                counted_s: seconds(entry.counted_s),
                late_s: seconds(entry.late_s),
                early_s: seconds(entry.early_s),
                slew_s: seconds(entry.slew_s),
                set_up_s: seconds(entry.set_up_s),
                spare_s: entry.spare_s.and_then(seconds),
                ..row
            },
            Planned::LeftOut(left) => {
                let reason = (self.reason)(left);
                let reason = Some(format.text(&reason).into_owned());
                Row { state: "left out", reason, ..row }
            }
        }
    }

    fn calendar(&self, out: &mut impl Write) -> io::Result<()> {
        let mut calendar = Calendar::empty();
        calendar.append_property(("VERSION", "2.0"));
        calendar.append_property(("PRODID", "-//Azel//Schedule//EN"));
        calendar.append_property(("CALSCALE", "GREGORIAN"));
        let pass_ids = event_ids(self.passes, self.query);
        for entry in &self.schedule.entries {
            let (number, antenna) = (entry.pass.satellite, entry.antenna);
            let id = format!("{}-antenna{}@azel", self.pass_id(entry, &pass_ids), antenna.0);
            let stamp = civil(self.now, BASIC);
            let mut event = Event::new();
            event.uid(&id);
            event.add_property("DTSTAMP", &stamp);
            event.add_property("DTSTART", civil(entry.start, BASIC));
            event.add_property("DTEND", civil(entry.end, BASIC));
            let name = self.satellite(number);
            let summary = format!("{name}, {}", self.antenna(antenna));
            event.add_property("SUMMARY", &summary);
            let mut alarm = Alarm::display(&summary, Trigger::before_start(ALARM_BEFORE));
            // The library would add a random UID and the time of writing.
            alarm.uid(&format!("alarm-{id}")).add_property("DTSTAMP", stamp);
            event.alarm(alarm);
            calendar.push(event.done());
        }
        write!(out, "{calendar}")
    }

    /// Returns the identity of the pass of `entry` in `pass_ids`, which belong to [`Self::passes`].
    fn pass_id(&self, entry: &Entry, pass_ids: &[String]) -> String {
        let number = entry.pass.satellite;
        let half_s = 0.5 * seconds_between(entry.start, entry.end);
        // AOS may differ, because Azel may have predicted the passes again after it made the
        // schedule.
        let middle = add_seconds(entry.start, half_s);
        let is_planned = |row: &ExportedPass<'_>| {
            row.satellite.elements.catalog_number() == number
                && (row.pass.aos.time..=row.pass.los.time).contains(&middle)
        };
        let found = self.passes.iter().position(is_planned);
        let id = found.and_then(|place| pass_ids.get(place)).cloned();
        id.unwrap_or_else(|| format!("{number}-{}", entry.pass.aos.as_second()))
    }
}

/// Time between the alarm of a calendar event and its start.
const ALARM_BEFORE: TimeDelta = TimeDelta::minutes(5);

/// UTC format in the basic form of iCalendar.
const BASIC: &str = "%Y%m%dT%H%M%SZ";
