//! How a simulated controller is made.

use std::collections::BTreeSet;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use super::{Control, Fault, Quirk, Simulator, StoredSatellite, unit::Rc2000c};
use crate::sim::harness::Switches;
use crate::{clock::Clock, protocol::rc2000c::Address};

/// Nothing of it is random.
const SEED: u64 = 1;

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

impl Control {
    /// A controller that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        Self::on_clock(options, Clock::system())
    }

    /// The same, living by `clock`.
    pub fn on_clock(options: &Options, clock: Clock) -> Self {
        let Options { quirks, faults, latency, .. } = options;
        let switches = Switches { quirks: quirks.clone(), faults: faults.clone() };
        Self::start(Rc2000c::new(options), switches, *latency..=*latency, SEED, clock)
    }

    /// The local operator presses MODE: the line commands no more, and what it
    /// asked for ends. The next command takes the panel again.
    pub fn use_panel(&self) {
        self.with_unit(Rc2000c::use_panel);
    }
}

impl Simulator {
    /// Starts a controller and listens; port 0 takes a free one.
    pub async fn bind(address: SocketAddr, options: &Options) -> io::Result<Self> {
        Self::listen(address, Control::new(options), options.max_clients).await
    }
}
