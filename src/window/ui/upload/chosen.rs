//! The satellites chosen for the upload.

use std::sync::Arc;

use egui::{Align, Button, Label, Layout, RichText, Role, Sense, TextEdit, Ui, WidgetInfo, vec2};

use super::form::Form;
use crate::{
    astro::time::seconds_between,
    contract::uploads::{Chosen, ChosenObject},
    device::HeldSatellite,
    model::Model,
    orbit::{Catalog, Elements},
    ui::{
        elements::words::{age_look, age_tone},
        format, icons, text, theme,
        widgets::{
            button::RADIUS,
            card, paint,
            status_line::{Tone, line},
        },
        words::sentence,
    },
};

/// Max number of search results.
const OFFERED: usize = 5;
const ROW: f32 = 24.0;
/// Side of the mark of an age, points.
const MARK: f32 = 12.0;
const OMIT: &str = "Omit";

enum Change {
    Remove(u32),
    Add(u32),
    Follow(u32),
    Favourites,
}

/// Shows the chosen satellites. `satellite` is the satellite on the unit, `None` if it was not read
/// yet. The unit continues to follow it until the operator marks another. If the file does not
/// contain it, the unit will follow the selected satellite, or else the first.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    catalog: &Arc<Catalog>,
    satellite: Option<&HeldSatellite>,
    form: &mut Form,
) {
    let favourites = &model.station.favourites.numbers();
    let mut change = None;
    card::show(ui, f32::INFINITY, |ui| {
        let is_own = form.numbers.is_some();
        let marked = form.marked;
        let chosen = form.chosen(catalog, favourites);
        let is_unread = satellite.is_none();
        let satellite = satellite.filter(|satellite| satellite.catalog_number > 0);
        let held_number = satellite.map(|satellite| satellite.catalog_number);
        let known_numbers =
            [marked, held_number, model.catalog_table.inspected].into_iter().flatten();
        let followed = known_numbers.clone().find(|number| is_chosen(&chosen, *number));
        let followed = followed.or_else(|| first(&chosen));
        head(ui, &chosen, is_own, &mut change);
        if let Some(satellite) =
            satellite.filter(|satellite| followed != Some(satellite.catalog_number))
        {
            let name = &satellite.name;
            let words = format!("The unit holds {name} now, and will follow the one marked here.");
            line(ui, Tone::Caution, &words);
        }
        if is_unread {
            line(ui, Tone::Plain, "The satellite on the unit has not been read yet.");
        }
        search(ui, catalog, form, &mut change);
        form.satellite = followed;
        for object in &chosen.objects {
            row(ui, model, catalog, object, followed == Some(object.catalog_number), &mut change);
        }
    });
    let mut numbers = form.numbers.clone().unwrap_or_else(|| favourites.clone());
    match change {
        None => {}
        Some(Change::Favourites) => form.numbers = None,
        Some(Change::Follow(number)) => form.marked = Some(number),
        Some(Change::Remove(number)) => {
            numbers.retain(|other| *other != number);
            form.numbers = Some(numbers);
        }
        Some(Change::Add(number)) => {
            numbers.push(number);
            form.numbers = Some(numbers);
        }
    }
}

fn is_chosen(chosen: &Chosen, number: u32) -> bool {
    chosen.objects.iter().any(|object| object.catalog_number == number && is_sent(object))
}

fn first(chosen: &Chosen) -> Option<u32> {
    chosen.objects.iter().find(|object| is_sent(object)).map(|object| object.catalog_number)
}

fn is_sent(object: &ChosenObject) -> bool {
    object.epoch.is_some() && object.problem.is_none()
}

fn head(ui: &mut Ui, chosen: &Chosen, is_own: bool, change: &mut Option<Change>) {
    let t = theme::tokens(ui);
    let count = chosen.objects.iter().filter(|object| is_sent(object)).count();
    let plural = if count == 1 { "" } else { "s" };
    ui.label(RichText::new(format!("{count} satellite{plural} to send")).font(text::value()));
    ui.horizontal_wrapped(|ui| {
        let words = "The unit tracks the one selected here.";
        ui.label(RichText::new(words).font(text::small()).color(t.t3));
        if is_own && ui.button("Use the favourites").clicked() {
            *change = Some(Change::Favourites);
        }
    });
}

