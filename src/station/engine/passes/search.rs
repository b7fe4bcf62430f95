//! Search for the passes of a list, on its own thread; the thread pool shares the work.

use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

use jiff::Timestamp;
use rayon::prelude::*;

use crate::{
    astro::{Angle, time::add_seconds},
    contract::passes::{ListedSatellite, Observer, PredictedPass},
    job::Wake,
    orbit::{Catalog, Elements, PassSearch, Propagator, passes_of_all},
};

/// Time before now at which the search starts, seconds. A pass under way began later, except with
/// satellites that hardly move.
const LOOK_BACK_S: f64 = 3600.0;
/// Number of progress reports to the station.
const STEPS: usize = 100;

/// Satellites to search passes for.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SearchScope {
    /// Satellites with these catalog numbers, in this order.
    Favourites(Arc<[u32]>),
    /// All satellites of the catalog.
    All,
}

/// All inputs of a pass list, except the time.
#[derive(Clone)]
pub(super) struct SearchKey {
    pub(super) catalog: Arc<Catalog>,
    pub(super) scope: SearchScope,
    pub(super) observer: Arc<Observer>,
    pub(super) floor: Angle,
    pub(super) span_h: u32,
}

impl PartialEq for SearchKey {
    fn eq(&self, other: &Self) -> bool {
        self.has_satellites_of(other)
            && (Arc::ptr_eq(&self.observer, &other.observer) || self.observer == other.observer)
            && self.floor == other.floor
            && self.span_h == other.span_h
    }
}

impl SearchKey {
    /// Returns `true` if the other key has the same satellites with the same elements.
    pub(super) fn has_satellites_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.catalog, &other.catalog) && self.scope == other.scope
    }

    fn satellites(&self) -> Vec<Arc<ListedSatellite>> {
        match &self.scope {
            SearchScope::Favourites(numbers) => {
                let elements = numbers.iter().filter_map(|number| self.catalog.get(*number));
                elements.filter_map(prepared).collect()
            }
            SearchScope::All => {
                let all: Vec<&Elements> = self.catalog.iter().collect();
                all.into_par_iter().filter_map(prepared).collect()
            }
        }
    }
}

pub(super) fn prepared(elements: &Elements) -> Option<Arc<ListedSatellite>> {
    match Propagator::new(elements) {
        Ok(propagator) => {
            Some(Arc::new(ListedSatellite { elements: elements.clone(), propagator }))
        }
        Err(error) => {
            tracing::warn!(number = elements.catalog_number(), %error, "cannot be propagated");
            None
        }
    }
}

/// Progress of a search, written by its threads.
#[derive(Default)]
pub(super) struct Progress {
    pub(super) done: AtomicUsize,
    pub(super) total: AtomicUsize,
}

/// Result of a search.
pub(super) struct Found {
    pub(super) satellites: Arc<Vec<Arc<ListedSatellite>>>,
    pub(super) passes: Vec<PredictedPass>,
}

/// Searches for passes from `now` on. `satellites` are the prepared satellites of `key`, if known.
pub(super) fn search(
    key: &SearchKey,
    satellites: Option<Arc<Vec<Arc<ListedSatellite>>>>,
    now: Timestamp,
    progress: &Progress,
    wake: &Wake,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Found {
    let satellites = satellites.unwrap_or_else(|| Arc::new(key.satellites()));
    progress.total.store(satellites.len(), Ordering::Relaxed);
    let observer = &key.observer;
    let span_s = f64::from(key.span_h) * 3600.0;
    let (start, end) = (add_seconds(now, -LOOK_BACK_S), add_seconds(now, span_s));
    let window = PassSearch {
        aos_elevation: observer.aos_elevation,
        floor: key.floor,
        ..PassSearch::new(observer.site, start, end)
    };
    let step = (satellites.len() / STEPS).max(1);
    let tell = |done: usize| {
        let before = progress.done.fetch_max(done, Ordering::Relaxed);
        if before / step < done / step {
            wake();
        }
    };
    let propagators: Vec<&Propagator> =
        satellites.iter().map(|satellite| &satellite.propagator).collect();
    let mut passes: Vec<PredictedPass> = passes_of_all(&propagators, &window, &tell, cancelled)
        .filter(|(_, pass)| pass.los.time > now)
        .filter_map(|(index, pass)| {
            let satellite = Arc::clone(satellites.get(index)?);
            Some(PredictedPass::new(satellite, pass, Arc::clone(observer)))
        })
        .collect();
    // Sort satellites that never set last: they would hide the first pass.
    passes.par_sort_by_key(|predicted| {
        let is_always_up = predicted.is_always_up();
        let aos = (!is_always_up).then_some(predicted.pass.aos.time);
        (is_always_up, aos, predicted.number())
    });
    Found { satellites, passes }
}
