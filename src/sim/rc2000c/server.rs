//! The controller on a raw TCP port, as behind a serial server.

use std::collections::BTreeSet;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use tokio::net::TcpStream;

use super::{Control, Fault, Quirk, StoredSatellite};
use crate::protocol::rc2000c::Address;
use crate::sim::port::{Port, Unit};

/// How a simulated controller is made.
#[derive(Debug, Clone)]
pub struct Options {
    /// Its address on the bus.
    pub address: Address,
    /// Its list of satellites, up to 35.
    pub satellites: Vec<StoredSatellite>,
    /// Oddities of firmware and wiring.
    pub quirks: BTreeSet<Quirk>,
    /// What goes wrong.
    pub faults: BTreeSet<Fault>,
    /// From the end of a command to the beginning of its reply.
    pub latency: Duration,
    /// Speed of the line, which delays each reply by the characters of both.
    pub baud: u32,
    /// Further clients are closed at once.
    pub max_clients: usize,
}

impl Default for Options {
    /// A well-behaved controller at address 50 with six satellites: replies
    /// begin after 15 ms on a line of 9600 baud, one client.
    fn default() -> Self {
        Self {
            address: Address::FACTORY,
            satellites: StoredSatellite::demo(),
            quirks: BTreeSet::new(),
            faults: BTreeSet::new(),
            latency: Duration::from_millis(15),
            baud: 9600,
            max_clients: 1,
        }
    }
}

/// A controller that listens on a TCP port.
#[derive(Debug)]
pub struct Simulator(Port<Control>);

impl Simulator {
    /// Starts a controller and listens; port 0 takes a free one.
    pub async fn bind(address: SocketAddr, options: &Options) -> io::Result<Self> {
        Port::bind(address, Control::new(options), options.max_clients).await.map(Self)
    }

    /// Where it listens.
    pub fn local_addr(&self) -> io::Result<SocketAddr> {
        self.0.local_addr()
    }

    /// A handle to watch and disturb the controller.
    pub fn control(&self) -> Control {
        self.0.unit().clone()
    }

    /// Serves clients. Dropping the future ends the controller and its connections.
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
