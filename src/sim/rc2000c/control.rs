//! One running controller, shared by its connections, and the hand that
//! disturbs it.

use std::collections::{BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::Instant;

use super::unit::Unit;
use super::{Fault, Options, Quirk};
use crate::protocol::rc2000c::{Address, Frame, Reply};

/// How many received commands are remembered.
const REMEMBERED_FRAMES: usize = 10_000;

/// Who commands the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// The local operator at the panel.
    Manual,
    /// The line.
    Remote,
    /// The controller itself, following a satellite.
    Track,
}

/// What the controller does, for tests and displays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Snapshot {
    /// Azimuth in counts, 30 to 3630.
    pub az_counts: u16,
    /// Elevation in counts, 30 to 1830.
    pub el_counts: u16,
    /// Polarization in the feed's units.
    pub polarization_units: u16,
    /// Who commands it.
    pub mode: Mode,
    /// Anything turns, told or untold.
    pub is_turning: bool,
}

/// Handle of a simulated controller; clones control the same one.
#[derive(Debug, Clone)]
pub struct Control {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    started: Instant,
    address: Address,
    latency: Duration,
    baud: u32,
    inner: Mutex<Inner>,
    /// Counts how often all clients were dropped.
    drops: watch::Sender<u64>,
}

#[derive(Debug)]
struct Inner {
    unit: Unit,
    received: VecDeque<(Instant, Frame)>,
}

/// What misbehaves at present.
#[derive(Debug, Clone)]
pub(super) struct Mood {
    pub(super) quirks: BTreeSet<Quirk>,
    pub(super) faults: BTreeSet<Fault>,
}

impl Control {
    /// A controller that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        let inner = Inner { unit: Unit::new(options), received: VecDeque::new() };
        let shared = Shared {
            started: Instant::now(),
            address: options.address,
            latency: options.latency,
            baud: options.baud.max(1),
            inner: Mutex::new(inner),
            drops: watch::Sender::new(0),
        };
        Self { shared: Arc::new(shared) }
    }

    /// Switches a quirk on or off.
    pub fn set_quirk(&self, quirk: Quirk, is_on: bool) {
        self.live();
        let unit = &mut self.lock().unit;
        if is_on {
            unit.quirks.insert(quirk);
        } else {
            unit.quirks.remove(&quirk);
        }
        unit.suffer();
    }

    /// Switches a fault on or off.
    pub fn set_fault(&self, fault: Fault, is_on: bool) {
        self.live();
        let unit = &mut self.lock().unit;
        if is_on {
            unit.faults.insert(fault);
        } else {
            unit.faults.remove(&fault);
        }
        unit.suffer();
    }

    /// The local operator presses MODE: the line commands no more, and what it
    /// asked for ends. The next command takes the panel again.
    pub fn use_panel(&self) {
        self.live();
        self.lock().unit.use_panel();
    }

    /// Puts both axes somewhere else, as if by hand, in counts; they stand there.
    pub fn place(&self, counts: [u16; 2]) {
        self.live();
        self.lock().unit.place(counts);
    }

    /// Closes every connection. The controller goes on with what it does.
    pub fn drop_clients(&self) {
        self.shared.drops.send_modify(|count| *count += 1);
    }

    /// The last 10 000 commands that came in whole, oldest first.
    pub fn received(&self) -> Vec<(Instant, Frame)> {
        self.lock().received.iter().cloned().collect()
    }

    /// Where the antenna is and what it does, now.
    pub fn state(&self) -> Snapshot {
        self.live();
        self.lock().unit.snapshot()
    }

    /// Lets the controller live until now.
    pub(super) fn live(&self) {
        let elapsed = self.shared.started.elapsed();
        self.lock().unit.advance(elapsed);
    }

    /// Carries a command out and gives the answer, if there is one.
    pub(super) fn answer(&self, frame: &Frame) -> Option<Reply> {
        self.live();
        let mut inner = self.lock();
        if inner.received.len() == REMEMBERED_FRAMES {
            inner.received.pop_front();
        }
        inner.received.push_back((Instant::now(), frame.clone()));
        inner.unit.answer(frame)
    }

    pub(super) fn address(&self) -> Address {
        self.shared.address
    }

    /// Between a command and its reply: latency, and the time that the
    /// characters take over the line, ten bits each.
    pub(super) fn reply_delay(&self, characters: usize) -> Duration {
        self.shared.latency + self.character_time() * u32::try_from(characters).unwrap_or(u32::MAX)
    }

    pub(super) fn character_time(&self) -> Duration {
        Duration::from_secs(10) / self.shared.baud
    }

    pub(super) fn mood(&self) -> Mood {
        let inner = self.lock();
        Mood { quirks: inner.unit.quirks.clone(), faults: inner.unit.faults.clone() }
    }

    /// Changes when all clients are to be dropped.
    pub(super) fn drops(&self) -> watch::Receiver<u64> {
        self.shared.drops.subscribe()
    }

    /// A panic elsewhere leaves nothing half done that matters here.
    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.shared.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
