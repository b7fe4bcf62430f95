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

/// Usual age beyond which elements count as out of date. The document names none.
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
    /// A folder on disk whose files the unit has too, read anew whenever the unit is told to
    /// use one, as a real unit does.
    pub element_folder: Option<PathBuf>,
    /// Age beyond which elements count as out of date.
    pub outdated_after: SignedDuration,
    /// Oddities of the firmware.
    pub quirks: BTreeSet<Quirk>,
    /// Failures.
    pub faults: BTreeSet<Fault>,
    /// Delay between a request and its reply, evenly spread.
    pub reply_delay: RangeInclusive<Duration>,
    /// Maximum number of clients; more are closed at once.
    pub max_clients: usize,
    /// Azimuth of the lower axis.
    pub lower_axis: Angle,
    /// Both ends of the travel of both axes, degrees as the unit counts.
    pub ends_deg: [f64; 2],
    /// Full rate of both axes, degrees a second.
    pub full_rate_deg_s: f64,
    /// Imperfections of both axes.
    pub mechanics: Mechanics,
    /// Lowest elevation that the unit is set to, degrees.
    pub minimum_elevation_deg: f64,
    /// Time from the start until GPS is locked.
    pub gps_lock_after: Duration,
    /// The clock starts in 2000 instead of showing the right time.
    pub clock_is_unset: bool,
    /// Seed of all randomness.
    pub seed: u64,
}

impl Options {
    /// A well-behaved unit at `site` that starts at `utc_origin`: one client, replies after 5
    /// to 30 ms, lower axis to the north, travel from 5 to 175 degrees at 5 degrees a second, GPS
    /// locked after 8 s, no elements, which count as out of date after 30 days.
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
    /// A unit that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        Self::on_clock(options, Clock::system())
    }

    /// Like [`Self::new`], running by `clock`.
    pub fn on_clock(options: &Options, clock: Clock) -> Self {
        let Options { quirks, faults, reply_delay, seed, .. } = options;
        let switches = Switches { quirks: quirks.clone(), faults: faults.clone() };
        Self::start(Satrak::new(options), switches, reply_delay.clone(), *seed, clock)
    }
}

impl Simulator {
    /// Starts a unit and listens; port 0 takes a free one. A real unit has 4001.
    pub async fn bind(address: SocketAddr, options: Options) -> io::Result<Self> {
        Self::listen(address, Control::new(&options), options.max_clients).await
    }
}
