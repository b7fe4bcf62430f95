//! Finds motions without effect: the unit took the command, and the axis does not turn, or its
//! sensor does not show it.

use std::time::Duration;

use super::{
    Session,
    activity::{Activity, SlewStage},
    standstill::Figures,
};
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    contract::driver::{Event, Safety},
    device::{AxisMotion, Measured},
    name::Name,
};

/// Longest time from the command of a jog until it shows in the angles.
const JOG_SHOWS_AFTER: Duration = Duration::from_millis(1500);

/// The angles of both axes since they last changed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Effects {
    axes: [Effect; 2],
    last_reading: Option<Instant>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Effect {
    /// The last angle that differs from those before it, degrees, and when it was asked for.
    changed: Option<(f64, Instant)>,
    expected_since: Option<Instant>,
    /// The angle has changed since a motion became expected.
    has_turned: bool,
}

/// Motion expected of a working axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Expected {
    /// It turns at this rate, degrees a second.
    Rate(f64),
    /// It turns at this rate, degrees a second, towards a position that is further away than the unit
    /// may ignore.
    Approach(f64),
}

/// Where an axis treats 0 and 360 degrees as the same position.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Wraps {
    Never,
    /// The unit can turn through north.
    Always,
    /// The axis cannot turn through north. It may come to rest so near one end that it reads the other.
    AtRest {
        within_deg: f64,
    },
}

impl Wraps {
    /// The way that is left to a position, degrees.
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
    fn take(&mut self, angle_deg: Option<f64>, at: Instant, figures: Figures) {
        let Some(angle_deg) = angle_deg else { return };
        let is_new =
            self.changed.is_none_or(|(before_deg, _)| !figures.are_same_deg(before_deg, angle_deg));
        if is_new {
            self.has_turned |= self.changed.is_some();
            self.changed = Some((angle_deg, at));
        }
    }

    /// Returns `true` once the axis has failed to move as expected for too long.
    fn is_missing(
        &mut self,
        expected: Option<Expected>,
        at: Instant,
        figures: Figures,
        shows_after: Duration,
    ) -> bool {
        let Some(expected) = expected else {
            (self.expected_since, self.has_turned) = (None, false);
            return false;
        };
        let since = *self.expected_since.get_or_insert(at);
        let Some((_, changed)) = self.changed else { return false };
        let waited = at.saturating_duration_since(since.max(changed));
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
    /// When an axis was last seen to turn.
    pub(super) fn last_change(&self) -> Option<Instant> {
        self.axes.iter().filter_map(|axis| Some(axis.changed?.1)).max()
    }
}

impl Session {
    /// Stops a motion that has no effect.
    pub(super) fn watch_effect(&mut self, now: Moment) {
        let Some(look) = self.gate.state().measured else { return };
        if self.seen.effects.last_reading.replace(look.received) == Some(look.received) {
            return;
        }
        let figures = self.figures();
        let can = self.setup.can();
        let shows_after = Duration::try_from_secs_f64(can.effect.shows_after_s).unwrap_or_default();
        let expected = self.expected(&look, shows_after);
        // Wind or somebody else may have moved the axis, so its angle proves no lack of effect.
        let suspects = self.gate.suspects(now);
        let effects = self.seen.effects.axes.iter_mut().zip(look.axes).zip(expected).zip(suspects);
        let mut missing = None;
        for (index, (((effect, axis), expected), is_suspect)) in
            effects.enumerate().take(can.axis_count())
        {
            effect.take(axis.angle_deg, look.asked, figures);
            let expected = expected.filter(|_| axis.angle_deg.is_some() && !is_suspect);
            if effect.is_missing(expected, look.asked, figures, shows_after) {
                missing = missing.or(Some(index));
            }
        }
        let Some(missing) = missing else { return };
        self.end_without_effect(can.axes.get(missing).copied(), now);
    }

    /// Stops a motion that has no effect, and reports it.
    pub(super) fn end_without_effect(&mut self, axis: Option<Name>, now: Moment) {
        if self.commanded.key.held().is_some() {
            self.commanded.key.spend();
            self.halt_quietly(now);
        } else {
            self.halt(now);
        }
        self.tell(Event::Safety(Safety::NoEffect { axis }));
    }

