//! A choice of a satellite from the favourites, or by number or name from the catalog.

use egui::{Key, Role, TextEdit, Ui, WidgetInfo, vec2};

use crate::{
    contract::CatalogState,
    model::Model,
    ui::{
        object_search::ObjectSearch,
        theme,
        widgets::{button::Button, drop_down::DropDown, form::ROW},
        words,
    },
};

/// Max number of offered objects.
const OFFERED: usize = 6;
const FIELD: f32 = 160.0;

/// Shows a field for a number or a name, the search results, and a list of `favourites`. Returns
/// the chosen satellite. The picker does not offer `excluded` satellites.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    favourites: &[u32],
    excluded: &[u32],
    search: &mut ObjectSearch,
) -> Option<u32> {
    let mut chosen = None;
    ui.vertical(|ui| {
        let is_entered = ui.horizontal(|ui| {
            let is_entered = field(ui, search);
            chosen = favourite(ui, model, favourites, excluded);
            is_entered
        });
        if search.typed.trim().is_empty() {
            return;
        }
        let CatalogState::Ready(catalog) = &model.catalog else {
            ui.colored_label(theme::tokens(ui).warn, "There are no elements to search.");
            return;
        };
        let objects =
            search.objects(catalog).iter().filter(|(number, _)| !excluded.contains(number));
        let objects: Vec<&(u32, String)> = objects.take(OFFERED).collect();
        if objects.is_empty() {
            let words = "No other object has this number or name.";
            ui.colored_label(theme::tokens(ui).warn, words);
        }
        for (place, (number, name)) in objects.into_iter().enumerate() {
            let is_first = is_entered.inner && place == 0;
            if ui.button(format!("{name}, {number}")).clicked() || is_first {
                chosen = Some(*number);
            }
        }
    });
    if chosen.is_some() {
        search.typed.clear();
    }
    chosen
}

/// Shows the field. Returns `true` if the operator pressed Enter in it.
fn field(ui: &mut Ui, search: &mut ObjectSearch) -> bool {
    let edit = TextEdit::singleline(&mut search.typed)
        .id_salt("search of a satellite")
        .hint_text("Number or name")
        .desired_width(FIELD);
    let response = ui.add(edit);
    response.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Search for a satellite"));
    let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if is_entered {
        response.request_focus();
    }
    is_entered
}

fn favourite(ui: &mut Ui, model: &Model, favourites: &[u32], excluded: &[u32]) -> Option<u32> {
    let list =
        DropDown { button: Button::normal("Favourite"), salt: "favourite", name: "Favourite" };
    let (place, _) = ui.allocate_exact_size(vec2(list.width(ui), ROW), egui::Sense::hover());
    let mut chosen = None;
    list.show(ui, place, |ui| {
        for number in favourites.iter().filter(|number| !excluded.contains(number)) {
            if ui.button(words::satellite(model, *number)).clicked() {
                chosen = Some(*number);
            }
        }
    });
    chosen
}
