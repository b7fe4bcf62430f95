//! Command line of the program.

mod check;
mod held_keys;
mod input;
pub mod log;
mod look;
mod no_window;
mod passes;
mod plan;
mod pointing;
mod record;
mod rehearse;
#[cfg(unix)]
mod remote;
pub mod serve;
mod simulate;
mod window;
mod work_area;

use std::{
    io::{self, Write as _},
    path::PathBuf,
    process::ExitCode,
};

use anyhow::Context as _;
use clap::{CommandFactory as _, Parser, Subcommand, error::ErrorKind};
use clap_complete::Shell;
use tracing_subscriber::filter::{LevelFilter, Targets};

#[cfg(unix)]
use crate::driver::dead_man;
use crate::engine::claim::LockFolders;

/// Console for the operator of a satellite ground station.
///
/// Without a command the window opens: on your station, or on a simulated
/// demo station while there are no settings yet.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100)]
pub struct Cli {
    /// Station file to use instead of the user's own
    #[arg(long, value_name = "FILE", global = true)]
    station: Option<PathBuf>,
    /// Open the window on the demo station, whatever station files there are
    #[arg(long, conflicts_with = "station")]
    demo: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Predict passes from element files
    Passes(Box<passes::Options>),
    /// Follow one satellite: direction, range and range rate in steps
    Look(Box<look::Options>),
    /// Plan which antenna takes which pass, and say why the others are left out
    Plan(Box<plan::Options>),
    /// Carry out the plan against simulated units, as fast as it can, and report on each pass
    Rehearse(Box<rehearse::Options>),
    /// Run the station without a window, until SIGTERM or Ctrl C
    Serve(serve::Options),
    /// Name the entries of a station file that cannot be used
    Check(check::Options),
    /// Write the record of the station as lines of JSON
    Log(record::Options),
    /// Fit a pointing model to the recorded passes of an antenna
    Pointing(Box<pointing::Options>),
    /// Stop the antennas of the Azel that has the station open, and wait for the proof
    #[cfg(unix)]
    Stop(remote::StopOptions),
    /// Tell how the antennas of the Azel that has the station open are
    #[cfg(unix)]
    Status(remote::StatusOptions),
    /// Switch automatic operation of an antenna of the Azel that has the station open
    #[cfg(unix)]
    Automatic(remote::AutomaticOptions),
    /// Lock out an antenna of the Azel that has the station open
    #[cfg(unix)]
    LockOut(remote::LockOutOptions),
    /// Stop a unit when the beat on standard input ends; started by the window
    #[cfg(unix)]
    #[command(name = dead_man::SUBCOMMAND, hide = true)]
    DeadMan {
        /// STOP as the unit understands it, in hexadecimal digits
        stop: String,
    },
    /// Serve a simulated controller to anyone who connects
    Simulate {
        #[command(subcommand)]
        simulator: simulate::Simulator,
    },
    /// Write what completes this command line in a shell to standard output
    #[command(hide = true)]
    Completions {
        /// Shell
        shell: Shell,
    },
    /// Write a man page for each command
    #[command(hide = true)]
    Man {
        /// Folder that the pages go to
        folder: PathBuf,
    },
}

impl Cli {
    /// Returns the log filter for runs without `AZEL_LOG`: warnings and errors. A simulator also
    /// logs its address and every frame.
    pub fn log_filter(&self) -> Targets {
        let warnings = Targets::new().with_default(LevelFilter::WARN);
        match self.command {
            Some(Command::Simulate { .. }) => warnings.with_target("azel::sim", LevelFilter::INFO),
            _ => warnings,
        }
    }

