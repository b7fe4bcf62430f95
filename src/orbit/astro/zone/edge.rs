//! One edge of a zone.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::{SAME, ZoneError, is_same};
use crate::astro::{Angle, AzEl};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    pub(super) start: DVec3,
    pub(super) end: DVec3,
    pub(super) from_azimuth: f64,
    to_azimuth: f64,
    /// Change of azimuth from start to end, radians, signed.
    pub(super) turn: f64,
    pub(super) shape: Shape,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// Shorter great circle; `normal` has length 1.
    GreatCircle { normal: DVec3 },
    /// Arc of constant elevation, radians.
    Arc { elevation: f64 },
}

impl Edge {
    pub(super) fn new(start: AzEl, end: AzEl, edge: usize) -> Result<Self, ZoneError> {
        let (a, b) = (start.to_enu(), end.to_enu());
        let is_level = (start.elevation - end.elevation).abs().radians() < SAME;
        let counted = (end.azimuth - start.azimuth).radians();
        let is_full_turn = is_level && counted.abs() > PI;
        if is_same(a, b) && !is_full_turn {
            return Err(ZoneError::NoLength { edge });
        }
        let made = |turn, shape| Self {
            start: a,
            end: b,
            from_azimuth: start.azimuth.radians(),
            to_azimuth: end.azimuth.radians(),
            turn,
            shape,
        };
        if is_level {
            if counted.abs() > TAU + SAME {
                return Err(ZoneError::MoreThanATurn { edge });
            }
            if start.elevation.radians() < SAME - FRAC_PI_2 {
                return Err(ZoneError::Nadir { edge });
            }
            let elevation = start.elevation.radians();
            return Ok(made(counted, Shape::Arc { elevation }));
        }
        let across = a.cross(b);
        if is_same(a, -b) {
            return Err(ZoneError::Opposite { edge });
        }
        let turn = Angle::from_radians(counted).wrapped_180().radians();
        let circle = made(turn, Shape::GreatCircle { normal: across.normalize() });
        if circle.chord_squared(DVec3::NEG_Z, 0.0, -FRAC_PI_2) < SAME * SAME {
            return Err(ZoneError::Nadir { edge });
        }
        Ok(circle)
    }

    /// Returns the change of azimuth along an arc of constant elevation, radians; `None` for a
    /// great circle.
    pub(super) fn turn(&self) -> Option<f64> {
        matches!(self.shape, Shape::Arc { .. }).then_some(self.turn)
    }

    /// Returns the square of the straight-line distance from the direction `point` to the nearest
    /// point of the edge.
    pub(super) fn chord_squared(&self, point: DVec3, azimuth: f64, elevation: f64) -> f64 {
        let along_edge = match self.shape {
            Shape::GreatCircle { normal } if self.spans(point, normal) => {
                let off_squared = normal.dot(point).powi(2).min(1.0);
                // This is the squared chord of an angle, from the square of its sine.
                2.0 * off_squared / (1.0 + (1.0 - off_squared).sqrt())
            }
            Shape::Arc { elevation: level } if self.turns_past(azimuth) => {
                (2.0 * ((elevation - level) / 2.0).sin()).powi(2)
            }
            Shape::GreatCircle { .. } | Shape::Arc { .. } => f64::INFINITY,
        };
        along_edge.min(point.distance_squared(self.start)).min(point.distance_squared(self.end))
    }

    /// Returns `true` if the point of the great circle nearest to `point` lies between the ends.
    pub(super) fn spans(&self, point: DVec3, normal: DVec3) -> bool {
        normal.cross(self.start).dot(point) >= 0.0 && self.end.cross(normal).dot(point) >= 0.0
    }

    /// Returns `true` if the azimuth lies between the ends of an arc of constant elevation.
    pub(super) fn turns_past(&self, azimuth: f64) -> bool {
        let start = if self.turn < 0.0 { self.to_azimuth } else { self.from_azimuth };
        (azimuth - start).rem_euclid(TAU) <= self.turn.abs()
    }

    /// Returns the number of times that the edge crosses the vertical line from the direction
    /// `point` down to the nadir. Crossings in the opposite sense count as negative.
    pub(super) fn crossings_below(&self, point: DVec3, azimuth: f64, elevation: f64) -> i64 {
        // Both edges of a corner compute its position relative to the line in the same way. A line
        // through a corner is therefore crossed once or not at all.
        let turn_to = |corner: f64| (corner - azimuth).rem_euclid(TAU);
        let (start, end) = (turn_to(self.from_azimuth), turn_to(self.to_azimuth));
        let crossings = ((start + self.turn - end) / TAU).round() as i64;
        if crossings == 0 {
            return 0;
        }
        let is_below = match self.shape {
            Shape::Arc { elevation: level } => level < elevation,
            Shape::GreatCircle { .. } => {
                let (sin, cos) = azimuth.sin_cos();
                let side = DVec3::new(cos, -sin, 0.0);
                let (first, last) = (side.dot(self.start).abs(), side.dot(self.end).abs());
                let crossing = if first + last > 0.0 {
                    self.start * last + self.end * first
                } else {
                    self.start
                };
                let outward = crossing.x * sin + crossing.y * cos;
                outward > 0.0 && crossing.z * point.x.hypot(point.y) < point.z * outward
            }
        };
        if is_below { crossings } else { 0 }
    }

    /// Returns the point at `share` (0 to 1) of the length.
    pub(super) fn point_at(&self, share: f64) -> DVec3 {
        match self.shape {
            Shape::GreatCircle { normal } => {
                let (sin, cos) = (self.length() * share).sin_cos();
                self.start * cos + normal.cross(self.start) * sin
            }
            Shape::Arc { elevation } => AzEl {
                azimuth: Angle::from_radians(self.from_azimuth + self.turn * share),
                elevation: Angle::from_radians(elevation),
            }
            .to_enu(),
        }
    }

    /// Returns the direction perpendicular to the edge at `share` of its length, a unit vector.
    pub(super) fn across(&self, share: f64) -> DVec3 {
        match self.shape {
            Shape::GreatCircle { normal } => normal,
            Shape::Arc { elevation } => AzEl {
                azimuth: Angle::from_radians(self.from_azimuth + self.turn * share),
                elevation: Angle::from_radians(elevation + FRAC_PI_2),
            }
            .to_enu(),
        }
    }

    /// Returns the length in radians.
    pub(super) fn length(&self) -> f64 {
        match self.shape {
            Shape::GreatCircle { .. } => {
                self.start.cross(self.end).length().atan2(self.start.dot(self.end))
            }
            Shape::Arc { elevation } => self.turn.abs() * elevation.cos(),
        }
    }

    /// Returns points from the start onwards, no more than `step` (radians) apart, without the end.
    pub(super) fn points(self, step: f64) -> impl Iterator<Item = AzEl> {
        let count = (self.length() / step).ceil().max(1.0) as u32;
        (0..count)
            .map(move |index| AzEl::from_enu(self.point_at(f64::from(index) / f64::from(count))))
    }
}
