//! The page of the window's appearance. Choices take effect immediately and belong to this window,
//! not to the station file.

use std::borrow::Cow;

use egui::{Ui, Vec2};

use super::{
    form::{self, choice, note},
    search::{self, Spot},
};
use crate::model::{Appearance, DistanceUnit, Model, ThemeName, UiCommand};

/// Cards of the page with the numbers of their rows.
pub(super) const CARDS: [usize; 3] = [6, 3, 6];
const THEME: &str = "Theme";
const SUN: &str = "Follow the Sun";
const SCALE: &str = "Scale";
const CLOCK: &str = "Local time";
const DECIMALS: &str = "Decimals of angles";
const DISTANCES: &str = "Distances";

/// Returns the labels of the choices for the search.
pub(super) fn labels() -> Vec<(Cow<'static, str>, Spot)> {
    search::on_page(&[THEME, SUN, SCALE, CLOCK, DECIMALS, DISTANCES])
}

pub(super) fn card_of(ui: &mut Ui, card: usize, model: &Model, commands: &mut Vec<UiCommand>) {
    let mut appearance = model.appearance;
    match card {
        0 => theme_and_size(ui, &mut appearance),
        1 => times(ui, &mut appearance),
        _ => units(ui, &mut appearance),
    }
    if appearance != model.appearance {
        commands.push(UiCommand::SetAppearance(appearance));
    }
}

fn theme_and_size(ui: &mut Ui, appearance: &mut Appearance) {
    let now = *appearance;
    form::card(ui, "Theme and size", |ui| {
        let themes =
            [("Dark", ThemeName::Dark), ("Light", ThemeName::Light), ("Night", ThemeName::Night)];
        choice(ui, THEME, &themes, &mut appearance.theme);
        note(ui, "Night is red only, for dark-adapted eyes.");
        let by_day = [("Off", false), ("Light by day", true)];
        choice(ui, SUN, &by_day, &mut appearance.light_by_day);
        note(ui, "While the Sun is up over the station the theme is light.");
        let words = Appearance::SCALES_PERCENT.map(|percent| (format!("{percent} %"), percent));
        let fits = |percent: u32| percent <= now.scale_percent || has_room(ui, percent);
        let scales: Vec<(&str, u32)> = words
            .iter()
            .filter(|(_, percent)| fits(*percent))
            .map(|(word, percent)| (word.as_str(), *percent))
            .collect();
        choice(ui, SCALE, &scales, &mut appearance.scale_percent);
        if scales.len() < words.len() {
            note(ui, "A larger scale needs a larger window, or part of the view is cut off.");
        }
    });
}

fn times(ui: &mut Ui, appearance: &mut Appearance) {
    form::card(ui, "Times", |ui| {
        let shown = [("Beside UTC", true), ("Not shown", false)];
        choice(ui, CLOCK, &shown, &mut appearance.local_time);
        note(ui, "In the top bar only. Every other time is UTC.");
    });
}

fn units(ui: &mut Ui, appearance: &mut Appearance) {
    form::card(ui, "Units", |ui| {
        let [one, two, three] = Appearance::ANGLE_DECIMALS;
        let choices = [("0.1°", one), ("0.01°", two), ("0.001°", three)];
        choice(ui, DECIMALS, &choices, &mut appearance.angle_decimals);
        note(
            ui,
            "For the angles of the antenna's axes and of the selected satellite. A unit with a \
             coarser resolution shows fewer.",
        );
        let of_distances = [
            ("Kilometres", DistanceUnit::Kilometres),
            ("Miles", DistanceUnit::Miles),
            ("Nautical miles", DistanceUnit::NauticalMiles),
        ];
        choice(ui, DISTANCES, &of_distances, &mut appearance.distances);
        note(
            ui,
            "For heights, ranges and their rates. Alarms, files and the altitude of the site stay \
             in kilometres and metres.",
        );
    });
}

/// Returns `true` if the window is large enough for this scale.
fn has_room(ui: &Ui, percent: u32) -> bool {
    let view = ui.ctx().content_rect().size() * ui.ctx().zoom_factor();
    let size = Vec2::from(Appearance::MIN_VIEW) * (percent as f32 / 100.0);
    view.x >= size.x && view.y >= size.y
}
