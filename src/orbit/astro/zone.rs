//! A region of the sky of a site, bounded by edges between corners.

mod cap;
mod crossing;
mod edge;
mod extent;

use std::f64::consts::PI;

use glam::DVec3;

use self::{cap::ZoneCap, edge::Edge, extent::Extent};
use super::{Angle, AzEl};

pub const MIN_CORNERS: usize = 3;
pub const MAX_CORNERS: usize = 100;

/// Max distance between directions that count as the same, radians.
const SAME: f64 = 1e-9;

/// A polygon on the sphere of directions. An edge between corners of equal elevation is an arc of
/// that elevation that spans the azimuths as given. Any other edge is the shorter great circle. The
/// inside is the side that does not contain the nadir.
///
/// Azimuths may continue past north: from 350 to 370 degrees an edge is 20 degrees long, from 350
/// to 10 degrees it goes back by 340. A last corner that is the first corner plus a turn closes the
/// polygon: 0, 120, 240, 360 degrees at one elevation make a cap around the zenith.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    corners: Vec<AzEl>,
    edges: Vec<Edge>,
    cap: ZoneCap,
    extent: Option<Extent>,
}

/// Reason why corners do not make a zone. Corners and edges are counted from 1. Edge 1 leads from
/// corner 1 to corner 2, and the last edge leads back to corner 1.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ZoneError {
    #[error("a zone needs at least {MIN_CORNERS} corners")]
    TooFewCorners,
    #[error("a zone has at most {MAX_CORNERS} corners")]
    TooManyCorners,
    /// The azimuth is infinite or NaN.
    #[error("the azimuth of corner {corner} is not a number")]
    Azimuth { corner: usize },
    /// The elevation is beyond the zenith or the nadir, or NaN.
    #[error("the elevation of corner {corner} is not between -90 and 90 degrees")]
    Elevation { corner: usize },
    #[error("edge {edge} has no length: its two corners are the same direction")]
    NoLength { edge: usize },
    /// An arc of constant elevation spans more than 360 degrees.
    #[error("edge {edge} turns by more than 360 degrees")]
    MoreThanATurn { edge: usize },
    /// Infinitely many great circles join opposite directions.
    #[error("edge {edge} joins opposite directions: a corner between them is needed")]
    Opposite { edge: usize },
    /// An edge through the nadir leaves the inside undefined, because the inside is the side
    /// without the nadir.
    #[error("edge {edge} passes through the nadir")]
    Nadir { edge: usize },
    /// Two edges share a point that is not a corner of both.
    #[error("edges {first} and {second} cross or touch each other")]
    Crossing { first: usize, second: usize },
    #[error("the corners lie on one line: the zone has no area")]
    NoArea,
}

impl Zone {
    /// Creates a zone of 3 to 100 corners with elevations of -90 to 90 degrees, in the order of its
    /// edges. The edge from the last corner to the first closes the zone.
    pub fn new(corners: Vec<AzEl>) -> Result<Self, ZoneError> {
        if corners.len() < MIN_CORNERS {
            return Err(ZoneError::TooFewCorners);
        }
        if corners.len() > MAX_CORNERS {
            return Err(ZoneError::TooManyCorners);
        }
        for (corner, direction) in (1..).zip(&corners) {
            if !direction.azimuth.is_finite() {
                return Err(ZoneError::Azimuth { corner });
            }
            // The negated test also refuses NaN.
            if !(-90.0..=90.0).contains(&direction.elevation_deg()) {
                return Err(ZoneError::Elevation { corner });
            }
        }
        let ends = corners.iter().zip(corners.iter().cycle().skip(1)).enumerate();
        let mut edges = Vec::with_capacity(corners.len());
        for (index, (start, end)) in ends {
            let closes = index + 1 == corners.len() && is_a_turn_on(*end, *start);
            if !closes {
                edges.push(Edge::new(*start, *end, index + 1)?);
            }
        }
        crossing::check(&edges)?;
        let cap = ZoneCap::enclosing(&edges);
        let extent = Extent::enclosing(&edges);
        Ok(Self { corners, edges, cap, extent })
    }

    /// Returns the corners as given.
    pub fn corners(&self) -> &[AzEl] {
        &self.corners
    }

    /// Returns the angle from `direction` to the nearest edge: positive outside, negative inside.
    /// The clearances of two directions differ by no more than the angle between the directions.
    pub fn clearance(&self, direction: AzEl) -> Angle {
        self.clearance_of(direction.to_enu())
    }

    /// Returns a lower bound of [`Self::clearance_of`] the unit vector `point`, at a fraction of
    /// the cost. The bound is good enough if the zone is far away.
    pub fn clearance_lower_bound(&self, point: DVec3) -> Angle {
        let clearance = self.cap.clearance(point);
        Angle::from_radians(if clearance > 0.0 { clearance } else { -PI })
    }

    /// Returns a lower bound of the clearance of every direction in a box of azimuths and
    /// elevations. Each range goes from the lower to the upper end. The bound is useful if the box
    /// is above, below or beside the zone; elsewhere it is -180 degrees.
    pub fn box_clearance_lower_bound(
        &self,
        azimuths: (Angle, Angle),
        elevations: (Angle, Angle),
    ) -> Angle {
        let radians = |(start, end): (Angle, Angle)| (start.radians(), end.radians());
        let clearance =
            self.extent.map(|extent| extent.clearance(radians(azimuths), radians(elevations)));
        Angle::from_radians(clearance.filter(|clearance| *clearance > 0.0).unwrap_or(-PI))
    }

