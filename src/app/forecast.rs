//! The passes of the followed satellites, computed in the background.

use std::sync::Arc;

use jiff::Timestamp;

use super::job::Job;
use crate::{
    astro::{
        Angle, AzEl, Site,
        time::{add_seconds, seconds_between},
    },
    driver::Wake,
    orbit::{Catalog, Elements, Pass, PassSearch, Propagator, passes},
    plan::{Sample, Trackability, trackability},
    station::{MotionLimits, Mount, Station},
};

/// How far ahead passes are listed.
const SPAN_S: f64 = 48.0 * 3600.0;
/// A pass that is under way has begun this long ago at most, but for those of
/// satellites that hardly move.
const LOOK_BACK_S: f64 = 3600.0;
/// A list older than this is made anew.
const STALE_S: f64 = 600.0;
/// A track is drawn from at most this many samples.
const MOST_SAMPLES: f64 = 600.0;

/// Which pass: the satellite and its AOS.
pub type PassKey = (u32, Timestamp);

/// A pass with all that is shown of it.
#[derive(Debug, Clone)]
pub struct Forecast {
    /// Its satellite.
    pub satellite: Arc<Followed>,
    /// Its three events.
    pub pass: Pass,
    /// The way across the sky, AOS to LOS, every 2 s or a little more.
    pub track: Vec<Sample>,
    /// What the first antenna makes of it.
    pub trackability: Option<Trackability>,
}

/// A satellite of the list.
#[derive(Debug)]
pub struct Followed {
    /// Its elements.
    pub elements: Elements,
    /// Where it goes.
    pub propagator: Propagator,
}

impl Followed {
    /// The name without what stands in brackets behind it.
    pub fn short_name(&self) -> &str {
        let name = self.elements.name();
        name.split_once(" (").map_or(name, |(short, _)| short)
    }
}

impl Forecast {
    /// Which pass this is.
    pub fn key(&self) -> PassKey {
        (self.satellite.elements.catalog_number(), self.pass.aos.time)
    }

    /// Whether the satellite is up at `now`.
    pub fn in_progress(&self, now: Timestamp) -> bool {
        self.pass.aos.time <= now && now < self.pass.los.time
    }
}

/// What a list of passes was made from.
#[derive(Debug, Clone, PartialEq)]
struct Basis {
    site: Site,
    floor: Angle,
    horizon: Angle,
    favourites: Vec<u32>,
    mount: Option<(Mount, MotionLimits)>,
}

impl Basis {
    fn of(station: &Station) -> Self {
        let antenna = station.antennas.first();
        Self {
            site: station.site,
            floor: station.elevation_floor(),
            horizon: Angle::from_degrees(
                antenna.map_or(0.0, |antenna| antenna.limits.minimum_elevation_deg),
            ),
            favourites: station.favourites.clone(),
            mount: antenna.map(|antenna| (antenna.mount, antenna.limits)),
        }
    }
}

/// The list and the work on the next one.
#[derive(Default)]
pub struct Forecasts {
    /// The followed satellites, in the order of the station.
    pub satellites: Vec<Arc<Followed>>,
    /// Passes that are not over yet, by AOS.
    pub passes: Vec<Forecast>,
    made: Option<(Basis, Timestamp)>,
    job: Option<(Basis, Timestamp, Job<Made>)>,
}

struct Made {
    satellites: Vec<Arc<Followed>>,
    passes: Vec<Forecast>,
}

impl Forecasts {
    /// Whether a new list is being made.
    pub fn under_way(&self) -> bool {
        self.job.is_some()
    }

