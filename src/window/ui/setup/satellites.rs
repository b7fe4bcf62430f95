//! The set-up step for the satellites: groups and single names of the catalog, and the chosen
//! satellites.

use std::sync::Arc;

use egui::{
    Align, Button, Key, Layout, Rect, RichText, Role, ScrollArea, TextEdit, Ui, WidgetInfo, vec2,
};

use super::draft::SetupDraft;
use crate::{
    contract::CatalogState,
    model::Model,
    orbit::Catalog,
    ui::{
        format,
        object_search::{ObjectSearch, named},
        text, theme,
        widgets::card,
    },
};

/// Max number of satellites in a group that the step offers.
const LARGEST_GROUP: usize = 200;
const LIST: f32 = 300.0;
const ROW: f32 = 26.0;
const CARD: f32 = 638.0;

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    draft: &mut SetupDraft,
    state: &mut ObjectSearch,
    wants_focus: &mut bool,
) {
    let t = theme::tokens(ui);
    let CatalogState::Ready(catalog) = &model.catalog else {
        let words = "There are no elements to choose from. You can continue and choose later.";
        ui.label(RichText::new(words).font(text::body()).color(t.warn));
        return;
    };
    groups(ui, catalog, draft);
    card::show(ui, CARD, |ui| {
        ui.horizontal_top(|ui| {
            let half = (ui.available_width() - 16.0) / 2.0;
            let column = vec2(half, LIST);
            let down = Layout::top_down(Align::Min);
            ui.allocate_ui_with_layout(column, down, |ui| {
                search(ui, catalog, draft, state, wants_focus);
            });
            ui.add_space(8.0);
            ui.allocate_ui_with_layout(column, down, |ui| chosen(ui, catalog, draft));
        });
    });
}

/// Shows the groups that are small enough to follow.
fn groups(ui: &mut Ui, catalog: &Catalog, draft: &mut SetupDraft) {
    let t = theme::tokens(ui);
    let fit = |(_, count): &(&str, usize)| (1..=LARGEST_GROUP).contains(count);
    let groups: Vec<(&str, usize)> = catalog.groups().filter(fit).collect();
    if groups.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Add a group").font(text::body()).color(t.t2));
        for (group, count) in groups {
            let name = format!("Add the group {group}, {}", super::super::elements::objects(count));
            let response = ui.button(format!("{group}, {count}"));
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            if response.clicked() {
                for elements in catalog.in_group(group) {
                    draft.favourites.mark(elements.catalog_number(), true);
                }
            }
        }
    });
    ui.add_space(4.0);
}

fn search(
    ui: &mut Ui,
    catalog: &Arc<Catalog>,
    draft: &mut SetupDraft,
    state: &mut ObjectSearch,
    wants_focus: &mut bool,
) {
    let t = theme::tokens(ui);
    let hint = RichText::new("Number or name; Enter adds the first").color(t.t3);
    let edit = TextEdit::singleline(&mut state.typed).id_salt("search").hint_text(hint);
    let edit = ui.add(edit.desired_width(f32::INFINITY));
    edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Search the catalogue"));
    if std::mem::take(wants_focus) {
        edit.request_focus();
    }
    if !state.typed.trim().is_empty() {
        let words = "Enter adds the first. Press Enter again to continue.";
        ui.label(RichText::new(words).font(text::small()).color(t.t2));
    }
    let is_entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if is_entered && !state.typed.trim().is_empty() {
        let first = state.objects(catalog).first().map(|(number, _)| *number);
        if let Some(number) = first {
            draft.favourites.mark(number, true);
            state.typed.clear();
        }
        edit.request_focus();
    }
    let objects = state.objects(catalog);
    if objects.is_empty() {
        let words = "No object has this number or name.";
        ui.label(RichText::new(words).font(text::small()).color(t.warn));
    }
    let favourites = &mut draft.favourites;
    list(ui, "found", objects, |ui, number, name| {
        let is_chosen = favourites.contains(number);
        if row(ui, number, name, !is_chosen, "Add") {
            favourites.mark(number, true);
        }
    });
}

fn chosen(ui: &mut Ui, catalog: &Catalog, draft: &mut SetupDraft) {
    let t = theme::tokens(ui);
    let numbers = draft.favourites.numbers();
    ui.horizontal(|ui| {
        let words = format!("{} chosen", format::number(numbers.len() as f64, 0));
        ui.label(RichText::new(words).font(text::body_medium()).color(t.t1));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.add_enabled(!numbers.is_empty(), Button::new("Remove all")).clicked() {
                draft.favourites = draft.favourites.with_numbers(&[]);
            }
        });
    });
    let objects: Vec<(u32, String)> = numbers
        .into_iter()
        .map(|number| {
            catalog.get(number).map_or_else(|| (number, "not in the catalogue".to_owned()), named)
        })
        .collect();
    list(ui, "chosen", &objects, |ui, number, name| {
        if row(ui, number, name, true, "Remove") {
            draft.favourites.mark(number, false);
        }
    });
}

fn list(
    ui: &mut Ui,
    salt: &str,
    objects: &[(u32, String)],
    mut one: impl FnMut(&mut Ui, u32, &str),
) {
    ui.spacing_mut().item_spacing.y = 0.0;
    // The list shows only whole rows, so that Tab reaches no hidden row.
    let height = (ui.available_height() / ROW).floor() * ROW;
    let area = ScrollArea::vertical().id_salt(salt).max_height(height).auto_shrink(false);
    area.show_rows(ui, ROW, objects.len(), |ui, range| {
        for (number, name) in objects.get(range).unwrap_or_default() {
            let row = Rect::from_min_size(ui.cursor().min, vec2(ui.available_width(), ROW));
            // The scroll area requests one row more than is visible.
            if ui.clip_rect().intersect(row).height() > 4.0 {
                one(ui, *number, name);
            }
        }
    });
}

/// Draws an object with a button. Returns `true` when the operator clicks the button.
fn row(ui: &mut Ui, number: u32, name: &str, enabled: bool, word: &str) -> bool {
    let t = theme::tokens(ui);
    let size = vec2(ui.available_width(), ROW);
    let layout = Layout::right_to_left(Align::Center);
    ui.push_id((word, number), |ui| {
        ui.allocate_ui_with_layout(size, layout, |ui| {
            let response = ui.add_enabled(enabled, Button::new(word).small());
            let spoken = format!("{word} {name}");
            response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, &spoken));
            ui.label(RichText::new(number.to_string()).font(text::small()).color(t.t3));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let words = RichText::new(name).font(text::body()).color(t.t1);
                ui.add(egui::Label::new(words).truncate());
            });
            response.clicked()
        })
        .inner
    })
    .inner
}
