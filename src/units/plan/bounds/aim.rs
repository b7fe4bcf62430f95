//! Directions of an antenna: by its axes, and on the sky.
//!
//! Keep-outs and the Sun apply to both directions, because the pointing model may be wrong. The
//! minimum elevation applies to the axes alone.

use glam::DVec3;

use super::{Angle, AzEl, Bounds, BoundsAt};
use crate::astro::PointingModel;

/// Directions of one position of the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Aim {
    /// Direction by the axes alone, without the pointing model.
    pub(super) axes: AzEl,
    /// Direction of the beam; `None` without a pointing model and without axis offsets.
    pub(super) sky: Option<AzEl>,
}

impl Aim {
    pub(super) fn directions(self) -> impl Iterator<Item = AzEl> {
        std::iter::once(self.axes).chain(self.sky)
    }

    pub(super) fn to_enu(self) -> AimVectors {
        AimVectors { axes: self.axes.to_enu(), sky: self.sky.map(AzEl::to_enu) }
    }
}

/// [`Aim`] as unit vectors.
#[derive(Debug, Clone, Copy)]
pub(super) struct AimVectors {
    axes: DVec3,
    sky: Option<DVec3>,
}

impl AimVectors {
    /// Returns the smaller clearance of both directions.
    pub(super) fn min_clearance(self, clearance: impl Fn(DVec3) -> Angle) -> Angle {
        let by_axes = clearance(self.axes);
        self.sky.map(clearance).filter(|on_sky| *on_sky < by_axes).unwrap_or(by_axes)
    }
}

/// Returns the beam direction for these angles of the axes. Past the zenith, the direction of the
/// axes has another azimuth and elevation, to which the model does not apply.
fn on_the_sky(model: &PointingModel, [first_deg, second_deg]: [f64; 2]) -> AzEl {
    model.direction(AzEl::from_degrees(first_deg, second_deg))
}

impl Bounds {
    pub(super) fn aim(&self, axes_deg: [f64; 2]) -> Aim {
        let sky = self.model.as_ref().map(|model| on_the_sky(model, axes_deg));
        Aim { axes: self.direction(axes_deg), sky }
    }
}

impl BoundsAt<'_> {
    pub(super) fn aim(&self, axes_deg: [f64; 2]) -> Aim {
        let sky = self.model.as_ref().map(|model| on_the_sky(model, axes_deg));
        self.shifted(self.bounds.direction(axes_deg), sky)
    }

    /// Returns the aim of axes on this side of the zenith that count `direction`.
    pub(super) fn aim_at(&self, direction: AzEl) -> Aim {
        self.shifted(direction, self.model.as_ref().map(|model| model.direction(direction)))
    }

    fn shifted(&self, axes: AzEl, sky: Option<AzEl>) -> Aim {
        let Some(to_sky) = self.to_sky else { return Aim { axes, sky } };
        let sky = to_sky * sky.unwrap_or(axes).to_enu();
        Aim { axes, sky: Some(AzEl::from_enu(sky)) }
    }
}
