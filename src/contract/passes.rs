//! The pass lists of a station.

mod choice;
mod list;
mod predicted_pass;
mod window;

use std::sync::Arc;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub use self::{
    choice::{ListChoice, SPANS_H, Scope},
    list::{PassList, UpcomingPasses, Work},
    predicted_pass::{ListedSatellite, Observer, PredictedPass, mount_limits},
    window::{whole_seconds, window},
};
use crate::astro::{Angle, AzEl, frames::SiteFrame, time::add_seconds};

/// Key of a pass: catalog number of the satellite and AOS.
pub type PassListKey = (u32, Timestamp);

/// Pass lists of a station: one for the favourites, one for all satellites.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct PassLists {
    /// Passes of the favourites.
    pub favourites: PassList,
    /// Passes of all satellites; the search runs when the operator opens the list.
    pub all: PassList,
}

impl PassLists {
    pub fn list(&self, scope: Scope) -> &PassList {
        match scope {
            Scope::Favourites => &self.favourites,
            Scope::All => &self.all,
        }
    }

    /// Returns the pass with `key`; the favourites come first.
    pub fn find(&self, key: PassListKey) -> Option<&PredictedPass> {
        self.favourites.find(key).or_else(|| self.all.find(key))
    }

    /// Returns the current or next pass of a favourite. A geosynchronous satellite counts only if
    /// there is no other pass.
    pub fn next(&self, now: Timestamp) -> Option<&PredictedPass> {
        let moving = |predicted: &&PredictedPass| !predicted.satellite.elements.is_geosynchronous();
        let passes = self.favourites.upcoming(now);
        passes.iter().find(moving).or_else(|| passes.iter().next())
    }

    /// Returns the satellite with this catalog number, if it is in a list.
    pub fn satellite(&self, catalog_number: u32) -> Option<&Arc<ListedSatellite>> {
        let number = |listed: &Arc<ListedSatellite>| listed.elements.catalog_number();
        let followed = &self.favourites.satellites;
        followed.iter().find(|listed| number(listed) == catalog_number).or_else(|| {
            let all = &self.all.satellites;
            let place = all.binary_search_by_key(&catalog_number, number).ok()?;
            all.get(place)
        })
    }
}

/// Returns the directions of a satellite from `now` until it sets, for at most `span_s` seconds, in
/// steps of 30 s.
pub fn ahead(
    satellite: &ListedSatellite,
    site: &SiteFrame,
    now: Timestamp,
    span_s: f64,
) -> Vec<AzEl> {
    let steps = (span_s / 30.0) as usize;
    let times: Vec<_> = (0..=steps).map(|step| add_seconds(now, step as f64 * 30.0)).collect();
    let states = satellite.propagator.states_at(&times);
    let directions = states.into_iter().zip(times).map_while(|(state, time)| {
        let direction = site.direction(state?.local(site, time).position_km);
        (direction.elevation > Angle::ZERO).then_some(direction)
    });
    directions.collect()
}
