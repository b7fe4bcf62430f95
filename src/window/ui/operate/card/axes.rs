//! Axes of an antenna on the card.

use egui::Ui;

use super::Cursor;
use crate::{
    astro::Angle,
    contract::antenna::AntennaModel,
    device::{AxisMotion, JogSpeeds, Pointing, SecondAxis},
    model::Model,
    station::Mount,
    ui::{
        format,
        widgets::{
            axes_table::{self, AxesTable, AxisRow, WantedColumn},
            jog_pad::{JogDirection, JogKeys},
        },
    },
};

/// Returns the direction in which the antenna is to point.
fn demanded(antenna: &AntennaModel) -> Option<Pointing> {
    antenna.snapshot.aim.or(antenna.prediction.map(|prediction| prediction.direction.into()))
}

/// Returns the source of the demanded direction.
fn wanted_column(antenna: &AntennaModel) -> WantedColumn {
    if antenna.snapshot.aim.is_none() && antenna.prediction.is_some() {
        WantedColumn::Predicted
    } else {
        WantedColumn::Command
    }
}

/// Returns azimuth and elevation, degrees.
fn in_degrees(pointing: Option<Pointing>) -> [Option<f64>; 2] {
    let azimuth = pointing.and_then(|pointing| pointing.azimuth).map(Angle::wrapped_360);
    [azimuth, pointing.and_then(|pointing| pointing.elevation)]
        .map(|angle| angle.map(Angle::degrees))
}

/// Returns the direction in which the antenna is to point, degrees, and the decimals to show.
pub(super) fn commanded(model: &Model, antenna: &AntennaModel) -> ([Option<f64>; 2], usize) {
    let predicted = model.appearance.angle_decimals as usize;
    let unit_decimals = format::decimals(antenna.variant().capabilities, predicted);
    (in_degrees(demanded(antenna)), wanted_column(antenna).decimals(unit_decimals, predicted))
}

/// Shows the table of the axes.
pub(super) fn show(ui: &Ui, cursor: &mut Cursor, model: &Model, antenna: &AntennaModel) {
    let capabilities = antenna.variant().capabilities;
    let (is_live, measured) = (antenna.is_live(), antenna.snapshot.state.measured);
    let (demanded, actual) = (demanded(antenna), measured.map(|measured| measured.pointing));
    let error_deg = |angle: fn(Pointing) -> Option<Angle>| {
        let (demanded, actual) = demanded.zip(actual).filter(|_| is_live)?;
        Some((angle(actual)? - angle(demanded)?).wrapped_180().degrees())
    };
    let rates = antenna.rates_deg_s.filter(|_| is_live);
    let ([wanted_az, wanted_el], [actual_az, actual_el]) =
        (in_degrees(demanded), in_degrees(actual));
    let azimuth = AxisRow {
        name: "Az",
        wanted_deg: wanted_az,
        actual_deg: actual_az,
        error_deg: error_deg(|pointing| pointing.azimuth),
        rate_deg_s: rates.map(|(azimuth, _)| azimuth),
    };
    let elevation = AxisRow {
        name: "El",
        wanted_deg: wanted_el,
        actual_deg: actual_el,
        error_deg: error_deg(|pointing| pointing.elevation),
        rate_deg_s: rates.map(|(_, elevation)| elevation),
    };
    let rows = [azimuth, elevation];
    let axes = if capabilities.has_elevation() { &rows[..] } else { &rows[..1] };
    let age = measured.filter(|_| !is_live).map(|measured| {
        let age = model.steady.saturating_duration_since(measured.requested);
        format::age(age.as_secs_f64())
    });
    let predicted_decimals = model.appearance.angle_decimals as usize;
    let table = AxesTable {
        wanted_column: wanted_column(antenna),
        decimals: format::decimals(capabilities, predicted_decimals),
        predicted_decimals,
        age: age.as_deref(),
        axes,
    };
    axes_table::show(ui, cursor.take(axes_table::height(axes.len())), &table);
}

