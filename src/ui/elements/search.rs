//! The catalog: search by number, name and group, and mark favourites.

use std::sync::Arc;

use egui::{
    Align, Align2, Layout, Rect, RichText, Role, ScrollArea, Sense, TextEdit, Ui, UiBuilder,
    WidgetInfo, vec2,
};

use super::{sources::named_button, words};
use crate::{
    astro::time::seconds_between,
    engine::{self, CatalogState},
    model::{Model, UiCommand},
    orbit::{Catalog, Elements},
    ui::{
        format, text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            drop_down::DropDown,
            paint,
        },
    },
};

const ROW: f32 = 48.0;
/// Width reserved for the button of a row.
const BUTTON: f32 = 80.0;

/// Search and result.
#[derive(Default)]
pub(super) struct SearchState {
    typed: String,
    among: Among,
    found: Option<Found>,
    wants_focus: bool,
}

/// The set of objects to search.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
enum Among {
    /// All objects.
    #[default]
    All,
    /// Favourites.
    Favourites,
    /// Objects of one source.
    Group(String),
}

impl Among {
    fn word(&self) -> &str {
        match self {
            Self::All => "All",
            Self::Favourites => "Favourites",
            Self::Group(name) => name,
        }
    }
}

/// The outcome of a search, kept until something it depends on changes.
struct Found {
    catalog: Arc<Catalog>,
    typed: String,
    among: Among,
    favourites: Vec<u32>,
    numbers: Vec<u32>,
}

impl SearchState {
    pub(super) fn focus(&mut self) {
        self.wants_focus = true;
    }

    fn numbers(&mut self, catalog: &Arc<Catalog>, favourites: &[u32]) -> &[u32] {
        let is_known = |found: &Found| {
            Arc::ptr_eq(&found.catalog, catalog)
                && found.typed == self.typed
                && found.among == self.among
                && (self.among != Among::Favourites || found.favourites == favourites)
        };
        let found = self.found.take().filter(is_known).unwrap_or_else(|| {
            let mut found = match &self.among {
                Among::Group(group) => catalog.search_group(group, &self.typed, usize::MAX),
                Among::All | Among::Favourites => catalog.search(&self.typed, usize::MAX),
            };
            if self.among == Among::Favourites {
                found.retain(|elements| favourites.contains(&elements.catalog_number()));
            }
            Found {
                catalog: Arc::clone(catalog),
                typed: self.typed.clone(),
                among: self.among.clone(),
                favourites: favourites.to_vec(),
                numbers: found.into_iter().map(Elements::catalog_number).collect(),
            }
        });
        &self.found.insert(found).numbers
    }
}

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    settings_are_edited: bool,
    state: &mut SearchState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.label(RichText::new("Catalogue").font(text::title()));
    let catalog = match &model.catalog {
        CatalogState::Ready(catalog) => catalog,
        CatalogState::Loading | CatalogState::Failed => {
            let words = "There is nothing to search.";
            ui.label(RichText::new(words).font(text::body()).color(t.t2));
            return;
        }
    };
    fields(ui, catalog, state);
    let numbers = state.numbers(catalog, &model.station.favourites);
    let count = words::objects(numbers.len());
    let words = if numbers.is_empty() {
        "No object has this number or name.".to_owned()
    } else if settings_are_edited {
        format!("{count}. Save or revert the preferences before the favourites change.")
    } else {
        count
    };
    ui.label(RichText::new(words).font(text::small()).color(t.t3));
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, numbers.len(), |ui, range| {
        for number in numbers.get(range).unwrap_or_default() {
            if let Some(elements) = catalog.get(*number) {
                row(ui, model, catalog, elements, settings_are_edited, commands);
            }
        }
    });
}

fn fields(ui: &mut Ui, catalog: &Catalog, state: &mut SearchState) {
    let t = theme::tokens(ui);
    ui.horizontal(|ui| {
        let hint = RichText::new("Number or name").color(t.t3);
        let edit = TextEdit::singleline(&mut state.typed).hint_text(hint).desired_width(184.0);
        let edit = ui.add(edit.id_salt("search"));
        edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Search the catalogue"));
        if std::mem::take(&mut state.wants_focus) {
            edit.request_focus();
        }
        let shown = state.among.word().to_owned();
        let name = format!("Group, {shown}");
        let groups = DropDown { button: Button::normal(&shown), salt: "group", name: &name };
        let size = vec2(ui.available_width(), SMALL_HEIGHT);
        let (place, _) = ui.allocate_exact_size(size, Sense::hover());
        groups.show(ui, place, |ui| {
            for among in [Among::All, Among::Favourites] {
                let word = among.word().to_owned();
                ui.selectable_value(&mut state.among, among, word);
            }
            for (group, count) in catalog.groups() {
                let words = format!("{group}, {}", format::number(count as f64, 0));
                ui.selectable_value(&mut state.among, Among::Group(group.to_owned()), words);
            }
        });
    });
    // A source that is gone has no objects to search.
    if let Among::Group(group) = &state.among
        && !catalog.groups().any(|(name, _)| name == group)
    {
        state.among = Among::All;
    }
}

fn row(
    ui: &mut Ui,
    model: &Model,
    catalog: &Catalog,
    elements: &Elements,
    settings_are_edited: bool,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let number = elements.catalog_number();
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let name = if elements.name().is_empty() { "No name" } else { elements.name() };
    let age = format::age(seconds_between(elements.epoch(), model.now));
    let groups: Vec<&str> = catalog.groups_of(number).collect();
    let second = format!("{number} · {age} old · {}", groups.join(", "));
    let room = rect.with_max_x(rect.right() - BUTTON - 8.0);
    let (first_line, second_line) = room.shrink2(vec2(0.0, 6.0)).split_top_bottom_at_fraction(0.5);
    paint::text_in(ui, first_line, Align2::LEFT_CENTER, name, text::body_medium(), t.t1);
    paint::text_in(ui, second_line, Align2::LEFT_CENTER, &second, text::small(), t.t3);
    paint::name_text(ui, ("object", number), room, &format!("{name}, {second}"))
        .on_hover_text(format!("{name}\n{second}"));

    let is_favourite = model.station.favourites.contains(&number);
    let (word, spoken) = if is_favourite {
        ("Remove", format!("Remove {name} from the favourites"))
    } else {
        ("Add", format!("Add {name} to the favourites"))
    };
    let place = Rect::from_min_max(room.right_top() + vec2(8.0, 0.0), rect.max);
    let layout = Layout::right_to_left(Align::Center);
    let builder = UiBuilder::new().id_salt(("follow", number)).max_rect(place).layout(layout);
    ui.scope_builder(builder, |ui| {
        if named_button(ui, !settings_are_edited, word, &spoken) {
            commands.push(UiCommand::Station(engine::Command::SetFavourite {
                number,
                is_favourite: !is_favourite,
            }));
        }
    });
}
