//! What a controller can do, as far as the rest of the program has to know.

/// What a controller can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capabilities {
    /// Names of the two axes that are jogged; empty for one that is absent.
    pub axes: [&'static str; 2],
    /// It follows a satellite by itself, from the elements that it holds.
    pub has_program: bool,
    /// It takes directions; without it there is no go-to, no park and no
    /// tracking by this program.
    pub takes_positions: bool,
    /// A direction that is off by this much counts as reached, degrees.
    pub arrives_within_deg: f64,
    /// Positions are told to it, and by it, in whole numbers of this many degrees;
    /// 0 for any.
    pub position_step_deg: f64,
    /// What its second axis turns.
    pub second_axis: SecondAxis,
    /// How fast it jogs.
    pub jog: JogSpeeds,
    /// One axis at a time is jogged.
    pub jogs_one_axis: bool,
    /// It takes single steps.
    pub steps: bool,
    /// A jog ends in the device by itself, so that an axis whose angle is not
    /// known may be jogged all the same.
    pub ends_jogs: bool,
    /// Whatever is asked of it may take its panel from somebody who stands in
    /// front of it. It is left alone until the operator connects to it.
    pub waits_for_word: bool,
    /// How standstill is told from its slowest motion.
    pub standstill: Standstill,
    /// What STOP does beyond stopping this antenna, in a sentence.
    pub stop_note: Option<&'static str>,
}

/// What the second axis of a unit turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SecondAxis {
    /// With the first one it turns both angles of the sky.
    Elevation,
    /// Something else than the antenna, named as in the middle of a sentence. The mount
    /// knows nothing of it; the elevation is neither read nor commanded.
    Other(&'static str),
    /// There is none: the elevation is neither read nor commanded.
    Absent,
}

impl Capabilities {
    /// It turns both angles of the sky.
    pub fn has_elevation(self) -> bool {
        self.second_axis == SecondAxis::Elevation
    }

    /// How many axes point the antenna.
    pub fn axis_count(self) -> usize {
        if self.has_elevation() { 2 } else { 1 }
    }
}

/// How standstill is told from the slowest motion of a unit: by two looks that lie as far
/// apart as its slowest motion needs to show, `1.5 * resolution_deg / slowest_deg_s`
/// seconds. STOP is told as unproved after 3 s, or 1 s more than that time where this is
/// longer: figures that keep it below 2 s are told in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standstill {
    /// Angles are told in steps of this, degrees.
    pub resolution_deg: f64,
    /// Slowest rate at which a motion of its own runs on, degrees a second.
    pub slowest_deg_s: f64,
    /// For how long an axis usually runs on at its rate after a STOP, seconds: half
    /// of the time in which it slows down.
    pub overrun_s: f64,
}

/// How fast a controller jogs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JogSpeeds {
    /// At any rate up to the highest that is allowed.
    AnyRate,
    /// At one of these, the slowest first.
    Named(&'static [JogSpeed]),
}

/// A speed without a figure that the device would know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JogSpeed {
    /// As on the front panel.
    pub name: &'static str,
    /// As a share of the highest allowed rate. It is what tells the speeds of one
    /// controller apart, not a promise.
    pub share: f64,
}

impl JogSpeeds {
    /// The named speed that is meant by a rate, of which the highest is
    /// `maximum_rate_deg_s`; `None` where any rate is possible.
    pub fn nearest(self, rate_deg_s: f64, maximum_rate_deg_s: f64) -> Option<JogSpeed> {
        let Self::Named(speeds) = self else { return None };
        let share = rate_deg_s.abs() / maximum_rate_deg_s;
        let off = |speed: &JogSpeed| (speed.share - share).abs();
        speeds.iter().min_by(|a, b| off(a).total_cmp(&off(b))).copied()
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
