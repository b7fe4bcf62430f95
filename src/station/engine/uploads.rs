//! Uploads of element files to units. One upload or roll-back runs at a time, from the choice of
//! satellites until the unit reports that it has found them.
//!
//! Invariants: an upload counts as proved only after Azel has read the file back in its place and
//! the unit has named the satellite in it. Slow work runs on its own threads. The displayed state
//! contains no secret.

mod errand;
mod flow;
mod order;
mod places;
mod runner;
mod select;
mod sessions;

use crate::contract::{
    transfer::OldAlgorithm,
    uploads::{Uploads, Warning},
};
pub(super) use order::UploadTarget;
pub use places::Places;
pub(super) use runner::{Runner, SessionRequest};
pub(super) use select::UnitNow;

/// Returns the old algorithms that the last order used.
pub(super) fn old_algorithms(uploads: &Uploads) -> &[OldAlgorithm] {
    let old = uploads.warnings.iter().find_map(|warning| match warning {
        Warning::OldAlgorithms(list) => Some(list.as_slice()),
        Warning::FactoryPassword | Warning::NotKept(_) => None,
    });
    old.unwrap_or_default()
}
