//! Predicted passes, computed in the background.

mod list;
mod search;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use jiff::Timestamp;

use self::{
    list::Search,
    search::{SearchKey, SearchScope},
};
use crate::{
    contract::passes::{ListChoice, Observer, PassList, PassLists, Scope},
    job::Wake,
    orbit::{Catalog, Elements},
    station::Station,
};

/// Min span of the favourites' passes, hours; the strip shows this span for any list.
const FAVOURITES_H: u32 = 48;

/// Searches for the pass lists.
#[derive(Default)]
pub(in crate::engine) struct Searches {
    favourites: Search,
    all: Search,
    /// Station and search key of the favourites.
    key: Option<(Arc<Station>, SearchKey)>,
}

impl Searches {
    /// Collects found passes, and starts the searches that are needed.
    pub(in crate::engine) fn refresh(
        &mut self,
        catalog: &Arc<Catalog>,
        station: &Arc<Station>,
        choice: ListChoice,
        now: Timestamp,
        wake: &Wake,
    ) {
        let key = self.key_of_favourites(catalog, station);
        self.favourites.refresh(&key, now, wake);
        let key = SearchKey { scope: SearchScope::All, span_h: choice.all_h, ..key };
        match choice.scope {
            Scope::All => self.all.refresh(&key, now, wake),
            Scope::Favourites => self.all.keep_only_from(&key),
        }
    }

    /// Returns the key of the favourites; a changed catalog or station makes a new key.
    fn key_of_favourites(&mut self, catalog: &Arc<Catalog>, station: &Arc<Station>) -> SearchKey {
        let is_of = |(searched, key): &(Arc<Station>, SearchKey)| {
            Arc::ptr_eq(searched, station) && Arc::ptr_eq(&key.catalog, catalog)
        };
        let previous = self.key.take().filter(is_of);
        let previous = previous
            .unwrap_or_else(|| (Arc::clone(station), SearchKey::of_favourites(catalog, station)));
        let key = previous.1.clone();
        self.key = Some(previous);
        key
    }

    pub(in crate::engine) fn shown(&self) -> PassLists {
        PassLists { favourites: self.favourites.shown(), all: self.all.shown() }
    }

    pub(in crate::engine) fn of_mut(&mut self, scope: Scope) -> &mut Search {
        match scope {
            Scope::Favourites => &mut self.favourites,
            Scope::All => &mut self.all,
        }
    }

    /// Returns `true` if the last search of a list broke off.
    pub(in crate::engine) fn broke_off(&self) -> bool {
        self.favourites.broke_off() || self.all.broke_off()
    }
}

/// Predicts the favourites' lists again as they were at `made_at`.
pub(in crate::engine) fn again(
    catalog: &Arc<Catalog>,
    elements: &[Elements],
    station: &Station,
    made_at: Option<Timestamp>,
) -> PassLists {
    let key = SearchKey::of_favourites(catalog, station);
    PassLists { favourites: list::again(&key, elements, made_at), all: PassList::default() }
}

impl SearchKey {
    fn of_favourites(catalog: &Arc<Catalog>, station: &Station) -> Self {
        Self {
            catalog: Arc::clone(catalog),
            scope: SearchScope::Favourites(station.favourites.numbers().into()),
            observer: Arc::new(Observer::from_station(station)),
            floor: station.elevation_floor(),
            span_h: FAVOURITES_H.max(station.scheduling.span_h.ceil() as u32),
        }
    }
}
