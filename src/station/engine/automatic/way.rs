//! Whether somebody else turns an antenna on its way to a pass. Whichever way round a unit takes,
//! each axis goes one way, so that one that turns back was turned: against its drives, past its
//! place, or taken back by its drives from where it had been turned.

use std::time::Duration;

use super::course::Look;
use crate::{
    clock::Instant,
    device::{Measured, Pointing},
};

/// Drives that turned when they were sent elsewhere may turn on for so long.
const COASTS: Duration = Duration::from_secs(5);
/// After a longer gap nobody knows which way an axis went.
const GAP: Duration = Duration::from_secs(10);
/// A place within this many degrees is the same place: elements and clocks move it.
const SAME_PLACE_DEG: f64 = 1.0;

/// What an antenna is on its way to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Goal {
    /// The place where a pass of the satellite `of` begins; `at` is `None` where the unit does not
    /// say where that is.
    Place { of: Option<u32>, at: Option<Pointing> },
    /// The satellite. A unit may change the way round when it moves.
    Satellite(Look),
}

/// The way of both axes since the antenna was sent to its goal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    goal: Goal,
    coasts_until: Instant,
    looked: Instant,
    axes: [Option<AxisWay>; 2],
}

impl Way {
    pub(super) fn new(goal: Goal, look: Measured) -> Self {
        let coasts = if look.moving() { COASTS } else { Duration::ZERO };
        let axes = [None; 2];
        Self { goal, coasts_until: look.asked + coasts, looked: look.asked, axes }
    }

    /// Takes a new position of an antenna on its way to `goal`. Returns `true` if an axis has
    /// turned back.
    pub(super) fn look(&mut self, goal: Goal, look: Measured, swing_deg: f64) -> bool {
        let gap = look.asked.saturating_duration_since(self.looked);
        if !goal.continues(&self.goal) || gap > GAP {
            *self = Self::new(goal, look);
            return false;
        }
        (self.looked, self.goal) = (look.asked, goal);
        let may_coast = look.asked < self.coasts_until;
        let mut is_turned = false;
        for (axis, now) in self.axes.iter_mut().zip(&look.axes) {
            let Some(at_deg) = now.angle_deg else {
                *axis = None;
                continue;
            };
            match axis {
                None => *axis = Some(AxisWay::new(at_deg, goal)),
                Some(axis) => {
                    let turns_back = axis.look(at_deg, goal, swing_deg);
                    let coasted = turns_back && may_coast && !axis.has_coasted;
                    axis.has_coasted |= coasted;
                    is_turned |= turns_back && !coasted;
                }
            }
        }
        is_turned
    }
}

impl Goal {
    /// The antenna has not been sent elsewhere since `before`.
    fn continues(&self, before: &Self) -> bool {
        match (self, before) {
            (Self::Place { of, at }, Self::Place { of: of_before, at: before }) => {
                let off = at.zip(*before).and_then(|(at, before)| at.separation(before));
                let is_there = match off {
                    Some(off) => off.degrees() <= SAME_PLACE_DEG,
                    None => at == before,
                };
                of == of_before && is_there
            }
            (Self::Satellite(_), Self::Satellite(_)) => true,
            _ => false,
        }
    }

    /// No change of the way round explains that the antenna has turned back since `then`.
    fn is_further_off(self, then: Self, swing_deg: f64) -> bool {
        match (self, then) {
            (Self::Satellite(now), Self::Satellite(then)) => now.is_turned_since(&then, swing_deg),
            _ => true,
        }
    }
}

/// The way of one axis.
#[derive(Debug, Clone, Copy)]
struct AxisWay {
    /// The last two angles, degrees, without a jump at north.
    last_deg: [f64; 2],
    clockwise: OneWay,
    counter_clockwise: OneWay,
    /// It has turned back once, after an earlier motion.
    has_coasted: bool,
}

impl AxisWay {
    fn new(at_deg: f64, goal: Goal) -> Self {
        Self {
            last_deg: [at_deg; 2],
            clockwise: OneWay::new(at_deg, goal),
            counter_clockwise: OneWay::new(-at_deg, goal),
            has_coasted: false,
        }
    }

