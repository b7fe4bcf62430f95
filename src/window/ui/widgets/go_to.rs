//! Two fields for a direction, and the button that sends it.

pub mod parse;

use egui::{Align2, Id, Key, Rect, Role, Sense, Ui, WidgetInfo, pos2};

use super::{
    angle_field::{AngleField, RADIUS},
    axes_table::angle,
    button::Button,
    input, paint,
};
use crate::ui::{text, theme};

pub use parse::Field;

/// Height of the two fields and the button, points.
pub const HEIGHT: f32 = 104.0;
/// [`HEIGHT`] in a small window, points.
pub const SMALL_HEIGHT: f32 = 94.0;
const LABEL: f32 = 40.0;

/// Limits and hints of the fields.
#[derive(Debug, Clone, Copy)]
pub struct GoToModel {
    /// `true` if Azel refuses to send a direction now; the caller shows the reason below.
    pub locked: bool,
    /// Accepted azimuths, degrees.
    pub azimuth_range_deg: (f64, f64),
    /// Accepted elevations, degrees; `None` for a rotator with one axis.
    pub elevation_range_deg: Option<(f64, f64)>,
    /// Commanded direction, degrees, shown in empty fields.
    pub commanded_deg: (Option<f64>, Option<f64>),
    /// Number of decimals of the commanded direction.
    pub decimals: usize,
}

/// An entered direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Azimuth clockwise from north, degrees.
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees; `None` for a rotator with one axis.
    pub elevation_deg: Option<f64>,
}

/// The operator's request.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GoToAction {
    /// Preview of the direction in the sky plot, without motion.
    Preview(Target),
    /// Motion of the antenna to the direction.
    Send(Target),
}

/// Contents of the fields, kept from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct GoToState {
    pub azimuth: String,
    pub elevation: String,
    refusal: Option<(Field, String)>,
    previewed: Option<Target>,
    /// Valid direction in the fields, if any.
    typed: Option<Target>,
    /// Direction that the operator has sent or abandoned; the fields keep it.
    left: Option<Target>,
    wants_focus: bool,
}

impl GoToState {
    /// Gives the first field the keyboard focus in the next frame.
    pub fn focus(&mut self) {
        self.wants_focus = true;
    }

    /// Returns the reason why Azel refused the last input.
    pub fn refusal(&self) -> Option<&str> {
        self.refusal.as_ref().map(|(_, sentence)| sentence.as_str())
    }

    /// Returns the previewed direction until the fields change.
    pub fn previewed(&self) -> Option<Target> {
        self.previewed
    }

    /// Returns the direction in the fields until the operator sends or abandons it.
    pub fn typed(&self) -> Option<Target> {
        self.typed.filter(|typed| self.left.as_ref() != Some(typed))
    }

    /// Ends the preview of the entered direction; the fields keep it.
    pub fn leave_typed(&mut self) {
        self.left = self.typed;
        self.previewed = None;
    }

    fn in_fields(&self, model: &GoToModel) -> Option<Target> {
        let azimuth = parse::angle(&self.azimuth, Field::Azimuth.name(), model.azimuth_range_deg);
        let elevation = model
            .elevation_range_deg
            .map(|range| parse::angle(&self.elevation, Field::Elevation.name(), range))
            .transpose();
        Some(Target { azimuth_deg: azimuth.ok()?, elevation_deg: elevation.ok()? })
    }

    fn read(&mut self, model: &GoToModel) -> Option<Target> {
        let azimuth = parse::angle(&self.azimuth, Field::Azimuth.name(), model.azimuth_range_deg)
            .map_err(|sentence| (Field::Azimuth, sentence));
        let elevation = model
            .elevation_range_deg
            .map(|range| parse::angle(&self.elevation, Field::Elevation.name(), range))
            .transpose()
            .map_err(|sentence| (Field::Elevation, sentence));
        match azimuth.and_then(|azimuth| elevation.map(|elevation| (azimuth, elevation))) {
            Ok((azimuth_deg, elevation_deg)) => {
                self.refusal = None;
                Some(Target { azimuth_deg, elevation_deg })
            }
            Err(refusal) => {
                self.refusal = Some(refusal);
                None
            }
        }
    }

