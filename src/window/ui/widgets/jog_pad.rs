//! Four keys that move an antenna while one of them is held.

mod hold;
mod keys;

use std::time::Duration;

use egui::{
    Align2, EventFilter, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, ViewportId,
    WidgetInfo,
};

use super::{button::RADIUS, paint};
use crate::ui::{
    icons::{self, Icon},
    text::{self, Weight},
    theme,
};

pub use hold::JogState;
use hold::{Focus, Frame};
pub use keys::{JogDirection, JogKeys, KeyLabel};

/// Max time between two reports of a held key.
const WHILE_HELD: Duration = Duration::from_millis(100);

/// Content of the pad.
#[derive(Debug, Clone, Copy, Default)]
pub struct JogModel<'a> {
    pub keys: JogKeys,
    /// `true` if Azel refuses jogging now; the caller shows the reason below the pad.
    pub locked: bool,
    /// Directions in which a limit stops the antenna.
    pub blocked: &'a [JogDirection],
    /// The chosen speed as a word or a number; empty if there is no choice.
    pub requested: &'a str,
    /// Measured rate of the moving axis, degrees per second.
    pub real_deg_s: Option<f64>,
}

/// Shows the pad in `rect`, a square. Returns the held direction in every frame of the hold; the
/// first frame with `None` is the release.
/// The pointer can hold a key. Arrow keys, Space or Enter hold a key while a key of the pad has the
/// focus. Only the arrow keys do so while the pad as a whole has the focus ([`JogState::focus`]).
/// Losing the window, the pointer or the focus releases the key, and only a new press holds it
/// again.
pub fn show(
    ui: &Ui,
    rect: Rect,
    model: &JogModel<'_>,
    state: &mut JogState,
) -> Option<JogDirection> {
    let side = (rect.width() * 5.0 / 17.0).floor();
    let mut frame = Frame::new(model.locked);
    let whole = whole(ui, rect, !model.locked);
    if keeps_arrows(ui, &whole) {
        frame.focus = Some(Focus::Pad);
    }
    let mut keys = Vec::new();
    for direction in JogDirection::ALL {
        let Some(label) = model.keys.label(direction) else { continue };
        let (x, y) = direction.signs();
        let reach = (rect.width() - side) / 2.0;
        let place =
            paint::square(rect.center() + Vec2::new(f32::from(x), -f32::from(y)) * reach, side);
        let free = !model.locked && !model.blocked.contains(&direction);
        let name = format!("Jog {}", label.name);
        let response = paint::held_control(ui, ("jog", direction), place, free, &name);
        if free {
            look_at(ui, &mut frame, direction, &response);
        }
        if !label.description.is_empty() {
            let description = label.description.clone();
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(description));
        }
        keys.push((direction, label, free, response));
    }
    frame.blocked = JogDirection::ALL.map(|direction| {
        !keys.iter().any(|(jog_direction, _, free, _)| *jog_direction == direction && *free)
    });
    ui.input(|input| frame.read(input));
    if state.takes_focus(&frame) {
        whole.request_focus();
    }
    let held_direction = state.step(&frame);
    if held_direction.is_some() {
        // Without a frame, nothing would report that the key is still held.
        ui.ctx().request_repaint_after_for(WHILE_HELD, ViewportId::ROOT);
    }
    for (direction, label, free, response) in &keys {
        paint_key(ui, label, *free, model.locked, held_direction == Some(*direction), response);
    }
    paint_middle(ui, rect, model, held_direction.is_some());
    paint::focus_ring(ui, &whole, RADIUS);
    held_direction
}

/// Adds the pad as a whole, which can have the focus in place of a single key. The pointer passes
/// through to the keys.
fn whole(ui: &Ui, rect: Rect, free: bool) -> Response {
    let sense = if free { Sense::focusable_noninteractive() } else { Sense::hover() };
    let response = ui.interact(rect, ui.make_persistent_id("jog pad"), sense);
    response.widget_info(|| WidgetInfo::labeled(Role::Group, free, "Jog with the arrow keys"));
    response
}

/// Adds pointer and focus of one key to the frame.
fn look_at(ui: &Ui, frame: &mut Frame, direction: JogDirection, response: &Response) {
    if response.is_pointer_button_down_on() {
        frame.pointer_on = Some(direction);
        response.request_focus();
    }
    if keeps_arrows(ui, response) {
        frame.focus = Some(Focus::Key(direction));
    }
}

/// Returns `true` if the control has the focus. The arrow keys then do not move the focus.
fn keeps_arrows(ui: &Ui, response: &Response) -> bool {
    if ui.input(|input| !input.focused) {
        // A return to the window must not press the keys again.
        response.surrender_focus();
    }
    if !response.has_focus() {
        return false;
    }
    let filter =
        EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    true
}

fn paint_key(
    ui: &Ui,
    label: &KeyLabel,
    free: bool,
    locked: bool,
    is_held: bool,
    response: &Response,
) {
    let t = theme::tokens(ui);
    let rect = response.rect;
    let colour = if is_held {
        ui.painter().rect_filled(rect, RADIUS, t.cmd);
        t.onsat
    } else if free {
        let border = Stroke::new(1.0, if response.hovered() { t.t2 } else { t.edge });
        ui.painter().rect(rect, RADIUS, t.bg3, border, StrokeKind::Inside);
        t.t1
    } else {
        let colour = if locked { t.edge } else { t.bad };
        paint::dashed_border(ui, rect, f32::from(RADIUS), (1.0, colour));
        if locked { t.t3 } else { t.bad }
    };
    let strong = text::sized(13.0, Weight::SemiBold);
    let (above, below) = rect.split_top_bottom_at_fraction(0.5);
    let above = above.with_min_y(above.top() + 3.0);
    paint::text(ui, above.center(), Align2::CENTER_CENTER, label.mark, strong, colour);
    let room = below.with_max_y(below.bottom() - 3.0);
    paint::text_in(ui, room, Align2::CENTER_CENTER, label.word, text::caption(), colour);
    paint::focus_ring(ui, response, RADIUS);
}

fn paint_middle(ui: &Ui, rect: Rect, model: &JogModel<'_>, is_held: bool) {
    let t = theme::tokens(ui);
    if model.locked {
        let area = paint::square(rect.center(), 18.0);
        icons::paint(ui.painter(), area, Icon::Lock, t.t2);
        return;
    }
    let (words, colour) = if is_held {
        let real = model.real_deg_s.map_or_else(
            || super::axes_table::UNKNOWN.to_owned(),
            |rate| format!("{rate:+.2}").replace('-', "−"),
        );
        (real, t.t1)
    } else {
        (model.requested.to_owned(), t.t2)
    };
    let font = text::sized(12.0, Weight::SemiBold);
    paint::text(ui, rect.center(), Align2::CENTER_CENTER, words, font, colour);
}

#[cfg(test)]
mod tests;
