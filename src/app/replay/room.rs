//! The work of a replay that takes a disk: finding what was shown, on a thread.

use std::path::PathBuf;

use jiff::Timestamp;

use crate::{
    astro::Site,
    driver::WireLog,
    engine::{
        Snapshot,
        film::Projector,
        recorded::{RecordLook, Recorded},
    },
    record::FilmError,
    station::AntennaId,
};

/// Which moment is wanted.
#[derive(Debug, Clone, Copy)]
pub(super) enum Wanted {
    At(Timestamp),
    /// The next event after this moment, or the one before.
    Event {
        from: Timestamp,
        is_next: bool,
    },
}

/// A projector for the record at `path`.
pub(super) struct Room {
    path: PathBuf,
    /// `None` until it is needed.
    projector: Option<Projector>,
}

/// What was found.
pub(super) struct Answer {
    /// The moment that was found; `None` where there is no further event.
    pub(super) at: Option<Timestamp>,
    pub(super) scene: Result<Option<Scene>, FilmError>,
    pub(super) recorded: Option<Recorded>,
}

/// What the station showed, and the lines on its links.
pub(super) struct Scene {
    pub(super) shown: Snapshot,
    pub(super) wires: Vec<(AntennaId, WireLog)>,
}

impl Room {
    pub(super) fn new(path: PathBuf) -> Self {
        Self { path, projector: None }
    }

    pub(super) fn answer(
        &mut self,
        wanted: Option<Wanted>,
        look: Option<RecordLook>,
        site: Site,
    ) -> Answer {
        let recorded = look.map(|look| Recorded::read(&self.path, look, site));
        let found = wanted.map_or(Ok(None), |wanted| self.find(wanted));
        match found {
            Ok(None) => Answer { at: None, scene: Ok(None), recorded },
            Ok(Some(at)) => Answer { at: Some(at), scene: self.scene(at), recorded },
            Err(error) => {
                let at = wanted.map(|wanted| match wanted {
                    Wanted::At(at) | Wanted::Event { from: at, .. } => at,
                });
                Answer { at, scene: Err(error), recorded }
            }
        }
    }

    fn projector(&mut self) -> Result<&mut Projector, FilmError> {
        let projector = match self.projector.take() {
            Some(projector) => projector,
            None => Projector::open(&self.path)?,
        };
        Ok(self.projector.insert(projector))
    }

    fn find(&mut self, wanted: Wanted) -> Result<Option<Timestamp>, FilmError> {
        match wanted {
            Wanted::At(at) => Ok(Some(at)),
            Wanted::Event { from, is_next } => {
                let film = self.projector()?.film();
                let Some(event) = film.event(from, is_next)? else { return Ok(None) };
                let shown = film.shown_from(event)?;
                // The picture that shows an event shows the ones shortly before it as well.
                Ok(Some(if is_next || shown < from { shown } else { event }))
            }
        }
    }

    fn scene(&mut self, at: Timestamp) -> Result<Option<Scene>, FilmError> {
        let projector = self.projector()?;
        let Some(shown) = projector.at(at)? else { return Ok(None) };
        let wires = projector.wires(&shown, at)?;
        Ok(Some(Scene { shown, wires }))
    }
}
