//! The catalog as a table that draws only the rows in view.

use std::sync::Arc;

use egui::{
    Align2, Color32, Event, Key, Modifiers, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo,
    pos2, vec2,
};

use super::{
    ElementsState, PADDING,
    columns::{self, Row},
    copy,
    words::{self, Form},
};
use crate::{
    contract::{self, CatalogState, antenna::AntennaModel},
    model::{
        DistanceUnit, Model, UiCommand,
        catalog_table::{Answer, Column},
    },
    orbit::Catalog,
    station::Priority,
    ui::{
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        upload::Choice as UploadChoice,
        widgets::{list::List, paint, selection::Choice},
    },
};

pub(super) const HEAD: f32 = 24.0;
const ROW: f32 = 25.0;
/// Side length of a check box, points.
const BOX: f32 = 16.0;

/// Draws the head and the rows of the table.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    lock: Option<&'static str>,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let (top, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    let rows = shown(model).map(|answer| Arc::clone(&answer.rows)).unwrap_or_default();
    show_head(ui, top, &rows, model.appearance.distances, state);
    ui.painter().rect_filled(body, 0.0, theme::tokens(ui).field);
    let list = List::new(ui, body, "catalogue", "Catalogue", ROW);
    keys(ui, &list, &rows, model, lock, state, commands);
    let CatalogState::Ready(catalog) = &model.catalog else {
        return list.show_empty(ui, "no objects", "There is nothing to search.");
    };
    if rows.is_empty() {
        let words = words::nothing_found(&state.question, catalog.len());
        return list.show_empty(ui, "no objects", &words);
    }
    let draws = Draws { list: &list, model, catalog, rows: &rows, lock };
    let mut scroll = state.scroll;
    list.show_rows(ui, rows.len(), &mut scroll, |ui, place, index| {
        if let Some(number) = rows.get(index) {
            draws.row(ui, place, *number, state, commands);
        }
    });
    state.scroll = scroll;
}

/// Returns the rows while they belong to the current catalog.
pub(super) fn shown(model: &Model) -> Option<&Answer> {
    let CatalogState::Ready(catalog) = &model.catalog else { return None };
    let answer = model.catalog_table.answer.as_ref();
    answer.filter(|answer| Arc::ptr_eq(&answer.inputs.catalog, catalog))
}

fn show_head(ui: &Ui, rect: Rect, rows: &[u32], unit: DistanceUnit, state: &mut ElementsState) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let some = !state.selection.marked().is_empty();
    let name = if some { "Unmark all" } else { "Mark all that are shown" };
    let place = paint::square(pos2(rect.left() + PADDING + BOX / 2.0, rect.center().y), BOX);
    let response = paint::control(ui, "mark all", place, Role::CheckBox, true, name);
    paint_box(ui, place, some.then_some(Icon::Dash));
    paint::focus_ring(ui, &response, 3);
    if response.on_hover_text(name).clicked() {
        if some { state.selection.unmark_all() } else { state.selection.mark_all(rows) }
    }
    for (column, place) in columns::places(rect) {
        let is_sorted = state.question.sort == column;
        let subject = columns::spoken(column);
        let words = columns::head(column, unit);
        let way = match (is_sorted, state.question.is_descending) {
            (true, false) => ", ascending",
            (true, true) => ", descending",
            (false, _) => "",
        };
        let name = format!("Sort by {subject}{way}");
        let response = paint::control(ui, ("sort", subject), place, Role::Button, true, &name);
        let (font, colour) = if is_sorted {
            (text::sized(11.0, Weight::SemiBold), t.t1)
        } else {
            (text::caption(), if response.hovered() { t.t1 } else { t.t3 })
        };
        if column == Column::Star {
            let icon = if is_sorted { Icon::Star } else { Icon::OpenStar };
            icons::paint(ui.painter(), paint::square(place.center(), 14.0), icon, colour);
        } else {
            let anchor =
                if columns::is_left(column) { Align2::LEFT_CENTER } else { Align2::RIGHT_CENTER };
            let drawn = paint::text_in(ui, place, anchor, &words, font, colour);
            if is_sorted {
                let x =
                    if columns::is_left(column) { drawn.right() + 8.0 } else { drawn.left() - 8.0 };
                sort_mark(ui, pos2(x, rect.center().y), state.question.is_descending);
            }
        }
        paint::focus_ring(ui, &response, 2);
        if response.on_hover_text(&name).clicked() {
            state.question.is_descending = is_sorted && !state.question.is_descending;
            state.question.sort = column;
        }
    }
}

