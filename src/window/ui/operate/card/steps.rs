//! Steps of an axis: their size, and a key for each direction.

use egui::{Align2, Event, EventFilter, Rect, Response, Ui, pos2, vec2};

use super::{Card, Cursor, axes};
use crate::{
    contract::{antenna::AntennaModel, driver::Command},
    ui::{
        text, theme,
        widgets::{
            angle_field::AngleField,
            button::{Button, SMALL_HEIGHT},
            go_to::parse,
            jog_pad::{JogDirection, JogState},
            paint,
        },
    },
};

/// Initial size of a step, degrees.
const DEFAULT_DEG: f64 = 0.5;
/// Min size of a step, degrees: the unit reports hundredths, so a smaller step would not show.
const MIN_DEG: f64 = 0.01;
const LABEL_WIDTH: f32 = 36.0;
const FIELD_WIDTH: f32 = 64.0;
const KEY_WIDTH: f32 = 36.0;
const GAP: f32 = 4.0;
const ORDER: [JogDirection; 4] =
    [JogDirection::XMinus, JogDirection::XPlus, JogDirection::YMinus, JogDirection::YPlus];

/// Text that the operator typed.
#[derive(Debug, Clone)]
pub(super) struct StepState {
    typed: String,
}

impl Default for StepState {
    fn default() -> Self {
        Self { typed: DEFAULT_DEG.to_string() }
    }
}

impl StepState {
    /// Returns the size, degrees, or the reason why the input is invalid.
    pub(super) fn size_deg(&self, antenna: &AntennaModel) -> Result<f64, String> {
        let max_deg = antenna.config.limits.maximum_step_deg;
        parse::angle(&self.typed, "Step", (MIN_DEG, max_deg))
    }
}

/// Shows the row. Call only while the operator may use the keys.
pub(super) fn show(
    ui: &mut Ui,
    cursor: &mut Cursor,
    card: &mut Card<'_>,
    state: &mut StepState,
    jog: JogState,
) {
    let (keys, blocked) = (axes::keys(card.antenna), axes::blocked(card.antenna));
    let row = cursor.take(SMALL_HEIGHT);
    let t = theme::tokens(ui);
    paint::text(ui, row.left_center(), Align2::LEFT_CENTER, "Step", text::small(), t.t2);
    let size = state.size_deg(card.antenna);
    let field =
        row.with_min_x(row.left() + LABEL_WIDTH).with_max_x(row.left() + LABEL_WIDTH + FIELD_WIDTH);
    let id = ui.make_persistent_id("step size");
    AngleField { refused: size.is_err(), hint: "", name: "Step size, degrees" }.show(
        ui,
        id,
        field,
        &mut state.typed,
    );

    let unit = pos2(field.right() + GAP, row.center().y);
    paint::text(ui, unit, Align2::LEFT_CENTER, "°", text::small(), t.t2);
    let mut focused = jog.has_focus();
    let mut requested = None;
    let keys: Vec<_> = ORDER
        .into_iter()
        .filter_map(|direction| Some((direction, keys.label(direction)?)))
        .collect();
    let mut left = row.right() + GAP - keys.len() as f32 * (KEY_WIDTH + GAP);
    for (direction, label) in keys {
        let place = Rect::from_min_size(pos2(left, row.top()), vec2(KEY_WIDTH, SMALL_HEIGHT));
        left = place.right() + GAP;
        let is_free = size.is_ok() && !blocked.contains(&direction);
        let button = Button::normal(label.word).locked(!is_free);
        let response = button.show(ui, ("step", direction), place);
        let response = response.accessible_name(format!("Step {}", label.name));
        focused |= keeps_arrows(ui, &response);
        if response.clicked() {
            response.request_focus();
            requested = Some(direction);
        }
    }
    if focused {
        requested = requested.or_else(|| arrow(ui));
    }
    if let (Some(direction), Ok(step_deg)) = (requested, size)
        && !blocked.contains(&direction)
        && !jog.is_held()
    {
        let (x, y) = direction.signs();
        card.queue(Command::Step { steps_deg: [x, y].map(|sign| f64::from(sign) * step_deg) });
    }
}

/// Returns `true` if the key has the focus. Keeps the arrow keys from moving the focus, because
/// they step the axis.
fn keeps_arrows(ui: &Ui, key: &Response) -> bool {
    if key.has_focus() {
        let filter = EventFilter {
            horizontal_arrows: true,
            vertical_arrows: true,
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(key.id, filter));
    }
    key.has_focus()
}

/// Returns the direction of an arrow key pressed with Shift in this frame. Ignores key repeat.
fn arrow(ui: &Ui) -> Option<JogDirection> {
    ui.input(|input| {
        input.events.iter().find_map(|event| match event {
            Event::Key { key, pressed: true, repeat: false, modifiers, .. }
                if modifiers.shift_only() =>
            {
                JogDirection::of_arrow(*key)
            }
            _ => None,
        })
    })
}
