//! Properties of whole sessions that drive the simulated units in paused time, over random mounts,
//! limits, keep-outs, commands and troubles.
//!
//! The short form runs with all other tests. The long form is optimised, because a case is minutes
//! of simulated time:
//!
//! ```text
//! AZEL_CASES=10000 cargo test --release --test azel -- --nocapture safety_properties
//! ```
//!
//! It runs 10 000 cases in each of nineteen classes, and as many for each of three makes and six
//! rates of damage. This command runs one class with 5000 seeds from 1000000 on:
//!
//! ```text
//! AZEL_SEED=1000000 AZEL_CASES=5000 \
//!   cargo test --release --test azel -- --nocapture safety_properties::cuts
//! ```
//!
//! This command runs the gate alone, with ten times as many cases:
//!
//! ```text
//! AZEL_CASES=10000 cargo test --release --lib -- --nocapture any_motion_that_is_allowed
//! ```
//!
//! Limits of the properties:
//!
//! - The tests compare an angle to within half a step of the reported figures plus the overshoot of
//!   the drives. This sum is 0.15 degrees for a Satrak, 2.6 for a Genius in whole degrees, and 0.3
//!   for an RC2000C. The session knows no finer figure.
//! - Others move only a Satrak and a Genius. An RC2000C has one master on its line, and the panel
//!   of the simulated one does not jog.
//! - The tests try false flags only on the two makes whose jogs run on and that others can move.
//! - A jog may enter a keep-out while its link is down, because it goes on until STOP gets through.
//!   A motion to a position may not.
//!
//! `judge.rs` judges by the true positions of the axes and by the requests that the unit received;
//! `truth.rs` has its own geometry. Limits of these classes:
//!
//! - A jog may enter a keep-out while its angles are frozen, or while its link or its session is
//!   down. Nobody can know the position of the antenna then.
//! - A unit that tracks on its own and reports wrong figures may enter the margin of a keep-out,
//!   but not the keep-out.
//!
//! Each class prints its seed, the number of cases that it ran, and the processor time of the turns
//! of its sessions. `AZEL_SEED` repeats a run. A failing case prints its own seed, and
//! `AZEL_SEED=<that> AZEL_CASES=1` runs it alone.

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
