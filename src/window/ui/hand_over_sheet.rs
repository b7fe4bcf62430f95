//! Page to print for the operator who takes over the shift: the next 24 hours of the schedule. The
//! page counts the entries that do not fit.

mod ages;
mod entries;
mod facts;
mod left_out;
#[cfg(test)]
mod tests;
mod time_line;

use std::collections::BTreeMap;

use jiff::Timestamp;
use maud::{Markup, html};

use super::{
    format,
    page::{self, GAP_MM, HEIGHT_MM, section},
    words,
};
use crate::{
    astro::time::{DAY_S, add_seconds},
    orbit::{Elements, Propagator},
    plan::schedule::{PassKey, Schedule},
    station::{AntennaId, Station},
};

/// Height of the page head, millimetres; equals the value in the style sheet.
const HEAD_MM: f64 = 15.0;
/// Min height of the notes with the signatures, millimetres.
const NOTES_MM: f64 = 24.0;
/// Height reserved for left-out passes beside many entries, millimetres.
const FEW_LEFT_OUT_MM: f64 = 38.0;

/// Part of a schedule that the sheet shows, with its sources.
pub struct HandOverSheet<'a> {
    station: &'a Station,
    schedule: &'a Schedule,
    /// Elements and propagators by catalog number.
    satellites: &'a BTreeMap<u32, (&'a Elements, &'a Propagator)>,
    start: Timestamp,
    end: Timestamp,
    printed: Timestamp,
}

impl<'a> HandOverSheet<'a> {
    /// Creates the sheet for the first 24 hours of a schedule for the time between `start` and
    /// `end`, printed at `printed`.
    pub fn new(
        station: &'a Station,
        schedule: &'a Schedule,
        satellites: &'a BTreeMap<u32, (&'a Elements, &'a Propagator)>,
        (start, end): (Timestamp, Timestamp),
        printed: Timestamp,
    ) -> Self {
        let end = end.min(add_seconds(start, DAY_S)).max(add_seconds(start, 1.0));
        Self { station, schedule, satellites, start, end, printed }
    }

    /// Returns the page as HTML.
    pub fn html(&self) -> String {
        let entries = entries::Table::new(self);
        let left_out = left_out::List::new(self);
        let ages = ages::List::new(self);
        let fixed_mm = HEAD_MM + self.time_line_mm() + ages.height_mm() + NOTES_MM;
        let room_mm = HEIGHT_MM - fixed_mm - 5.0 * GAP_MM;
        // The entries get the room first, except a few lines for the left-out passes.
        let few_mm = left_out.height_mm(FEW_LEFT_OUT_MM);
        let laid_out = entries.lay_out(room_mm - few_mm);
        let left_mm = room_mm - laid_out.height_mm();
        let content = html! {
            (self.head())
            (self.time_line())
            (laid_out.html())
            (left_out.html(left_mm))
            (ages.html())
            (notes())
        };
        page::whole(&format!("Hand-over sheet, {}", self.station.name), &content)
    }

    /// Returns the page head: the station, the hours, and the proven quality of the schedule.
    fn head(&self) -> Markup {
        let minute = |time| format!("{} {}Z", format::date(time), format::minute_of_day(time));
        let span = format!("{} to {} (UTC)", minute(self.start), minute(self.end));
        let printed = format!("Printed {}", minute(self.printed));
        let rule = words::schedule::choose_by(self.station.scheduling.choose_by);
        let proof = words::schedule::proof(self.schedule);
        let place = page::place(self.station.site);
        let lines = [[&*span, &*printed], [&*format!("{rule}. {proof}"), &*place]];
        page::head(&self.station.name, "Hand-over sheet", lines)
    }

    /// Returns the name of a satellite, or its number if it has no known name.
    fn name(&self, number: u32) -> String {
        let known_satellite = self.satellites.get(&number);
        known_satellite
            .map_or_else(|| number.to_string(), |(elements, _)| page::printable(&elements.label()))
    }

    /// Returns the name of a satellite with the time of AOS.
    fn named_pass(&self, pass: PassKey) -> String {
        format!("{} {}", self.name(pass.satellite), format::minute_of_day(pass.aos))
    }

    fn antenna(&self, id: AntennaId) -> String {
        let antenna_config = self.station.antennas.iter().find(|antenna| antenna.id == id);
        antenna_config.map_or_else(|| "?".to_owned(), |antenna| page::printable(&antenna.name))
    }
}

/// Returns lines to write on, and the signatures at the bottom of the page.
fn notes() -> Markup {
    let content = html! {
        div.lines {}
        footer {
            @for word in ["Handed over by", "Taken over by", "Time (UTC)"] { span { (word) } }
        }
    };
    section("notes", "Notes", "", &content)
}
