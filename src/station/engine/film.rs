//! Conversion of a station's snapshots to pictures of its film, and back.

use std::{any::Any, collections::HashMap, path::Path, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use crate::{
    astro::time::{add_seconds, seconds_between},
    clock::Moment,
    contract::{
        CatalogState, Snapshot,
        antenna::{AntennaModel, ErrorSample, Errors, PastTrack, PastTracks},
        driver::{self, LinkState, WireLog},
        passes::PassLists,
        written,
    },
    engine::passes,
    orbit::{Catalog, Elements, ReadReport},
    record::{Film, FilmError, Parts, Picture},
    station::{AntennaId, Station},
};

/// Name of the source that a film's elements appear under.
const RECORDED_SOURCE: &str = "record";

/// Span of shown lines before the selected moment, seconds.
const WIRE_S: f64 = 300.0;

/// Snapshot with part numbers in place of its large parts.
#[derive(Serialize, Deserialize)]
struct Drawn {
    shown: Snapshot,
    antennas: Vec<DrawnAntenna>,
    station: i64,
    satellites: i64,
    sources: i64,
    older_sets: Option<i64>,
    // Older films lack the next two fields.
    pointing_fitted: Option<i64>,
    peaks: Option<i64>,
    reminders: i64,
    schedule: i64,
    swap: Option<i64>,
    day: i64,
    uploads: i64,
    source_tests: i64,
    link_tests: i64,
    copies: i64,
    /// Calls of hooks; older films lack them.
    hooks: Option<i64>,
}

/// Errors of an antenna: whole chunks and newest samples of the current track, and past tracks.
#[derive(Serialize, Deserialize)]
struct DrawnAntenna {
    chunks: Vec<i64>,
    newest: Vec<ErrorSample>,
    past_tracks: Vec<i64>,
}

impl Picture for Snapshot {
    fn moment(&self) -> Moment {
        self.moment
    }

    fn draw(&self, parts: &mut Parts) -> serde_json::Result<Value> {
        // Name all fields: a new field must be drawn too.
        let Self {
            moment,
            time_sync,
            station,
            station_saved_at,
            demo,
            station_unread,
            catalog,
            catalog_revision,
            sources,
            older_sets,
            // `recorded` is left out: the film is part of the record that it describes.
            recorded: _,
            pointing_fitted,
            peaks,
            antennas,
            pass_lists,
            reminders,
            schedule,
            swap,
            day,
            uploads,
            source_tests,
            link_tests,
            alarms,
            copies,
            record,
            closing,
            metrics,
            hooks,
        } = self;
        let drawn = Drawn {
            antennas: (antennas.iter())
                .map(|antenna| DrawnAntenna::new(antenna, parts))
                .collect::<Result<_, _>>()?,
            station: parts.number(station)?,
            satellites: parts.number_with(&pass_lists.favourites.satellites, |satellites| {
                let elements: Vec<&Elements> =
                    satellites.iter().map(|satellite| &satellite.elements).collect();
                serde_json::to_vec(&elements)
            })?,
            sources: parts.number(sources)?,
            older_sets: older_sets.as_ref().map(|part| parts.number(part)).transpose()?,
            pointing_fitted: pointing_fitted.as_ref().map(|part| parts.number(part)).transpose()?,
            peaks: Some(parts.number(peaks)?),
            reminders: parts.number(reminders)?,
            schedule: parts.number(schedule)?,
            swap: swap.as_ref().map(|part| parts.number(part)).transpose()?,
            day: parts.number(day)?,
            uploads: parts.number(uploads)?,
            source_tests: parts.number(source_tests)?,
            link_tests: parts.number(link_tests)?,
            copies: parts.number(copies)?,
            hooks: Some(parts.number(hooks)?),
            shown: Self {
                antennas: without_parts(antennas, parts),
                time_sync: *time_sync,
                station_saved_at: *station_saved_at,
                demo: *demo,
                station_unread: *station_unread,
                catalog: catalog.clone(),
                catalog_revision: *catalog_revision,
                pass_lists: pass_lists.clone(),
                alarms: alarms.clone(),
                record: record.clone(),
                closing: closing.clone(),
                metrics: metrics.clone(),
                ..Self::before_anything(*moment)
            },
        };
        serde_json::to_value(drawn)
    }
}

/// Reads a picture by way of its text. Reading it straight from the tree would compile each type a
/// second time, and a picture is small.
fn drawn(picture: &serde_json::Value) -> serde_json::Result<Drawn> {
    serde_json::from_slice(&serde_json::to_vec(picture)?)
}

/// Returns the antennas without their large parts and without values that equal the previous
/// picture.
fn without_parts(antennas: &[AntennaModel], parts: &mut Parts) -> Vec<AntennaModel> {
    let mut antennas = antennas.to_vec();
    for (index, antenna) in antennas.iter_mut().enumerate() {
        antenna.snapshot = without_unchanged(
            format!("/shown/antennas/{index}/snapshot"),
            &antenna.snapshot,
            parts,
        );
        antenna.errors = Errors::default();
        antenna.past_tracks = PastTracks::default();
    }
    antennas
}

/// Returns the snapshot at `place` without values that equal the previous picture.
fn without_unchanged(
    place: String,
    snapshot: &Arc<driver::Snapshot>,
    parts: &mut Parts,
) -> Arc<driver::Snapshot> {
    let state_field = |field| format!("{place}/state/{field}");
    let state = &snapshot.state;
    let same_readings = parts.is_same(state_field("readings"), &state.readings);
    let same_checks = parts.is_same(state_field("checks"), &state.checks);
    let same_questions = parts.is_same(state_field("questions"), &state.questions);
    let same_held = parts.is_same(state_field("held"), &state.groups);
    // Compare the fields first: they stay known while the whole snapshot is unchanged.
    if parts.is_same(place, snapshot) {
        return Arc::new(driver::Snapshot::before_anything(LinkState::Off));
    }
    let mut snapshot = driver::Snapshot::clone(snapshot);
    if same_readings {
        snapshot.state.readings = Arc::default();
    }
    if same_checks {
        snapshot.state.checks = Arc::default();
    }
    if same_questions {
        snapshot.state.questions = Arc::default();
    }
    if same_held {
        snapshot.state.groups = Arc::default();
    }
    Arc::new(snapshot)
}

impl DrawnAntenna {
    fn new(antenna: &AntennaModel, parts: &mut Parts) -> serde_json::Result<Self> {
        let (whole, newest) = antenna.errors.chunks();
        Ok(Self {
            chunks: whole.map(|chunk| parts.number(chunk)).collect::<Result<_, _>>()?,
            newest: newest.to_vec(),
            past_tracks: (antenna.past_tracks.iter())
                .map(|track| parts.number(track))
                .collect::<Result<_, _>>()?,
        })
    }
}

/// Projector that turns a film back into snapshots.
pub struct Projector {
    film: Film,
    /// Parts of the last pictures by run and number.
    parts: HashMap<(i64, i64), StoredPart>,
    lists: Option<PredictedAgain>,
    wires: Wires,
}

/// Lines on the links of the last minutes.
#[derive(Default)]
struct Wires {
    logs: Vec<(AntennaId, WireLog)>,
    end: Timestamp,
}

struct StoredPart {
    part: Arc<dyn Any + Send + Sync>,
    is_shown: bool,
}

/// Predicted pass lists, and the input of the prediction.
struct PredictedAgain {
    station: Arc<Station>,
    elements: Arc<Vec<Elements>>,
    made_at: Option<Timestamp>,
    catalog: Arc<Catalog>,
    lists: PassLists,
}

impl Projector {
    /// Opens the film in the record at `path`.
    pub fn open(path: &Path) -> Result<Self, FilmError> {
        Ok(Self {
            film: Film::open(path)?,
            parts: HashMap::new(),
            lists: None,
            wires: Wires::default(),
        })
    }

    pub fn film(&mut self) -> &mut Film {
        &mut self.film
    }

    /// Returns the snapshot that the station showed at `time`; `None` before the first picture.
    pub fn seek(&mut self, time: Timestamp) -> Result<Option<Snapshot>, FilmError> {
        let Some(shown) = self.film.seek(time)? else { return Ok(None) };
        let run = shown.run;
        let Drawn {
            mut shown,
            antennas,
            station,
            satellites,
            sources,
            older_sets,
            pointing_fitted,
            peaks,
            reminders,
            schedule,
            swap,
            day,
            uploads,
            source_tests,
            link_tests,
            copies,
            hooks,
        } = drawn(shown.picture)?;
        let station = self.part_with(run, station, |content| {
            let mut deserializer = serde_json::Deserializer::from_slice(content);
            written::station::deserialize::<_, Station>(&mut deserializer)
        })?;
        let elements = self.part(run, satellites)?;
        for (antenna, drawn) in shown.antennas.iter_mut().zip(antennas) {
            let chunks: Vec<_> = drawn
                .chunks
                .iter()
                .map(|chunk| self.part(run, *chunk))
                .collect::<Result<_, _>>()?;
            antenna.errors = Errors::of_chunks(chunks, drawn.newest);
            let tracks: Vec<Arc<PastTrack>> = drawn
                .past_tracks
                .iter()
                .map(|chunk| self.part(run, *chunk))
                .collect::<Result<_, _>>()?;
            antenna.past_tracks = tracks.into_iter().collect();
        }
        shown.sources = self.part(run, sources)?;
        shown.older_sets = older_sets.map(|chunk| self.part(run, chunk)).transpose()?;
        shown.pointing_fitted = pointing_fitted.map(|chunk| self.part(run, chunk)).transpose()?;
        shown.peaks = peaks.map(|chunk| self.part(run, chunk)).transpose()?.unwrap_or_default();
        shown.reminders = self.part(run, reminders)?;
        shown.schedule = self.part(run, schedule)?;
        shown.swap = swap.map(|chunk| self.part(run, chunk)).transpose()?;
        shown.day = self.part(run, day)?;
        shown.uploads = self.part(run, uploads)?;
        shown.source_tests = self.part(run, source_tests)?;
        shown.hooks = hooks.map(|chunk| self.part(run, chunk)).transpose()?.unwrap_or_default();
        shown.link_tests = self.part(run, link_tests)?;
        shown.copies = self.part(run, copies)?;
        self.predict(&mut shown, &station, elements);
        shown.station = station;
        self.parts.retain(|_, stored| std::mem::take(&mut stored.is_shown));
        Ok(Some(shown))
    }

    /// Returns the lines on the links of the antennas in `shown`, of the five minutes up to `time`.
    /// `time`.
    pub fn wires(
        &mut self,
        shown: &Snapshot,
        time: Timestamp,
    ) -> Result<Vec<(AntennaId, WireLog)>, FilmError> {
        let wires = &mut self.wires;
        let passed_s = seconds_between(wires.end, time);
        let antennas = shown.antennas.iter().map(AntennaModel::id);
        let goes_on = (0.0..WIRE_S).contains(&passed_s)
            && antennas.clone().eq(wires.logs.iter().map(|(antenna, _)| *antenna));
        if !goes_on {
            wires.logs = antennas.map(|antenna| (antenna, WireLog::default())).collect();
            wires.end = add_seconds(time, -WIRE_S);
        }
        for (antenna, log) in &wires.logs {
            for line in self.film.lines(*antenna, wires.end, time)? {
                log.push(line);
            }
        }
        wires.end = time;
        Ok(wires.logs.clone())
    }

    fn part<T>(&mut self, run: i64, number: i64) -> Result<Arc<T>, FilmError>
    where
        T: DeserializeOwned + Send + Sync + 'static,
    {
        self.part_with(run, number, |content| serde_json::from_slice(content))
    }

    fn part_with<T: Send + Sync + 'static>(
        &mut self,
        run: i64,
        number: i64,
        read: impl FnOnce(&[u8]) -> serde_json::Result<T>,
    ) -> Result<Arc<T>, FilmError> {
        if let Some(stored) = self.parts.get_mut(&(run, number))
            && let Ok(part) = Arc::clone(&stored.part).downcast()
        {
            stored.is_shown = true;
            return Ok(part);
        }
        let part = Arc::new(read(&self.film.part(run, number)?)?);
        self.parts.insert((run, number), StoredPart { part: part.clone(), is_shown: true });
        Ok(part)
    }

    /// Predicts the passes that the station showed from its elements, and puts them into `shown`.
    fn predict(
        &mut self,
        shown: &mut Snapshot,
        station: &Arc<Station>,
        elements: Arc<Vec<Elements>>,
    ) {
        let made_at = shown.pass_lists.favourites.made_at;
        let is_same = |again: &PredictedAgain| {
            Arc::ptr_eq(&again.station, station)
                && Arc::ptr_eq(&again.elements, &elements)
                && again.made_at == made_at
        };
        if !self.lists.as_ref().is_some_and(is_same) {
            let mut catalog = Catalog::default();
            let read = ReadReport { elements: elements.to_vec(), ..ReadReport::default() };
            catalog.merge(read, RECORDED_SOURCE);
            let catalog = Arc::new(catalog);
            let lists = passes::again(&catalog, &elements, station, made_at);
            let station = Arc::clone(station);
            self.lists = Some(PredictedAgain { station, elements, made_at, catalog, lists });
        }
        let Some(again) = &self.lists else { return };
        let favourites = &mut shown.pass_lists.favourites;
        favourites.satellites = Arc::clone(&again.lists.favourites.satellites);
        favourites.passes = Arc::clone(&again.lists.favourites.passes);
        if let CatalogState::Ready(catalog) = &mut shown.catalog {
            *catalog = Arc::clone(&again.catalog);
        }
    }
}
