//! Capabilities of a controller that the rest of the program needs to know.

/// Capabilities of a controller with its connection settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capabilities {
    /// Names of the two axes of a jog; empty for an absent axis.
    pub axes: [&'static str; 2],
    /// `true` if the unit can track a satellite from elements that it holds (on-board track).
    pub has_program: bool,
    /// `true` if the unit takes directions. Otherwise it has no go-to, no park and no program
    /// track.
    pub takes_positions: bool,
    /// Max distance from a direction at which it counts as reached, degrees.
    pub arrives_within_deg: f64,
    /// Step of the positions that the unit takes and reports, degrees; 0 for any.
    pub position_step_deg: f64,
    /// `true` if the unit reports azimuths on a circle. An axis that turns past an end of a whole
    /// turn then seems to stand at the other end.
    pub azimuth_wraps: bool,
    pub second_axis: SecondAxis,
    pub jog: JogSpeeds,
    /// `true` if a jog can turn only one axis at a time.
    pub jogs_one_axis: bool,
    /// `true` if the unit can turn by single steps.
    pub steps: bool,
    /// `true` if the unit's own timer ends a jog. Azel may then jog an axis whose angle is unknown.
    pub ends_jogs: bool,
    /// `true` if any question may take the panel away from a person in front of the unit. Azel then
    /// asks nothing until the operator connects to the unit.
    pub waits_for_word: bool,
    pub standstill: Standstill,
    pub effect: Effect,
    /// A further effect of STOP, in addition to stopping this antenna, as a sentence.
    pub stop_note: Option<&'static str>,
}

/// The second axis of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SecondAxis {
    /// Elevation: together the two axes turn both angles of the sky.
    Elevation,
    /// Another device than the antenna, with its name for the middle of a sentence. The mount
    /// ignores it, and Azel neither reads nor commands the elevation.
    Other(&'static str),
    /// No second axis: Azel neither reads nor commands the elevation.
    Absent,
}

impl Capabilities {
    /// Returns `true` if the axes turn both angles of the sky.
    pub fn has_elevation(self) -> bool {
        self.second_axis == SecondAxis::Elevation
    }

    /// Returns the max reported distance between a resting axis and its target, degrees.
    pub fn rests_within_deg(self) -> f64 {
        self.arrives_within_deg + self.position_step_deg
    }

    /// Returns the number of axes that point the antenna.
    pub fn axis_count(self) -> usize {
        if self.has_elevation() { 2 } else { 1 }
    }
}

/// Figures that distinguish standstill from the slowest motion, by two positions. The time between
/// the positions must let that motion show: `1.5 * resolution_deg / slowest_deg_s` seconds. Azel
/// reports STOP as unproved after 3 s, or after that time plus 1 s if this is longer. A time below
/// 2 s causes no delay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standstill {
    /// Step of the reported angles, degrees.
    pub resolution_deg: f64,
    /// Min rate at which a motion of the unit continues, degrees a second.
    pub slowest_deg_s: f64,
    /// Typical overrun after STOP, in seconds at the rate of the axis: half of the time in which
    /// the axis slows down.
    pub overrun_s: f64,
}

/// Figures that reveal a motion without effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effect {
    /// Max time from a command to a position until the angle starts or continues to change,
    /// seconds.
    pub shows_after_s: f64,
    /// Distance to a commanded position below which the unit may ignore the command, degrees.
    pub ignores_deg: f64,
}

/// Jog speeds of a controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JogSpeeds {
    /// Any rate up to the allowed max.
    AnyRate,
    /// Only these speeds, the slowest first.
    Named(&'static [JogSpeed]),
}

/// A named speed; the unit gives no figure for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JogSpeed {
    /// Name as on the front panel.
    pub name: &'static str,
    /// Share of the max allowed rate. It distinguishes the speeds of one controller and promises no
    /// rate.
    pub share: f64,
}

impl JogSpeeds {
    /// Returns the named speed nearest to a rate, for the max rate `maximum_rate_deg_s`; `None` if
    /// the unit takes any rate.
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
