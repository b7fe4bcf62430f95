//! Passes: the times in which a satellite is above the AOS elevation of a site.
//!
//! The search is geometric. With refraction in the passes of a site, it looks for the geometric
//! elevations that belong to the apparent ones, because the latter rise with the former; each
//! point gets its apparent direction when it is kept.
//!
//! AOS and LOS are found by [`near_circular`] (`search.rs`, `edges`) for near-circular orbits and
//! by [`sampled`] (`reach`) for all others; both by `LocalSeries::crossing`
//! (`local_series.rs`), or by halving in `Track::crossing` where that does not settle.

mod compact;
mod geosynchronous;
mod local_series;
mod mask;
mod near_circular;
mod sampled;
mod sighting;
mod track;
mod two_body;
mod window;

use std::{
    borrow::Borrow,
    sync::atomic::{AtomicUsize, Ordering},
};

use jiff::Timestamp;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use self::{compact::CompactPass, near_circular::NearCircular, track::Track, window::Window};
pub use self::{compact::FoundPasses, mask::clear_stretches};
use super::Propagator;
use crate::astro::{Angle, AzEl, Site, time};

/// Number of satellites that one thread takes at a time.
const BATCH: usize = 64;

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PassPoint {
    /// In UTC.
    pub time: Timestamp,
    /// Geometric, or apparent where the site has refraction in its passes.
    pub direction: AzEl,
}

/// One period above the horizon within a window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Acquisition of signal: where the satellite rises, or the start of the window.
    pub aos: PassPoint,
    /// The greatest elevation from AOS to LOS.
    pub tca: PassPoint,
    /// Loss of signal: where the satellite sets, or the end of the window.
    pub los: PassPoint,
    /// The satellite is above the horizon when the window starts.
    pub starts_before: bool,
    /// The satellite is above the horizon when the window, or its orbit, ends.
    pub ends_after: bool,
}

impl Pass {
    pub fn max_elevation(&self) -> Angle {
        self.tca.direction.elevation
    }

    pub fn duration_s(&self) -> f64 {
        time::seconds_between(self.aos.time, self.los.time)
    }
}

/// The parameters of a search for passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassSearch {
    pub site: Site,
    /// Start of the window.
    pub start: Timestamp,
    /// End of the window.
    pub end: Timestamp,
    /// Elevation of AOS and LOS, -90 to 90 degrees.
    pub aos_elevation: Angle,
    /// Passes whose greatest elevation within the window stays below this are left out. A higher
    /// floor takes less computation.
    pub floor: Angle,
}

impl PassSearch {
    /// All passes over the horizon of `site` from `start` to `end`.
    pub fn new(site: Site, start: Timestamp, end: Timestamp) -> Self {
        Self { site, start, end, aos_elevation: Angle::ZERO, floor: Angle::ZERO }
    }
}

/// All passes of a satellite, in order: the longest stretches in which the elevation is that
/// of AOS or more, cut at the window and marked where they are cut. AOS and LOS are exact to
/// a millisecond.
///
/// The search ends without an error if the object decays. It also ends once `cancelled` returns
/// `true`; the passes found until then are returned.
pub fn passes(
    propagator: &Propagator,
    search: &PassSearch,
    cancelled: &dyn Fn() -> bool,
) -> Vec<Pass> {
    passes_and_effort(propagator, search, cancelled).0
}

/// Like [`passes`], with the number of states of the satellite that were computed.
pub fn passes_and_effort(
    propagator: &Propagator,
    search: &PassSearch,
    cancelled: &dyn Fn() -> bool,
) -> (Vec<Pass>, u64) {
    let of_one = |window| passes_in(&window, &[propagator], 0, cancelled);
    let (found, effort) = Window::new(search).map(of_one).unwrap_or_default();
    (found.into_iter().map(Pass::from).collect(), effort)
}

