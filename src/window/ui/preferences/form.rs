//! Cards and rows of the forms.

use std::borrow::Cow;

use egui::{
    Align, Color32, Frame, Label, Layout, Margin, Rect, Response, RichText, Role, ScrollArea,
    Sense, Stroke, StrokeKind, TextEdit, Tooltip, Ui, UiBuilder, accesskit::Action, pos2, vec2,
};

use super::fields::{Field, Standing, TextShape, Typed};
use crate::{
    device::settings::Kind,
    ui::{
        text::{self, Weight},
        theme,
        widgets::{
            button::RADIUS,
            card as card_frame,
            form::{self as parts, GAP, LABEL, Mark, ROW, labelled},
            input::{focus_to_replace, select_when_tabbed},
            paint, segmented,
        },
    },
};

/// Width of a number field with its unit, points.
const NUMBER: f32 = 108.0;
/// Width of a name or address field: next to its state, and in the set-up, points.
const WORDS: [f32; 2] = [160.0, 240.0];
/// Distance from the left end of the label to the left end of the state, points.
const STATE: f32 = 360.0;
/// Width of a segment in addition to its word, points.
const SEGMENT: f32 = 20.0;
/// Height above which a long text scrolls, points.
const LINES: f32 = 140.0;

/// Content next to a field. Rows keep their place when it appears or disappears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RowAnnotation {
    /// State of the field: unchanged, edited, or invalid with the reason.
    State,
    /// Reason why the field is invalid; nothing for a valid field.
    Reason,
}

/// Label of the field that a search result leads to, until the field has the focus.
#[derive(Default)]
pub(super) struct FocusTarget(Option<Cow<'static, str>>);

impl FocusTarget {
    pub(super) fn new(label: Cow<'static, str>) -> Self {
        Self(Some(label))
    }

    /// Returns `true` once for the field with this label.
    pub(super) fn takes(&mut self, label: &str) -> bool {
        self.0.take_if(|target| target == label).is_some()
    }
}

pub(super) fn card(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    card_frame::show(ui, f32::INFINITY, |ui| {
        ui.spacing_mut().item_spacing = vec2(GAP, 4.0);
        ui.label(RichText::new(title).font(text::value()));
        ui.add_space(2.0);
        let group = UiBuilder::new().accessibility_role(Role::Group).accessibility_label(title);
        ui.scope_builder(group, content);
    });
}

/// Shows a card titled `section` with the fields of the section; `more` draws the content below
/// them.
pub(super) fn section<T: Clone>(
    ui: &mut Ui,
    group: &str,
    (typed, standings): (&mut Typed<T>, &[Standing]),
    section: &str,
    focus_target: &mut FocusTarget,
    more: impl FnOnce(&mut Ui),
) {
    card(ui, section, |ui| {
        rows(ui, group, (typed, standings), section, focus_target);
        more(ui);
    });
}

/// Shows the used fields of `section`, with their states next to them.
pub(super) fn rows<T: Clone>(
    ui: &mut Ui,
    group: &str,
    (typed, standings): (&mut Typed<T>, &[Standing]),
    section: &str,
    focus_target: &mut FocusTarget,
) {
    for (field, standing) in typed.fields.iter_mut().zip(standings) {
        if standing.is_used && field.section == section {
            let response = row(ui, group, field, standing, RowAnnotation::State);
            if focus_target.takes(&field.description.label) {
                focus_to_replace(ui, &response, &field.entry.text);
                response.scroll_to_me(Some(Align::Center));
            }
        }
    }
}

/// Shows the used fields, with the reason next to each invalid field. Returns the responses of the
/// input fields.
pub(in crate::ui) fn fields<T>(
    ui: &mut Ui,
    group: &str,
    fields: &mut [Field<T>],
    standings: &[Standing],
) -> Vec<Response> {
    let used = fields.iter_mut().zip(standings).filter(|(_, standing)| standing.is_used);
    used.map(|(field, standing)| row(ui, group, field, standing, RowAnnotation::Reason)).collect()
}

/// Shows a note in the column of the fields.
pub(super) fn note(ui: &mut Ui, words: &str) {
    let colour = theme::tokens(ui).t3;
    parts::note(ui, words, colour);
}

/// Shows a sentence over the whole width of a card.
pub(super) fn remark(ui: &mut Ui, words: &str) {
    let colour = theme::tokens(ui).t3;
    ui.add(Label::new(RichText::new(words).font(text::small()).color(colour)).wrap());
}

/// Shows a read-only value.
pub(super) fn read_only_row(ui: &mut Ui, label: &str, words: &str) {
    let t = theme::tokens(ui);
    labelled(ui, label, LABEL, |ui, _| {
        let words = RichText::new(words).font(text::small()).color(t.t3);
        ui.vertical(|ui| {
            // The space aligns the value with the label.
            ui.add_space(4.0);
            ui.add(Label::new(words).wrap());
        });
    });
}

/// Shows a choice that takes effect immediately.
pub(super) fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    choices: &[(&str, T)],
    value: &mut T,
) {
    labelled(ui, label, LABEL, |ui, _| segments(ui, (label, label), choices, value));
}

