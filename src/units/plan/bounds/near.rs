//! Clearances from barriers, computed only as far as a check needs them.

use super::{Angle, Barrier, aim::AimVectors, sun::SunAhead};
use crate::astro::Zone;

/// Barrier, and its distance from the direction of the antenna.
pub(super) struct Near<'a> {
    pub(super) name: BarrierName<'a>,
    pub(super) warns_only: bool,
    pub(super) angle: Clear<'a>,
}

/// Clearance from a barrier. A zone or the Sun costs time, so the clearance is computed on demand.
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

    /// Returns the clearance. If it is clearly at least `limit`, returns any angle between `limit`
    /// and the clearance.
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

    /// Returns a lower bound of the clearance for all directions in a box, if available at once.
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

    /// Returns the number of edges that a clearance check examines.
    pub(super) fn cost(&self) -> usize {
        match self.angle {
            Clear::Known(_) | Clear::OfSun { .. } => 1,
            Clear::OfZone { zone, .. } => zone.corners().len(),
        }
    }

    /// Returns the clearance if it is less than `limit`.
    pub(super) fn angle_below(&self, limit: Angle) -> Option<Angle> {
        Some(self.angle_unless_from(limit)).filter(|angle| *angle < limit)
    }
}

/// Name of a barrier, borrowed for a keep-out.
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
