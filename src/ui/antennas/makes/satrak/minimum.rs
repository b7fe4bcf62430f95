//! The lowest elevation of a unit that goes lower than the station allows.

use egui::{Sense, Ui, vec2};

use crate::{
    device::settings::Value,
    ui::{
        antennas::{form::Form, row, unit::Unit},
        format,
        icons::Icon,
        theme,
        widgets::button::{Button, SMALL_HEIGHT},
    },
};

const GROUP: &str = "general";
const FIELD: &str = "minimum_elevation_deg";

/// Fills the lowest elevation of the station in, to be applied.
pub(super) fn show(ui: &mut Ui, unit: &Unit<'_>, form: &mut Form) {
    let station_deg = unit.antenna.config.limits.minimum_elevation_deg;
    let held = unit.values(GROUP).and_then(|held| held.get(FIELD));
    let Some(Value::Decimal(unit_deg)) = held else { return };
    if *unit_deg >= station_deg {
        return;
    }
    let t = theme::tokens(ui);
    let station = format::degrees(station_deg, 1);
    let why = format!(
        "The unit points down to {} by itself, the station allows {station}.",
        format::degrees(*unit_deg, 1)
    );
    row::note(ui, Some(Icon::Warning), &why, t.warn);
    let (rect, _) =
        ui.allocate_exact_size(vec2(ui.available_width(), SMALL_HEIGHT), Sense::hover());
    let words = format!("Take {station} from the station");
    let button = Button::normal(&words);
    let place = rect.with_max_x(rect.left() + button.width(ui));
    let field = super::group(GROUP).and_then(|group| group.field(FIELD));
    if let Some(field) = field
        && button.show(ui, "take minimum", place).clicked()
    {
        let text = field.kind.text(&Value::Decimal(station_deg));
        form.draft(GROUP).type_in(field, text, unit.values(GROUP));
    }
}
