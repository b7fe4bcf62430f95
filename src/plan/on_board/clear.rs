//! Whether a path keeps to what an antenna may do.

use jiff::Timestamp;

use super::Ability;
use crate::{
    astro::{Angle, AzEl, xy_mount},
    plan::{Barrier, Bounds, Sample},
    station::Mount,
};

/// A unit's clock, place and whole seconds move its path by about this much,
/// degrees: what goes less far beyond a bound runs along it.
const ALONG_DEG: f64 = 0.5;

/// A path leads where the antenna must not point.
#[derive(Debug, Clone, PartialEq)]
pub struct Trespass {
    /// When first.
    pub at: Timestamp,
    /// Where.
    pub direction: AzEl,
    /// Which bound.
    pub limit: OffLimits,
}

/// A bound of an antenna.
#[derive(Debug, Clone, PartialEq)]
pub enum OffLimits {
    /// Below its lowest elevation, degrees.
    Elevation {
        /// The lowest.
        lowest_deg: f64,
    },
    /// Beyond the travel of its axes.
    Travel,
    /// Inside what is forbidden at the site.
    Forbidden(Barrier),
}

/// Whether every sample of `path` is where the antenna may point: above its lowest
/// elevation, within the travel of its axes and outside what is forbidden.
pub fn path_is_clear(
    mut path: impl Iterator<Item = Sample>,
    ability: &Ability,
    bounds: &Bounds,
) -> Result<(), Trespass> {
    path.try_for_each(|Sample { time, direction }| {
        let forbidden = || bounds.at(time).forbids(direction).map(OffLimits::Forbidden);
        let limit = off_limits(direction, ability).or_else(forbidden);
        limit.map_or(Ok(()), |limit| Err(Trespass { at: time, direction, limit }))
    })
}

fn off_limits(direction: AzEl, ability: &Ability) -> Option<OffLimits> {
    let lowest_deg = ability.minimum_elevation.degrees();
    if direction.elevation_deg() < lowest_deg - ALONG_DEG {
        return Some(OffLimits::Elevation { lowest_deg });
    }
    (!is_within_travel(direction, ability.mount)).then_some(OffLimits::Travel)
}

fn is_within_travel(direction: AzEl, mount: Mount) -> bool {
    let Mount::Xy { lower_axis_azimuth_deg, .. } = mount else { return mount.reaches(direction) };
    let axes = xy_mount::axes_from_azel(direction, Angle::from_degrees(lower_axis_azimuth_deg));
    // The controller counts 90 at the zenith.
    let axes_deg = [axes.lower, axes.upper].map(|axis| axis.degrees() + 90.0);
    axes_deg.into_iter().zip(mount.travel_deg()).all(|(axis_deg, (from_deg, to_deg))| {
        (from_deg - ALONG_DEG..=to_deg + ALONG_DEG).contains(&axis_deg)
    })
}
