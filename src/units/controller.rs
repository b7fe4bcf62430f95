//! The behaviour of each make of controller, without I/O: the next question, the meaning of a
//! reply, and the mapping of its state to the one that all antennas share. Time comes in as an
//! argument.
//!
//! Each make is one folder. [`crate::device`] is what they have in common.
//!
//! Invariant: nothing here opens a link.

pub mod rc2000c;
mod reply_clock;
pub mod rotator_genius;
pub mod satrak;

use crate::station::ControllerSpec;

/// Descriptions of all makes, for the reader of the station file.
pub static SPECS: &[&ControllerSpec] = &[&satrak::SPEC, &rotator_genius::SPEC, &rc2000c::SPEC];
