//! How a simulated unit is made.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Duration;

use jiff::Timestamp;

use super::{Control, Fault, Quirk, Simulator, unit::Satrak};
use crate::orbit::Elements;
use crate::sim::harness::Switches;
use crate::{
    astro::{Angle, Site},
    clock::Clock,
};

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

impl Control {
    /// A unit that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        Self::on_clock(options, Clock::system())
    }

    /// The same, living by `clock`.
    pub fn on_clock(options: &Options, clock: Clock) -> Self {
        let Options { quirks, faults, reply_delay, seed, .. } = options;
        let switches = Switches { quirks: quirks.clone(), faults: faults.clone() };
        Self::start(Satrak::new(options), switches, reply_delay.clone(), *seed, clock)
    }
}

impl Simulator {
    /// Starts a unit and listens; port 0 takes a free one, a real unit has 4001.
    pub async fn bind(address: SocketAddr, options: Options) -> io::Result<Self> {
        Self::listen(address, Control::new(&options), options.max_clients).await
    }
}
