//! The button beside Track, with other targets for program track.

use egui::{Popup, Rect, Ui};

use super::CardAction;
use crate::ui::{
    format,
    icons::{self, Icon},
    theme,
    widgets::{go_to::Target, menu, paint},
};

/// Width of the button.
pub(super) const WIDTH: f32 = 28.0;

/// The targets offered.
#[derive(Debug, Clone, Copy, Default)]
pub struct FollowModel<'a> {
    /// The selected satellite, if Track would use the unit's on-board track.
    pub by_positions: Option<&'a str>,
    /// The direction in which the antenna points.
    pub here: Option<Target>,
    /// Decimals of that direction.
    pub here_decimals: usize,
    /// The Sun avoidance that following the Sun lifts; this then takes a hold.
    pub sun_avoidance: Option<&'a str>,
}

/// Target of a program track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FollowChoice {
    /// The selected satellite.
    Selected,
    /// The Sun.
    Sun,
    /// The Sun, with Sun avoidance lifted.
    IntoSun,
    /// The Moon.
    Moon,
    /// A fixed direction.
    Direction(Target),
}

/// Shows the button in `rect`. `typed` is the direction in the go-to fields; `asks_sun`
/// becomes `true` when the Sun was chosen and takes a hold.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &FollowModel<'_>,
    typed: Option<Target>,
    asks_sun: &mut bool,
    actions: &mut Vec<CardAction>,
) {
    let t = theme::tokens(ui);
    let name = "Follow something else";
    let response = paint::icon_control(ui, "follow menu", rect, name);
    if response.hovered() {
        ui.painter().rect_filled(rect, 4.0, t.bg3);
    }
    icons::paint(ui.painter(), paint::square(rect.center(), 12.0), Icon::ChevronDown, t.t2);
    paint::focus_ring(ui, &response, 4);
    menu::show(&response, Popup::menu(&response).accessible_name(name), |ui| {
        let mut choices = vec![
            ("Follow the Sun".to_owned(), FollowChoice::Sun),
            ("Follow the Moon".to_owned(), FollowChoice::Moon),
        ];
        let directions = [
            ("Keep pointing at", model.here, model.here_decimals),
            ("Follow the typed direction", typed, 1),
        ];
        for (words, direction, decimals) in directions {
            choices.extend(direction.map(|target| {
                (format!("{words} {}", in_words(target, decimals)), FollowChoice::Direction(target))
            }));
        }
        if let Some(satellite) = model.by_positions {
            let words = format!("Follow {satellite} position by position, from here");
            choices.insert(0, (words, FollowChoice::Selected));
        }
        for (words, choice) in choices {
            if !ui.button(words).clicked() {
                continue;
            }
            *asks_sun = choice == FollowChoice::Sun && model.sun_avoidance.is_some();
            if !*asks_sun {
                actions.push(CardAction::Follow(choice));
            }
        }
    });
}

/// A target in the format of the fields: azimuth, and elevation if there is one.
fn in_words(target: Target, decimals: usize) -> String {
    let angles = [Some(target.azimuth_deg), target.elevation_deg];
    let known = angles.into_iter().flatten().map(|angle_deg| format::degrees(angle_deg, decimals));
    known.collect::<Vec<_>>().join(", ")
}
