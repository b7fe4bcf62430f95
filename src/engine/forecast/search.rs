//! The search for the passes of a list. Runs on a thread of its own and shares
//! the work with the pool.

use std::sync::{Arc, atomic::Ordering};

use jiff::Timestamp;
use rayon::prelude::*;

use super::{
    listing::Progress,
    outlook::{Followed, Forecast, Vantage},
};
use crate::{
    astro::{Angle, time::add_seconds},
    job::Wake,
    orbit::{Catalog, Elements, PassSearch, Propagator, passes_of_all},
};

/// A pass that is under way has begun this long ago at most, but for those of
/// satellites that hardly move.
const LOOK_BACK_S: f64 = 3600.0;
/// The station is told of the progress in so many steps.
const STEPS: usize = 100;

/// Whose passes a list holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Whose {
    /// These, in this order.
    Favourites(Vec<u32>),
    /// All of the catalog.
    All,
}

/// What a list of passes is made from.
#[derive(Clone)]
pub(super) struct Basis {
    pub(super) catalog: Arc<Catalog>,
    pub(super) whose: Whose,
    pub(super) vantage: Arc<Vantage>,
    pub(super) floor: Angle,
    pub(super) span_h: u32,
}

impl PartialEq for Basis {
    fn eq(&self, other: &Self) -> bool {
        self.has_satellites_of(other)
            && self.vantage == other.vantage
            && self.floor == other.floor
            && self.span_h == other.span_h
    }
}

impl Basis {
    /// Whether the satellites are the same, with the same elements.
    pub(super) fn has_satellites_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.catalog, &other.catalog) && self.whose == other.whose
    }

    fn satellites(&self) -> Vec<Arc<Followed>> {
        match &self.whose {
            Whose::Favourites(numbers) => {
                let known = numbers.iter().filter_map(|number| self.catalog.get(*number));
                known.filter_map(prepared).collect()
            }
            Whose::All => {
                let all: Vec<&Elements> = self.catalog.iter().collect();
                all.into_par_iter().filter_map(prepared).collect()
            }
        }
    }
}

fn prepared(elements: &Elements) -> Option<Arc<Followed>> {
    match Propagator::new(elements) {
        Ok(propagator) => Some(Arc::new(Followed { elements: elements.clone(), propagator })),
        Err(error) => {
            tracing::warn!(number = elements.catalog_number(), %error, "cannot be propagated");
            None
        }
    }
}

/// What a search has found.
pub(super) struct Found {
    pub(super) satellites: Arc<Vec<Arc<Followed>>>,
    pub(super) passes: Vec<Forecast>,
}

/// Searches from `now` on. `satellites`: those of `basis`, when they are
/// prepared already.
pub(super) fn search(
    basis: &Basis,
    satellites: Option<Arc<Vec<Arc<Followed>>>>,
    now: Timestamp,
    progress: &Progress,
    wake: &Wake,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Found {
    let satellites = satellites.unwrap_or_else(|| Arc::new(basis.satellites()));
    progress.of.store(satellites.len(), Ordering::Relaxed);
    let vantage = &basis.vantage;
    let span_s = f64::from(basis.span_h) * 3600.0;
    let (from, to) = (add_seconds(now, -LOOK_BACK_S), add_seconds(now, span_s));
    let window = PassSearch {
        aos_elevation: vantage.horizon,
        floor: basis.floor,
        ..PassSearch::new(vantage.site, from, to)
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
    let mut passes: Vec<Forecast> = passes_of_all(&propagators, &window, &tell, cancelled)
        .filter(|(_, pass)| pass.los.time > now)
        .filter_map(|(index, pass)| {
            let satellite = Arc::clone(satellites.get(index)?);
            Some(Forecast::new(satellite, pass, Arc::clone(vantage)))
        })
        .collect();
    let is_all = basis.whose == Whose::All;
    // Hundreds that never set would hide the first pass of a whole catalogue.
    let is_late = |forecast: &Forecast| is_all && forecast.is_always_up();
    passes
        .par_sort_by_key(|forecast| (is_late(forecast), forecast.pass.aos.time, forecast.number()));
    if !is_all {
        // All of them stand in the strip from the first frame on.
        passes.par_iter().for_each(|forecast| {
            forecast.path();
        });
    }
    Found { satellites, passes }
}
