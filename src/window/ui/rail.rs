//! The rail at the left edge of the window: the views and the list of keys.

use egui::{Align2, Rect, Response, Role, Sense, Ui, UiBuilder, WidgetInfo, pos2, vec2};

use super::{
    icons::{self, Icon},
    text, theme,
    widgets::paint,
};

/// Width of the rail with icons and words, points.
pub const WIDTH: f32 = 72.0;
/// Width of the rail with only icons, points.
pub const SMALL_WIDTH: f32 = 48.0;
/// Window width below which the rail has only icons, points.
pub const SMALL_BELOW: f32 = 1200.0;

/// Padding above the first entry and below the last, points.
const EDGE: f32 = 8.0;
/// Gap between two entries, points.
const GAP: f32 = 4.0;

#[derive(Debug, Clone, Copy)]
pub struct RailEntry<'a> {
    pub icon: Icon,
    pub word: &'a str,
    /// `true` if this view is open.
    pub active: bool,
    /// Number of edits in the view that are not applied.
    pub edits: usize,
}

/// Returns the width of the rail for a window of this width, points.
pub fn width(window_width: f32) -> f32 {
    if window_width < SMALL_BELOW { SMALL_WIDTH } else { WIDTH }
}

/// Shows the entries in `rect`. Returns the index of a clicked entry.
pub fn show(ui: &mut Ui, rect: Rect, entries: &[RailEntry<'_>]) -> Option<usize> {
    let builder = UiBuilder::new().id_salt("rail").max_rect(rect);
    ui.scope_builder(builder, |ui| fill(ui, rect, entries)).inner
}

fn fill(ui: &Ui, rect: Rect, entries: &[RailEntry<'_>]) -> Option<usize> {
    let t = theme::tokens(ui);
    ui.painter().vline(rect.right() - 0.5, rect.y_range(), (1.0, t.line));
    let mut clicked = None;
    for (index, entry) in entries.iter().enumerate() {
        let top = rect.top() + EDGE + index as f32 * (cell_height(rect) + GAP);
        if cell(ui, rect, top, entry, Role::Tab).clicked() {
            clicked = Some(index);
        }
    }
    clicked
}

/// Clicks on the entries at the foot of the rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FootClicks {
    pub view: bool,
    /// `true` if the operator clicked the list of keys.
    pub keys: bool,
}

/// Shows a view entry at the foot of the rail in `rect`, with the button for the list of keys below
/// it.
pub fn show_foot(ui: &mut Ui, rect: Rect, view: &RailEntry<'_>) -> FootClicks {
    let keys = RailEntry { icon: Icon::Question, word: "Keys", active: false, edits: 0 };
    let keys_top = rect.bottom() - EDGE - cell_height(rect);
    let view_top = keys_top - GAP - cell_height(rect);
    let builder = UiBuilder::new().id_salt("rail foot").max_rect(rect);
    let foot = |ui: &mut Ui| FootClicks {
        view: cell(ui, rect, view_top, view, Role::Tab).clicked(),
        keys: cell(ui, rect, keys_top, &keys, Role::Button).clicked(),
    };
    ui.scope_builder(builder, foot).inner
}

fn is_small(rect: Rect) -> bool {
    rect.width() < WIDTH
}

fn cell_height(rect: Rect) -> f32 {
    if is_small(rect) { 40.0 } else { 60.0 }
}

fn cell(ui: &Ui, rect: Rect, top: f32, entry: &RailEntry<'_>, role: Role) -> Response {
    let t = theme::tokens(ui);
    let size = vec2(rect.width() - 8.0, cell_height(rect));
    let cell = Rect::from_min_size(pos2(rect.left() + 4.0, top), size);
    let id = ui.make_persistent_id(("view", entry.word));
    let mut response = ui.interact(cell, id, Sense::click());
    let name = match entry.edits {
        0 => entry.word.to_owned(),
        1 => format!("{}, 1 edit", entry.word),
        edits => format!("{}, {edits} edits", entry.word),
    };
    response.widget_info(|| match role {
        Role::Tab => WidgetInfo::selected(role, true, entry.active, &name),
        _ => WidgetInfo::labeled(role, true, &name),
    });
    let colour = if entry.active { t.sat } else { t.t2 };
    if entry.active {
        ui.painter().rect_filled(cell, 6.0, t.bgsel);
        if !is_small(rect) {
            let bar = Rect::from_min_size(pos2(rect.left(), top), vec2(3.0, cell.height()));
            ui.painter().rect_filled(bar, 0.0, t.sat);
        }
    } else if response.hovered() {
        ui.painter().rect_filled(cell, 6.0, t.bg3);
    }
    if is_small(rect) {
        icons::paint(ui.painter(), paint::square(cell.center(), 20.0), entry.icon, colour);
        response = response.on_hover_text(&name);
    } else {
        let position = cell.center() - vec2(0.0, 9.0);
        icons::paint(ui.painter(), paint::square(position, 20.0), entry.icon, colour);
        let word = cell.with_min_y(cell.bottom() - 27.0).expand2(vec2(3.0, 0.0));
        paint::text_in(ui, word, Align2::CENTER_CENTER, entry.word, text::caption(), colour);
    }
    if entry.edits > 0 {
        let words = entry.edits.to_string();
        let half = paint::text_width(ui, &words, text::caption()) / 2.0 + 4.0;
        let position = pos2(cell.right() - half - 2.0, cell.top() + 10.0);
        let badge = Rect::from_center_size(position, vec2(2.0 * half, 16.0));
        ui.painter().rect_filled(badge, 8.0, t.sat);
        paint::text(ui, position, Align2::CENTER_CENTER, words, text::caption(), t.onsat);
    }
    paint::focus_ring(ui, &response, 6);
    response
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn a_view_is_chosen_with_and_without_its_word() {
        for window_width in [1440.0, 1024.0] {
            let mut window = testing::window([window_width, 640.0], None, |ui, chosen| {
                let size = vec2(width(ui.ctx().content_rect().width()), 592.0);
                let rect = Rect::from_min_size(pos2(0.0, 48.0), size);
                let entries = [
                    RailEntry { icon: Icon::CrossHair, word: "Operate", active: true, edits: 0 },
                    RailEntry { icon: Icon::Sliders, word: "Preferences", active: false, edits: 2 },
                ];
                *chosen = show(ui, rect, &entries).or(*chosen);
            });
            window.get_by_role_and_label(Role::Tab, "Preferences, 2 edits").click();
            window.run();
            assert_eq!(*window.state(), Some(1), "{window_width}");
        }
    }
}
