//! Details of the selected satellite.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{PADDING, facts, words};
use crate::{
    contract::{antenna::AntennaModel, passes::PredictedPass},
    model::{Model, UiCommand, View, globe::GlobeSatellite},
    ui::{
        format,
        icons::Icon,
        small_sky,
        state_sentence::state_sentence,
        text::{self, Weight},
        theme,
        upcoming::Upcoming,
        widgets::{
            button::{Button, HEIGHT as BUTTON},
            inspector::{self, Head, Parts},
            paint, sentence,
        },
    },
};

/// Max number of next passes shown.
const PASSES: usize = 3;
const PLOT: f32 = 252.0;
/// Height of the foot with its buttons, points.
const FOOT: f32 = 60.0;
const GAP: f32 = 8.0;

/// Draws the details of the selected satellite into `rect`.
pub(super) fn show(ui: &mut Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    inspector::show_ground(ui, rect);
    let Some(satellite) = model.globe.selected() else {
        let words = "Click a satellite on the map or in the table.";
        return inspector::show_nothing(ui, rect, "No satellite selected", words);
    };
    // The selected pass may be over: the next pass of the satellite replaces it.
    let predicted = model.selected_pass().or_else(|| model.pass_of(satellite.number()));
    let Parts { head, body, foot } = Parts::new(rect, FOOT);
    show_head(ui, head, model, satellite, predicted);
    inspector::show_body(ui, body, "map", |ui| {
        parts(ui, body.width(), model, satellite, predicted, commands);
    });
    buttons(ui, foot, commands);
}

fn show_head(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    satellite: &GlobeSatellite,
    predicted: Option<&PredictedPass>,
) {
    let (event, countdown) =
        predicted.map_or(("", "no pass".to_owned()), |predicted| end_of_pass(predicted, model));
    let age = format::age(satellite.satellite.elements.age_s(model.now));
    let detail = format!("{}, elements {age} old", satellite.number());
    let name = satellite.satellite.short_name();
    let head = Head { name, detail: &detail, event, countdown: &countdown, indent: 0.0 };
    inspector::show_head(ui, rect, "map", head);
}

/// Returns the next event of a pass and the time until then.
fn end_of_pass(predicted: &PredictedPass, model: &Model) -> (&'static str, String) {
    let pass = &predicted.pass;
    if predicted.is_always_up() {
        return ("", "always up".to_owned());
    }
    let (event, time) = if predicted.in_progress(model.now) {
        ("LOS", pass.los.time)
    } else {
        ("AOS", pass.aos.time)
    };
    (event, format::countdown(model.now, time))
}

fn parts(
    ui: &mut Ui,
    width: f32,
    model: &Model,
    satellite: &GlobeSatellite,
    predicted: Option<&PredictedPass>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let place = |ui: &mut Ui, height: f32| inspector::place(ui, width, height);
    if let Some(predicted) = predicted {
        let plot = place(ui, PLOT);
        let look = model.sky.selected.map_or(satellite.look, |selected| selected.look);
        small_sky::show(ui, plot, model, predicted, Some(look));
    }
    let lines = place(ui, facts::HEIGHT + GAP);
    facts::show(ui, lines, model, satellite);
    ui.painter().hline(lines.x_range(), lines.bottom() - 0.5, (1.0, t.line));
    if let Some(antenna) = speaker(model, satellite) {
        let room = ui.available_rect_before_wrap();
        let position = pos2(room.left() + PADDING, room.top() + GAP);
        let name = &antenna.config.name;
        let font = text::sized(13.0, Weight::SemiBold);
        let head = paint::text(ui, position, Align2::LEFT_TOP, name, font, t.t1);
        let position = pos2(position.x, head.bottom() + GAP / 2.0);
        let spoken = state_sentence(model, antenna);
        let block = spoken.with_sentence(|words| {
            sentence::show_short(ui, position, width - 2.0 * PADDING, words)
        });
        place(ui, block.bottom() - room.top() + GAP);
    }
    let upcoming = Upcoming {
        title: &format!("Next at {}", model.station.name),
        remark: "",
        passes: &later_passes(model, satellite.number()),
        empty: words::no_later_pass(satellite, model),
    };
    let list = place(ui, upcoming.height());
    if let Some(pass) = upcoming.show(ui, list, model) {
        commands.push(UiCommand::SelectPass(pass.key()));
    }
}

/// Returns the passes of a satellite after the current one.
pub(super) fn later_passes(model: &Model, number: u32) -> Vec<&PredictedPass> {
    // The satellite may not be a favourite.
    let lists = [&model.pass_lists.favourites, &model.pass_lists.all];
    let is_later = |predicted: &&PredictedPass| {
        predicted.number() == number && predicted.pass.aos.time > model.now
    };
    let found =
        lists.map(|list| list.passes.iter().filter(is_later).take(PASSES).collect::<Vec<_>>());
    found.into_iter().find(|passes| !passes.is_empty()).unwrap_or_default()
}

/// Returns the antenna whose sentence the inspector shows: the one that tracks the satellite, else
/// the selected one.
fn speaker<'a>(model: &'a Model, satellite: &GlobeSatellite) -> Option<&'a AntennaModel> {
    let tracks = |antenna: &&AntennaModel| antenna.tracked_number() == Some(satellite.number());
    model.antennas.iter().find(tracks).or_else(|| model.antenna())
}

fn buttons(ui: &Ui, rect: Rect, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect.with_min_x(rect.left() + 1.0), 0.0, t.bg1);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let width = (inner.width() - GAP) / 2.0;
    let area = |left: f32| Rect::from_min_size(pos2(left, rect.top() + 12.0), vec2(width, BUTTON));
    let plot = Button::normal("Open on sky plot").icon(Icon::CrossHair);
    if plot.show(ui, "open on sky plot", area(inner.left())).clicked() {
        commands.push(UiCommand::Show(View::Operate));
    }
    let elements = Button::normal("Elements").icon(Icon::Orbit);
    if elements.show(ui, "map elements", area(inner.right() - width)).clicked() {
        commands.push(UiCommand::Show(View::Elements));
    }
}
