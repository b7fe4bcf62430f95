//! Detection of motions without effect: the unit accepted the command, but the axis does not turn,
//! or its sensor does not show it.

use std::time::Duration;

use super::standstill::Figures;
use crate::{
    astro::Angle,
    clock::Instant,
    device::{AxisMotion, Capabilities, Measured},
};

/// Max time from a jog command until the angles show it.
const JOG_SHOWS_AFTER: Duration = Duration::from_millis(1500);

/// Last change of the angle of each axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Effects {
    axes: [Effect; 2],
    last_reading: Option<Instant>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Effect {
    /// Last changed angle, degrees, and its request time.
    changed: Option<(f64, Instant)>,
    expected_since: Option<Instant>,
    /// `true` if the angle has changed since the session expected a motion.
    has_turned: bool,
}

/// Motion expected of a working axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Expected {
    /// Motion at this rate, degrees a second.
    Rate(f64),
    /// Motion at this rate, degrees a second, towards a position beyond the distance that the unit
    /// may ignore.
    Approach(f64),
}

/// Motion of Azel that must show in the angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RequestedMotion {
    Nothing,
    Jog {
        rates_deg_s: [f64; 2],
        /// Axes that stand at an end of the unit's own travel and are jogged towards it.
        is_at_end: [bool; 2],
    },
    Approach(Approach),
}

/// Motion to a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Approach {
    /// `true` for a motion that ends at its position; `false` for one of many positions of a track.
    pub(super) is_slew: bool,
    /// Target of each axis, degrees.
    pub(super) to_deg: [Option<f64>; 2],
    /// Expected rates of the axes, degrees a second.
    pub(super) rates_deg_s: [f64; 2],
    /// `true` if the unit may turn the azimuth through north.
    pub(super) may_turn_either_way: bool,
    /// `true` if the azimuth axis reaches no direction twice, except the direction of its ends.
    pub(super) has_one_turn: bool,
}

impl Approach {
    fn wraps(&self, axis: usize, is_driven: bool, can: Capabilities) -> Wraps {
        if axis != 0 {
            Wraps::Never
        } else if self.may_turn_either_way {
            Wraps::Always
        } else if can.azimuth_wraps && !is_driven && self.has_one_turn {
            Wraps::AtRest { within_deg: can.rests_within_deg() }
        } else {
            Wraps::Never
        }
    }
}

/// Conditions under which an axis treats 0 and 360 degrees as the same position.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Wraps {
    Never,
    /// Unit that can turn through north.
    Always,
    /// Axis that cannot turn through north. It may come to rest so near one end that it reads the
    /// other.
    AtRest {
        within_deg: f64,
    },
}

impl Wraps {
    /// Returns the remaining distance to a position, degrees.
    fn way_deg(self, angle_deg: f64, to_deg: f64) -> f64 {
        let plain_deg = to_deg - angle_deg;
        let wrapped_deg = Angle::from_degrees(plain_deg).wrapped_180().degrees();
        let is_wrapped = match self {
            Self::Never => false,
            Self::Always => true,
            Self::AtRest { within_deg } => wrapped_deg.abs() <= within_deg,
        };
        if is_wrapped { wrapped_deg } else { plain_deg }
    }
}

impl Effect {
    fn take(&mut self, angle_deg: Option<f64>, time: Instant, figures: Figures) {
        let Some(angle_deg) = angle_deg else { return };
        let is_new =
            self.changed.is_none_or(|(before_deg, _)| !figures.are_same_deg(before_deg, angle_deg));
        if is_new {
            self.has_turned |= self.changed.is_some();
            self.changed = Some((angle_deg, time));
        }
    }

    /// Returns `true` once the axis has failed to move as expected for too long.
    fn is_missing(
        &mut self,
        expected: Option<Expected>,
        time: Instant,
        figures: Figures,
        shows_after: Duration,
    ) -> bool {
        let Some(expected) = expected else {
            (self.expected_since, self.has_turned) = (None, false);
            return false;
        };
        let begun = *self.expected_since.get_or_insert(time);
        let Some((_, changed)) = self.changed else { return false };
        let waited = time.saturating_duration_since(begun.max(changed));
        match expected {
            Expected::Rate(rate_deg_s) => {
                let turning_s = waited.saturating_sub(JOG_SHOWS_AFTER).as_secs_f64();
                rate_deg_s.abs() * turning_s > 4.0 * figures.tolerance_deg()
            }
            Expected::Approach(rate_deg_s) => {
                // A slow axis takes longer to exceed its sway.
                let turns_s = 2.0 * figures.tolerance_deg() / rate_deg_s;
                let turns = Duration::try_from_secs_f64(turns_s).unwrap_or(Duration::MAX);
                waited >= shows_after.saturating_add(figures.gap().max(turns))
            }
        }
    }
}

impl Effects {
    /// Returns `true` once for each position.
    pub(super) fn is_new(&mut self, look: &Measured) -> bool {
        self.last_reading.replace(look.received) != Some(look.received)
    }

