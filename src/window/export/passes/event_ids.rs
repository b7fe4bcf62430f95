//! Identities of passes in a calendar. An identity survives new elements, another time window or a
//! new measurement of the site. A second import therefore replaces the events of the first.
//!
//! Time is divided into slots, and the slot of its TCA identifies a pass. The length of a slot in
//! seconds is a power of two, less than the time between two passes. A slightly different period
//! gives the same slots. A slightly different TCA lies in the same slot unless it is next to the
//! border of two slots.

use std::collections::BTreeMap;

use jiff::Timestamp;

use super::{ExportedPass, PassQuery};
use crate::{
    astro::{Site, time},
    orbit::{Elements, Pass},
};

/// Maximum length of a slot as a share of the time between two passes.
const SLOT_SHARE: f64 = 0.9;
/// Max length of a pass with a stable TCA, revolutions.
const LONGEST_PASS: f64 = 2.0;
/// Offset that keeps the borders of cells away from round coordinates, degrees.
const CELL_OFFSET_DEG: f64 = 0.317;
/// Latitude above which a metre is too large a part of a degree of longitude, degrees.
const POLAR_LATITUDE_DEG: f64 = 89.0;

/// Returns the identities of `rows`, which are ordered by AOS. All identities are different. A
/// calendar appends its domain.
pub(in crate::export) fn event_ids(rows: &[ExportedPass<'_>], query: &PassQuery) -> Vec<String> {
    let cell = cell(query.search.site);
    // Number of earlier passes by satellite and slot.
    let mut before: BTreeMap<(u32, Option<i64>), usize> = BTreeMap::new();
    let id = |ExportedPass { satellite, pass }: &ExportedPass<'_>| {
        let number = satellite.elements.catalog_number();
        let slots = Slots::new(&satellite.elements);
        let again = |start, end| query.passes_between(&satellite.propagator, start, end);
        let FoundSlot { slot, order } = slots.find(pass, query.search.start, again);
        let before = before.entry((number, slot)).or_default();
        let order = order.max(*before);
        *before = order + 1;
        let slot = slot.map_or_else(|| "up".to_owned(), |slot| slot.to_string());
        let order = if order > 0 { format!("-{order}") } else { String::new() };
        format!("{number}-{cell}-{}-{slot}{order}", slots.exponent)
    };
    rows.iter().map(id).collect()
}

/// Returns a number for the square degree of a site, since two stations may have their passes in
/// one calendar.
fn cell(site: Site) -> u32 {
    let (latitude_deg, longitude_deg) = (site.latitude().degrees(), site.longitude().degrees());
    let row = (latitude_deg + 90.0 + CELL_OFFSET_DEG) as u32;
    let is_polar = latitude_deg.abs() > POLAR_LATITUDE_DEG;
    let column = if is_polar { 0.0 } else { (longitude_deg + CELL_OFFSET_DEG).rem_euclid(360.0) };
    row * 360 + column as u32
}

struct Slots {
    /// Binary logarithm of the length of a slot in seconds.
    exponent: u32,
    longest_pass_s: f64,
}

/// The position of a pass among the slots.
struct FoundSlot {
    /// The slot; `None` for a satellite that stays above the horizon.
    slot: Option<i64>,
    /// Number of known passes before this one in the same slot.
    order: usize,
}

impl Slots {
    fn new(elements: &Elements) -> Self {
        let period_s = elements.period_s();
        // A slow satellite rises once per rotation of the Earth.
        let between_s = SLOT_SHARE * period_s.min(time::DAY_S);
        let exponent = between_s.log2().max(0.0) as u32;
        Self { exponent, longest_pass_s: LONGEST_PASS * period_s }
    }

    fn slot(&self, time: Timestamp) -> i64 {
        time.as_second() >> self.exponent
    }

    fn start(&self, slot: i64) -> Timestamp {
        Timestamp::from_second(slot << self.exponent).unwrap_or(Timestamp::MIN)
    }

    /// Finds the slot of `pass`. If the window from `start` on cuts off a part of the pass or of
    /// its slot, `again` searches a wider window.
    fn find(
        &self,
        pass: &Pass,
        start: Timestamp,
        again: impl FnOnce(Timestamp, Timestamp) -> Vec<Pass>,
    ) -> FoundSlot {
        let slot = self.slot(pass.tca.time);
        let is_cut = pass.starts_before || pass.ends_after || self.start(slot) < start;
        let found = FoundSlot { slot: Some(slot), order: 0 };
        if !is_cut {
            return if self.is_long(pass) { FoundSlot { slot: None, order: 0 } } else { found };
        }
        let first = self.start(slot).min(pass.aos.time);
        let first = time::add_seconds(first, -self.longest_pass_s);
        let last = if pass.ends_after { self.longest_pass_s } else { 1.0 };
        let passes = again(first, time::add_seconds(pass.los.time, last));
        let middle = time::add_seconds(pass.aos.time, 0.5 * pass.duration_s());
        let is_same = |whole: &&Pass| (whole.aos.time..=whole.los.time).contains(&middle);
        let Some(whole) = passes.iter().find(is_same) else { return found };
        if self.is_long(whole) {
            return FoundSlot { slot: None, order: 0 };
        }
        let slot = self.slot(whole.tca.time);
        let is_before = |other: &&Pass| {
            other.aos.time < whole.aos.time
                && self.slot(other.tca.time) == slot
                && !self.is_long(other)
        };
        FoundSlot { slot: Some(slot), order: passes.iter().filter(is_before).count() }
    }

    fn is_long(&self, pass: &Pass) -> bool {
        pass.duration_s() > self.longest_pass_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_site_measured_anew_stays_in_its_cell() {
        let cell = |latitude_deg, longitude_deg| {
            super::cell(Site::new(latitude_deg, longitude_deg, 0.0).unwrap())
        };
        for latitude_deg in [-89.0, -41.5, 0.0, 41.0] {
            for longitude_deg in [-90.5, 0.0, 29.0, 180.0] {
                let here = cell(latitude_deg, longitude_deg);
                assert_eq!(here, cell(latitude_deg + 1e-4, longitude_deg));
                assert_eq!(here, cell(latitude_deg, longitude_deg - 1e-4));
                assert_ne!(here, cell(latitude_deg, longitude_deg - 1.1));
                assert_ne!(here, cell(latitude_deg + 1.1, longitude_deg));
            }
        }
        assert_eq!(cell(41.0, -180.0), cell(41.0, 180.0));
        assert_eq!(cell(-90.0, 0.0), cell(-90.0, 170.0));
    }
}
