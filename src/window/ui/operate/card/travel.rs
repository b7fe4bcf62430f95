//! Gauges for the travel of the axes.

use egui::{Align2, Ui};

use super::Cursor;
use crate::{
    contract::antenna::AntennaModel,
    station::Mount,
    ui::{
        format, text, theme,
        widgets::{
            paint,
            travel_gauge::{self, TravelModel},
        },
    },
};

/// Returns the gauges of the axes, with the ends that the unit reports. Returns none for a unit
/// that does not report its axes.
pub(super) fn gauges(antenna: &AntennaModel) -> Vec<TravelModel<'static>> {
    let capabilities = antenna.variant().capabilities;
    let state = &antenna.snapshot.state;
    let mount = antenna.config.mount;
    let [whole_deg, clipped_deg] =
        [mount, mount.clipped(state.travel_deg)].map(|mount| mount.travel_deg());
    let gauge = |index: usize| {
        let axis = state.measured.and_then(|measured| measured.axes.get(index).copied());
        let (name, whole_deg) = (capabilities.axes.get(index)?, *whole_deg.get(index)?);
        let scale_deg = match mount {
            Mount::Xy { .. } => (0.0, 180.0),
            Mount::AzEl { .. } => whole_deg,
        };
        Some(TravelModel {
            name,
            scale_deg,
            travel_deg: *clipped_deg.get(index)?,
            position_deg: axis.and_then(|axis| axis.angle_deg),
            is_old: !antenna.is_live(),
            decimals: format::decimals(capabilities, 1),
            lower_limit: axis.is_some_and(|axis| axis.minus_limit),
            upper_limit: axis.is_some_and(|axis| axis.plus_limit),
            turns: whole_deg.1 - whole_deg.0 > 360.0,
        })
    };
    (0..capabilities.axis_count()).filter_map(gauge).collect()
}

/// Shows the gauges; a full card adds a head.
pub(super) fn show(ui: &Ui, cursor: &mut Cursor, axes: &[TravelModel<'_>]) {
    let t = theme::tokens(ui);
    if !cursor.is_short() && !axes.is_empty() {
        cursor.skip(8.0);
        let head = cursor.take(18.0);
        let words = "Axis travel";
        paint::text(ui, head.left_center(), Align2::LEFT_CENTER, words, text::caption(), t.t3);
        if let Some(range) = common_range(axes) {
            paint::text(
                ui,
                head.right_center(),
                Align2::RIGHT_CENTER,
                range,
                text::caption(),
                t.t3,
            );
        }
    }
    for axis in axes {
        travel_gauge::show(ui, cursor.take(travel_gauge::HEIGHT), axis);
    }
}

/// Returns the travel in words, if it is the same for all axes.
fn common_range(axes: &[TravelModel<'_>]) -> Option<String> {
    let (low, high) = axes.first()?.travel_deg;
    let is_same = |deg: f64, other: f64| (deg - other).abs() < 0.05;
    let is_common =
        axes.iter().all(|axis| is_same(axis.travel_deg.0, low) && is_same(axis.travel_deg.1, high));
    is_common.then(|| format!("{low:.0}° to {high:.0}°").replace('-', "−"))
}

pub(super) fn in_words(axes: &[TravelModel<'_>]) -> String {
    let words: Vec<String> = axes
        .iter()
        .map(|axis| {
            let limit = if axis.lower_limit || axis.upper_limit { " limit" } else { "" };
            format!("{} {}{limit}", axis.name, axis.number())
        })
        .collect();
    words.join("  ")
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
        let ends_deg: Vec<_> = gauges(&antenna).into_iter().map(|axis| axis.travel_deg).collect();
        assert_eq!(ends_deg, [(0.0, 360.0), (5.0, 90.0)]);
    }
}
