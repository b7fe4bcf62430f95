//! `azel log`: the record of a station as lines of JSON.

use std::{
    io::{self, BufWriter, Write as _},
    path::PathBuf,
    process::ExitCode,
    thread,
    time::Duration,
};

use anyhow::{Context as _, bail};
use clap::{Args, ValueEnum, builder::PossibleValue};
use jiff::Timestamp;

use super::input;
use crate::{
    engine::{Settings, demo_record_path, record_path, records_folder},
    record::{Query, Record, Row, What},
};

/// Time between two looks for new rows. The record is written twice a second.
const LOOK: Duration = Duration::from_millis(250);

#[derive(Debug, Args)]
pub(super) struct Options {
    /// From this instant on: `now`, a date (0 h UTC), or a time with Z or an offset; all without
    /// it
    #[arg(long, value_name = "TIME", value_parser = input::instant)]
    from: Option<Timestamp>,
    /// Before this instant
    #[arg(long, value_name = "TIME", value_parser = input::instant)]
    to: Option<Timestamp>,
    /// What concerns the antenna of this name alone
    #[arg(long, value_name = "NAME")]
    antenna: Option<String>,
    /// Kinds of rows; all but position and frame without it
    #[arg(long, value_name = "KIND", value_delimiter = ',')]
    kind: Vec<Kinds>,
    /// Go on with what is recorded from now on, until Ctrl C
    #[arg(long)]
    follow: bool,
    /// Another record than that of the station, such as a copy
    #[arg(long, value_name = "FILE", conflicts_with = "of_demo")]
    file: Option<PathBuf>,
    /// The record of the demo station
    #[arg(long = "of-demo")]
    of_demo: bool,
}

/// A kind of rows, as an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Kinds(What);

impl ValueEnum for Kinds {
    fn value_variants<'a>() -> &'a [Self] {
        static ALL: std::sync::LazyLock<Vec<Kinds>> =
            std::sync::LazyLock::new(|| What::all().map(Kinds).collect());
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
    let is_raw = |what: &What| matches!(what, What::Position | What::Frame);
    let what = if options.kind.is_empty() {
        What::all().filter(|what| !is_raw(what)).collect()
    } else {
        options.kind.iter().map(|kind| kind.0).collect()
    };
    let begins = options.follow.then(Timestamp::now);
    let query = Query {
        from: options.from.or(begins),
        to: options.to,
        antenna: options.antenna.clone(),
        what,
    };
    let mut lines = Lines { out: BufWriter::new(io::stdout().lock()), error: None };
    record.read(&query, &mut |row| lines.write(&row)).with_context(unread)?;
    while options.follow && lines.flush() && query.to.is_none_or(|to| to > Timestamp::now()) {
        thread::sleep(LOOK);
        record.read_on(&query, &mut |row| lines.write(&row)).with_context(unread)?;
    }
    lines.finish().context("The record cannot be written to standard output")?;
    Ok(ExitCode::SUCCESS)
}

fn place(station: Option<PathBuf>, of_demo: bool) -> anyhow::Result<PathBuf> {
    let folder = records_folder().context("this user has no folder for records")?;
    if of_demo {
        return Ok(demo_record_path(&folder));
    }
    let station = Settings { path: station, ..Settings::default() }.station_path();
    let station = station.context("this user has no folder for settings")?;
    Ok(record_path(&folder, &station))
}

/// Writes lines until nobody reads them.
struct Lines<W: io::Write> {
    out: BufWriter<W>,
    error: Option<io::Error>,
}

impl<W: io::Write> Lines<W> {
    /// Returns `false` once it makes no sense to go on.
    fn write(&mut self, row: &Row) -> bool {
        let written = serde_json::to_writer(&mut self.out, row)
            .map_err(io::Error::from)
            .and_then(|()| self.out.write_all(b"\n"));
        self.keep(written)
    }

    fn flush(&mut self) -> bool {
        let flushed = self.out.flush();
        self.keep(flushed)
    }

    fn keep(&mut self, outcome: io::Result<()>) -> bool {
        self.error = self.error.take().or(outcome.err());
        self.error.is_none()
    }

    fn finish(mut self) -> io::Result<()> {
        self.flush();
        match self.error {
            // The reader has seen enough.
            Some(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
            _ => Ok(()),
        }
    }
}
