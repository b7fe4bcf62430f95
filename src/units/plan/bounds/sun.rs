//! Surroundings of the Sun, now and during the time ahead.

use std::cell::OnceCell;

use glam::DVec3;
use jiff::{SignedDuration, Timestamp};

use super::{Angle, AzEl, Bounds, BoundsAt, FINEST_DEG, Site, SunAvoidance};
use crate::astro::sun_moon;

/// Min interval between two positions of the Sun, seconds: the Sun moves a tenth of a degree in
/// this time.
const SUN_STEP_S: f64 = 24.0;
/// Max number of positions of the Sun for any time ahead.
const MAX_SUNS: f64 = 40.0;
/// Max rate of the Sun, degrees per second.
const SUN_DEG_S: f64 = 360.0 / 86_164.0;
/// Max apparent motion of the Sun per degree of its true motion: refraction stretches it close
/// below the horizon.
const MAX_STRETCH: f64 = 2.0;
/// Distance between the rings of a search for a refuge from the Sun, degrees.
const RING_DEG: f64 = 0.5;
/// Number of directions on each ring.
const BEARINGS: u32 = 24;
/// Radius of the largest ring beyond the motion of the Sun, degrees.
const BEYOND_DEG: f64 = 30.0;

impl Bounds {
    /// Returns the bounds without the Sun, for an antenna that must point at the Sun.
    #[must_use]
    pub fn without_the_sun(&self) -> Self {
        Self { sun: None, ..self.clone() }
    }

    /// Returns the bounds for a way out of the surroundings of the Sun that leads no nearer to the
    /// Sun than the axes at `start_deg`. Returns `None` if the antenna is outside. Uses the axis
    /// direction or the sky direction, whichever is nearer to the Sun.
    pub fn away_from_the_sun(&self, start_deg: [f64; 2], time: Timestamp) -> Option<Self> {
        let sun = self.sun?;
        let ahead = SunAhead::new(self.site, sun, time);
        let clearances =
            self.aim(start_deg).directions().map(|start| ahead.clearance_of(start.to_enu()));
        let clearance_deg = clearances.map(Angle::degrees).min_by(f64::total_cmp)?;
        let radius_deg = sun.radius_deg + clearance_deg;
        let closer = SunAvoidance { radius_deg, ..sun };
        (clearance_deg < 0.0).then(|| Self { sun: Some(closer), ..self.clone() })
    }

    /// Returns `true` if an antenna with axes that count `direction` is clear of all barriers, and
    /// of the Sun throughout the time ahead.
    pub fn stays_clear(&self, direction: AzEl, time: Timestamp) -> bool {
        are_clear(&self.now_and_later(time), direction)
    }

    fn now_and_later(&self, time: Timestamp) -> Vec<BoundsAt<'_>> {
        let ahead_min = self.sun.map_or(0.0, |sun| sun.ahead_min);
        let later = time.checked_add(seconds(ahead_min * 60.0));
        std::iter::once(time).chain(later).map(|utc| self.at_time(utc)).collect()
    }

    /// Returns directions of the axes that stay clear, the nearest to `start` first.
    pub fn refuges(&self, start: AzEl, time: Timestamp) -> impl Iterator<Item = AzEl> + '_ {
        let furthest_deg = self.sun.map_or(0.0, |sun| 2.0 * sun.radius_deg + BEYOND_DEG);
        let rings = (1..).map(f64::from).take_while(move |ring| ring * RING_DEG <= furthest_deg);
        let ring_points = rings.flat_map(move |ring| {
            let bearings = (0..BEARINGS).map(|part| f64::from(part) / f64::from(BEARINGS) * 360.0);
            bearings.map(move |bearing_deg| start.displaced(bearing_deg, ring * RING_DEG))
        });
        let all = self.now_and_later(time);
        ring_points.filter(move |direction| are_clear(&all, *direction))
    }
}

/// Positions of the Sun from one time to the end of the time ahead.
#[derive(Debug, Clone)]
pub(super) struct SunAhead {
    site: Site,
    sun: SunAvoidance,
    computed_at: Timestamp,
    /// Unit vector to the Sun at the first time.
    first: DVec3,
    /// Unit vectors to the Sun, including the first one.
    all: OnceCell<Vec<DVec3>>,
}

impl SunAhead {
    pub(super) fn new(site: Site, sun: SunAvoidance, time: Timestamp) -> Self {
        let first = sun_moon::sun(site, time).to_enu();
        Self { site, sun, computed_at: time, first, all: OnceCell::new() }
    }

    /// Returns the smallest clearance of a direction from the surroundings of the Sun.
    pub(super) fn clearance_of(&self, direction: DVec3) -> Angle {
        let chords = self.all().iter().map(|sun| sun.distance_squared(direction));
        let radius = Angle::from_degrees(around_each_deg(self.sun));
        // No chord of the unit sphere is longer than 2.
        across(chords.fold(4.0, f64::min)) - radius
    }

