//! Lines of a card, in fixed columns: no text pushes its neighbours.

use egui::{Align2, Color32, FontId, Rect, Sense, Ui, pos2, vec2};

use crate::ui::{
    icons::{self, Icon},
    text, theme,
    widgets::paint,
};

pub(super) const HEIGHT: f32 = 28.0;
/// Height of a field in a line, points.
const FIELD: f32 = 24.0;
/// Gap between two columns, points.
const GAP: f32 = 6.0;
/// Min width of the columns together, points.
pub(super) const MIN_WIDTH: f32 = 530.0;

/// Columns of a line: setting, value on the unit, new value, unit of measure, state.
pub(super) struct Columns {
    pub(super) label: Rect,
    pub(super) on_unit: Rect,
    pub(super) new: Rect,
    pub(super) unit: Rect,
    pub(super) state: Rect,
}

impl Columns {
    /// Divides `rect` into the columns; the values share the width beyond the min.
    pub(super) fn new(rect: Rect) -> Self {
        let spare = (rect.width() - MIN_WIDTH).max(0.0);
        let widths = [127.0, 108.0 + spare * 0.5, 112.0 + spare * 0.3, 34.0, 125.0 + spare * 0.2];
        let mut left = rect.left();
        let [label, on_unit, new, unit, state] = widths.map(|width| {
            let column =
                Rect::from_min_max(pos2(left, rect.top()), pos2(left + width, rect.bottom()));
            left += width + GAP;
            column
        });
        let inset = (rect.height() - FIELD) / 2.0;
        Self { label, on_unit, new: new.shrink2(vec2(0.0, inset)), unit, state }
    }

    /// Joins the columns of the new value and its unit, for a long value without a unit of measure.
    pub(super) fn wide(&self) -> Rect {
        self.new.with_max_x(self.unit.right() - 2.0)
    }
}

/// Allocates the space of the next line of the card.
pub(super) fn take(ui: &mut Ui) -> Rect {
    ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover()).0
}

/// Draws the column headings.
pub(super) fn head(ui: &mut Ui) {
    let t = theme::tokens(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 20.0), Sense::hover());
    let columns = Columns::new(rect);
    for (column, word) in [
        (columns.label, "Setting"),
        (columns.on_unit, "On the unit"),
        (columns.new, "New value"),
        (columns.state, "State"),
    ] {
        paint::text_in(ui, column, Align2::LEFT_CENTER, word, text::caption(), t.t3);
    }
}

/// Draws a text in a column with the accessible name `name`. If the text is cut or abbreviated,
/// `name` is also the tooltip.
pub(super) fn status_text(
    ui: &Ui,
    rect: Rect,
    words: &str,
    font: FontId,
    colour: Color32,
    name: &str,
) {
    paint::text_in(ui, rect, Align2::LEFT_CENTER, words, font.clone(), colour);
    let named = paint::name_text(ui, ("said", name), rect, name);
    if !name.contains(words) || !paint::fits(ui, words, font, rect) {
        named.on_hover_text(name);
    }
}

/// Draws a state with its mark.
pub(super) fn state(
    ui: &Ui,
    rect: Rect,
    icon: Option<Icon>,
    words: &str,
    colour: Color32,
    name: &str,
) {
    let mut room = rect;
    if let Some(icon) = icon {
        let area = paint::square(pos2(rect.left() + 6.0, rect.center().y), 12.0);
        icons::paint(ui.painter(), area, icon, colour);
        room = rect.with_min_x(rect.left() + 17.0);
    }
    status_text(ui, room, words, text::small(), colour, name);
}

/// Draws a line without a field: subject, fact and conclusion.
pub(super) fn plain(
    ui: &mut Ui,
    label: &str,
    value: &str,
    verdict: Option<(Option<Icon>, &str, Color32)>,
) {
    let t = theme::tokens(ui);
    let rect = take(ui);
    let columns = Columns::new(rect);
    status_text(ui, columns.label, label, text::small(), t.t1, label);
    let room = columns.on_unit.with_max_x(columns.unit.right());
    let room = if verdict.is_none() { room.with_max_x(rect.right()) } else { room };
    status_text(ui, room, value, text::small(), t.t2, &format!("{label}: {value}"));
    if let Some((icon, words, colour)) = verdict {
        state(ui, columns.state, icon, words, colour, &format!("{label}: {words}"));
    }
}

/// Draws a sentence over the whole width, wrapped.
pub(super) fn note(ui: &mut Ui, icon: Option<Icon>, words: &str, colour: Color32) {
    let indent = if icon.is_some() { 20.0 } else { 0.0 };
    let width = ui.available_width() - indent;
    let galley = ui.painter().layout(words.to_owned(), text::small(), colour, width);
    let size = vec2(ui.available_width(), galley.size().y + 6.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    if let Some(icon) = icon {
        let area = paint::square(pos2(rect.left() + 7.0, rect.top() + 10.0), 14.0);
        icons::paint(ui.painter(), area, icon, colour);
    }
    ui.painter().galley(rect.min + vec2(indent, 2.0), galley, colour);
    paint::name_text(ui, ("note", words), rect, words);
}
