//! What the views show. Only the app's logic changes it; a view reads it and
//! queues commands.

use std::{sync::Arc, time::Instant};

use jiff::Timestamp;

use super::{
    alarms::Alarms,
    antenna::AntennaModel,
    clearance::Clearance,
    closing::Closing,
    copies::Copies,
    daylight::{self, SunSpan},
    effects::Effects,
    forecast::{Followed, Forecast, Forecasts, ListChoice, PassKey, Scope, ahead},
    source_tests::SourceTests,
    sources::Sources,
    uploads::Uploads,
};
use crate::{
    astro::{AzEl, Site, sun_moon},
    driver::TimeSync,
    orbit::{Catalog, LookAngles, is_sunlit},
    plan::{Follow, Target},
    station::Station,
};

/// For how long the way of a satellite that is not selected is drawn.
const AHEAD_S: f64 = 300.0;

/// Which view fills the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum View {
    /// Watch and drive.
    #[default]
    Operate,
    /// The catalogue and where it comes from.
    Elements,
    /// The settings of the units.
    Antennas,
    /// What goes over the links.
    Console,
    /// The station's settings.
    Preferences,
}

/// The elements.
#[derive(Debug, Clone)]
pub enum CatalogState {
    /// They are being read.
    Loading,
    /// They are here.
    Ready(Arc<Catalog>),
    /// There are none, and why.
    Failed,
}

/// Everything that is shown.
pub struct Model {
    /// UTC of this frame.
    pub now: Timestamp,
    /// The steady clock of this frame, for ages.
    pub steady: Instant,
    /// How the clock behind [`now`](Self::now) is kept.
    pub time_sync: TimeSync,
    /// The station as saved.
    pub station: Station,
    /// The station is the demo station with simulated antennas.
    pub demo: bool,
    /// The elements.
    pub catalog: CatalogState,
    /// Where the elements come from.
    pub sources: Sources,
    /// The antennas of the station.
    pub antennas: Vec<AntennaModel>,
    /// Which of them the card shows.
    pub selected_antenna: usize,
    /// The passes to come.
    pub forecasts: Forecasts,
    /// Which of them the list shows.
    pub list: ListChoice,
    /// The pass that is shown.
    pub selected: Option<PassKey>,
    /// The sky at `now`.
    pub sky: Sky,
    /// Files of elements on their way to units.
    pub uploads: Uploads,
    /// The sources that units are told to use, tested from here.
    pub source_tests: SourceTests,
    /// What the keep-outs do to the passes to come.
    pub effects: Effects,
    /// What must not be missed.
    pub alarms: Alarms,
    /// Copies of the settings of units.
    pub copies: Copies,
    /// Which view fills the window.
    pub view: View,
    /// The window is about to close, and what it waits for.
    pub closing: Option<Closing>,
}

/// The sky of the site.
#[derive(Debug, Default)]
pub struct Sky {
    /// The satellites of the list that are up.
    pub satellites: Vec<Seen>,
    /// The satellite of the selected pass, up or not.
    pub selected: Option<Selected>,
    /// What the horizon mask leaves of the selected pass.
    pub clearance: Clearance,
    /// The Sun.
    pub sun: Option<AzEl>,
    /// The Moon.
    pub moon: Option<AzEl>,
    /// Day and night from a little before now for the next hours.
    pub sun_spans: Vec<SunSpan>,
    seconds: Option<i64>,
    sun_spans_of: Option<(Site, i64)>,
}

/// A satellite above the horizon.
#[derive(Debug)]
pub struct Seen {
    /// Which.
    pub satellite: Arc<Followed>,
    /// Where.
    pub direction: AzEl,
    /// Where it goes in the next minutes.
    pub ahead: Vec<AzEl>,
}

/// The satellite of the selected pass.
#[derive(Debug, Clone, Copy)]
pub struct Selected {
    /// Where it stands and how it moves.
    pub look: LookAngles,
    /// The Sun shines on it.
    pub sunlit: bool,
}

impl Model {
    /// The selected antenna.
    pub fn antenna(&self) -> Option<&AntennaModel> {
        self.antennas.get(self.selected_antenna)
    }

