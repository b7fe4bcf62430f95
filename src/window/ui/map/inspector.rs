//! The selected satellite in detail.

use egui::{Align2, Rect, RichText, ScrollArea, Sense, Ui, UiBuilder, pos2, vec2};

use super::{PADDING, facts, upcoming};
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
        widgets::{
            button::{Button, HEIGHT as BUTTON},
            paint, sentence,
        },
    },
};

/// Height of the name and the countdown.
const HEAD: f32 = 56.0;
const PLOT: f32 = 252.0;
/// Height of the foot with its buttons.
const FOOT: f32 = 60.0;
const GAP: f32 = 8.0;

/// Draws the panel.
pub(super) fn show(ui: &mut Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let Some(of) = model.globe.selected() else {
        let place = inner.shrink2(vec2(0.0, PADDING));
        let builder = UiBuilder::new().id_salt("map inspector").max_rect(place);
        ui.scope_builder(builder, |ui| {
            ui.label(RichText::new("No satellite selected").font(text::value()));
            let words = "Click a satellite on the map or in the table.";
            ui.label(RichText::new(words).font(text::body()).color(t.t2));
        });
        return;
    };
    // The selected pass may be over.
    let predicted = model.selected_pass().or_else(|| model.pass_of(of.number()));
    let (top, rest) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    head(ui, top, model, of, predicted);
    let (body, foot) = rest.split_top_bottom_at_y(rest.bottom() - FOOT);
    ui.scope_builder(UiBuilder::new().id_salt("map inspector").max_rect(body), |ui| {
        ui.set_clip_rect(body.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        let area = ScrollArea::vertical().id_salt("map details").auto_shrink(false);
        area.show(ui, |ui| parts(ui, body.width(), model, of, predicted, commands));
    });
    buttons(ui, foot, commands);
}

/// Name and age of the elements at the left, the countdown of the pass at the right.
fn head(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    of: &GlobeSatellite,
    predicted: Option<&PredictedPass>,
) {
    let t = theme::tokens(ui);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let line = |y: f32| {
        Rect::from_x_y_ranges(inner.x_range(), rect.top() + y - 12.0..=rect.top() + y + 12.0)
    };
    let (event, countdown) = predicted.map_or(("", "no pass".to_owned()), |of| until(of, model));
    let right = Align2::RIGHT_CENTER;
    let up = paint::text_in(ui, line(16.0), right, event, text::small(), t.t3);
    let font = text::sized(20.0, Weight::SemiBold);
    let down = paint::text_in(ui, line(37.0), right, &countdown, font, t.t1);
    let words = format!("{event} {countdown}");
    paint::name_text(ui, "map countdown", up.union(down), words.trim());

    let left = Align2::LEFT_CENTER;
    let name = of.satellite.short_name();
    paint::text_in(ui, line(19.0).with_max_x(up.left() - GAP), left, name, text::title(), t.t1);
    let elements = &of.satellite.elements;
    let age = format::age(elements.age_s(model.now));
    let detail = format!("{}, elements {age} old", of.number());
    let room = line(40.0).with_max_x(down.left() - GAP);
    let detail_place = paint::text_in(ui, room, left, &detail, text::small(), t.t2);
    paint::name_text(ui, "map selected", detail_place, &format!("{name}, {detail}"));
}

/// The next event of a pass and the time until then.
fn until(predicted: &PredictedPass, model: &Model) -> (&'static str, String) {
    let pass = &predicted.pass;
    if predicted.is_always_up() {
        return ("", "always up".to_owned());
    }
    let (event, at) = if predicted.in_progress(model.now) {
        ("LOS", pass.los.time)
    } else {
        ("AOS", pass.aos.time)
    };
    (event, format::countdown(model.now, at))
}

fn parts(
    ui: &mut Ui,
    width: f32,
    model: &Model,
    of: &GlobeSatellite,
    predicted: Option<&PredictedPass>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let place = |ui: &mut Ui, height: f32| {
        let (rect, _) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
        rect
    };
    if let Some(predicted) = predicted {
        let plot = place(ui, PLOT);
        let look = model.sky.selected.map_or(of.look, |selected| selected.look);
        small_sky::show(ui, plot, model, predicted, Some(look));
    }
    let lines = place(ui, facts::HEIGHT + GAP);
    facts::show(ui, lines, model, of);
    ui.painter().hline(lines.x_range(), lines.bottom() - 0.5, (1.0, t.line));
    if let Some(antenna) = speaker(model, of) {
        let room = ui.available_rect_before_wrap();
        let at = pos2(room.left() + PADDING, room.top() + GAP);
        let name = &antenna.config.name;
        let font = text::sized(13.0, Weight::SemiBold);
        let head = paint::text(ui, at, Align2::LEFT_TOP, name, font, t.t1);
        let at = pos2(at.x, head.bottom() + GAP / 2.0);
        let spoken = state_sentence(model, antenna);
        let block = spoken.with(|words| sentence::show_short(ui, at, width - 2.0 * PADDING, words));
        place(ui, block.bottom() - room.top() + GAP);
    }
    let passes = upcoming::passes(model, of.number());
    let list = place(ui, upcoming::height(passes.len()));
    upcoming::show(ui, list, model, of, &passes, commands);
}

/// The antenna whose sentence is shown: that which tracks the satellite, else the selected one.
fn speaker<'a>(model: &'a Model, of: &GlobeSatellite) -> Option<&'a AntennaModel> {
    let tracks = |antenna: &&AntennaModel| antenna.tracked_number() == Some(of.number());
    model.antennas.iter().find(tracks).or_else(|| model.antenna())
}

fn buttons(ui: &Ui, rect: Rect, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect.with_min_x(rect.left() + 1.0), 0.0, t.bg1);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let width = (inner.width() - GAP) / 2.0;
    let at = |left: f32| Rect::from_min_size(pos2(left, rect.top() + 12.0), vec2(width, BUTTON));
    let plot = Button::normal("Open on sky plot").icon(Icon::CrossHair);
    if plot.show(ui, "open on sky plot", at(inner.left())).clicked() {
        commands.push(UiCommand::Show(View::Operate));
    }
    let elements = Button::normal("Elements").icon(Icon::Orbit);
    if elements.show(ui, "map elements", at(inner.right() - width)).clicked() {
        commands.push(UiCommand::Show(View::Elements));
    }
}