    /// Returns a lower bound of [`Self::clearance_of`], from the first position alone.
    pub(super) fn clearance_lower_bound(&self, direction: DVec3) -> Angle {
        let moved_deg = SUN_DEG_S * self.sun.ahead_min * 60.0 * MAX_STRETCH;
        let radius = Angle::from_degrees(around_each_deg(self.sun) + moved_deg);
        across(self.first.distance_squared(direction)) - radius
    }

    fn all(&self) -> &[DVec3] {
        self.all.get_or_init(|| {
            let step_s = sun_step_s(self.sun);
            let steps = (self.sun.ahead_min * 60.0 / step_s).ceil() as u32;
            let later = (1..=steps)
                .filter_map(|step| {
                    self.computed_at.checked_add(seconds(f64::from(step) * step_s)).ok()
                })
                .map(|time| sun_moon::sun(self.site, time).to_enu());
            std::iter::once(self.first).chain(later).collect()
        })
    }
}

/// Returns the angle across a chord of the unit sphere.
fn across(chord_squared: f64) -> Angle {
    // The chord stays precise near zero, unlike the cosine.
    Angle::from_radians(2.0 * (chord_squared.sqrt() / 2.0).min(1.0).asin())
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

/// Returns the radius around each position of the Sun, degrees: wide enough to leave no gap between
/// two positions.
fn around_each_deg(sun: SunAvoidance) -> f64 {
    let half_deg = sun_step_s(sun) * SUN_DEG_S / 2.0;
    sun.radius_deg.hypot(half_deg) + FINEST_DEG
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{Air, Refraction},
        plan::{Barrier, Sweep},
        station::{Antenna, Station},
    };

    fn noon() -> Timestamp {
        "2026-08-12T10:00:00Z".parse().unwrap()
    }

    fn high() -> Sweep {
        Sweep::at_position([0.0, 89.0])
    }

    #[test]
    fn the_sun_is_avoided_where_it_will_be_too() {
        let sun_avoidance = Some(SunAvoidance { radius_deg: 5.0, ahead_min: 60.0 });
        let mut station = Station { sun_avoidance, ..Station::default() };
        let bounds = Bounds::new(&station, &Antenna::genius("Yagi", "memory:1"));
        let later = noon() + SignedDuration::from_mins(50);
        let ahead = sun_moon::sun(station.site, later);
        let place_deg = [ahead.azimuth_deg(), ahead.elevation_deg()];
        let sweep = Sweep::new(place_deg, place_deg);
        assert_eq!(
            bounds.at_time(noon()).blocks(sweep, high()).map(|(barrier, _)| barrier),
            Some(Barrier::Sun)
        );
        station.sun_avoidance = None;
        let bounds = Bounds::new(&station, &Antenna::genius("Yagi", "memory:1"));
        assert_eq!(bounds.at_time(noon()).blocks(sweep, high()), None);
    }

    #[test]
    fn no_direction_is_nearer_to_the_sun_than_its_first_position_tells() {
        let humid = Refraction {
            air: Air::Measured,
            pressure_hpa: 1080.0,
            temperature_c: 40.0,
            humidity_percent: 82.0,
            ..Refraction::default()
        };
        for (latitude_deg, refraction) in
            [(0.0, humid), (50.0, humid), (89.0, humid), (50.0, Refraction::default())]
        {
            let site =
                Site::new(latitude_deg, 30.0, 0.0).unwrap().with_refraction(refraction).unwrap();
            for (minutes, ahead_min) in
                (0..1440).step_by(7).zip([0.0, 10.0, 30.0, 120.0].into_iter().cycle())
            {
                let time = noon() + SignedDuration::from_mins(minutes);
                let sun = SunAhead::new(site, SunAvoidance { radius_deg: 5.0, ahead_min }, time);
                for later in sun.all() {
                    assert!(
                        sun.clearance_lower_bound(*later) <= sun.clearance_of(*later),
                        "{latitude_deg} {time} {ahead_min}"
                    );
                }
            }
        }
    }

    #[test]
    fn wherever_the_sun_comes_in_its_time_ahead_is_refused() {
        for (radius_deg, ahead_min) in [(0.1, 120.0), (5.0, 120.0), (1.0, 7.0), (30.0, 0.0)] {
            let sun_avoidance = Some(SunAvoidance { radius_deg, ahead_min });
            let station = Station { sun_avoidance, ..Station::default() };
            let bounds = Bounds::new(&station, &Antenna::genius("Yagi", "memory:1"));
            let bounds = bounds.at_time(noon());
            let positions = bounds.sun.as_ref().unwrap().all().len();
            assert!(positions <= 42, "{positions}");
            for second in (0..=(ahead_min * 60.0) as i64).step_by(10) {
                let later = noon() + SignedDuration::from_secs(second);
                let sun = sun_moon::sun(station.site, later);
                for bearing_deg in [0.0, 45.0, 90.0, 180.0, 300.0] {
                    let near_edge = sun.displaced(bearing_deg, radius_deg * 0.999);
                    assert!(
                        !are_clear(std::slice::from_ref(&bounds), near_edge),
                        "{radius_deg} {second} {bearing_deg}"
                    );
                }
            }
        }
    }
}
