//! Check of a path against the limits of an antenna.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Ability, path::NoDirection};
use crate::{
    astro::{Angle, AzEl, xy_mount},
    plan::{Barrier, Bounds, Sample},
    station::Mount,
};

/// Typical shift of a path by the clock, location and whole seconds of a unit, degrees. A path that
/// exceeds a bound by less counts as running along it.
pub const ALONG_DEG: f64 = 0.5;

/// First position at which a path leaves the limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trespass {
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub direction: AzEl,
    pub limit: OffLimits,
}

/// Reason why a unit may not track a path on its own.
#[derive(Debug, Clone, PartialEq)]
pub enum NotClear {
    Leads(Trespass),
    /// Unknown path: the elements yield no direction at this time.
    NoDirection(Timestamp),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum OffLimits {
    /// Position below the minimum elevation `lowest_deg`, degrees.
    Elevation { lowest_deg: f64 },
    /// Position beyond the travel of the axes.
    Travel,
    /// Position inside a keep-out or the surroundings of the Sun.
    Forbidden(Barrier),
}

/// Checks that every sample of `path` is above the minimum elevation, within travel and outside
/// keep-outs.
pub(super) fn path_is_clear(
    mut path: impl Iterator<Item = Result<Sample, NoDirection>>,
    ability: &Ability,
    bounds: &Bounds,
) -> Result<(), NotClear> {
    path.try_for_each(|sample| {
        let Sample { time, direction } =
            sample.map_err(|NoDirection(utc)| NotClear::NoDirection(utc))?;
        let forbidden = || bounds.at_time(time).forbids(direction).map(OffLimits::Forbidden);
        let limit = off_limits(direction, ability).or_else(forbidden);
        let leads = |limit| NotClear::Leads(Trespass { time, direction, limit });
        limit.map_or(Ok(()), |limit| Err(leads(limit)))
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
    // The controller counts 90 degrees at the zenith.
    let axes_deg = [axes.lower, axes.upper].map(|axis| axis.degrees() + 90.0);
    axes_deg.into_iter().zip(mount.travel_deg()).all(|(axis_deg, (from_deg, to_deg))| {
        (from_deg - ALONG_DEG..=to_deg + ALONG_DEG).contains(&axis_deg)
    })
}
