//! The behaviour of each make of controller, without I/O: the next question, the meaning of a
//! reply, and the conversion to the common state of all antennas. The caller passes the time.
//!
//! Each make is one folder. [`crate::device`] defines the interface that all makes share.
//!
//! Invariant: this module opens no link.

pub mod rc2000c;
mod reply_clock;
pub mod rotator_genius;
pub mod satrak;

use crate::station::ControllerSpec;

/// Descriptions of all makes, for the reader of the station file.
pub static SPECS: &[&ControllerSpec] = &[&satrak::SPEC, &rotator_genius::SPEC, &rc2000c::SPEC];
