//! Command line of the simulated Rotator Genius.

use std::net::SocketAddr;

use super::{Fault, Options, Quirk, RotatorOptions, Simulator};
use crate::sim::{
    Mechanics,
    command_line::{Command, Serving, Simulated, StartError, serving},
};

/// `azel simulate genius`.
pub const COMMAND: Command = Command::new::<Arguments>("genius");

/// 4O3A Rotator Genius on TCP, with two rotators
#[derive(Debug, clap::Args)]
struct Arguments {
    /// Where to listen
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:9006")]
    listen: SocketAddr,
    /// Let the second rotator turn the elevation; without it, it has no sensor
    #[arg(long)]
    elevation: bool,
    /// Way in which the device differs from recorded ones; may be repeated
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
        let mut options = Options {
            mechanics: self.mechanics,
            quirks: self.quirks.into_iter().collect(),
            faults: self.faults.into_iter().collect(),
            ..Options::default()
        };
        if self.elevation {
            let [_, second] = &mut options.rotators;
            *second = RotatorOptions::elevation();
        }
        let bound = Simulator::bind(self.listen, options).await;
        serving("Rotator Genius", self.listen, bound)
    }
}
