//! Whether somebody else turns an antenna that tracks a satellite, waits for it, or is on its way.
//! Its drives turn it only towards the satellite, so that it falls behind by what the satellite
//! moves, and by no more.

use std::{collections::VecDeque, time::Duration};

use super::way::{Goal, Way};
use crate::{
    astro::Angle,
    clock::Instant,
    device::{Measured, Phase, Pointing},
    engine::antenna::AntennaModel,
    plan::TrackPhase,
};

/// An antenna that follows a path leaves it by no more than this, degrees: it swings, and gusts
/// push it.
const SWINGS_DEG: f64 = 3.0;
/// Looks are compared within this time.
const KEPT: Duration = Duration::from_secs(10);
/// To a satellite so near to an end of its travel, in degrees, an azimuth axis may turn the long
/// way: its unit may keep off the end.
const NEAR_END_DEG: f64 = 3.0;

/// The last looks at an antenna that has a pass to take.
#[derive(Default)]
pub(super) struct Course {
    /// On its way there.
    way: Option<Way>,
    /// While it follows its satellite, or waits for it.
    looks: VecDeque<Look>,
    /// Where the unit waits for its satellite.
    start: Option<Pointing>,
    /// The last look was too far off.
    is_off: bool,
    /// When the last position that was looked at had been asked for.
    looked: Option<Instant>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    pub(super) asked: Instant,
    pub(super) off: Angle,
    pub(super) target: Pointing,
}

impl Course {
    /// Looks at the last position. Returns `true`, once, when somebody else has turned the
    /// antenna.
    pub(super) fn look(&mut self, antenna: &AntennaModel) -> bool {
        // New offsets of the unit's own track turn the antenna off the path that is known here.
        let is_shifted =
            antenna.snapshot.unit_offsets.as_ref().is_some_and(|unit| unit.is_changing);
        let is_known = antenna.is_live() && !is_shifted;
        let measured = antenna.snapshot.state.measured.filter(|_| is_known);
        let Some(measured) = measured else {
            *self = Self { start: self.start, ..Self::default() };
            return false;
        };
        if self.looked.replace(measured.asked) == Some(measured.asked) {
            return false;
        }
        let swing_deg = SWINGS_DEG + antenna.config.sway_deg;
        let follows_within_deg = antenna.config.beam_width().degrees() * 0.5 + swing_deg;
        let target = self.target(antenna, measured);
        let look = target.and_then(|target| Look::new(measured, target));
        let look = look.filter(|look| !may_turn_round(antenna, measured, look.target));
        let goes_to = place(antenna).or_else(|| {
            look.filter(|look| look.off.degrees() > follows_within_deg).map(Goal::Satellite)
        });
        let is_turned_back = goes_to.is_some_and(|goal| {
            let way = self.way.get_or_insert_with(|| Way::new(goal, measured));
            way.look(goal, measured, swing_deg)
        });
        self.way.take_if(|_| goes_to.is_none() || is_turned_back);
        let Some(look) = look else {
            (self.is_off, self.looks) = Default::default();
            return is_turned_back;
        };
        self.take(look, swing_deg, follows_within_deg) || is_turned_back
    }

    /// Where the antenna is to point at the last position: to its satellite, or, before AOS, to
    /// the start of the pass.
    fn target(&mut self, antenna: &AntennaModel, measured: Measured) -> Option<Pointing> {
        let waits = waits_by_itself(antenna);
        // The unit does not say where the start is.
        let stands = waits && self.start.is_none() && !measured.moving();
        self.start = self.start.filter(|_| waits).or(stands.then_some(measured.pointing));
        let track = antenna.snapshot.program_track.as_ref();
        match track.map(|track| track.phase) {
            Some(TrackPhase::Waiting { .. }) => track?.commanded,
            _ if waits => self.start,
            _ => {
                let prediction = antenna.prediction.filter(|_| antenna.tracks())?;
                (prediction.at == measured.at).then(|| prediction.direction.into())
            }
        }
    }

    /// An antenna that is off by more than `follows_within_deg` does not follow.
    fn take(&mut self, look: Look, swing_deg: f64, follows_within_deg: f64) -> bool {
        self.looks.retain(|from| look.asked.saturating_duration_since(from.asked) <= KEPT);
        if self.looks.iter().any(|from| look.is_turned_since(from, swing_deg)) {
            // One position alone may be misread.
            let is_turned = std::mem::replace(&mut self.is_off, true);
            if is_turned {
                self.looks.clear();
            }
            return is_turned;
        }
        self.is_off = false;
        if look.off.degrees() > follows_within_deg {
            self.looks.clear();
        } else {
            self.looks.push_back(look);
        }
        false
    }
}

/// Where the antenna was sent to wait for its pass.
fn place(antenna: &AntennaModel) -> Option<Goal> {
    let track = antenna.snapshot.program_track.as_ref();
    let track = track.filter(|track| matches!(track.phase, TrackPhase::Waiting { .. }));
    let of = antenna.tracked_number();
    match track {
        Some(track) => Some(Goal::Place { of, at: Some(track.commanded?) }),
        None => waits_by_itself(antenna).then_some(Goal::Place { of, at: None }),
    }
}

/// Returns `true` if the unit waits at the start of a pass, or goes there, by its own program.
fn waits_by_itself(antenna: &AntennaModel) -> bool {
    let program = antenna.snapshot.state.program;
    program.is_some_and(|it| it.enabled && it.phase == Phase::AtStart)
}

