//! A page to print for the operator who takes over the shift: the next 24 hours of the schedule as
//! SVG, one page of A4 in black on white. The page counts the entries that do not fit.

mod ages;
mod entries;
mod facts;
mod head;
mod left_out;
#[cfg(test)]
mod tests;
mod time_line;

use std::collections::BTreeMap;

use jiff::Timestamp;

use super::{
    format,
    sheet::{BOTTOM, LEFT, MARGIN, RIGHT, SMALL, section, svg::Svg},
};
use crate::{
    astro::time::{DAY_S, add_seconds},
    orbit::{Elements, Propagator},
    plan::schedule::{PassKey, Schedule},
    station::{AntennaId, Station},
};

/// Between two sections.
const GAP: f64 = 9.0;
/// Least height of the notes, with the signatures.
const NOTES: f64 = 64.0;
/// Height that is kept for passes that are left out beside many entries.
const FEW_LEFT_OUT: f64 = 110.0;

/// The part of a schedule that the sheet shows, and what it is made from.
pub struct HandOverSheet<'a> {
    station: &'a Station,
    schedule: &'a Schedule,
    /// By catalog number.
    satellites: &'a BTreeMap<u32, (&'a Elements, &'a Propagator)>,
    from: Timestamp,
    until: Timestamp,
    printed: Timestamp,
}

impl<'a> HandOverSheet<'a> {
    /// The first 24 hours of a schedule that was made for the time between `from` and `until`,
    /// printed at `printed`.
    pub fn new(
        station: &'a Station,
        schedule: &'a Schedule,
        satellites: &'a BTreeMap<u32, (&'a Elements, &'a Propagator)>,
        (from, until): (Timestamp, Timestamp),
        printed: Timestamp,
    ) -> Self {
        let until = until.min(add_seconds(from, DAY_S)).max(add_seconds(from, 1.0));
        Self { station, schedule, satellites, from, until, printed }
    }

    /// The page.
    pub fn svg(&self) -> String {
        let mut svg = Svg::new(&format!("Hand-over sheet, {}", self.station.name));
        let entries = entries::Table::of(self);
        let left_out = left_out::List::of(self);
        let ages = ages::List::of(self);

        let mut y = self.head(&mut svg, MARGIN);
        y = self.time_line(&mut svg, y + GAP) + GAP;
        // From here on the page is shared out: the entries come first.
        let after = ages.height() + 2.0 * GAP + NOTES;
        let few = left_out.height(FEW_LEFT_OUT);
        y = entries.draw(&mut svg, y, BOTTOM - after - few - GAP - y) + GAP;
        y = left_out.draw(&mut svg, y, BOTTOM - after - y) + GAP;
        y = ages.draw(&mut svg, y) + GAP;
        notes(&mut svg, y);
        svg.finish()
    }

    /// Name of a satellite; its number where it has none.
    fn name(&self, number: u32) -> String {
        let known = self.satellites.get(&number);
        known.map_or_else(|| number.to_string(), |(elements, _)| elements.label())
    }

    /// Name of a satellite with the time of AOS.
    fn named_pass(&self, pass: PassKey) -> String {
        format!("{} {}", self.name(pass.satellite), format::minute_of_day(pass.aos))
    }

    fn antenna(&self, id: AntennaId) -> &str {
        let known = self.station.antennas.iter().find(|antenna| antenna.id == id);
        known.map_or("?", |antenna| &antenna.name)
    }
}

/// Lines to write on, and the signatures at the bottom of the page.
fn notes(svg: &mut Svg, y: f64) {
    const LINE: f64 = 17.0;
    let signatures = BOTTOM - 2.0;
    let mut y = section(svg, y, "Notes", "") + LINE;
    while y < signatures - LINE - 4.0 {
        svg.line([LEFT, y], [RIGHT, y], 0.25);
        y += LINE;
    }
    let third = (RIGHT - LEFT) / 3.0;
    for (word, column) in ["Handed over by", "Taken over by", "Time (UTC)"].into_iter().zip(0..) {
        let x = LEFT + third * f64::from(column);
        svg.text([x, signatures], third, SMALL, word);
        svg.line([x + 56.0, signatures + 1.0], [x + third - 10.0, signatures + 1.0], 0.5);
    }
}
