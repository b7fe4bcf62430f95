//! Properties of whole sessions that drive the simulated units in paused time, over
//! random mounts, limits, keep-outs, commands and troubles.
//!
//! The short form runs with all other tests. The long form, with the cases of the
//! gate alone:
//!
//! ```text
//! AZEL_CASES=10000 cargo test --release --lib --test safety_properties -- --nocapture any_
//! ```
//!
//! Each class prints its seed and how many cases it ran. `AZEL_SEED` repeats a run;
//! a case that fails prints its own seed, and `AZEL_SEED=<that> AZEL_CASES=1` runs it
//! alone.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may end here"
)]

#[path = "safety_properties/damage.rs"]
mod damage;
#[path = "safety_properties/lies.rs"]
mod lies;
#[path = "safety_properties/link_down.rs"]
mod link_down;
#[path = "safety_properties/link_up.rs"]
mod link_up;
#[path = "safety_properties/world.rs"]
mod world;