fn row(
    ui: &mut Ui,
    model: &Model,
    catalog: &Catalog,
    object: &ChosenObject,
    is_followed: bool,
    change: &mut Option<Change>,
) {
    let t = theme::tokens(ui);
    let number = object.catalog_number;
    let name = if object.name.is_empty() { number.to_string() } else { object.name.clone() };
    let age_s = object.epoch.map(|epoch| seconds_between(epoch, model.now));
    let age = age_s.map_or_else(|| "no elements".to_owned(), format::age);
    // The table of the elements uses the same colours.
    let tone = catalog.get(number).map_or(Tone::Caution, |elements| age_tone(elements, model.now));
    let (mark, colour) = age_look(tone, t);
    let spacing = ui.spacing().item_spacing.x;
    let of_mark = if mark.is_some() { MARK + spacing } else { 0.0 };
    let of_age = paint::text_width(ui, &age, text::small()) + spacing;
    let of_omit = paint::text_width(ui, OMIT, text::body_medium())
        + 2.0 * ui.spacing().button_padding.x
        + spacing;
    let (width, left_to_right) = (ui.available_width(), Layout::left_to_right(Align::Center));
    ui.allocate_ui_with_layout(vec2(width, ROW), left_to_right, |ui| {
        let room = vec2((width - of_mark - of_age - of_omit).max(0.0).floor(), ROW);
        ui.allocate_ui_with_layout(room, left_to_right, |ui| {
            ui.set_min_width(room.x);
            let can = is_sent(object);
            ui.add_enabled_ui(can, |ui| {
                let radio = ui.radio(is_followed, "");
                paint::focus_ring(ui, &radio, RADIUS);
                let spoken = format!("The unit follows {name}");
                radio.widget_info(|| {
                    WidgetInfo::selected(Role::RadioButton, can, is_followed, &spoken)
                });
                if radio.clicked() {
                    *change = Some(Change::Follow(number));
                }
            });
            let words = RichText::new(&name).font(text::body_medium());
            ui.add(Label::new(words).truncate()).on_hover_text(&name);
        });
        if let Some(mark) = mark {
            let (place, _) = ui.allocate_exact_size(vec2(MARK, MARK), Sense::hover());
            icons::paint(ui.painter(), place, mark, colour);
        }
        ui.label(RichText::new(age).font(text::small()).color(colour));
        if named(ui, true, OMIT, &format!("Leave out {name}")) {
            *change = Some(Change::Remove(number));
        }
    });
    if let Some(problem) = &object.problem {
        line(ui, Tone::Bad, &sentence(&problem.to_string()));
    }
}

fn search(ui: &mut Ui, catalog: &Catalog, form: &mut Form, change: &mut Option<Change>) {
    let t = theme::tokens(ui);
    let hint = RichText::new("Add: number or name").color(t.t3);
    let width = ui.available_width();
    let edit = TextEdit::singleline(&mut form.search).hint_text(hint).desired_width(width);
    let edit = ui.add(edit.id_salt("add a satellite"));
    edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Add a satellite"));
    if form.search.trim().is_empty() {
        return;
    }
    let numbers: Vec<u32> = form
        .numbers
        .clone()
        .or_else(|| form.known_numbers().map(<[u32]>::to_vec))
        .unwrap_or_default();
    let found = catalog.search(&form.search, OFFERED + numbers.len());
    let offered: Vec<&Elements> = found
        .into_iter()
        .filter(|one| !numbers.contains(&one.catalog_number()))
        .take(OFFERED)
        .collect();
    if offered.is_empty() {
        let words = "No other object has this number or name.";
        ui.label(RichText::new(words).font(text::small()).color(t.t3));
    }
    for elements in offered {
        let number = elements.catalog_number();
        let size = vec2(ui.available_width(), ROW);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            if named(ui, true, "Add", &format!("Add {}", elements.name())) {
                *change = Some(Change::Add(number));
            }
            ui.label(RichText::new(number.to_string()).font(text::small()).color(t.t3));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let name = RichText::new(elements.name()).font(text::body());
                ui.add(Label::new(name).truncate());
            });
        });
    }
}

/// Shows a button with a longer accessible name. Returns `true` on a click.
pub(super) fn named(ui: &mut Ui, enabled: bool, word: &str, name: &str) -> bool {
    let response = ui.add_enabled(enabled, Button::new(word));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    response.clicked()
}