    /// Takes a position. Returns the first axis that has failed for too long to move as requested.
    /// `suspects`: axes that somebody else may have moved.
    pub(super) fn failed_axis(
        &mut self,
        look: &Measured,
        requested: RequestedMotion,
        suspects: [bool; 2],
        can: Capabilities,
        figures: Figures,
    ) -> Option<usize> {
        let shows_after = Duration::try_from_secs_f64(can.effect.shows_after_s).unwrap_or_default();
        let expected = match requested {
            RequestedMotion::Nothing => [None; 2],
            RequestedMotion::Jog { rates_deg_s, is_at_end } => {
                self.expected_of_jog(look, rates_deg_s, is_at_end)
            }
            RequestedMotion::Approach(approach) => {
                self.expected_of_approach(look, approach, can, figures, shows_after)
            }
        };
        let mut missing = None;
        let effects = self.axes.iter_mut().zip(look.axes).zip(expected).zip(suspects);
        for (index, (((effect, axis), expected), is_suspect)) in
            effects.enumerate().take(can.axis_count())
        {
            effect.take(axis.angle_deg, look.requested, figures);
            // Wind or somebody else may have moved the axis, so its angle proves no lack of effect.
            let expected = expected.filter(|_| axis.angle_deg.is_some() && !is_suspect);
            if effect.is_missing(expected, look.requested, figures, shows_after) {
                missing = missing.or(Some(index));
            }
        }
        missing
    }

    fn expected_of_jog(
        &self,
        look: &Measured,
        rates_deg_s: [f64; 2],
        is_at_end: [bool; 2],
    ) -> [Option<Expected>; 2] {
        let mut expected = [None; 2];
        let axes = look.axes.iter().zip(self.axes).zip(rates_deg_s).zip(is_at_end);
        for (expected, (((axis, effect), rate), is_at_end)) in expected.iter_mut().zip(axes) {
            // The unit itself ends a jog at its limits, and some units do not report that.
            let is_ended = effect.has_turned && axis.motion == AxisMotion::Still;
            let is_due = rate != 0.0 && !is_at_end && !is_ended;
            *expected = is_due.then_some(Expected::Rate(rate));
        }
        expected
    }

    fn expected_of_approach(
        &self,
        look: &Measured,
        approach: Approach,
        can: Capabilities,
        figures: Figures,
        shows_after: Duration,
    ) -> [Option<Expected>; 2] {
        let finest_deg =
            can.arrives_within_deg + 2.0 * can.standstill.resolution_deg + figures.tolerance_deg();
        // A unit may turn one axis after the other.
        let turned_lately = self.axes.map(|effect| {
            effect.changed.is_some_and(|(_, changed)| {
                look.requested.saturating_duration_since(changed) < shows_after
            })
        });
        let axes = look.axes.iter().zip(approach.to_deg).zip(self.axes).zip(approach.rates_deg_s);
        let mut expected = [None; 2];
        for (index, (expected, (((axis, to_deg), effect), rate_deg_s))) in
            expected.iter_mut().zip(axes).enumerate()
        {
            let Some((angle_deg, to_deg)) = axis.angle_deg.zip(to_deg) else { continue };
            let is_driven = axis.motion != AxisMotion::Still;
            let other_turns = turned_lately.get(1 - index) == Some(&true);
            // A stop before the target is reported separately, and the unit decides when to creep.
            let may_rest = !is_driven && (other_turns || (approach.is_slew && effect.has_turned));
            let ignored_deg = if is_driven { 0.0 } else { can.effect.ignores_deg };
            let way_deg = approach.wraps(index, is_driven, can).way_deg(angle_deg, to_deg);
            let is_far = way_deg.abs() > finest_deg + ignored_deg;
            *expected = (is_far && !may_rest).then_some(Expected::Approach(rate_deg_s));
        }
        expected
    }

    /// Returns the time of the last observed turn of an axis.
    pub(super) fn last_change(&self) -> Option<Instant> {
        self.axes.iter().filter_map(|axis| Some(axis.changed?.1)).max()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_at_rest_has_a_whole_turn_left_unless_it_reads_the_other_end() {
        let at_rest = Wraps::AtRest { within_deg: 3.0 };
        for (wraps, angle_deg, to_deg, left_deg) in [
            (at_rest, 0.0, 350.0, 350.0),
            (at_rest, 360.0, 0.0, 0.0),
            (at_rest, 359.0, 1.0, 2.0),
            (at_rest, 10.0, 20.0, 10.0),
            (Wraps::Always, 0.0, 350.0, -10.0),
            (Wraps::Never, 360.0, 0.0, -360.0),
        ] {
            let way_deg = wraps.way_deg(angle_deg, to_deg);
            assert!((way_deg - left_deg).abs() < 1e-9, "{wraps:?}: {angle_deg} to {to_deg}");
        }
    }
}
