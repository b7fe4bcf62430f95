//! Cards of the form, with their fields.

use egui::{
    Align, Color32, Frame, Label, Layout, Margin, Response, RichText, ScrollArea, Sense, Stroke,
    StrokeKind, TextEdit, Ui, vec2,
};

use super::{
    draft::Draft,
    fields::{Field, Standing, TextShape},
};
use crate::{
    device::settings::Kind,
    engine, makes,
    model::{Model, UiCommand},
    ui::{
        text, theme,
        widgets::{
            button::RADIUS,
            card as card_frame,
            input::select_when_tabbed,
            segmented::{self, Segment},
            told,
        },
        words,
    },
};

pub(in crate::ui) const LABEL: f32 = 192.0;
pub(in crate::ui) const ROW: f32 = 24.0;
/// Width of a number with its unit.
const NUMBER: f32 = 112.0;
/// Width of a name or an address.
const WORDS: f32 = 240.0;
/// Width of a choice.
const CHOICE: f32 = 300.0;
/// Height beyond which a long text is scrolled.
const LINES: f32 = 140.0;
/// Gap between the two columns.
const GAP: f32 = 16.0;
/// Maximum width of a column, as its fields need it.
const COLUMN: f32 = 560.0;

/// Shows all fields, in two columns if there is room.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    draft: &mut Draft,
    two_columns: bool,
    commands: &mut Vec<UiCommand>,
) {
    columns(ui, two_columns, draft, site, |ui, draft| antennas(ui, model, draft, commands));
}

/// Shows two parts of a form side by side, or below each other.
pub(super) fn columns<T>(
    ui: &mut Ui,
    two_columns: bool,
    draft: &mut T,
    first: impl FnOnce(&mut Ui, &mut T),
    second: impl FnOnce(&mut Ui, &mut T),
) {
    if !two_columns {
        first(ui, draft);
        second(ui, draft);
        return;
    }
    let width = COLUMN.min((ui.available_width() - GAP) / 2.0);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        column(ui, width, |ui| first(ui, draft));
        column(ui, width, |ui| second(ui, draft));
    });
}

fn column(ui: &mut Ui, width: f32, fill: impl FnOnce(&mut Ui)) {
    ui.allocate_ui_with_layout(vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
        ui.spacing_mut().item_spacing.x = 8.0;
        ui.set_width(width);
        fill(ui);
    });
}

fn site(ui: &mut Ui, draft: &mut Draft) {
    card(ui, "Site and satellites", |ui| {
        let standings = draft.ground_standings();
        fields(ui, "station", &mut draft.ground.fields, &standings);
    });
}

fn antennas(ui: &mut Ui, model: &Model, draft: &mut Draft, commands: &mut Vec<UiCommand>) {
    let (mut toggled, mut duplicated) = (None, None);
    for index in 0..draft.antennas.len() {
        let is_removed = draft.is_removed(index);
        let standings = draft.antenna_standings(index);
        let (as_typed, test) = (draft.antenna(index), draft.test(index, model));
        let Some(antenna) = draft.antennas.get_mut(index) else { continue };
        let make = antenna.before().connection.spec().name;
        let number = index + 1;
        let note = if is_removed { ", removed when saved" } else { "" };
        card(ui, &format!("Antenna {number}: {make}{note}"), |ui| {
            ui.add_enabled_ui(!is_removed, |ui| {
                fields(ui, &format!("antenna {index}"), &mut antenna.fields, &standings);
            });
            let before = antenna.before();
            if let Some(known) = model.antennas.iter().find(|of| of.config == *before) {
                let words = words::stopping_way(known.snapshot.stopping_way);
                measured(ui, "Way after STOP", &words);
            }
            ui.add_space(4.0);
            // The card keeps its height: nothing else moves under the pointer.
            ui.horizontal(|ui| {
                let word = if is_removed { "Undo: keep" } else { "Remove" };
                if ui.button(format!("{word} antenna {number}")).clicked() {
                    toggled = Some(index);
                }
                if is_removed {
                    return;
                }
                if ui.button(format!("Duplicate antenna {number}")).clicked() {
                    duplicated = Some(index);
                }
                let button = egui::Button::new(format!("Test link of antenna {number}"));
                let response = ui.add_enabled(as_typed.is_some(), button);
                if let (true, Some(antenna)) = (response.clicked(), as_typed) {
                    let test = engine::Command::TestLink(Box::new(antenna));
                    commands.push(UiCommand::Station(test));
                }
            });
            let outcome = test.filter(|_| !is_removed);
            let outcome = outcome.map(|test| words::link_test(test, model.demo));
            for (tone, words) in outcome.unwrap_or_default() {
                told::line(ui, tone, &words);
            }
        });
    }
    if let Some(index) = toggled {
        draft.toggle_removed(index);
    }
    if let Some(index) = duplicated {
        draft.duplicate(index, model.now);
    }
    card(ui, "One more antenna", |ui| {
        ui.horizontal_wrapped(|ui| {
            for spec in makes::SPECS {
                if ui.button(format!("Add {}", spec.name)).clicked() {
                    draft.add_antenna(spec, model.now);
                }
            }
        });
    });
}

pub(super) fn card(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    card_frame::show(ui, COLUMN, |ui| {
        ui.label(RichText::new(title).font(text::value()));
        content(ui);
    });
}

/// A measured value, which cannot be typed.
fn measured(ui: &mut Ui, label: &str, words: &str) {
    let t = theme::tokens(ui);
    ui.horizontal_top(|ui| {
        let left = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(LABEL, ROW), left, |ui| {
            ui.set_min_width(LABEL);
            ui.label(RichText::new(label).font(text::body()).color(t.t2));
        });
        let words = RichText::new(words).font(text::small()).color(t.t3);
        ui.vertical(|ui| {
            // Align with the label.
            ui.add_space(4.0);
            ui.add(Label::new(words).wrap());
        });
    });
}

