//! Title and count, and the choice of satellites, span and elevation floor.

use egui::{Align2, Color32, Popup, Rect, Role, Stroke, StrokeKind, TextWrapMode, Ui, pos2, vec2};

use super::{FLOORS_DEG, Filter, PassListModel};
use crate::{
    contract,
    contract::passes::{SPANS_H, Scope},
    export::{EventFormat, ListFormat},
    model::{UiCommand, export::Export},
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{Button, RADIUS, SMALL_HEIGHT},
            drop_down::DropDown,
            menu, paint,
            segmented::{self, Segment},
        },
    },
};

/// Height of the head, with its divider, points.
pub(super) const HEIGHT: f32 = 72.0;

const PADDING: f32 = 16.0;
const GAP: f32 = 8.0;
const MIN_GAP: f32 = 2.0;
/// Centres of the two lines from the top, points.
const LINES: [f32; 2] = [20.0, 52.0];
/// Width of the choice of satellites, points.
const SCOPES: f32 = 116.0;
const FLOOR: &str = "Elevation floor: passes with a lower maximum elevation are not listed. It \
                     applies to the whole station.";
const SPAN: &str = "How far ahead passes are listed";
/// Max difference of two floors that count as equal, degrees.
const SAME_DEG: f64 = 0.05;
/// Width below which a list has a short title, points.
const NARROW: f32 = 250.0;

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    filter: &mut Filter,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let room = rect.shrink2(vec2(PADDING, 0.0));
    let [first, second] = LINES.map(|down| {
        let position = room.top() + down - SMALL_HEIGHT / 2.0;
        Rect::from_min_size(pos2(room.left(), position), vec2(room.width(), SMALL_HEIGHT))
    });
    let position = first.left_center();
    let title = if room.width() < NARROW { "Passes" } else { "Next passes" };
    let title = paint::text(ui, position, Align2::LEFT_CENTER, title, text::small_strong(), t.t1);
    let floor = floors(ui, first, model, commands);
    let mut count = format::number(model.rows as f64, 0);
    if model.rows < model.total {
        count = format!("{count} of {}", format::number(model.total as f64, 0));
    }
    let decimals = usize::from(model.aos_elevation_deg.fract() != 0.0);
    let aos = format::degrees(model.aos_elevation_deg, decimals);
    let (aos, count) = (format!("AOS at {aos}"), format!("{count} · AOS at {aos}"));
    let left = first.with_min_x(title.right() + GAP).with_max_x(floor.left() - GAP / 2.0);
    let fits = paint::text_width(ui, &count, text::small()) <= left.width();
    let words = if fits { &count } else { &aos };
    let count_place = paint::text_in(ui, left, Align2::LEFT_CENTER, words, text::small(), t.t3);
    paint::name_text(ui, "title", title | count_place, &format!("Next passes, {count}"));

    let segment = |scope| match model.lock {
        _ if scope == model.scope => Segment::Chosen,
        Some(_) => Segment::Locked(model.lock),
        None => Segment::Free,
    };
    let scopes = [(Scope::Favourites, "Favourites"), (Scope::All, "All")];
    let place = second.with_max_x(second.left() + SCOPES);
    let words = scopes.map(|(scope, word)| (word, segment(scope)));
    let chosen = segmented::show(ui, "scope", place, "Satellites of the list", &words);
    if let Some((scope, _)) = chosen.and_then(|index| scopes.get(index))
        && *scope != model.scope
    {
        commands.push(UiCommand::SetScope(*scope));
    }
    let span = second.with_min_x(second.right() - span_menu(model).width(ui));
    // In the narrowest list the buttons are narrower and closer together.
    let free = span.left() - second.left() - SCOPES;
    let side = vec2((free / 2.0 - 1.5 * MIN_GAP).min(SMALL_HEIGHT), SMALL_HEIGHT);
    let gap = ((free - 2.0 * side.x) / 3.0).clamp(MIN_GAP, GAP);
    let place = Rect::from_min_size(pos2(span.left() - gap - side.x, span.top()), side);
    save(ui, place.translate(vec2(-gap - side.x, 0.0)), model, commands);
    search(ui, place, filter);
    spans(ui, span, model, commands);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
}

fn floors(ui: &Ui, line: Rect, model: &PassListModel<'_>, commands: &mut Vec<UiCommand>) -> Rect {
    let same = |floor_deg: &f64| (floor_deg - model.floor_deg).abs() < SAME_DEG;
    let angle = |floor_deg: f64| format::degrees(floor_deg, 0);
    let words = |floor_deg: f64| format!("Floor {}", angle(floor_deg));
    let name = format!("Elevation floor: {}", angle(model.floor_deg));
    let (chosen, lock) = (words(model.floor_deg), model.lock);
    let menu = Menu { salt: "floor", name, chosen, description: FLOOR, lock };
    let place = line.with_min_x(line.right() - menu.width(ui));
    menu.show(ui, place, |ui| {
        for floor_deg in FLOORS_DEG {
            let choice = egui::Button::selectable(same(&floor_deg), words(floor_deg));
            if ui.add(choice).clicked() && !same(&floor_deg) {
                commands.push(UiCommand::Station(contract::Command::SetElevationFloor(floor_deg)));
            }
        }
    });
    place
}

