//! Capabilities of a controller that the rest of the program needs to know.

/// Capabilities of a controller, with the settings of its connection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capabilities {
    /// Names of the two jogged axes; empty for an absent one.
    pub axes: [&'static str; 2],
    /// The unit can track a satellite from elements that it holds (on-board track).
    pub has_program: bool,
    /// The unit takes directions. Without this there is no go-to, no park and no program
    /// track.
    pub takes_positions: bool,
    /// A direction that is off by this many degrees or less counts as reached.
    pub arrives_within_deg: f64,
    /// The unit takes and reports positions in multiples of this many degrees; 0 for any.
    pub position_step_deg: f64,
    /// The unit reports azimuths on a circle, so an axis that runs past an end of a whole turn reads as
    /// standing at the other end.
    pub azimuth_wraps: bool,
    pub second_axis: SecondAxis,
    pub jog: JogSpeeds,
    /// Only one axis at a time is jogged.
    pub jogs_one_axis: bool,
    /// The unit can turn by single steps.
    pub steps: bool,
    /// The unit ends a jog by itself, so an axis whose angle is not known may be jogged
    /// too.
    pub ends_jogs: bool,
    /// Any question may take the panel away from somebody who stands in front of the unit,
    /// so it is left alone until the operator connects to it.
    pub waits_for_word: bool,
    pub standstill: Standstill,
    pub effect: Effect,
    /// A further effect of STOP, beyond stopping this antenna, as a sentence.
    pub stop_note: Option<&'static str>,
}

/// The second axis of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SecondAxis {
    /// Elevation: together the two axes turn both angles of the sky.
    Elevation,
    /// Something other than the antenna, named as in the middle of a sentence. The mount
    /// ignores it; the elevation is neither read nor commanded.
    Other(&'static str),
    /// No second axis: the elevation is neither read nor commanded.
    Absent,
}

impl Capabilities {
    /// Returns `true` if the axes turn both angles of the sky.
    pub fn has_elevation(self) -> bool {
        self.second_axis == SecondAxis::Elevation
    }

    /// Farthest reported rest from the position that an axis was sent to, degrees.
    pub fn rests_within_deg(self) -> f64 {
        self.arrives_within_deg + self.position_step_deg
    }

    /// Number of axes that point the antenna.
    pub fn axis_count(self) -> usize {
        if self.has_elevation() { 2 } else { 1 }
    }
}

/// How to tell standstill from the slowest motion: by two positions that lie far enough
/// apart in time for that motion to show, `1.5 * resolution_deg / slowest_deg_s` seconds.
/// STOP is reported as unproved after 3 s, or after that time plus 1 s where this is
/// longer; figures that keep that time below 2 s are reported in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standstill {
    /// Step of the reported angles, degrees.
    pub resolution_deg: f64,
    /// Slowest rate at which a motion of the unit runs on, degrees a second.
    pub slowest_deg_s: f64,
    /// Usual overrun after STOP, in seconds at the rate of the axis: half of the time in
    /// which the axis slows down.
    pub overrun_s: f64,
}

/// How to tell a motion without effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effect {
    /// Longest time from a command to a position until the angle begins to change, or until it
    /// goes on changing, seconds.
    pub shows_after_s: f64,
    /// The unit may ignore a command to a position that is nearer than this, degrees.
    pub ignores_deg: f64,
}

/// Jog speeds of a controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JogSpeeds {
    /// Any rate up to the highest that is allowed.
    AnyRate,
    /// Only these, the slowest first.
    Named(&'static [JogSpeed]),
}

/// A named speed; the unit knows no figure for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JogSpeed {
    /// Name as on the front panel.
    pub name: &'static str,
    /// Share of the highest allowed rate. It tells the speeds of one controller apart and
    /// promises no rate.
    pub share: f64,
}

impl JogSpeeds {
    /// The named speed nearest to a rate, where the highest rate is `maximum_rate_deg_s`;
    /// `None` where any rate is possible.
    pub fn nearest(self, rate_deg_s: f64, maximum_rate_deg_s: f64) -> Option<JogSpeed> {
        let Self::Named(speeds) = self else { return None };
        let share = rate_deg_s.abs() / maximum_rate_deg_s;
        let distance = |speed: &JogSpeed| (speed.share - share).abs();
        speeds.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEEDS: &[JogSpeed] =
        &[JogSpeed { name: "Slow", share: 0.25 }, JogSpeed { name: "Fast", share: 1.0 }];

    #[test]
    fn a_rate_means_the_nearest_named_speed_either_way_round() {
        let slow = JogSpeed { name: "Slow", share: 0.25 };
        let fast = JogSpeed { name: "Fast", share: 1.0 };
        let speeds = JogSpeeds::Named(SPEEDS);
        assert_eq!(speeds.nearest(-0.5, 2.0), Some(slow));
        assert_eq!(speeds.nearest(2.0, 2.0), Some(fast));
        assert_eq!(speeds.nearest(-1.9, 2.0), Some(fast));
        assert_eq!(JogSpeeds::AnyRate.nearest(1.0, 2.0), None);
    }
}