    fn look(&mut self, read_deg: f64, goal: Goal, swing_deg: f64) -> bool {
        let turned = |from: f64| (read_deg - from + 180.0).rem_euclid(360.0) - 180.0;
        let [earlier, before] = self.last_deg;
        // The one before may be misread.
        let nearest = [before, earlier]
            .into_iter()
            .min_by(|one, other| turned(*one).abs().total_cmp(&turned(*other).abs()));
        let at_deg = nearest.map_or(before, |from| from + turned(from));
        self.last_deg = [before, at_deg];
        let clockwise = self.clockwise.look([before, at_deg], goal, swing_deg);
        let counter = self.counter_clockwise.look([-before, -at_deg], goal, swing_deg);
        clockwise || counter
    }
}

/// How far an axis has gone in one direction of turn, degrees. One position alone may be misread:
/// what counts is where two in a row have been.
#[derive(Debug, Clone, Copy)]
struct OneWay {
    from_deg: f64,
    furthest_deg: f64,
    /// The goal, when it was there.
    goal: Goal,
}

impl OneWay {
    fn new(at_deg: f64, goal: Goal) -> Self {
        Self { from_deg: at_deg, furthest_deg: at_deg, goal }
    }

    /// Returns `true` if the axis has come back from where it had gone.
    fn look(&mut self, [before_deg, now_deg]: [f64; 2], goal: Goal, swing_deg: f64) -> bool {
        if before_deg.min(now_deg) > self.furthest_deg {
            *self = Self { furthest_deg: before_deg.min(now_deg), goal, ..*self };
        }
        let most_deg = before_deg.max(now_deg);
        let has_gone = self.furthest_deg - self.from_deg > swing_deg;
        let is_back = most_deg < self.furthest_deg - swing_deg;
        let is_turned = has_gone && is_back && goal.is_further_off(self.goal, swing_deg);
        if most_deg < self.from_deg || is_turned {
            *self = Self::new(most_deg, goal);
        }
        is_turned
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;
    use proptest::prelude::*;

    use super::*;
    use crate::{
        astro::AzEl,
        device::{Axis, AxisMotion},
    };

    /// Interval of looks, seconds.
    const LOOK_S: f64 = 0.5;
    const LOOK: Duration = Duration::from_millis(500);
    const SWING_DEG: f64 = 3.0;
    const START: Goal = Goal::Place { of: Some(25_544), at: None };

    fn measured(look: usize, azimuth_deg: f64, moves: bool) -> Measured {
        let motion = if moves { AxisMotion::Plus } else { AxisMotion::Still };
        let axis = |angle_deg| Axis { angle_deg, motion, plus_limit: false, minus_limit: false };
        let asked = began() + LOOK * look as u32;
        Measured {
            at: Timestamp::UNIX_EPOCH,
            asked,
            received: asked,
            pointing: AzEl::from_degrees(azimuth_deg, 10.0).into(),
            axes: [axis(Some(azimuth_deg.rem_euclid(360.0))), axis(None)],
        }
    }

    fn began() -> Instant {
        thread_local!(static BEGAN: Instant = Instant::now());
        BEGAN.with(|began| *began)
    }

    /// The first look at which an antenna at these azimuths, one a look, has turned back.
    fn turned_back(looks: impl IntoIterator<Item = (f64, Goal)>) -> Option<usize> {
        let mut way = None;
        looks.into_iter().enumerate().position(|(look, (azimuth_deg, goal))| {
            let measured = measured(look, azimuth_deg, look > 0);
            way.get_or_insert_with(|| Way::new(goal, measured)).look(goal, measured, SWING_DEG)
        })
    }

    /// Azimuths of an axis that turns from `from_deg` to `to_deg`, where it swings.
    fn azimuths(from_deg: f64, to_deg: f64, rate_deg_s: f64) -> impl Iterator<Item = f64> {
        (0..).map(move |look| {
            let turned_deg = rate_deg_s * LOOK_S * f64::from(look);
            let left_deg = (to_deg - from_deg).abs() - turned_deg;
            let swing_deg = SWING_DEG * 0.45 * (f64::from(look) * 0.7).sin();
            to_deg - (to_deg - from_deg).signum() * left_deg.max(0.0) + swing_deg
        })
    }

    proptest! {
        #[test]
        fn one_that_goes_its_way_was_turned_by_nobody(
            from_deg in -90.0..450.0_f64,
            to_deg in -90.0..450.0_f64,
            rate_deg_s in 0.5..15.0_f64,
            misread in 1..30_usize,
        ) {
            let all = azimuths(from_deg, to_deg, rate_deg_s).enumerate().take(300);
            let read = all.map(|(look, deg)| if look % 40 == misread { 70.0 } else { deg });
            prop_assert_eq!(turned_back(read.map(|deg| (deg, START))), None);
        }

        #[test]
        fn one_that_is_turned_on_its_way_is_seen_at_once_or_when_it_is_taken_back(
            from_deg in 0.0..100.0_f64,
            way_deg in 60.0..200.0_f64,
            is_counter in any::<bool>(),
            rate_deg_s in 1.0..6.0_f64,
            turned_deg in 15.0..90.0_f64,
            is_ahead in any::<bool>(),
        ) {
            let sign = if is_counter { -1.0 } else { 1.0 };
            let to_deg = from_deg + way_deg * sign;
            // Turned for ten looks when it is half way; the drives then take it to its place.
            let half = (way_deg / 2.0 / rate_deg_s / LOOK_S) as usize;
            let mut at_deg = from_deg;
            let looks = (0..4 * half + 400).map(|look| {
                if (half..half + 10).contains(&look) {
                    let turned_deg = if is_ahead { way_deg } else { -turned_deg };
                    at_deg += turned_deg * sign / 10.0;
                } else {
                    let most_deg = rate_deg_s * LOOK_S;
                    at_deg += (to_deg - at_deg).clamp(-most_deg, most_deg);
                }
                (at_deg, START)
            });
            let looks: Vec<_> = looks.collect();
            let seen = turned_back(looks);
            let by = if is_ahead { half + 10 + (way_deg / rate_deg_s) as usize * 2 } else { half + 9 };
            prop_assert!(seen.is_some_and(|look| half < look && look <= by), "{seen:?}, {half}");
        }

        #[test]
        fn one_that_changes_its_way_round_to_a_satellite_is_nobody_elses(
            rate_deg_s in 0.5..4.0_f64,
            from_deg in 0.0..360.0_f64,
            satellite_deg in 0.0..360.0_f64,
            satellite_deg_s in -12.0..12.0_f64,
        ) {
            let mut at_deg = from_deg;
            let looks = (0..400).map(|look| {
                let target_deg = satellite_deg + satellite_deg_s * LOOK_S * f64::from(look);
                let most_deg = rate_deg_s * LOOK_S;
                let shorter_deg = (target_deg - at_deg + 180.0).rem_euclid(360.0) - 180.0;
                at_deg += shorter_deg.clamp(-most_deg, most_deg);
                let target = AzEl::from_degrees(target_deg, 10.0);
                let off = AzEl::from_degrees(at_deg, 10.0).separation(target);
                let asked = began() + LOOK * look as u32;
                (at_deg, Goal::Satellite(Look { asked, off, target: target.into() }))
            });
            let looks: Vec<_> = looks.collect();
            prop_assert_eq!(turned_back(looks), None);
        }
    }

    #[test]
    fn one_that_is_turned_away_from_a_satellite_that_it_slews_to_is_seen() {
        let target = AzEl::from_degrees(180.0, 10.0);
        let looks = (0..60).map(|look| {
            let at_deg =
                if look < 20 { f64::from(look) * 2.0 } else { 38.0 - f64::from(look - 20) };
            let off = AzEl::from_degrees(at_deg, 10.0).separation(target);
            let asked = began() + LOOK * look as u32;
            (at_deg, Goal::Satellite(Look { asked, off, target: target.into() }))
        });
        assert!(turned_back(looks).is_some_and(|look| look < 30));
    }

    #[test]
    fn drives_that_were_sent_elsewhere_may_coast() {
        let goal = |azimuth_deg| Goal::Place {
            of: None,
            at: Some(AzEl::from_degrees(azimuth_deg, 10.0).into()),
        };
        let out = (0..20).map(|look| (f64::from(look) * 3.0, goal(300.0)));
        let coasts = (0..6).map(|look| (60.0 + f64::from(look) * 2.0, goal(10.0)));
        let back = (0..20).map(|look| (70.0 - f64::from(look) * 3.0, goal(10.0)));
        assert_eq!(turned_back(out.chain(coasts).chain(back)), None);
    }
}