fn sort_mark(ui: &Ui, position: egui::Pos2, is_descending: bool) {
    let t = theme::tokens(ui);
    let down = if is_descending { 2.0 } else { -2.0 };
    let ends = [vec2(-3.5, -down), vec2(0.0, down), vec2(3.5, -down)];
    let points = ends.map(|step| position + step).to_vec();
    ui.painter().line(points, Stroke::new(1.5, t.t1));
}

fn paint_box(ui: &Ui, rect: Rect, mark: Option<Icon>) {
    let t = theme::tokens(ui);
    let (fill, border) =
        if mark.is_some() { (t.sat, t.sat) } else { (Color32::TRANSPARENT, t.edge) };
    ui.painter().rect(rect, 3, fill, Stroke::new(1.0, border), StrokeKind::Inside);
    if let Some(mark) = mark {
        icons::paint(ui.painter(), rect.shrink(2.0), mark, t.onsat);
    }
}

/// Data from which the table draws all rows.
struct Draws<'a> {
    list: &'a List,
    model: &'a Model,
    catalog: &'a Catalog,
    rows: &'a [u32],
    lock: Option<&'static str>,
}

impl Draws<'_> {
    fn row(
        &self,
        ui: &Ui,
        rect: Rect,
        number: u32,
        state: &mut ElementsState,
        commands: &mut Vec<UiCommand>,
    ) {
        let Some(elements) = self.catalog.get(number) else { return };
        let row = Row::new(elements, self.catalog, self.model);
        let is_selected = state.selection.row() == Some(number);
        let priority = self.model.station.priority(number);
        let spoken = || row.spoken(priority.map(Priority::number));
        let clear = Color32::TRANSPARENT;
        let response = self.list.option(ui, rect, number, is_selected, clear, spoken);
        for (column, place) in columns::places(rect) {
            if column == Column::Star {
                self.star(ui, place, &row, priority, commands);
            } else {
                cell(ui, place, column, &row);
            }
        }
        self.mark(ui, rect, &row, state);
        if response.clicked() {
            let choice = ui.input(|input| input.modifiers).into();
            state.selection.choose(number, choice, self.rows);
        }
        response.on_hover_text(row.tip());
    }

    fn mark(&self, ui: &Ui, rect: Rect, row: &Row<'_>, state: &mut ElementsState) {
        let number = row.elements.catalog_number();
        let position = pos2(rect.left() + PADDING + BOX / 2.0, rect.center().y);
        let place = paint::square(position, BOX);
        let is_marked = state.selection.is_marked(number);
        let response = ui.interact(
            place.expand(3.0),
            self.list.response.id.with(("mark", number)),
            Sense::CLICK,
        );
        let name = || format!("Mark {}", row.elements.label());
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, is_marked, name()));
        let response = response.on_hover_ui(|ui| {
            ui.label(name());
        });
        paint_box(ui, place, is_marked.then_some(Icon::Check));
        if response.clicked() {
            let shift = ui.input(|input| input.modifiers.shift);
            let choice = if shift { Choice::Range } else { Choice::Toggle };
            state.selection.choose(number, choice, self.rows);
        }
    }

    fn star(
        &self,
        ui: &Ui,
        place: Rect,
        row: &Row<'_>,
        priority: Option<Priority>,
        commands: &mut Vec<UiCommand>,
    ) {
        let t = theme::tokens(ui);
        let number = row.elements.catalog_number();
        let label = row.elements.label();
        let name = if priority.is_some() {
            format!("Remove {label} from the favourites")
        } else {
            format!("Add {label} to the favourites")
        };
        let is_free = self.lock.is_none();
        let sense = if is_free { Sense::CLICK } else { Sense::hover() };
        let response = ui.interact(place, self.list.response.id.with(("star", number)), sense);
        response.widget_info(|| WidgetInfo::labeled(Role::Button, is_free, &name));
        let rect = paint::square(place.center() - vec2(2.0, 0.0), 15.0);
        let (icon, colour) = match (priority, response.hovered() && is_free) {
            (Some(_), _) => (Icon::Star, t.sat),
            (None, true) => (Icon::OpenStar, t.t1),
            (None, false) => (Icon::OpenStar, t.t3),
        };
        icons::paint(ui.painter(), rect, icon, colour);
        if let Some(priority) = priority.filter(|level| *level != Priority::default()) {
            let position = pos2(rect.right() + 1.0, place.center().y);
            let words = priority.number();
            paint::text(ui, position, Align2::LEFT_CENTER, words, text::caption(), t.t1);
        }
        if response.on_hover_text(self.lock.unwrap_or(&name)).clicked() {
            favour(vec![number], priority.is_none(), commands);
        }
    }
}

