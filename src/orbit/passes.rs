//! Passes: the times at which a satellite is above the AOS elevation of a site.
//!
//! The search is geometric. With refraction in the passes of a site, it looks for the geometric
//! elevations of the apparent elevations, because both rise together. Each point gets its apparent
//! direction when it is stored.
//!
//! [`near_circular`] (`search.rs`, `edges`) finds AOS and LOS for near-circular orbits, and
//! [`sampled`] (`reach`) for all others. Both use `LocalSeries::crossing` (`local_series.rs`), or
//! halving in `Track::crossing` if that does not converge.

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

/// Number of satellites in the batch of one thread.
const BATCH: usize = 64;

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PassPoint {
    /// Time of the point, UTC.
    pub time: Timestamp,
    /// Geometric direction; apparent if the site has refraction in its passes.
    pub direction: AzEl,
}

/// One period above the horizon within a window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Acquisition of signal: rise of the satellite, or the start of the window.
    pub aos: PassPoint,
    /// Point of the max elevation from AOS to LOS.
    pub tca: PassPoint,
    /// Loss of signal: set of the satellite, or the end of the window.
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

/// Parameters of a search for passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassSearch {
    pub site: Site,
    /// Start of the window.
    pub start: Timestamp,
    /// End of the window.
    pub end: Timestamp,
    /// Elevation of AOS and LOS, -90 to 90 degrees.
    pub aos_elevation: Angle,
    /// Min of the greatest elevation within the window; lower passes are left out. A higher floor
    /// takes less computation.
    pub floor: Angle,
}

impl PassSearch {
    /// Creates a search for all passes over the horizon of `site` from `start` to `end`.
    pub fn new(site: Site, start: Timestamp, end: Timestamp) -> Self {
        Self { site, start, end, aos_elevation: Angle::ZERO, floor: Angle::ZERO }
    }
}

/// Returns all passes of a satellite, in order: the longest stretches with at least the elevation
/// of AOS. The window cuts passes, and each cut is marked. AOS and LOS are exact to a millisecond.
///
/// The search ends without an error if the object decays. It also ends once `cancelled` returns
/// `true`, and returns the passes found until then.
pub fn passes(
    propagator: &Propagator,
    search: &PassSearch,
    cancelled: &dyn Fn() -> bool,
) -> Vec<Pass> {
    passes_and_effort(propagator, search, cancelled).0
}

/// Returns the same as [`passes`], with the number of computed states of the satellite.
pub fn passes_and_effort(
    propagator: &Propagator,
    search: &PassSearch,
    cancelled: &dyn Fn() -> bool,
) -> (Vec<Pass>, u64) {
    let of_one = |window| passes_in(&window, &[propagator], 0, cancelled);
    let (found, effort) = Window::new(search).map(of_one).unwrap_or_default();
    (found.into_iter().map(Pass::from).collect(), effort)
}

/// Returns the passes of many satellites, each with the index of its satellite, ordered by
/// satellite, then by time.
///
/// The threads of the caller's rayon pool share the work. The search calls `progress` from time to
/// time with the number of completed satellites. Once `cancelled` returns `true`, the search ends
/// and returns the passes found until then.
pub fn passes_of_all<P: Borrow<Propagator> + Sync>(
    propagators: &[P],
    search: &PassSearch,
    progress: &(dyn Fn(usize) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) -> impl Iterator<Item = (usize, Pass)> + use<P> {
    found_passes(propagators, search, progress, cancelled).into_passes()
}

/// Returns the same as [`passes_of_all`] in a compact form.
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

/// Returns the passes of a few satellites, of which the first has the index `first`, and the number
/// of computed states. The function is not generic, so that this package compiles and optimises it.
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
        // Geosynchronous satellites below the horizon need no search.
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

    /// Returns the passes over Istanbul in the first `hours` from the start.
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
        // Source: AIAA 2006-6753. The object is lost in under 420 minutes.
        let text = "1 29141U 85108AA  06170.26783845  .99999999  00000-0  13519-0 0   718\n\
                    2 29141  82.4288 273.4882 0015848 277.2124  83.9133 15.93343074  6828\n";
        let elements = &read_elements(text).elements[0];
        let propagator = Propagator::new(elements).unwrap();
        let window_end = time::add_seconds(elements.epoch(), 10.0 * time::DAY_S);
        let pole = Site::new(90.0, 0.0, 0.0).unwrap();
        let found =
            passes(&propagator, &PassSearch::new(pole, elements.epoch(), window_end), &|| false);
        let end = time::add_seconds(elements.epoch(), 420.0 * 60.0);
        // The object has one pass per revolution of 87 minutes, the first 20 minutes after the
        // epoch.
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
        // The numbers are near-earth orbits that drag brings down within weeks, and two orbits of
        // twelve hours with a perigee in the atmosphere.
        let numbers = [43_881, 46_582, 48_924, 49_176, 52_445, 53_500, 57_956, 26_410, 26_464];
        for number in numbers {
            let propagator = propagator(number);
            for days in [60.0, 100.0, 140.0] {
                let time_at =
                    |hours: f64| time::add_seconds(start(), days * time::DAY_S + hours * 3600.0);
                // A caller that only asks for states uses such steps.
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
