//! Clock of a session in paused time.

use std::{
    sync::{
        Arc,
        atomic::{AtomicI64, AtomicU64, Ordering},
    },
    time::Duration,
};

use azel::{
    astro::time::add_seconds,
    clock::{Clock, Instant},
};
use jiff::Timestamp;

/// Maximum number of readings; no test needs more.
const MAX_READINGS: u64 = 4_000_000;

/// Clock of a computer, which a test can set; clones are the same clock.
#[derive(Clone)]
pub(crate) struct TestClock {
    utc_origin: Timestamp,
    started: Instant,
    readings: Arc<AtomicU64>,
    ahead_s: Arc<AtomicI64>,
    asleep_s: Arc<AtomicU64>,
}

impl TestClock {
    /// Returns a clock that shows `utc_origin` now.
    pub(crate) fn new(utc_origin: Timestamp) -> Self {
        Self {
            utc_origin,
            started: Instant::now(),
            readings: Arc::default(),
            ahead_s: Arc::default(),
            asleep_s: Arc::default(),
        }
    }

    /// Returns the clock in the form that a session takes.
    pub(crate) fn clock(&self) -> Clock {
        let (utc, asleep) = (self.clone(), self.clone());
        let clock = Clock::new(move || {
            // In paused time, a loop that never sleeps would run forever.
            let readings = utc.readings.fetch_add(1, Ordering::Relaxed);
            assert!(readings < MAX_READINGS, "a busy loop");
            add_seconds(utc.utc(), utc.ahead_s.load(Ordering::Relaxed) as f64)
        });
        clock.sleeping(move || Duration::from_secs(asleep.asleep_s.load(Ordering::Relaxed)))
    }

    /// Returns true UTC, even if the clock shows another time.
    pub(crate) fn utc(&self) -> Timestamp {
        add_seconds(self.utc_origin, (Instant::now() - self.started).as_secs_f64())
    }

    /// Sets the clock `ahead_s` seconds ahead of true UTC.
    pub(crate) fn set(&self, ahead_s: i64) {
        self.ahead_s.store(ahead_s, Ordering::Relaxed);
    }

    /// Simulates `seconds` of sleep: UTC advances, but the steady clock stands still.
    pub(crate) fn sleep_for(&self, seconds: u32) {
        self.ahead_s.fetch_add(i64::from(seconds), Ordering::Relaxed);
        self.asleep_s.fetch_add(u64::from(seconds), Ordering::Relaxed);
    }

    /// Returns the number of readings up to this call.
    pub(crate) fn readings(&self) -> u64 {
        self.readings.load(Ordering::Relaxed)
    }
}
