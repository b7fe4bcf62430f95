//! The sky of the site at one moment.

use std::sync::Arc;

use jiff::Timestamp;

use super::daylight::{self, SunSpan};
use crate::{
    astro::{Angle, AzEl, Site, frames::SiteFrame, sun_moon},
    contract::passes::{ListedSatellite, ahead},
    orbit::{LookAngles, Propagator, is_sunlit},
};

/// Max number of satellites in the sky whose names and paths stay distinguishable.
pub const CROWD: usize = 150;
/// Time covered by the drawn path of an unselected satellite, seconds.
const AHEAD_S: f64 = 300.0;
/// Min time for which day and night are computed, seconds.
const SUN_AHEAD_S: f64 = 25.0 * 3600.0;

/// The sky of the site.
#[derive(Debug, Default)]
pub struct Sky {
    /// Satellites of the list that are above the horizon.
    pub satellites: Vec<SkySatellite>,
    /// The satellite of the selected pass, above or below the horizon.
    pub selected: Option<Selected>,
    pub sun: Option<AzEl>,
    pub moon: Option<AzEl>,
    /// Day and night from shortly before now to the end of the plan, for at least a day.
    pub sun_spans: Vec<SunSpan>,
    seconds: Option<i64>,
    sun_spans_of: Option<(Site, i64, f64)>,
}

/// A satellite above the horizon.
#[derive(Debug)]
pub struct SkySatellite {
    pub satellite: Arc<ListedSatellite>,
    pub direction: AzEl,
    /// Path over the next minutes; empty if the sky is crowded.
    pub ahead: Vec<AzEl>,
}

/// The satellite of the selected pass.
#[derive(Debug, Clone, Copy)]
pub struct Selected {
    pub look: LookAngles,
    /// `true` if the Sun shines on the satellite.
    pub sunlit: bool,
}

impl Selected {
    fn new(satellite: &ListedSatellite, site: Site, time: Timestamp) -> Option<Self> {
        let state = satellite.propagator.state_at(time).ok()?;
        Some(Self { look: state.look_from(site, time), sunlit: is_sunlit(&state, time) })
    }
}

impl Sky {
    /// Updates the sky to `now`. `span_s` is the length of the plan.
    pub(super) fn refresh(
        &mut self,
        satellites: &[Arc<ListedSatellite>],
        selected: Option<&ListedSatellite>,
        (site, span_s): (Site, f64),
        now: Timestamp,
    ) {
        if self.seconds == Some(now.as_second()) {
            // The operator compares the selected satellite with the antenna, so it moves in every
            // frame.
            self.selected = selected.and_then(|satellite| Selected::new(satellite, site, now));
            return;
        }
        let sun_spans = (std::mem::take(&mut self.sun_spans), self.sun_spans_of);
        *self = Self::new(satellites, selected, site, now);
        self.seconds = Some(now.as_second());
        (self.sun_spans, self.sun_spans_of) = sun_spans;
        self.refresh_sun_spans(site, span_s, now);
    }

    /// Returns the sky at `time`, without day and night.
    pub(super) fn new(
        satellites: &[Arc<ListedSatellite>],
        selected: Option<&ListedSatellite>,
        site: Site,
        time: Timestamp,
    ) -> Self {
        let frame = SiteFrame::from(site);
        let requests: Vec<_> = satellites.iter().map(|listed| (&listed.propagator, time)).collect();
        let places = Propagator::over_ground(&requests).into_iter();
        let up = satellites.iter().zip(places).filter_map(|(satellite, place)| {
            let place_km = frame.enu_km(place?.position_km);
            // Skip the direction of a satellite far below the horizon, which costs time.
            let direction =
                (place_km.z > -0.1 * place_km.length()).then(|| frame.direction(place_km))?;
            (direction.elevation > Angle::ZERO).then(|| SkySatellite {
                satellite: Arc::clone(satellite),
                direction,
                ahead: Vec::new(),
            })
        });
        let mut satellites: Vec<SkySatellite> = up.collect();
        if satellites.len() <= CROWD {
            for satellite in &mut satellites {
                satellite.ahead = ahead(&satellite.satellite, &frame, time, AHEAD_S);
            }
        }
        Self {
            satellites,
            selected: selected.and_then(|satellite| Selected::new(satellite, site, time)),
            sun: Some(sun_moon::sun(site, time)),
            moon: Some(sun_moon::moon(site, time)),
            ..Self::default()
        }
    }

    /// Recomputes day and night every minute.
    fn refresh_sun_spans(&mut self, site: Site, span_s: f64, now: Timestamp) {
        let made_of = (site, now.as_second() / 60, span_s);
        if self.sun_spans_of == Some(made_of) {
            return;
        }
        self.sun_spans_of = Some(made_of);
        self.sun_spans = daylight::spans(site, now, span_s.max(SUN_AHEAD_S));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::bundled;

    #[test]
    fn a_satellite_stands_where_its_look_angles_are_and_has_a_path_unless_there_is_a_crowd() {
        let time: Timestamp = "2026-08-12T11:15:30Z".parse().unwrap();
        let site = Site::new(41.02, 29.17, 100.0).unwrap();
        let elements = bundled().unwrap().get(54_743).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let look = propagator.look_from(site, time).unwrap();
        let satellite = Arc::new(ListedSatellite { elements, propagator });
        let sky =
            |count| Sky::new(&vec![Arc::clone(&satellite); count], None, site, time).satellites;
        let few = sky(CROWD);
        assert_eq!(few.len(), CROWD);
        assert!(few.iter().all(|satellite| satellite.ahead.len() == 11));
        assert!(few[0].direction.separation(look.direction).degrees() < 1e-9);
        let many = sky(CROWD + 1);
        assert_eq!(many.len(), CROWD + 1);
        assert!(many.iter().all(|satellite| satellite.ahead.is_empty()));
    }
}
