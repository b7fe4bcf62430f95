//! Simulated unit of any make.

use azel::{clock::Instant, driver::Stream};

use crate::common::dice::Dice;

/// Simulated unit, as the tests judge and control it.
pub(super) trait Unit: Send + Sync {
    /// Returns the true positions of both axes, degrees as the mount counts.
    fn axes_deg(&self) -> [f64; 2];

    fn is_turning(&self) -> bool;

    /// Returns the positions that the unit counts for axes placed at `axes_deg`.
    fn as_counted(&self, axes_deg: [f64; 2]) -> [f64; 2] {
        axes_deg
    }

    /// Puts the axes at `axes_deg`; returns `false` if they cannot stand there.
    fn place(&self, axes_deg: [f64; 2]) -> bool;

    fn tell(&self, lie: Lie);

    /// Adds noise of half of the last figure to every reading from now on.
    fn add_noise(&self);

    /// Opens a link that the unit serves.
    fn link(&self) -> Box<dyn Stream>;

    /// Closes every link.
    fn drop_clients(&self);

    /// Returns the received commands, in order.
    fn words(&self) -> Vec<(Instant, Word)>;

    /// Returns `true` if the bytes of one write hold a STOP.
    fn holds_stop(&self, bytes: &[u8]) -> bool;

    /// Returns `true` if the bytes of one write are more than a question.
    fn holds_order(&self, bytes: &[u8]) -> bool;

    /// Returns `true` if a reply reports the position and answers a question, not an order.
    fn is_reading(&self, reply: &[u8]) -> bool;

    /// Returns the reply with one of several texts in place of the angle of an axis, or the
    /// unchanged reply if it has no angle.
    fn without_angle(&self, reply: &[u8], axis: usize, text: usize) -> Vec<u8>;

    /// Returns the reply with other figures and a correct checksum. Angles and flags of motion
    /// stay.
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
    /// Order to move the antenna.
    Motion,
    Other,
}

/// Returns `true` if `bytes` contain `word`.
pub(super) fn holds(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|part| part == word)
}
