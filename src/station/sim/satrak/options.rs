//! Options of a simulated Satrak.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Duration;

use jiff::{SignedDuration, Timestamp};

use super::{Control, Fault, Quirk, Simulator, unit::Satrak};
use crate::orbit::Elements;
use crate::sim::{Mechanics, harness::Switches};
use crate::{
    astro::{Angle, Site},
    clock::Clock,
};

/// Default max age of current elements. The document names none.
const OUTDATED_AFTER: SignedDuration = SignedDuration::from_hours(30 * 24);

/// Options of a simulated unit.
#[derive(Debug, Clone)]
pub struct Options {
    /// Site of the antenna.
    pub site: Site,
    /// UTC at the start of the unit.
    pub utc_origin: Timestamp,
    /// Element files in the unit, by name.
    pub elements: BTreeMap<String, Vec<Elements>>,
    /// Folder on disk with more element files. The unit reads it again for each command to use a
    /// file, like a real unit.
    pub element_folder: Option<PathBuf>,
    /// Max age of current elements.
    pub outdated_after: SignedDuration,
    /// Oddities of the firmware.
    pub quirks: BTreeSet<Quirk>,
    /// Failures of the unit and its line.
    pub faults: BTreeSet<Fault>,
    /// Delay between a request and its reply, evenly distributed.
    pub reply_delay: RangeInclusive<Duration>,
    /// Max number of clients; the unit closes further connections at once.
    pub max_clients: usize,
    /// Azimuth of the lower axis.
    pub lower_axis: Angle,
    /// Both ends of the travel of each axis, degrees in the unit's count.
    pub ends_deg: [f64; 2],
    /// Full rate of both axes, degrees per second.
    pub full_rate_deg_s: f64,
    /// Imperfections of both axes.
    pub mechanics: Mechanics,
    /// Min elevation in the unit's settings, degrees.
    pub minimum_elevation_deg: f64,
    /// Time from the start until GPS is locked.
    pub gps_lock_after: Duration,
    /// `true` if the clock starts in the year 2000 instead of at the right time.
    pub clock_is_unset: bool,
    /// Seed of all randomness.
    pub seed: u64,
}

impl Options {
    /// Returns options of a unit without faults at `site` that starts at `utc_origin`: one client,
    /// replies after 5 to 30 ms, lower axis to the north. The travel is 5 to 175 degrees at 5
    /// degrees per second. GPS locks after 8 s. There are no elements; elements become out of date
    /// after 30 days.
    pub fn new(site: Site, utc_origin: Timestamp) -> Self {
        Self {
            site,
            utc_origin,
            elements: BTreeMap::new(),
            element_folder: None,
            outdated_after: OUTDATED_AFTER,
            quirks: BTreeSet::new(),
            faults: BTreeSet::new(),
            reply_delay: Duration::from_millis(5)..=Duration::from_millis(30),
            max_clients: 1,
            lower_axis: Angle::ZERO,
            ends_deg: [5.0, 175.0],
            full_rate_deg_s: 5.0,
            mechanics: Mechanics::default(),
            minimum_elevation_deg: 3.0,
            gps_lock_after: Duration::from_secs(8),
            clock_is_unset: false,
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
        let Options { quirks, faults, reply_delay, seed, .. } = options;
        let switches = Switches { quirks: quirks.clone(), faults: faults.clone() };
        Self::start(Satrak::new(options), switches, reply_delay.clone(), *seed, clock)
    }
}

impl Simulator {
    /// Starts a unit and listens; port 0 selects a free port. A real unit uses 4001.
    pub async fn bind(address: SocketAddr, options: Options) -> io::Result<Self> {
        Self::listen(address, Control::new(&options), options.max_clients).await
    }
}
