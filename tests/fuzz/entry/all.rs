//! Functions to fuzz: each takes any bytes and panics if an invariant is broken. The fuzz
//! targets and the ordinary tests share them.

#![allow(
    dead_code,
    clippy::expect_used,
    clippy::indexing_slicing,
    reason = "each target uses one of them, and a panic is a finding"
)]

pub(crate) mod elements;
pub(crate) mod lists;
pub(crate) mod mask;
mod no_infinity;
pub(crate) mod rc2000c;
pub(crate) mod rotator_genius;
pub(crate) mod satrak;
pub(crate) mod station;

/// Function that feeds bytes to the code under test.
pub(crate) type Run = fn(&[u8]);

/// All functions, with the names of their targets and folders.
pub(crate) const ALL: [(&str, Run); 7] = [
    ("elements", elements::run),
    ("lists", lists::run),
    ("mask", mask::run),
    ("rc2000c", rc2000c::run),
    ("rotator_genius", rotator_genius::run),
    ("satrak", satrak::run),
    ("station", station::run),
];
