//! The time that the sky plot shows: now, or a moment of the plan that the operator looks at. It
//! changes the picture alone; no command follows from it.

pub(super) mod row;

use jiff::Timestamp;

use crate::{
    astro::{Site, time::add_seconds},
    contract::passes::{PassListKey, PredictedPass},
    model::{Model, Sky},
    ui::{format, sky_plot::PlannedAntenna, words},
};

/// The time of the sky plot, from the operator's choice on until it is over.
#[derive(Debug, Default)]
pub struct SkyTime {
    /// `None` for now.
    time: Option<Timestamp>,
    sky: Option<(SkyKey, Sky)>,
    /// The slider had the keyboard focus in the last frame.
    pub has_focus: bool,
    /// The operator clicked in the sky of another time.
    is_click_refused: bool,
}

/// Inputs that a sky was computed from.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SkyKey {
    time: Timestamp,
    site: Site,
    passes_revision: u64,
    selected: Option<PassListKey>,
}

impl SkyTime {
    /// The time shown, if it is not now.
    pub fn time(&self) -> Option<Timestamp> {
        self.time
    }

    pub fn return_to_now(&mut self) {
        (self.time, self.sky, self.is_click_refused) = (None, None, false);
    }

    /// Shows another time, at most the end of the schedule. A time that is over is now.
    pub fn show_at(&mut self, model: &Model, time: Timestamp) {
        self.is_click_refused = false;
        match model.schedule_until() {
            Some(end) if time > model.now => self.time = Some(time.min(end)),
            _ => self.return_to_now(),
        }
    }

    /// Shows a time so many seconds later, or earlier.
    pub fn step(&mut self, model: &Model, by_s: f64) {
        self.show_at(model, add_seconds(self.time.unwrap_or(model.now), by_s));
    }

    /// A click in the sky of another time points no antenna, and says so.
    pub(super) fn refuse_click(&mut self) {
        self.is_click_refused = true;
    }

    /// Returns to now from a time that is over, or that the schedule does not hold any more, and
    /// computes the sky of the time shown.
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

    /// The sky of the time shown, if that is not now.
    pub(super) fn sky(&self) -> Option<&Sky> {
        let (_, sky) = self.sky.as_ref().filter(|_| self.time.is_some())?;
        Some(sky)
    }

    /// Which time it is, in words.
    pub(super) fn words(&self, model: &Model) -> Option<String> {
        let time = self.time?;
        let moment = format::moment(time, model.now);
        Some(format!("Sky at {moment}, in {}", format::time_left(model.now, time)))
    }
}

/// Positions of the antennas in the schedule at `time`.
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
