//! The commands of a motion, and the reasons not to send them.

use super::{
    Genius,
    actions::{DIRECTION, OTHER},
    roles::Roles,
};
use crate::{
    astro::Angle,
    clock::Moment,
    device::{AxisMotion, Motion, MotionRequest, panel::Act},
    protocol::rotator_genius::{
        self as unit, Direction, NoPosition, Rotator, RotatorNumber, WholeDegrees,
    },
};

/// One command to one rotator. A motion of both axes needs two commands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct QueuedMotion {
    pub(super) request: unit::Motion,
    /// The request that this command belongs to.
    pub(super) origin: MotionRequest,
}

const NOT_READ: &str = "the rotators were not read yet";
const KINDS: &str = "the kinds of the rotators do not fit this antenna";
const OTHER_TURNS: &str = "the other rotator turns, and STOP would end both";
const NO_SENSOR: &str = "the rotator has no sensor, so the device refuses to turn it";
const NO_POSITION: &str = "the device gives no position of the rotator";
const OUTSIDE: &str = "the rotator is outside its limits, where nothing ends a jog: send it to a \
                       direction, or allow jogs outside limits";
const OUTSIDE_UNKNOWN: &str = "whether the rotator is outside its limits is not known, and there \
                               nothing ends a jog: send it to a direction, or allow jogs outside limits";
const OUT_OF_RANGE: &str = "the device takes azimuths from 0 to 360 degrees";
const NO_MOTION: &str = "the device has no such motion";

impl Genius {
    pub(super) fn roles(&self) -> Option<Roles> {
        self.status.as_ref().map(|status| Roles::new(self.rotators, status))
    }

    /// Returns the make's own reason not to send `origin`.
    pub(super) fn objection_to(&self, origin: &MotionRequest, now: Moment) -> Option<&'static str> {
        let Some(status) = &self.status else { return Some(NOT_READ) };
        let Roles { axes: [first, second], is_clear, is_pair } = Roles::new(self.rotators, status);
        match *origin {
            MotionRequest::Motion(Motion::Jog { x_deg_s, .. }) => {
                let (number, other) =
                    if x_deg_s == 0.0 { (second, first) } else { (first, second) };
                if !is_clear && (is_pair || number == first) {
                    return Some(KINDS);
                }
                if self.turns(other) {
                    return Some(OTHER_TURNS);
                }
                let rotator = status.rotator(number);
                match rotator.is_outside_limits {
                    Some(false) => None,
                    _ if self.is_rescue_armed(now.steady) => None,
                    Some(true) => Some(OUTSIDE),
                    None => Some(OUTSIDE_UNKNOWN),
                }
            }
            MotionRequest::Motion(Motion::Position { azimuth, elevation }) => {
                if !is_clear {
                    return Some(KINDS);
                }
                if azimuth.is_some_and(|azimuth| whole_azimuth(azimuth).is_none()) {
                    return Some(OUT_OF_RANGE);
                }
                let numbers = [azimuth.map(|_| first), elevation.map(|_| second)];
                let mut rotators =
                    numbers.into_iter().flatten().map(|number| status.rotator(number));
                rotators.find_map(without_position)
            }
            MotionRequest::Action(OTHER) => without_position(status.rotator(second)),
            _ => None,
        }
    }

    /// Returns `true` if the rotator turned in the last status, or if a pending command may turn
    /// it.
    fn turns(&self, number: RotatorNumber) -> bool {
        let of_axis = self.roles().zip(self.state.measured).and_then(|(roles, measured)| {
            let mut axes = roles.axes.into_iter().zip(measured.axes);
            axes.find(|(rotator, _)| *rotator == number).map(|(_, axis)| axis.motion)
        });
        let waits = self.orders.iter().any(|order| rotator_of(order.request) == number);
        waits || of_axis.is_some_and(|motion| motion != AxisMotion::Still)
    }

    /// Returns the commands of `motion`, or the reason why there are none.
    pub(super) fn orders_for(&self, motion: Motion) -> Result<Vec<QueuedMotion>, &'static str> {
        let Roles { axes: [first, second], is_pair, .. } = self.roles().ok_or(NOT_READ)?;
        let requests = match motion {
            Motion::Jog { x_deg_s, y_deg_s } if x_deg_s == 0.0 || y_deg_s == 0.0 => {
                let (rotator, rate) =
                    if x_deg_s == 0.0 { (second, y_deg_s) } else { (first, x_deg_s) };
                let direction =
                    if rate > 0.0 { Direction::Clockwise } else { Direction::CounterClockwise };
                vec![unit::Motion::Rotate { rotator, direction }]
            }
            Motion::Position { azimuth, elevation } if is_pair || elevation.is_none() => {
                let azimuth = azimuth
                    .map(|azimuth| whole_azimuth(azimuth).ok_or(OUT_OF_RANGE))
                    .transpose()?;
                let elevation = elevation.map(whole_elevation);
                let parts = [(first, azimuth), (second, elevation)].into_iter();
                let go_to = |(rotator, target): (_, Option<_>)| {
                    target.map(|target| unit::Motion::GoTo { rotator, target })
                };
                parts.filter_map(go_to).collect()
            }
            _ => return Err(NO_MOTION),
        };
        Ok(requests
            .into_iter()
            .map(|request| QueuedMotion { request, origin: motion.into() })
            .collect())
    }

    pub(super) fn order_for(&self, act: &Act) -> Result<QueuedMotion, &'static str> {
        let degrees = DIRECTION.get(&act.values).and_then(|degrees| u16::try_from(degrees).ok());
        let target =
            degrees.and_then(|degrees| WholeDegrees::new(degrees).ok()).ok_or(OUT_OF_RANGE)?;
        let Roles { axes: [_, rotator], .. } = self.roles().ok_or(NOT_READ)?;
        let request = unit::Motion::GoTo { rotator, target };
        Ok(QueuedMotion { request, origin: MotionRequest::Action(act.action) })
    }

    /// Returns the likely meaning of an `F` according to the last status: the unit gives no reason.
    pub(super) fn refusal(&self, request: unit::Motion) -> String {
        let Some(status) = &self.status else { return "F".to_owned() };
        let number = rotator_of(request);
        let rotator = status.rotator(number);
        let limits = |limit: Option<WholeDegrees>| limit.map_or("?".to_owned(), |l| l.to_string());
        let reason = match (&rotator.position, rotator.is_outside_limits) {
            (Err(NoPosition::NoSensor), _) => "its sensor is not connected".to_owned(),
            (Err(problem), _) => problem.to_string(),
            (Ok(_), Some(true)) => "it is outside its limits".to_owned(),
            (Ok(_), None) => "its limit flag has no known meaning".to_owned(),
            (Ok(_), Some(false)) => format!(
                "no reason is given; its limits are {} and {}",
                limits(rotator.limit_ccw),
                limits(rotator.limit_cw)
            ),
        };
        format!("F for rotator {}: {reason}", number.number())
    }
}

