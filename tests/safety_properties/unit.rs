//! A simulated unit of any make.

use azel::{clock::Instant, driver::Stream};

use crate::common::dice::Dice;

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

    /// From now on every reading is noisy by half of its last figure.
    fn add_noise(&self);

    /// Link that the unit serves.
    fn link(&self) -> Box<dyn Stream>;

    /// Closes every link.
    fn drop_clients(&self);

    /// Received commands, in order.
    fn words(&self) -> Vec<(Instant, Word)>;

    /// Returns `true` if a STOP is among bytes that were written at once.
    fn holds_stop(&self, bytes: &[u8]) -> bool;

    /// Returns `true` if bytes that were written at once are more than a question.
    fn holds_order(&self, bytes: &[u8]) -> bool;

    /// Returns `true` if a reply reports the position and answers a question, not an order.
    fn is_reading(&self, reply: &[u8]) -> bool;

    /// A reply with this text, one of several, in place of the angle of an axis; the reply itself
    /// if it tells no angle.
    fn without_angle(&self, reply: &[u8], axis: usize, text: usize) -> Vec<u8>;

    /// A reply with other figures in it, and a correct checksum; angles and flags of motion stay.
    fn falsified(&self, reply: &[u8], dice: &mut Dice) -> Vec<u8>;
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

/// Returns `true` if a word is among bytes.
pub(super) fn holds(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|part| part == word)
}
