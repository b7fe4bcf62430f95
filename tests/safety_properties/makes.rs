//! The makes that the properties are tried on: each is one file and one line here.

mod rc2000c;
mod rotator_genius;
mod satrak;

use super::world::World;
use crate::common::dice::Dice;

/// All makes. What a seed stands for depends on their order.
pub(super) const MAKES: &[&Make] = &[&satrak::MAKE, &rotator_genius::MAKE, &rc2000c::MAKE];

/// What differs by make beside its unit.
pub(super) struct Make {
    pub(super) name: &'static str,
    /// A random unit with its antenna, without keep-outs.
    pub(super) random: fn(&mut Dice) -> World,
    /// What another client writes to turn an axis at a rate; `None` where the unit has
    /// no other one.
    pub(super) others_jog: Option<fn(axis: usize, rate_deg_s: f64) -> Vec<u8>>,
    /// A jog goes on until the unit is told otherwise.
    pub(super) jogs_run_on: bool,
    /// Replies carry no checksum: a changed figure would be a true one of elsewhere.
    pub(super) is_unchecked: bool,
    /// The controller holds the angles against the flags before anything else sees them.
    pub(super) doubts_flags: bool,
    /// It is told a direction in so many words.
    pub(super) words_of_a_go_to: usize,
}
