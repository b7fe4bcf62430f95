//! Targets that are followed position by position, over real passes, against the
//! simulated controllers in paused time.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may end here, and prints its figures"
)]

mod host_tracking {
    mod rig;
    mod sky;

    mod genius;
    mod go_round;
    mod rc2000c;
    mod satrak;
}