    /// Handles Enter: the first press previews the direction, the second sends it.
    fn enter(&mut self, model: &GoToModel) -> Option<GoToAction> {
        let target = self.read(model)?;
        if self.previewed.take() == Some(target) {
            return Some(GoToAction::Send(target));
        }
        self.previewed = Some(target);
        Some(GoToAction::Preview(target))
    }
}

/// Shows the fields and the button in `rect`. The entered text stays after a refusal; the caller
/// shows [`GoToState::refusal`] below.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &GoToModel,
    state: &mut GoToState,
) -> Option<GoToAction> {
    let small = rect.height() < HEIGHT;
    let (field, gap) = if small { (26.0, 6.0) } else { (28.0, 8.0) };
    let row = |index: f32| {
        let top = rect.top() + index * (field + gap);
        Rect::from_min_max(pos2(rect.left(), top), pos2(rect.right(), top + field))
    };
    let mut entered = field_row(ui, row(0.0), Field::Azimuth, model, state);
    if model.elevation_range_deg.is_some() {
        entered |= field_row(ui, row(1.0), Field::Elevation, model, state);
    }
    let button = rect.with_min_y(row(2.0).top());
    let pressed = Button::normal("Go to").locked(model.locked).show(ui, "go to", button).clicked();
    state.typed = state.in_fields(model).filter(|_| !model.locked);
    if state.typed.is_none() {
        state.left = None;
    }
    if model.locked {
        state.previewed = None;
        state.refusal = None;
        return None;
    }
    if pressed {
        let target = state.read(model)?;
        state.leave_typed();
        return Some(GoToAction::Send(target));
    }
    let action = entered.then(|| state.enter(model)).flatten();
    if matches!(action, Some(GoToAction::Preview(_))) {
        state.left = None;
    }
    if matches!(action, Some(GoToAction::Send(_))) {
        state.leave_typed();
        // The next key press is again a shortcut of the window.
        ui.memory_mut(egui::Memory::stop_text_input);
    }
    action
}

/// Shows one field. Returns `true` if the operator pressed Enter in it.
fn field_row(
    ui: &mut Ui,
    row: Rect,
    field: Field,
    model: &GoToModel,
    state: &mut GoToState,
) -> bool {
    let t = theme::tokens(ui);
    let word = if field == Field::Azimuth { "Az" } else { "El" };
    paint::text(ui, row.left_center(), Align2::LEFT_CENTER, word, text::small(), t.t2);
    let rect = row.with_min_x(row.left() + LABEL);
    let (buffer, commanded) = match field {
        Field::Azimuth => (&mut state.azimuth, model.commanded_deg.0),
        Field::Elevation => (&mut state.elevation, model.commanded_deg.1),
    };
    let commanded = angle(commanded, model.decimals);
    let name = format!("Go to {}, degrees", field.name().to_lowercase());
    let id = ui.make_persistent_id(("go to", word));
    if model.locked {
        let shown = if buffer.is_empty() { &commanded } else { buffer };
        locked_field(ui, rect, id, &name, shown);
        return false;
    }
    let refused = state.refusal.as_ref().is_some_and(|(entry, _)| *entry == field);
    let response = AngleField { refused, hint: &commanded, name: &name }.show(ui, id, rect, buffer);
    if state.wants_focus && field == Field::Azimuth {
        state.wants_focus = false;
        input::focus_to_replace(ui, &response, buffer);
    }
    if response.changed() {
        state.previewed = None;
        if refused {
            state.refusal = None;
        }
    }
    let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if entered {
        response.request_focus();
    }
    entered
}

fn locked_field(ui: &Ui, rect: Rect, id: Id, name: &str, shown: &str) {
    let t = theme::tokens(ui);
    let response = ui.interact(rect, id, Sense::hover());
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::TextInput, false, name);
        info.current_text_value = Some(shown.to_owned());
        info
    });
    ui.painter().rect_filled(rect, RADIUS, t.bg0);
    paint::dashed_border(ui, rect, RADIUS, (1.0, t.edge));
    let room = rect.with_min_x(rect.left() + 9.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, shown, text::body(), t.t3);
}

#[cfg(test)]
mod tests;
