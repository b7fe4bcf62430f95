//! Jog keys beside the go-to fields, and the reasons of refusals.

use egui::{Align2, Color32, Rect, Ui, pos2};

use super::{
    CardAction, Cursor, speed,
    steps::{self, StepState},
};
use crate::{
    device::JogSpeeds,
    ui::{
        icons::{self, Icon},
        text, theme,
        widgets::{
            go_to::{self, GoToAction, GoToModel, GoToState},
            jog_pad::{self, JogDirection, JogKeys, JogModel, JogState},
            paint,
        },
    },
};

/// Initial jog rate.
const FIRST_RATE_DEG_S: f64 = 0.5;
/// Gap below the row of steps.
const STEPS_GAP: f32 = 4.0;
/// Height of a sentence of one line.
const MESSAGE: f32 = 17.0;

/// Content of the controls for moving by hand.
#[derive(Debug, Clone, Copy)]
pub struct DriveModel<'a> {
    /// Names of the jog keys.
    pub keys: JogKeys,
    /// A target is tracked: nothing moves by hand, and a low card leaves these controls out.
    pub is_tracking: bool,
    /// The reason why jogging is refused now.
    pub jog_locked: Option<&'a str>,
    /// The reason why jogging waits for the operator's permission.
    pub unguarded: Option<&'a str>,
    /// The reason why some keys do nothing.
    pub jog_note: Option<&'a str>,
    /// Directions in which a limit stops the antenna, or whose axis must not turn.
    pub blocked: &'a [JogDirection],
    /// The measured rate of the moving axis.
    pub real_deg_s: Option<f64>,
    /// Selectable jog speeds.
    pub speeds: JogSpeeds,
    /// Max rate of the unit.
    pub max_deg_s: f64,
    /// The largest step of an axis; none for a unit without steps.
    pub max_step_deg: Option<f64>,
    /// The reason why moving to a direction is refused now.
    pub go_to_locked: Option<&'a str>,
    /// Accepted azimuths.
    pub azimuth_range_deg: (f64, f64),
    /// Accepted elevations; none for a rotator with one axis.
    pub elevation_range_deg: Option<(f64, f64)>,
    /// The commanded direction.
    pub commanded_deg: (Option<f64>, Option<f64>),
    /// Decimals of the commanded direction.
    pub commanded_decimals: usize,
    /// Effects of STOP beyond stopping this antenna.
    pub stop_note: Option<&'a str>,
}

/// Held keys and input.
#[derive(Debug, Clone)]
pub struct DriveState {
    /// Demanded jog rate.
    pub rate_deg_s: f64,
    /// The go-to fields.
    pub go_to: GoToState,
    steps: StepState,
    jog: JogState,
    jogging: bool,
}

impl DriveState {
    /// Selects the next rate up (`by` positive) or down.
    pub fn change_rate(&mut self, by: i32, speeds: JogSpeeds, max_deg_s: f64) {
        self.rate_deg_s = speed::stepped(self.rate_deg_s, by, speeds, max_deg_s);
    }

    /// Gives the jog pad the keyboard focus as soon as it is free.
    pub fn focus_pad(&mut self) {
        self.jog.focus();
    }

    /// Releases the jog key. Returns `true` if one was held.
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

pub(super) fn show(
    ui: &mut Ui,
    at: &mut Cursor,
    model: &DriveModel<'_>,
    state: &mut DriveState,
    actions: &mut Vec<CardAction>,
    short: bool,
) {
    if short && model.is_tracking {
        if std::mem::take(&mut state.jogging) {
            actions.push(CardAction::JogReleased);
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
    jog(ui, area.with_max_x(area.left() + side), model, state, actions);

    let column = area.with_min_x(area.left() + side + if short { 16.0 } else { 20.0 });
    let rate = column.with_max_y(column.top() + 22.0);
    speed::show(ui, rate, model, &mut state.rate_deg_s);
    let height = if short { go_to::SMALL_HEIGHT } else { go_to::HEIGHT };
    let fields = column.with_min_y(column.bottom() - height);
    let go_to_model = GoToModel {
        locked: model.go_to_locked.is_some(),
        azimuth_range_deg: model.azimuth_range_deg,
        elevation_range_deg: model.elevation_range_deg,
        commanded_deg: model.commanded_deg,
        decimals: model.commanded_decimals,
    };
    let asked = go_to::show(ui, fields, &go_to_model, &mut state.go_to);
    actions.extend(asked.map(|action| match action {
        GoToAction::Preview(target) => CardAction::PreviewGoTo(target),
        GoToAction::Send(target) => CardAction::GoTo(target),
    }));
    at.skip(6.0);
    if let Some(max_deg) = model.max_step_deg.filter(|_| model.jog_locked.is_none()) {
        steps::show(ui, at, model, max_deg, &mut state.steps, state.jog, actions);
        at.skip(STEPS_GAP);
    }
}

fn jog(
    ui: &Ui,
    pad: Rect,
    model: &DriveModel<'_>,
    state: &mut DriveState,
    actions: &mut Vec<CardAction>,
) {
    let rate_deg_s = speed::rate_deg_s(state.rate_deg_s, model.speeds, model.max_deg_s);
    let jog_model = JogModel {
        keys: model.keys,
        locked: model.jog_locked.is_some(),
        blocked: model.blocked,
        requested: &speed::in_words(rate_deg_s, model.speeds, model.max_deg_s),
        real_deg_s: model.real_deg_s,
    };
    let held = jog_pad::show(ui, pad, &jog_model, &mut state.jog);
    if let Some(direction) = held {
        let (x, y) = direction.signs();
        actions.push(CardAction::Jog { x, y, rate_deg_s });
    } else if state.jogging {
        actions.push(CardAction::JogReleased);
    }
    state.jogging = held.is_some();
}

/// Shows the reasons of refusals below the controls that they are about.
pub(super) fn messages(ui: &Ui, at: &mut Cursor, model: &DriveModel<'_>, state: &DriveState) {
    let t = theme::tokens(ui);
    // Reserved, so that little moves when a sentence appears.
    let end = at.y + MESSAGE;
    let refusal = state.go_to.refusal();
    let step = model.max_step_deg.and_then(|max_deg| state.steps.size_deg(max_deg).err());
    let step = step.as_deref().filter(|_| model.jog_locked.is_none());
    let lock = model.jog_locked;
    let other_lock = model.go_to_locked.filter(|reason| Some(*reason) != lock);
    let found: [(Option<&str>, Icon, Color32, Color32); 6] = [
        (step, Icon::Warning, t.bad, t.bad),
        (refusal, Icon::Warning, t.bad, t.bad),
        (lock, Icon::Lock, t.t2, t.t2),
        (other_lock, Icon::Lock, t.t2, t.t2),
        (model.jog_note.filter(|_| lock.is_none()), Icon::Info, t.t2, t.t2),
        (model.stop_note, Icon::Octagon, t.t2, t.t2),
    ];
    for (index, (words, icon, mark, colour)) in found.into_iter().enumerate() {
        let Some(words) = words else { continue };
        let glyph = paint::square(pos2(at.left + 7.0, at.y + 8.0), 13.0);
        icons::paint(ui.painter(), glyph, icon, mark);
        let start = pos2(at.left + 20.0, at.y);
        let width = at.width() - 20.0;
        let taken = paint::paragraph(ui, start, width, words, text::small(), colour);
        paint::name_text(ui, ("message", index), taken, words);
        at.y = taken.bottom() + 1.0;
    }
    at.y = at.y.max(end);
}
