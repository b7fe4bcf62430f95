//! `azel log`: the record of a station as lines of JSON.

use std::{
    io::{self, Seek as _},
    path::PathBuf,
    process::ExitCode,
    thread,
    time::Duration,
};

use anyhow::{Context as _, bail};
use clap::{Args, ValueEnum, builder::PossibleValue};
use jiff::{SignedDuration, Timestamp};

use super::{input, passes::written};
use crate::{
    contract::record::Row,
    engine::{Settings, demo_record_path, record_path, records_folder},
    record::{Query, Record, RowKind},
};

/// Time between two looks for new rows. The record is written twice a second.
const LOOK: Duration = Duration::from_millis(250);
/// Lines that are kept in memory until they are written, bytes; more go to a file.
const IN_MEMORY: usize = 1 << 20;
/// Longest time from a measurement until it is in the record.
const LATE: SignedDuration = SignedDuration::from_secs(2);

#[derive(Debug, Args)]
pub(super) struct Options {
    /// Start of the rows: `now`, a date (0 h UTC), or a time with Z or an offset [default: the
    /// beginning; with --follow, now]
    #[arg(long = "from", value_name = "TIME", value_parser = input::instant)]
    start: Option<Timestamp>,
    /// End of the rows, exclusive, in the same forms
    #[arg(long = "to", value_name = "TIME", value_parser = input::instant)]
    end: Option<Timestamp>,
    /// Only rows of this antenna
    #[arg(long, value_name = "NAME")]
    antenna: Option<String>,
    /// Kinds of rows [default: all except position and frame]
    #[arg(long, value_name = "KIND", value_delimiter = ',')]
    kind: Vec<Kinds>,
    /// Go on with what is recorded from now on, until Ctrl C
    #[arg(long)]
    follow: bool,
    /// Read this record file instead of the station's
    #[arg(long, value_name = "FILE", conflicts_with = "of_demo")]
    file: Option<PathBuf>,
    /// The record of the demo station
    #[arg(long = "of-demo")]
    of_demo: bool,
}

/// A kind of rows, as an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Kinds(RowKind);

impl ValueEnum for Kinds {
    fn value_variants<'a>() -> &'a [Self] {
        static ALL: std::sync::LazyLock<Vec<Kinds>> =
            std::sync::LazyLock::new(|| RowKind::all().map(Kinds).collect());
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.word()))
    }
}

pub(super) fn run(station: Option<PathBuf>, options: &Options) -> anyhow::Result<ExitCode> {
    let path = match &options.file {
        Some(file) => file.clone(),
        None => place(station, options.of_demo)?,
    };
    if !path.exists() {
        bail!(
            "There is no record at {}. A station is recorded while a window or azel serve runs it.",
            path.display()
        );
    }
    let unread = || format!("The record at {} cannot be read", path.display());
    let mut record = Record::open(&path).with_context(unread)?;
    let is_raw = |row_kind: &RowKind| matches!(row_kind, RowKind::Position | RowKind::Frame);
    let row_kinds = if options.kind.is_empty() {
        RowKind::all().filter(|row_kind| !is_raw(row_kind)).collect()
    } else {
        options.kind.iter().map(|kind| kind.0).collect()
    };
    let begins = options.follow.then(Timestamp::now);
    let query = Query {
        start: options.start.or(begins),
        end: options.end,
        antenna: options.antenna.clone(),
        row_kinds,
    };
    let unwritten = || format!("Printing the record at {} failed", path.display());
    written(|out| write(&mut record, &query, options.follow, out)).with_context(unwritten)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the rows that `query` wants, and goes on with those to come while `follow`.
fn write(
    record: &mut Record,
    query: &Query,
    follow: bool,
    out: &mut impl io::Write,
) -> io::Result<()> {
    loop {
        // Whoever reads standard output may take his time, and the record must not wait for him.
        let mut lines = tempfile::spooled_tempfile(IN_MEMORY);
        let mut outcome = Ok(());
        let read = record.read(query, &mut |row| {
            outcome = line(&mut lines, &row);
            outcome.is_ok()
        });
        read.map_err(io::Error::other)?;
        outcome?;
        lines.rewind()?;
        io::copy(&mut lines, out)?;
        out.flush()?;
        // What was measured at the end is written a little later.
        let is_over = query.end.is_some_and(|end| Timestamp::now().duration_since(end) > LATE);
        if !follow || is_over {
            return Ok(());
        }
        thread::sleep(LOOK);
    }
}

fn line(out: &mut impl io::Write, row: &Row) -> io::Result<()> {
    serde_json::to_writer(&mut *out, row)?;
    out.write_all(b"\n")
}

fn place(station: Option<PathBuf>, of_demo: bool) -> anyhow::Result<PathBuf> {
    if of_demo {
        return Ok(demo_record_path(&folder()?));
    }
    record_of(station)
}

fn folder() -> anyhow::Result<PathBuf> {
    records_folder().context("this user has no folder for records")
}

/// The record of the station of this file, or of the user's own.
pub(super) fn record_of(station: Option<PathBuf>) -> anyhow::Result<PathBuf> {
    let station = Settings { path: station, ..Settings::default() }.station_path();
    let station = station.context("this user has no folder for settings")?;
    Ok(record_path(&folder()?, &station))
}
