//! The demo station's antennas: simulators in this process, behind real
//! sockets on the loopback. The rest of the program does not know.

use std::{collections::BTreeMap, io, net::SocketAddr, thread};

use jiff::Timestamp;

use crate::{
    orbit::Elements,
    sim::satrak::{Options, Simulator},
    station::{DEMO_ELEMENT_FILE, Station},
};

/// Running simulators. Dropping it ends them.
pub(super) struct Demo {
    /// Where the Satrak listens.
    pub(super) satrak: SocketAddr,
    _end: tokio::sync::oneshot::Sender<()>,
}

impl Demo {
    /// Starts the simulators of `station`, whose unit holds `elements`.
    pub(super) fn start(station: &Station, elements: Vec<Elements>) -> io::Result<Self> {
        let options = Options {
            elements: BTreeMap::from([(DEMO_ELEMENT_FILE.to_owned(), elements)]),
            ..Options::new(station.site, Timestamp::now())
        };
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let listen = SocketAddr::from(([127, 0, 0, 1], 0));
        let simulator = runtime.block_on(Simulator::bind(listen, options))?;
        let satrak = simulator.local_addr()?;
        let (end, ended) = tokio::sync::oneshot::channel::<()>();
        thread::Builder::new().name("azel-simulator".to_owned()).spawn(move || {
            runtime.block_on(async {
                tokio::select! {
                    () = simulator.run() => {}
                    _ = ended => {}
                }
            });
        })?;
        Ok(Self { satrak, _end: end })
    }
}
