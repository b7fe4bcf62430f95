//! Time that the sky plot shows: now, or a planned moment that the operator looks at. It changes
//! only the picture; no command follows from it.

pub(super) mod row;

use jiff::Timestamp;

use crate::{
    astro::{Site, time::add_seconds},
    contract::passes::{PassListKey, PredictedPass},
    model::{Model, Sky},
    ui::{format, sky_plot::PlannedAntenna, words},
};

/// Time of the sky plot, from the operator's choice until that time is over.
#[derive(Debug, Default)]
pub struct SkyTime {
    /// Time shown; `None` for now.
    time: Option<Timestamp>,
    sky: Option<(SkyKey, Sky)>,
    /// Flag: the slider had the keyboard focus in the last frame.
    pub has_focus: bool,
    /// Flag: the operator clicked in the sky of another time.
    is_click_refused: bool,
}

/// Inputs from which a sky was computed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SkyKey {
    time: Timestamp,
    site: Site,
    passes_revision: u64,
    selected: Option<PassListKey>,
}

impl SkyTime {
    /// Returns the time shown; `None` for now.
    pub fn time(&self) -> Option<Timestamp> {
        self.time
    }

    pub fn return_to_now(&mut self) {
        (self.time, self.sky, self.is_click_refused) = (None, None, false);
    }

    /// Shows another time, at most the end of the schedule. A past time shows now.
    pub fn show_at(&mut self, model: &Model, time: Timestamp) {
        self.is_click_refused = false;
        match model.schedule_until() {
            Some(end) if time > model.now => self.time = Some(time.min(end)),
            _ => self.return_to_now(),
        }
    }

    /// Shows a time `by_s` seconds later, or earlier if negative.
    pub fn step(&mut self, model: &Model, by_s: f64) {
        self.show_at(model, add_seconds(self.time.unwrap_or(model.now), by_s));
    }

    /// Refuses a click in the sky of another time: the click points no antenna, and a note says so.
    pub(super) fn refuse_click(&mut self) {
        self.is_click_refused = true;
    }

    /// Computes the sky of the time shown. Returns to now once that time is over or the schedule no
    /// longer holds it.
    pub(super) fn keep(&mut self, model: &Model) {
        let Some(time) = self.time else { return };
        let Some(end) = model.schedule_until().filter(|_| time > model.now) else {
            return self.return_to_now();
        };
        let time = time.min(end);
        self.time = Some(time);
        let key = SkyKey {
            time,
            site: model.station.site,
            passes_revision: model.pass_lists.favourites.revision,
            selected: model.selected_pass().map(PredictedPass::key),
        };
        if self.sky.as_ref().is_none_or(|(sky_key, _)| *sky_key != key) {
            self.sky = Some((key, model.sky_at(time)));
        }
    }

    /// Returns the sky of the time shown; `None` for now.
    pub(super) fn sky(&self) -> Option<&Sky> {
        let (_, sky) = self.sky.as_ref().filter(|_| self.time.is_some())?;
        Some(sky)
    }

    /// Describes the time shown; `None` for now.
    pub(super) fn words(&self, model: &Model) -> Option<String> {
        let time = self.time?;
        let moment = format::moment(time, model.now);
        Some(format!("Sky at {moment}, in {}", format::time_left(model.now, time)))
    }
}

/// Returns the positions of the antennas in the schedule at `time`.
pub(super) fn planned_antennas(model: &Model, time: Timestamp) -> Vec<PlannedAntenna<'_>> {
    let antennas = model.antennas.iter().enumerate();
    let planned = antennas.filter_map(|(index, antenna)| {
        let pose = model.pose_at(antenna, time)?;
        Some(PlannedAntenna {
            index,
            name: &antenna.config.name,
            doing: words::schedule::doing(model, pose.doing),
            pointing: pose.pointing,
        })
    });
    planned.collect()
}
