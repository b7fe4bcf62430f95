//! Requests to the Azel that has the station file open: a window or `azel serve`.

use std::{
    io::{self, Write as _},
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context as _, anyhow, bail};
use clap::{Args, ValueEnum, builder::NonEmptyStringValueParser};
use jiff::Timestamp;

use crate::{
    controller::SPECS,
    engine::{
        Settings,
        claim::LockFolders,
        reach::{self, Outcome, Reached},
        socket::{Answer, Ask},
        status::{AntennaStatus, AutomaticStatus},
    },
    station::{self, Antenna, LockOut},
};

/// Exit code when an antenna is not known to stand.
const NOT_PROVED: u8 = 4;

#[derive(Debug, Args)]
pub(super) struct StopOptions {
    /// Antenna to stop, by its name; all of them without it
    #[arg(long, value_name = "NAME")]
    antenna: Option<String>,
}

#[derive(Debug, Args)]
pub(super) struct StatusOptions {
    /// Write JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
pub(super) struct AutomaticOptions {
    #[arg(value_enum)]
    switch: Switch,
    /// Antenna, by its name
    #[arg(long, value_name = "NAME")]
    antenna: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Switch {
    /// The antenna takes the passes of its schedule by itself
    On,
    /// It takes no more of them; a pass under way goes on
    Off,
}

#[derive(Debug, Args)]
pub(super) struct LockOutOptions {
    /// Antenna, by its name
    #[arg(long, value_name = "NAME")]
    antenna: String,
    /// Why it is locked out
    #[arg(long, value_name = "TEXT", required_unless_present = "lift", value_parser = NonEmptyStringValueParser::new())]
    reason: Option<String>,
    /// Who locks it out; the user by default
    #[arg(long = "by", value_name = "WHO", value_parser = NonEmptyStringValueParser::new())]
    operator: Option<String>,
    /// Take the lock-out off
    #[arg(long = "off", conflicts_with_all = ["reason", "operator"])]
    lift: bool,
    /// With --off: who locked it out, as `azel status` says
    #[arg(long, value_name = "WHO", requires = "lift")]
    locked_by: Option<String>,
}

pub(super) fn stop(station: Option<PathBuf>, options: &StopOptions) -> anyhow::Result<ExitCode> {
    let (folders, path) = places(station)?;
    let ask = Ask::Stop { antenna: options.antenna.clone() };
    let mut reached = reach::ask_station(&folders, &path, &ask)?;
    if reached.is_empty() {
        // Another station file may have the units of this one.
        reached = reach::stop_units(&folders, &antennas(&path, options.antenna.as_deref()))?;
    }
    if reached.is_empty() {
        return Err(nobody(&path));
    }
    let (mut are_proved, mut stopped, mut refused) = (true, 0, None);
    for Reached { holder, outcome } in reached {
        let holder = holder.map_or_else(|| "another Azel".to_owned(), |holder| holder.to_string());
        match outcome {
            Outcome::Answered(Answer::Stopped(antennas)) => {
                for antenna in &antennas {
                    let word = if antenna.proved { "stands" } else { "NOT known to stand" };
                    say(&format!("{}: {word}", antenna.antenna))?;
                    if let Some(reason) = &antenna.not_on_disk {
                        say(&format!(
                            "STOP of {} is sent, NOT on disk, and lost when Azel ends: {reason}",
                            antenna.antenna
                        ))?;
                    }
                }
                stopped += antennas.len();
                are_proved &= antennas.iter().all(|antenna| antenna.proved);
            }
            Outcome::Answered(other) => refused = Some(unexpected(other)),
            Outcome::Signalled => {
                say(&format!(
                    "STOP went to {holder} as a signal, for all its antennas: NOT known to stand"
                ))?;
                are_proved = false;
                stopped += 1;
            }
            Outcome::NotReached(reason) => {
                say(&format!("NOT reached: {holder} has the station or a unit of it ({reason})"))?;
                are_proved = false;
                stopped += 1;
            }
        }
    }
    if !are_proved {
        return Ok(ExitCode::from(NOT_PROVED));
    }
    if let Some(refused) = refused {
        return Err(refused);
    }
    if stopped == 0 {
        say("No antenna is connected or was moved from there.")?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The antennas of the station file at `path`, or the one called `name`.
fn antennas(path: &Path, name: Option<&str>) -> Vec<Antenna> {
    let Ok(loaded) = station::load(path, SPECS) else { return Vec::new() };
    let antennas = loaded.station.antennas.into_iter();
    antennas.filter(|antenna| name.is_none_or(|name| antenna.name == name)).collect()
}

pub(super) fn status(
    station: Option<PathBuf>,
    options: &StatusOptions,
) -> anyhow::Result<ExitCode> {
    let Answer::Status(antennas) = expected(ask(station, &Ask::Status)?)? else {
        bail!("the answer is to another question");
    };
    if options.json {
        say(&serde_json::to_string(&antennas)?)?;
    } else {
        for antenna in &antennas {
            say(&sentence(antenna))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn sentence(antenna: &AntennaStatus) -> String {
    let link = format!("link {:?}", antenna.link).to_lowercase();
    let age = |time: Timestamp| Timestamp::now().duration_since(time).as_secs_f64();
    let parts = [
        Some(link),
        Some(antenna.intent.clone()),
        antenna.azimuth_deg.map(|azimuth| format!("azimuth {azimuth:.1}°")),
        antenna.elevation_deg.map(|elevation| format!("elevation {elevation:.1}°")),
        antenna.measured_at.map(|time| format!("measured {:.1} s ago", age(time))),
        antenna.moves.map(|moves| if moves { "moves" } else { "stands" }.to_owned()),
        antenna.tracks.as_ref().map(|name| format!("tracks {name}")),
        match antenna.automatic {
            AutomaticStatus::Off => None,
            AutomaticStatus::On => Some("automatic".to_owned()),
            AutomaticStatus::Suspended => Some("automatic operation suspended".to_owned()),
        },
        antenna.owes_stop.then(|| "STOP IS NOT PROVED".to_owned()),
        antenna.locked_out.as_ref().map(|author| format!("locked out by {author}")),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    format!("{}: {}", antenna.antenna, parts.join(", "))
}

pub(super) fn automatic(
    station: Option<PathBuf>,
    options: &AutomaticOptions,
) -> anyhow::Result<ExitCode> {
    let antenna = options.antenna.clone();
    let is_on = options.switch == Switch::On;
    match ask(station, &Ask::Automatic { antenna: antenna.clone(), is_on })? {
        Answer::Automatic { waits_for_connect } => {
            let word = if is_on { "on" } else { "off" };
            say(&format!("Automatic operation of {antenna} is {word}."))?;
            if is_on && waits_for_connect {
                say(&format!(
                    "{antenna} is not connected, so nothing moves yet. Press Connect in the window. To \
                     connect at every start, set connects_at_start = true for {antenna} in the \
                     station file."
                ))?;
                return Ok(ExitCode::from(NOT_PROVED));
            }
            Ok(ExitCode::SUCCESS)
        }
        other => Err(unexpected(other)),
    }
}

pub(super) fn lock_out(
    station: Option<PathBuf>,
    options: &LockOutOptions,
) -> anyhow::Result<ExitCode> {
    let name = options.operator.clone().or_else(|| std::env::var("USER").ok());
    let lock_out = options.reason.clone().map(|reason| LockOut {
        operator: name.unwrap_or_else(|| "the command line".to_owned()),
        reason,
        start: Timestamp::now(),
    });
    let antenna = options.antenna.clone();
    let is_off = lock_out.is_none();
    let locked_by = options.locked_by.clone();
    match ask(station, &Ask::LockOut { antenna: antenna.clone(), lock_out, locked_by })? {
        Answer::LockOut { proved, not_on_disk } => {
            match (is_off, proved) {
                (true, _) => say(&format!("{antenna} is not locked out any more."))?,
                (false, true) => say(&format!("{antenna} is locked out and stands."))?,
                (false, false) => say(&format!(
                    "{antenna} is locked out, but it is NOT confirmed that it stands and does not \
                     start by itself."
                ))?,
            }
            if let Some(explanation) = &not_on_disk {
                say(&format!(
                    "This change is NOT on disk and is lost when Azel ends: {explanation}"
                ))?;
            }
            let is_good = proved && not_on_disk.is_none();
            Ok(if is_good { ExitCode::SUCCESS } else { ExitCode::from(NOT_PROVED) })
        }
        other => Err(unexpected(other)),
    }
}

/// Asks the Azel that has the station open.
fn ask(station: Option<PathBuf>, ask: &Ask) -> anyhow::Result<Answer> {
    let (folders, path) = places(station)?;
    let reached = reach::ask_station(&folders, &path, ask)?;
    let mut silent = None;
    for Reached { holder, outcome } in reached {
        match outcome {
            Outcome::Answered(answer) => return Ok(answer),
            Outcome::Signalled => {}
            Outcome::NotReached(reason) => silent = Some((holder, reason)),
        }
    }
    let Some((holder, reason)) = silent else { return Err(nobody(&path)) };
    let holder = holder.map_or_else(|| "another Azel".to_owned(), |holder| holder.to_string());
    bail!("{holder} has {} open and did not answer: {reason}", path.display())
}

/// Folders of locks and sockets, and the station file.
fn places(station: Option<PathBuf>) -> anyhow::Result<(LockFolders, PathBuf)> {
    let path = Settings { path: station, ..Settings::default() }.station_path();
    let path = path.context("this user has no folder for settings")?;
    let folders = LockFolders::of_user().context("this user has no folder for sockets")?;
    Ok((folders, path))
}

fn nobody(path: &Path) -> anyhow::Error {
    anyhow!(
        "No Azel of this machine has the station {} open: nothing was asked of any antenna.",
        path.display()
    )
}

fn expected(answer: Answer) -> anyhow::Result<Answer> {
    match answer {
        Answer::Refused(reason) => Err(anyhow!("Refused: {reason}.")),
        answer => Ok(answer),
    }
}

fn unexpected(answer: Answer) -> anyhow::Error {
    match expected(answer) {
        Err(refused) => refused,
        Ok(_) => anyhow!("the answer is to another question"),
    }
}

fn say(line: &str) -> io::Result<()> {
    writeln!(io::stdout(), "{line}")
}
