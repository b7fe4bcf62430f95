//! A rehearsal of the plan, as the plan view shows it.

use std::sync::Arc;

use jiff::Timestamp;

use super::Model;
use crate::{
    astro::time::seconds_between,
    contract::{
        passes::PassListKey,
        rehearsal::{Rehearsed, RehearsedPass},
    },
};

/// Max difference between the AOS of the same pass in the list and in the rehearsal, seconds.
const SAME_AOS_S: f64 = 60.0;

/// The last rehearsal of this window.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum RehearsalState {
    #[default]
    None,
    /// Progress of the current rehearsal, 0 to 1.
    UnderWay(f64),
    Done {
        rehearsed: Arc<Rehearsed>,
        time: Timestamp,
    },
    Failed(String),
}

impl Model {
    /// Returns the outcomes of a pass in the rehearsal: two outcomes if antennas hand the pass
    /// over.
    pub fn rehearsed(&self, key: PassListKey) -> impl Iterator<Item = &RehearsedPass> {
        let passes = match &self.rehearsal {
            RehearsalState::Done { rehearsed, .. } => &rehearsed.passes[..],
            _ => &[],
        };
        passes.iter().filter(move |rehearsed_pass| {
            rehearsed_pass.satellite == key.0
                && seconds_between(rehearsed_pass.aos, key.1).abs() < SAME_AOS_S
        })
    }
}
