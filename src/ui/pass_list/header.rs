//! Title, count and the choice of the lowest maximum elevation.

use egui::{Align2, Popup, Rect, Ui, pos2, vec2};

use super::{FLOORS_DEG, PassListAction, PassListModel};
use crate::ui::{
    format, text, theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        paint,
    },
};

/// Height of the head, with its divider.
pub(super) const HEIGHT: f32 = 40.0;

const PADDING: f32 = 16.0;
/// Floors closer than this are the same.
const SAME_DEG: f64 = 0.05;

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    actions: &mut Vec<PassListAction>,
) {
    let t = theme::tokens(ui);
    let room = rect.shrink2(vec2(PADDING, 0.0));
    let at = room.left_center();
    let title = paint::text(ui, at, Align2::LEFT_CENTER, "Next passes", text::small_strong(), t.t1);
    let at = title.right_center() + vec2(8.0, 0.0);
    let count = format::number(model.rows as f64, 0);
    let count_place = paint::text(ui, at, Align2::LEFT_CENTER, &count, text::small(), t.t3);
    paint::name_text(ui, "title", title | count_place, &format!("Next passes, {count}"));
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));

    let chosen = floor(model.floor_deg);
    let button = Button::quiet(&chosen).chevron();
    let size = vec2(button.width(ui), SMALL_HEIGHT);
    let place = Rect::from_min_size(
        pos2(room.right() - size.x, (rect.center().y - size.y / 2.0).round()),
        size,
    );
    let response = button.show(ui, "floor", place);
    Popup::menu(&response).width(size.x).accessible_name("Lowest maximum elevation").show(|ui| {
        ui.set_min_width(ui.available_width());
        for floor_deg in FLOORS_DEG {
            let same = (floor_deg - model.floor_deg).abs() < SAME_DEG;
            let choice = egui::Button::selectable(same, floor(floor_deg));
            if ui.add(choice).clicked() && !same {
                actions.push(PassListAction::SetFloor(floor_deg));
            }
        }
    });
}

fn floor(floor_deg: f64) -> String {
    format!("max ≥ {}", format::degrees(floor_deg, 0))
}