    /// Returns the same as [`Self::clearance`] for a unit vector (east, north, up).
    pub fn clearance_of(&self, point: DVec3) -> Angle {
        let elevation = point.z.atan2(point.x.hypot(point.y));
        let azimuth = point.x.atan2(point.y);
        let mut nearest = f64::INFINITY;
        let mut crossed = 0_i64;
        for edge in &self.edges {
            nearest = nearest.min(edge.chord_squared(point, azimuth, elevation));
            crossed += edge.crossings_below(point, azimuth, elevation);
        }
        // The chord stays precise near zero, unlike the cosine.
        let distance = 2.0 * (nearest.sqrt() / 2.0).min(1.0).asin();
        let is_inside = crossed % 2 != 0;
        Angle::from_radians(if is_inside { -distance } else { distance })
    }

    /// Returns points along the edges, including each corner, no more than `step` (at least 0.01
    /// degrees) apart. The points lead from the first corner all the way around and back to it.
    /// Azimuths are from 0 to 360 degrees.
    pub fn edges_sampled(&self, step: Angle) -> impl Iterator<Item = AzEl> + '_ {
        let step = step.radians().max(0.01_f64.to_radians());
        let first = self.corners.first().map(|first| AzEl::from_enu(first.to_enu()));
        self.edges.iter().flat_map(move |edge| edge.points(step)).chain(first)
    }

    /// Returns points around the zone at the distance `margin`, about `step` (at least 0.01
    /// degrees) apart, in the order of the edges. Around a simple zone, the points cover all
    /// directions with this clearance. Without a margin, the list is empty.
    pub fn margin_sampled(&self, margin: Angle, step: Angle) -> Vec<AzEl> {
        let step = step.radians().max(0.01_f64.to_radians());
        if margin.radians() <= 0.0 {
            return Vec::new();
        }
        let mut points = Vec::new();
        let before = self.edges.iter().cycle().skip(self.edges.len().saturating_sub(1));
        for (edge, before) in self.edges.iter().zip(before) {
            let (Some(arriving), Some(leaving)) =
                (self.outward(before, 1.0), self.outward(edge, 0.0))
            else {
                continue;
            };
            points.extend(fan(edge.point_at(0.0), arriving, leaving, margin.radians(), step));
            let parts = (edge.length() / step).ceil().max(1.0) as u32;
            points.extend((1..parts).filter_map(|part| {
                let share = f64::from(part) / f64::from(parts);
                let outward = self.outward(edge, share)?;
                Some(away_from(edge.point_at(share), outward, margin.radians()))
            }));
        }
        // Points that are too near come from the inside of a bend.
        let min = margin.radians() - 1e-6;
        let points = points.into_iter().map(AzEl::from_enu);
        points.filter(|point| self.clearance(*point).radians() >= min).collect()
    }

    /// Returns the direction away from the zone, perpendicular to `edge` at `share` of its length.
    fn outward(&self, edge: &Edge, share: f64) -> Option<DVec3> {
        let point = edge.point_at(share);
        let across = edge.across(share);
        [across, -across].into_iter().find(|side| {
            let inwards = share.clamp(1e-3, 1.0 - 1e-3);
            let probe =
                away_from(edge.point_at(inwards), edge.across(inwards) * side.dot(across), 1e-6);
            point.is_finite() && self.clearance(AzEl::from_enu(probe)).radians() > 0.0
        })
    }

    /// Returns the middle of the edge from corner `index` (from 0) to the next corner; `None`
    /// without such an edge. Its azimuth continues from the corner's without wrapping.
    pub fn middle_of_edge(&self, index: usize) -> Option<AzEl> {
        let (edge, start) = (self.edges.get(index)?, self.corners.get(index)?);
        let middle = AzEl::from_enu(edge.point_at(0.5));
        let turned = (middle.azimuth - start.azimuth).wrapped_180();
        let azimuth = match edge.turn() {
            Some(turn) => start.azimuth + Angle::from_radians(turn / 2.0),
            None => start.azimuth + turned,
        };
        Some(AzEl { azimuth, elevation: middle.elevation })
    }
}

/// Returns `true` if `a` and `b` are the same direction with azimuths one or more turns apart.
fn is_a_turn_on(a: AzEl, b: AzEl) -> bool {
    let is_counted_on = (a.azimuth - b.azimuth).abs().degrees() > 180.0;
    is_counted_on && is_same(a.to_enu(), b.to_enu())
}

/// Returns the point at `angle` from `point` in `direction`, which is perpendicular to `point`.
fn away_from(point: DVec3, direction: DVec3, angle: f64) -> DVec3 {
    point * angle.cos() + direction * angle.sin()
}

/// Returns points at `angle` around `corner`, from one perpendicular direction to another.
fn fan(corner: DVec3, start: DVec3, end: DVec3, turn: f64, step: f64) -> Vec<DVec3> {
    let angle = start.cross(end).length().atan2(start.dot(end));
    let parts = (angle * turn / step).ceil().max(1.0) as u32;
    let turned = |part: u32| {
        let share = f64::from(part) / f64::from(parts);
        let mixed = start * ((1.0 - share) * angle).sin() + end * (share * angle).sin();
        away_from(corner, mixed.try_normalize().unwrap_or(start), turn)
    };
    (0..=parts).map(turned).collect()
}

fn is_same(a: DVec3, b: DVec3) -> bool {
    a.distance_squared(b) < SAME * SAME
}

#[cfg(test)]
mod tests;
