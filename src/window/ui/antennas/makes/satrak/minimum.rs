//! Warning about a unit whose minimum elevation is below that of the station, and its remedy.

use egui::{Sense, Ui, vec2};

use crate::{
    controller::satrak::settings::{GENERAL, MINIMUM_ELEVATION_DEG},
    device::settings::Value,
    ui::{
        antennas::{form::Form, row, unit::ShownUnit},
        format,
        icons::Icon,
        theme,
        widgets::button::{Button, SMALL_HEIGHT},
    },
};

/// Offers the minimum elevation of the station as the new value.
pub(super) fn show(ui: &mut Ui, unit: &ShownUnit<'_>, form: &mut Form) {
    let station_deg = unit.antenna.config.limits.minimum_elevation_deg;
    let current = unit.values(GENERAL.key).and_then(|current| MINIMUM_ELEVATION_DEG.get(current));
    let Some(unit_deg) = current else { return };
    if unit_deg >= station_deg {
        return;
    }
    let t = theme::tokens(ui);
    let station = format::degrees(station_deg, 1);
    let reason = format!(
        "Minimum elevation: the unit points as low as {}, but the station's minimum is {station}.",
        format::degrees(unit_deg, 1)
    );
    row::note(ui, Some(Icon::Warning), &reason, t.warn);
    let (rect, _) =
        ui.allocate_exact_size(vec2(ui.available_width(), SMALL_HEIGHT), Sense::hover());
    let words = format!("Use the station's {station}");
    let button = Button::normal(&words);
    let place = rect.with_max_x(rect.left() + button.width(ui));
    if let Some(field) = GENERAL.field(MINIMUM_ELEVATION_DEG.name)
        && button.show(ui, "take minimum", place).clicked()
    {
        let text = field.kind.text(&Value::Decimal(station_deg));
        form.draft(GENERAL.key).type_in(field, text, unit.values(GENERAL.key));
    }
}
