//! Divider between pass list and plot, which the operator can drag.

use egui::{CursorIcon, Rangef, Rect, Role, Sense, Ui, WidgetInfo};

use crate::ui::theme;

/// Reach of the handle to each side of the line, points.
const REACH: f32 = 4.0;

/// Shows the handle at the right edge of `list`. A double click restores the default width.
pub(super) fn show(ui: &Ui, list: Rect, widths: Rangef, width: &mut Option<u32>) {
    let line = list.with_min_x(list.right() - 1.0);
    let handle = line.expand2(egui::vec2(REACH, 0.0));
    // The divider takes no keys: Tab skips it.
    let id = ui.make_persistent_id("width of the pass list");
    let response = ui.interact(handle, id, Sense::CLICK | Sense::DRAG);
    response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, "Width of the pass list"));
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        ui.painter().rect_filled(line.expand2(egui::vec2(1.0, 0.0)), 0.0, theme::tokens(ui).edge);
    }
    if response.double_clicked() {
        *width = None;
    } else if response.dragged()
        && let Some(pointer) = response.interact_pointer_pos()
    {
        *width = Some(widths.clamp(pointer.x - list.left()).round() as u32);
    }
}
