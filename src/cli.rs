//! The command line.

pub mod log;
mod passes;
mod simulate;
mod window;

use std::{path::PathBuf, process::ExitCode};

use clap::{Parser, Subcommand};

/// Console for the operator of a satellite ground station.
///
/// Without a command the window opens: on your station, or on a simulated
/// demo station while there are no settings yet.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100)]
pub struct Cli {
    /// Station file to use instead of the user's own
    #[arg(long, value_name = "FILE")]
    station: Option<PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Predict passes from element files
    Passes(passes::Options),
    /// Serve a simulated controller to anyone who connects
    Simulate {
        #[command(subcommand)]
        simulator: simulate::Simulator,
    },
}

impl Cli {
    /// What the log holds unless `AZEL_LOG` says otherwise: warnings and errors;
    /// a simulator also tells its address and every frame.
    pub fn log_filter(&self) -> &'static str {
        match self.command {
            Some(Command::Simulate { .. }) => "warn,azel::sim=info",
            _ => "warn",
        }
    }

    /// Does what the command line says, and how well, as an exit code.
    pub fn run(self) -> anyhow::Result<ExitCode> {
        match self.command {
            None => window::run(self.station)?,
            Some(Command::Passes(options)) => return passes::run(&options),
            Some(Command::Simulate { simulator }) => simulate::run(&simulator)?,
        }
        Ok(ExitCode::SUCCESS)
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Cli::command().debug_assert();
    }
}