/// Returns the pair of axes that the jog keys turn.
pub(super) fn keys(antenna: &AntennaModel) -> JogKeys {
    let capabilities = antenna.variant().capabilities;
    match (antenna.config.mount, capabilities.second_axis) {
        (Mount::Xy { lower_axis_azimuth_deg, .. }, _) => xy_keys(lower_axis_azimuth_deg),
        (Mount::AzEl { .. }, SecondAxis::Elevation) => JogKeys::AzEl,
        (Mount::AzEl { .. }, SecondAxis::Other(_)) => {
            let [_, name] = capabilities.axes;
            JogKeys::AzOther(name)
        }
        (Mount::AzEl { .. }, SecondAxis::Absent) => JogKeys::Az,
    }
}

/// Returns the keys of an X/Y mount. From the zenith, X tilts across the lower axis and Y along it.
fn xy_keys(lower_axis_azimuth_deg: f64) -> JogKeys {
    let side = |from_axis_deg| format::side_of_sky(lower_axis_azimuth_deg + from_axis_deg);
    JogKeys::Xy {
        x_plus: side(90.0),
        x_minus: side(270.0),
        y_plus: side(0.0),
        y_minus: side(180.0),
    }
}

/// Returns the blocked directions: a limit switch is set, or the axis is absent or has no known
/// angle.
pub(super) fn blocked(antenna: &AntennaModel) -> Vec<JogDirection> {
    let capabilities = antenna.variant().capabilities;
    let Some(measured) = antenna.snapshot.state.measured else { return Vec::new() };
    let is_unknown = measured.axes.map(|axis| axis.angle_deg.is_none() && !capabilities.ends_jogs);
    let [x, y] = measured.axes;
    let [x_unknown, y_unknown] = is_unknown;
    let y_unknown = y_unknown || capabilities.second_axis == SecondAxis::Absent;
    [
        (x.plus_limit || x_unknown, JogDirection::XPlus),
        (x.minus_limit || x_unknown, JogDirection::XMinus),
        (y.plus_limit || y_unknown, JogDirection::YPlus),
        (y.minus_limit || y_unknown, JogDirection::YMinus),
    ]
    .into_iter()
    .filter_map(|(is_blocked, direction)| is_blocked.then_some(direction))
    .collect()
}

/// Returns a sentence about the axes that the operator cannot jog because their angle is unknown.
pub(super) fn unknown_axis_note(antenna: &AntennaModel) -> Option<String> {
    let capabilities = antenna.variant().capabilities;
    let measured = antenna.snapshot.state.measured.filter(|_| !capabilities.ends_jogs)?;
    let axis = match (measured.axes.map(|axis| axis.angle_deg.is_none()), capabilities.second_axis)
    {
        ([false, false], _) | ([false, _], SecondAxis::Absent) => return None,
        ([true, true], SecondAxis::Elevation | SecondAxis::Other(_)) => {
            return Some("No angle is known, so neither axis can be turned by hand.".to_owned());
        }
        ([true, _], SecondAxis::Absent) => "azimuth",
        ([true, false], _) => "first axis",
        ([false, true], SecondAxis::Elevation) => "elevation",
        ([false, true], SecondAxis::Other(name)) => name,
    };
    Some(format!("The {axis} has no known angle and cannot be turned by hand."))
}

/// Returns the signed rate of the jogged axis, degrees per second: measured for named speeds,
/// otherwise as commanded.
pub(super) fn jog_rate_deg_s(antenna: &AntennaModel) -> Option<f64> {
    let capabilities = antenna.variant().capabilities;
    let jog = antenna.snapshot.jog?;
    if capabilities.jog == JogSpeeds::AnyRate {
        let measured = antenna.snapshot.state.measured?;
        return jog
            .into_iter()
            .zip(measured.axes)
            .find(|(rate, axis)| *rate != 0.0 && axis.motion != AxisMotion::Still)
            .map(|(rate, _)| rate);
    }
    let (azimuth, elevation) = antenna.rates_deg_s?;
    let [x, _] = jog;
    if x == 0.0 { capabilities.has_elevation().then_some(elevation) } else { Some(azimuth) }
}
