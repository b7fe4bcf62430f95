//! The clocks of a session.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;
use tokio::time::Instant;

use crate::device::Moment;

/// Where UTC comes from, and how long the computer has slept; the steady clock is
/// tokio's, so that tests can pause it.
#[derive(Clone)]
pub struct Clock {
    utc: Arc<dyn Fn() -> Timestamp + Send + Sync>,
    asleep: Arc<dyn Fn() -> Duration + Send + Sync>,
}

impl Clock {
    /// The clocks of the operating system.
    pub fn system() -> Self {
        Self { utc: Arc::new(Timestamp::now), asleep: Arc::new(asleep) }
    }

    /// A clock of one's own, of a computer that never sleeps.
    pub fn new(utc: impl Fn() -> Timestamp + Send + Sync + 'static) -> Self {
        Self { utc: Arc::new(utc), asleep: Arc::new(|| Duration::ZERO) }
    }

    /// The same clock of a computer that has slept for `asleep` in all.
    #[must_use]
    pub fn sleeping(self, asleep: impl Fn() -> Duration + Send + Sync + 'static) -> Self {
        Self { asleep: Arc::new(asleep), ..self }
    }

    /// UTC now.
    pub fn utc(&self) -> Timestamp {
        (self.utc)()
    }

    /// For how long the computer has slept in all, during which the steady clock
    /// stood.
    pub fn asleep(&self) -> Duration {
        (self.asleep)()
    }

    /// UTC and the steady clock now. Only within a runtime.
    pub fn now(&self) -> Moment {
        Moment { steady: Instant::now().into_std(), utc: self.utc() }
    }
}

/// The clock that runs on in sleep, less the one that stands.
#[cfg(target_os = "linux")]
fn asleep() -> Duration {
    use nix::time::ClockId;
    let read = |clock: ClockId| clock.now().map(Duration::from);
    let clocks = read(ClockId::CLOCK_BOOTTIME).and_then(|boot| {
        let steady = read(ClockId::CLOCK_MONOTONIC)?;
        Ok(boot.saturating_sub(steady))
    });
    clocks.unwrap_or_default()
}

/// The steady clock runs on in sleep, or nothing tells.
#[cfg(not(target_os = "linux"))]
fn asleep() -> Duration {
    Duration::ZERO
}
