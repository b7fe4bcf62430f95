//! Search of the catalog for an object, by its number or a part of its name.

use std::sync::Arc;

use crate::orbit::{Catalog, Elements};

/// Max number of objects that a search shows.
const FOUND: usize = 40;

/// Text to search for, and the objects found.
#[derive(Default)]
pub(super) struct ObjectSearch {
    pub(super) typed: String,
    found: Option<Found>,
}

struct Found {
    catalog: Arc<Catalog>,
    typed: String,
    objects: Vec<(u32, String)>,
}

impl ObjectSearch {
    /// Returns the catalog numbers and names of the found objects.
    pub(super) fn objects(&mut self, catalog: &Arc<Catalog>) -> &[(u32, String)] {
        let is_known =
            |found: &Found| Arc::ptr_eq(&found.catalog, catalog) && found.typed == self.typed;
        let found = self.found.take().filter(is_known).unwrap_or_else(|| Found {
            catalog: Arc::clone(catalog),
            typed: self.typed.clone(),
            objects: catalog.search(self.typed.trim(), FOUND).into_iter().map(named).collect(),
        });
        &self.found.insert(found).objects
    }
}

/// Returns the catalog number and name of an object.
pub(super) fn named(elements: &Elements) -> (u32, String) {
    let name = if elements.name().is_empty() { "No name" } else { elements.name() };
    (elements.catalog_number(), name.to_owned())
}
