//! A pass next to its satellite: time, maximum elevation and verdict.

use egui::{Align2, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use super::{PassRow, phase, row, thumbnail};
use crate::ui::{
    format,
    text::{self, Weight},
    theme,
    widgets::paint,
};

/// Height of a row, points.
pub const SHORT_ROW: f32 = 64.0;
const PADDING: f32 = 16.0;
/// Distance of the texts from the left edge, points.
const TEXTS: f32 = 76.0;

/// Shows the row of a pass that begins at `time`, which is already formatted.
pub fn short_row(
    ui: &Ui,
    rect: Rect,
    row: &PassRow<'_>,
    time: &str,
    is_selected: bool,
) -> Response {
    let t = theme::tokens(ui);
    let id = ui.make_persistent_id(("short pass", row.key));
    let response = ui.interact(rect, id, Sense::click());
    let shape = shape(row);
    let verdict = row.verdict.map(super::Verdict::sentence).unwrap_or_default();
    response.widget_info(|| {
        let spoken = format!("Pass at {time}, {shape}, {verdict}");
        WidgetInfo::selected(Role::ListBoxOption, true, is_selected, spoken)
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_selected(is_selected));
    if is_selected || response.hovered() {
        ui.painter().rect_filled(rect, 0.0, if is_selected { t.bgsel } else { t.bg3 });
    }
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let picture = pos2(rect.left() + PADDING + thumbnail::SIDE / 2.0, rect.center().y);
    thumbnail::paint(ui, paint::square(picture, thumbnail::SIDE), row.path);
    let line = |start: f32| {
        let min = pos2(rect.left() + TEXTS, rect.top() + start);
        Rect::from_min_size(min, vec2(rect.right() - PADDING - min.x, 18.0))
    };
    let left = Align2::LEFT_CENTER;
    paint::text_in(ui, line(5.0), left, time, text::sized(13.0, Weight::SemiBold), t.t1);
    paint::text_in(ui, line(23.0), left, &shape, text::small(), t.t2);
    if let Some(verdict) = row.verdict {
        row::verdict_in(ui, line(41.0), verdict, t);
    }
    paint::focus_ring(ui, &response, 0);
    response
}

/// Returns maximum elevation, azimuths and duration, as far as they are known.
fn shape(row: &PassRow<'_>) -> String {
    let max = format!("max {}", format::degrees(row.max_elevation_deg, 0));
    let parts = [max, phase::azimuths(row), phase::duration(row)];
    let shown_parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    shown_parts.join(", ")
}
