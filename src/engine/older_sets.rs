//! The older sets of the object that a client looks at, read from the library.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Engine;
use crate::{
    job::Job,
    library::{History, OlderSet},
};

/// The older sets of one object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OlderSets {
    pub catalog_number: u32,
    /// The newest first.
    pub sets: Vec<OlderSet>,
}

/// The reading of older sets.
#[derive(Default)]
pub(super) struct Reading {
    wanted: Option<u32>,
    job: Option<Job<OlderSets>>,
}

impl Engine {
    /// Reads the older sets of another object.
    pub(super) fn list_older_sets(&mut self, catalog_number: u32) {
        self.older_reading.wanted = Some(catalog_number);
        self.read_older_sets();
    }

    /// Reads the older sets of the same object anew.
    pub(super) fn read_older_sets(&mut self) {
        let Some(catalog_number) = self.older_reading.wanted else { return };
        let Some(folder) = self.places.library() else { return };
        let history = History::beside(folder);
        let job = Job::start("azel-older-sets", Arc::clone(&self.wake), move |_| OlderSets {
            catalog_number,
            sets: history.of(catalog_number),
        });
        self.older_reading.job =
            job.inspect_err(|error| tracing::error!(%error, "no thread for older sets")).ok();
    }

    pub(super) fn take_older_sets(&mut self) {
        if let Some(Ok(sets)) = Job::take(&mut self.older_reading.job) {
            self.older_sets = Some(Arc::new(sets));
        }
    }
}
