//! The button beside Track, with other targets for program track.

use egui::{Popup, Rect, Ui};

use super::Card;
use crate::{
    astro::{Angle, AzEl},
    contract::{self, driver::Command, passes::PredictedPass},
    device::Pointing,
    model::UiCommand,
    plan::{self, ProgramTrack},
    ui::{
        format,
        icons::{self, Icon},
        theme,
        widgets::{go_to::Target, menu, paint},
    },
};

/// Width of the button, points.
pub(super) const WIDTH: f32 = 28.0;

/// Target of a program track.
#[derive(Clone, Copy, PartialEq)]
enum FollowChoice {
    /// The selected satellite.
    Selected,
    Sun,
    Moon,
    /// A fixed direction.
    Direction(Target),
}

/// Shows the button in `rect`. `go_to_target` is the direction in the go-to fields. Sets `asks_sun`
/// when the operator chose the Sun, which takes a hold.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    card: &mut Card<'_>,
    go_to_target: Option<Target>,
    asks_sun: &mut bool,
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
        let capabilities = card.antenna.variant().capabilities;
        let measured = card.antenna.snapshot.state.measured;
        let current = measured.and_then(|measured| target(measured.pointing));
        let directions = [
            ("Keep pointing at", current, format::decimals(capabilities, 1)),
            ("Follow the typed direction", go_to_target, 1),
        ];
        for (words, direction, decimals) in directions {
            choices.extend(direction.map(|target| {
                (format!("{words} {}", in_words(target, decimals)), FollowChoice::Direction(target))
            }));
        }
        // Offer the satellite as well: Track would use the unit's own program.
        if let Some(predicted) = card.model.selected_pass().filter(|_| capabilities.has_program) {
            let satellite = predicted.satellite.short_name();
            let words = format!("Follow {satellite} position by position, from here");
            choices.insert(0, (words, FollowChoice::Selected));
        }
        for (words, choice) in choices {
            if !ui.button(words).clicked() {
                continue;
            }
            *asks_sun = choice == FollowChoice::Sun && card.model.station.sun_avoidance.is_some();
            if !*asks_sun {
                follow(card, choice);
            }
        }
    });
}

fn follow(card: &mut Card<'_>, choice: FollowChoice) {
    let target = match choice {
        FollowChoice::Selected => {
            let antenna = card.antenna.id();
            let pass = card.model.selected_pass().map(PredictedPass::key);
            let track = |pass| contract::Command::ProgramTrackPass { antenna, pass };
            return card.commands.extend(pass.map(track).map(UiCommand::Station));
        }
        FollowChoice::Sun => plan::Target::Sun,
        FollowChoice::Moon => plan::Target::Moon,
        FollowChoice::Direction(Target { azimuth_deg, elevation_deg }) => {
            let elevation_deg = elevation_deg.unwrap_or_default();
            plan::Target::Fixed(AzEl::from_degrees(azimuth_deg, elevation_deg))
        }
    };
    card.queue(Command::ProgramTrack(program_track(card, target)));
}

/// Follows the Sun, with Sun avoidance lifted.
pub(super) fn follow_into_sun(card: &mut Card<'_>) {
    card.queue(Command::ProgramTrackIntoSun(program_track(card, plan::Target::Sun)));
}

fn program_track(card: &Card<'_>, target: plan::Target) -> Box<ProgramTrack> {
    Box::new(ProgramTrack::new(target, card.model.station.site, Vec::new()))
}

/// Converts a direction to a go-to target.
fn target(pointing: Pointing) -> Option<Target> {
    Some(Target {
        azimuth_deg: pointing.azimuth?.wrapped_360().degrees(),
        elevation_deg: pointing.elevation.map(Angle::degrees),
    })
}

/// Formats a target like the fields: azimuth, and elevation if there is one.
fn in_words(target: Target, decimals: usize) -> String {
    let angles = [Some(target.azimuth_deg), target.elevation_deg];
    let texts = angles.into_iter().flatten().map(|angle_deg| format::degrees(angle_deg, decimals));
    texts.collect::<Vec<_>>().join(", ")
}
