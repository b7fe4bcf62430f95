//! The Plan view: the passes of each satellite over time, a lane for each antenna, the list of the
//! chosen antenna, and the selected pass in detail.

mod bar;
mod gantt;
mod inspector;
mod lanes;
mod legend;
mod list;
mod state;
mod switches;

use egui::{EventFilter, Rect, Response, Ui};

pub use self::state::PlanState;
use super::{theme, widgets::paint};
use crate::{
    contract,
    model::{Model, UiCommand, plan::PlannedPass},
    station::Take,
};

const PADDING: f32 = 16.0;
const INSPECTOR: f32 = 344.0;
/// Window width below which the inspector is a drawer, points.
const DRAWER_BELOW: f32 = 1100.0;
/// Window height below which the view has one lane and fewer rows, points.
const LOW_BELOW: f32 = 800.0;
/// Max width of the Gantt labels and of the lane labels, points.
const LABELS: f32 = 208.0;

/// Inset of the focus ring within a focused list, points.
const RING: f32 = 4.0;

/// Draws the view. The inspector stands next to it if `window` is wide enough.
pub fn show(
    ui: &mut Ui,
    window: Rect,
    rect: Rect,
    model: &Model,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let has_drawer = window.width() < DRAWER_BELOW;
    let is_low = window.height() < LOW_BELOW;
    let side = if has_drawer && !state.inspector_is_open { 0.0 } else { INSPECTOR };
    let (main, right) = rect.split_left_right_at_x(rect.right() - side);
    let main = if has_drawer { rect } else { main };
    let (head, rest) = main.split_top_bottom_at_y(main.top() + bar::HEIGHT);
    bar::show(ui, head, model, has_drawer, state, commands);

    let satellites = model.planned_satellites();
    let lanes = if is_low { 1 } else { model.antennas.len().clamp(1, 3) };
    let below = lanes::height(lanes) + list::min_height(is_low);
    let max = (rest.height() - below).max(gantt::height(1));
    let requested = gantt::height(satellites.len().min(if is_low { 8 } else { usize::MAX }));
    let (top, rest) = rest.split_top_bottom_at_y(rest.top() + requested.min(max));
    let (middle, bottom) = rest.split_top_bottom_at_y(rest.top() + lanes::height(lanes));
    // A drawer takes the pointer from the views below it.
    let visible =
        |part: Rect| if has_drawer && side > 0.0 { part.with_max_x(right.left()) } else { part };
    gantt::show(ui, visible(top), model, &satellites, state, commands);
    lanes::show(ui, visible(middle), model, &satellites, is_low, state, commands);
    list::show(ui, visible(bottom), model, state, commands);
    if side > 0.0 {
        let place = if has_drawer { right.with_min_y(head.bottom()) } else { right };
        inspector::show(ui, place, model, state, commands);
    }
    state.forget_old_undo(model.now);
}

/// Shows that a list of passes has the focus. The list is one Tab stop, and the arrow keys move
/// through the passes as everywhere in the view.
fn show_focus(ui: &Ui, list: &Response) {
    if list.has_focus() {
        let arrows = EventFilter {
            horizontal_arrows: true,
            vertical_arrows: true,
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(list.id, arrows));
        paint::ring_around(ui, list.rect.shrink(RING), 0);
    }
}

/// Returns the command that includes or excludes a pass; `take: None` leaves it to the schedule.
fn choose(planned: &PlannedPass<'_>, take: Option<Take>) -> contract::Command {
    let predicted = planned.predicted;
    contract::Command::ChoosePass {
        satellite: predicted.number(),
        tca: predicted.pass.tca.time,
        take,
    }
}
