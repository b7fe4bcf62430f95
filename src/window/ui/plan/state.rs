//! State that the Plan view keeps between frames.

use std::collections::BTreeMap;

use jiff::Timestamp;

use super::choose;
use crate::{
    astro::time::seconds_between,
    contract,
    contract::passes::{PassListKey, PredictedPass},
    model::{Model, UiCommand, plan::PlannedPass},
    station::{AntennaId, Take},
    ui::{
        confirm::Question,
        format,
        widgets::{hold_button::HoldState, list::Scroll},
        words,
    },
};

/// Time in which the operator can undo a change, seconds.
const UNDO_S: f64 = 10.0;
/// Selectable spans of the lanes, hours.
const LANES_H: [f64; 5] = [1.5, 3.0, 4.5, 6.0, 12.0];

/// Selection of passes in the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Shown {
    #[default]
    All,
    Taken,
    LeftOut,
}

/// Open parts, the section of the lanes, and the last change.
#[derive(Default)]
pub struct PlanState {
    pub(super) shown: Shown,
    pub(super) inspector_is_open: bool,
    /// Time from the start of the plan to the start of the lanes, seconds.
    pub(super) lanes_after_s: f64,
    pub(super) scroll: Scroll,
    zoom: usize,
    /// Hold state of the switches of automatic operation, by antenna.
    holds: BTreeMap<AntennaId, HoldState>,
    undo: Option<Undo>,
}

/// Command that undoes a change of the plan.
pub(super) struct Undo {
    pub(super) command: UiCommand,
    pub(super) words: String,
    start: Timestamp,
}

impl PlanState {
    /// Returns the span of the lanes, hours.
    pub(super) fn lanes_h(&self) -> f64 {
        let place = (LANES_H.len() / 2 + self.zoom) % LANES_H.len();
        LANES_H.get(place).copied().unwrap_or(4.5)
    }

    /// Zooms the lanes to fewer or more hours.
    pub fn change_zoom(&mut self, is_closer: bool) {
        let half = LANES_H.len() / 2;
        let place = (half + self.zoom) % LANES_H.len();
        let place =
            if is_closer { place.saturating_sub(1) } else { (place + 1).min(LANES_H.len() - 1) };
        self.zoom = (place + LANES_H.len() - half) % LANES_H.len();
    }

    /// Resets the lanes to the default span from now on.
    pub fn reset_zoom(&mut self) {
        (self.zoom, self.lanes_after_s) = (0, 0.0);
    }

    /// Changes the plan; the operator can undo the change for some seconds.
    pub(super) fn change(
        &mut self,
        model: &Model,
        command: contract::Command,
        back: contract::Command,
        words: &str,
        commands: &mut Vec<UiCommand>,
    ) {
        commands.push(UiCommand::Station(command));
        let command = UiCommand::Station(back);
        self.undo = Some(Undo { command, words: words.to_owned(), start: model.now });
    }

    /// Discards the undo step, because the last change failed.
    pub fn was_not_changed(&mut self) {
        self.undo = None;
    }

    /// Returns the pass before or after the selected one in the list.
    pub fn neighbour(&self, model: &Model, step: isize) -> Option<PassListKey> {
        let all = model.planned_passes();
        let keys: Vec<PassListKey> = all.iter().map(|planned| planned.predicted.key()).collect();
        let selected = model.selected_pass().map(PredictedPass::key);
        let place = keys.iter().position(|key| Some(*key) == selected);
        let place = place.map_or(Some(0), |place| place.checked_add_signed(step));
        keys.get(place?).copied()
    }

    /// Includes the selected pass in the schedule or excludes it.
    pub fn choose(&mut self, model: &Model, take: Option<Take>, commands: &mut Vec<UiCommand>) {
        if let Some(planned) = model.selected_planned() {
            self.choose_for(model, &planned, take, commands);
        }
    }

    pub(super) fn choose_for(
        &mut self,
        model: &Model,
        planned: &PlannedPass<'_>,
        take: Option<Take>,
        commands: &mut Vec<UiCommand>,
    ) {
        let present = planned.choice.map(|choice| choice.take);
        if present != take {
            let (command, back) = (choose(planned, take), choose(planned, present));
            self.change(model, command, back, "Planned again", commands);
        }
    }

    /// Returns the question whether the schedule should take the selected pass, which it leaves
    /// out.
    pub fn ask_to_swap(&self, model: &Model) -> Option<Question> {
        let planned = model.selected_planned().filter(|planned| planned.entries.is_empty())?;
        let key = planned.predicted.key();
        let name = planned.predicted.satellite.short_name();
        let aos = format::moment(key.1, model.now);
        let known_swap = model.swap_of(key);
        let price = known_swap.map(|swap| format!(" {}", words::schedule::price(model, swap)));
        Some(Question {
            text: format!("Always take {name}, AOS {aos}?{}", price.unwrap_or_default()),
            yes: "Take it",
            command: UiCommand::Station(choose(&planned, Some(Take::Always))),
        })
    }

    pub(super) fn undo(&self) -> Option<&Undo> {
        self.undo.as_ref()
    }

    pub(super) fn take_undo(&mut self) -> Option<UiCommand> {
        self.undo.take().map(|undo| undo.command)
    }

    pub(super) fn forget_old_undo(&mut self, now: Timestamp) {
        self.undo.take_if(|undo| seconds_between(undo.start, now) >= UNDO_S);
    }

    pub(super) fn hold(&mut self, antenna: AntennaId) -> &mut HoldState {
        self.holds.entry(antenna).or_default()
    }
}
