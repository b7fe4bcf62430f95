//! The satellites over the globe, for the map: recomputed once a second, their tracks less often.

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

/// Part of the track of the selected satellite that lies behind it, minutes.
pub const FLOWN_MIN: u32 = 50;
/// Part of the track of the selected satellite that lies ahead of it, minutes.
pub const AHEAD_MIN: u32 = 150;
/// Part of the track of any other satellite that lies ahead of it: one orbit of a low one, minutes.
const OTHERS_AHEAD_MIN: u32 = 100;
/// Steps of the tracks of the selected satellite and of the others, seconds.
const STEP_S: u32 = 20;
const OTHERS_STEP_S: u32 = 60;
/// Tracks of satellites that are not selected and are computed in one second: the frame must not
/// wait for those of a long list.
const TRACKS_AT_ONCE: usize = 8;
/// Time in which a satellite shows which way it goes, seconds.
const HEADING_S: f64 = 1.0;
/// A satellite that is slower over the ground goes nowhere, degrees a second.
const STANDS_BELOW_DEG_S: f64 = 0.000_5;

/// The globe at one moment.
#[derive(Debug, Default)]
pub struct Globe {
    /// The favourites, the selected satellite and those that antennas track, the highest over the
    /// station first.
    pub satellites: Vec<GlobeSatellite>,
    /// The point with the Sun in its zenith.
    pub subsolar: Option<GroundPoint>,
    /// The part that has night.
    pub night: Option<Cap>,
    /// The elevation from which on a satellite is up, at the station and in the footprints.
    pub aos_elevation: Angle,
    tracks: HashMap<u32, KeptTrack>,
    made_of: Option<MadeOf>,
}

/// A satellite over the globe.
#[derive(Debug, Clone)]
pub struct GlobeSatellite {
    pub satellite: Arc<ListedSatellite>,
    /// Its pass is selected, or was until it was over.
    pub is_selected: bool,
    pub is_favourite: bool,
    /// An antenna tracks it.
    pub is_tracked: bool,
    pub below: SubPoint,
    /// Inertial.
    pub speed_km_s: f64,
    /// From the station.
    pub look: LookAngles,
    /// The ground from which it is seen at the AOS elevation or higher.
    pub footprint: Cap,
    /// Above the AOS elevation and clear of the horizon mask at the station.
    pub is_up: bool,
    /// Direction over the ground, from north over east; `None` if it stands still.
    pub heading: Option<Angle>,
    pub is_sunlit: bool,
    /// The pass that is under way or comes next.
    pub next: Option<NextPass>,
    /// The ground track: of the selected satellite also what it has flown. Empty until computed.
    pub track: Arc<[TrackPoint]>,
}

/// A pass in short.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextPass {
    pub aos: Timestamp,
    pub los: Timestamp,
    pub max_elevation: Angle,
    /// The satellite neither rises nor sets within the list.
    pub is_always_up: bool,
}

/// A side of the map.
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

/// Whatever a change of which is shown at once.
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

    /// The next satellite on that side of the selected one, among those that `is_shown`; the
    /// highest over the station if none is selected. Only a satellite with a pass can be selected.
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

    /// Recomputes the globe if the second or something else that it shows has changed.
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
        // Up from AOS to LOS, which need not be apparent.
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

    /// Computes the tracks whose time has come, that of the selected satellite first.
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
    /// The track that is wanted now, without its points. It begins at a full step, so that it is
    /// kept for a while.
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

/// The satellites of the map, each once, the selected one first.
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
