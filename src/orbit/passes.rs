//! When a satellite stands above the horizon of a site.

mod search;

use jiff::Timestamp;

use super::Propagator;
use crate::astro::{Angle, AzEl, Site, time};

/// Time and direction of one point of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassPoint {
    /// When, UTC.
    pub time: Timestamp,
    /// Where in the sky.
    pub direction: AzEl,
}

/// One stay above the horizon within a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// Acquisition of signal: where the satellite comes up, or the start of the window.
    pub aos: PassPoint,
    /// The greatest elevation from AOS to LOS.
    pub tca: PassPoint,
    /// Loss of signal: where the satellite goes down, or the end of the window.
    pub los: PassPoint,
    /// The satellite stands above the horizon when the window starts.
    pub starts_before: bool,
    /// The satellite stands above the horizon when the window, or its orbit, ends.
    pub ends_after: bool,
}

impl Pass {
    /// The greatest elevation from AOS to LOS.
    pub fn max_elevation(&self) -> Angle {
        self.tca.direction.elevation
    }

    /// From AOS to LOS in seconds.
    pub fn duration_s(&self) -> f64 {
        time::seconds_between(self.aos.time, self.los.time)
    }
}

/// All passes of a satellite over `site` from `from` to `to`, in order: the
/// longest stretches with an elevation of `horizon` or more, cut at the window
/// and marked where they are. AOS and LOS are exact to a millisecond.
///
/// The search ends quietly where the object decays. Once `cancelled` says so it
/// ends too; the passes found until then are returned.
pub fn passes(
    propagator: &Propagator,
    site: Site,
    from: Timestamp,
    to: Timestamp,
    horizon: Angle,
    cancelled: &dyn Fn() -> bool,
) -> Vec<Pass> {
    search::run(propagator, site, from, to, horizon, cancelled)
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::orbit::{bundled, read_elements};

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

    /// Passes over Istanbul in `hours` from the start.
    fn search(propagator: &Propagator, hours: f64, horizon_deg: f64) -> Vec<Pass> {
        let to = time::add_seconds(start(), hours * 3600.0);
        let horizon = Angle::from_degrees(horizon_deg);
        passes(propagator, istanbul(), start(), to, horizon, &|| false)
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
        let from = time::add_seconds(whole.aos.time, 60.0);
        let to = time::add_seconds(whole.los.time, -60.0);
        let cut = passes(&iss, istanbul(), from, to, Angle::ZERO, &|| false);
        assert_eq!(cut.len(), 1);
        assert!(cut[0].starts_before && cut[0].ends_after);
        assert_eq!((cut[0].aos.time, cut[0].los.time), (from, to));
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
        let asked = Cell::new(0);
        let to = time::add_seconds(start(), 1e9);
        let cancelled = || {
            asked.set(asked.get() + 1);
            asked.get() > 3
        };
        let iss = propagator(ISS);
        passes(&iss, istanbul(), start(), to, Angle::ZERO, &cancelled);
        assert_eq!(asked.get(), 4);
    }

    #[test]
    fn a_decay_ends_the_search_quietly() {
        // AIAA 2006-6753: lost in under 420 minutes.
        let text = "1 29141U 85108AA  06170.26783845  .99999999  00000-0  13519-0 0   718\n\
                    2 29141  82.4288 273.4882 0015848 277.2124  83.9133 15.93343074  6828\n";
        let elements = &read_elements(text).elements[0];
        let propagator = Propagator::new(elements).unwrap();
        let to = time::add_seconds(elements.epoch(), 10.0 * time::DAY_S);
        let pole = Site::new(90.0, 0.0, 0.0).unwrap();
        let found = passes(&propagator, pole, elements.epoch(), to, Angle::ZERO, &|| false);
        let end = time::add_seconds(elements.epoch(), 420.0 * 60.0);
        // One pass a revolution of 87 minutes, the first 20 minutes after the epoch.
        assert_eq!(found.len(), 5);
        assert!(found.iter().all(|pass| pass.los.time < end));
    }
}
