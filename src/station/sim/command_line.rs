//! Simulators as commands: each make brings its arguments and start, and the program
//! collects them.

use std::{fmt, future::Future, io, net::SocketAddr, pin::Pin};

use clap::{ArgMatches, Args};

use super::harness::{Simulator, Unit};
use crate::orbit::BundledError;

/// A simulator as a command: name, arguments and start.
pub struct Command {
    name: &'static str,
    arguments: fn(clap::Command) -> clap::Command,
    start: fn(&ArgMatches) -> Result<Starting, clap::Error>,
}

/// Start of a simulator. Await it inside a tokio runtime with I/O.
pub type Starting = Pin<Box<dyn Future<Output = Result<Serving, StartError>>>>;

/// The work of a simulator: dropping it ends the simulator.
pub type Serving = Pin<Box<dyn Future<Output = ()> + Send>>;

/// Reason why a simulator did not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    #[error("The simulator cannot listen on {address}")]
    Listen {
        /// Address to listen at.
        address: SocketAddr,
        source: io::Error,
    },
    /// The system gives no pseudo-terminal.
    #[error("No pseudo-terminal can be opened")]
    Terminal(#[source] io::Error),
    /// The address of the simulator is unknown.
    #[error(transparent)]
    Address(#[from] io::Error),
    /// The bundled elements cannot be read.
    #[error(transparent)]
    Elements(#[from] BundledError),
}

/// Arguments of a simulator. The doc comment of the type is the help of the command.
pub(super) trait Simulated: Args + 'static {
    /// Starts the simulator and prints where it answers.
    fn start(self) -> impl Future<Output = Result<Serving, StartError>> + 'static;
}

impl Command {
    pub(super) const fn new<S: Simulated>(name: &'static str) -> Self {
        Self {
            name,
            arguments: S::augment_args,
            start: |matches| Ok(Box::pin(S::from_arg_matches(matches)?.start())),
        }
    }

    /// Name on the command line.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Subcommand with its arguments.
    pub fn arguments(&self) -> clap::Command {
        (self.arguments)(clap::Command::new(self.name))
    }

    /// Starts the simulator with the arguments in `matches`.
    pub fn start(&self, matches: &ArgMatches) -> Result<Starting, clap::Error> {
        (self.start)(matches)
    }
}

impl fmt::Debug for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Command").field(&self.name).finish()
    }
}

/// Work of a simulator that listens at `address`.
pub(super) fn serving<U: Unit>(
    name: &str,
    address: SocketAddr,
    bound: io::Result<Simulator<U>>,
) -> Result<Serving, StartError> {
    let simulator = bound.map_err(|source| StartError::Listen { address, source })?;
    let address = simulator.local_addr()?;
    tracing::info!(target: "azel::sim", %address, "a simulated {name} listens");
    Ok(Box::pin(simulator.run()))
}
