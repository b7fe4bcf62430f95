//! Predicted passes, computed in the background.

mod choice;
mod list;
mod predicted_pass;
mod search;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub use self::{
    choice::{ListChoice, SPANS_H, Scope},
    list::{PassList, UpcomingPasses, Work},
    predicted_pass::{ListedSatellite, Observer, PredictedPass, mount_limits},
};
use self::{
    list::Search,
    search::{SearchKey, SearchScope},
};
use crate::{
    astro::{Angle, AzEl, frames::SiteFrame, time::add_seconds},
    job::Wake,
    orbit::{Catalog, Elements},
    station::Station,
};

/// Hours ahead for the passes of the favourites at least: the strip shows this much, whatever
/// the list shows.
const FAVOURITES_H: u32 = 48;

/// Key of a pass: catalog number of the satellite and AOS.
pub type PassKey = (u32, Timestamp);

/// The pass lists.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct PassLists {
    /// Passes of the favourites.
    pub favourites: PassList,
    /// Passes of all satellites, searched for when the operator wants the list.
    pub all: PassList,
}

/// The searches for the pass lists.
#[derive(Default)]
pub(in crate::engine) struct Searches {
    favourites: Search,
    all: Search,
    /// The key of the favourites, with the station that it is of.
    key: Option<(Arc<Station>, SearchKey)>,
}

impl Searches {
    /// Takes the passes that were found, and begins the searches that are needed.
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

    /// Made anew where the catalog or the station is another.
    fn key_of_favourites(&mut self, catalog: &Arc<Catalog>, station: &Arc<Station>) -> SearchKey {
        let is_of = |(of, key): &(Arc<Station>, SearchKey)| {
            Arc::ptr_eq(of, station) && Arc::ptr_eq(&key.catalog, catalog)
        };
        let known = self.key.take().filter(is_of);
        let known = known
            .unwrap_or_else(|| (Arc::clone(station), SearchKey::of_favourites(catalog, station)));
        let key = known.1.clone();
        self.key = Some(known);
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

impl SearchKey {
    fn of_favourites(catalog: &Arc<Catalog>, station: &Station) -> Self {
        Self {
            catalog: Arc::clone(catalog),
            scope: SearchScope::Favourites(station.favourites.numbers().into()),
            observer: Arc::new(Observer::of(station)),
            floor: station.elevation_floor(),
            span_h: FAVOURITES_H.max(station.scheduling.span_h.ceil() as u32),
        }
    }
}

impl PassLists {
    /// The lists that were made at `made_at` of these elements of the favourites, predicted anew.
    pub(in crate::engine) fn again(
        catalog: &Arc<Catalog>,
        elements: &[Elements],
        station: &Station,
        made_at: Option<Timestamp>,
    ) -> Self {
        let key = SearchKey::of_favourites(catalog, station);
        Self { favourites: PassList::again(&key, elements, made_at), all: PassList::default() }
    }

    pub fn of(&self, scope: Scope) -> &PassList {
        match scope {
            Scope::Favourites => &self.favourites,
            Scope::All => &self.all,
        }
    }

    /// The pass of `key`, first among the favourites.
    pub fn find(&self, key: PassKey) -> Option<&PredictedPass> {
        self.favourites.find(key).or_else(|| self.all.find(key))
    }

    /// The pass of a favourite that is under way or comes next; geosynchronous satellites
    /// only if there is no other.
    pub fn next(&self, now: Timestamp) -> Option<&PredictedPass> {
        let moving = |predicted: &&PredictedPass| !predicted.satellite.elements.is_geosynchronous();
        let passes = self.favourites.upcoming(now);
        passes.iter().find(moving).or_else(|| passes.iter().next())
    }

    /// The satellite with this catalog number, if a list has it.
    pub fn satellite(&self, catalog_number: u32) -> Option<&Arc<ListedSatellite>> {
        let number = |known: &Arc<ListedSatellite>| known.elements.catalog_number();
        let followed = &self.favourites.satellites;
        followed.iter().find(|known| number(known) == catalog_number).or_else(|| {
            let all = &self.all.satellites;
            let place = all.binary_search_by_key(&catalog_number, number).ok()?;
            all.get(place)
        })
    }
}

/// Directions of a satellite while it is up in the next `span_s`, in steps of 30 s.
pub fn ahead(
    satellite: &ListedSatellite,
    site: &SiteFrame,
    now: Timestamp,
    span_s: f64,
) -> Vec<AzEl> {
    let steps = (span_s / 30.0) as usize;
    let times: Vec<_> = (0..=steps).map(|step| add_seconds(now, step as f64 * 30.0)).collect();
    let states = satellite.propagator.states_at(&times);
    let directions = states.into_iter().zip(times).map_while(|(state, at)| {
        let direction = site.direction(state?.local(site, at).position_km);
        (direction.elevation > Angle::ZERO).then_some(direction)
    });
    directions.collect()
}