    fn expected(&self, look: &Measured, shows_after: Duration) -> [Option<Expected>; 2] {
        if self.stop.is_under_way() || !self.contact.is_open() {
            return [None; 2];
        }
        if let Some(jog) = self.commanded.key.started() {
            let rates =
                jog.rates_deg_s().into_iter().zip(self.is_at_own_end(look, jog.rates_deg_s()));
            let mut expected = [None; 2];
            let axes = look.axes.iter().zip(self.seen.effects.axes);
            for ((expected, (rate, is_at_end)), (axis, effect)) in
                expected.iter_mut().zip(rates).zip(axes)
            {
                // The unit itself ends a jog at its limits, which not every unit reports.
                let is_ended = effect.has_turned && axis.motion == AxisMotion::Still;
                let is_due = rate != 0.0 && !is_at_end && !is_ended;
                *expected = is_due.then_some(Expected::Rate(rate));
            }
            return expected;
        }
        let is_slew = self
            .commanded
            .activity
            .slew()
            .is_some_and(|slew| matches!(slew.stage, SlewStage::UnderWay { .. }));
        let is_track = matches!(self.commanded.activity, Activity::ProgramTrack(_));
        if !is_slew && !is_track {
            return [None; 2];
        }
        let can = self.setup.can();
        let finest_deg = can.arrives_within_deg
            + 2.0 * can.standstill.resolution_deg
            + self.figures().tolerance_deg();
        let effects = self.seen.effects.axes;
        // A unit may turn one axis after the other.
        let turned_lately = effects.map(|effect| {
            effect.changed.is_some_and(|(_, changed)| {
                look.asked.saturating_duration_since(changed) < shows_after
            })
        });
        let rates_deg_s = self.setup.track_config().rates_deg_s();
        let axes = look.axes.iter().zip(self.gate.sent_to_deg()).zip(effects).zip(rates_deg_s);
        let mut expected = [None; 2];
        for (index, (expected, (((axis, to_deg), effect), rate_deg_s))) in
            expected.iter_mut().zip(axes).enumerate()
        {
            let Some((angle_deg, to_deg)) = axis.angle_deg.zip(to_deg) else { continue };
            let is_driven = axis.motion != AxisMotion::Still;
            let other_turns = turned_lately.get(1 - index) == Some(&true);
            // One that stops on its way is reported as such, and the unit decides when to creep.
            let may_rest = !is_driven && (other_turns || (is_slew && effect.has_turned));
            let ignored_deg = if is_driven { 0.0 } else { can.effect.ignores_deg };
            let wraps = if index != 0 {
                Wraps::Never
            } else if self.gate.state().may_turn_either_way {
                Wraps::Always
            } else if can.azimuth_wraps && !is_driven && self.has_one_turn() {
                Wraps::AtRest { within_deg: can.rests_within_deg() }
            } else {
                Wraps::Never
            };
            let way_deg = wraps.way_deg(angle_deg, to_deg);
            let is_far = way_deg.abs() > finest_deg + ignored_deg;
            *expected = (is_far && !may_rest).then_some(Expected::Approach(rate_deg_s));
        }
        expected
    }

    /// Returns `true` if the azimuth axis reaches no direction twice but that of its ends.
    fn has_one_turn(&self) -> bool {
        let [(from_deg, to_deg), _] = self.gate.bounds().mount().travel_deg();
        to_deg - from_deg <= 360.0
    }

    /// Returns `true` for each axis that stands at an end of the unit's own travel and is jogged
    /// towards it.
    fn is_at_own_end(&self, look: &Measured, rates_deg_s: [f64; 2]) -> [bool; 2] {
        let can = self.setup.can();
        let near_deg = can.arrives_within_deg + 2.0 * can.standstill.resolution_deg;
        let travel_deg = self.gate.state().travel_deg;
        let mut is_at_end = [false; 2];
        let axes = look.axes.iter().zip(travel_deg).zip(rates_deg_s);
        for (is_at_end, ((axis, travel_deg), rate)) in is_at_end.iter_mut().zip(axes) {
            let Some((angle_deg, (from_deg, to_deg))) = axis.angle_deg.zip(travel_deg) else {
                continue;
            };
            let left_deg = if rate > 0.0 { to_deg - angle_deg } else { angle_deg - from_deg };
            *is_at_end = left_deg <= near_deg;
        }
        is_at_end
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
