//! A rehearsal of the plan as its view shows it.

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

/// Largest difference in AOS of one pass between the list and the rehearsal, seconds.
const SAME_AOS_S: f64 = 60.0;

/// The last rehearsal of this window.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum RehearsalState {
    #[default]
    None,
    /// It has come to this share, 0 to 1.
    UnderWay(f64),
    Done {
        rehearsed: Arc<Rehearsed>,
        time: Timestamp,
    },
    Failed(String),
}

impl Model {
    /// Returns the outcome of a pass in the rehearsal; two where it is handed over.
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
