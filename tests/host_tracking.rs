//! Program track over real passes, against the simulated units in paused time.

mod rig;
mod sky;

mod genius;
mod go_round;
mod offsets;
mod rc2000c;
mod satrak;
