//! List of the antennas, with the sections of the selected one.

use egui::{Align2, Color32, Rect, Role, Stroke, StrokeKind, Ui, pos2, vec2};

use super::{form::Form, makes, section::Section, unit::ShownUnit};
use crate::{
    contract::antenna::AntennaModel,
    device::settings::Value,
    model::{Model, UiCommand, View},
    ui::{
        bar,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{link_chip, list::paint_ground, paint},
    },
};

pub(super) const WIDTH: f32 = 208.0;
const ANTENNA: f32 = 56.0;
const SECTION: f32 = 32.0;
const PADDING: f32 = 16.0;

/// Shows the list in `rect` and returns the clicked section.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    shown: Option<(&ShownUnit<'_>, &Form)>,
    commands: &mut Vec<UiCommand>,
) -> Option<Section> {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().vline(rect.right() - 0.5, rect.y_range(), (1.0, t.line));
    let head = rect.with_max_y(rect.top() + 40.0).shrink2(vec2(PADDING, 0.0));
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Antennas", text::value(), t.t1);
    let mut y = head.bottom();
    let mut clicked = None;
    for (index, antenna) in model.antennas.iter().enumerate() {
        let place = Rect::from_min_size(pos2(rect.left(), y), vec2(rect.width(), ANTENNA));
        y = place.bottom();
        let of_this = shown.filter(|(unit, _)| unit.index == index);
        if antenna_line(ui, place, model, antenna, of_this) && of_this.is_none() {
            commands.push(UiCommand::SelectAntenna(index));
        }
        let Some((unit, form)) = of_this else { continue };
        y += 4.0;
        for section in Section::new(&unit.antenna.config.connection) {
            let place = Rect::from_min_size(pos2(rect.left(), y), vec2(rect.width(), SECTION));
            y = place.bottom();
            if section_line(ui, place, section, unit, form) {
                clicked = Some(section);
            }
        }
        let place = Rect::from_min_size(pos2(rect.left(), y), vec2(rect.width(), SECTION));
        y = place.bottom() + 4.0;
        if line(ui, place, "Mount and connection", t.t2) {
            commands.push(UiCommand::Show(View::Preferences));
        }
        ui.painter().hline(rect.x_range(), y, (1.0, t.line));
    }
    if let Some((unit, _)) = shown {
        versions(ui, rect.with_min_y(y), unit);
    }
    clicked
}