    /// Takes a finished list, drops what is over, and starts the next list when
    /// the station has changed or the list has grown old. `true` when the list
    /// is a new one.
    pub fn refresh(
        &mut self,
        catalog: &Arc<Catalog>,
        station: &Station,
        now: Timestamp,
        wake: &Wake,
    ) -> bool {
        let finished = self.job.as_ref().and_then(|(.., job)| job.poll());
        let renewed = finished.is_some();
        if let (Some(made), Some((basis, at, _))) = (finished, self.job.take_if(|_| renewed)) {
            self.satellites = made.satellites;
            self.passes = made.passes;
            self.made = Some((basis, at));
        }
        self.passes.retain(|forecast| forecast.pass.los.time > now);

        let basis = Basis::of(station);
        let fresh = self.made.as_ref().is_some_and(|(made_of, at)| {
            *made_of == basis && seconds_between(*at, now).abs() < STALE_S
        });
        let coming = self.job.as_ref().is_some_and(|(made_of, ..)| *made_of == basis);
        if !fresh && !coming {
            let (catalog, wanted) = (Arc::clone(catalog), basis.clone());
            let work = move |cancelled: &dyn Fn() -> bool| make(&catalog, &wanted, now, cancelled);
            match Job::start("azel-passes", Arc::clone(wake), work) {
                Ok(job) => self.job = Some((basis, now, job)),
                Err(error) => tracing::error!(%error, "no thread for the passes"),
            }
        }
        renewed
    }

    /// The pass of `key`. After a new list its AOS may differ by a little.
    pub fn find(&self, key: PassKey) -> Option<&Forecast> {
        let (number, aos) = key;
        self.passes
            .iter()
            .filter(|forecast| forecast.satellite.elements.catalog_number() == number)
            .find(|forecast| {
                seconds_between(forecast.pass.aos.time, aos).abs() < 60.0
                    || (forecast.pass.starts_before && aos < forecast.pass.los.time)
            })
    }

    /// The followed satellite with this number.
    pub fn satellite(&self, catalog_number: u32) -> Option<&Arc<Followed>> {
        self.satellites.iter().find(|known| known.elements.catalog_number() == catalog_number)
    }
}

fn make(catalog: &Catalog, basis: &Basis, now: Timestamp, cancelled: &dyn Fn() -> bool) -> Made {
    let followed = |number: &u32| {
        let elements = catalog.get(*number)?.clone();
        match Propagator::new(&elements) {
            Ok(propagator) => Some(Arc::new(Followed { elements, propagator })),
            Err(error) => {
                tracing::warn!(number, %error, "cannot be propagated");
                None
            }
        }
    };
    let satellites: Vec<Arc<Followed>> = basis.favourites.iter().filter_map(followed).collect();
    let (from, to) = (add_seconds(now, -LOOK_BACK_S), add_seconds(now, SPAN_S));
    let search = PassSearch {
        aos_elevation: basis.horizon,
        floor: basis.floor,
        ..PassSearch::new(basis.site, from, to)
    };
    let mut found = Vec::new();
    for satellite in &satellites {
        for pass in passes(&satellite.propagator, &search, cancelled) {
            if pass.los.time <= now {
                continue;
            }
            let track = track(&satellite.propagator, basis.site, &pass);
            let trackability = basis
                .mount
                .map(|(mount, limits)| trackability(&track, mount, limits.maximum_rate_deg_s));
            let satellite = Arc::clone(satellite);
            found.push(Forecast { satellite, pass, track, trackability });
        }
    }
    found.sort_by_key(Forecast::aos_then_number);
    Made { satellites, passes: found }
}

impl Forecast {
    fn aos_then_number(&self) -> (Timestamp, u32) {
        (self.pass.aos.time, self.satellite.elements.catalog_number())
    }
}

fn track(propagator: &Propagator, site: Site, pass: &Pass) -> Vec<Sample> {
    let duration_s = pass.duration_s();
    let step_s = (duration_s / MOST_SAMPLES).max(2.0);
    let count = (duration_s / step_s).ceil() as usize;
    (0..=count)
        .map(|index| add_seconds(pass.aos.time, (index as f64 * step_s).min(duration_s)))
        .filter_map(|time| {
            let look = propagator.look_from(site, time).ok()?;
            Some(Sample { time, direction: look.direction })
        })
        .collect()
}

/// Where a satellite goes in the next `span_s`, in steps of 30 s.
pub fn ahead(satellite: &Followed, site: Site, now: Timestamp, span_s: f64) -> Vec<AzEl> {
    let steps = (span_s / 30.0) as usize;
    (0..=steps)
        .map_while(|step| {
            let look = satellite.propagator.look_from(site, add_seconds(now, step as f64 * 30.0));
            look.ok().map(|look| look.direction)
        })
        .take_while(|direction| direction.elevation_deg() > 0.0)
        .collect()
}
