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
    engine::{
        Settings,
        claim::{claims_folder, socket_path},
        socket::{self, Answer, Ask},
        status::{AntennaStatus, AutomaticStatus},
    },
    station::LockOut,
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
    #[arg(long, value_name = "TEXT", required_unless_present = "off", value_parser = NonEmptyStringValueParser::new())]
    reason: Option<String>,
    /// Who locks it out; the user by default
    #[arg(long, value_name = "WHO", value_parser = NonEmptyStringValueParser::new())]
    by: Option<String>,
    /// Take the lock-out off
    #[arg(long, conflicts_with_all = ["reason", "by"])]
    off: bool,
    /// With --off: who locked it out, as `azel status` says
    #[arg(long, value_name = "WHO", requires = "off")]
    locked_by: Option<String>,
}

pub(super) fn stop(station: Option<PathBuf>, options: &StopOptions) -> anyhow::Result<ExitCode> {
    match ask(station, &Ask::Stop { antenna: options.antenna.clone() })? {
        Answer::Stopped(antennas) if antennas.is_empty() => {
            say("No antenna is connected or was moved from there.")?;
            Ok(ExitCode::SUCCESS)
        }
        Answer::Stopped(antennas) => {
            for antenna in &antennas {
                let word = if antenna.proved { "stands" } else { "NOT known to stand" };
                say(&format!("{}: {word}", antenna.antenna))?;
                if let Some(why) = &antenna.not_on_disk {
                    say(&format!(
                        "STOP of {} is sent, NOT on disk, and lost when Azel ends: {why}",
                        antenna.antenna
                    ))?;
                }
            }
            let all = antennas.iter().all(|antenna| antenna.proved);
            Ok(if all { ExitCode::SUCCESS } else { ExitCode::from(NOT_PROVED) })
        }
        other => Err(unexpected(other)),
    }
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
    let age = |at: Timestamp| Timestamp::now().duration_since(at).as_secs_f64();
    let parts = [
        Some(link),
        Some(antenna.intent.clone()),
        antenna.azimuth_deg.map(|azimuth| format!("azimuth {azimuth:.1}°")),
        antenna.elevation_deg.map(|elevation| format!("elevation {elevation:.1}°")),
        antenna.measured_at.map(|at| format!("measured {:.1} s ago", age(at))),
        antenna.moves.map(|moves| if moves { "moves" } else { "stands" }.to_owned()),
        antenna.tracks.as_ref().map(|name| format!("tracks {name}")),
        match antenna.automatic {
            AutomaticStatus::Off => None,
            AutomaticStatus::On => Some("automatic".to_owned()),
            AutomaticStatus::Suspended => Some("automatic operation suspended".to_owned()),
        },
        antenna.owes_stop.then(|| "STOP IS NOT PROVED".to_owned()),
        antenna.locked_out.as_ref().map(|by| format!("locked out by {by}")),
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
        Answer::Automatic => {
            let word = if is_on { "on" } else { "off" };
            say(&format!("Automatic operation of {antenna} is {word}."))?;
            Ok(ExitCode::SUCCESS)
        }
        other => Err(unexpected(other)),
    }
}

pub(super) fn lock_out(
    station: Option<PathBuf>,
    options: &LockOutOptions,
) -> anyhow::Result<ExitCode> {
    let by = options.by.clone().or_else(|| std::env::var("USER").ok());
    let lock_out = options.reason.clone().map(|reason| LockOut {
        by: by.unwrap_or_else(|| "the command line".to_owned()),
        reason,
        since: Timestamp::now(),
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
            if let Some(why) = &not_on_disk {
                say(&format!("This change is NOT on disk and is lost when Azel ends: {why}"))?;
            }
            let is_good = proved && not_on_disk.is_none();
            Ok(if is_good { ExitCode::SUCCESS } else { ExitCode::from(NOT_PROVED) })
        }
        other => Err(unexpected(other)),
    }
}

fn ask(station: Option<PathBuf>, ask: &Ask) -> anyhow::Result<Answer> {
    let path = Settings { path: station, ..Settings::default() }.station_path();
    let path = path.context("this user has no folder for settings")?;
    let folder = claims_folder().context("this user has no folder for sockets")?;
    let answer = socket::ask(&socket_path(&folder, &path), ask);
    answer.map_err(|error| nobody(&error, &path))
}

fn nobody(error: &io::Error, path: &Path) -> anyhow::Error {
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::ConnectionRefused => anyhow!(
            "No Azel of this user has the station {} open: nothing was asked of any antenna.",
            path.display()
        ),
        _ => anyhow!("The Azel that has {} open did not answer: {error}", path.display()),
    }
}

fn expected(answer: Answer) -> anyhow::Result<Answer> {
    match answer {
        Answer::Refused(why) => Err(anyhow!("Refused: {why}.")),
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