impl Look {
    fn new(measured: Measured, target: Pointing) -> Option<Self> {
        let has_elevation = measured.pointing.elevation.is_some();
        let target = Pointing { elevation: target.elevation.filter(|_| has_elevation), ..target };
        let off = measured.pointing.separation(target)?;
        Some(Self { asked: measured.asked, off, target })
    }

    /// Further off than an antenna that has stood still since `from`.
    pub(super) fn is_turned_since(&self, from: &Self, swing_deg: f64) -> bool {
        let moved = self.target.separation(from.target).unwrap_or(Angle::ZERO);
        self.off.degrees() > from.off.degrees() + moved.degrees() + swing_deg
    }
}

/// Returns `true` if the azimuth axis may have to turn the long way to `target`.
fn may_turn_round(antenna: &AntennaModel, measured: Measured, target: Pointing) -> bool {
    let mount = antenna.config.mount.within(antenna.snapshot.state.travel_deg);
    let [travel_deg, _] = mount.travel_deg();
    let at_deg = measured.axes.first().and_then(|axis| axis.angle_deg);
    let ends = at_deg.zip(target.azimuth).map(|(at_deg, to)| (at_deg, to.degrees()));
    ends.is_some_and(|(at_deg, to_deg)| is_beyond(travel_deg, at_deg, to_deg))
}

/// Returns `true` if the shorter way from `at_deg` to `azimuth_deg` leads out of the travel of the
/// axis, or close to its end.
fn is_beyond((from_deg, to_deg): (f64, f64), at_deg: f64, azimuth_deg: f64) -> bool {
    let goes_to_deg = at_deg + (azimuth_deg - at_deg + 180.0).rem_euclid(360.0) - 180.0;
    to_deg - from_deg > 180.0
        && !(from_deg + NEAR_END_DEG..=to_deg - NEAR_END_DEG).contains(&goes_to_deg)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::astro::AzEl;

    /// Interval of looks, seconds.
    const LOOK_S: f64 = 0.5;
    const LOOK: Duration = Duration::from_millis(500);

    fn course(offs_deg: impl IntoIterator<Item = (f64, f64)>) -> Option<usize> {
        let (mut course, began) = (Course::default(), Instant::now());
        offs_deg.into_iter().enumerate().position(|(look, (azimuth_deg, off_deg))| {
            let look = Look {
                asked: began + LOOK * look as u32,
                off: Angle::from_degrees(off_deg),
                target: AzEl::from_degrees(azimuth_deg, 0.0).into(),
            };
            course.take(look, SWINGS_DEG, 2.0 + SWINGS_DEG)
        })
    }

    proptest! {
        #[test]
        fn drives_that_turn_towards_the_satellite_are_nobody_elses(
            rate_deg_s in 0.0..3.0_f64,
            start_deg in -40.0..40.0_f64,
            most_deg_s in prop::collection::vec(0.0..6.0_f64, 200),
        ) {
            // Also with drives that are too weak, or that stop, and by any way to the satellite.
            let mut at_deg = start_deg;
            let looks = most_deg_s.iter().enumerate().map(|(look, most_deg_s)| {
                let satellite_deg = rate_deg_s * LOOK_S * look as f64;
                let most_deg = most_deg_s * LOOK_S;
                at_deg += (satellite_deg - at_deg).clamp(-most_deg, most_deg);
                (satellite_deg, (satellite_deg - at_deg).abs())
            });
            prop_assert_eq!(course(looks), None);
        }

        #[test]
        fn one_that_is_turned_away_is_seen_within_two_looks(
            rate_deg_s in 0.0..1.0_f64,
            error_deg in 0.0..2.0_f64,
            turned_deg in 8.0..90.0_f64,
        ) {
            let looks = (0..30).map(|look| {
                let off_deg = if look < 10 { error_deg } else { turned_deg };
                (rate_deg_s * LOOK_S * f64::from(look), off_deg)
            });
            prop_assert_eq!(course(looks), Some(11));
        }

        #[test]
        fn one_that_is_turned_away_slowly_is_seen_once_it_is_off_its_path(
            rate_deg_s in 0.0..0.5_f64,
            turns_deg_s in 1.5..6.0_f64,
        ) {
            let looks = (0..60).map(|look| {
                let turned_s = LOOK_S * f64::from((look - 20).max(0));
                (rate_deg_s * LOOK_S * f64::from(look), turns_deg_s * turned_s)
            });
            let seen = course(looks);
            prop_assert!(seen.is_some_and(|look| look < 40), "{seen:?}");
        }
    }

    #[test]
    fn an_axis_turns_round_only_for_what_lies_at_or_beyond_an_end() {
        let whole = (0.0, 360.0);
        assert!(!is_beyond(whole, 350.0, 340.0), "back from the end");
        assert!(!is_beyond(whole, 355.0, 356.0));
        assert!(is_beyond(whole, 355.0, 2.0) && is_beyond(whole, 350.0, 358.0));
        assert!(!is_beyond((-90.0, 450.0), 355.0, 2.0) && is_beyond((-90.0, 450.0), 440.0, 91.0));
        assert!(!is_beyond((5.0, 175.0), 10.0, 4.0), "a crossed axis");
    }

    #[test]
    fn one_position_that_is_misread_turns_nothing() {
        let looks = (0..100).map(|look| (0.0, if look % 20 == 19 { 70.0 } else { 0.1 }));
        assert_eq!(course(looks), None);
    }
}
