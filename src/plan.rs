//! What a mount can follow, and lists of passes for others to read. Pure
//! functions over passes.

pub mod pass_export;
mod trackability;

pub use trackability::{Sample, Trackability, trackability};