fn row<T>(
    ui: &mut Ui,
    group: &str,
    field: &mut Field<T>,
    standing: &Standing,
    annotation: RowAnnotation,
) -> Response {
    let t = theme::tokens(ui);
    let border = state(field, standing).0.border(t);
    let (label, unit) = (field.description.label.clone(), field.description.unit);
    let ((response, end), place) = labelled(ui, &label, LABEL, |ui, name| {
        let response =
            ui.scope(|ui| edit(ui, group, field, border, annotation).labelled_by(name)).inner;
        let end = response.rect.right();
        if unit.is_empty() {
            return (response, end);
        }
        let words = RichText::new(unit).font(text::body()).color(t.t3);
        let left = Layout::left_to_right(Align::Center);
        let unit = ui.allocate_ui_with_layout(vec2(0.0, ROW), left, |ui| ui.label(words));
        (response, unit.response.rect.right())
    });
    if annotation == RowAnnotation::State || standing.problem.is_some() {
        let (mark, words) = match state(field, standing) {
            (Mark::Plain | Mark::Edited, _) if standing.is_new => (Mark::Plain, "New".to_owned()),
            state => state,
        };
        let name = match &standing.problem {
            Some(problem) => format!("{label} {}.", problem.reason),
            None => words.clone(),
        };
        parts::state(ui, (group, &*label), state_room(ui, place, end), mark, [&words, &name]);
    }
    if let Some(problem) = standing.problem.as_ref().filter(|_| response.has_focus()) {
        // The suggested text may be the previous value, which a new station does not have.
        let cure = problem.would_do.as_ref().filter(|_| annotation == RowAnnotation::State);
        why_below(&response, &label, &problem.reason, cure);
    }
    if let Some(words) = &standing.note {
        note(ui, words);
    }
    response
}

/// Returns the state of a field, and its text next to the field.
fn state<T>(field: &Field<T>, standing: &Standing) -> (Mark, String) {
    match (&standing.problem, &standing.proved) {
        (None, Some(proved)) => (Mark::Good, proved.clone()),
        (problem, _) => {
            let problem = problem.as_ref().map(|problem| problem.short.clone());
            parts::standing(problem, field.entry.was())
        }
    }
}

/// Shows below a focused field why it is invalid. The text floats above the rows, so that no row
/// moves.
fn why_below(response: &Response, label: &str, reason: &str, cure: Option<&String>) {
    let cure = cure.map(|text| format!(" Use {text}."));
    let words = format!("{label} {reason}.{}", cure.unwrap_or_default());
    let (ctx, layer) = (response.ctx.clone(), response.layer_id);
    let below = Tooltip::always_open(ctx, layer, response.id.with("why"), response.rect);
    below.show(|ui| {
        let colour = theme::tokens(ui).bad;
        ui.label(RichText::new(words).font(text::small()).color(colour));
    });
}

/// Returns the room for the state in the row at `place`, whose field ends at `end`.
fn state_room(ui: &Ui, place: Rect, end: f32) -> Rect {
    let right = ui.max_rect().right();
    let left = (place.left() + STATE).max(end + GAP).min(right - 14.0);
    Rect::from_min_max(pos2(left, place.top()), pos2(right, place.top() + ROW))
}

/// Shows a row whose field `content` draws. The state next to it is "edited" or the reason why the
/// field is invalid.
pub(super) fn custom_row<R>(
    ui: &mut Ui,
    (group, label): (&str, &str),
    wrong: Option<&str>,
    is_edited: bool,
    content: impl FnOnce(&mut Ui) -> R,
) -> R {
    let (result, place) = labelled(ui, label, LABEL, |ui, _| content(ui));
    let room = state_room(ui, place, place.right());
    let (mark, words) = match wrong {
        Some(reason) => (Mark::Invalid, reason),
        None if is_edited => (Mark::Edited, "Edited"),
        None => return result,
    };
    parts::state(ui, (group, label), room, mark, [words, &format!("{label}: {words}")]);
    result
}

