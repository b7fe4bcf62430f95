//! The switch of automatic operation of an antenna. The operator holds it for a second to switch
//! on.

use egui::{Rect, Role, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use super::PlanState;
use crate::{
    contract::{self, antenna::AntennaModel, automatic::Operation},
    model::{Model, UiCommand},
    ui::{
        replay, theme,
        widgets::{hold_button, paint},
    },
};

const WIDTH: f32 = 36.0;
const HEIGHT: f32 = 20.0;

/// Returns the place of the switch in the label of a lane.
pub(super) fn place(label: Rect) -> Rect {
    let min = pos2(label.right() - 12.0 - WIDTH, label.top() + 7.0);
    Rect::from_min_size(min, vec2(WIDTH, HEIGHT))
}

/// Draws the switch. A click switches it off; a hold of one second switches it on.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    antenna: &AntennaModel,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let is_on = !matches!(antenna.operation, Operation::Off(_));
    let name = &antenna.config.name;
    let id = antenna.id();
    let is_replayed = model.replay.is_some();
    let can = antenna.snapshot.lock_out.is_none() && antenna.held_by.is_none() && !is_replayed;
    let locked = replay::locked(name);
    let description = |words| if is_replayed { &*locked } else { words };
    let set = |is_on| UiCommand::Station(contract::Command::SetAutomatic { antenna: id, is_on });
    let (fill, line) = if is_on { (t.okbg, t.ok) } else { (t.bg0, t.edge) };
    let mut way = if is_on { 1.0 } else { 0.0 };
    let response = if is_on {
        let words = format!("Automatic operation of {name}, on");
        let response =
            paint::control(ui, ("automatic", id.0), rect, Role::Switch, !is_replayed, &words);
        let is_enabled = !is_replayed;
        response.widget_info(|| WidgetInfo::selected(Role::Switch, is_enabled, true, &words));
        if is_enabled && response.clicked() {
            commands.push(set(false));
        }
        response.on_hover_text(description("Click to switch it off. A pass under way continues."))
    } else {
        let words = format!("Automatic operation of {name}, off: hold 1 s to switch it on");
        let hold = state.hold(id);
        let (response, is_held) = hold_button::draw_held(ui, rect, &words, can, hold);
        if is_held {
            commands.push(set(true));
        }
        way = hold_button::part(ui, hold);
        response.on_hover_text(description("Hold for a second to switch it on."))
    };
    let knob = pos2(egui::lerp(rect.left() + 10.0..=rect.right() - 10.0, way), rect.center().y);
    ui.painter().rect_filled(rect, HEIGHT / 2.0, fill);
    if is_replayed {
        paint::dashed_border(ui, rect, HEIGHT / 2.0, Stroke::new(1.0, t.edge));
    } else {
        ui.painter().rect_stroke(rect, HEIGHT / 2.0, Stroke::new(1.0, line), StrokeKind::Inside);
    }
    ui.painter().circle_filled(knob, 7.0, line);
    paint::focus_ring(ui, &response, 10);
}
