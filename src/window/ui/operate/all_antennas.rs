//! Unselected antennas and the ends of azimuth axes, for the sky plot.

use std::borrow::Cow;

use super::sky;
use crate::{
    astro::Angle,
    contract::antenna::AntennaModel,
    model::Model,
    station::Mount,
    ui::sky_plot::{AzimuthStop, Measured, OtherAntenna},
};

/// Max distance between ends that share one mark, degrees.
const SAME_DEG: f64 = 1.0;

/// Returns how long each antenna with a lost link has been silent, in the order of the station.
pub(super) fn silences(model: &Model) -> Vec<Option<String>> {
    model.antennas.iter().map(|antenna| sky::lost_for(model, antenna)).collect()
}

/// Returns the antennas with a known direction or azimuth, except the selected one.
pub(super) fn others<'a>(
    model: &'a Model,
    silences: &'a [Option<String>],
) -> Vec<OtherAntenna<'a>> {
    let antennas = model.antennas.iter().zip(silences).enumerate();
    let others = antennas.filter(|(index, _)| *index != model.selected_antenna);
    let shown = others.map(|(index, (antenna, lost))| {
        let measured = antenna.snapshot.state.measured?;
        let lost = lost.as_deref();
        Some(OtherAntenna {
            index,
            name: &antenna.config.name,
            commanded: sky::commanded(antenna),
            measured: measured.direction().map(|direction| Measured { direction, lost }),
            bearing: sky::bearing(antenna, lost),
        })
    });
    shown.flatten().collect()
}

/// Returns the ends of the azimuth axes, grouped by azimuth. With `all`, includes the antennas that
/// are not selected.
pub(super) fn stops(model: &Model, all: bool) -> Vec<AzimuthStop<'_>> {
    let mut stops: Vec<AzimuthStop<'_>> = Vec::new();
    let antennas = model.antennas.iter().enumerate();
    for (_, antenna) in antennas.filter(|(index, _)| all || *index == model.selected_antenna) {
        let name = antenna.config.name.as_str();
        for azimuth in ends(antenna).into_iter().flatten() {
            let off_deg =
                |stop: &AzimuthStop<'_>| (stop.azimuth - azimuth).wrapped_180().degrees().abs();
            match stops.iter_mut().find(|stop| off_deg(stop) < SAME_DEG) {
                None => stops.push(AzimuthStop { names: Cow::Borrowed(name), azimuth }),
                Some(stop) if stop.names.contains(name) => {}
                Some(stop) => stop.names = Cow::Owned(format!("{}, {name}", stop.names)),
            }
        }
    }
    stops
}

/// Returns both ends of an azimuth axis as directions in the sky, the CCW end first; `None` without
/// an azimuth axis.
pub(super) fn ends(antenna: &AntennaModel) -> Option<[Angle; 2]> {
    let mount = antenna.config.mount.clipped(antenna.snapshot.state.travel_deg);
    let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } = mount else { return None };
    Some([azimuth_from_deg, azimuth_to_deg].map(|deg| Angle::from_degrees(deg).wrapped_360()))
}
