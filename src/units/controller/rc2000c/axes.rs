//! The two axes: angles from a status, and counts and jogs from angles.

use super::Calibration;
use crate::{
    astro::Angle,
    device::{Axis, AxisMotion, CountLine, Drive, Pointing},
    protocol::rc2000c::{AxisDrive, Direction, LimitEnd, Position, Sense, Status},
    station::Mount,
};

/// Max change of the reading of a standing axis, steps.
const UNSTEADY: u16 = 1;
/// Max noise of a sensor, degrees.
const NOISE_DEG: f64 = 1.0;
const TURN_DEG: f64 = 360.0;
/// Drive number of an auto move, which shows no direction.
const AUTO_MOVE: i64 = 7;

/// Conversion of the counts of both axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    lines: [Option<CountLine>; 2],
}

impl Axes {
    pub(super) fn new(calibration: &Calibration) -> Self {
        let lines = [&calibration.azimuth, &calibration.elevation];
        Self { lines: lines.map(|points| CountLine::from_points(points).ok()) }
    }

    pub(super) fn are_calibrated(&self) -> bool {
        self.lines.iter().all(Option::is_some)
    }

    /// Returns azimuth and elevation in `status`. An axis whose position differs from `before` is
    /// moving: the unit does not report an axis that coasts.
    pub(super) fn read(&self, status: &Status, before: Option<&Status>) -> [Axis; 2] {
        let angle_axes = |status: &Status| [status.azimuth, status.elevation];
        let before = before.map(angle_axes);
        let drives = [status.azimuth_drive, status.elevation_drive];
        let [azimuth, elevation] = angle_axes(status);
        let axis = |position, line: Option<CountLine>, drive, before: Option<Position>| {
            let is_reversed = line.is_some_and(|line| line.is_reversed());
            let end = match position {
                Position::Limit(end) => Some(sense_of(end)),
                _ => None,
            };
            let is_at_end = |sense| end.is_some_and(|end| (end == sense) != is_reversed);
            Axis {
                angle_deg: angle_deg(position, line),
                motion: motion(drive, position, before, is_reversed),
                drive: drive_state(drive),
                plus_limit: is_at_end(Sense::Positive),
                minus_limit: is_at_end(Sense::Negative),
            }
        };
        let [az_line, el_line] = self.lines;
        let [az_drive, el_drive] = drives;
        [
            axis(azimuth, az_line, az_drive, before.map(|[azimuth, _]| azimuth)),
            axis(elevation, el_line, el_drive, before.map(|[_, elevation]| elevation)),
        ]
    }

    /// Finds the turn of an azimuth that the display has wrapped to 0 to 360 degrees. The axis is
    /// near its angle in `before`, if that is known. An axis that may be on either of two turns
    /// gets no angle.
    pub(super) fn unwrapped(
        azimuth: Axis,
        position: Position,
        before: Option<&Axis>,
        mount: &Mount,
    ) -> Axis {
        let (Position::TenthsOfDegree(_), Some(shown_deg)) = (position, azimuth.angle_deg) else {
            return azimuth;
        };
        if shown_deg > TURN_DEG {
            return azimuth;
        }
        let [(from_deg, to_deg), _] = mount.travel_deg();
        let before_deg = before.and_then(|before| match before {
            Axis { minus_limit: true, .. } => Some(from_deg),
            Axis { plus_limit: true, .. } => Some(to_deg),
            Axis { angle_deg, .. } => *angle_deg,
        });
        let first = ((from_deg - NOISE_DEG - shown_deg) / TURN_DEG).ceil();
        let lowest_deg = shown_deg + first * TURN_DEG;
        let angle_deg = if let Some(before_deg) = before_deg {
            Some(shown_deg + ((before_deg - shown_deg) / TURN_DEG).round() * TURN_DEG)
        } else if lowest_deg + TURN_DEG <= to_deg + NOISE_DEG {
            None
        } else if lowest_deg <= to_deg + NOISE_DEG {
            Some(lowest_deg)
        } else {
            // The axis is outside its travel.
            Some(shown_deg)
        };
        Axis { angle_deg, ..azimuth }
    }

    /// Returns the direction of the antenna with these axes. On a mount that does not flip, an
    /// elevation a little beyond 90 degrees is noise of the sensor. An axis at its limit reports no
    /// angle, but still shows on which side a flipped antenna points.
    pub(super) fn pointing(axes: [Axis; 2], mount: &Mount) -> Pointing {
        let [azimuth, elevation] = axes.map(|axis| axis.angle_deg.map(Angle::from_degrees));
        let azimuth = azimuth.map(Angle::wrapped_360);
        if !mount.can_flip() {
            return Pointing { azimuth, elevation };
        }
        match (elevation, axes[1]) {
            (Some(_), _) => Pointing::of_axes(azimuth, elevation),
            (None, Axis { plus_limit: true, .. }) => {
                let other_side = Angle::from_degrees(180.0);
                let azimuth = azimuth.map(|azimuth| (azimuth + other_side).wrapped_360());
                Pointing { azimuth, elevation: None }
            }
            (None, Axis { minus_limit: true, .. }) => Pointing { azimuth, elevation: None },
            (None, _) => Pointing { azimuth: None, elevation: None },
        }
    }

    /// Returns the direction of a jog that increases or decreases the angle of one axis.
    pub(super) fn direction(&self, x_deg_s: f64, y_deg_s: f64) -> Direction {
        let [azimuth, elevation] = self.lines;
        let grows = |rate: f64, line: Option<CountLine>| {
            (rate > 0.0) != line.is_some_and(|line| line.is_reversed())
        };
        match x_deg_s {
            0.0 if grows(y_deg_s, elevation) => Direction::Up,
            0.0 => Direction::Down,
            _ if grows(x_deg_s, azimuth) => Direction::Clockwise,
            _ => Direction::CounterClockwise,
        }
    }

