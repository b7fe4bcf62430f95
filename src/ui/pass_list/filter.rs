//! The filter of the list by name or number.

use egui::{Align2, Rect, RichText, Role, TextEdit, Ui, UiBuilder, WidgetInfo, vec2};

use crate::ui::{
    theme,
    widgets::button::{Button, SMALL_HEIGHT},
};

/// Height of the strip, with its divider.
pub(super) const HEIGHT: f32 = 36.0;

const PADDING: f32 = 16.0;
const GAP: f32 = 8.0;

/// The filter text.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Filter {
    pub(super) is_open: bool,
    typed: String,
    wants_focus: bool,
}

impl Filter {
    /// Opens the filter and gives it the keyboard focus.
    pub fn open(&mut self) {
        (self.is_open, self.wants_focus) = (true, true);
    }

    /// The filter text; empty for all passes.
    pub fn text(&self) -> &str {
        if self.is_open { self.typed.trim() } else { "" }
    }
}

pub(super) fn show(ui: &mut Ui, rect: Rect, filter: &mut Filter) {
    let t = theme::tokens(ui);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let room = rect.shrink2(vec2(PADDING, 0.0));
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
        *filter = Filter::default();
    }
}
