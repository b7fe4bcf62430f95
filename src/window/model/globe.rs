//! Satellites over the globe, for the map. Azel updates them once a second and their tracks less
//! often.

use std::{collections::HashMap, sync::Arc};

use jiff::Timestamp;

use super::Model;
use crate::{
    astro::{Angle, Cap, GroundPoint, sun_moon, time::add_seconds},
    contract::{
        antenna::AntennaModel,
        passes::{ListedSatellite, Observer},
    },
    orbit::{LookAngles, State, SubPoint, TrackPoint, is_sunlit},
    station::Station,
};

/// Past part of the ground track of the selected satellite, minutes.
pub const FLOWN_MIN: u32 = 50;
/// Future part of the ground track of the selected satellite, minutes.
pub const AHEAD_MIN: u32 = 150;
/// Future part of the ground track of any other satellite, minutes: one orbit of a low satellite.
const OTHERS_AHEAD_MIN: u32 = 100;
/// Steps of the tracks of the selected satellite and of the others, seconds.
const STEP_S: u32 = 20;
const OTHERS_STEP_S: u32 = 60;
/// Max number of unselected satellites whose tracks Azel computes per second. The frame must not
/// wait for the tracks of a long list.
const TRACKS_AT_ONCE: usize = 8;
/// Time over which the heading of a satellite is measured, seconds.
const HEADING_S: f64 = 1.0;
/// Min ground speed of a satellite with a heading, degrees a second.
const STANDS_BELOW_DEG_S: f64 = 0.000_5;

/// The globe at one moment.
#[derive(Debug, Default)]
pub struct Globe {
    /// The favourites, the selected satellite and the tracked satellites, the highest over the
    /// station first.
    pub satellites: Vec<GlobeSatellite>,
    /// Ground point with the Sun in the zenith.
    pub subsolar: Option<GroundPoint>,
    /// Part of the globe with night.
    pub night: Option<Cap>,
    /// Elevation above which a satellite counts as up, at the station and in the footprints.
    pub aos_elevation: Angle,
    tracks: HashMap<u32, KeptTrack>,
    made_of: Option<MadeOf>,
}

/// A satellite over the globe.
#[derive(Debug, Clone)]
pub struct GlobeSatellite {
    pub satellite: Arc<ListedSatellite>,
    /// `true` if a pass of the satellite is or was last selected.
    pub is_selected: bool,
    pub is_favourite: bool,
    /// `true` if an antenna tracks the satellite.
    pub is_tracked: bool,
    pub below: SubPoint,
    /// Inertial speed, km/s.
    pub speed_km_s: f64,
    /// Look angles from the station.
    pub look: LookAngles,
    /// Ground area from which the satellite is seen at the AOS elevation or higher.
    pub footprint: Cap,
    /// `true` if the satellite is above the AOS elevation and clear of the station's horizon mask.
    pub is_up: bool,
    /// Direction over the ground, clockwise from north; `None` if the satellite hardly moves.
    pub heading: Option<Angle>,
    pub is_sunlit: bool,
    /// The current or next pass.
    pub next: Option<NextPass>,
    /// The ground track ahead; for the selected satellite also its past part. Empty until computed.
    pub track: Arc<[TrackPoint]>,
}

/// A summary of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextPass {
    pub aos: Timestamp,
    pub los: Timestamp,
    pub max_elevation: Angle,
    /// `true` if the satellite neither rises nor sets within the list.
    pub is_always_up: bool,
}

/// A direction on the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapDirection {
    North,
    East,
    South,
    West,
}

#[derive(Debug)]
struct KeptTrack {
    epoch: Timestamp,
    is_selected: bool,
    start: Timestamp,
    points: Arc<[TrackPoint]>,
}

/// Inputs of the globe. The map shows a change of any of them immediately.
#[derive(Debug, Clone)]
struct MadeOf {
    second: i64,
    selected: Option<u32>,
    tracked: Vec<u32>,
    revision: u64,
    station: Arc<Station>,
}

