//! Disk work of a replay, on a thread: it finds the state at a moment.

use std::path::PathBuf;

use jiff::Timestamp;

use crate::{
    astro::Site,
    contract::{
        Snapshot,
        driver::WireLog,
        record::PassTimes,
        recorded::{RecordLook, Recorded},
    },
    engine::{film::Projector, recorded::read_record},
    model::replay::{JumpNews, Stretch},
    record::{self, FilmError, Neighbour},
    station::AntennaId,
};

/// Moment to find.
#[derive(Debug, Clone, Copy)]
pub(super) enum FilmTarget {
    At(Timestamp),
    /// Next event after `start`, or the previous event.
    Event {
        start: Timestamp,
        is_next: bool,
    },
    /// Start of the next pass, or of the previous pass.
    Pass {
        reference: Neighbour,
        is_next: bool,
    },
}

/// A projector for the record at `path`.
pub(super) struct Room {
    path: PathBuf,
    /// Projector of the record; `None` until its first use.
    projector: Option<Projector>,
}

/// Stretch without film.
type Hole = (Timestamp, Timestamp);

/// Requests to a [`Room`].
#[derive(Default)]
pub(super) struct RoomRequest {
    pub(super) target: Option<FilmTarget>,
    pub(super) look: Option<RecordLook>,
    /// Stretch whose passes the replay has not marked yet.
    pub(super) unmarked: Option<Stretch>,
}

/// Results of a [`Room`].
#[derive(Default)]
pub(super) struct Answer {
    /// Moment that was found, or the reason why there is none.
    pub(super) found: Option<Result<Found, JumpNews>>,
    pub(super) recorded: Option<Recorded>,
    pub(super) passes: Option<(Stretch, Vec<PassTimes>)>,
}

/// Moment that was found, with its scene.
pub(super) struct Found {
    pub(super) time: Timestamp,
    /// New stretch to show; `None` keeps the current stretch.
    pub(super) stretch: Option<Stretch>,
    /// Gap in the film around `time`.
    pub(super) hole: Option<Hole>,
    /// Gap in the film that the search passed over.
    pub(super) skipped: Option<Hole>,
    pub(super) scene: Result<Option<Scene>, FilmError>,
}

/// Shown state of the station, with the lines on its links.
pub(super) struct Scene {
    pub(super) shown: Snapshot,
    pub(super) wires: Vec<(AntennaId, WireLog)>,
}

impl Room {
    pub(super) fn new(path: PathBuf) -> Self {
        Self { path, projector: None }
    }

    pub(super) fn answer(&mut self, request: RoomRequest, site: Site) -> Answer {
        let RoomRequest { target, look, unmarked } = request;
        Answer {
            recorded: look.map(|look| read_record(&self.path, look, site)),
            found: target.map(|target| self.find(target)),
            passes: unmarked.map(|stretch| {
                let passes = self.passes(&stretch, site);
                (stretch, passes)
            }),
        }
    }

    /// Returns the passes of a stretch, or none after an error: a replay also works without them.
    fn passes(&self, stretch: &Stretch, site: Site) -> Vec<PassTimes> {
        let passes = match stretch.pass {
            Some(pass) => record::times_of_pass(&self.path, pass.id, site)
                .map(|times| times.into_iter().collect()),
            None => record::times_between(&self.path, stretch.start, stretch.end, site),
        };
        passes.unwrap_or_else(|error| {
            tracing::warn!(%error, "the passes of a replay are not marked");
            Vec::new()
        })
    }

    fn projector(&mut self) -> Result<&mut Projector, FilmError> {
        let projector = match self.projector.take() {
            Some(projector) => projector,
            None => Projector::open(&self.path)?,
        };
        Ok(self.projector.insert(projector))
    }

    fn find(&mut self, target: FilmTarget) -> Result<Found, JumpNews> {
        let (stretch, moment) = match target {
            FilmTarget::At(time) => (None, Ok((time, None))),
            FilmTarget::Event { start: begin, is_next } => {
                match self.event(begin, is_next).transpose() {
                    None => return Err(JumpNews::NoEvent { is_next }),
                    // If the film cannot be read, stay at `begin` and report the error.
                    Some(moment) => (None, moment.map_err(|error| (begin, error))),
                }
            }
            FilmTarget::Pass { reference, is_next } => {
                let pass = record::neighbour(&self.path, reference, is_next);
                let pass = pass.map_err(|error| JumpNews::Failed(error.to_string()))?;
                let stretch = Stretch::new(&pass.ok_or(JumpNews::NoPass { is_next })?);
                let start = stretch.start;
                (Some(stretch), Ok((start, None)))
            }
        };
        Ok(match moment {
            Ok((time, skipped)) => {
                let hole = self.projector().and_then(|projector| projector.film().hole_at(time));
                Found { time, stretch, hole: hole.ok().flatten(), skipped, scene: self.scene(time) }
            }
            Err((time, error)) => {
                Found { time, stretch, hole: None, skipped: None, scene: Err(error) }
            }
        })
    }

    /// Returns the time of the next or previous event, and the gap passed over on the way.
    fn event(
        &mut self,
        start: Timestamp,
        is_next: bool,
    ) -> Result<Option<(Timestamp, Option<Hole>)>, FilmError> {
        let film = self.projector()?.film();
        let Some(event) = film.event(start, is_next)? else { return Ok(None) };
        let shown = film.shown_from(event)?;
        // The picture of an event also shows the events shortly before it.
        let time = if is_next || shown < start { shown } else { event };
        let skipped = film.hole(start.min(time), start.max(time))?;
        Ok(Some((time, skipped)))
    }

    fn scene(&mut self, time: Timestamp) -> Result<Option<Scene>, FilmError> {
        let projector = self.projector()?;
        let Some(shown) = projector.seek(time)? else { return Ok(None) };
        let wires = projector.wires(&shown, time)?;
        Ok(Some(Scene { shown, wires }))
    }
}