    /// Returns the counts of a move to a direction. The command always moves both axes. Azel sends
    /// an axis that should stay to its current counts, or to its end if it stands at a limit and
    /// reports no counts. Noise may show a position a little beyond an end, which the unit would
    /// refuse.
    pub(super) fn counts(
        &self,
        azimuth: Option<Angle>,
        elevation: Option<Angle>,
        status: Option<&Status>,
        mount: &Mount,
    ) -> Result<[u16; 2], String> {
        let [az_line, el_line] = self.lines;
        let [az_travel_deg, el_travel_deg] = mount.travel_deg();
        let counts =
            |name, angle: Option<Angle>, line: Option<CountLine>, position, (from_deg, to_deg)| {
                let degrees = match (angle, position) {
                    (Some(angle), _) => angle.degrees(),
                    (None, Some(Position::Counts(counts))) => {
                        let at_deg = line.map(|line| line.degrees(counts));
                        match at_deg.and_then(|at_deg| end_beside(at_deg, from_deg, to_deg)) {
                            Some(end_deg) => end_deg,
                            None => return Ok(counts),
                        }
                    }
                    (None, Some(Position::Limit(end))) => {
                        let is_reversed = line.is_some_and(|line| line.is_reversed());
                        if (sense_of(end) == Sense::Positive) == is_reversed {
                            from_deg
                        } else {
                            to_deg
                        }
                    }
                    (None, _) => {
                        return Err(format!("the {name} is to stay, but its counts are not known"));
                    }
                };
                let line = line.ok_or_else(|| format!("the {name} is not calibrated"))?;
                line.counts(degrees)
                    .ok_or_else(|| format!("the {name} has no counts for {degrees:.1}°"))
            };
        let az_at = status.map(|status| status.azimuth);
        let el_at = status.map(|status| status.elevation);
        let az_counts = counts("azimuth", azimuth, az_line, az_at, az_travel_deg)?;
        let el_counts = counts("elevation", elevation, el_line, el_at, el_travel_deg)?;
        Ok([az_counts, el_counts])
    }

    /// Returns the angles of the axes at these counts, degrees of the mount; `None` unless both
    /// axes are calibrated.
    pub(super) fn degrees(&self, counts: [u16; 2]) -> Option<[Option<f64>; 2]> {
        let [azimuth, elevation] = self.lines;
        Some([Some(azimuth?.degrees(counts[0])), Some(elevation?.degrees(counts[1]))])
    }
}

/// Returns the end of the travel if `at_deg` lies beyond that end by no more than noise.
fn end_beside(at_deg: f64, from_deg: f64, to_deg: f64) -> Option<f64> {
    let end_deg = at_deg.clamp(from_deg, to_deg);
    let beyond_deg = (at_deg - end_deg).abs();
    (beyond_deg > 0.0 && beyond_deg <= NOISE_DEG).then_some(end_deg)
}

/// Returns the angle of a position, degrees. Counts need a calibration; a displayed angle does not.
fn angle_deg(position: Position, line: Option<CountLine>) -> Option<f64> {
    match position {
        Position::Counts(counts) => Some(line?.degrees(counts)),
        Position::TenthsOfDegree(tenths) => Some(f64::from(tenths) / 10.0),
        Position::Limit(_) | Position::Unknown(_) => None,
    }
}

fn sense_of(end: LimitEnd) -> Sense {
    match end {
        LimitEnd::CounterClockwise | LimitEnd::Down => Sense::Negative,
        LimitEnd::Clockwise | LimitEnd::Up => Sense::Positive,
    }
}

fn motion(
    drive: AxisDrive,
    position: Position,
    before: Option<Position>,
    is_reversed: bool,
) -> AxisMotion {
    let counts_grow = |grow: bool| turning(grow != is_reversed);
    match drive {
        AxisDrive::Pending(sense) | AxisDrive::Moving(sense) => {
            counts_grow(sense == Sense::Positive)
        }
        AxisDrive::Unknown(code) => AxisMotion::Unknown(code.into()),
        _ => match (before, position) {
            (Some(Position::Counts(before)), Position::Counts(now))
                if now.abs_diff(before) > UNSTEADY =>
            {
                counts_grow(now > before)
            }
            (Some(Position::TenthsOfDegree(before)), Position::TenthsOfDegree(now))
                if turned_tenths(before, now).unsigned_abs() > UNSTEADY =>
            {
                turning(turned_tenths(before, now) > 0)
            }
            _ if drive == AxisDrive::AutoMove => AxisMotion::Unknown(AUTO_MOVE),
            _ => AxisMotion::Still,
        },
    }
}

/// Returns the shorter way round from one shown angle to another, tenths of a degree: the display
/// may wrap.
fn turned_tenths(before: i16, now: i16) -> i16 {
    let turned = (i32::from(now) - i32::from(before) + 1800).rem_euclid(3600) - 1800;
    i16::try_from(turned).unwrap_or_default()
}

fn drive_state(drive: AxisDrive) -> Drive {
    match drive {
        AxisDrive::Still | AxisDrive::Jammed | AxisDrive::Limit | AxisDrive::Overcurrent => {
            Drive::Off
        }
        AxisDrive::Pending(_) | AxisDrive::Moving(_) => Drive::Jogged,
        AxisDrive::AutoMove | AxisDrive::Unknown(_) => Drive::On,
        AxisDrive::Runaway => Drive::Runaway,
    }
}

fn turning(angle_grows: bool) -> AxisMotion {
    if angle_grows { AxisMotion::Plus } else { AxisMotion::Minus }
}

#[cfg(test)]
pub(super) mod tests;
