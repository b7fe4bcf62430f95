//! The unit on a TCP port.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Duration;

use jiff::Timestamp;
use tokio::net::TcpStream;

use super::{Control, Fault, Quirk};
use crate::astro::{Angle, Site};
use crate::orbit::Elements;
use crate::sim::port::{Port, Unit};

/// How a simulated unit is made.
#[derive(Debug, Clone)]
pub struct Options {
    /// Where the antenna stands.
    pub site: Site,
    /// UTC at the start of the unit.
    pub utc_origin: Timestamp,
    /// Files with elements in the unit, by name.
    pub elements: BTreeMap<String, Vec<Elements>>,
    /// A folder on disk whose files the unit holds besides, read anew whenever it
    /// is told to use one, as a real unit does.
    pub element_folder: Option<PathBuf>,
    /// Oddities of the firmware.
    pub quirks: BTreeSet<Quirk>,
    /// What goes wrong.
    pub faults: BTreeSet<Fault>,
    /// Between a request and its reply, evenly spread.
    pub reply_delay: RangeInclusive<Duration>,
    /// Further clients are closed at once.
    pub max_clients: usize,
    /// Azimuth of the lower axis.
    pub lower_axis: Angle,
    /// Until GPS is locked, counted from the start.
    pub gps_lock_after: Duration,
    /// The clock starts in 2000 instead of being right.
    pub clock_is_unset: bool,
    /// Seed of all randomness.
    pub seed: u64,
}

impl Options {
    /// A well-behaved unit at `site` that starts at `utc_origin`: one client,
    /// replies after 5 to 30 ms, lower axis to the north, GPS locked after 8 s,
    /// no elements.
    pub fn new(site: Site, utc_origin: Timestamp) -> Self {
        Self {
            site,
            utc_origin,
            elements: BTreeMap::new(),
            element_folder: None,
            quirks: BTreeSet::new(),
            faults: BTreeSet::new(),
            reply_delay: Duration::from_millis(5)..=Duration::from_millis(30),
            max_clients: 1,
            lower_axis: Angle::ZERO,
            gps_lock_after: Duration::from_secs(8),
            clock_is_unset: false,
            seed: 1,
        }
    }
}

/// A unit that listens on a TCP port.
#[derive(Debug)]
pub struct Simulator(Port<Control>);

impl Simulator {
    /// Starts a unit and listens; port 0 takes a free one, a real unit has 4001.
    pub async fn bind(address: SocketAddr, options: Options) -> io::Result<Self> {
        let max_clients = options.max_clients;
        Port::bind(address, Control::new(&options), max_clients).await.map(Self)
    }

    /// Where it listens.
    pub fn local_addr(&self) -> io::Result<SocketAddr> {
        self.0.local_addr()
    }

    /// A handle to watch and disturb the unit.
    pub fn control(&self) -> Control {
        self.0.unit().clone()
    }

    /// Serves clients. Dropping the future ends the unit and its connections.
    pub async fn run(self) {
        self.0.run().await;
    }
}

impl Unit for Control {
    fn live_on(&self) {
        self.live();
    }

    async fn serve_client(&self, stream: TcpStream) -> io::Result<()> {
        self.serve(stream).await
    }
}

#[cfg(test)]
mod tests {
    use tokio::io::{AsyncReadExt, AsyncWriteExt};

    use super::*;

    /// A status reply, or `None` when the connection is closed instead.
    async fn status(stream: &mut TcpStream) -> Option<String> {
        stream.write_all(b"$STATUS?*2B\r\n").await.ok()?;
        let mut buffer = [0; 256];
        let count = stream.read(&mut buffer).await.ok()?;
        (count > 0).then(|| String::from_utf8_lossy(&buffer[..count]).into_owned())
    }

    #[tokio::test]
    async fn one_client_is_served_on_a_socket_and_a_second_is_closed() {
        let site = Site::new(41.01, 29.17, 100.0).unwrap();
        let options = Options {
            reply_delay: Duration::ZERO..=Duration::ZERO,
            ..Options::new(site, Timestamp::UNIX_EPOCH)
        };
        let simulator = Simulator::bind(([127, 0, 0, 1], 0).into(), options).await.unwrap();
        let address = simulator.local_addr().unwrap();
        let server = tokio::spawn(simulator.run());

        let mut first = TcpStream::connect(address).await.unwrap();
        assert!(status(&mut first).await.unwrap().starts_with("$STATUS?,0,"));
        let mut second = TcpStream::connect(address).await.unwrap();
        assert_eq!(status(&mut second).await, None);
        assert!(status(&mut first).await.is_some());

        drop(first);
        let served_again = async {
            while status(&mut TcpStream::connect(address).await.unwrap()).await.is_none() {
                tokio::task::yield_now().await;
            }
        };
        tokio::time::timeout(Duration::from_secs(10), served_again).await.unwrap();

        server.abort();
        assert!(server.await.unwrap_err().is_cancelled());
        assert!(TcpStream::connect(address).await.is_err());
    }
}