fn antenna_line(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    antenna: &AntennaModel,
    shown: Option<(&ShownUnit<'_>, &Form)>,
) -> bool {
    let t = theme::tokens(ui);
    let activity = bar::activity(model, antenna);
    let name = format!("{}, settings: {activity}", antenna.config.name);
    let id = ("settings of", &antenna.config.name);
    let response = paint::control(ui, id, rect, Role::Button, true, &name);
    paint_ground(ui, rect, shown.is_some(), response.hovered());
    let (icon, colour) = bar::glyph(model, antenna).look(t);
    let area = paint::square(pos2(rect.left() + 23.0, rect.center().y), 13.0);
    icons::paint(ui.painter(), area, icon, colour);
    let edited = shown.map_or(0, |(unit, form)| form.count_all(unit).edited);
    let right = if edited > 0 {
        badge(ui, pos2(rect.right() - PADDING, rect.center().y), edited, (t.onsat, Some(t.sat)))
    } else {
        rect.right()
    };
    let room = rect.with_min_x(rect.left() + 40.0).with_max_x(right - 4.0);
    let font = text::sized(13.0, Weight::SemiBold);
    let up = room.translate(vec2(0.0, -8.0));
    paint::text_in(ui, up, Align2::LEFT_CENTER, &antenna.config.name, font, t.t1);
    let down = room.translate(vec2(0.0, 8.0));
    let age = bar::age(model, antenna);
    let second = link_chip::with_age(activity, &age, bar::glyph(model, antenna));
    paint::text_in(ui, down, Align2::LEFT_CENTER, &second, text::small(), t.t2);
    paint::focus_ring(ui, &response, 0);
    response.clicked()
}

fn section_line(ui: &Ui, rect: Rect, section: Section, unit: &ShownUnit<'_>, form: &Form) -> bool {
    let t = theme::tokens(ui);
    let count = form.count(unit, section.keys);
    let clicked = line(ui, rect, section.title, if count.edited > 0 { t.t1 } else { t.t2 });
    let mut right = pos2(rect.right() - PADDING, rect.center().y);
    let mut sentences = Vec::new();
    for (number, colour, word) in
        [(count.edited, t.sat, "edited"), (count.rejected, t.bad, "rejected")]
    {
        if number > 0 {
            right.x = badge(ui, right, number, (colour, None)) - 6.0;
            sentences.push(format!("{number} {word}"));
        }
    }
    if !sentences.is_empty() {
        let name = format!("{}: {}", section.title, sentences.join(", "));
        let area = rect.with_min_x(right.x).with_max_x(rect.right());
        paint::name_text(ui, ("counts", section.title), area, &name);
    }
    if section.is_service && form.unlock.is_none() && sentences.is_empty() {
        icons::paint(ui.painter(), paint::square(right - vec2(8.0, 0.0), 14.0), Icon::Lock, t.t3);
    }
    clicked
}

fn line(ui: &Ui, rect: Rect, words: &str, colour: Color32) -> bool {
    let t = theme::tokens(ui);
    let response = paint::control(ui, ("line", words), rect, Role::Button, true, words);
    if response.hovered() {
        ui.painter().rect_filled(rect, 0.0, t.bg3);
    }
    let room = rect.with_min_x(rect.left() + 44.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, words, text::body_medium(), colour);
    paint::focus_ring(ui, &response, 0);
    response.clicked()
}

/// Draws a number in a box with its right end at `right`; returns the left end.
fn badge(
    ui: &Ui,
    right: egui::Pos2,
    number: usize,
    (ink, fill): (Color32, Option<Color32>),
) -> f32 {
    let words = number.to_string();
    let width = (paint::text_width(ui, &words, text::small_strong()) + 10.0).max(19.0);
    let rect = Rect::from_min_max(right - vec2(width, 9.0), right + vec2(0.0, 9.0));
    let stroke = Stroke::new(1.0, fill.unwrap_or(ink));
    let ground = fill.unwrap_or(Color32::TRANSPARENT);
    ui.painter().rect(rect, 3, ground, stroke, StrokeKind::Inside);
    paint::text_in(ui, rect, Align2::CENTER_CENTER, &words, text::small_strong(), ink);
    rect.left()
}

/// Shows the versions that the unit reports, at the foot if there is room.
fn versions(ui: &Ui, rect: Rect, unit: &ShownUnit<'_>) {
    let t = theme::tokens(ui);
    let own = makes::own(unit.antenna.spec());
    let Some(values) = own.and_then(|own| unit.values(own.versions.key)) else { return };
    let texts = values.values().filter_map(|value| match value {
        Value::Text(text) => Some(text.as_str()),
        _ => None,
    });
    let texts: Vec<&str> = texts.collect();
    let height = 18.0 * (texts.len() + 1) as f32;
    let top = rect.bottom() - PADDING - height;
    if top < rect.top() + 4.0 {
        return;
    }
    let lines = std::iter::once(("Unit", t.t3)).chain(texts.into_iter().map(|text| (text, t.t2)));
    for (index, (words, colour)) in lines.enumerate() {
        let y = top + 18.0 * index as f32;
        let area =
            Rect::from_min_size(pos2(rect.left() + PADDING, y), vec2(rect.width() - 24.0, 18.0));
        paint::text_in(ui, area, Align2::LEFT_CENTER, words, text::small(), colour);
        paint::name_text(ui, ("version", index), area, words);
    }
}