    /// The selected pass.
    pub fn selected_pass(&self) -> Option<&Forecast> {
        self.forecasts.find(self.selected?)
    }

    /// The pass of a followed satellite that is under way, or else its next one.
    pub fn pass_of(&self, catalog_number: u32) -> Option<&Forecast> {
        let passes = &self.forecasts.favourites.passes;
        passes.iter().find(|forecast| forecast.number() == catalog_number)
    }

    /// The pass of a followed satellite that is under way or comes next.
    pub fn next_pass(&self) -> Option<&Forecast> {
        let moving = |forecast: &&Forecast| !forecast.satellite.elements.is_geosynchronous();
        let passes = &self.forecasts.favourites.passes;
        passes.iter().find(moving).or(passes.first())
    }

    /// The passes that the list shows.
    pub fn listed(&self) -> &[Forecast] {
        match self.list.scope {
            Scope::Favourites => self.forecasts.favourites.within(self.now, self.list.span_h()),
            Scope::All => &self.forecasts.all.passes,
        }
    }

    /// What an antenna has to follow for the pass of `forecast` and the passes of
    /// its satellite after it, as far as they are known.
    pub fn follow_of(&self, forecast: &Forecast) -> Follow {
        let number = forecast.number();
        let later = |other: &&Forecast| {
            other.number() == number && other.pass.aos.time > forecast.pass.aos.time
        };
        let favourites = self.forecasts.favourites.passes.iter();
        let passes = favourites.filter(later).chain(self.forecasts.all.passes.iter().filter(later));
        let passes = std::iter::once(forecast).chain(passes);
        let mut passes: Vec<_> =
            passes.map(|forecast| (forecast.pass.aos.time, forecast.pass.los.time)).collect();
        passes.sort_unstable();
        // Both lists may hold the same pass, found at another time.
        passes.dedup_by(|later, earlier| later.0 < earlier.1);
        if forecast.is_always_up() {
            passes.clear();
        }
        let elements = Box::new(forecast.satellite.elements.clone());
        Follow { target: Target::Satellite(elements), site: self.station.site, passes }
    }

    /// Puts everything at its place for `now`.
    pub fn refresh_sky(&mut self) {
        let (site, now) = (self.station.site, self.now);
        let pass = self.selected.and_then(|key| self.forecasts.find(key));
        self.sky.clearance.refresh(pass, site, self.station.horizon_mask.as_ref());
        let selected = self.selected_pass().map(|forecast| Arc::clone(&forecast.satellite));
        self.sky.refresh(&self.forecasts.favourites.satellites, selected.as_deref(), site, now);
    }
}

impl Sky {
    fn refresh(
        &mut self,
        satellites: &[Arc<Followed>],
        selected: Option<&Followed>,
        site: Site,
        now: Timestamp,
    ) {
        // The one that is compared with the antenna moves with every frame.
        self.selected = selected.and_then(|satellite| {
            let look = satellite.propagator.look_from(site, now).ok()?;
            let state = satellite.propagator.state_at(now).ok()?;
            Some(Selected { look, sunlit: is_sunlit(&state, now) })
        });
        if self.seconds == Some(now.as_second()) {
            return;
        }
        self.seconds = Some(now.as_second());
        self.sun = Some(sun_moon::sun(site, now));
        self.refresh_sun_spans(site, now);
        self.moon = Some(sun_moon::moon(site, now));
        self.satellites = satellites
            .iter()
            .filter_map(|satellite| {
                let look = satellite.propagator.look_from(site, now).ok()?;
                (look.direction.elevation_deg() > 0.0).then(|| Seen {
                    satellite: Arc::clone(satellite),
                    direction: look.direction,
                    ahead: ahead(satellite, site, now, AHEAD_S),
                })
            })
            .collect();
    }

    /// Made anew every minute.
    fn refresh_sun_spans(&mut self, site: Site, now: Timestamp) {
        let made_of = (site, now.as_second() / 60);
        if self.sun_spans_of == Some(made_of) {
            return;
        }
        self.sun_spans_of = Some(made_of);
        self.sun_spans = daylight::spans(site, now);
    }
}
