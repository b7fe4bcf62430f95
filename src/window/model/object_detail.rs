//! Next passes of the object shown in detail in the Elements view, and its older sets compared with
//! the set in use. A thread computes them.

use std::sync::Arc;

use jiff::Timestamp;

use crate::{
    astro::{
        Angle,
        time::{DAY_S, add_seconds, seconds_between},
    },
    contract::{
        older_sets::{OlderSet, OlderSets},
        passes::{ListedSatellite, Observer, PredictedPass},
    },
    orbit::{Elements, Pass, PassSearch, Propagator, passes},
    plan::Sample,
    station::Station,
};

/// Number of passes shown.
const COUNT: usize = 3;
/// Time ahead in which Azel searches for the passes, days.
const DAYS: u32 = 7;
/// Max time since the start of a current pass, seconds, except for satellites that hardly move.
const LOOK_BACK_S: f64 = 3600.0;
/// Time before and after a pass in which an older set may show the same pass, seconds.
const AROUND_S: f64 = 1800.0;

/// Inputs of the detail, except the time.
#[derive(Debug, Clone, PartialEq)]
pub struct DetailKey {
    pub elements: Elements,
    observer: Observer,
    floor: Angle,
    older: Option<Arc<OlderSets>>,
}

impl DetailKey {
    pub fn new(elements: &Elements, station: &Station, older: Option<&Arc<OlderSets>>) -> Self {
        let is_of = |older: &&Arc<OlderSets>| older.catalog_number == elements.catalog_number();
        Self {
            older: older.filter(is_of).cloned(),
            elements: elements.clone(),
            observer: Observer::from_station(station),
            floor: station.elevation_floor(),
        }
    }
}

/// The detail of an object.
#[derive(Debug)]
pub struct ObjectDetail {
    pub key: DetailKey,
    /// The first passes that reach the elevation floor of the station, in order of time.
    pub passes: Vec<PredictedPass>,
    /// The sets not in use, the newest first.
    pub sets: Vec<SetShift>,
}

/// A set not in use, compared with the set in use during the next pass.
#[derive(Debug, Clone, PartialEq)]
pub struct SetShift {
    pub set: OlderSet,
    /// Delay of the satellite by this set at its closest approach, seconds; `None` if this set has
    /// no such pass.
    pub late_s: Option<f64>,
    /// Max angle between the directions by both sets; `None` without a pass.
    pub deviation: Option<Angle>,
}

impl ObjectDetail {
    /// Computes the detail at `now`.
    pub fn new(key: DetailKey, now: Timestamp, cancelled: &dyn Fn() -> bool) -> Self {
        let passes = next_passes(&key, now, cancelled);
        let older = key.older.iter().flat_map(|older| &older.sets);
        let others = older.filter(|set| set.elements.epoch() != key.elements.epoch());
        let sets = others.map(|set| shift(set, passes.first(), &key, cancelled)).collect();
        Self { key, passes, sets }
    }

    /// Returns `true` if the detail is still valid for `key` at `now`.
    pub fn is_of(&self, key: &DetailKey, now: Timestamp) -> bool {
        self.key == *key && self.passes.iter().all(|predicted| predicted.pass.los.time > now)
    }
}

fn shift(
    set: &OlderSet,
    predicted: Option<&PredictedPass>,
    key: &DetailKey,
    cancelled: &dyn Fn() -> bool,
) -> SetShift {
    let mut shift = SetShift { set: set.clone(), late_s: None, deviation: None };
    let propagator = Propagator::new(&set.elements).ok();
    let (Some(predicted), Some(propagator)) = (predicted, propagator) else { return shift };
    let deviation = |sample: &Sample| {
        let look = propagator.look_from(key.observer.site, sample.time).ok()?;
        Some(look.direction.separation(sample.direction))
    };
    shift.deviation = predicted
        .track()
        .iter()
        .filter_map(deviation)
        .reduce(|a, b| if a.radians() < b.radians() { b } else { a });
    let pass = predicted.pass;
    let pass_search = PassSearch {
        aos_elevation: Angle::ZERO,
        floor: Angle::ZERO,
        ..PassSearch::new(
            key.observer.site,
            add_seconds(pass.aos.time, -AROUND_S),
            add_seconds(pass.los.time, AROUND_S),
        )
    };
    let late_s = |other: &Pass| seconds_between(pass.tca.time, other.tca.time);
    let found = passes(&propagator, &pass_search, cancelled);
    shift.late_s = found
        .iter()
        .filter(|_| !predicted.is_always_up())
        .map(late_s)
        .min_by(|a, b| a.abs().total_cmp(&b.abs()));
    shift
}