fn cell(ui: &Ui, place: Rect, column: Column, row: &Row<'_>) {
    let t = theme::tokens(ui);
    let words = row.cell(column);
    let anchor = if columns::is_left(column) { Align2::LEFT_CENTER } else { Align2::RIGHT_CENTER };
    let (font, colour) = match column {
        Column::Name => (text::body_medium(), t.t1),
        Column::Age => {
            let tone = words::age_tone(row.elements, row.now);
            let (icon, colour) = words::age_look(tone, t);
            let drawn = paint::text_in(ui, place, anchor, &words, text::small(), colour);
            if let Some(icon) = icon {
                let position = pos2(drawn.left() - 12.0, place.center().y);
                icons::paint(ui.painter(), paint::square(position, 12.0), icon, colour);
            }
            return;
        }
        Column::NextPass => match row.next.pass() {
            Some(next) if next.aos <= row.now => (text::small_strong(), t.ok),
            Some(_) => (text::small(), t.t1),
            None => (text::small(), t.t3),
        },
        Column::MaxElevation => {
            if let Some(next) = row.next.pass() {
                bar(ui, place, next.max_elevation.degrees());
            }
            (text::small(), t.t1)
        }
        Column::From if row.is_older_set => {
            let position = pos2(place.left() + 6.0, place.center().y);
            icons::paint(ui.painter(), paint::square(position, 12.0), Icon::Warning, t.warn);
            let room = place.with_min_x(place.left() + 17.0);
            paint::text_in(ui, room, anchor, &words, text::small(), t.warn);
            return;
        }
        Column::From | Column::Number => (text::small(), t.t2),
        _ => (text::small(), t.t1),
    };
    paint::text_in(ui, place, anchor, &words, font, colour);
}

/// Draws a bar that is full at 90 degrees.
fn bar(ui: &Ui, place: Rect, degrees: f64) {
    let t = theme::tokens(ui);
    let position = pos2(place.left(), place.center().y - 3.0);
    let whole = Rect::from_min_size(position, vec2(columns::BAR, 6.0));
    ui.painter().rect(whole, 1, t.bg0, Stroke::new(1.0, t.line), StrokeKind::Inside);
    let part = (degrees / 90.0).clamp(0.0, 1.0) as f32;
    let filled = whole.with_max_x(whole.left() + part * whole.width());
    ui.painter().rect_filled(filled, 1, t.other);
}

/// Marks or unmarks the objects `numbers` as favourites.
pub(super) fn favour(numbers: Vec<u32>, is_favourite: bool, commands: &mut Vec<UiCommand>) {
    let command = contract::Command::SetFavourites { numbers, is_favourite };
    commands.push(UiCommand::Station(command));
}

/// Handles the keys of the list while it has the focus.
fn keys(
    ui: &Ui,
    list: &List,
    rows: &[u32],
    model: &Model,
    lock: Option<&'static str>,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    if !list.response.has_focus() {
        return;
    }
    let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    if ui.input(|input| input.events.iter().any(|event| matches!(event, Event::Copy))) {
        let form = if ui.input(|input| input.modifiers.shift) { Form::Omm } else { Form::Tle };
        copy(ui, model, &state.selection.chosen(), form);
    }
    if pressed(Modifiers::COMMAND, Key::A) {
        state.selection.mark_all(rows);
    }
    if let Some(place) = list.step(ui).and_then(|step| state.selection.go(step, rows)) {
        state.scroll.bring_into_view(place);
    }
    if pressed(Modifiers::NONE, Key::U) {
        let takes = |antenna: &AntennaModel| antenna.spec().element_files.is_some();
        if model.antenna().is_some_and(takes) {
            let marked = state.selection.marked();
            let choice = match state.selection.row() {
                Some(number) if marked.is_empty() => UploadChoice::Also(number),
                _ => UploadChoice::These(marked.iter().copied().collect()),
            };
            state.upload(choice);
        }
    }
    if pressed(Modifiers::NONE, Key::Space) {
        state.selection.toggle(rows);
    }
    let chosen = state.selection.chosen();
    if chosen.is_empty() || lock.is_some() {
        return;
    }
    if pressed(Modifiers::NONE, Key::F) {
        let favourites = &model.station.favourites;
        let are_all = chosen.iter().all(|number| favourites.contains(*number));
        favour(chosen.clone(), !are_all, commands);
    }
    let digits = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5];
    for (key, priority) in digits.into_iter().zip(Priority::ALL) {
        if pressed(Modifiers::NONE, key) {
            let command = contract::Command::SetPriority { numbers: chosen.clone(), priority };
            commands.push(UiCommand::Station(command));
        }
    }
}
