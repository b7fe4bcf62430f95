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

/// Where the steady clocks of this process count from.
static BASE: LazyLock<tokio::time::Instant> = LazyLock::new(tokio::time::Instant::now);

/// A reading of a steady clock, which never jumps; nanoseconds from an arbitrary zero.
/// Unlike the one of the standard library it can be written down, and it may come from
/// a clock that runs faster than real time: only readings of the same clock compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Instant(i64);

impl Instant {
    /// The steady clock of this process.
    pub fn now() -> Self {
        Clock::scaled(NonZeroU32::MIN)
    }

    /// The time since `earlier`; zero where that is later.
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

/// One instant on both clocks: the steady one for intervals, UTC for the sky.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Moment {
    /// Never jumps.
    pub steady: Instant,
    /// May be corrected at any time.
    pub utc: Timestamp,
}

/// UTC, the steady clock, timers, and how long the computer has slept. The steady clock
/// is tokio's, so that tests can pause it, times the speed.
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
    /// The clocks of the operating system.
    pub fn system() -> Self {
        let utc = Arc::new(Timestamp::now);
        Self { utc, asleep: Arc::new(asleep), speed: NonZeroU32::MIN, is_of_system: true }
    }

    /// A clock of one's own, of a computer that never sleeps.
    pub fn new(utc: impl Fn() -> Timestamp + Send + Sync + 'static) -> Self {
        let asleep = Arc::new(|| Duration::ZERO);
        Self { utc: Arc::new(utc), asleep, speed: NonZeroU32::MIN, is_of_system: false }
    }

    /// A clock that shows `start` now and runs `speed` times as fast as real time.
    pub fn at_speed(start: Timestamp, speed: NonZeroU32) -> Self {
        let begun = Self::scaled(speed);
        let utc = move || {
            let passed = Self::scaled(speed).saturating_duration_since(begun);
            start.checked_add(passed).unwrap_or(Timestamp::MAX)
        };
        Self { speed, ..Self::new(utc) }
    }

    /// The same clock of a computer that has slept for `asleep` in all.
    #[must_use]
    pub fn sleeping(self, asleep: impl Fn() -> Duration + Send + Sync + 'static) -> Self {
        Self { asleep: Arc::new(asleep), ..self }
    }

    /// Returns `true` for the clocks of the operating system, which a time service keeps.
    pub fn is_of_system(&self) -> bool {
        self.is_of_system
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

    /// UTC and the steady clock now.
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

    /// Returns the real time in which `span` passes, rounded up: after a sleep that ends too early,
    /// another one would begin again and again.
    fn real(&self, span: Duration) -> Duration {
        let nanos = span.as_nanos().div_ceil(self.speed.get().into());
        u64::try_from(nanos).map_or(Duration::MAX, Duration::from_nanos)
    }

    /// A reading of the steady clock that runs at `speed`.
    fn scaled(speed: NonZeroU32) -> Instant {
        let (now, base) = (tokio::time::Instant::now(), *BASE);
        // A paused clock of a test may have begun before the first reading.
        let elapsed_ns = nanos(now.saturating_duration_since(base));
        let real = elapsed_ns - nanos(base.saturating_duration_since(now));
        Instant(real.saturating_mul(speed.get().into()))
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
