//! The filter of the list: a text, and chips below the text.

use egui::{Align2, Rect, RichText, Role, TextEdit, Ui, UiBuilder, WidgetInfo, vec2};

use super::{
    PassListModel,
    arrangement::{self, Arrangement},
};
use crate::ui::{
    text, theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        paint,
    },
};

/// Height of the line with the filter text or the summary, points.
const LINE: f32 = 36.0;
/// Gap between the chips and the divider, points.
const BELOW: f32 = 8.0;

const PADDING: f32 = 16.0;
const GAP: f32 = 8.0;

/// Filter and order of the list, kept from frame to frame.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Filter {
    pub(super) is_open: bool,
    typed: String,
    wants_focus: bool,
    /// Order and further filters. They stay active while the filter is closed.
    pub arrangement: Arrangement,
}

impl Filter {
    /// Opens the filter and gives it the keyboard focus.
    pub fn open(&mut self) {
        (self.is_open, self.wants_focus) = (true, true);
    }

    /// Returns the filter text; empty for all passes.
    pub fn text(&self) -> &str {
        if self.is_open { self.typed.trim() } else { "" }
    }
}

/// Returns the height of the strip at the top of `rect` with its divider, points.
pub(super) fn height(ui: &Ui, rect: Rect, filter: &Filter) -> f32 {
    if filter.is_open {
        let room = rect.shrink2(vec2(PADDING, 0.0));
        LINE + arrangement::height(ui, room, &filter.arrangement) + BELOW
    } else if filter.arrangement == Arrangement::default() {
        0.0
    } else {
        LINE
    }
}

/// Shows the strip in `rect`: the open filter, or a summary of the active filters.
pub(super) fn show(ui: &mut Ui, rect: Rect, model: &PassListModel<'_>, filter: &mut Filter) {
    let t = theme::tokens(ui);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let room = rect.shrink2(vec2(PADDING, 0.0));
    let line = room.with_max_y(room.top() + LINE);
    if filter.is_open {
        typed(ui, line, filter);
        arrangement::show(ui, room.with_min_y(line.bottom()), model, &mut filter.arrangement);
        return;
    }
    let clear = Button::quiet("Clear");
    let size = vec2(clear.width(ui), SMALL_HEIGHT);
    let place = Align2::RIGHT_CENTER.align_size_within_rect(size, line);
    let words = filter.arrangement.words();
    let left = line.with_max_x(place.left() - GAP);
    paint::text_in(ui, left, Align2::LEFT_CENTER, &words, text::small(), t.t1);
    paint::name_text(ui, "filtered", left, &format!("Filtered: {words}")).on_hover_text(words);
    if clear.show(ui, "clear filters", place).clicked() {
        filter.arrangement = Arrangement::default();
    }
}

fn typed(ui: &mut Ui, room: Rect, filter: &mut Filter) {
    let t = theme::tokens(ui);
    let close = Button::quiet("Close");
    let size = vec2(close.width(ui), SMALL_HEIGHT);
    let place = Align2::RIGHT_CENTER.align_size_within_rect(size, room);
    let size = vec2(place.left() - GAP - room.left(), SMALL_HEIGHT);
    let field = Align2::LEFT_CENTER.align_size_within_rect(size, room);
    ui.scope_builder(UiBuilder::new().id_salt("filter").max_rect(field), |ui| {
        let hint = RichText::new("Name or number").color(t.t3);
        let edit = TextEdit::singleline(&mut filter.typed).hint_text(hint).id_salt("text");
        let response = ui.add_sized(field.size(), edit);
        response.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Filter of the list"));
        if std::mem::take(&mut filter.wants_focus) {
            response.request_focus();
        }
    });
    if close.show(ui, "close filter", place).clicked() {
        *filter =
            Filter { arrangement: std::mem::take(&mut filter.arrangement), ..Filter::default() };
    }
}
