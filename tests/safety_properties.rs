//! Properties of whole sessions that drive the simulated units in paused time, over
//! random mounts, limits, keep-outs, commands and troubles.
//!
//! The short form runs with all other tests. The long form, optimised because a case is
//! minutes of simulated time:
//!
//! ```text
//! AZEL_CASES=10000 cargo test --release --test azel -- --nocapture safety_properties
//! ```
//!
//! It runs 10 000 cases in each of nineteen classes, and as many for each of three makes and
//! six rates of damage. One class and a range of seeds, here 5000 from seed 1000000 on:
//!
//! ```text
//! AZEL_SEED=1000000 AZEL_CASES=5000 cargo test --release --test azel -- --nocapture safety_properties::cuts
//! ```
//!
//! The gate alone, ten times as many:
//!
//! ```text
//! AZEL_CASES=10000 cargo test --release --lib -- --nocapture any_motion_that_is_allowed
//! ```
//!
//! Limits of the properties:
//!
//! - an angle is compared to within half a step of the reported figures plus the overshoot
//!   of the drives (0.15 degrees for a Satrak, 2.6 for a Genius in whole degrees, 0.3 for an
//!   RC2000C): the session knows no finer figure;
//! - others move a Satrak and a Genius only: an RC2000C has one master on its line, and the
//!   panel of the simulated one does not jog;
//! - false flags are tried only on the two makes whose jogs run on and that others can move;
//! - a jog is not held to the keep-outs while its link is down: it goes on until STOP gets
//!   through. A motion to a position is.
//!
//! `judge.rs` judges by the true positions of the axes and by the words that the unit received,
//! `truth.rs` has its own geometry. Limits of these classes:
//!
//! - a jog is not held to the keep-outs while its angles are frozen, or while its link or its
//!   session is down: nobody can know where the antenna is;
//! - a unit that tracks by itself and reports wrong figures is held to the keep-outs, not to their
//!   margins.
//!
//! Each class prints its seed, how many cases it ran, and the processor time of the turns of its
//! sessions. `AZEL_SEED` repeats a run; a case that fails prints its own seed, and `AZEL_SEED=<that> AZEL_CASES=1` runs it
//! alone.

pub(crate) mod cases;
mod deeds;
mod judge;
mod line;
mod makes;
mod scene;
mod sky;
mod truth;
mod unit;
mod world;

mod clock_steps;
mod cuts;
mod damage;
mod frozen;
mod full_disk;
mod kills;
mod lies;
mod link_down;
mod link_up;
mod no_angle;
mod quiet;
mod reports;
mod retargets;
mod unread;
