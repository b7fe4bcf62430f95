//! Jog keys beside the go-to fields, and the reasons of refusals.

use egui::{Align2, Rect, Ui};

use super::{
    Card, Cursor, axes, show_remark, speed,
    steps::{self, StepState},
};
use crate::{
    astro::Angle,
    contract::{antenna::AntennaModel, driver::Command},
    device::JogSpeeds,
    station::Mount,
    ui::{
        icons::Icon,
        text, theme,
        widgets::{
            go_to::{self, GoToAction, GoToModel, GoToState},
            jog_pad::{self, JogModel, JogState},
            paint,
        },
    },
};

/// Initial jog rate, degrees per second.
const DEFAULT_RATE_DEG_S: f64 = 0.5;
/// Gap below the row of steps, points.
const STEPS_GAP: f32 = 4.0;
/// Height of a sentence of one line, points.
const MESSAGE_HEIGHT: f32 = 17.0;

/// Held keys and input.
#[derive(Debug, Clone)]
pub struct DriveState {
    /// Demanded jog rate, degrees per second.
    pub rate_deg_s: f64,
    /// State of the go-to fields.
    pub go_to: GoToState,
    steps: StepState,
    jog: JogState,
    is_jogging: bool,
}

impl DriveState {
    /// Changes the rate by `steps`: up if positive, down if negative.
    pub fn change_rate(&mut self, steps: i32, speeds: JogSpeeds, max_deg_s: f64) {
        self.rate_deg_s = speed::stepped(self.rate_deg_s, steps, speeds, max_deg_s);
    }

    /// Gives the jog pad the keyboard focus as soon as the focus is free.
    pub fn focus_pad(&mut self) {
        self.jog.focus();
    }

    /// Releases the jog key. Returns `true` if the operator held a key.
    pub(super) fn release_key(&mut self) -> bool {
        self.jog = JogState::default();
        std::mem::take(&mut self.is_jogging)
    }
}

impl Default for DriveState {
    fn default() -> Self {
        Self {
            rate_deg_s: DEFAULT_RATE_DEG_S,
            go_to: GoToState::default(),
            steps: StepState::default(),
            jog: JogState::default(),
            is_jogging: false,
        }
    }
}

pub(super) fn show(ui: &mut Ui, cursor: &mut Cursor, card: &mut Card<'_>, state: &mut DriveState) {
    let (antenna, is_short) = (card.antenna, cursor.is_short());
    if is_short && card.locks.is_tracking {
        if std::mem::take(&mut state.is_jogging) {
            card.queue(Command::EndJog);
        }
        return;
    }
    let t = theme::tokens(ui);
    if !is_short {
        let head = cursor.take(20.0);
        let words = "Jog, hold to move";
        paint::text(ui, head.left_top(), Align2::LEFT_TOP, words, text::caption(), t.t3);
        paint::text(ui, head.right_top(), Align2::RIGHT_TOP, "Go to", text::caption(), t.t3);
    }
    let side = if is_short { 120.0 } else { 136.0 };
    let area = cursor.take(side);
    show_jog_pad(ui, area.with_max_x(area.left() + side), card, state);

    let column = area.with_min_x(area.left() + side + if is_short { 16.0 } else { 20.0 });
    let rate = column.with_max_y(column.top() + 22.0);
    let capabilities = antenna.variant().capabilities;
    let max_deg_s = antenna.config.limits.maximum_rate_deg_s;
    let is_locked = card.locks.jog.is_some();
    speed::show(ui, rate, capabilities.jog, max_deg_s, is_locked, &mut state.rate_deg_s);
    let height = if is_short { go_to::SMALL_HEIGHT } else { go_to::HEIGHT };
    let fields = column.with_min_y(column.bottom() - height);
    let (commanded_deg, decimals) = axes::commanded(card.model, antenna);
    let go_to_model = GoToModel {
        locked: card.locks.go_to.is_some(),
        azimuth_range_deg: azimuth_range_deg(antenna.config.mount),
        elevation_range_deg: capabilities.has_elevation().then(|| elevation_range_deg(antenna)),
        commanded_deg: commanded_deg.into(),
        decimals,
    };
    match go_to::show(ui, fields, &go_to_model, &mut state.go_to) {
        Some(GoToAction::Send(target)) => card.queue(Command::Position {
            azimuth: Some(Angle::from_degrees(target.azimuth_deg)),
            elevation: target.elevation_deg.map(Angle::from_degrees),
        }),
        // The plot reads the ghost from the fields themselves.
        Some(GoToAction::Preview(_)) | None => {}
    }
    cursor.skip(6.0);
    if has_steps(card) {
        steps::show(ui, cursor, card, &mut state.steps, state.jog);
        cursor.skip(STEPS_GAP);
    }
}

