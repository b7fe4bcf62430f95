//! The sky of the site at one moment.

use std::sync::Arc;

use jiff::Timestamp;

use super::daylight::{self, SunSpan};
use crate::{
    astro::{AzEl, Site, sun_moon},
    engine::passes::{ListedSatellite, ahead},
    orbit::{LookAngles, is_sunlit},
};

/// Length of the drawn path of a satellite that is not selected.
const AHEAD_S: f64 = 300.0;
/// Least time ahead of day and night.
const SUN_AHEAD_S: f64 = 25.0 * 3600.0;

/// The sky of the site.
#[derive(Debug, Default)]
pub struct Sky {
    /// Satellites of the list above the horizon.
    pub satellites: Vec<Seen>,
    /// The satellite of the selected pass, above the horizon or not.
    pub selected: Option<Selected>,
    pub sun: Option<AzEl>,
    pub moon: Option<AzEl>,
    /// Day and night from shortly before now to the end of the plan, for a day at least.
    pub sun_spans: Vec<SunSpan>,
    seconds: Option<i64>,
    sun_spans_of: Option<(Site, i64, f64)>,
}

/// A satellite above the horizon.
#[derive(Debug)]
pub struct Seen {
    pub satellite: Arc<ListedSatellite>,
    pub direction: AzEl,
    /// Path of the next minutes.
    pub ahead: Vec<AzEl>,
}

/// The satellite of the selected pass.
#[derive(Debug, Clone, Copy)]
pub struct Selected {
    pub look: LookAngles,
    /// The Sun shines on it.
    pub sunlit: bool,
}

impl Selected {
    fn at(satellite: &ListedSatellite, site: Site, at: Timestamp) -> Option<Self> {
        let state = satellite.propagator.state_at(at).ok()?;
        Some(Self { look: state.look_from(site, at), sunlit: is_sunlit(&state, at) })
    }
}

impl Sky {
    /// Brings it to `now`; `span_s` is the length of the plan.
    pub(super) fn refresh(
        &mut self,
        satellites: &[Arc<ListedSatellite>],
        selected: Option<&ListedSatellite>,
        (site, span_s): (Site, f64),
        now: Timestamp,
    ) {
        if self.seconds == Some(now.as_second()) {
            // The selected satellite is compared with the antenna and moves with every frame.
            self.selected = selected.and_then(|satellite| Selected::at(satellite, site, now));
            return;
        }
        let sun_spans = (std::mem::take(&mut self.sun_spans), self.sun_spans_of);
        *self = Self::at(satellites, selected, site, now);
        self.seconds = Some(now.as_second());
        (self.sun_spans, self.sun_spans_of) = sun_spans;
        self.refresh_sun_spans(site, span_s, now);
    }

    /// The sky at any time, without day and night.
    pub(super) fn at(
        satellites: &[Arc<ListedSatellite>],
        selected: Option<&ListedSatellite>,
        site: Site,
        at: Timestamp,
    ) -> Self {
        let up = satellites.iter().filter_map(|satellite| {
            let look = satellite.propagator.look_from(site, at).ok()?;
            (look.direction.elevation_deg() > 0.0).then(|| Seen {
                satellite: Arc::clone(satellite),
                direction: look.direction,
                ahead: ahead(satellite, site, at, AHEAD_S),
            })
        });
        Self {
            satellites: up.collect(),
            selected: selected.and_then(|satellite| Selected::at(satellite, site, at)),
            sun: Some(sun_moon::sun(site, at)),
            moon: Some(sun_moon::moon(site, at)),
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
