//! Menus of a pass, of a satellite in the sky, and of the sky.

use egui::{Id, Ui};

use super::{
    format, replay,
    widgets::context_menu::{entry, entry_locked_by},
};
use crate::{
    astro::AzEl,
    contract::{
        Command,
        passes::{ListedSatellite, PassListKey, PredictedPass},
    },
    model::{Model, UiCommand, View},
};

/// Function that shows the entries of a pass in the menu of the row or bar with this id.
pub type PassMenu<'a> = dyn Fn(&mut Ui, Id, PassListKey, &mut Vec<UiCommand>) + 'a;

/// Shows the entries of a pass in the menu of `response`.
pub(super) fn pass(
    ui: &mut Ui,
    response: Id,
    model: &Model,
    key: PassListKey,
    commands: &mut Vec<UiCommand>,
) {
    let Some(predicted) = model.pass_lists.find(key) else { return };
    if model.selected != Some(key) && entry(ui, response, "Select") {
        commands.push(UiCommand::SelectPass(key));
    }
    track(ui, response, model, predicted, commands);
    of_satellite(ui, response, model, &predicted.satellite, commands);
}

/// Shows the entries of a satellite in the sky. Returns `true` if the operator chose to point the
/// antenna at it.
pub(super) fn satellite(
    ui: &mut Ui,
    response: Id,
    model: &Model,
    (number, direction): (u32, AzEl),
    commands: &mut Vec<UiCommand>,
) -> bool {
    let predicted = model.pass_of(number);
    let is_selected = model.selected.is_some_and(|(selected, _)| selected == number);
    if !is_selected && predicted.is_some() && entry(ui, response, "Select") {
        commands.push(UiCommand::SelectSatellite(number));
    }
    if let Some(predicted) = predicted {
        track(ui, response, model, predicted, commands);
        of_satellite(ui, response, model, &predicted.satellite, commands);
    }
    sky(ui, response, model, direction)
}

/// Shows the entries of a direction. Returns `true` if the operator chose to point the antenna
/// there.
pub(super) fn sky(ui: &mut Ui, response: Id, model: &Model, direction: AzEl) -> bool {
    let looks = model.antenna().is_some_and(|antenna| {
        let words = format!("Point {} here\u{2026}", antenna.config.name);
        entry_locked_by(ui, response, &words, replay::lock(model))
    });
    self::direction(ui, response, direction);
    looks
}

/// Shows the entry that copies a direction.
pub(super) fn direction(ui: &mut Ui, response: Id, direction: AzEl) {
    if entry(ui, response, "Copy azimuth and elevation") {
        ui.copy_text(format::pointing_at(direction));
    }
}

fn track(
    ui: &mut Ui,
    response: Id,
    model: &Model,
    predicted: &PredictedPass,
    commands: &mut Vec<UiCommand>,
) {
    let Some(antenna) = model.antenna().filter(|_| predicted.pass.los.time > model.now) else {
        return;
    };
    let can = antenna.variant().capabilities;
    let is_tracked = antenna.tracked_number() == Some(predicted.number());
    let can_track = antenna.snapshot.link.is_open() && (can.has_program || can.takes_positions);
    if is_tracked || !can_track {
        return;
    }
    let words = format!("Track with {}\u{2026}", antenna.config.name);
    if entry_locked_by(ui, response, &words, replay::lock(model)) {
        commands.push(UiCommand::AskToTrack(predicted.key()));
    }
}

fn of_satellite(
    ui: &mut Ui,
    response: Id,
    model: &Model,
    satellite: &ListedSatellite,
    commands: &mut Vec<UiCommand>,
) {
    let number = satellite.elements.catalog_number();
    if entry(ui, response, "Open in Elements") {
        commands.extend([UiCommand::InspectObject(number), UiCommand::Show(View::Elements)]);
    }
    let is_favourite = model.station.favourites.numbers().contains(&number);
    let words = if is_favourite { "Remove from favourites" } else { "Add to favourites" };
    if entry_locked_by(ui, response, words, replay::lock(model)) {
        let is_favourite = !is_favourite;
        commands.push(UiCommand::Station(Command::SetFavourites {
            numbers: vec![number],
            is_favourite,
        }));
    }
}
