//! Facts that the sheet shows beyond the schedule: the passes, the nights, and the price of a
//! left-out pass.

use jiff::Timestamp;

use super::HandOverSheet;
use crate::{
    astro::{
        AzEl, sun_moon,
        time::{DAY_S, add_seconds, seconds_between},
    },
    orbit::{Pass, PassSearch, passes},
    plan::schedule::{Entry, LeftOut, LeftOutReason, PassKey},
    station::AntennaId,
};

/// Number of points of a track.
const POINTS: u32 = 30;
/// Max time from the start in the key of a pass to the start of the found pass, seconds.
const SAME_S: f64 = 60.0;
/// Time between two looks at the Sun, seconds.
const SUN_STEP_S: f64 = 120.0;

/// Entries that an antenna gives up if it takes a left-out pass.
pub(super) struct Price<'a> {
    pub(super) antenna: AntennaId,
    pub(super) entries: Vec<&'a Entry>,
}

impl<'a> HandOverSheet<'a> {
    /// Returns the entries that overlap the time of the sheet, in the order of execution.
    pub(super) fn entries(&self) -> Vec<&'a Entry> {
        let schedule: &'a _ = self.schedule;
        let is_shown = |entry: &&Entry| entry.end > self.start && entry.start < self.end;
        schedule.entries.iter().filter(is_shown).collect()
    }

    pub(super) fn left_out(&self) -> Vec<&'a LeftOut> {
        let schedule: &'a _ = self.schedule;
        let is_shown = |left: &&LeftOut| left.pass.aos >= self.start && left.pass.aos < self.end;
        schedule.left_out.iter().filter(is_shown).collect()
    }

    /// Returns the pass with this key; `None` if the elements are no longer known.
    pub(super) fn pass(&self, key: PassKey) -> Option<Pass> {
        let (_, propagator) = self.satellites.get(&key.satellite)?;
        let station = self.station;
        let search = PassSearch {
            aos_elevation: station.aos_elevation(),
            ..PassSearch::new(station.site, key.aos, add_seconds(key.aos, DAY_S))
        };
        let first = passes(propagator, &search, &|| false).into_iter().next()?;
        (seconds_between(key.aos, first.aos.time) < SAME_S).then_some(first)
    }

    /// Returns directions from `start` to `end`, at equal intervals.
    pub(super) fn track(&self, satellite: u32, start: Timestamp, end: Timestamp) -> Vec<AzEl> {
        let Some((_, propagator)) = self.satellites.get(&satellite) else { return Vec::new() };
        let step_s = seconds_between(start, end) / f64::from(POINTS - 1);
        let times = (0..POINTS).map(|point| add_seconds(start, f64::from(point) * step_s));
        let looks = times.filter_map(|time| propagator.look_from(self.station.site, time).ok());
        looks.map(|look| look.direction).collect()
    }

    /// Returns the spans on the sheet in which the Sun is down.
    pub(super) fn nights(&self) -> Vec<[Timestamp; 2]> {
        let steps = (seconds_between(self.start, self.end) / SUN_STEP_S).ceil() as u32;
        let mut nights: Vec<[Timestamp; 2]> = Vec::new();
        let mut is_night = false;
        for step in 0..=steps {
            let time = add_seconds(self.start, f64::from(step) * SUN_STEP_S).min(self.end);
            let was_night = is_night;
            is_night = sun_moon::sun(self.station.site.airless(), time).elevation_deg() < 0.0;
            match nights.last_mut().filter(|_| was_night) {
                Some([_, end]) => *end = time,
                None if is_night => nights.push([time, time]),
                None => {}
            }
        }
        nights
    }

    /// Returns the entries that an antenna gives up if it takes a pass and nothing else is
    /// replanned. Picks the antenna with the lowest price. Returns `None` if no antenna can take
    /// the pass.
    pub(super) fn price(&self, left: &LeftOut) -> Option<Price<'a>> {
        let schedule: &'a _ = self.schedule;
        let on = |(antenna, reason): &(AntennaId, LeftOutReason)| {
            let in_the_way = match reason {
                LeftOutReason::Overlaps(conflict) | LeftOutReason::SlewTooShort(conflict) => {
                    let mut all = conflict.others.clone();
                    all.push(conflict.pass);
                    all
                }
                LeftOutReason::NotFound => Vec::new(),
                _ => return None,
            };
            let is_given_up =
                |other: &&Entry| other.antenna == *antenna && in_the_way.contains(&other.pass);
            let entries = schedule.entries.iter().filter(is_given_up).collect();
            Some(Price { antenna: *antenna, entries })
        };
        let rank = |price: &Price<'_>| {
            let class = price.entries.iter().map(|entry| entry.class).min();
            let seconds: f64 = price.entries.iter().map(|entry| entry.counted_s).sum();
            (class, seconds)
        };
        // Give up a lower priority first: the greater class is the lower price.
        left.by_antenna.iter().filter_map(on).min_by(|a, b| {
            let ((a, a_s), (b, b_s)) = (rank(a), rank(b));
            let is_free = |class: Option<_>| class.is_some();
            is_free(a).cmp(&is_free(b)).then(b.cmp(&a)).then(a_s.total_cmp(&b_s))
        })
    }
}
