//! A simulated unit of any make.

use azel::{clock::Instant, driver::Stream};

/// A simulated unit.
pub(super) trait Unit: Send + Sync {
    /// True positions of both axes, degrees as the mount counts.
    fn axes_deg(&self) -> [f64; 2];

    fn is_turning(&self) -> bool;

    /// Positions as the unit counts them, for axes placed there.
    fn as_counted(&self, axes_deg: [f64; 2]) -> [f64; 2] {
        axes_deg
    }

    /// Puts the axes there; returns `false` if they cannot stand there.
    fn place(&self, axes_deg: [f64; 2]) -> bool;

    fn tell(&self, lie: Lie);

    /// Link that the unit serves.
    fn link(&self) -> Box<dyn Stream>;

    /// Closes every link.
    fn drop_clients(&self);

    /// Received commands, in order.
    fn words(&self) -> Vec<(Instant, Word)>;

    /// Whether a STOP is among bytes that were written at once.
    fn holds_stop(&self, bytes: &[u8]) -> bool;
}

/// Falsehood in the reports of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lie {
    FrozenAngles,
    FalseRest,
}

/// Kind of a received command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Stop,
    Question,
    /// Order to move metal.
    Motion,
    Other,
}

/// Whether a word is among bytes.
pub(super) fn holds(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|part| part == word)
}