fn hours(span_h: u32) -> String {
    format!("{span_h} h")
}

fn span_menu(model: &PassListModel<'_>) -> Menu {
    let chosen = hours(model.span_h);
    let name = format!("How far ahead: {chosen}");
    Menu { salt: "span", name, chosen, description: SPAN, lock: None }
}

fn spans(ui: &Ui, place: Rect, model: &PassListModel<'_>, commands: &mut Vec<UiCommand>) {
    span_menu(model).show(ui, place, |ui| {
        for span_h in SPANS_H {
            let choice = egui::Button::selectable(span_h == model.span_h, hours(span_h));
            if ui.add(choice).clicked() && span_h != model.span_h {
                commands.push(UiCommand::SetSpan(span_h));
            }
        }
    });
}

/// Shows the button that opens the filter.
fn search(ui: &Ui, place: Rect, filter: &mut Filter) {
    let t = theme::tokens(ui);
    let response = paint::control(ui, "open filter", place, Role::Button, true, "Filter the list");
    let border = if response.hovered() { t.t2 } else { t.line };
    let fill = if filter.is_open { t.bgsel } else { Color32::TRANSPARENT };
    let stroke = Stroke::new(1.0, border);
    ui.painter().rect(place, RADIUS, fill, stroke, StrokeKind::Inside);
    icons::paint(ui.painter(), paint::square(place.center(), 14.0), Icon::Search, t.t1);
    paint::focus_ring(ui, &response, RADIUS);
    if response.on_hover_text("Filter and sort (Ctrl F)").clicked() {
        filter.open();
    }
}

/// Shows the button that saves the listed passes, or the look angles of the selected pass.
fn save(ui: &Ui, place: Rect, model: &PassListModel<'_>, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let (name, is_free) = ("Save passes to a file", model.lock.is_none());
    let response = paint::control(ui, "save", place, Role::Button, is_free, name);
    let colour = if is_free {
        let border = if response.hovered() { t.t2 } else { t.line };
        let stroke = Stroke::new(1.0, border);
        ui.painter().rect(place, RADIUS, Color32::TRANSPARENT, stroke, StrokeKind::Inside);
        t.t1
    } else {
        paint::dashed_border(ui, place, f32::from(RADIUS), (1.0, t.edge));
        t.t3
    };
    icons::paint(ui.painter(), paint::square(place.center(), 14.0), Icon::Download, colour);
    paint::focus_ring(ui, &response, RADIUS);
    let response = response.on_hover_text(model.lock.unwrap_or(name));
    menu::show(&response, Popup::menu(&response).accessible_name(name), |ui| {
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        let forms = [
            ("Listed passes as CSV…", EventFormat::Csv),
            ("Listed passes as JSON…", EventFormat::Json),
            ("Listed passes as iCalendar…", EventFormat::Ics),
        ];
        for (word, format) in forms {
            if ui.add_enabled(model.rows > 0, egui::Button::new(word)).clicked() {
                commands.push(UiCommand::Save(Export::Passes { keys: (model.keys)(), format }));
            }
        }
        ui.separator();
        let forms = [
            ("Az/el of the selected pass as CSV…", ListFormat::Csv),
            ("Az/el of the selected pass as JSON…", ListFormat::Json),
        ];
        for (word, format) in forms {
            let choice = ui.add_enabled(model.selected.is_some(), egui::Button::new(word));
            if let (true, Some(pass)) = (choice.clicked(), model.selected) {
                commands.push(UiCommand::Save(Export::Looks { pass, format }));
            }
        }
    });
}

/// A drop-down button.
struct Menu {
    salt: &'static str,
    /// Subject and current choice, for screen readers.
    name: String,
    chosen: String,
    description: &'static str,
    /// Reason for a locked menu, which replaces the hover text.
    lock: Option<&'static str>,
}

impl Menu {
    fn list(&self) -> DropDown<'_> {
        let button = Button::quiet(&self.chosen).locked_by(self.lock);
        DropDown { button, salt: self.salt, name: &self.name }
    }

    fn width(&self, ui: &Ui) -> f32 {
        self.list().width(ui)
    }

    fn show(&self, ui: &Ui, place: Rect, choices: impl FnOnce(&mut Ui)) {
        let shown = self.list().show(ui, place, choices);
        if self.lock.is_none() {
            shown.on_hover_text(self.description);
        }
    }
}
