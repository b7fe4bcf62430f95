//! Input of `azel passes`, `azel look` and `azel plan`: the site and the satellites.

mod age;
mod elevations;
mod place;
mod satellites;
mod values;

use std::{
    io::{self, Write as _},
    path::{Path, PathBuf},
    process::ExitCode,
};

use clap::{Args, CommandFactory as _, builder::NonEmptyStringValueParser, error::ErrorKind};
use jiff::Timestamp;

pub(super) use self::{
    elevations::Elevations,
    place::Place,
    satellites::Satellites,
    values::{duration_s, elevation, hours, instant, megahertz, minutes, share, step_s},
};
use super::Cli;
use crate::{export::Satellite, station::Favourites};

/// Exit code when something was written, but part of the request could not be used.
const NOT_ALL: u8 = 3;

/// Exit codes, for `--help`.
pub(super) const EXIT_CODES: &str = "Exit code: 0 when all objects that were asked for were used; \
    3 when one of them could not be used, or a file holds nothing usable (standard error names \
    each with the reason); 1 when nothing could be done; 2 for a wrong command line.";

#[derive(Debug, Args)]
pub(super) struct InputOptions {
    /// Element files: TLE, or OMM in JSON, CSV, XML or KVN; `-` reads standard
    /// input, a folder stands for all element files in it. The newest set of an
    /// object is used
    #[arg(long, value_name = "FILE", num_args = 1..)]
    elements: Vec<PathBuf>,
    /// Elements of this source of the station, as they were last fetched. With
    /// `--station` and neither this nor `--elements`, all its sources are used
    #[arg(long, value_name = "NAME")]
    group: Vec<String>,
    /// Only these objects, and those of --name
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    catalog_number: Vec<u32>,
    /// Only objects whose name holds this text in any case, and those of --catalog-number
    #[arg(long, value_name = "TEXT", value_parser = NonEmptyStringValueParser::new())]
    name: Vec<String>,
    /// Latitude of the site in degrees, north positive; that of the station when left out
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = values::latitude)]
    lat: Option<f64>,
    /// Longitude of the site in degrees, east positive
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = values::longitude)]
    lon: Option<f64>,
    /// Altitude of the site above the WGS84 ellipsoid in metres
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = values::altitude)]
    alt: Option<f64>,
}

impl InputOptions {
    /// Leaves the satellites that a plan of the station is for: those that the command line asks
    /// for, by number, name or file, or else the favourites.
    pub(super) fn keep_planned(&self, list: &mut Vec<Satellite>, favourites: &Favourites) {
        let asks_for_none =
            self.catalog_number.is_empty() && self.name.is_empty() && self.elements.is_empty();
        if asks_for_none {
            list.retain(|satellite| favourites.contains(satellite.elements.catalog_number()));
        }
    }

    /// Refuses a command line that lacks the site or the elements.
    pub(super) fn check(&self, command: &str, station: Option<&Path>) -> Result<(), clap::Error> {
        if station.is_some() {
            return Ok(());
        }
        let missing = [
            ("--elements <FILE>...", self.elements.is_empty()),
            ("--lat <DEG>", self.lat.is_none()),
            ("--lon <DEG>", self.lon.is_none()),
            ("--alt <M>", self.alt.is_none()),
        ];
        let missing: Vec<&str> =
            missing.iter().filter(|(_, is_missing)| *is_missing).map(|(name, _)| *name).collect();
        if !missing.is_empty() {
            let list = missing.join(", ");
            return Err(usage(command, &format!("without --station these are needed: {list}")));
        }
        if !self.group.is_empty() {
            return Err(usage(command, "--group is a source of a station and needs --station"));
        }
        Ok(())
    }
}

pub(super) fn exit_code(is_complete: bool) -> ExitCode {
    if is_complete { ExitCode::SUCCESS } else { ExitCode::from(NOT_ALL) }
}

/// Warns on standard error about elements too far from the time between `start` and `end`.
pub(super) fn caution(satellites: &[Satellite], start: Timestamp, end: Timestamp) {
    let elements = satellites.iter().map(|satellite| &satellite.elements);
    if let Some(sentence) = age::caution(elements, start, end) {
        note(&sentence);
    }
}

/// Writes a sentence to standard error.
pub(super) fn note(sentence: &str) {
    // An error is ignored: standard error is closed.
    let _ = writeln!(io::stderr(), "{sentence}");
}

/// Error for a wrong command line of `azel <command>`.
pub(super) fn usage(command: &str, sentence: &str) -> clap::Error {
    let mut azel = Cli::command();
    azel.build();
    let kind = ErrorKind::MissingRequiredArgument;
    match azel.find_subcommand_mut(command) {
        Some(command) => command.error(kind, sentence),
        None => azel.error(kind, sentence),
    }
}
