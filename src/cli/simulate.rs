//! Serves one simulated controller.

use std::{net::SocketAddr, path::PathBuf};

use anyhow::Context as _;
use clap::Subcommand;
use jiff::Timestamp;

use crate::{
    driver, orbit,
    sim::{rc2000c, rotator_genius, satrak},
    station::{DEMO_ELEMENT_FILE, Station},
};

#[derive(Debug, Subcommand)]
pub(super) enum Controller {
    /// SVS Satrak on TCP, with an X/Y mount and on-board tracking
    Satrak {
        /// Where to listen
        #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:4001")]
        listen: SocketAddr,
        /// Folder of element files that the unit holds besides its own; read anew
        /// whenever it is told to use one
        #[arg(long, value_name = "FOLDER")]
        element_folder: Option<PathBuf>,
        /// Way in which the unit differs from its document; may be repeated
        #[arg(long = "quirk", value_name = "QUIRK")]
        quirks: Vec<satrak::Quirk>,
        /// Trouble to make; may be repeated
        #[arg(long = "fault", value_name = "FAULT")]
        faults: Vec<satrak::Fault>,
    },
    /// 4O3A Rotator Genius on TCP, with two rotators
    Genius {
        /// Where to listen
        #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:9006")]
        listen: SocketAddr,
        /// Let the second rotator turn the elevation; without it, it has no sensor
        #[arg(long)]
        elevation: bool,
        /// Way in which the device differs from recorded ones; may be repeated
        #[arg(long = "quirk", value_name = "QUIRK")]
        quirks: Vec<rotator_genius::Quirk>,
        /// Trouble to make; may be repeated
        #[arg(long = "fault", value_name = "FAULT")]
        faults: Vec<rotator_genius::Fault>,
    },
    /// Research Concepts RC2000C on raw TCP, as behind a serial server, or on a pseudo-terminal
    Rc2000 {
        /// Where to listen
        #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:4002")]
        listen: SocketAddr,
        /// Serve a pseudo-terminal instead, and print its path
        #[cfg(unix)]
        #[arg(long, conflicts_with = "listen")]
        pty: bool,
        /// Way in which the controller or its line differs from the plain case; may be repeated
        #[arg(long = "quirk", value_name = "QUIRK")]
        quirks: Vec<rc2000c::Quirk>,
        /// Trouble to make; may be repeated
        #[arg(long = "fault", value_name = "FAULT")]
        faults: Vec<rc2000c::Fault>,
    },
}

pub(super) fn run(controller: Controller) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        match controller {
            Controller::Satrak { listen, element_folder, quirks, faults } => {
                let options = satrak::Options {
                    element_folder,
                    quirks: quirks.into_iter().collect(),
                    faults: faults.into_iter().collect(),
                    ..demo_satrak()?
                };
                let simulator = satrak::Simulator::bind(listen, options)
                    .await
                    .with_context(|| taken(listen))?;
                announce("a simulated Satrak listens", simulator.local_addr()?);
                until_told(simulator.run()).await
            }
            Controller::Genius { listen, elevation, quirks, faults } => {
                let mut options = rotator_genius::Options {
                    quirks: quirks.into_iter().collect(),
                    faults: faults.into_iter().collect(),
                    ..rotator_genius::Options::default()
                };
                if elevation {
                    let [_, second] = &mut options.rotators;
                    *second = rotator_genius::RotatorOptions::elevation();
                }
                let simulator = rotator_genius::Simulator::bind(listen, options)
                    .await
                    .with_context(|| taken(listen))?;
                announce("a simulated Rotator Genius listens", simulator.local_addr()?);
                until_told(simulator.run()).await
            }
            Controller::Rc2000 {
                listen,
                #[cfg(unix)]
                pty,
                quirks,
                faults,
            } => {
                let options = rc2000c::Options {
                    quirks: quirks.into_iter().collect(),
                    faults: faults.into_iter().collect(),
                    ..rc2000c::Options::default()
                };
                #[cfg(unix)]
                if pty {
                    use std::io::Write as _;
                    let simulator = rc2000c::PtySimulator::open(&options)
                        .context("No pseudo-terminal can be opened")?;
                    writeln!(std::io::stdout(), "{}", simulator.path().display())?;
                    return until_told(simulator.run()).await;
                }
                let simulator = rc2000c::Simulator::bind(listen, &options)
                    .await
                    .with_context(|| taken(listen))?;
                announce("a simulated RC2000C listens", simulator.local_addr()?);
                until_told(simulator.run()).await
            }
        }
    })
}

/// At the demo station, with the bundled elements.
fn demo_satrak() -> anyhow::Result<satrak::Options> {
    let elements = orbit::bundled()?.iter().cloned().collect();
    Ok(satrak::Options {
        elements: [(DEMO_ELEMENT_FILE.to_owned(), elements)].into(),
        ..satrak::Options::new(Station::default().site, Timestamp::now())
    })
}

fn taken(listen: SocketAddr) -> String {
    format!("The simulator cannot listen on {listen}")
}

fn announce(what: &str, address: SocketAddr) {
    tracing::info!(%address, "{what}");
}

/// Serves until the user or the system asks for an end.
async fn until_told(serving: impl Future<Output = ()>) -> anyhow::Result<()> {
    tokio::select! {
        () = serving => Ok(()),
        told = driver::told_to_end() => Ok(told?),
    }
}
