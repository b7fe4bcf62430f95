//! `azel check`: reads a station file and names what cannot be used in it.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::Context as _;
use clap::Args;

use crate::{controller::SPECS, station, ui::words::setting_note};

/// The file holds entries that cannot be used.
const HOLDS_ERRORS: u8 = 3;

#[derive(Debug, Args)]
pub(super) struct Options {
    /// The station file [default: the one that Azel would open]
    file: Option<PathBuf>,
}

/// Exit code 0 if the whole file can be used, 3 if entries cannot, 1 if the file cannot be read.
pub(super) fn run(station_file: Option<&Path>, options: &Options) -> anyhow::Result<ExitCode> {
    let default_path = station::settings_path();
    let path = options.file.as_deref().or(station_file).or(default_path.as_deref());
    let path = path.context("this user has no folder for settings")?;
    let loaded = station::load(path, SPECS)?;
    let mut out = io::stdout().lock();
    for note in &loaded.notes {
        writeln!(out, "{}", setting_note(note))?;
    }
    let station = &loaded.station;
    for antenna in &station.antennas {
        let concerns = |unread: &&station::Unread| unread.concerns(antenna.id);
        if let Some(unread) = station.unread.iter().find(concerns) {
            let (name, place) = (&antenna.name, &unread.place);
            writeln!(out, "{name} will not move by itself: {place} could not be read.")?;
        }
    }
    if loaded.notes.is_empty() {
        writeln!(out, "Every entry can be used: {}", path.display())?;
        return Ok(ExitCode::SUCCESS);
    }
    Ok(ExitCode::from(HOLDS_ERRORS))
}
