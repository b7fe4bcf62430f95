//! Serves one simulated controller.

use std::net::SocketAddr;

use anyhow::Context as _;
use clap::Subcommand;
use jiff::Timestamp;

use crate::{
    driver, orbit,
    sim::satrak::{Fault, Options, Quirk, Simulator},
    station::{DEMO_ELEMENT_FILE, Station},
};

#[derive(Debug, Subcommand)]
pub(super) enum Controller {
    /// SVS Satrak on TCP, with an X/Y mount and on-board tracking
    Satrak {
        /// Where to listen
        #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:4001")]
        listen: SocketAddr,
        /// Way in which the unit differs from its document; may be repeated
        #[arg(long = "quirk", value_name = "QUIRK")]
        quirks: Vec<Quirk>,
        /// Trouble to make; may be repeated
        #[arg(long = "fault", value_name = "FAULT")]
        faults: Vec<Fault>,
    },
}

pub(super) fn run(controller: Controller) -> anyhow::Result<()> {
    let Controller::Satrak { listen, quirks, faults } = controller;
    let station = Station::default();
    let catalog = orbit::bundled()?;
    let elements = catalog.iter().cloned().collect();
    let options = Options {
        elements: [(DEMO_ELEMENT_FILE.to_owned(), elements)].into(),
        quirks: quirks.into_iter().collect(),
        faults: faults.into_iter().collect(),
        ..Options::new(station.site, Timestamp::now())
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let simulator = Simulator::bind(listen, options)
            .await
            .with_context(|| format!("The simulator cannot listen on {listen}"))?;
        let address = simulator.local_addr()?;
        tracing::info!(%address, "a simulated Satrak listens");
        tokio::select! {
            () = simulator.run() => Ok(()),
            told = driver::told_to_end() => Ok(told?),
        }
    })
}
