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
