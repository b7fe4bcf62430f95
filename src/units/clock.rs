//! The clocks of a station: UTC, the steady clock and sleep, from the operating system
//! or from a test.

use std::{
    fmt,
    future::Future,
    num::NonZeroU32,
    ops::{Add, AddAssign, Sub},
    sync::{Arc, LazyLock},
    time::Duration,
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use tokio::time::error::Elapsed;

/// Zero of the steady clocks of this process.
static BASE: LazyLock<tokio::time::Instant> = LazyLock::new(tokio::time::Instant::now);

/// A reading of a steady clock, which never jumps; nanoseconds from an arbitrary zero. Unlike the
/// instant of the standard library, it can be serialized and may come from a clock that runs faster
/// than real time. Only readings of the same clock can be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Instant(i64);

impl Instant {
    /// Returns the current reading of the steady clock of this process.
    pub fn now() -> Self {
        Clock::scaled(NonZeroU32::MIN)
    }

    /// Returns the time since `earlier`; zero if `earlier` is later.
    #[must_use]
    pub fn saturating_duration_since(self, earlier: Self) -> Duration {
        Duration::from_nanos(self.0.saturating_sub(earlier.0).try_into().unwrap_or_default())
    }
}

impl Add<Duration> for Instant {
    type Output = Self;

    fn add(self, span: Duration) -> Self {
        Self(self.0.saturating_add(nanos(span)))
    }
}

impl AddAssign<Duration> for Instant {
    fn add_assign(&mut self, span: Duration) {
        *self = *self + span;
    }
}

impl Sub<Duration> for Instant {
    type Output = Self;

    fn sub(self, span: Duration) -> Self {
        Self(self.0.saturating_sub(nanos(span)))
    }
}

impl Sub for Instant {
    type Output = Duration;

    fn sub(self, earlier: Self) -> Duration {
        self.saturating_duration_since(earlier)
    }
}

fn nanos(span: Duration) -> i64 {
    i64::try_from(span.as_nanos()).unwrap_or(i64::MAX)
}

/// One instant on both clocks: steady time for intervals, UTC for the sky.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Moment {
    /// Time of the steady clock, which never jumps.
    pub steady: Instant,
    /// UTC, which may be corrected at any time.
    pub utc: Timestamp,
}

/// UTC, the steady clock, timers, and the time that the computer has slept. The steady clock is
/// tokio's clock, which tests can pause, multiplied by the speed.
#[derive(Clone)]
pub struct Clock {
    utc: Arc<dyn Fn() -> Timestamp + Send + Sync>,
    asleep: Arc<dyn Fn() -> Duration + Send + Sync>,
    speed: NonZeroU32,
    is_of_system: bool,
}

impl fmt::Debug for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Clock").field("utc", &self.utc()).finish_non_exhaustive()
    }
}

impl Clock {
    /// Returns the clocks of the operating system.
    pub fn system() -> Self {
        let utc = Arc::new(Timestamp::now);
        Self { utc, asleep: Arc::new(asleep), speed: NonZeroU32::MIN, is_of_system: true }
    }

    /// Returns a clock that shows `utc`, of a computer that never sleeps.
    pub fn new(utc: impl Fn() -> Timestamp + Send + Sync + 'static) -> Self {
        let asleep = Arc::new(|| Duration::ZERO);
        Self { utc: Arc::new(utc), asleep, speed: NonZeroU32::MIN, is_of_system: false }
    }

    /// Returns a clock that shows `start` now and runs `speed` times as fast as real time.
    pub fn at_speed(start: Timestamp, speed: NonZeroU32) -> Self {
        let begun = Self::scaled(speed);
        let utc = move || {
            let passed = Self::scaled(speed).saturating_duration_since(begun);
            start.checked_add(passed).unwrap_or(Timestamp::MAX)
        };
        Self { speed, ..Self::new(utc) }
    }

    /// Returns the same clock of a computer that has slept for `asleep` in all.
    #[must_use]
    pub fn sleeping(self, asleep: impl Fn() -> Duration + Send + Sync + 'static) -> Self {
        Self { asleep: Arc::new(asleep), ..self }
    }

    /// Returns `true` for the clocks of the operating system, which a time service corrects.
    pub fn is_of_system(&self) -> bool {
        self.is_of_system
    }

    /// Returns the current UTC.
    pub fn utc(&self) -> Timestamp {
        (self.utc)()
    }

    /// Returns the total time that the computer has slept. The steady clock stops during sleep.
    pub fn asleep(&self) -> Duration {
        (self.asleep)()
    }

    /// Returns the current UTC and the current reading of the steady clock.
    pub fn now(&self) -> Moment {
        Moment { steady: Self::scaled(self.speed), utc: self.utc() }
    }

    /// Waits until the steady clock shows `end`.
    pub async fn sleep_until(&self, end: Instant) {
        let left = end.saturating_duration_since(Self::scaled(self.speed));
        self.sleep(left).await;
    }

    /// Waits for `span` of this clock.
    pub async fn sleep(&self, span: Duration) {
        tokio::time::sleep(self.real(span)).await;
    }

    /// Returns the output of `work`, unless it takes longer than `span` of this clock.
    pub async fn timeout<F: Future>(&self, span: Duration, work: F) -> Result<F::Output, Elapsed> {
        tokio::time::timeout(self.real(span), work).await
    }

    /// Returns the real time in which `span` passes, rounded up: a sleep that ends too early would
    /// be repeated again and again.
    fn real(&self, span: Duration) -> Duration {
        let nanos = span.as_nanos().div_ceil(self.speed.get().into());
        u64::try_from(nanos).map_or(Duration::MAX, Duration::from_nanos)
    }

    /// Returns the current reading of the steady clock that runs at `speed`.
    fn scaled(speed: NonZeroU32) -> Instant {
        let (now, base) = (tokio::time::Instant::now(), *BASE);
        // A paused clock of a test may have begun before the first reading.
        let elapsed_ns = nanos(now.saturating_duration_since(base));
        let real = elapsed_ns - nanos(base.saturating_duration_since(now));
        Instant(real.saturating_mul(speed.get().into()))
    }
}

/// Returns the time slept since boot: the clock that counts sleep, less the clock that stops.
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

/// Returns zero: the steady clock continues during sleep, or no clock shows the sleep.
#[cfg(not(target_os = "linux"))]
fn asleep() -> Duration {
    Duration::ZERO
}
