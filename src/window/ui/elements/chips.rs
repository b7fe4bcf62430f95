//! Groups of the catalog, one of which is shown, and the export.

use std::collections::BTreeSet;

use egui::{Align2, Color32, Rect, Role, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use super::{ElementsState, PADDING, table, words};
use crate::{
    contract::CatalogState,
    model::{
        Model, UiCommand,
        catalog_table::Subset,
        export::{ElementForm, Export},
    },
    ui::{
        format, replay, text, theme,
        widgets::{
            button::{self, Button},
            drop_down::DropDown,
            paint,
        },
    },
};

pub(super) const HEIGHT: f32 = 40.0;
const CHIP: f32 = 24.0;
const GAP: f32 = 8.0;

/// Draws the groups and the actions on the whole table.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let chips = chips(model);
    // A removed source or group has no objects to show.
    if !chips.iter().any(|(scope, _)| *scope == state.question.scope) {
        state.question.scope = Subset::All;
    }
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let exported = Exported::new(model, state);
    let mut right = inner.right_center();
    let [export_at] = button::row_before(&mut right, CHIP, [exported.list().width(ui)]);
    groups(ui, inner.with_max_x(right.x), &chips, state);
    exported.show(ui, export_at, commands);
}

/// Draws the chips, and a button for the chips without room.
fn groups(ui: &Ui, inner: Rect, chips: &[(Subset, usize)], state: &mut ElementsState) {
    let widths: Vec<f32> = chips.iter().map(|chip| width(ui, chip)).collect();
    let more = 72.0;
    let all: f32 = widths.iter().map(|width| width + GAP).sum();
    let max = if all - GAP <= inner.width() { inner.right() } else { inner.right() - more };
    let mut x = inner.left();
    let mut hidden = Vec::new();
    let top = inner.center().y - CHIP / 2.0;
    for (chip, width) in chips.iter().zip(widths) {
        let place = Rect::from_min_size(pos2(x, top), vec2(width, CHIP));
        if place.right() > max || !hidden.is_empty() {
            hidden.push(chip);
            continue;
        }
        x = place.right() + GAP;
        if one(ui, place, chip, state.question.scope == chip.0) {
            state.question.scope = chip.0.clone();
        }
    }
    if hidden.is_empty() {
        return;
    }
    let active = hidden.iter().find(|(scope, _)| *scope == state.question.scope);
    let shown = active.map_or("More", |(scope, _)| word(scope));
    let name = format!("More groups, {}", word(&state.question.scope));
    let list = DropDown { button: Button::quiet(shown), salt: "more groups", name: &name };
    let right = (x + list.width(ui)).min(inner.right());
    let place = Rect::from_min_max(pos2(x, top), pos2(right, top + CHIP));
    list.show(ui, place, |ui| {
        for (scope, count) in hidden {
            let words = format!("{}, {}", word(scope), format::number(*count as f64, 0));
            ui.selectable_value(&mut state.question.scope, scope.clone(), words);
        }
    });
}

/// Rows that Export saves.
struct Exported {
    numbers: Vec<u32>,
    name: String,
    lock: Option<&'static str>,
}

impl Exported {
    /// Returns the marked rows, or all rows if none is marked.
    fn new(model: &Model, state: &ElementsState) -> Self {
        let marked = state.selection.marked();
        let (numbers, subset): (Vec<u32>, _) = if marked.is_empty() {
            let rows = table::shown(model).map(|answer| answer.rows.to_vec());
            (rows.unwrap_or_default(), "listed")
        } else {
            (marked.iter().copied().collect(), "marked")
        };
        let name = format!("Export the {} {subset}", words::plain(numbers.len()));
        Self { numbers, name, lock: replay::lock(model) }
    }

    fn list(&self) -> DropDown<'_> {
        DropDown {
            button: Button::quiet("Export").locked(self.numbers.is_empty()).locked_by(self.lock),
            salt: "export elements",
            name: &self.name,
        }
    }

    fn show(&self, ui: &Ui, place: Rect, commands: &mut Vec<UiCommand>) {
        self.list().show(ui, place, |ui| {
            ui.label(&self.name);
            for (word, form) in [
                ("TLE\u{2026}", ElementForm::Tle),
                ("OMM, JSON\u{2026}", ElementForm::OmmJson),
                ("OMM, CSV\u{2026}", ElementForm::OmmCsv),
            ] {
                if ui.button(word).clicked() {
                    let numbers = self.numbers.clone().into();
                    commands.push(UiCommand::Save(Export::Elements { numbers, form }));
                }
            }
        });
    }
}

/// Returns the groups with the numbers of their objects.
fn chips(model: &Model) -> Vec<(Subset, usize)> {
    let CatalogState::Ready(catalog) = &model.catalog else { return vec![(Subset::All, 0)] };
    let favourites = model.station.favourites.iter();
    let held_count =
        favourites.filter(|favourite| catalog.get(favourite.satellite).is_some()).count();
    let mut chips = vec![(Subset::Favourites, held_count), (Subset::All, catalog.len())];
    let groups = catalog.groups().map(|(name, count)| (Subset::Group(name.to_owned()), count));
    chips.extend(groups);
    let old = table::shown(model).map_or(0, |answer| answer.old);
    chips.push((Subset::Old, old));
    // A station file may have two groups with the same name.
    let names: BTreeSet<&String> = model.station.groups.iter().map(|group| &group.name).collect();
    chips.extend(names.into_iter().map(|name| {
        let own = model.station.in_groups(name).into_iter();
        (Subset::Own(name.clone()), own.filter(|number| catalog.get(*number).is_some()).count())
    }));
    chips
}

fn word(scope: &Subset) -> &str {
    match scope {
        Subset::All => "All",
        Subset::Favourites => "Favourites",
        Subset::Group(name) | Subset::Own(name) => name,
        Subset::Old => "Older than 7 d",
    }
}

fn count((_, count): &(Subset, usize)) -> String {
    format::number(*count as f64, 0)
}

fn width(ui: &Ui, chip: &(Subset, usize)) -> f32 {
    let word = paint::text_width(ui, word(&chip.0), text::small());
    (word + paint::text_width(ui, &count(chip), text::small()) + 30.0).ceil()
}

fn one(ui: &Ui, place: Rect, chip: &(Subset, usize), is_active: bool) -> bool {
    let t = theme::tokens(ui);
    let (word, count) = (word(&chip.0), count(chip));
    let own = if matches!(chip.0, Subset::Own(_)) { ", your group" } else { "" };
    let name = format!("{word}{own}, {count}");
    let response = paint::control(ui, ("chip", own, word), place, Role::RadioButton, true, &name);
    response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, is_active, &name));
    let fill = match (is_active, response.hovered()) {
        (true, _) => t.bgsel,
        (false, true) => t.bg3,
        (false, false) => Color32::TRANSPARENT,
    };
    let border = if is_active { t.sat } else { t.line };
    let stroke = Stroke::new(1.0, border);
    ui.painter().rect(place, 12, fill, stroke, StrokeKind::Inside);
    let room = place.shrink2(vec2(11.0, 0.0));
    let (font, colour) =
        if is_active { (text::small_strong(), t.t1) } else { (text::small(), t.t2) };
    paint::text_in(ui, room, Align2::LEFT_CENTER, word, font, colour);
    let colour = if is_active { t.t1 } else { t.t3 };
    paint::text_in(ui, room, Align2::RIGHT_CENTER, &count, text::small(), colour);
    paint::focus_ring(ui, &response, 12);
    response.clicked()
}
