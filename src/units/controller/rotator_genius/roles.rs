//! Assignment of the two rotators to the axes of the antenna.

use super::Rotators;
use crate::protocol::rotator_genius::{Rotator, RotatorKind, RotatorNumber, Status, WholeDegrees};

/// Angle just below a whole turn, degrees: the upper end of an azimuth that the unit never reports
/// as 360.
const BELOW_TURN_DEG: f64 = 359.999;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Roles {
    pub(super) axes: [RotatorNumber; 2],
    pub(super) is_pair: bool,
    /// `true` if the kinds that the unit reports fit the antenna. Otherwise Azel uses no reading as
    /// azimuth or elevation.
    pub(super) is_clear: bool,
}

impl Roles {
    /// Returns the roles of the rotators. In a pair, the reported kinds decide, not the numbers.
    pub(super) fn new(rotators: Rotators, status: &Status) -> Self {
        let [one, two] = status.rotators.each_ref().map(|rotator| rotator.kind);
        let (first, second) = (RotatorNumber::One, RotatorNumber::Two);
        match rotators {
            Rotators::Pair => {
                let is_turned = one == RotatorKind::Elevation && two == RotatorKind::Azimuth;
                let axes = if is_turned { [second, first] } else { [first, second] };
                Self { axes, is_pair: true, is_clear: one != two }
            }
            Rotators::First => Self {
                axes: [first, second],
                is_pair: false,
                is_clear: one == RotatorKind::Azimuth,
            },
            Rotators::Second => Self {
                axes: [second, first],
                is_pair: false,
                is_clear: two == RotatorKind::Azimuth,
            },
        }
    }

    /// Returns `true` if the rotator turns this antenna.
    pub(super) fn is_ours(self, number: RotatorNumber) -> bool {
        self.is_pair || self.axes.first() == Some(&number)
    }

    /// Returns both ends of each axis of the antenna according to the limits of its rotator,
    /// degrees.
    pub(super) fn travel_deg(self, status: &Status) -> [Option<(f64, f64)>; 2] {
        self.axes.map(|number| {
            let is_axis = self.is_clear && self.is_ours(number);
            let rotator = is_axis.then(|| status.rotator(number))?;
            match rotator.kind {
                RotatorKind::Azimuth => Some((0.0, highest_azimuth_deg(rotator))),
                RotatorKind::Elevation => elevation_ends_deg(rotator),
            }
        })
    }

    /// Returns `true` unless the limits show that the azimuth rotator cannot turn across north.
    pub(super) fn may_turn_over_north(self, status: &Status) -> bool {
        let Some(rotator) = self.azimuth_rotator(status) else { return true };
        let (Some(ccw), Some(cw)) = (rotator.limit_ccw, rotator.limit_cw) else { return true };
        let (ccw, cw) = (ccw.degrees(), cw.degrees());
        let ends_at_north = (ccw == 0 && cw >= 359) || (cw == 0 && ccw >= 359);
        // The limits span two arcs. A position between them that is inside the limits rules out the
        // arc across north.
        let is_between =
            rotator.position.is_ok_and(|position| (ccw..=cw).contains(&position.degrees()));
        let is_ruled_out = is_between && rotator.is_outside_limits == Some(false);
        !ends_at_north && !is_ruled_out
    }

    /// Returns the limits of the azimuth rotator, degrees; `None` while the rotator may be beyond a
    /// limit, because it has to return across that limit.
    pub(super) fn azimuth_limits_deg(self, status: &Status) -> [Option<f64>; 2] {
        let is_inside = |rotator: &&Rotator| rotator.is_outside_limits == Some(false);
        let Some(rotator) = self.azimuth_rotator(status).filter(is_inside) else {
            return [None; 2];
        };
        [rotator.limit_ccw, rotator.limit_cw].map(|limit| Some(f64::from(limit?.degrees())))
    }

    fn azimuth_rotator(self, status: &Status) -> Option<&Rotator> {
        let ours = self.axes.into_iter().filter(|number| self.is_ours(*number));
        let mut rotators = ours.map(|number| status.rotator(number));
        rotators.find(|rotator| rotator.kind == RotatorKind::Azimuth)
    }

    /// Returns the position of a rotator on the scale of its axis, degrees. The unit reports an
    /// elevation a little below the horizon as almost a whole turn.
    pub(super) fn axis_deg(rotator: &Rotator) -> Option<f64> {
        rotator.position.ok().map(|position| axis_deg(rotator.kind, position))
    }
}

fn axis_deg(kind: RotatorKind, position: WholeDegrees) -> f64 {
    let angle_deg = f64::from(position.degrees());
    let is_below = kind == RotatorKind::Elevation && angle_deg > 270.0;
    if is_below { angle_deg - 360.0 } else { angle_deg }
}

/// Returns the upper end of an azimuth, degrees. The direction of the arc between the limits is
/// uncertain, so the limits only show whether the azimuth has 360 in addition to 0.
fn highest_azimuth_deg(rotator: &Rotator) -> f64 {
    let highest = WholeDegrees::MAX;
    let is_end = [rotator.limit_cw, rotator.limit_ccw].contains(&Some(highest));
    if is_end { f64::from(highest.degrees()) } else { BELOW_TURN_DEG }
}

/// Returns both ends of an elevation, degrees. An elevation never turns by more than half a turn,
/// so the order of its limits does not matter.
fn elevation_ends_deg(rotator: &Rotator) -> Option<(f64, f64)> {
    let [one, other] = [rotator.limit_cw?, rotator.limit_ccw?];
    let [one_deg, other_deg] = [one, other].map(|limit| axis_deg(rotator.kind, limit));
    (one != other).then_some((one_deg.min(other_deg), one_deg.max(other_deg)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::rotator_genius::{Decoder, Received, Reply};

    /// Returns the travel of two rotators with these limits, clockwise and counter-clockwise.
    fn travel_deg(azimuth: [u16; 2], elevation: [u16; 2]) -> [Option<(f64, f64)>; 2] {
        let rotator = |[cw, ccw]: [u16; 2], kind| format!("  0{cw:3}{ccw:3}{kind}0   0999999\0");
        let mut decoder = Decoder::new();
        let name = "            ";
        let one = rotator(azimuth, 'A') + name;
        let two = rotator(elevation, 'E') + name;
        decoder.push(format!("|h2\0{one}{two}").as_bytes());
        let Some(Received::Reply(Reply::Status(status))) =
            std::iter::from_fn(|| decoder.next()).last()
        else {
            panic!("no status")
        };
        Roles::new(Rotators::Pair, &status).travel_deg(&status)
    }

    #[test]
    fn a_place_for_360_degrees_is_there_where_a_limit_says_so() {
        for (limits, to_deg) in
            [([359, 0], 359.999), ([360, 0], 360.0), ([0, 360], 360.0), ([45, 300], 359.999)]
        {
            assert_eq!(travel_deg(limits, [90, 0])[0], Some((0.0, to_deg)), "{limits:?}");
        }
    }

    #[test]
    fn an_elevation_travels_between_its_limits_whichever_is_which() {
        for (limits, ends_deg) in [
            ([90, 0], Some((0.0, 90.0))),
            ([0, 180], Some((0.0, 180.0))),
            ([95, 355], Some((-5.0, 95.0))),
            ([90, 90], None),
        ] {
            assert_eq!(travel_deg([359, 0], limits)[1], ends_deg, "{limits:?}");
        }
    }
}