    /// Carries out the command line and returns the exit code.
    pub fn run(self) -> anyhow::Result<ExitCode> {
        if self.demo && self.command.is_some() {
            let text = "the argument '--demo' opens the window and cannot be used with a command";
            return reported(Err(Self::command().error(ErrorKind::ArgumentConflict, text).into()));
        }
        match self.command {
            None => window::run(self.station, self.demo)?,
            Some(Command::Passes(options)) => {
                return reported(passes::run(self.station.as_deref(), &options));
            }
            Some(Command::Check(options)) => {
                return check::run(self.station.as_deref(), &options);
            }
            Some(Command::Look(options)) => {
                return reported(look::run(self.station.as_deref(), &options));
            }
            Some(Command::Plan(options)) => {
                return reported(plan::run(self.station.as_deref(), &options));
            }
            Some(Command::Rehearse(options)) => {
                return reported(rehearse::run(self.station.as_deref(), &options));
            }
            Some(Command::Serve(options)) => {
                return serve::run(
                    self.station,
                    &options,
                    this_program(),
                    marks(),
                    LockFolders::of_user(),
                );
            }
            Some(Command::Log(options)) => return record::run(self.station, &options),
            Some(Command::Pointing(options)) => {
                return reported(pointing::run(self.station.as_deref(), &options));
            }
            #[cfg(unix)]
            Some(Command::Stop(options)) => return remote::stop(self.station, &options),
            #[cfg(unix)]
            Some(Command::Status(options)) => return remote::status(self.station, &options),
            #[cfg(unix)]
            Some(Command::Automatic(options)) => return remote::automatic(self.station, &options),
            #[cfg(unix)]
            Some(Command::LockOut(options)) => return remote::lock_out(self.station, &options),
            #[cfg(unix)]
            Some(Command::DeadMan { stop }) => {
                let bytes = from_hexadecimal(&stop).context("STOP is not in hexadecimal digits")?;
                dead_man::watch_over(&bytes)?;
            }
            Some(Command::Simulate { simulator }) => simulate::run(&simulator)?,
            Some(Command::Completions { shell }) => {
                let mut text = Vec::new();
                clap_complete::generate(shell, &mut Self::command(), "azel", &mut text);
                io::stdout().write_all(&text)?;
            }
            Some(Command::Man { folder }) => clap_mangen::generate_to(Self::command(), &folder)
                .with_context(|| format!("no man pages in {}", folder.display()))?,
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Reports an error in the command line that the parser did not see, in the style of the
/// parser.
fn reported(result: anyhow::Result<ExitCode>) -> anyhow::Result<ExitCode> {
    result.or_else(|error| {
        let error = error.downcast::<clap::Error>()?;
        error.print()?;
        Ok(ExitCode::from(error.exit_code() as u8))
    })
}

/// Returns the folder in the user's data folder for marks of manual motions.
fn marks() -> Option<PathBuf> {
    directories::ProjectDirs::from("", "", "azel").map(|dirs| dirs.data_dir().join("marks"))
}

/// Returns the path of this program. On Linux it stays valid after a newer file replaced the
/// program.
fn this_program() -> Option<PathBuf> {
    let running = PathBuf::from("/proc/self/exe");
    if running.exists() { Some(running) } else { std::env::current_exe().ok() }
}

#[cfg(unix)]
fn from_hexadecimal(digits: &str) -> Option<Vec<u8>> {
    let pairs = digits.as_bytes().chunks(2);
    let byte = |pair: &[u8]| match pair {
        // Accept only hexadecimal digits: the parser also accepts a sign.
        [first, _] if first.is_ascii_hexdigit() => {
            u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()
        }
        _ => None,
    };
    pairs.map(byte).collect()
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Cli::command().debug_assert();
    }

    #[cfg(unix)]
    #[test]
    fn only_pairs_of_hexadecimal_digits_are_bytes() {
        assert_eq!(from_hexadecimal("24aF0d"), Some(vec![0x24, 0xaf, 0x0d]));
        for bad in ["2", "+1", "-1", " 1", "0x", "2g", "\u{b5}"] {
            assert_eq!(from_hexadecimal(bad), None, "{bad}");
        }
    }
}
