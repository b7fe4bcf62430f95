//! Mechanics that all simulated units share: clients, faults, and the handle for tests.
//!
//! A make brings a [`Unit`], which lives in memory, and a [`Wire`], by which the unit
//! talks to one client.

mod connection;
mod control;
mod in_memory;
mod simulator;
#[cfg(test)]
pub(super) mod testing;

pub(super) use connection::{Replies, serve};
pub use control::Control;
pub use in_memory::{InMemory, Misreading, Trouble};
pub(super) use simulator::HEARTBEAT;
pub use simulator::Simulator;

use std::{collections::BTreeSet, fmt, ops::RangeInclusive, time::Duration};

/// A simulated unit in memory, without I/O or clock.
pub trait Unit: fmt::Debug + Send + Sized + 'static {
    /// An oddity of firmware or line.
    type Quirk: Copy + Ord + fmt::Debug + Send;
    /// A failure.
    type Fault: Copy + Ord + fmt::Debug + Send;
    /// A request as listed by [`Control::received`].
    type Request: Clone + fmt::Debug + Send;
    type Snapshot;
    /// Positions of both axes in the unit's own figures.
    type Place;
    type Wire: Wire<Self>;

    /// Fault: no reply comes.
    const SILENCE: Self::Fault;
    /// Fault: noise precedes each reply.
    const NOISE: Self::Fault;
    /// Fault: what a track needs is refused.
    const REFUSAL: Self::Fault;
    /// Fault: replies come in pieces.
    const SPLIT: Self::Fault;
    /// Fault: replies are gathered and come together.
    const MERGE: Self::Fault;

    /// Runs the unit until `elapsed` after the start. Earlier times change nothing.
    fn advance(&mut self, elapsed: Duration);

    /// Switches these quirks and faults on and all others off.
    fn set_switches(&mut self, switches: &Switches<Self::Quirk, Self::Fault>);

    /// Leaves the drives of the first and the second axis these shares of their full rate, 0 to 1.
    fn set_strength(&mut self, shares: [f64; 2]);

    /// Sets the unit's own clock back by so much. Returns `false` if it has none that matters.
    fn set_clock_late(&mut self, _late: Duration) -> bool {
        false
    }

    /// Makes the unit follow its track late by so much. Returns `false` if it tracks nothing by itself.
    fn set_track_late(&mut self, _late: Duration) -> bool {
        false
    }

    /// Takes GPS from the unit, whose own clock then gains so many seconds a day; `None` brings it
    /// back. Returns `false` if the unit has no clock that matters.
    fn set_clock_drift(&mut self, _gains_s_day: Option<f64>) -> bool {
        false
    }

    /// Cuts the power: the drives stop and a track ends. Settings, clock and angles stay.
    fn cut_power(&mut self);

    /// Makes the sensors of the axes read something else. Returns `false` if they cannot.
    fn set_misreading(&mut self, _misreading: Misreading) -> bool {
        false
    }

    /// Puts both axes elsewhere, as if by hand; they stand there.
    fn place(&mut self, place: Self::Place);

    fn snapshot(&self) -> Self::Snapshot;

    /// Wire for a new client.
    fn wire(&self) -> Self::Wire;
}

/// Protocol of a unit on one connection.
pub trait Wire<U: Unit>: Send {
    type Reply: Send;

    /// Time for which replies are gathered with [`Unit::MERGE`].
    const MERGE_TIME: Duration = Duration::from_millis(100);
    /// Length of a piece with [`Unit::SPLIT`].
    const PIECE_BYTES: RangeInclusive<u64> = 1..=8;

    /// Carries out the bytes that came in. Requests act at once; their replies wait.
    fn take(
        &mut self,
        bytes: &mut [u8],
        control: &Control<U>,
        switches: &Switches<U::Quirk, U::Fault>,
        replies: &mut Replies<Self::Reply>,
    );

    /// Bytes to send for `reply` number `number`, counted from 1. `None` ends the connection.
    fn put(
        &mut self,
        reply: Self::Reply,
        number: u64,
        switches: &Switches<U::Quirk, U::Fault>,
    ) -> Option<Vec<u8>>;
}

/// The quirks and faults that are switched on.
#[derive(Debug, Clone)]
pub struct Switches<Q, F> {
    pub(super) quirks: BTreeSet<Q>,
    pub(super) faults: BTreeSet<F>,
}

impl<Q: Copy + Ord, F: Copy + Ord> Switches<Q, F> {
    pub(super) fn has_quirk(&self, quirk: Q) -> bool {
        self.quirks.contains(&quirk)
    }

    pub(super) fn has_fault(&self, fault: F) -> bool {
        self.faults.contains(&fault)
    }
}
