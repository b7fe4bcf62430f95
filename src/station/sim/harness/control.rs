//! Running unit, shared by its connections, and the handle that controls it.

use std::{
    collections::{BTreeSet, VecDeque},
    ops::RangeInclusive,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::Duration,
};

use tokio::sync::watch;

use super::{Switches, Unit};
use crate::{
    clock::{Clock, Instant},
    sim::prng::Prng,
};

/// Max number of stored requests.
const REMEMBERED_REQUESTS: usize = 10_000;

/// Handle of a simulated unit; clones control the same unit.
#[derive(Debug)]
pub struct Control<U: Unit> {
    shared: Arc<Shared<U>>,
}

#[derive(Debug)]
struct Shared<U: Unit> {
    clock: Clock,
    started: Instant,
    reply_delay: RangeInclusive<Duration>,
    inner: Mutex<Inner<U>>,
    /// Number of times that all clients were dropped.
    drops: watch::Sender<u64>,
}

#[derive(Debug)]
struct Inner<U: Unit> {
    unit: U,
    switches: Switches<U::Quirk, U::Fault>,
    prng: Prng,
    /// Max extra reply delay.
    lateness: Duration,
    received: VecDeque<(Instant, U::Request)>,
}

impl<U: Unit> Clone for Control<U> {
    fn clone(&self) -> Self {
        Self { shared: Arc::clone(&self.shared) }
    }
}

impl<U: Unit> Control<U> {
    /// Starts `unit` without a port. The delay between request and reply is evenly distributed over
    /// `reply_delay`.
    pub(in crate::sim) fn start(
        mut unit: U,
        switches: Switches<U::Quirk, U::Fault>,
        reply_delay: RangeInclusive<Duration>,
        seed: u64,
        clock: Clock,
    ) -> Self {
        unit.set_switches(&switches);
        let inner = Inner {
            unit,
            switches,
            prng: Prng::new(seed),
            lateness: Duration::ZERO,
            received: VecDeque::new(),
        };
        let shared = Shared {
            started: clock.now().steady,
            clock,
            reply_delay,
            inner: Mutex::new(inner),
            drops: watch::Sender::new(0),
        };
        Self { shared: Arc::new(shared) }
    }

    pub fn set_quirk(&self, quirk: U::Quirk, is_on: bool) {
        self.switch(|switches| set(&mut switches.quirks, quirk, is_on));
    }

    pub fn set_fault(&self, fault: U::Fault, is_on: bool) {
        self.switch(|switches| set(&mut switches.faults, fault, is_on));
    }

    fn switch(&self, change: impl FnOnce(&mut Switches<U::Quirk, U::Fault>)) {
        let mut inner = self.live();
        let Inner { unit, switches, .. } = &mut *inner;
        change(switches);
        unit.set_switches(switches);
    }

    /// Moves both axes to a place at once, as if by hand; the axes rest there.
    pub fn place(&self, place: U::Place) {
        self.live().unit.place(place);
    }

    /// Closes every connection. The unit continues its activity.
    pub fn drop_clients(&self) {
        self.shared.drops.send_modify(|count| *count += 1);
    }

    /// Returns the last 10 000 complete requests, oldest first, without secrets.
    pub fn received(&self) -> Vec<(Instant, U::Request)> {
        self.lock().received.iter().cloned().collect()
    }

    /// Returns the current state of the unit.
    pub fn state(&self) -> U::Snapshot {
        self.live().unit.snapshot()
    }

    /// Stores `request` and carries it out.
    pub(in crate::sim) fn carry_out<R>(
        &self,
        request: U::Request,
        carry_out: impl FnOnce(&mut U) -> R,
    ) -> R {
        let mut inner = self.live();
        if inner.received.len() == REMEMBERED_REQUESTS {
            inner.received.pop_front();
        }
        inner.received.push_back((self.clock().now().steady, request));
        carry_out(&mut inner.unit)
    }

    /// Changes the unit in a way that no client can.
    pub(in crate::sim) fn with_unit<R>(&self, change: impl FnOnce(&mut U) -> R) -> R {
        change(&mut self.live().unit)
    }

    /// Advances the unit to the current time.
    pub(in crate::sim) fn live_on(&self) {
        drop(self.live());
    }

    fn live(&self) -> MutexGuard<'_, Inner<U>> {
        let elapsed = self.clock().now().steady - self.shared.started;
        let mut inner = self.lock();
        inner.unit.advance(elapsed);
        inner
    }

    /// Returns the unit's clock. Its steady time drives the unit.
    pub(in crate::sim) fn clock(&self) -> &Clock {
        &self.shared.clock
    }

    pub(in crate::sim) fn switches(&self) -> Switches<U::Quirk, U::Fault> {
        self.lock().switches.clone()
    }

    pub(in crate::sim) fn wire(&self) -> U::Wire {
        self.lock().unit.wire()
    }

    /// Returns a random delay for the next reply.
    pub(in crate::sim) fn reply_delay(&self) -> Duration {
        let micros = |delay: &Duration| u64::try_from(delay.as_micros()).unwrap_or(u64::MAX);
        let max = *self.shared.reply_delay.end() + self.lock().lateness;
        Duration::from_micros(
            self.random(&(micros(self.shared.reply_delay.start())..=micros(&max))),
        )
    }

    /// Sets the max extra reply delay.
    pub(super) fn set_lateness(&self, lateness: Duration) {
        self.lock().lateness = lateness;
    }

    /// Returns a random number in `range`.
    pub(super) fn random(&self, range: &RangeInclusive<u64>) -> u64 {
        self.lock().prng.in_range(*range.start(), *range.end())
    }

    /// Returns a receiver that changes when all clients must be dropped.
    pub(super) fn drops(&self) -> watch::Receiver<u64> {
        self.shared.drops.subscribe()
    }

    /// Locks the state. Ignores poisoning: a panic elsewhere leaves no harmful partial change.
    fn lock(&self) -> MutexGuard<'_, Inner<U>> {
        self.shared.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn set<T: Ord>(switched_on: &mut BTreeSet<T>, value: T, is_on: bool) {
    if is_on {
        switched_on.insert(value);
    } else {
        switched_on.remove(&value);
    }
}
