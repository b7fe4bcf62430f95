//! Behaviour of each make of controller without I/O: what to ask next, what a
//! reply means, and how its state maps to the one that all antennas share. Time
//! comes in as an argument.
//!
//! Each make is one folder. What they have in common is [`crate::device`].
//!
//! Invariant: nothing here opens a link.

pub mod rc2000c;
mod reply_clock;
pub mod rotator_genius;
pub mod satrak;
