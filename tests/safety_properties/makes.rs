//! Makes under test: each make has one file, and one line here.

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
    /// Function that draws a unit with its antenna, without keep-outs.
    pub(super) random: fn(&mut Dice, Timestamp) -> World,
    /// Bytes with which another client turns an axis at a rate; `None` if the unit accepts no
    /// other client.
    pub(super) others_jog: Option<fn(axis: usize, rate_deg_s: f64) -> Vec<u8>>,
    /// `true` if a jog goes on until another command ends it.
    pub(super) jogs_run_on: bool,
    /// `true` if replies carry no checksum, so that a changed figure looks like a position
    /// elsewhere.
    pub(super) is_unchecked: bool,
    /// `true` if the controller checks the angles against the flags before any other code sees
    /// them.
    pub(super) doubts_flags: bool,
    /// `true` if the unit can track satellites.
    pub(super) tracks_on_board: bool,
    /// Length of a way that the unit ignores, degrees, with the step of its figures. The angles of
    /// a motion without effect may stay this far behind.
    pub(super) ignores_deg: f64,
    /// `true` if a new session waits for the operator before it opens a link.
    pub(super) waits_for_word: bool,
    /// Number of commands for one direction.
    pub(super) words_of_a_go_to: usize,
}
