//! Command line of the simulated RC2000C.

use std::net::SocketAddr;

use super::{Fault, Options, Quirk, Simulator};
use crate::sim::{
    Mechanics,
    command_line::{Command, Serving, Simulated, StartError, serving},
};

/// `azel simulate rc2000`.
pub const COMMAND: Command = Command::new::<Arguments>("rc2000");

/// Research Concepts RC2000C on raw TCP, as behind a serial server, or on a pseudo-terminal
#[derive(Debug, clap::Args)]
struct Arguments {
    /// Where to listen
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:4002")]
    listen: SocketAddr,
    /// Serve a pseudo-terminal instead, and print its path
    #[cfg(unix)]
    #[arg(long, conflicts_with = "listen")]
    pty: bool,
    /// Way in which the controller or its line differs from the plain case; may be repeated
    #[arg(long = "quirk", value_name = "QUIRK")]
    quirks: Vec<Quirk>,
    /// Trouble to make; may be repeated
    #[arg(long = "fault", value_name = "FAULT")]
    faults: Vec<Fault>,
    #[command(flatten)]
    mechanics: Mechanics,
}

impl Simulated for Arguments {
    async fn start(self) -> Result<Serving, StartError> {
        let options = Options {
            mechanics: self.mechanics,
            quirks: self.quirks.into_iter().collect(),
            faults: self.faults.into_iter().collect(),
            ..Options::default()
        };
        #[cfg(unix)]
        if self.pty {
            use std::io::Write as _;
            let simulator = super::PtySimulator::open(&options).map_err(StartError::Terminal)?;
            writeln!(std::io::stdout(), "{}", simulator.path().display())?;
            return Ok(Box::pin(simulator.run()));
        }
        let bound = Simulator::bind(self.listen, &options).await;
        serving("RC2000C", self.listen, bound)
    }
}
