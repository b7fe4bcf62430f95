//! A page to print for the operator who takes over the shift: the next 24 hours of the schedule. The
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

/// Height of the head of the page, millimetres; as in the style sheet.
const HEAD_MM: f64 = 15.0;
/// Least height of the notes, with the signatures, millimetres.
const NOTES_MM: f64 = 24.0;
/// Height that is kept for passes that are left out beside many entries, millimetres.
const FEW_LEFT_OUT_MM: f64 = 38.0;

/// The part of a schedule that the sheet shows, and what it is made from.
pub struct HandOverSheet<'a> {
    station: &'a Station,
    schedule: &'a Schedule,
    /// By catalog number.
    satellites: &'a BTreeMap<u32, (&'a Elements, &'a Propagator)>,
    start: Timestamp,
    end: Timestamp,
    printed: Timestamp,
}

impl<'a> HandOverSheet<'a> {
    /// The first 24 hours of a schedule that was made for the time between `start` and `end`,
    /// printed at `printed`.
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

    /// The page, as HTML.
    pub fn html(&self) -> String {
        let entries = entries::Table::new(self);
        let left_out = left_out::List::new(self);
        let ages = ages::List::new(self);
        let fixed_mm = HEAD_MM + self.time_line_mm() + ages.height_mm() + NOTES_MM;
        let room_mm = HEIGHT_MM - fixed_mm - 5.0 * GAP_MM;
        // The entries come first, but for a few lines of what is left out.
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

    /// Which station, which hours, and how good the schedule is known to be.
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

    /// Name of a satellite; its number where it has none.
    fn name(&self, number: u32) -> String {
        let known_satellite = self.satellites.get(&number);
        known_satellite
            .map_or_else(|| number.to_string(), |(elements, _)| page::printable(&elements.label()))
    }

    /// Name of a satellite with the time of AOS.
    fn named_pass(&self, pass: PassKey) -> String {
        format!("{} {}", self.name(pass.satellite), format::minute_of_day(pass.aos))
    }

    fn antenna(&self, id: AntennaId) -> String {
        let antenna_config = self.station.antennas.iter().find(|antenna| antenna.id == id);
        antenna_config.map_or_else(|| "?".to_owned(), |antenna| page::printable(&antenna.name))
    }
}

/// Lines to write on, and the signatures at the bottom of the page.
fn notes() -> Markup {
    let content = html! {
        div.lines {}
        footer {
            @for word in ["Handed over by", "Taken over by", "Time (UTC)"] { span { (word) } }
        }
    };
    section("notes", "Notes", "", &content)
}
