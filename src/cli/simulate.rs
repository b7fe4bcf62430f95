//! Command that runs a simulated unit.

use clap::{ArgMatches, FromArgMatches, Subcommand, error::ErrorKind};

use crate::{driver, makes, sim};

/// A simulator of the list of makes, with its arguments.
#[derive(Debug)]
pub(super) struct Simulator {
    command: &'static sim::Command,
    arguments: ArgMatches,
}

impl Subcommand for Simulator {
    fn augment_subcommands(command: clap::Command) -> clap::Command {
        command.subcommands(makes::SIMULATORS.iter().map(sim::Command::arguments))
    }

    fn augment_subcommands_for_update(command: clap::Command) -> clap::Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        named(name).is_some()
    }
}

impl FromArgMatches for Simulator {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let missing = || clap::Error::new(ErrorKind::MissingSubcommand);
        let (name, arguments) = matches.subcommand().ok_or_else(missing)?;
        let command = named(name).ok_or_else(|| clap::Error::new(ErrorKind::InvalidSubcommand))?;
        Ok(Self { command, arguments: arguments.clone() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn named(name: &str) -> Option<&'static sim::Command> {
    makes::SIMULATORS.iter().find(|command| command.name() == name)
}

/// Serves until the user or the system ends it.
pub(super) fn run(simulator: &Simulator) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let serving = simulator.command.start(&simulator.arguments)?.await?;
        tokio::select! {
            () = serving => Ok(()),
            result = driver::told_to_end() => Ok(result?),
        }
    })
}
