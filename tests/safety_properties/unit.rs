//! One simulated unit, whatever its make.

use azel::{clock::Instant, driver::Stream};

/// A simulated unit.
pub(super) trait Unit: Send + Sync {
    /// Where both axes truly stand, degrees as the mount counts.
    fn axes_deg(&self) -> [f64; 2];

    fn is_turning(&self) -> bool;

    /// Where the axes stand that were put there, as the unit counts.
    fn as_counted(&self, axes_deg: [f64; 2]) -> [f64; 2] {
        axes_deg
    }

    /// Puts the axes there; `false` where they cannot stand.
    fn place(&self, axes_deg: [f64; 2]) -> bool;

    fn tell(&self, lie: Lie);

    /// A link that it serves.
    fn link(&self) -> Box<dyn Stream>;

    /// Closes every link.
    fn drop_clients(&self);

    /// What it has received, in order.
    fn words(&self) -> Vec<(Instant, Word)>;

    /// Whether a STOP is among bytes that were written to it at once.
    fn holds_stop(&self, bytes: &[u8]) -> bool;
}

/// What a unit tells wrongly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lie {
    FrozenAngles,
    FalseRest,
}

/// What a unit received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Stop,
    Question,
    /// Metal is to move.
    Motion,
    Other,
}

/// Whether a word is among bytes.
pub(super) fn holds(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|part| part == word)
}
