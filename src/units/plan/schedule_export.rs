//! Writes a schedule as a table, CSV, JSON or iCalendar.

use std::{
    collections::BTreeMap,
    io::{self, Write},
};

use chrono::TimeDelta;
use icalendar::{Alarm, Calendar, Component as _, Event, EventLike as _, Trigger};
use jiff::Timestamp;

use super::{
    pass_export::{ExportedPass, PassQuery, civil, event_ids, io_error, plain, rfc3339},
    schedule::{Entry, LeftOut, Schedule},
};
use crate::{
    astro::time::{add_seconds, seconds_between},
    station::AntennaId,
};

/// How a schedule is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScheduleFormat {
    /// For people.
    Table,
    Csv,
    Json,
    /// Events of a calendar: only what is taken.
    Ics,
}

/// A schedule with the names of what is in it.
pub struct ScheduleList<'a> {
    pub schedule: &'a Schedule,
    /// By catalog number.
    pub satellites: &'a BTreeMap<u32, String>,
    pub antennas: &'a BTreeMap<AntennaId, String>,
    /// Says why a pass is left out.
    pub reason: &'a dyn Fn(&LeftOut) -> String,
    /// The planned passes, ordered by AOS, and the search that found them: they identify events.
    pub passes: &'a [ExportedPass<'a>],
    pub query: &'a PassQuery,
    /// Time stamp of the events.
    pub now: Timestamp,
}

const HEADER: [&str; 13] = [
    "state",
    "antenna",
    "catalog_number",
    "name",
    "aos_time",
    "from_time",
    "to_time",
    "counted_s",
    "late_s",
    "early_s",
    "slew_s",
    "spare_s",
    "reason",
];

/// A row of the table: an entry or a pass that is left out.
enum Row<'a> {
    Taken(&'a Entry),
    LeftOut(&'a LeftOut),
}

impl ScheduleList<'_> {
    pub fn write(&self, out: &mut impl Write, format: ScheduleFormat) -> io::Result<()> {
        match format {
            ScheduleFormat::Table => self.table(out),
            ScheduleFormat::Csv => self.csv(out),
            ScheduleFormat::Json => self.json(out),
            ScheduleFormat::Ics => self.calendar(out),
        }
    }

    /// All passes by AOS.
    fn rows(&self) -> Vec<Row<'_>> {
        let taken = self.schedule.entries.iter().map(Row::Taken);
        let mut rows: Vec<Row<'_>> =
            taken.chain(self.schedule.left_out.iter().map(Row::LeftOut)).collect();
        rows.sort_by_key(|row| match row {
            Row::Taken(entry) => (entry.pass.aos, entry.pass.satellite, entry.from),
            Row::LeftOut(left) => (left.pass.aos, left.pass.satellite, left.pass.aos),
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
        for row in self.rows() {
            match row {
                Row::Taken(entry) => writeln!(
                    out,
                    "{:<antennas$}  {:<names$}  {}  {}  {:>6}  {:>5}  {:>6}",
                    self.antenna(entry.antenna),
                    self.satellite(entry.pass.satellite),
                    civil(entry.from, "%Y-%m-%d %H:%M:%S"),
                    civil(entry.to, "%H:%M:%S"),
                    minutes(entry.counted_s),
                    minutes(entry.slew_s),
                    entry.spare_s.map(minutes).unwrap_or_default(),
                )?,
                Row::LeftOut(left) => writeln!(
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

    fn csv(&self, out: &mut impl Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(HEADER).map_err(io_error)?;
        for row in self.rows() {
            let fields: [String; 13] = match row {
                Row::Taken(entry) => [
                    "taken".to_owned(),
                    plain(self.antenna(entry.antenna)).into_owned(),
                    entry.pass.satellite.to_string(),
                    plain(&self.satellite(entry.pass.satellite)).into_owned(),
                    rfc3339(entry.pass.aos),
                    rfc3339(entry.from),
                    rfc3339(entry.to),
                    entry.counted_s.to_string(),
                    entry.late_s.to_string(),
                    entry.early_s.to_string(),
                    entry.slew_s.to_string(),
                    entry.spare_s.map(|spare_s| spare_s.to_string()).unwrap_or_default(),
                    String::new(),
                ],
                Row::LeftOut(left) => {
                    let mut fields: [String; 13] = Default::default();
                    let said = [
                        "left out".to_owned(),
                        String::new(),
                        left.pass.satellite.to_string(),
                        plain(&self.satellite(left.pass.satellite)).into_owned(),
                        rfc3339(left.pass.aos),
                    ];
                    for (field, said) in fields.iter_mut().zip(said) {
                        *field = said;
                    }
                    if let Some(reason) = fields.last_mut() {
                        *reason = plain(&(self.reason)(left)).into_owned();
                    }
                    fields
                }
            };
            table.write_record(fields).map_err(io_error)?;
        }
        table.flush()
    }

    fn json(&self, out: &mut impl Write) -> io::Result<()> {
        let antennas: BTreeMap<String, &String> =
            self.antennas.iter().map(|(id, name)| (id.0.to_string(), name)).collect();
        let whole = serde_json::json!({
            "antennas": antennas,
            "satellites": self.satellites,
            "schedule": self.schedule,
        });
        serde_json::to_writer_pretty(&mut *out, &whole)?;
        writeln!(out)
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
            event.add_property("DTSTART", civil(entry.from, BASIC));
            event.add_property("DTEND", civil(entry.to, BASIC));
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
        let half_s = 0.5 * seconds_between(entry.from, entry.to);
        // AOS may differ: the passes may have been predicted again since the schedule was made.
        let middle = add_seconds(entry.from, half_s);
        let is_planned = |row: &ExportedPass<'_>| {
            row.satellite.elements.catalog_number() == number
                && (row.pass.aos.time..=row.pass.los.time).contains(&middle)
        };
        let found = self.passes.iter().position(is_planned);
        let id = found.and_then(|place| pass_ids.get(place)).cloned();
        id.unwrap_or_else(|| format!("{number}-{}", entry.pass.aos.as_second()))
    }
}

/// Time between the alarm of a calendar and the start of what it is for.
const ALARM_BEFORE: TimeDelta = TimeDelta::minutes(5);

/// UTC in the basic form of iCalendar.
const BASIC: &str = "%Y%m%dT%H%M%SZ";

fn minutes(seconds: f64) -> String {
    let whole = seconds.round() as i64;
    format!("{}:{:02}", whole / 60, whole % 60)
}
