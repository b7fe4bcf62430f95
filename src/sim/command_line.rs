//! How simulators are started from the command line: each has its own arguments,
//! and the program puts them together.

use std::{fmt, future::Future, io, net::SocketAddr, pin::Pin};

use clap::{ArgMatches, Args};

use super::harness::{Simulator, Unit};
use crate::orbit::BundledError;

/// A simulator as a command: its name, its arguments and its start.
pub struct Command {
    name: &'static str,
    arguments: fn(clap::Command) -> clap::Command,
    start: fn(&ArgMatches) -> Result<Starting, clap::Error>,
}

/// A simulator that is being started. Await it inside a tokio runtime with I/O.
pub type Starting = Pin<Box<dyn Future<Output = Result<Serving, StartError>>>>;

/// The work of a simulator: dropping it ends the simulator.
pub type Serving = Pin<Box<dyn Future<Output = ()> + Send>>;

/// Why a simulator did not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// Nothing can listen there.
    #[error("The simulator cannot listen on {address}")]
    Listen {
        /// Where.
        address: SocketAddr,
        /// Why.
        source: io::Error,
    },
    /// The system gives no pseudo-terminal.
    #[error("No pseudo-terminal can be opened")]
    Terminal(#[source] io::Error),
    /// Where it answers cannot be told.
    #[error(transparent)]
    Address(#[from] io::Error),
    /// The elements that it is to hold cannot be read.
    #[error(transparent)]
    Elements(#[from] BundledError),
}

/// What a simulator is told on the command line. What the type says of itself is
/// the help of the command.
pub(super) trait Simulated: Args + 'static {
    /// Starts it and tells where it answers.
    fn start(self) -> impl Future<Output = Result<Serving, StartError>> + 'static;
}

impl Command {
    pub(super) const fn of<S: Simulated>(name: &'static str) -> Self {
        Self {
            name,
            arguments: S::augment_args,
            start: |matches| Ok(Box::pin(S::from_arg_matches(matches)?.start())),
        }
    }

    /// Its name on the command line.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Its part of the command line.
    pub fn arguments(&self) -> clap::Command {
        (self.arguments)(clap::Command::new(self.name))
    }

    /// Starts the simulator as the command line says.
    pub fn start(&self, matches: &ArgMatches) -> Result<Starting, clap::Error> {
        (self.start)(matches)
    }
}

impl fmt::Debug for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Command").field(&self.name).finish()
    }
}

/// What a simulator that listens at `address` does from now on.
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
