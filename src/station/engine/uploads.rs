//! Uploads of element files to units: one upload or roll-back at a time, from the choice of
//! satellites until the unit reports that it has found them.
//!
//! Invariants: nothing counts as proved before the file was read back in its place and the
//! unit has named the satellite in it; slow work runs on threads of its own; no secret is
//! in the displayed state.

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