/// Shows the fields that are used; returns what their input fields respond.
pub(in crate::ui) fn fields<T>(
    ui: &mut Ui,
    group: &str,
    fields: &mut [Field<T>],
    standings: &[Standing],
) -> Vec<Response> {
    let t = theme::tokens(ui);
    let (mut section, mut responses) = ("", Vec::new());
    for (field, standing) in fields.iter_mut().zip(standings).filter(|(_, of)| of.is_used) {
        if field.section != section {
            section = field.section;
            ui.add_space(4.0);
            ui.label(RichText::new(section).font(text::small()).color(t.t3));
        }
        let border = match &standing.problem {
            Some(_) => Some(t.bad),
            None => field.is_edited().then_some(t.sat),
        };
        let (label, unit) = (field.description.label.clone(), field.description.unit);
        ui.horizontal_top(|ui| {
            let words = RichText::new(&*label).font(text::body()).color(t.t2);
            let left = Layout::left_to_right(Align::Center);
            let name = ui
                .allocate_ui_with_layout(vec2(LABEL, ROW), left, |ui| {
                    ui.set_min_width(LABEL);
                    ui.label(words).id
                })
                .inner;
            let field = ui.scope(|ui| edit(ui, group, field, border).labelled_by(name));
            responses.push(field.inner);
            let words = RichText::new(unit).font(text::body()).color(t.t3);
            ui.allocate_ui_with_layout(vec2(0.0, ROW), left, |ui| ui.label(words));
        });
        let problem = standing.problem.as_ref().map(|why| (format!("{label} {why}."), t.bad));
        let note = standing.note.clone().map(|words| (words, t.t3));
        if let Some((words, colour)) = problem.or(note) {
            ui.horizontal_top(|ui| {
                ui.add_space(LABEL + 8.0);
                let words = RichText::new(words).font(text::small()).color(colour);
                ui.add(Label::new(words).wrap());
            });
        }
    }
    responses
}

fn edit<T>(ui: &mut Ui, group: &str, field: &mut Field<T>, border: Option<Color32>) -> Response {
    let focused = border.unwrap_or(theme::tokens(ui).sat);
    ui.visuals_mut().selection.stroke = Stroke::new(2.0, focused);
    if let Some(colour) = border {
        let widgets = &mut ui.visuals_mut().widgets;
        for widget in [&mut widgets.inactive, &mut widgets.hovered] {
            widget.bg_stroke = Stroke::new(2.0, colour);
        }
    }
    let label = &*field.description.label;
    let text = &mut field.text;
    if let Some(words) = field.description.kind.choices() {
        return choice(ui, (group, label), text, &words, border);
    }
    let edit = match field.description.kind {
        Kind::Points => {
            return lines(ui, (group, label), text, "counts degrees, one pair a line", border);
        }
        Kind::Integer { .. } | Kind::Decimal { .. } | Kind::Number { .. } | Kind::Place { .. } => {
            TextEdit::singleline(text).desired_width(NUMBER)
        }
        _ => match field.description.shape {
            TextShape::Line => TextEdit::singleline(text).desired_width(WORDS),
            TextShape::Wrapped => TextEdit::multiline(text)
                .return_key(None)
                .desired_rows(1)
                .desired_width(ui.available_width().min(COLUMN - LABEL - 48.0)),
            TextShape::Lines { hint } => return lines(ui, (group, label), text, hint, border),
        },
    };
    let response = ui.add(edit.id_salt((group, label)));
    select_when_tabbed(ui, &response, &field.text);
    response
}

/// A text field of many lines, scrolled within one border.
fn lines(
    ui: &mut Ui,
    salt: (&str, &str),
    text: &mut String,
    hint: &str,
    border: Option<Color32>,
) -> Response {
    let t = theme::tokens(ui);
    let id = ui.make_persistent_id(salt);
    let border = border.or_else(|| ui.memory(|memory| memory.has_focus(id)).then_some(t.sat));
    // A thicker border must not move the fields below.
    let (stroke, outside) =
        border.map_or((Stroke::new(1.0, t.edge), 1), |colour| (Stroke::new(2.0, colour), 0));
    let frame = Frame::new().fill(t.field).stroke(stroke).corner_radius(4).outer_margin(outside);
    let area = ScrollArea::vertical().min_scrolled_height(LINES).max_height(LINES);
    let edit = TextEdit::multiline(text)
        .id(id)
        .frame(Frame::new().inner_margin(Margin::symmetric(10, 4)))
        .hint_text(hint)
        .desired_rows(3)
        .desired_width(WORDS);
    frame.show(ui, |ui| area.id_salt(salt).show(ui, |ui| ui.add(edit)).inner).inner
}

/// A choice of a few words, side by side.
fn choice(
    ui: &mut Ui,
    salt: (&str, &str),
    text: &mut String,
    words: &[&str],
    border: Option<Color32>,
) -> Response {
    let state = |word: &str| if word == text { Segment::Chosen } else { Segment::Free };
    let segments: Vec<(&str, Segment)> = words.iter().map(|word| (*word, state(word))).collect();
    let (rect, response) = ui.allocate_exact_size(vec2(CHOICE, ROW), Sense::hover());
    let (group, label) = salt;
    let clicked = segmented::show(ui, &format!("{group} {label}"), rect, label, &segments);
    if let Some(word) = clicked.and_then(|index| words.get(index)) {
        (*word).clone_into(text);
    }
    if let Some(colour) = border {
        ui.painter().rect_stroke(rect, RADIUS, Stroke::new(2.0, colour), StrokeKind::Outside);
    }
    response
}
