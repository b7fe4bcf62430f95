//! Targets that are followed position by position, over real passes, against the
//! simulated controllers in paused time.

mod rig;
mod sky;

mod genius;
mod go_round;
mod rc2000c;
mod satrak;
