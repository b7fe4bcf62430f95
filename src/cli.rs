//! The command line.

mod simulate;
mod window;

use std::path::PathBuf;

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
    /// Serve a simulated controller to anyone who connects
    Simulate {
        #[command(subcommand)]
        controller: simulate::Controller,
    },
}

impl Cli {
    /// Does what the command line says.
    pub fn run(self) -> anyhow::Result<()> {
        match self.command {
            None => window::run(self.station),
            Some(Command::Simulate { controller }) => simulate::run(controller),
        }
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
