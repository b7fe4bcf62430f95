//! Jog keys beside the go-to fields, and the reasons of refusals.

use egui::{Align2, Rect, Ui};

use super::{
    Card, Cursor, axes, remark, speed,
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
const FIRST_RATE_DEG_S: f64 = 0.5;
/// Gap below the row of steps, points.
const STEPS_GAP: f32 = 4.0;
/// Height of a sentence of one line, points.
const MESSAGE: f32 = 17.0;

/// Held keys and input.
#[derive(Debug, Clone)]
pub struct DriveState {
    /// Demanded jog rate, degrees per second.
    pub rate_deg_s: f64,
    /// State of the go-to fields.
    pub go_to: GoToState,
    steps: StepState,
    jog: JogState,
    jogging: bool,
}

impl DriveState {
    /// Changes the rate by `by` steps: up if positive, down if negative.
    pub fn change_rate(&mut self, by: i32, speeds: JogSpeeds, max_deg_s: f64) {
        self.rate_deg_s = speed::stepped(self.rate_deg_s, by, speeds, max_deg_s);
    }

    /// Gives the jog pad the keyboard focus as soon as the focus is free.
    pub fn focus_pad(&mut self) {
        self.jog.focus();
    }

    /// Releases the jog key. Returns `true` if the operator held a key.
    pub(super) fn let_go(&mut self) -> bool {
        self.jog = JogState::default();
        std::mem::take(&mut self.jogging)
    }
}

impl Default for DriveState {
    fn default() -> Self {
        Self {
            rate_deg_s: FIRST_RATE_DEG_S,
            go_to: GoToState::default(),
            steps: StepState::default(),
            jog: JogState::default(),
            jogging: false,
        }
    }
}

pub(super) fn show(ui: &mut Ui, at: &mut Cursor, card: &mut Card<'_>, state: &mut DriveState) {
    let (antenna, short) = (card.antenna, at.is_short());
    if short && card.locks.is_tracking {
        if std::mem::take(&mut state.jogging) {
            card.ask(Command::EndJog);
        }
        return;
    }
    let t = theme::tokens(ui);
    if !short {
        let head = at.take(20.0);
        let words = "Jog, hold to move";
        paint::text(ui, head.left_top(), Align2::LEFT_TOP, words, text::caption(), t.t3);
        paint::text(ui, head.right_top(), Align2::RIGHT_TOP, "Go to", text::caption(), t.t3);
    }
    let side = if short { 120.0 } else { 136.0 };
    let area = at.take(side);
    jog(ui, area.with_max_x(area.left() + side), card, state);

    let column = area.with_min_x(area.left() + side + if short { 16.0 } else { 20.0 });
    let rate = column.with_max_y(column.top() + 22.0);
    let can = antenna.variant().capabilities;
    let max_deg_s = antenna.config.limits.maximum_rate_deg_s;
    let is_locked = card.locks.jog.is_some();
    speed::show(ui, rate, can.jog, max_deg_s, is_locked, &mut state.rate_deg_s);
    let height = if short { go_to::SMALL_HEIGHT } else { go_to::HEIGHT };
    let fields = column.with_min_y(column.bottom() - height);
    let (commanded_deg, decimals) = axes::commanded(card.model, antenna);
    let go_to_model = GoToModel {
        locked: card.locks.go_to.is_some(),
        azimuth_range_deg: azimuth_range_deg(antenna.config.mount),
        elevation_range_deg: can.has_elevation().then(|| elevation_range_deg(antenna)),
        commanded_deg: commanded_deg.into(),
        decimals,
    };
    match go_to::show(ui, fields, &go_to_model, &mut state.go_to) {
        Some(GoToAction::Send(target)) => card.ask(Command::Position {
            azimuth: Some(Angle::from_degrees(target.azimuth_deg)),
            elevation: target.elevation_deg.map(Angle::from_degrees),
        }),
        // The plot reads the ghost from the fields themselves.
        Some(GoToAction::Preview(_)) | None => {}
    }
    at.skip(6.0);
    if has_steps(card) {
        steps::show(ui, at, card, &mut state.steps, state.jog);
        at.skip(STEPS_GAP);
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
    let lowest = antenna.config.limits.minimum_elevation_deg;
    match antenna.config.mount {
        Mount::Xy { .. } => (lowest, 90.0),
        Mount::AzEl { elevation_from_deg, elevation_to_deg, .. } => {
            (lowest.max(elevation_from_deg), elevation_to_deg.min(90.0))
        }
    }
}

fn jog(ui: &Ui, pad: Rect, card: &mut Card<'_>, state: &mut DriveState) {
    let antenna = card.antenna;
    let speeds = antenna.variant().capabilities.jog;
    let max_deg_s = antenna.config.limits.maximum_rate_deg_s;
    let rate_deg_s = speed::rate_deg_s(state.rate_deg_s, speeds, max_deg_s);
    let jog_model = JogModel {
        keys: axes::keys(antenna),
        locked: card.locks.jog.is_some(),
        blocked: &axes::blocked(antenna),
        requested: &speed::in_words(rate_deg_s, speeds, max_deg_s),
        real_deg_s: axes::rate_of_jog(antenna),
    };
    let held = jog_pad::show(ui, pad, &jog_model, &mut state.jog);
    if let Some(direction) = held {
        let (x, y) = direction.signs();
        card.ask(Command::Jog { rates_deg_s: [x, y].map(|sign| f64::from(sign) * rate_deg_s) });
    } else if state.jogging {
        card.ask(Command::EndJog);
    }
    state.jogging = held.is_some();
}

/// Shows the reasons of refusals below the controls they concern.
pub(super) fn messages(ui: &Ui, at: &mut Cursor, card: &Card<'_>, state: &DriveState) {
    let t = theme::tokens(ui);
    // Reserve a line, to keep most of the layout when a sentence appears.
    let end = at.y + MESSAGE;
    let refusal = state.go_to.refusal();
    let step = has_steps(card).then(|| state.steps.size_deg(card.antenna).err()).flatten();
    let lock = card.locks.jog;
    let other_lock = card.locks.go_to.filter(|reason| Some(*reason) != lock);
    let unseen = axes::unseen(card.antenna).filter(|_| lock.is_none());
    let found = [
        (step.as_deref(), Icon::Warning, t.bad),
        (refusal, Icon::Warning, t.bad),
        (lock, Icon::Lock, t.t2),
        (other_lock, Icon::Lock, t.t2),
        (unseen.as_deref(), Icon::Info, t.t2),
        (card.antenna.variant().capabilities.stop_note, Icon::Octagon, t.t2),
    ];
    for (index, (words, icon, colour)) in found.into_iter().enumerate() {
        if let Some(words) = words {
            remark(ui, at, ("message", index), icon, colour, words);
            at.skip(1.0);
        }
    }
    at.y = at.y.max(end);
}
