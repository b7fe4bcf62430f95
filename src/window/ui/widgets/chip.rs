//! A filter that is on or off.

use egui::{Align2, Color32, Rect, Role, Stroke, StrokeKind, Ui, WidgetInfo, vec2};

use super::paint;
use crate::ui::{text, theme};

const PADDING: f32 = 11.0;
const RADIUS: u8 = 12;

/// Returns the width of a chip with this word, points.
pub fn width(ui: &Ui, word: &str) -> f32 {
    (paint::text_width(ui, word, text::small_strong()) + 2.0 * PADDING).ceil()
}

/// Shows a chip in `rect`; a click switches it.
pub fn show(ui: &Ui, salt: &str, rect: Rect, word: &str, is_on: &mut bool) {
    let t = theme::tokens(ui);
    let response = paint::control(ui, ("chip", salt), rect, Role::CheckBox, true, word);
    if response.clicked() {
        *is_on = !*is_on;
    }
    let on = *is_on;
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, on, word));
    let fill = match (on, response.hovered()) {
        (true, _) => t.bgsel,
        (false, true) => t.bg3,
        (false, false) => Color32::TRANSPARENT,
    };
    let stroke = Stroke::new(1.0, if on { t.sat } else { t.line });
    ui.painter().rect(rect, RADIUS, fill, stroke, StrokeKind::Inside);
    let (font, colour) = if on { (text::small_strong(), t.t1) } else { (text::small(), t.t2) };
    let room = rect.shrink2(vec2(2.0, 0.0));
    paint::text_in(ui, room, Align2::CENTER_CENTER, word, font, colour);
    paint::focus_ring(ui, &response, RADIUS);
}
