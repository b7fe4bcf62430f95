//! The cards of the form and their fields.

use egui::{
    Align, Color32, Frame, Layout, Margin, Response, RichText, ScrollArea, Stroke, TextEdit, Ui,
    vec2,
};

use super::draft::{Draft, Field, Kind};
use crate::ui::{text, theme, widgets::card as card_frame};

const LABEL: f32 = 192.0;
const ROW: f32 = 24.0;
/// For a number with its unit.
const NUMBER: f32 = 112.0;
/// For a name or an address.
const WORDS: f32 = 240.0;
/// A long horizon mask is scrolled beyond this height.
const MASK: f32 = 140.0;
/// Between the two columns.
const GAP: f32 = 16.0;
/// A column is not wider than its fields need.
const COLUMN: f32 = 560.0;

/// Shows all fields, in two columns where there is room. `before` is the
/// draft as nothing was typed yet.
pub(super) fn show(ui: &mut Ui, draft: &mut Draft, before: &Draft, two_columns: bool) {
    if !two_columns {
        site(ui, draft, before);
        antennas(ui, draft, before);
        return;
    }
    let width = COLUMN.min((ui.available_width() - GAP) / 2.0);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let column = |ui: &mut Ui, fill: &mut dyn FnMut(&mut Ui)| {
            ui.allocate_ui_with_layout(vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
                ui.spacing_mut().item_spacing.x = 8.0;
                ui.set_width(width);
                fill(ui);
            });
        };
        column(ui, &mut |ui| site(ui, draft, before));
        column(ui, &mut |ui| antennas(ui, draft, before));
    });
}

fn site(ui: &mut Ui, draft: &mut Draft, before: &Draft) {
    card(ui, "Site and satellites", |ui| {
        let problems: Vec<Option<String>> = draft.station.iter().map(Field::problem).collect();
        fields(ui, "station", &mut draft.station, &problems, Some(&before.station));
    });
}

fn antennas(ui: &mut Ui, draft: &mut Draft, before: &Draft) {
    let mut removed = None;
    for index in 0..draft.antennas.len() {
        let problems = draft.antenna_problems(index);
        let Some(antenna) = draft.antennas.get_mut(index) else { continue };
        card(ui, &format!("Antenna {}", index + 1), |ui| {
            let before = before.antennas.get(index).map(<[Field; 14]>::as_slice);
            fields(ui, &format!("antenna {index}"), antenna, &problems, before);
            if ui.button(format!("Remove antenna {}", index + 1)).clicked() {
                removed = Some(index);
            }
        });
    }
    if let Some(index) = removed {
        draft.antennas.remove(index);
    }
    if ui.button("Add a Satrak").clicked() {
        draft.add_antenna();
    }
    ui.add_space(8.0);
}

fn card(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    card_frame::show(ui, COLUMN, |ui| {
        ui.label(RichText::new(title).font(text::value()));
        content(ui);
    });
}

fn fields(
    ui: &mut Ui,
    group: &str,
    fields: &mut [Field],
    problems: &[Option<String>],
    before: Option<&[Field]>,
) {
    let t = theme::tokens(ui);
    for (index, (field, problem)) in fields.iter_mut().zip(problems).enumerate() {
        let same = before.and_then(|before| before.get(index)).is_some_and(|old| old == field);
        let border = match (problem, same) {
            (Some(_), _) => Some(t.bad),
            (None, false) => Some(t.sat),
            (None, true) => None,
        };
        let (label, unit) = (field.label, field.kind.unit());
        ui.horizontal_top(|ui| {
            let words = RichText::new(label).font(text::body()).color(t.t2);
            let left = Layout::left_to_right(Align::Center);
            let label = ui
                .allocate_ui_with_layout(vec2(LABEL, ROW), left, |ui| {
                    ui.set_min_width(LABEL);
                    ui.label(words).id
                })
                .inner;
            ui.scope(|ui| edit(ui, group, field, border).labelled_by(label));
            let words = RichText::new(unit).font(text::body()).color(t.t3);
            ui.allocate_ui_with_layout(vec2(0.0, ROW), left, |ui| ui.label(words));
        });
        if let Some(problem) = problem {
            ui.horizontal(|ui| {
                ui.add_space(LABEL + 8.0);
                let words = format!("{label} {problem}.");
                ui.label(RichText::new(words).font(text::small()).color(t.bad));
            });
        }
    }
}

fn edit(ui: &mut Ui, group: &str, field: &mut Field, border: Option<Color32>) -> Response {
    let focused = border.unwrap_or(theme::tokens(ui).sat);
    ui.visuals_mut().selection.stroke = Stroke::new(2.0, focused);
    if let Some(colour) = border {
        let widgets = &mut ui.visuals_mut().widgets;
        for widget in [&mut widgets.inactive, &mut widgets.hovered] {
            widget.bg_stroke = Stroke::new(2.0, colour);
        }
    }
    let id = (group, field.label);
    let edit = match field.kind {
        // Long, and to be seen whole.
        Kind::Numbers => TextEdit::multiline(&mut field.text)
            .return_key(None)
            .desired_rows(1)
            .desired_width(ui.available_width().min(COLUMN - LABEL - 48.0)),
        Kind::Mask => return mask(ui, group, field, border),
        Kind::Range { .. } => TextEdit::singleline(&mut field.text).desired_width(NUMBER),
        _ => TextEdit::singleline(&mut field.text).desired_width(WORDS),
    };
    ui.add(edit.id_salt(id))
}

/// Many lines, scrolled within one border.
fn mask(ui: &mut Ui, group: &str, field: &mut Field, border: Option<Color32>) -> Response {
    let t = theme::tokens(ui);
    let id = ui.make_persistent_id((group, field.label));
    let border = border.or_else(|| ui.memory(|memory| memory.has_focus(id)).then_some(t.sat));
    // A thicker border must not move what lies below.
    let (stroke, outside) =
        border.map_or((Stroke::new(1.0, t.edge), 1), |colour| (Stroke::new(2.0, colour), 0));
    let frame = Frame::new().fill(t.bg0).stroke(stroke).corner_radius(4).outer_margin(outside);
    let area = ScrollArea::vertical().min_scrolled_height(MASK).max_height(MASK);
    let edit = TextEdit::multiline(&mut field.text)
        .id(id)
        .frame(Frame::new().inner_margin(Margin::symmetric(10, 4)))
        .hint_text("azimuth elevation, one point a line")
        .desired_rows(3)
        .desired_width(WORDS);
    frame.show(ui, |ui| area.id_salt(field.label).show(ui, |ui| ui.add(edit)).inner).inner
}
