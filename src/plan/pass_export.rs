//! Lists of passes as table, CSV, JSON and iCalendar.

mod calendar;
mod csv;
mod json;
mod table;

use std::io::{self, Write};

use jiff::Timestamp;

use crate::orbit::{Elements, Pass};

/// A pass and its satellite.
#[derive(Debug, Clone, Copy)]
pub struct ExportedPass<'a> {
    pub elements: &'a Elements,
    pub pass: &'a Pass,
}

/// How a list is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum PassFormat {
    /// Columns to read
    Table,
    /// A header and one row per pass (RFC 4180)
    Csv,
    /// A list of objects
    Json,
    /// iCalendar (RFC 5545), one event per pass
    Ics,
}

/// Writes `rows` in their order. All times are UTC; `now` is the time stamp of
/// the calendar's events.
pub fn write_passes(
    out: &mut impl Write,
    format: PassFormat,
    rows: &[ExportedPass<'_>],
    now: Timestamp,
) -> io::Result<()> {
    match format {
        PassFormat::Table => table::write(out, rows),
        PassFormat::Csv => csv::write(out, rows),
        PassFormat::Json => json::write(out, rows),
        PassFormat::Ics => calendar::write(out, rows, now),
    }
}

/// RFC 3339, UTC, with milliseconds.
fn rfc3339(time: Timestamp) -> String {
    let rounded = time.round(jiff::Unit::Millisecond).unwrap_or(time);
    format!("{rounded:.3}")
}

/// A number of degrees without the noise behind the sixth decimal.
fn degrees(value: f64) -> f64 {
    // Adding zero makes the zero of a small negative number positive.
    (value * 1e6).round() / 1e6 + 0.0
}

#[cfg(test)]
mod testing;
