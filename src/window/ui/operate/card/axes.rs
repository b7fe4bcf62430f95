//! The axes of an antenna as the card shows them.

use crate::{
    astro::Angle,
    contract::antenna::AntennaModel,
    device::{AxisMotion, Capabilities, JogSpeeds, Measured, Pointing, SecondAxis},
    station::Mount,
    ui::{
        format,
        widgets::{
            axes_table::AxisRow,
            jog_pad::{JogDirection, JogKeys},
            travel_gauge::TravelModel,
        },
    },
};

pub(super) type Row = AxisRow<'static>;

/// Rows of the axes table.
pub(super) fn table(antenna: &AntennaModel) -> Vec<Row> {
    let snapshot = &antenna.snapshot;
    let actual = snapshot.state.measured.map(|measured| measured.pointing);
    let wanted = snapshot.aim.or(antenna.prediction.map(|prediction| prediction.direction.into()));
    let is_live = antenna.is_live();
    let rates = antenna.rates_deg_s.filter(|_| is_live);
    let error = wanted.zip(actual).filter(|_| is_live).map(|(wanted, actual)| {
        let off = |actual: Option<Angle>, wanted: Option<Angle>| {
            Some((actual? - wanted?).wrapped_180().degrees())
        };
        (off(actual.azimuth, wanted.azimuth), off(actual.elevation, wanted.elevation))
    });
    let azimuth_deg = |at: Pointing| at.azimuth.map(|azimuth| azimuth.wrapped_360().degrees());
    let elevation_deg = |at: Pointing| at.elevation.map(Angle::degrees);
    let azimuth = AxisRow {
        name: "Az",
        wanted_deg: wanted.and_then(azimuth_deg),
        actual_deg: actual.and_then(azimuth_deg),
        error_deg: error.and_then(|(azimuth, _)| azimuth),
        rate_deg_s: rates.map(|(azimuth, _)| azimuth),
    };
    let elevation = AxisRow {
        name: "El",
        wanted_deg: wanted.and_then(elevation_deg),
        actual_deg: actual.and_then(elevation_deg),
        error_deg: error.and_then(|(_, elevation)| elevation),
        rate_deg_s: rates.map(|(_, elevation)| elevation),
    };
    let has_elevation = antenna.variant().capabilities.has_elevation();
    std::iter::once(azimuth).chain(has_elevation.then_some(elevation)).collect()
}

/// Travel gauges, with the ends that the unit keeps to where it tells them. A rotator that turns something else gets none.
pub(super) fn travel(antenna: &AntennaModel) -> Vec<TravelModel<'static>> {
    let can = antenna.variant().capabilities;
    let state = &antenna.snapshot.state;
    let mount = antenna.config.mount;
    let [whole_deg, within_deg] =
        [mount, mount.clipped(state.travel_deg)].map(|it| it.travel_deg());
    let gauge = |index: usize| {
        let axis = state.measured.and_then(|measured| measured.axes.get(index).copied());
        let (name, whole_deg) = (can.axes.get(index)?, *whole_deg.get(index)?);
        let scale_deg = match mount {
            Mount::Xy { .. } => (0.0, 180.0),
            Mount::AzEl { .. } => whole_deg,
        };
        Some(TravelModel {
            name,
            scale_deg,
            travel_deg: *within_deg.get(index)?,
            position_deg: axis.and_then(|axis| axis.angle_deg),
            is_old: !antenna.is_live(),
            decimals: format::decimals(can, 1),
            lower_limit: axis.is_some_and(|axis| axis.minus_limit),
            upper_limit: axis.is_some_and(|axis| axis.plus_limit),
            turns: whole_deg.1 - whole_deg.0 > 360.0,
        })
    };
    (0..can.axis_count()).filter_map(gauge).collect()
}

/// The pair of axes that the jog keys turn.
pub(super) fn keys(antenna: &AntennaModel) -> JogKeys {
    let can = antenna.variant().capabilities;
    match (antenna.config.mount, can.second_axis) {
        (Mount::Xy { lower_axis_azimuth_deg, .. }, _) => xy_keys(lower_axis_azimuth_deg),
        (Mount::AzEl { .. }, SecondAxis::Elevation) => JogKeys::AzEl,
        (Mount::AzEl { .. }, SecondAxis::Other(_)) => {
            let [_, name] = can.axes;
            JogKeys::AzOther(name)
        }
        (Mount::AzEl { .. }, SecondAxis::Absent) => JogKeys::Az,
    }
}

/// The keys of an X/Y mount. From the zenith, X tilts across the lower axis and Y along it.
fn xy_keys(lower_axis_azimuth_deg: f64) -> JogKeys {
    let side = |from_axis_deg| format::side_of_sky(lower_axis_azimuth_deg + from_axis_deg);
    JogKeys::Xy {
        x_plus: side(90.0),
        x_minus: side(270.0),
        y_plus: side(0.0),
        y_minus: side(180.0),
    }
}

/// Directions in which a limit switch is set, or whose axis has no known angle or is absent.
pub(super) fn blocked(measured: Measured, can: Capabilities) -> Vec<JogDirection> {
    let unseen = measured.axes.map(|axis| axis.angle_deg.is_none() && !can.ends_jogs);
    let [x, y] = measured.axes;
    let [x_unseen, y_unseen] = unseen;
    let y_unseen = y_unseen || can.second_axis == SecondAxis::Absent;
    [
        (x.plus_limit || x_unseen, JogDirection::XPlus),
        (x.minus_limit || x_unseen, JogDirection::XMinus),
        (y.plus_limit || y_unseen, JogDirection::YPlus),
        (y.minus_limit || y_unseen, JogDirection::YMinus),
    ]
    .into_iter()
    .filter_map(|(set, direction)| set.then_some(direction))
    .collect()
}

/// A sentence about the axes that are not jogged because their angle is unknown.
pub(super) fn unseen(antenna: &AntennaModel) -> Option<String> {
    let can = antenna.variant().capabilities;
    let measured = antenna.snapshot.state.measured.filter(|_| !can.ends_jogs)?;
    let axis = match (measured.axes.map(|axis| axis.angle_deg.is_none()), can.second_axis) {
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

/// The signed rate of the jogged axis, degrees per second: measured for named speeds,
/// otherwise as commanded.
pub(super) fn rate_of_jog(antenna: &AntennaModel) -> Option<f64> {
    let can = antenna.variant().capabilities;
    let jog = antenna.snapshot.jog?;
    if can.jog == JogSpeeds::AnyRate {
        let measured = antenna.snapshot.state.measured?;
        return jog
            .into_iter()
            .zip(measured.axes)
            .find(|(rate, axis)| *rate != 0.0 && axis.motion != AxisMotion::Still)
            .map(|(rate, _)| rate);
    }
    let (azimuth, elevation) = antenna.rates_deg_s?;
    let [x, _] = jog;
    if x == 0.0 { can.has_elevation().then_some(elevation) } else { Some(azimuth) }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        contract::driver::{LinkState, Snapshot},
        station::Antenna,
    };

    #[test]
    fn the_travel_ends_where_the_unit_says_so() {
        let mut snapshot = Snapshot::before_anything(LinkState::Off);
        snapshot.state.travel_deg = [None, Some((5.0, 120.0))];
        let antenna = AntennaModel::new(Antenna::genius("Mast", ""), Arc::new(snapshot));
        let ends_deg: Vec<_> = travel(&antenna).into_iter().map(|axis| axis.travel_deg).collect();
        assert_eq!(ends_deg, [(0.0, 360.0), (5.0, 90.0)]);
    }
}