impl MadeOf {
    fn new(model: &Model) -> Self {
        Self {
            second: model.now.as_second(),
            selected: model.selected.map(|(number, _)| number),
            tracked: model.antennas.iter().filter_map(AntennaModel::tracked_number).collect(),
            revision: model.pass_lists.favourites.revision,
            station: Arc::clone(&model.station),
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        self.second == other.second
            && self.selected == other.selected
            && self.tracked == other.tracked
            && self.revision == other.revision
            && Arc::ptr_eq(&self.station, &other.station)
    }
}

impl GlobeSatellite {
    pub fn number(&self) -> u32 {
        self.satellite.elements.catalog_number()
    }
}

impl Globe {
    pub fn selected(&self) -> Option<&GlobeSatellite> {
        self.satellites.iter().find(|satellite| satellite.is_selected)
    }

    /// Returns the next satellite on that side of the selected one, among the satellites that
    /// `is_shown` accepts. Returns the highest over the station if none is selected. Only a
    /// satellite with a pass can be selected.
    pub fn nearest(
        &self,
        direction: MapDirection,
        is_shown: impl Fn(&GlobeSatellite) -> bool,
    ) -> Option<u32> {
        let mut others = self.satellites.iter().filter(|satellite| {
            let can_be_selected = satellite.next.is_some() && !satellite.is_selected;
            can_be_selected && is_shown(satellite)
        });
        let Some(start) = self.selected() else { return others.next().map(GlobeSatellite::number) };
        let effort = |end: &GlobeSatellite| {
            let start = start.below.point;
            let east = (end.below.point.longitude - start.longitude).wrapped_180().degrees();
            let north = (end.below.point.latitude - start.latitude).degrees();
            let (along, across) = match direction {
                MapDirection::North => (north, east),
                MapDirection::East => (east, north),
                MapDirection::South => (-north, east),
                MapDirection::West => (-east, north),
            };
            (along > 0.0).then(|| along + 2.0 * across.abs())
        };
        others
            .filter_map(|satellite| Some((effort(satellite)?, satellite.number())))
            .min_by(|(a, _), (b, _)| a.total_cmp(b))
            .map(|(_, number)| number)
    }

    /// Recomputes the globe if the second or another input has changed.
    pub(super) fn refresh(&mut self, model: &Model) {
        let made_of = MadeOf::new(model);
        if self.made_of.as_ref().is_some_and(|before| before.is_same(&made_of)) {
            return;
        }
        let now = model.now;
        self.subsolar = Some(sun_moon::subsolar_point(now));
        self.night = Some(sun_moon::night(now));
        self.aos_elevation = Observer::from_station(&model.station).aos_elevation;
        self.refresh_tracks(&made_of, model);
        self.satellites = self.placed(&made_of, model);
        self.made_of = Some(made_of);
    }

    fn placed(&self, made_of: &MadeOf, model: &Model) -> Vec<GlobeSatellite> {
        let mut next = HashMap::new();
        for predicted in model.pass_lists.favourites.upcoming(model.now).iter() {
            let pass = predicted.pass;
            next.entry(predicted.number()).or_insert(NextPass {
                aos: pass.aos.time,
                los: pass.los.time,
                max_elevation: pass.max_elevation(),
                is_always_up: predicted.is_always_up(),
            });
        }
        let mut placed: Vec<GlobeSatellite> = listed(made_of, model)
            .into_iter()
            .filter_map(|satellite| {
                let next = next.get(&satellite.elements.catalog_number()).copied();
                self.place(satellite, next, made_of, model)
            })
            .collect();
        let elevation = |object: &GlobeSatellite| object.look.direction.elevation.radians();
        placed.sort_by(|a, b| elevation(b).total_cmp(&elevation(a)));
        placed
    }

