//! Makes under test: each is one file, and one line here.

mod rc2000c;
mod rotator_genius;
mod satrak;

use jiff::Timestamp;

use super::world::World;
use crate::common::dice::Dice;

/// All makes. The meaning of a seed depends on their order.
pub(super) const MAKES: &[&Make] = &[&satrak::MAKE, &rotator_genius::MAKE, &rc2000c::MAKE];

/// Differences between makes, apart from the unit.
pub(super) struct Make {
    pub(super) name: &'static str,
    /// A random unit with its antenna, without keep-outs.
    pub(super) random: fn(&mut Dice, Timestamp) -> World,
    /// Bytes with which another client turns an axis at a rate; `None` if the unit accepts no
    /// other client.
    pub(super) others_jog: Option<fn(axis: usize, rate_deg_s: f64) -> Vec<u8>>,
    /// A jog goes on until the unit is told otherwise.
    pub(super) jogs_run_on: bool,
    /// Replies carry no checksum: a changed figure would be a true one of elsewhere.
    pub(super) is_unchecked: bool,
    /// The controller checks the angles against the flags before anything else sees them.
    pub(super) doubts_flags: bool,
    /// The unit tracks satellites by itself.
    pub(super) tracks_on_board: bool,
    /// The unit ignores shorter ways, so the angles of a motion without effect may stay so far
    /// behind, degrees, with the unit's figures.
    pub(super) ignores_deg: f64,
    /// A new session waits for the operator before it opens a link.
    pub(super) waits_for_word: bool,
    /// Number of commands for one direction.
    pub(super) words_of_a_go_to: usize,
}
