//! One running device, shared by its connections, and the hand that controls it.

use std::collections::{BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::Instant;

use super::unit::Unit;
use super::{Fault, Options, Quirk};
use crate::protocol::rotator_genius::{Moving, RotatorNumber, WholeDegrees};
use crate::sim::prng::Prng;

/// How many received commands are remembered.
const REMEMBERED_COMMANDS: usize = 10_000;

/// What the device does, for tests and displays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snapshot {
    /// Both rotators.
    pub rotators: [RotatorState; 2],
}

impl Snapshot {
    /// One rotator.
    pub fn rotator(&self, number: RotatorNumber) -> &RotatorState {
        number.of(&self.rotators)
    }
}

/// Where one rotator truly is and what it does, whatever its sensor says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotatorState {
    /// Where it points, degrees, 0 to 360.
    pub angle_deg: f64,
    /// Which way it is driven.
    pub moving: Moving,
    /// Whether it turns; it coasts when it is no longer driven.
    pub is_turning: bool,
    /// Whether its sensor shows it outside its limits.
    pub is_outside_limits: bool,
    /// Where it is going.
    pub target: Option<WholeDegrees>,
}

/// Handle of a simulated device; clones control the same one.
#[derive(Debug, Clone)]
pub struct Control {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    started: Instant,
    reply_delay: (Duration, Duration),
    inner: Mutex<Inner>,
    /// Counts how often all clients were dropped.
    drops: watch::Sender<u64>,
}

#[derive(Debug)]
struct Inner {
    unit: Unit,
    quirks: BTreeSet<Quirk>,
    faults: BTreeSet<Fault>,
    prng: Prng,
    received: VecDeque<(Instant, String)>,
}

/// A reply on its way.
pub(super) struct Reply {
    pub(super) bytes: Vec<u8>,
    pub(super) delay: Duration,
}

impl Control {
    /// A device that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        let inner = Inner {
            unit: Unit::new(options),
            quirks: options.quirks.clone(),
            faults: options.faults.clone(),
            prng: Prng::new(options.seed),
            received: VecDeque::new(),
        };
        let shared = Shared {
            started: Instant::now(),
            reply_delay: (*options.reply_delay.start(), *options.reply_delay.end()),
            inner: Mutex::new(inner),
            drops: watch::Sender::new(0),
        };
        Self { shared: Arc::new(shared) }
    }

    /// Switches a quirk on or off.
    pub fn set_quirk(&self, quirk: Quirk, is_on: bool) {
        let mut inner = self.lock();
        if is_on {
            inner.quirks.insert(quirk);
        } else {
            inner.quirks.remove(&quirk);
        }
    }

    /// Switches a fault on or off.
    pub fn set_fault(&self, fault: Fault, is_on: bool) {
        self.live();
        let mut inner = self.lock();
        if is_on {
            inner.faults.insert(fault);
        } else {
            inner.faults.remove(&fault);
        }
        let Inner { unit, faults, .. } = &mut *inner;
        unit.inject(faults);
    }

    /// Puts both rotators somewhere else, as if by hand; they stand there.
    pub fn place(&self, angles: [WholeDegrees; 2]) {
        self.live();
        self.lock().unit.place(angles);
    }

    /// Closes every connection. The device goes on with what it does.
    pub fn drop_clients(&self) {
        self.shared.drops.send_modify(|count| *count += 1);
    }

    /// The last 10 000 commands that came in, oldest first, as Latin-1 text.
    pub fn received(&self) -> Vec<(Instant, String)> {
        self.lock().received.iter().cloned().collect()
    }

    /// Where the rotators are and what they do, now.
    pub fn state(&self) -> Snapshot {
        self.live();
        self.lock().unit.snapshot()
    }

    /// Lets the device live until now.
    pub(super) fn live(&self) {
        let elapsed = self.shared.started.elapsed();
        self.lock().unit.advance(elapsed);
    }

    /// Carries a command out and gives the reply, if there is one.
    pub(super) fn answer(&self, command: &[u8]) -> Option<Reply> {
        self.live();
        let mut inner = self.lock();
        if inner.received.len() == REMEMBERED_COMMANDS {
            inner.received.pop_front();
        }
        inner.received.push_back((Instant::now(), latin_1(command)));
        let Inner { unit, quirks, prng, .. } = &mut *inner;
        let bytes = unit.answer(command, quirks)?;
        let (least, most) = self.shared.reply_delay;
        let micros = |delay: Duration| u64::try_from(delay.as_micros()).unwrap_or(u64::MAX);
        let delay = Duration::from_micros(prng.between(micros(least), micros(most)));
        Some(Reply { bytes, delay })
    }

    pub(super) fn quirks(&self) -> BTreeSet<Quirk> {
        self.lock().quirks.clone()
    }

    pub(super) fn faults(&self) -> BTreeSet<Fault> {
        self.lock().faults.clone()
    }

    /// A number from `least` to `most`, both included.
    pub(super) fn random(&self, least: u64, most: u64) -> u64 {
        self.lock().prng.between(least, most)
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

/// `bytes` as text for logs and tests.
pub(super) fn latin_1(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| char::from(*byte)).collect()
}
