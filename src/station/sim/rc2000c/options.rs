//! Options of a simulated RC2000C.

use std::collections::BTreeSet;
use std::io;
use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::time::Duration;

use super::{Control, Fault, Quirk, Simulator, StoredSatellite, unit::Rc2000c};
use crate::sim::{Mechanics, harness::Switches};
use crate::{clock::Clock, protocol::rc2000c::Address};

/// Options of a simulated unit.
#[derive(Debug, Clone)]
pub struct Options {
    /// Address on the bus.
    pub address: Address,
    /// Stored satellites, up to 35.
    pub satellites: Vec<StoredSatellite>,
    pub azimuth: AxisOptions,
    pub elevation: AxisOptions,
    /// Imperfections of both axes.
    pub mechanics: Mechanics,
    /// Oddities of firmware and wiring.
    pub quirks: BTreeSet<Quirk>,
    /// Failures of the unit and its line.
    pub faults: BTreeSet<Fault>,
    /// Time from the end of a command to the start of its reply.
    pub latency: Duration,
    /// Speed of the line, baud. The characters of command and reply delay the reply.
    pub baud: u32,
    /// Max number of clients; the unit closes further connections at once.
    pub max_clients: usize,
    /// Seed of all randomness.
    pub seed: u64,
}

/// Options of an axis, in counts of its sensor.
#[derive(Debug, Clone)]
pub struct AxisOptions {
    pub travel: RangeInclusive<u16>,
    /// Full rate, counts per second.
    pub full_rate_counts_s: f64,
    pub counts_per_deg: f64,
}

impl AxisOptions {
    /// Azimuth of half a turn between its limits; 20 counts are one degree.
    pub const AZIMUTH: Self =
        Self { travel: 30..=3630, full_rate_counts_s: 40.0, counts_per_deg: 20.0 };
    /// Elevation from the horizon to the zenith.
    pub const ELEVATION: Self =
        Self { travel: 30..=1830, full_rate_counts_s: 40.0, counts_per_deg: 20.0 };
}

impl Default for Options {
    /// Returns a unit without faults at address 50, with six satellites and one client. Its axes
    /// turn half a turn and a quarter turn at 2 degrees per second. Replies begin after 15 ms, at
    /// 9600 baud.
    fn default() -> Self {
        Self {
            address: Address::FACTORY,
            satellites: StoredSatellite::demo(),
            azimuth: AxisOptions::AZIMUTH,
            elevation: AxisOptions::ELEVATION,
            mechanics: Mechanics::default(),
            quirks: BTreeSet::new(),
            faults: BTreeSet::new(),
            latency: Duration::from_millis(15),
            baud: 9600,
            max_clients: 1,
            seed: 1,
        }
    }
}

impl Control {
    /// Creates a unit that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        Self::on_clock(options, Clock::system())
    }

    /// Creates a unit like [`Self::new`] that runs by `clock`.
    pub fn on_clock(options: &Options, clock: Clock) -> Self {
        let Options { quirks, faults, latency, seed, .. } = options;
        let switches = Switches { quirks: quirks.clone(), faults: faults.clone() };
        Self::start(Rc2000c::new(options), switches, *latency..=*latency, *seed, clock)
    }

    /// Presses MODE for the local operator: the line loses the panel, and its motion ends. The next
    /// command takes the panel again.
    pub fn use_panel(&self) {
        self.with_unit(Rc2000c::use_panel);
    }
}

impl Simulator {
    /// Starts a unit and listens; port 0 selects a free port.
    pub async fn bind(address: SocketAddr, options: &Options) -> io::Result<Self> {
        Self::listen(address, Control::new(options), options.max_clients).await
    }
}
