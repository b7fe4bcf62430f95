//! Watchdog for the driver thread, on an independent thread.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

use super::Wake;

/// Interval of the driver's beats and of the watchdog's checks.
pub(super) const PERIOD: Duration = Duration::from_millis(100);
/// Time without a beat after which the driver counts as hanging.
const STANDS_AFTER: Duration = Duration::from_millis(500);
/// Max delay of a watchdog check. Beyond it, a suspended or overloaded computer delayed both the
/// watchdog and the driver.
const LATE: Duration = Duration::from_millis(400);
/// Interval between reminders while the driver hangs.
const REMIND: Duration = Duration::from_secs(1);

/// Beats of the driver thread, and findings of the watchdog.
#[derive(Debug, Clone, Default)]
pub(super) struct Pulse(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    beats: AtomicU64,
    /// Duration of the hang, milliseconds; 0 while the driver runs.
    stood_ms: AtomicU64,
}

impl Pulse {
    /// Sends beats for ever; runs as a task of the driver thread.
    pub(super) async fn beat(self) {
        let mut period = tokio::time::interval(PERIOD);
        loop {
            period.tick().await;
            self.0.beats.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Returns how long the driver has not run, if at least half a second.
    pub(super) fn stood_for(&self) -> Option<Duration> {
        let ms = self.0.stood_ms.load(Ordering::Relaxed);
        (ms > 0).then(|| Duration::from_millis(ms))
    }

    /// Starts the watchdog thread, which ends when the caller drops the returned sender. The
    /// watchdog calls `wake` when the driver hangs, and when it runs again.
    pub(super) fn watch(&self, wake: Wake) -> io::Result<mpsc::SyncSender<()>> {
        let (near_end, end) = mpsc::sync_channel(1);
        let pulse = self.clone();
        thread::Builder::new().name("azel-watchdog".to_owned()).spawn(move || {
            let mut watchdog = Watchdog::new(Instant::now());
            let mut last_report: Option<Instant> = None;
            while end.recv_timeout(PERIOD) == Err(mpsc::RecvTimeoutError::Timeout) {
                let now = Instant::now();
                let stood = watchdog.look(pulse.0.beats.load(Ordering::Relaxed), now);
                let ms = stood.map_or(0, |stood| stood.as_millis() as u64);
                pulse.0.stood_ms.store(ms, Ordering::Relaxed);
                if stood.is_some() != last_report.is_some() {
                    if let Some(stood) = stood {
                        tracing::error!(?stood, "the driver does not respond");
                    } else {
                        tracing::warn!("the driver responds again");
                    }
                }
                let due = last_report.is_none_or(|last| now.duration_since(last) >= REMIND);
                match stood {
                    Some(_) if due => {
                        last_report = Some(now);
                        wake();
                    }
                    None if last_report.take().is_some() => wake(),
                    _ => {}
                }
            }
        })?;
        Ok(near_end)
    }
}

/// Detector of a hanging driver.
#[derive(Debug)]
struct Watchdog {
    beats: u64,
    /// Time of the last observed change of the beats.
    changed: Instant,
    looked: Instant,
}

impl Watchdog {
    fn new(now: Instant) -> Self {
        Self { beats: 0, changed: now, looked: now }
    }

    /// Returns how long the driver has hung at `now`, after this number of `beats`.
    fn look(&mut self, beats: u64, now: Instant) -> Option<Duration> {
        let was_held_up = now.saturating_duration_since(self.looked) >= LATE;
        self.looked = now;
        if beats != self.beats || was_held_up {
            (self.beats, self.changed) = (beats, now);
        }
        let stood = now.saturating_duration_since(self.changed);
        (stood >= STANDS_AFTER).then_some(stood)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the driver every tenth of a second; each `true` in `beats` adds a beat before a
    /// check.
    fn looks(beats: impl IntoIterator<Item = bool>) -> Vec<Option<u64>> {
        let mut now = Instant::now();
        let mut watchdog = Watchdog::new(now);
        let mut count = 0;
        let look = |beats: bool| {
            now += PERIOD;
            count += u64::from(beats);
            watchdog.look(count, now).map(|stood| stood.as_millis() as u64)
        };
        beats.into_iter().map(look).collect()
    }

    #[test]
    fn a_driver_stands_after_half_a_second_without_a_beat_until_the_next() {
        assert_eq!(looks([true; 50]), [None; 50]);
        let stands = looks([true, false, false, false, false, false, false, true, false]);
        let expected = [None, None, None, None, None, Some(500), Some(600), None, None];
        assert_eq!(stands, expected);
    }

    #[test]
    fn a_watchdog_that_was_held_up_itself_blames_nobody() {
        let start = Instant::now();
        let mut watchdog = Watchdog::new(start);
        let thawed = start + Duration::from_hours(1);
        assert_eq!(watchdog.look(0, thawed), None);
        assert_eq!(watchdog.look(1, thawed + PERIOD), None);
        let stands = |tenths: u32| thawed + tenths * PERIOD;
        let results: Vec<_> = (2..8).map(|tenths| watchdog.look(1, stands(tenths))).collect();
        assert_eq!(results[4], Some(STANDS_AFTER));
    }
}
