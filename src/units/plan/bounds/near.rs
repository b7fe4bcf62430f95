//! Clearances from barriers, computed no further than a check needs them.

use super::{Angle, Barrier, aim::AimVectors, sun::SunAhead};
use crate::astro::Zone;

/// A barrier, and how near it is to where the antenna points.
pub(super) struct Near<'a> {
    pub(super) name: BarrierName<'a>,
    pub(super) warns_only: bool,
    pub(super) angle: Clear<'a>,
}

/// The clearance from a barrier. Those from a zone and the Sun cost time, so they are computed on
/// demand.
pub(super) enum Clear<'a> {
    Known(Angle),
    OfZone { zone: &'a Zone, margin: Angle, vectors: AimVectors },
    OfSun { sun: &'a SunAhead, vectors: AimVectors },
}

impl Near<'_> {
    pub(super) fn angle(&self) -> Angle {
        match self.angle {
            Clear::Known(angle) => angle,
            Clear::OfZone { zone, margin, vectors } => {
                vectors.min_clearance(|point| zone.clearance_of(point)) - margin
            }
            Clear::OfSun { sun, vectors } => vectors.min_clearance(|point| sun.clearance_of(point)),
        }
    }

    /// The clearance; where that is clearly no less than `limit`, an angle from `limit` up to it.
    pub(super) fn angle_unless_from(&self, limit: Angle) -> Angle {
        match self.angle {
            Clear::Known(angle) => angle,
            Clear::OfZone { zone, margin, vectors } => vectors.min_clearance(|point| {
                let min = zone.clearance_lower_bound(point) - margin;
                if min >= limit { min } else { zone.clearance_of(point) - margin }
            }),
            Clear::OfSun { sun, vectors } => vectors.min_clearance(|point| {
                let bound = sun.clearance_lower_bound(point);
                if bound >= limit { bound } else { sun.clearance_of(point) }
            }),
        }
    }

    /// A clearance that no direction in a box falls below, as far as that is known at once.
    pub(super) fn lower_bound_in_box(
        &self,
        azimuths: (Angle, Angle),
        elevations: (Angle, Angle),
    ) -> Option<Angle> {
        match self.angle {
            Clear::Known(_) | Clear::OfSun { .. } => None,
            Clear::OfZone { zone, margin, .. } => {
                Some(zone.box_clearance_lower_bound(azimuths, elevations) - margin)
            }
        }
    }

    /// Number of edges that a look at the clearance goes through.
    pub(super) fn cost(&self) -> usize {
        match self.angle {
            Clear::Known(_) | Clear::OfSun { .. } => 1,
            Clear::OfZone { zone, .. } => zone.corners().len(),
        }
    }

    /// The clearance if it is less than `limit`.
    pub(super) fn angle_below(&self, limit: Angle) -> Option<Angle> {
        Some(self.angle_unless_from(limit)).filter(|angle| *angle < limit)
    }
}

/// A barrier with a borrowed name.
#[derive(Debug, Clone, Copy)]
pub(super) enum BarrierName<'a> {
    MinimumElevation,
    KeepOut(&'a str),
    Sun,
}

impl BarrierName<'_> {
    pub(super) fn clone_of(self) -> Barrier {
        match self {
            Self::MinimumElevation => Barrier::MinimumElevation,
            Self::KeepOut(name) => Barrier::KeepOut(name.into()),
            Self::Sun => Barrier::Sun,
        }
    }
}
