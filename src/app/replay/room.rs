//! The work of a replay that takes a disk: finding what was shown, on a thread.

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
    /// The next event after this moment, or the one before.
    Event {
        start: Timestamp,
        is_next: bool,
    },
    /// The beginning of the next pass, or of the one before.
    Pass {
        reference: Neighbour,
        is_next: bool,
    },
}

/// A projector for the record at `path`.
pub(super) struct Room {
    path: PathBuf,
    /// `None` until it is needed.
    projector: Option<Projector>,
}

/// A stretch of which there is no film.
type Hole = (Timestamp, Timestamp);

/// Requests to a [`Room`].
#[derive(Default)]
pub(super) struct RoomRequest {
    pub(super) target: Option<FilmTarget>,
    pub(super) look: Option<RecordLook>,
    /// The stretch whose passes are to be marked.
    pub(super) unmarked: Option<Stretch>,
}

/// Results of a [`Room`].
#[derive(Default)]
pub(super) struct Answer {
    /// The moment that was found, or why there is none.
    pub(super) found: Option<Result<Found, JumpNews>>,
    pub(super) recorded: Option<Recorded>,
    pub(super) passes: Option<(Stretch, Vec<PassTimes>)>,
}

/// A moment.
pub(super) struct Found {
    pub(super) time: Timestamp,
    /// The stretch that is shown from then on, where that is another one.
    pub(super) stretch: Option<Stretch>,
    /// The stretch around it of which there is no film.
    pub(super) hole: Option<Hole>,
    /// Stretch that was passed over, because there is no film of it.
    pub(super) skipped: Option<Hole>,
    pub(super) scene: Result<Option<Scene>, FilmError>,
}

/// State that the station showed, and the lines on its links.
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

    /// The passes of a stretch. Without them it can be shown as well.
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
                    // Where the film cannot be read, it stands still and says so.
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

    /// The moment of the next event, or of the one before, and what was passed over on the way.
    fn event(
        &mut self,
        start: Timestamp,
        is_next: bool,
    ) -> Result<Option<(Timestamp, Option<Hole>)>, FilmError> {
        let film = self.projector()?.film();
        let Some(event) = film.event(start, is_next)? else { return Ok(None) };
        let shown = film.shown_from(event)?;
        // The picture that shows an event shows the ones shortly before it as well.
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
