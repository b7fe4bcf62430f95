//! The Elements view: the sources of elements with their ages, and the catalog, where
//! the operator searches and marks favourites.

mod add;
mod search;
mod sources;
mod words;

use egui::{Rect, RichText, ScrollArea, Ui, UiBuilder, vec2};

use super::{confirm::Question, text, theme, words::sentence};
use crate::{
    engine::{
        self, CatalogState,
        sources::{SourceWork, Sources},
    },
    model::{Model, UiCommand},
};

/// Width of the catalog.
const CATALOG_WIDTH: f32 = 416.0;
/// Width of the catalog in a small window.
const NARROW_CATALOG_WIDTH: f32 = 360.0;
/// Below this width of the view the window is small.
const SMALL_BELOW: f32 = 1100.0;
const PADDING: f32 = 16.0;

/// Input and search results.
#[derive(Default)]
pub struct ElementsState {
    add: add::AddState,
    search: search::SearchState,
    upload_is_open: bool,
}

impl ElementsState {
    /// Gives the search field the keyboard focus.
    pub fn focus_search(&mut self) {
        self.search.focus();
    }
}

/// Draws the view. `settings_are_edited`: the station's settings have unsaved edits and must
/// not change. Returns the place for the upload to the selected unit, when it is open in
/// place of the catalog.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    settings_are_edited: bool,
    state: &mut ElementsState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) -> Option<Rect> {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let wide = rect.width() >= SMALL_BELOW;
    let catalog_width = if wide { CATALOG_WIDTH } else { NARROW_CATALOG_WIDTH };
    let (left, right) = rect.split_left_right_at_x(rect.right() - catalog_width);
    ui.painter().rect_filled(right, 0.0, t.bg1);
    let builder = UiBuilder::new().id_salt("sources").max_rect(left.shrink2(vec2(PADDING, 0.0)));
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(left);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.add_space(PADDING);
            head(ui, model, &mut state.upload_is_open, commands);
            sources::show(ui, model, question, commands);
            add::show(ui, &model.sources, &mut state.add, commands);
            ui.add_space(PADDING);
        });
    });
    ui.painter().vline(right.left() + 0.5, rect.y_range(), (1.0, t.line));
    if state.upload_is_open {
        return Some(right.shrink(PADDING));
    }
    let builder = UiBuilder::new().id_salt("catalogue").max_rect(right.shrink(PADDING));
    ui.scope_builder(builder, |ui| {
        search::show(ui, model, settings_are_edited, &mut state.search, commands);
    });
    None
}

fn head(ui: &mut Ui, model: &Model, upload_is_open: &mut bool, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let sources = &model.sources;
    ui.label(RichText::new("Elements").font(text::title()));
    let catalog = match &model.catalog {
        CatalogState::Loading => "The elements are being read.".to_owned(),
        CatalogState::Failed => "There are no elements.".to_owned(),
        CatalogState::Ready(catalog) => words::catalog(catalog, model.now),
    };
    ui.label(RichText::new(catalog).font(text::body()).color(t.t2));
    if let Some(problem) = &sources.problem {
        ui.label(RichText::new(sentence(problem)).font(text::body()).color(t.bad));
    }
    ui.horizontal(|ui| {
        let all = egui::Button::new("Refresh all");
        let can = sources.is_free() && !sources.list.is_empty();
        if ui.add_enabled(can, all).clicked() {
            let names = sources.list.iter().map(|source| source.name.clone()).collect();
            commands
                .push(UiCommand::Station(engine::Command::RefreshSources { names, forced: false }));
        }
        let word = if *upload_is_open { "Back to the catalogue" } else { "Upload to unit…" };
        if ui.add_enabled(model.antenna().is_some(), egui::Button::new(word)).clicked() {
            *upload_is_open ^= true;
        }
    });
    ui.label(RichText::new(work(sources)).font(text::body()).color(t.t2));
    ui.add_space(8.0);
}

fn work(sources: &Sources) -> &'static str {
    match sources.work {
        SourceWork::Reading => "The sources are being read.",
        SourceWork::Asking => "The servers are being asked. The elements in use stay meanwhile.",
        SourceWork::Nothing if sources.is_locked => "The list of sources is left as it is.",
        SourceWork::Nothing if sources.list.is_empty() => {
            "No sources yet. The elements that come with Azel are in use."
        }
        SourceWork::Nothing => "Servers that were asked in the last 2 h are left alone.",
    }
}
