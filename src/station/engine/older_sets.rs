//! Older element sets of the object that a client looks at, and older sets in use.

use std::{path::Path, sync::Arc};

use super::Engine;
use crate::{
    contract::older_sets::{OlderSets, SetChoice},
    job::Job,
    library::{Exceptions, History},
    orbit::Catalog,
};

/// Reading of older sets from the library.
#[derive(Default)]
pub(super) struct Reading {
    requested: Option<u32>,
    job: Option<Job<OlderSets>>,
}

impl Engine {
    /// Reads the older sets of another object.
    pub(super) fn list_older_sets(&mut self, catalog_number: u32) {
        self.older_reading.requested = Some(catalog_number);
        self.read_older_sets();
    }

    /// Reads the older sets of the same object again.
    pub(super) fn read_older_sets(&mut self) {
        let Some(catalog_number) = self.older_reading.requested else { return };
        let Some(folder) = self.places.library() else { return };
        let history = History::new(folder);
        let read = move |_: &(dyn Fn() -> bool + Sync)| OlderSets {
            catalog_number,
            sets: history.sets_of(catalog_number),
        };
        self.older_reading.job = Some(Job::start("azel-older-sets", Arc::clone(&self.wake), read));
    }

    pub(super) fn take_older_sets(&mut self) {
        if let Some(Ok(sets)) = Job::take(&mut self.older_reading.job) {
            self.older_sets = Some(Arc::new(sets));
        }
    }
}

/// Saves `choice` in the library, and applies the operator's older sets and the preferred sources
/// to `catalog`.
pub(super) fn use_older_sets(
    folder: &Path,
    choice: Option<SetChoice>,
    catalog: &mut Catalog,
) -> Result<(), String> {
    let mut exceptions = Exceptions::load(folder);
    let ended = exceptions.forget_ended(catalog);
    let chosen = choice.map_or(Ok(()), |choice| choose(choice, &mut exceptions, folder, catalog));
    exceptions.apply(catalog);
    catalog.apply_orders(|number| exceptions.has(number));
    chosen?;
    ended.map_err(|error| format!("the older sets in use are not kept: {error}"))
}

fn choose(
    choice: SetChoice,
    exceptions: &mut Exceptions,
    folder: &Path,
    catalog: &Catalog,
) -> Result<(), String> {
    let result = match choice {
        SetChoice::Older { catalog_number, epoch } => {
            let missing = || format!("{catalog_number}: the chosen set is not held any more");
            let newest = catalog.get(catalog_number).ok_or_else(missing)?.epoch();
            let older_sets = History::new(folder).sets_of(catalog_number);
            let set = older_sets.into_iter().find(|set| set.elements.epoch() == epoch);
            exceptions.begin(set.ok_or_else(missing)?, newest)
        }
        SetChoice::Newest { catalog_number } => exceptions.end(catalog_number),
    };
    result.map_err(|error| format!("the choice of a set is not kept: {error}"))
}
