//! Simulated antennas of the demo station. The simulators run in this process, behind real sockets
//! on the loopback and a pseudo-terminal; the rest of the program treats them as units.

use std::{
    collections::BTreeMap,
    io,
    net::{IpAddr, Ipv4Addr, SocketAddr},
    sync::mpsc,
    thread,
};

use jiff::{SignedDuration, Timestamp};

use crate::{
    makes::DemoAddresses,
    orbit::Elements,
    protocol::rotator_genius::WholeDegrees,
    sim::{Serving, rc2000c, rotator_genius, satrak},
    station::Station,
};

/// Any free port, reachable from this machine only.
const LOOPBACK: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

/// Running simulators. Dropping `Demo` ends them.
pub(super) struct Demo {
    pub(super) addresses: DemoAddresses,
    _end: tokio::sync::oneshot::Sender<()>,
}

impl Demo {
    /// Starts the simulators of `station`, whose Satrak holds `elements`.
    pub(super) fn start(station: &Station, elements: Vec<Elements>) -> io::Result<Self> {
        let satrak = satrak::Options {
            elements: BTreeMap::from([(satrak::BUNDLED_FILE.to_owned(), elements)]),
            // The bundled elements are as old as the program; the window says so.
            outdated_after: SignedDuration::MAX,
            ..satrak::Options::new(station.site, Timestamp::now())
        };
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let (end, ended) = tokio::sync::oneshot::channel::<()>();
        let (tell, receiver) = mpsc::sync_channel(1);
        thread::Builder::new().name("azel-simulators".to_owned()).spawn(move || {
            runtime.block_on(async {
                let (addresses, serving) = match serve(satrak).await {
                    Ok(served) => served,
                    Err(error) => return drop(tell.send(Err(error))),
                };
                // The caller may no longer wait for the addresses.
                drop(tell.send(Ok(addresses)));
                tokio::select! {
                    () = serving => {}
                    _ = ended => {}
                }
            });
        })?;
        let broken = |_| io::Error::other("the simulators broke down");
        let addresses = receiver.recv().map_err(broken)??;
        Ok(Self { addresses, _end: end })
    }
}

/// Returns the simulators' addresses, and the future that serves them.
async fn serve(satrak: satrak::Options) -> io::Result<(DemoAddresses, Serving)> {
    let satrak = satrak::Simulator::bind(LOOPBACK, satrak).await?;
    let genius = rotator_genius::Simulator::bind(LOOPBACK, genius()).await?;
    let (rc2000c, rc2000c_address) = rc2000c().await?;
    let addresses = DemoAddresses {
        satrak: satrak.local_addr()?.to_string(),
        genius: genius.local_addr()?.to_string(),
        rc2000c: rc2000c_address,
    };
    let serving = async {
        tokio::select! {
            () = satrak.run() => {}
            () = genius.run() => {}
            () = rc2000c => {}
        }
    };
    Ok((addresses, Box::pin(serving)))
}

/// Returns options with azimuth all around and elevation to the zenith.
fn genius() -> rotator_genius::Options {
    let azimuth = rotator_genius::RotatorOptions {
        limit_cw: WholeDegrees::MAX,
        ..rotator_genius::RotatorOptions::default()
    };
    rotator_genius::Options {
        rotators: [azimuth, rotator_genius::RotatorOptions::elevation()],
        ..rotator_genius::Options::default()
    }
}

/// Creates the simulated RC2000C on a pseudo-terminal, or behind a TCP port like a serial server
/// where the system has none. Returns the future that serves it, and its address.
async fn rc2000c() -> io::Result<(Serving, String)> {
    let options = rc2000c::Options::default();
    #[cfg(unix)]
    match rc2000c::PtySimulator::open(&options) {
        Ok(simulator) => {
            let path = simulator.path().display().to_string();
            return Ok((Box::pin(simulator.run()), path));
        }
        Err(error) => tracing::warn!(%error, "no pseudo-terminal for the simulated RC2000C"),
    }
    let simulator = rc2000c::Simulator::bind(LOOPBACK, &options).await?;
    let address = simulator.local_addr()?.to_string();
    Ok((Box::pin(simulator.run()), address))
}
