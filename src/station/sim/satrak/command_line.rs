//! Command line of the simulated Satrak.

use std::{net::SocketAddr, path::PathBuf};

use jiff::Timestamp;

use super::{BUNDLED_FILE, Fault, Options, Quirk, Simulator};
use crate::{
    astro::Site,
    orbit,
    sim::{
        Mechanics,
        command_line::{Command, Serving, Simulated, StartError, serving},
    },
};

/// `azel simulate satrak`.
pub const COMMAND: Command = Command::new::<Arguments>("satrak");

/// SVS Satrak on TCP, with an X/Y mount and on-board tracking; its element file is active.txt
#[derive(Debug, clap::Args)]
struct Arguments {
    /// Where to listen
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:4001")]
    listen: SocketAddr,
    /// Folder of element files that the unit holds besides its own; read anew
    /// whenever it is told to use one
    #[arg(long, value_name = "FOLDER")]
    element_folder: Option<PathBuf>,
    /// Way in which the unit differs from its document; may be repeated
    #[arg(long = "quirk", value_name = "QUIRK")]
    quirks: Vec<Quirk>,
    /// Trouble to make; may be repeated
    #[arg(long = "fault", value_name = "FAULT")]
    faults: Vec<Fault>,
    #[command(flatten)]
    mechanics: Mechanics,
}

/// Starts at the usual site, with the bundled elements.
impl Simulated for Arguments {
    async fn start(self) -> Result<Serving, StartError> {
        let elements = orbit::bundled()?.iter().cloned().collect();
        let options = Options {
            elements: [(BUNDLED_FILE.to_owned(), elements)].into(),
            element_folder: self.element_folder,
            mechanics: self.mechanics,
            quirks: self.quirks.into_iter().collect(),
            faults: self.faults.into_iter().collect(),
            ..Options::new(Site::default(), Timestamp::now())
        };
        let bound = Simulator::bind(self.listen, options).await;
        serving("Satrak", self.listen, bound)
    }
}
