//! What a mount can follow. Pure functions over sampled passes.

mod trackability;

pub use trackability::{Sample, Trackability, trackability};