    fn place(
        &self,
        satellite: Arc<ListedSatellite>,
        next: Option<NextPass>,
        made_of: &MadeOf,
        model: &Model,
    ) -> Option<GlobeSatellite> {
        let (now, station) = (model.now, &model.station);
        let number = satellite.elements.catalog_number();
        let state = satellite.propagator.state_at(now).ok()?;
        let below = state.sub_point(now);
        let look = state.look_from(station.site, now);
        let mask = station.horizon_mask.as_ref();
        let skyline = mask.map_or(Angle::ZERO, |mask| mask.elevation_at(look.direction.azimuth));
        // A satellite counts as up from AOS to LOS, which may use the geometric elevation.
        let of_pass = |direction| station.site.pass_direction(direction).elevation;
        let elevation = of_pass(state.look_from(station.site.airless(), now).direction);
        let lowest = self.aos_elevation.radians().max(skyline.radians());
        Some(GlobeSatellite {
            is_selected: made_of.selected == Some(number),
            is_favourite: station.favourites.contains(number),
            is_tracked: made_of.tracked.contains(&number),
            speed_km_s: state.velocity_km_s.length(),
            footprint: below.footprint(station.site.geometric_of_pass(self.aos_elevation)),
            is_up: elevation.radians() >= lowest,
            heading: heading(&satellite, &below, now),
            is_sunlit: is_sunlit(&state, now),
            track: self.tracks.get(&number).map(|track| &track.points).cloned().unwrap_or_default(),
            satellite,
            below,
            look,
            next,
        })
    }

    /// Computes the tracks that are due, the selected satellite's track first.
    fn refresh_tracks(&mut self, made_of: &MadeOf, model: &Model) {
        let satellites = listed(made_of, model);
        let numbers: Vec<u32> =
            satellites.iter().map(|satellite| satellite.elements.catalog_number()).collect();
        self.tracks.retain(|number, _| numbers.contains(number));
        let mut left = TRACKS_AT_ONCE;
        for (satellite, number) in satellites.iter().zip(numbers) {
            let is_selected = made_of.selected == Some(number);
            let fresh = KeptTrack::empty(satellite, is_selected, model.now);
            if self.tracks.get(&number).is_some_and(|track| track.is_same(&fresh)) {
                continue;
            }
            if !is_selected {
                let Some(fewer) = left.checked_sub(1) else { continue };
                left = fewer;
            }
            self.tracks.insert(number, fresh.computed(satellite));
        }
    }
}

impl KeptTrack {
    /// Returns the required track without its points. The track begins at a full step, so that it
    /// stays valid for a while.
    fn empty(satellite: &ListedSatellite, is_selected: bool, now: Timestamp) -> Self {
        let (period_s, flown_s) = if is_selected {
            (i64::from(STEP_S), i64::from(FLOWN_MIN) * 60)
        } else {
            (2 * i64::from(OTHERS_STEP_S), 0)
        };
        let second = now.as_second();
        let from_second = second - second.rem_euclid(period_s) - flown_s;
        let start = Timestamp::from_second(from_second).unwrap_or(now);
        let epoch = satellite.elements.epoch();
        Self { epoch, is_selected, start, points: Arc::default() }
    }

    fn is_same(&self, other: &Self) -> bool {
        (self.epoch, self.is_selected, self.start) == (other.epoch, other.is_selected, other.start)
    }

    fn computed(self, satellite: &ListedSatellite) -> Self {
        let (step_s, span_min) = if self.is_selected {
            (STEP_S, FLOWN_MIN + AHEAD_MIN)
        } else {
            (OTHERS_STEP_S, OTHERS_AHEAD_MIN)
        };
        let count = span_min * 60 / step_s + 1;
        let track = satellite.propagator.ground_track(self.start, f64::from(step_s), count);
        Self { points: track.into(), ..self }
    }
}

/// Returns the satellites of the map, each once, the selected one first.
fn listed(made_of: &MadeOf, model: &Model) -> Vec<Arc<ListedSatellite>> {
    let mut listed: Vec<Arc<ListedSatellite>> = Vec::new();
    let chosen = made_of.selected.iter().chain(&made_of.tracked);
    let chosen = chosen.filter_map(|number| model.pass_lists.satellite(*number));
    for satellite in chosen.chain(model.pass_lists.favourites.satellites.iter()) {
        let number = satellite.elements.catalog_number();
        if !listed
            .iter()
            .any(|listed_satellite| listed_satellite.elements.catalog_number() == number)
        {
            listed.push(Arc::clone(satellite));
        }
    }
    listed
}

fn heading(satellite: &ListedSatellite, below: &SubPoint, now: Timestamp) -> Option<Angle> {
    let time = add_seconds(now, HEADING_S);
    let state: State = satellite.propagator.state_at(time).ok()?;
    let end = state.sub_point(time).point;
    let moved = below.point.distance(end).degrees();
    (moved >= STANDS_BELOW_DEG_S * HEADING_S).then(|| below.point.bearing(end))
}