fn next_passes(
    key: &DetailKey,
    now: Timestamp,
    cancelled: &dyn Fn() -> bool,
) -> Vec<PredictedPass> {
    let Ok(propagator) = Propagator::new(&key.elements) else { return Vec::new() };
    let elements = key.elements.clone();
    let satellite = Arc::new(ListedSatellite { elements, propagator });
    let observer = Arc::new(key.observer.clone());
    let mut found: Vec<PredictedPass> = Vec::new();
    // Most satellites have enough passes on the first day.
    for days in [1, DAYS] {
        let search = PassSearch {
            aos_elevation: observer.aos_elevation,
            floor: key.floor,
            ..PassSearch::new(
                observer.site,
                add_seconds(now, -LOOK_BACK_S),
                add_seconds(now, f64::from(days) * DAY_S),
            )
        };
        let upcoming = passes(&satellite.propagator, &search, cancelled);
        found = upcoming
            .into_iter()
            .filter(|pass| pass.los.time > now)
            .take(COUNT)
            .map(|pass| PredictedPass::new(Arc::clone(&satellite), pass, Arc::clone(&observer)))
            .collect();
        let is_always_up = found.iter().any(PredictedPass::is_always_up);
        if found.len() == COUNT || is_always_up || cancelled() {
            break;
        }
    }
    for predicted in &found {
        predicted.path();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::bundled;

    #[test]
    fn an_older_set_is_compared_in_seconds_and_degrees_at_the_next_pass() {
        let catalog = bundled().unwrap();
        let now: Timestamp = "2026-08-12T12:00:00Z".parse().unwrap();
        let iss = catalog.get(25_544).unwrap();
        // The same orbit, 10 s later: a smaller mean anomaly.
        let mut text = Vec::new();
        crate::orbit::write_omm_json([iss], &mut text).unwrap();
        let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
        let behind_deg = 10.0 * 360.0 / iss.period_s();
        let anomaly = list[0]["MEAN_ANOMALY"].as_f64().unwrap() - behind_deg;
        list[0]["MEAN_ANOMALY"] = anomaly.rem_euclid(360.0).into();
        list[0]["EPOCH"] = "2026-08-11T00:00:00".into();
        let late = crate::orbit::read_elements(&list.to_string()).elements.remove(0);
        // The test moves only the epoch; the comparison must not depend on it.
        let moved_s = seconds_between(late.epoch(), iss.epoch());
        list[0]["MEAN_ANOMALY"] =
            (anomaly - moved_s * 360.0 / iss.period_s()).rem_euclid(360.0).into();
        let late = crate::orbit::read_elements(&list.to_string()).elements.remove(0);
        let sets = vec![OlderSet { elements: late, source: "own".to_owned() }];
        let older = Arc::new(OlderSets { catalog_number: 25_544, sets });
        let key = DetailKey::new(iss, &Station::default(), Some(&older));
        let detail = ObjectDetail::new(key, now, &|| false);
        let shift = &detail.sets[0];
        let late_s = shift.late_s.unwrap();
        assert!((3.0..25.0).contains(&late_s), "{late_s}");
        let off_deg = shift.deviation.unwrap().degrees();
        assert!((1.0..25.0).contains(&off_deg), "{off_deg}");
    }

    #[test]
    fn the_next_passes_reach_the_floor_and_a_satellite_that_stays_up_has_one() {
        let catalog = bundled().unwrap();
        let now: Timestamp = "2026-08-12T12:00:00Z".parse().unwrap();
        let station = Station::default();
        let detail = |number| {
            let key = DetailKey::new(catalog.get(number).unwrap(), &station, None);
            ObjectDetail::new(key, now, &|| false)
        };
        let iss = detail(25_544);
        assert_eq!(iss.passes.len(), COUNT);
        for predicted in &iss.passes {
            assert!(predicted.pass.max_elevation() >= station.elevation_floor());
            assert!(predicted.pass.los.time > now);
        }
        assert!(iss.is_of(&iss.key, now));
        assert!(!iss.is_of(&iss.key, iss.passes[0].pass.los.time), "the first pass is over");
        let geostationary = detail(44_334);
        assert_eq!(geostationary.passes.len(), 1);
        assert!(geostationary.passes[0].is_always_up());
    }
}
