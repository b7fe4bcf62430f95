//! Lists for people and for other programs: passes, look angles, plans, rehearsals and recorded
//! passes. Each list is a struct of columns; Azel writes CSV and JSON from the same struct.

mod looks;
mod passes;
mod plan;
mod recorded;
mod rows;

use jiff::{Timestamp, tz::TimeZone};

pub use self::{
    looks::LookList,
    passes::{ExportedPass, PassList, PassQuery, Satellite},
    plan::PlanList,
    recorded::{points, reports},
    rows::{FORMAT_VERSION, RowFormat, Time, rounded, write_rows},
};

/// The form of a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ListFormat {
    /// Columns to read
    Table,
    /// A header and a line per row
    Csv,
    /// An object with a list of rows
    Json,
}

/// The form of a list of which a calendar can be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum EventFormat {
    /// Columns to read
    Table,
    /// A header and a line per row
    Csv,
    /// An object with a list of rows
    Json,
    /// iCalendar (RFC 5545), an event per pass
    Ics,
}

/// Formats a time in UTC, rounded to the nearest second.
pub fn civil(time: Timestamp, format: &str) -> String {
    let rounded = time.round(jiff::Unit::Second).unwrap_or(time);
    rounded.to_zoned(TimeZone::UTC).strftime(format).to_string()
}

/// Formats a duration as minutes and seconds.
pub fn minutes(seconds: f64) -> String {
    let whole = seconds.round() as i64;
    format!("{}:{:02}", whole / 60, whole % 60)
}
