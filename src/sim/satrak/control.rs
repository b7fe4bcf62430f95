//! One running unit, shared by its connections, and the hand that controls it.

use std::collections::{BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::Instant;

use super::folder;
use super::unit::Unit;
use super::{Fault, Options, Quirk};
use crate::protocol::satrak::Frame;
use crate::sim::prng::Prng;

/// How many received frames are remembered.
const REMEMBERED_FRAMES: usize = 10_000;

/// What the unit believes and does, for tests and displays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snapshot {
    /// X angle as reported, degrees.
    pub x_deg: f64,
    /// Y angle as reported, degrees.
    pub y_deg: f64,
    /// Where both axes truly are, whatever is reported, degrees.
    pub metal_deg: [f64; 2],
    /// Azimuth, degrees, 0 to 360.
    pub az_deg: f64,
    /// Elevation, degrees.
    pub el_deg: f64,
    /// Tracking is switched on.
    pub is_tracking: bool,
    /// Any axis moves.
    pub is_moving: bool,
}

/// Handle of a simulated unit; clones control the same one.
#[derive(Debug, Clone)]
pub struct Control {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    started: Instant,
    reply_delay: (Duration, Duration),
    element_folder: Option<PathBuf>,
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

/// An answer on its way.
pub(super) struct Reply {
    pub(super) payload: String,
    pub(super) delay: Duration,
}

/// What misbehaves at present.
#[derive(Debug, Clone, Default)]
pub(super) struct Mood {
    pub(super) quirks: BTreeSet<Quirk>,
    pub(super) faults: BTreeSet<Fault>,
}

impl Control {
    /// A unit that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        let mut unit = Unit::new(options);
        unit.inject(&options.faults);
        let inner = Inner {
            unit,
            quirks: options.quirks.clone(),
            faults: options.faults.clone(),
            prng: Prng::new(options.seed),
            received: VecDeque::new(),
        };
        let shared = Shared {
            started: Instant::now(),
            reply_delay: (*options.reply_delay.start(), *options.reply_delay.end()),
            element_folder: options.element_folder.clone(),
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

    /// Closes every connection. The unit goes on with what it does.
    pub fn drop_clients(&self) {
        self.shared.drops.send_modify(|count| *count += 1);
    }

    /// The last 10 000 payloads that came in with a right checksum, oldest
    /// first, without secrets.
    pub fn received(&self) -> Vec<(Instant, String)> {
        self.lock().received.iter().cloned().collect()
    }

    /// Where the antenna is and what it does, now.
    pub fn state(&self) -> Snapshot {
        self.live();
        self.lock().unit.snapshot()
    }

    /// Puts both axes somewhere else, as if by hand, degrees; they stand there.
    pub fn place(&self, axes_deg: [f64; 2]) {
        self.live();
        self.lock().unit.place(axes_deg);
    }

    /// Lets the unit live until now.
    pub(super) fn live(&self) {
        let elapsed = self.shared.started.elapsed();
        self.lock().unit.advance(elapsed);
    }

    /// Carries a frame out and gives the answer.
    pub(super) fn answer(&self, frame: &Frame) -> Reply {
        self.live();
        let folder = self.shared.element_folder.as_deref();
        let files = folder.filter(|_| folder::is_about_a_file(frame)).map(folder::read);
        let mut inner = self.lock();
        inner.unit.take_files(files.unwrap_or_default());
        if inner.received.len() == REMEMBERED_FRAMES {
            inner.received.pop_front();
        }
        inner.received.push_back((Instant::now(), frame.redacted().into_owned()));
        let answer = inner.unit.answer(frame);
        let payload = answer.payload(&inner.quirks);
        let (least, most) = self.shared.reply_delay;
        let micros = |delay: Duration| u64::try_from(delay.as_micros()).unwrap_or(u64::MAX);
        let delay = Duration::from_micros(inner.prng.between(micros(least), micros(most)));
        Reply { payload, delay }
    }

    pub(super) fn mood(&self) -> Mood {
        let inner = self.lock();
        Mood { quirks: inner.quirks.clone(), faults: inner.faults.clone() }
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
