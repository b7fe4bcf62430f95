//! Processor time of each turn (each poll) of a task.

use std::{
    cell::RefCell,
    collections::BTreeMap,
    fmt,
    future::{Future, poll_fn},
    pin::pin,
    time::Duration,
};

use nix::time::ClockId;

/// Max processor time of one turn, also in unoptimised tests. A longer turn delays the other
/// antennas.
const MAX_TURN: Duration = Duration::from_millis(500);

/// Returns the processor time that this thread has used.
fn spent() -> Duration {
    ClockId::CLOCK_THREAD_CPUTIME_ID.now().map(Duration::from).unwrap_or_default()
}

/// Runs `work`, and hands the processor time of each turn to `take`.
pub(crate) async fn timed<F: Future>(work: F, mut take: impl FnMut(Duration)) -> F::Output {
    let mut work = pin!(work);
    poll_fn(move |context| {
        let before = spent();
        let polled = work.as_mut().poll(context);
        take(spent().saturating_sub(before));
        polled
    })
    .await
}

/// Number of turns by processor time, in steps of 10 microseconds.
#[derive(Clone, Default)]
pub(crate) struct Turns(BTreeMap<u64, u64>);

impl Turns {
    pub(crate) fn add(&mut self, turn: Duration) {
        *self.0.entry(turn.as_micros() as u64 / 10).or_default() += 1;
    }

    pub(crate) fn add_all(&mut self, others: &Self) {
        for (time, count) in &others.0 {
            *self.0.entry(*time).or_default() += count;
        }
    }

    fn count(&self) -> u64 {
        self.0.values().sum()
    }

    pub(crate) fn longest_ms(&self) -> f64 {
        self.exceeded_by_ms(0.0)
    }

    /// Returns the time that at most the fraction `share` of the turns exceeds, milliseconds.
    fn exceeded_by_ms(&self, share: f64) -> f64 {
        let mut left = ((1.0 - share) * self.count() as f64).ceil() as u64;
        let reached = self.0.iter().find(|(_, count)| {
            left = left.saturating_sub(**count);
            left == 0
        });
        reached.map_or(0.0, |(time, _)| *time as f64 / 100.0)
    }
}

impl fmt::Display for Turns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [p50, p9999] = [0.5, 1e-4].map(|share| self.exceeded_by_ms(share));
        let max = self.longest_ms();
        write!(f, "{} turns: p50 {p50} ms, p99.99 {p9999} ms, max {max} ms", self.count())
    }
}

thread_local! {
    static MEASURED: RefCell<Turns> = RefCell::default();
}

/// Returns the turns on this thread that [`measured`] has recorded since the last call.
pub(crate) fn take_measured() -> Turns {
    MEASURED.take()
}

/// Runs `work` and fails if one of its turns takes longer than [`MAX_TURN`].
pub(crate) async fn measured<F: Future>(work: F) -> F::Output {
    timed(work, |turn| {
        assert!(turn < MAX_TURN, "one turn took {turn:?} of processor time");
        MEASURED.with_borrow_mut(|turns| turns.add(turn));
    })
    .await
}
