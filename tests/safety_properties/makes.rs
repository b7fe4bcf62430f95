//! Makes under test: each is one file, and one line here.

mod rc2000c;
mod rotator_genius;
mod satrak;

use super::world::World;
use crate::common::dice::Dice;

/// All makes. The meaning of a seed depends on their order.
pub(super) const MAKES: &[&Make] = &[&satrak::MAKE, &rotator_genius::MAKE, &rc2000c::MAKE];

/// Differences between makes, apart from the unit.
pub(super) struct Make {
    pub(super) name: &'static str,
    /// A random unit with its antenna, without keep-outs.
    pub(super) random: fn(&mut Dice) -> World,
    /// Bytes with which another client turns an axis at a rate; `None` if the unit accepts no
    /// other client.
    pub(super) others_jog: Option<fn(axis: usize, rate_deg_s: f64) -> Vec<u8>>,
    /// A jog goes on until the unit is told otherwise.
    pub(super) jogs_run_on: bool,
    /// Replies carry no checksum: a changed figure would be a true one of elsewhere.
    pub(super) is_unchecked: bool,
    /// The controller checks the angles against the flags before anything else sees them.
    pub(super) doubts_flags: bool,
    /// Number of commands for one direction.
    pub(super) words_of_a_go_to: usize,
}
