//! Common parts of all simulated units: clients, faults, and the handle for tests.
//!
//! A make implements a [`Unit`], which lives in memory, and a [`Wire`], by which the unit talks to
//! one client.

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

/// Simulated unit in memory, without I/O or clock.
pub trait Unit: fmt::Debug + Send + Sized + 'static {
    /// Oddity of firmware or line.
    type Quirk: Copy + Ord + fmt::Debug + Send;
    /// Failure of the unit or its line.
    type Fault: Copy + Ord + fmt::Debug + Send;
    /// Request as listed by [`Control::received`].
    type Request: Clone + fmt::Debug + Send;
    type Snapshot;
    /// Positions of both axes in the unit's own figures.
    type Place;
    type Wire: Wire<Self>;

    /// Fault: no reply comes.
    const SILENCE: Self::Fault;
    /// Fault: noise precedes each reply.
    const NOISE: Self::Fault;
    /// Fault: the unit refuses the commands that a track needs.
    const REFUSAL: Self::Fault;
    /// Fault: replies come in pieces.
    const SPLIT: Self::Fault;
    /// Fault: replies are collected and sent together.
    const MERGE: Self::Fault;

    /// Runs the unit until `elapsed` after the start. Earlier times change nothing.
    fn advance(&mut self, elapsed: Duration);

    /// Switches on exactly these quirks and faults.
    fn set_switches(&mut self, switches: &Switches<Self::Quirk, Self::Fault>);

    /// Reduces the drives of the first and the second axis to these shares of their full rate, 0 to
    /// 1.
    fn set_strength(&mut self, shares: [f64; 2]);

    /// Sets the unit's own clock back by `late`. Returns `false` if the unit uses no clock.
    fn set_clock_late(&mut self, _late: Duration) -> bool {
        false
    }

    /// Delays the unit's own tracking by `late`. Returns `false` if the unit does not track on its
    /// own.
    fn set_track_late(&mut self, _late: Duration) -> bool {
        false
    }

    /// Disconnects GPS, so that the unit's clock gains this many seconds a day; `None` reconnects
    /// GPS. Returns `false` if the unit uses no clock.
    fn set_clock_drift(&mut self, _gains_s_day: Option<f64>) -> bool {
        false
    }

    /// Cuts the power: the drives stop and a track ends. Settings, clock and angles stay.
    fn cut_power(&mut self);

    /// Adds errors to the sensors of the axes. Returns `false` if the unit cannot simulate them.
    fn set_misreading(&mut self, _misreading: Misreading) -> bool {
        false
    }

    /// Moves both axes to a place at once, as if by hand; the axes rest there.
    fn place(&mut self, place: Self::Place);

    fn snapshot(&self) -> Self::Snapshot;

    /// Creates the wire for a new client.
    fn wire(&self) -> Self::Wire;
}

/// Protocol of a unit on one connection.
pub trait Wire<U: Unit>: Send {
    type Reply: Send;

    /// Time over which replies are collected with [`Unit::MERGE`].
    const MERGE_TIME: Duration = Duration::from_millis(100);
    /// Length of a piece with [`Unit::SPLIT`], bytes.
    const PIECE_BYTES: RangeInclusive<u64> = 1..=8;

    /// Handles received bytes. Requests act at once; their replies are queued.
    fn take(
        &mut self,
        bytes: &mut [u8],
        control: &Control<U>,
        switches: &Switches<U::Quirk, U::Fault>,
        replies: &mut Replies<Self::Reply>,
    );

    /// Returns the bytes of reply `number`, counted from 1. `None` ends the connection.
    fn put(
        &mut self,
        reply: Self::Reply,
        number: u64,
        switches: &Switches<U::Quirk, U::Fault>,
    ) -> Option<Vec<u8>>;
}

/// Quirks and faults that are switched on.
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