/// Returns `true` while the operator can turn the axes by steps.
fn has_steps(card: &Card<'_>) -> bool {
    card.antenna.variant().capabilities.steps && card.locks.jog.is_none()
}

/// Returns the accepted azimuths, degrees: the whole sky, and azimuths beyond it within the travel
/// of the axis.
fn azimuth_range_deg(mount: Mount) -> (f64, f64) {
    match mount {
        Mount::Xy { .. } => (0.0, 360.0),
        Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } => {
            (azimuth_from_deg.min(0.0), azimuth_to_deg.max(360.0))
        }
    }
}

/// Returns the accepted elevations, degrees.
fn elevation_range_deg(antenna: &AntennaModel) -> (f64, f64) {
    let min_deg = antenna.config.limits.minimum_elevation_deg;
    match antenna.config.mount {
        Mount::Xy { .. } => (min_deg, 90.0),
        Mount::AzEl { elevation_from_deg, elevation_to_deg, .. } => {
            (min_deg.max(elevation_from_deg), elevation_to_deg.min(90.0))
        }
    }
}

fn show_jog_pad(ui: &Ui, pad: Rect, card: &mut Card<'_>, state: &mut DriveState) {
    let antenna = card.antenna;
    let speeds = antenna.variant().capabilities.jog;
    let max_deg_s = antenna.config.limits.maximum_rate_deg_s;
    let rate_deg_s = speed::rate_deg_s(state.rate_deg_s, speeds, max_deg_s);
    let jog_model = JogModel {
        keys: axes::keys(antenna),
        locked: card.locks.jog.is_some(),
        blocked: &axes::blocked(antenna),
        requested: &speed::in_words(rate_deg_s, speeds, max_deg_s),
        real_deg_s: axes::jog_rate_deg_s(antenna),
    };
    let held_direction = jog_pad::show(ui, pad, &jog_model, &mut state.jog);
    if let Some(direction) = held_direction {
        let (x, y) = direction.signs();
        card.queue(Command::Jog { rates_deg_s: [x, y].map(|sign| f64::from(sign) * rate_deg_s) });
    } else if state.is_jogging {
        card.queue(Command::EndJog);
    }
    state.is_jogging = held_direction.is_some();
}

/// Shows the reasons of refusals below the controls they concern.
pub(super) fn show_messages(ui: &Ui, cursor: &mut Cursor, card: &Card<'_>, state: &DriveState) {
    let t = theme::tokens(ui);
    // Reserve a line, to keep most of the layout when a sentence appears.
    let end = cursor.y + MESSAGE_HEIGHT;
    let refusal = state.go_to.refusal();
    let step = has_steps(card).then(|| state.steps.size_deg(card.antenna).err()).flatten();
    let lock = card.locks.jog;
    let other_lock = card.locks.go_to.filter(|reason| Some(*reason) != lock);
    let unknown_axis = axes::unknown_axis_note(card.antenna).filter(|_| lock.is_none());
    let messages = [
        (step.as_deref(), Icon::Warning, t.bad),
        (refusal, Icon::Warning, t.bad),
        (lock, Icon::Lock, t.t2),
        (other_lock, Icon::Lock, t.t2),
        (unknown_axis.as_deref(), Icon::Info, t.t2),
        (card.antenna.variant().capabilities.stop_note, Icon::Octagon, t.t2),
    ];
    for (index, (words, icon, colour)) in messages.into_iter().enumerate() {
        if let Some(words) = words {
            show_remark(ui, cursor, ("message", index), icon, colour, words);
            cursor.skip(1.0);
        }
    }
    cursor.y = cursor.y.max(end);
}
