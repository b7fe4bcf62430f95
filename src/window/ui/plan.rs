//! The Plan view: the passes of each satellite over time, a lane for each antenna, what the
//! chosen antenna will carry out, and the selected pass in detail.

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
/// In a window below this width the inspector is a drawer.
const DRAWER_BELOW: f32 = 1100.0;
/// In a window below this height there is one lane, and fewer rows.
const LOW_BELOW: f32 = 800.0;
/// Widest Gantt labels, and those of the lanes.
const LABELS: f32 = 208.0;

/// The ring of a focused list lies so far within it.
const RING: f32 = 4.0;

/// Draws the view. The inspector has room beside it if `window` is wide enough.
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
    // A drawer takes the pointer.
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

/// Shows that a list of passes has the focus. It is one stop of Tab, and the arrows go through the
/// passes as they do anywhere in the view.
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

/// The command by which the operator chooses a pass for the schedule, or leaves it to that.
fn choose(planned: &PlannedPass<'_>, take: Option<Take>) -> contract::Command {
    let predicted = planned.predicted;
    contract::Command::ChoosePass {
        satellite: predicted.number(),
        tca: predicted.pass.tca.time,
        take,
    }
}
