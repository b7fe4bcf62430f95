//! The surroundings of the Sun, now and during the time ahead.

use jiff::{SignedDuration, Timestamp};

use super::{AzEl, Bounds, BoundsAt, FINEST_DEG, SunAvoidance};
use crate::astro::sun_moon;

/// Shortest interval between two positions of the Sun, seconds: the Sun moves a tenth of
/// a degree in it.
const SUN_STEP_S: f64 = 24.0;
/// Maximum number of positions of the Sun for any time ahead.
const MAX_SUNS: f64 = 40.0;
/// Fastest motion of the Sun, degrees per second.
const SUN_DEG_S: f64 = 360.0 / 86_164.0;
/// Distance between the rings that are searched for a refuge from the Sun, degrees.
const RING_DEG: f64 = 0.5;
/// Number of directions on each ring.
const BEARINGS: u32 = 24;
/// Radius of the largest ring, beyond the motion of the Sun, degrees.
const BEYOND_DEG: f64 = 30.0;

impl Bounds {
    /// The bounds without the Sun, for an antenna that is meant to point at it.
    #[must_use]
    pub fn without_the_sun(&self) -> Self {
        Self { sun: None, ..self.clone() }
    }

    /// The bounds for a way out of the surroundings of the Sun that leads no nearer to the Sun than
    /// the antenna is with its axes at `start_deg`; `None` if it is outside. Of its directions by
    /// the axes and on the sky, the one nearer to the Sun counts.
    pub fn away_from_the_sun(&self, start_deg: [f64; 2], at: Timestamp) -> Option<Self> {
        let sun = self.sun?;
        let suns = self.suns(at);
        let separations = self
            .aim(start_deg)
            .each()
            .flat_map(|start| suns.iter().map(move |sun| start.separation(*sun).degrees()));
        let nearest_deg = separations.min_by(f64::total_cmp)?;
        let is_inside = nearest_deg < around_each_deg(sun);
        let radius_deg = nearest_deg - (around_each_deg(sun) - sun.radius_deg);
        is_inside.then(|| Self { sun: Some(SunAvoidance { radius_deg, ..sun }), ..self.clone() })
    }

    /// Returns `true` if an antenna with axes that count `direction` is clear of all barriers, and of
    /// the Sun throughout the time ahead.
    pub fn stays_clear(&self, direction: AzEl, at: Timestamp) -> bool {
        are_clear(&self.now_and_later(at), direction)
    }

    fn now_and_later(&self, at: Timestamp) -> Vec<BoundsAt<'_>> {
        let ahead_min = self.sun.map_or(0.0, |sun| sun.ahead_min);
        let later = at.checked_add(seconds(ahead_min * 60.0));
        std::iter::once(at).chain(later).map(|at| self.at(at)).collect()
    }

    /// Directions of the axes that stay clear, the nearest to `from` first.
    pub fn refuges(&self, from: AzEl, at: Timestamp) -> impl Iterator<Item = AzEl> + '_ {
        let furthest_deg = self.sun.map_or(0.0, |sun| 2.0 * sun.radius_deg + BEYOND_DEG);
        let rings = (1..).map(f64::from).take_while(move |ring| ring * RING_DEG <= furthest_deg);
        let around = rings.flat_map(move |ring| {
            let bearings = (0..BEARINGS).map(|part| f64::from(part) / f64::from(BEARINGS) * 360.0);
            bearings.map(move |bearing_deg| from.towards(bearing_deg, ring * RING_DEG))
        });
        let all = self.now_and_later(at);
        around.filter(move |direction| are_clear(&all, *direction))
    }

    /// Directions of the Sun from `at` to the end of the time ahead.
    pub(super) fn suns(&self, at: Timestamp) -> Vec<AzEl> {
        let Some(sun) = self.sun else { return Vec::new() };
        let step_s = sun_step_s(sun);
        let steps = (sun.ahead_min * 60.0 / step_s).ceil() as u32;
        (0..=steps)
            .filter_map(|step| at.checked_add(seconds(f64::from(step) * step_s)).ok())
            .map(|at| sun_moon::sun(self.site, at))
            .collect()
    }
}

fn are_clear(all: &[BoundsAt<'_>], direction: AzEl) -> bool {
    all.iter().all(|bounds| bounds.has_room_at(bounds.aim_at(direction), 0.0))
}

fn seconds(seconds: f64) -> SignedDuration {
    SignedDuration::try_from_secs_f64(seconds).unwrap_or_default()
}

fn sun_step_s(sun: SunAvoidance) -> f64 {
    SUN_STEP_S.max(sun.ahead_min * 60.0 / MAX_SUNS)
}

/// Radius around each position of the Sun, degrees: wide enough to leave no gap
/// between two of them.
pub(super) fn around_each_deg(sun: SunAvoidance) -> f64 {
    let half_deg = sun_step_s(sun) * SUN_DEG_S / 2.0;
    sun.radius_deg.hypot(half_deg) + FINEST_DEG
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        plan::{Barrier, Sweep},
        station::{Antenna, Station},
    };

    fn noon() -> Timestamp {
        "2026-08-12T10:00:00Z".parse().unwrap()
    }

    fn high() -> Sweep {
        Sweep::at([0.0, 89.0])
    }

    #[test]
    fn the_sun_is_avoided_where_it_will_be_too() {
        let sun_avoidance = Some(SunAvoidance { radius_deg: 5.0, ahead_min: 60.0 });
        let mut station = Station { sun_avoidance, ..Station::default() };
        let bounds = Bounds::of(&station, &Antenna::genius("Yagi", "memory:1"));
        let later = noon() + SignedDuration::from_mins(50);
        let ahead = sun_moon::sun(station.site, later);
        let place_deg = [ahead.azimuth_deg(), ahead.elevation_deg()];
        let there = Sweep::between(place_deg, place_deg);
        assert_eq!(
            bounds.at(noon()).blocks(there, high()).map(|(barrier, _)| barrier),
            Some(Barrier::Sun)
        );
        station.sun_avoidance = None;
        let bounds = Bounds::of(&station, &Antenna::genius("Yagi", "memory:1"));
        assert_eq!(bounds.at(noon()).blocks(there, high()), None);
    }

    #[test]
    fn wherever_the_sun_comes_in_its_time_ahead_is_refused() {
        for (radius_deg, ahead_min) in [(0.1, 120.0), (5.0, 120.0), (1.0, 7.0), (30.0, 0.0)] {
            let sun_avoidance = Some(SunAvoidance { radius_deg, ahead_min });
            let station = Station { sun_avoidance, ..Station::default() };
            let bounds = Bounds::of(&station, &Antenna::genius("Yagi", "memory:1"));
            let bounds = bounds.at(noon());
            assert!(bounds.suns.len() <= 42, "{}", bounds.suns.len());
            for second in (0..=(ahead_min * 60.0) as i64).step_by(10) {
                let later = noon() + SignedDuration::from_secs(second);
                let sun = sun_moon::sun(station.site, later);
                for bearing_deg in [0.0, 45.0, 90.0, 180.0, 300.0] {
                    let beside = sun.towards(bearing_deg, radius_deg * 0.999);
                    assert!(
                        !are_clear(std::slice::from_ref(&bounds), beside),
                        "{radius_deg} {second} {bearing_deg}"
                    );
                }
            }
        }
    }
}