/// The passes of many satellites, each with the index of its satellite, ordered by
/// satellite, then by time.
///
/// The work is shared by the threads of the rayon pool in which this is called. `progress` is
/// called now and then with the number of satellites that are done. Once `cancelled` returns
/// `true`, the search ends; the passes found until then are returned.
pub fn passes_of_all<P: Borrow<Propagator> + Sync>(
    propagators: &[P],
    search: &PassSearch,
    progress: &(dyn Fn(usize) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) -> impl Iterator<Item = (usize, Pass)> + use<P> {
    found_passes(propagators, search, progress, cancelled).into_passes()
}

/// Like [`passes_of_all`], kept in little memory.
pub fn found_passes<P: Borrow<Propagator> + Sync>(
    propagators: &[P],
    search: &PassSearch,
    progress: &(dyn Fn(usize) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) -> FoundPasses {
    let done = AtomicUsize::new(0);
    let of_batch = |window: &Window, batch: usize, propagators: &[P]| {
        // An index takes less memory in each found pass than a reference would.
        let first = (batch * BATCH) as u32;
        let propagators: Vec<&Propagator> = propagators.iter().map(Borrow::borrow).collect();
        let (found, _) = passes_in(window, &propagators, first, cancelled);
        progress(done.fetch_add(propagators.len(), Ordering::Relaxed) + propagators.len());
        found
    };
    let of_all = |window: Window| {
        let batches = propagators.par_chunks(BATCH).enumerate();
        batches.map(|(batch, propagators)| of_batch(&window, batch, propagators)).collect()
    };
    FoundPasses::new(Window::new(search).map_or_else(Vec::new, of_all))
}

/// The passes of a few satellites, of which the first has the index `first`, and the number of
/// states computed. Not generic, so that the search is compiled and optimised in this package.
fn passes_in(
    window: &Window,
    propagators: &[&Propagator],
    first: u32,
    cancelled: &dyn Fn() -> bool,
) -> (Vec<CompactPass>, u64) {
    if cancelled() {
        return (Vec::new(), 0);
    }
    let indexed = propagators.iter().zip(first..);
    let tracks: Vec<Track<'_>> =
        indexed.map(|(propagator, index)| Track::new(window, index, propagator)).collect();
    let near_circular: Vec<Option<NearCircular<'_>>> =
        tracks.iter().map(NearCircular::new).collect();
    let mut found = near_circular::passes(window, near_circular.iter().flatten(), cancelled);
    for (track, near_circular) in tracks.iter().zip(&near_circular) {
        // Geosynchronous satellites below the horizon are ruled out without a search.
        if near_circular.is_none() && !cancelled() && !geosynchronous::never_rises(track) {
            sampled::passes(track, cancelled, &mut found);
        }
    }
    // The two searches added their passes one after the other.
    found.sort_by_key(|pass| pass.satellite);
    found.shrink_to_fit();
    (found, tracks.iter().map(Track::propagations).sum())
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::{PropagationError, bundled, read_elements};

    const ISS: u32 = 25_544;
    const METEOSAT_12: u32 = 54_743;

    fn istanbul() -> Site {
        Site::new(41.02, 29.17, 100.0).unwrap()
    }

    fn start() -> Timestamp {
        "2026-08-12T00:00:00Z".parse().unwrap()
    }

    fn propagator(number: u32) -> Propagator {
        Propagator::new(bundled().unwrap().get(number).unwrap()).unwrap()
    }

    /// Passes over Istanbul in the first `hours` from the start.
    fn search(propagator: &Propagator, hours: f64, aos_deg: f64) -> Vec<Pass> {
        let end = time::add_seconds(start(), hours * 3600.0);
        let aos_elevation = Angle::from_degrees(aos_deg);
        let search = PassSearch { aos_elevation, ..PassSearch::new(istanbul(), start(), end) };
        passes(propagator, &search, &|| false)
    }

    #[test]
    fn what_never_sets_is_one_pass_as_long_as_the_window() {
        let found = search(&propagator(METEOSAT_12), 48.0, 0.0);
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_before && found[0].ends_after);
        assert!((found[0].duration_s() - 172_800.0).abs() < 1e-6);
        assert!(search(&propagator(METEOSAT_12), 48.0, 60.0).is_empty());
    }

    #[test]
    fn a_window_within_a_pass_cuts_it_at_both_ends() {
        let iss = propagator(ISS);
        let whole = search(&iss, 24.0, 0.0)[0];
        let start = time::add_seconds(whole.aos.time, 60.0);
        let end = time::add_seconds(whole.los.time, -60.0);
        let cut = passes(&iss, &PassSearch::new(istanbul(), start, end), &|| false);
        assert_eq!(cut.len(), 1);
        assert!(cut[0].starts_before && cut[0].ends_after);
        assert_eq!((cut[0].aos.time, cut[0].los.time), (start, end));
        assert!(cut[0].aos.direction.elevation_deg() > 0.0);
    }

    #[test]
    fn an_empty_or_turned_window_holds_no_pass() {
        let satellite = propagator(METEOSAT_12);
        assert!(search(&satellite, 0.0, 0.0).is_empty());
        assert!(search(&satellite, -1.0, 0.0).is_empty());
    }

    #[test]
    fn a_cancelled_search_ends_at_once() {
        let calls = Cell::new(0);
        let end = time::add_seconds(start(), 1e9);
        let cancelled = || {
            calls.set(calls.get() + 1);
            calls.get() > 3
        };
        let iss = propagator(ISS);
        passes(&iss, &PassSearch::new(istanbul(), start(), end), &cancelled);
        assert!(calls.get() < 10, "{}", calls.get());
    }

    #[test]
    fn a_decay_ends_the_search_quietly() {
        // AIAA 2006-6753: lost in under 420 minutes.
        let text = "1 29141U 85108AA  06170.26783845  .99999999  00000-0  13519-0 0   718\n\
                    2 29141  82.4288 273.4882 0015848 277.2124  83.9133 15.93343074  6828\n";
        let elements = &read_elements(text).elements[0];
        let propagator = Propagator::new(elements).unwrap();
        let window_end = time::add_seconds(elements.epoch(), 10.0 * time::DAY_S);
        let pole = Site::new(90.0, 0.0, 0.0).unwrap();
        let found =
            passes(&propagator, &PassSearch::new(pole, elements.epoch(), window_end), &|| false);
        let end = time::add_seconds(elements.epoch(), 420.0 * 60.0);
        // One pass per revolution of 87 minutes, the first 20 minutes after the epoch.
        assert_eq!(found.len(), 5);
        assert!(found.iter().all(|pass| pass.los.time < end));
        // The equations continue and bring the object up again.
        for days in [1.0, 3.0, 9.0] {
            let start = time::add_seconds(elements.epoch(), days * time::DAY_S);
            let later = PassSearch::new(pole, start, time::add_seconds(start, 10.0 * time::DAY_S));
            assert_eq!(passes(&propagator, &later, &|| false), []);
            assert_eq!(propagator.state_at(start), Err(PropagationError::Decayed));
        }
    }

    #[test]
    fn what_has_come_down_before_the_window_has_no_pass() {
        // Near-earth orbits that drag brings down within weeks, and two of twelve hours whose
        // perigee is in the atmosphere.
        let numbers = [43_881, 46_582, 48_924, 49_176, 52_445, 53_500, 57_956, 26_410, 26_464];
        for number in numbers {
            let propagator = propagator(number);
            for days in [60.0, 100.0, 140.0] {
                let time_at =
                    |hours: f64| time::add_seconds(start(), days * time::DAY_S + hours * 3600.0);
                // In the steps of a caller that only asks for states.
                let mut before = (0..)
                    .map(|step| time::add_seconds(propagator.epoch(), f64::from(step) * 600.0));
                let is_down = before
                    .by_ref()
                    .take_while(|time| *time < time_at(0.0))
                    .any(|time| propagator.state_at(time).is_err());
                let search = PassSearch::new(istanbul(), time_at(0.0), time_at(24.0));
                let found = passes(&propagator, &search, &|| false);
                assert!(!is_down || found.is_empty(), "{number} +{days} d: {found:?}");
            }
        }
    }
}
