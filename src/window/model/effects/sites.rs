//! Predicted passes over a site whose settings the operator edits.

use std::sync::Arc;

use jiff::Timestamp;

use super::{Compare, PassTrack};
use crate::{
    astro::{
        Angle, Site,
        time::{add_seconds, seconds_between},
    },
    contract::passes::ListedSatellite,
    orbit::{PassSearch, passes},
    station::Station,
};

/// Time ahead in which Azel searches for passes, hours.
const AHEAD_H: f64 = 48.0;

/// A site with the elevations that decide its passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standpoint {
    pub site: Site,
    aos_elevation: Angle,
    floor: Angle,
}

impl Standpoint {
    pub fn new(station: &Station) -> Self {
        Self {
            site: station.site,
            aos_elevation: station.aos_elevation(),
            floor: station.elevation_floor(),
        }
    }
}

/// A question: the saved and the edited site.
#[derive(Debug, Clone)]
pub struct Question {
    /// Favourites whose passes the effect compares.
    pub satellites: Arc<Vec<Arc<ListedSatellite>>>,
    /// Start of the time in which passes count.
    pub start: Timestamp,
    pub before: Standpoint,
    pub after: Standpoint,
}

impl PartialEq for Question {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.satellites, &other.satellites)
            && self.start == other.start
            && self.before == other.before
            && self.after == other.after
    }
}

/// The passes over a site.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    pub count: usize,
    /// Total time from AOS to LOS of all passes, seconds.
    pub up_s: f64,
    /// The highest maximum elevation, degrees; zero without a pass.
    pub highest_deg: f64,
    pub first_aos: Option<Timestamp>,
}

impl Tally {
    fn new(standpoint: Standpoint, question: &Question) -> Self {
        let search = PassSearch {
            aos_elevation: standpoint.aos_elevation,
            floor: standpoint.floor,
            ..PassSearch::new(
                standpoint.site,
                question.start,
                add_seconds(question.start, AHEAD_H * 3600.0),
            )
        };
        let mut tally = Self::default();
        for satellite in question.satellites.iter() {
            for pass in passes(&satellite.propagator, &search, &|| false) {
                // A satellite that starts before and ends after the window hardly moves and has no
                // AOS.
                if pass.starts_before && pass.ends_after {
                    continue;
                }
                tally.count += 1;
                tally.up_s += seconds_between(pass.aos.time, pass.los.time);
                tally.highest_deg = tally.highest_deg.max(pass.max_elevation().degrees());
                let aos = Some(pass.aos.time).filter(|_| !pass.starts_before);
                tally.first_aos = match (tally.first_aos, aos) {
                    (Some(first), Some(aos)) => Some(first.min(aos)),
                    (first, aos) => first.or(aos),
                };
            }
        }
        tally
    }
}

impl Compare for Question {
    type Tally = Tally;
    /// Interval that skips all samples, because the tracks over another site differ.
    const EVERY: usize = usize::MAX;

    fn tallies(&self, _: &[PassTrack]) -> [Tally; 2] {
        [self.before, self.after].map(|standpoint| Tally::new(standpoint, self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::{Propagator, bundled};

    #[test]
    fn a_moved_site_and_a_higher_aos_have_other_passes() {
        let elements = bundled().unwrap().get(25_544).unwrap().clone();
        let start = elements.epoch();
        let propagator = Propagator::new(&elements).unwrap();
        let satellite = ListedSatellite { elements, propagator };
        let station = Station::default();
        let tallies = |station: &Station| {
            let question = Question {
                satellites: Arc::new(vec![Arc::new(ListedSatellite {
                    elements: satellite.elements.clone(),
                    propagator: satellite.propagator.clone(),
                })]),
                start,
                before: Standpoint::new(&Station::default()),
                after: Standpoint::new(station),
            };
            question.tallies(&[])
        };
        let [was, same] = tallies(&station);
        assert_eq!(was, same);
        assert!(was.count > 4 && was.up_s > 600.0 && was.highest_deg > 5.0, "{was:?}");
        let pole = Station { site: Site::new(89.0, 0.0, 0.0).unwrap(), ..Station::default() };
        assert_eq!(tallies(&pole)[1], Tally::default(), "the ISS is never up at the pole");
        let [was, new] = tallies(&Station { aos_elevation_deg: 20.0, ..station });
        assert!(new.up_s < was.up_s && new.first_aos > was.first_aos, "{was:?} {new:?}");
    }
}
