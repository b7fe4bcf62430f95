//! The station and its menu.

use egui::{Align2, Button, Popup, Rect, Role, Ui, pos2, vec2};

use super::TopBarModel;
use crate::{
    model::{NextStation, ThemeName, UiCommand, View, typed_path::OpenedFile},
    ui::{
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{menu, paint},
    },
};

/// Returns the width of the selector without coordinates, points.
pub(super) fn one_line_width(ui: &Ui, name: &str) -> f32 {
    (paint::text_width(ui, name, text::sized(14.0, Weight::SemiBold)) + 48.0).min(170.0)
}

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &TopBarModel<'_>,
    two_lines: bool,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let place = rect.shrink2(vec2(0.0, 6.0));
    let name = format!("Station {}", model.station);
    let response = paint::control(ui, "station", place, Role::Button, true, &name);
    if response.hovered() {
        ui.painter().rect_filled(place, 5.0, t.bg3);
    }
    let room = rect.with_min_x(rect.left() + 12.0).with_max_x(rect.right() - 30.0);
    let strong = text::sized(14.0, Weight::SemiBold);
    let is_cut = !paint::fits(ui, model.station, strong.clone(), room);
    let response = if is_cut { response.on_hover_text(model.station) } else { response };
    if two_lines {
        let up = room.translate(vec2(0.0, -8.0));
        paint::text_in(ui, up, Align2::LEFT_CENTER, model.station, strong, t.t1);
        let down = room.translate(vec2(0.0, 9.0));
        paint::text_in(ui, down, Align2::LEFT_CENTER, model.coordinates, text::small(), t.t2);
    } else {
        paint::text_in(ui, room, Align2::LEFT_CENTER, model.station, strong, t.t1);
    }
    let position = pos2(rect.right() - 22.0, rect.center().y);
    icons::paint(ui.painter(), paint::square(position, 14.0), Icon::ChevronDown, t.t2);
    paint::focus_ring(ui, &response, 5);
    menu::show(
        &response,
        Popup::menu(&response).width(180.0).accessible_name("Station menu"),
        |ui| {
            menu(ui, model, commands);
        },
    );
}

fn menu(ui: &mut Ui, model: &TopBarModel<'_>, commands: &mut Vec<UiCommand>) {
    if ui.button("Station settings…").clicked() {
        commands.push(UiCommand::Show(View::Preferences));
    }
    if model.demo && ui.button("Set up your station…").clicked() {
        commands.push(UiCommand::Show(View::Setup));
    }
    ui.separator();
    stations(ui, model, commands);
    ui.separator();
    let shown = theme::name(ui);
    for (theme, word) in [
        (ThemeName::Dark, "Dark theme"),
        (ThemeName::Light, "Light theme"),
        (ThemeName::Night, "Night theme"),
    ] {
        if ui.add(Button::selectable(shown == theme, word)).clicked() {
            commands.push(UiCommand::SetTheme(theme));
        }
    }
}

/// Shows the known stations. Marks the current station, and ignores a click on it.
fn stations(ui: &mut Ui, model: &TopBarModel<'_>, commands: &mut Vec<UiCommand>) {
    for station in &model.stations.stations {
        let is_open = !model.demo && model.stations.open.as_ref() == Some(&station.path);
        let entry = ui.add(Button::selectable(is_open, model.stations.label(station)).truncate());
        if entry.on_hover_text(station.path.display().to_string()).clicked() && !is_open {
            let next = NextStation::File(station.path.clone());
            commands.push(UiCommand::ChooseStation(next));
        }
    }
    if ui.add(Button::selectable(model.demo, "Demo station")).clicked() && !model.demo {
        commands.push(UiCommand::ChooseStation(NextStation::Demo));
    }
    if !model.demo && ui.button("New station…").clicked() {
        commands.push(UiCommand::ChooseStation(NextStation::New));
    }
    if ui.button("Open…").clicked() {
        commands.push(UiCommand::ChooseFile(OpenedFile::Station));
    }
}