fn edit<T>(
    ui: &mut Ui,
    group: &str,
    field: &mut Field<T>,
    border: Option<Color32>,
    annotation: RowAnnotation,
) -> Response {
    let t = theme::tokens(ui);
    let (stroke, margin) = border
        .map_or((Stroke::new(1.0, t.edge), (11, 3)), |colour| (Stroke::new(2.0, colour), (10, 2)));
    // The focus ring surrounds this border.
    let frame = Frame::new()
        .fill(t.field)
        .stroke(stroke)
        .corner_radius(4)
        .inner_margin(Margin::symmetric(margin.0, margin.1));
    let is_edited = field.entry.is_edited();
    let [narrow, wide] = WORDS;
    let width = if annotation == RowAnnotation::State { narrow } else { wide };
    let label = &*field.description.label;
    let text = &mut field.entry.text;
    if let Some(words) = field.description.kind.choices() {
        return words_choice(ui, (group, label), text, &words, border);
    }
    let edit = match field.description.kind {
        Kind::Points => {
            return lines(ui, (group, label), text, "counts degrees, one pair a line", border);
        }
        Kind::Integer { .. } | Kind::Decimal { .. } | Kind::Number { .. } | Kind::Place { .. } => {
            TextEdit::singleline(text).desired_width(NUMBER)
        }
        _ => match field.description.shape {
            TextShape::Line => TextEdit::singleline(text).desired_width(width),
            TextShape::Wrapped => TextEdit::multiline(text)
                .return_key(None)
                .desired_rows(1)
                .desired_width(ui.available_width() - 2.0 * ROW),
            TextShape::Lines { hint } => return lines(ui, (group, label), text, hint, border),
        },
    };
    let weight = if is_edited { Weight::SemiBold } else { Weight::Regular };
    let edit = edit.frame(frame).font(text::sized(13.0, weight));
    let response = ui.add(edit.id_salt((group, label)));
    paint::focus_ring(ui, &response, 4);
    select_when_tabbed(ui, &response, &field.entry.text);
    response
}

/// Shows a multi-line text field that scrolls within one border.
fn lines(
    ui: &mut Ui,
    salt: (&str, &str),
    text: &mut String,
    hint: &str,
    border: Option<Color32>,
) -> Response {
    let t = theme::tokens(ui);
    let id = ui.make_persistent_id(salt);
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
        .desired_width(WORDS[1]);
    // The scroll area scrolls only the text of the field, so the page has to scroll separately.
    let is_asked_for =
        ui.input(|input| input.has_accesskit_action_request(id, Action::ScrollIntoView));
    let shown = frame.show(ui, |ui| area.id_salt(salt).show(ui, |ui| ui.add(edit)).inner);
    let is_by_key = shown.inner.gained_focus() && !ui.input(|input| input.pointer.any_down());
    if is_asked_for || is_by_key {
        shown.response.scroll_to_me(None);
    }
    if shown.inner.has_focus() {
        paint::ring_around(ui, shown.response.rect, 4);
    }
    shown.inner
}

/// Shows a choice of a few words, side by side.
fn words_choice(
    ui: &mut Ui,
    salt: (&str, &str),
    text: &mut String,
    words: &[&str],
    border: Option<Color32>,
) -> Response {
    let choices: Vec<(&str, &str)> = words.iter().map(|word| (*word, *word)).collect();
    let before = text.clone();
    let mut chosen = before.as_str();
    let response = segments(ui, salt, &choices, &mut chosen);
    chosen.clone_into(text);
    if let Some(colour) = border {
        let stroke = Stroke::new(2.0, colour);
        ui.painter().rect_stroke(response.rect, RADIUS, stroke, StrokeKind::Outside);
    }
    response
}

/// Shows segments as wide as their words need.
fn segments<T: Copy + PartialEq>(
    ui: &mut Ui,
    (group, label): (&str, &str),
    choices: &[(&str, T)],
    value: &mut T,
) -> Response {
    let width = |word: &str| paint::text_width(ui, word, text::body_medium()) + SEGMENT;
    let width: f32 = choices.iter().map(|(word, _)| width(word)).sum();
    let size = vec2(width.max(WORDS[0]).min(ui.available_width() - ROW), ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    segmented::choose(ui, &format!("{group} {label}"), rect, label, choices, value);
    response
}
