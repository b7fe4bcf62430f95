//! A text field for an angle.

use egui::{Align2, Frame, Id, Margin, Rect, Response, RichText, Stroke, TextEdit, Ui};

use super::input::select_when_tabbed;
use crate::ui::{text, theme};

/// Corner radius of a field, points.
pub const RADIUS: f32 = 4.0;

#[derive(Debug, Clone, Copy)]
pub struct AngleField<'a> {
    /// `true` if Azel refused the entered angle; the caller shows the reason below.
    pub refused: bool,
    /// Hint for an empty field.
    pub hint: &'a str,
    /// Name of the field, with its unit.
    pub name: &'a str,
}

impl AngleField<'_> {
    /// Shows the field in `rect` and edits `typed`.
    pub fn show(self, ui: &mut Ui, id: Id, rect: Rect, typed: &mut String) -> Response {
        let t = theme::tokens(ui);
        let stroke = if self.refused {
            Stroke::new(2.0, t.bad)
        } else if ui.memory(|memory| memory.has_focus(id)) {
            Stroke::new(2.0, t.sat)
        } else {
            Stroke::new(1.0, t.edge)
        };
        let frame = Frame::new()
            .fill(t.field)
            .stroke(stroke)
            .corner_radius(RADIUS)
            .inner_margin(Margin::symmetric(8, 0));
        let edit = TextEdit::singleline(typed)
            .id(id)
            .frame(frame)
            .font(text::body())
            .text_color(t.t1)
            .hint_text(RichText::new(self.hint).color(t.t3))
            .align(Align2::LEFT_CENTER)
            .char_limit(16)
            .min_size(rect.size())
            .desired_width(rect.width());
        let response = ui.place(rect, edit).accessible_name(self.name);
        select_when_tabbed(ui, &response, typed);
        response
    }
}