pub(super) fn rotator_of(request: unit::Motion) -> RotatorNumber {
    match request {
        unit::Motion::GoTo { rotator, .. } | unit::Motion::Rotate { rotator, .. } => rotator,
    }
}

fn without_position(rotator: &Rotator) -> Option<&'static str> {
    match rotator.position {
        Ok(_) => None,
        Err(NoPosition::NoSensor) => Some(NO_SENSOR),
        Err(_) => Some(NO_POSITION),
    }
}

/// Returns a position in the whole degrees that Azel sends; any other motion unchanged.
pub(super) fn in_whole_degrees(motion: Motion) -> Motion {
    let Motion::Position { azimuth, elevation } = motion else { return motion };
    let whole = |degrees: WholeDegrees| Angle::from_degrees(f64::from(degrees.degrees()));
    Motion::Position {
        // Azel refuses a position that cannot be sent, and shows its requested values.
        azimuth: azimuth.map(|azimuth| whole_azimuth(azimuth).map_or(azimuth, whole)),
        elevation: elevation.map(|elevation| whole(whole_elevation(elevation))),
    }
}

/// Returns the nearest whole degree. The result is 360 only if 360 was requested. On a mount with
/// its stop in the north, 360 may be a whole turn away from 359.6.
fn whole_azimuth(azimuth: Angle) -> Option<WholeDegrees> {
    let degrees = azimuth.degrees();
    // Angles come from decimal degrees, so the test allows for rounding.
    let degrees = if (-1e-9..0.0).contains(&degrees) { 0.0 } else { degrees };
    let nearest = WholeDegrees::nearest(degrees).ok()?;
    let is_rounded_to_north = nearest == WholeDegrees::MAX && degrees < 360.0 - 1e-9;
    Some(if is_rounded_to_north { WholeDegrees::saturating(359) } else { nearest })
}

/// Returns the nearest whole degree of an elevation, 0 to 180 over the zenith.
fn whole_elevation(elevation: Angle) -> WholeDegrees {
    WholeDegrees::saturating(elevation.degrees().clamp(0.0, 180.0).round() as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn north_is_rounded_to_the_side_on_which_it_was_asked_for() {
        let azimuth =
            |degrees| whole_azimuth(Angle::from_degrees(degrees)).map(WholeDegrees::degrees);
        for (requested_deg, sent) in [
            (0.0, Some(0)),
            (0.4, Some(0)),
            (0.6, Some(1)),
            (359.4, Some(359)),
            (359.6, Some(359)),
            (360.0, Some(360)),
            (-1e-12, Some(0)),
            (360.4, None),
            (370.0, None),
            (-10.0, None),
            (f64::NAN, None),
        ] {
            assert_eq!(azimuth(requested_deg), sent, "{requested_deg}");
        }
    }

    #[test]
    fn a_position_is_told_as_it_is_sent() {
        let position = |azimuth_deg, elevation_deg| Motion::Position {
            azimuth: Some(Angle::from_degrees(azimuth_deg)),
            elevation: Some(Angle::from_degrees(elevation_deg)),
        };
        assert_eq!(in_whole_degrees(position(120.5, 12.5)), position(121.0, 13.0));
        assert_eq!(in_whole_degrees(position(359.6, 12.4)), position(359.0, 12.0));
        assert_eq!(in_whole_degrees(position(370.0, 12.4)), position(370.0, 12.0));
        let none = Motion::Position { azimuth: None, elevation: None };
        assert_eq!(in_whole_degrees(none), none);
    }

    #[test]
    fn elevations_end_at_both_horizons() {
        let elevation = |degrees| whole_elevation(Angle::from_degrees(degrees)).degrees();
        let sent = [-3.0, 0.4, 89.5, 120.0, 200.0].map(elevation);
        assert_eq!(sent, [0, 0, 90, 120, 180]);
    }
}
