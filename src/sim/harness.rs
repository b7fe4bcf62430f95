//! The mechanics that all simulated units share: their clients, their faults, and the handle for tests.
//!
//! A make brings a [`Unit`], which lives in memory, and a [`Wire`], by which the unit talks to one client.

mod connection;
mod control;
mod simulator;
#[cfg(test)]
pub(super) mod testing;

pub(super) use connection::{Replies, serve};
pub use control::Control;
pub(super) use simulator::HEARTBEAT;
pub use simulator::Simulator;

use std::{collections::BTreeSet, fmt, ops::RangeInclusive, time::Duration};

/// A simulated unit in memory: no I/O and no clock.
pub trait Unit: fmt::Debug + Send + Sized + 'static {
    /// An oddity of its firmware or its line.
    type Quirk: Copy + Ord + fmt::Debug + Send;
    /// Something that goes wrong.
    type Fault: Copy + Ord + fmt::Debug + Send;
    /// A request as [`Control::received`] gives it.
    type Request: Clone + fmt::Debug + Send;
    type Snapshot;
    /// Both axes in the unit's own figures.
    type Place;
    type Wire: Wire<Self>;

    /// Replies come in pieces.
    const SPLIT: Self::Fault;
    /// Replies are gathered and come together.
    const MERGE: Self::Fault;

    /// Lives until `elapsed` after the start. Earlier times change nothing.
    fn advance(&mut self, elapsed: Duration);

    /// Switches these quirks and faults on and all others off.
    fn set_switches(&mut self, switches: &Switches<Self::Quirk, Self::Fault>);

    /// Puts both axes somewhere else, as if by hand; they stand there.
    fn place(&mut self, place: Self::Place);

    fn snapshot(&self) -> Self::Snapshot;

    /// The wire of a new client.
    fn wire(&self) -> Self::Wire;
}

/// A unit's protocol on one connection.
pub trait Wire<U: Unit>: Send {
    type Reply: Send;

    /// With [`Unit::MERGE`], replies are gathered for this long.
    const MERGE_TIME: Duration = Duration::from_millis(100);
    /// With [`Unit::SPLIT`], the length of a piece.
    const PIECE_BYTES: RangeInclusive<u64> = 1..=8;

    /// Carries out what came in. The requests act at once, the replies wait.
    fn take(
        &mut self,
        bytes: &mut [u8],
        control: &Control<U>,
        switches: &Switches<U::Quirk, U::Fault>,
        replies: &mut Replies<Self::Reply>,
    );

    /// The bytes that go out for `reply`, which is the `number`th, from 1. `None` ends the connection.
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
