//! Whether somebody else has turned an antenna that stands, or that settles after a motion. Its
//! angles show it at once, however short the motion was: one that settles swings less and less.

use std::{collections::VecDeque, time::Duration};

use super::seen::is_asked;
use crate::{
    clock::Instant,
    device::{Measured, Pointing},
    driver::Intent,
    engine::antenna::AntennaModel,
};

/// Largest error of a reading, besides its rounding, degrees.
const NOISE_DEG: f64 = 0.02;
/// An antenna that has turned by no more than noise for so long has settled.
const SETTLES: Duration = Duration::from_secs(10);
/// An antenna swings no further than this when its drives have come to rest, degrees.
const SWINGS_DEG: f64 = 3.0;
/// Time in which its swings become a third, seconds.
const CALMS_S: f64 = 2.0;
/// Positions that are kept of an antenna that settles.
const KEPT: usize = 100;
/// Where it stands is taken anew after this time: it may creep, and nobody turns it so slowly.
const CREEPS: Duration = Duration::from_mins(1);

/// Where an antenna stands of which nothing is asked.
#[derive(Default)]
pub(super) struct Stance {
    was_asked: Option<Asked>,
    /// When the last position that was looked at had been asked for.
    looked: Option<Instant>,
    at: At,
}

/// What was asked of it last. A new request moves it, and it settles again.
#[derive(PartialEq)]
struct Asked {
    intent: Intent,
    aim: Option<Pointing>,
    link_since: Option<Instant>,
}

#[derive(Default)]
enum At {
    #[default]
    Unknown,
    /// Its drives rest since then. `is_off`: it has turned further than it swings, by the last
    /// position.
    Settles { since: Instant, looks: VecDeque<Measured>, is_off: bool },
    /// It stands there. `is_off`: the last position was another one.
    Stands { there: Measured, is_off: bool },
}

impl Stance {
    /// Looks at the last position. Returns `true`, once, when somebody else has turned the
    /// antenna.
    pub(super) fn look(&mut self, antenna: &AntennaModel) -> bool {
        let (snapshot, can) = (&antenna.snapshot, antenna.variant().capabilities);
        let tracks = snapshot.state.program.is_some_and(|program| program.enabled);
        let rests = antenna.is_live() && !is_asked(snapshot) && !tracks;
        let was_asked = rests.then(|| Asked {
            intent: snapshot.intent,
            aim: snapshot.aim,
            link_since: snapshot.state.link_since,
        });
        if self.was_asked != was_asked {
            *self = Self { was_asked, ..Self::default() };
        }
        let look = snapshot.state.measured.filter(|_| self.was_asked.is_some());
        let Some(look) = look.filter(|look| self.looked != Some(look.asked)) else { return false };
        self.looked = Some(look.asked);
        let noise_deg = noise_deg(can.standstill.resolution_deg, antenna.config.sway_deg);
        self.at.look(look, noise_deg, |from| turned_deg(from, &look, can.axis_count()))
    }
}

impl At {
    fn look(
        &mut self,
        look: Measured,
        noise_deg: f64,
        turned_deg: impl Fn(&Measured) -> f64,
    ) -> bool {
        let is_past =
            |from: &Measured, time| look.asked.saturating_duration_since(from.asked) >= time;
        let has_turned = |from: &Measured| turned_deg(from) > noise_deg;
        match self {
            // What its drives still do may be the end of a motion.
            Self::Unknown if look.moving() => false,
            Self::Unknown => {
                *self = Self::settling(look);
                false
            }
            Self::Settles { since, looks, is_off } => {
                let swing_deg = |at: Instant| {
                    let rested_s = at.saturating_duration_since(*since).as_secs_f64();
                    SWINGS_DEG * (-rested_s / CALMS_S).exp()
                };
                let too_far = |from: &Measured| {
                    turned_deg(from) > noise_deg + swing_deg(from.asked) + swing_deg(look.asked)
                };
                if looks.iter().any(too_far) {
                    // One position alone may be misread.
                    if std::mem::replace(is_off, true) {
                        *self = Self::settling(look);
                        return true;
                    }
                    return false;
                }
                *is_off = false;
                let still = looks.iter().rev().take_while(|from| !has_turned(from)).last();
                if still.is_some_and(|from| is_past(from, SETTLES)) {
                    *self = Self::Stands { there: look, is_off: false };
                    return false;
                }
                if looks.len() >= KEPT {
                    looks.pop_front();
                }
                looks.push_back(look);
                false
            }
            Self::Stands { there, is_off } if !has_turned(there) => {
                if is_past(there, CREEPS) {
                    *there = look;
                }
                *is_off = false;
                false
            }
            Self::Stands { is_off, .. } => {
                if std::mem::replace(is_off, true) {
                    *self = Self::settling(look);
                    return true;
                }
                false
            }
        }
    }

    fn settling(look: Measured) -> Self {
        Self::Settles { since: look.asked, looks: VecDeque::from([look]), is_off: false }
    }
}

/// How far two positions of a standing axis may differ, degrees: both are rounded, and both are
/// wrong by noise.
fn noise_deg(resolution_deg: f64, sway_deg: f64) -> f64 {
    resolution_deg * 1.5 + NOISE_DEG * 2.0 + sway_deg
}

/// How far the axis has turned that has turned most, degrees.
fn turned_deg(from: &Measured, to: &Measured, axes: usize) -> f64 {
    let pairs = from.axes.iter().zip(&to.axes).take(axes);
    // An axis that stands at north may read 0 or 360.
    let turned = pairs.filter_map(|(from, to)| {
        let turned_deg = to.angle_deg? - from.angle_deg?;
        Some(((turned_deg + 180.0).rem_euclid(360.0) - 180.0).abs())
    });
    turned.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;
    use proptest::prelude::*;

    use super::*;
    use crate::device::{Axis, AxisMotion};

    /// Interval of looks, milliseconds.
    const LOOK_MS: u64 = 500;

    /// One axis that is looked at twice a second.
    struct Fixture {
        at: At,
        began: Instant,
        looks: u64,
        resolution_deg: f64,
    }

    impl Fixture {
        fn new(resolution_deg: f64) -> Self {
            Self { at: At::Unknown, began: Instant::now(), looks: 0, resolution_deg }
        }

        fn now_s(&self) -> f64 {
            Duration::from_millis(self.looks * LOOK_MS).as_secs_f64()
        }

        /// Looks at the axis at this angle, read with this error.
        fn look(&mut self, angle_deg: f64, error_deg: f64) -> bool {
            let read_deg = ((angle_deg + error_deg) / self.resolution_deg).round();
            let asked = self.began + Duration::from_millis(self.looks * LOOK_MS);
            self.looks += 1;
            let axis = |angle_deg| Axis {
                angle_deg: Some(angle_deg),
                motion: AxisMotion::Still,
                plus_limit: false,
                minus_limit: false,
            };
            let look = Measured {
                at: Timestamp::UNIX_EPOCH,
                asked,
                received: asked,
                pointing: Pointing { azimuth: None, elevation: None },
                axes: [axis(read_deg * self.resolution_deg), axis(0.0)],
            };
            let noise_deg = noise_deg(self.resolution_deg, 0.0);
            self.at.look(look, noise_deg, |from| turned_deg(from, &look, 2))
        }
    }

    fn resolutions() -> impl Strategy<Value = f64> {
        prop_oneof![Just(1.0), Just(0.1), Just(0.01)]
    }

    fn errors(count: usize) -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(-NOISE_DEG..=NOISE_DEG, count)
    }

    proptest! {
        #[test]
        fn an_antenna_that_settles_and_stands_with_noise_was_turned_by_nobody(
            resolution_deg in resolutions(),
            swings_deg in 0.0..SWINGS_DEG,
            period_s in 0.3..6.0_f64,
            calms_s in 0.1..CALMS_S,
            creeps_deg_s in -0.00005..0.00005_f64,
            stands_deg in 0.0..360.0_f64,
            errors in errors(600),
        ) {
            let mut fixture = Fixture::new(resolution_deg);
            for error_deg in errors {
                let now_s = fixture.now_s();
                let swing_deg = swings_deg * (-now_s / calms_s).exp();
                let swing_deg = swing_deg * (std::f64::consts::TAU * now_s / period_s).sin();
                let angle_deg = stands_deg + creeps_deg_s * now_s + swing_deg;
                prop_assert!(!fixture.look(angle_deg, error_deg), "after {now_s} s");
            }
        }

        #[test]
        fn one_that_is_turned_beyond_noise_is_seen_within_two_looks(
            resolution_deg in resolutions(),
            // Beyond what rounding can take away.
            steps in 2.0..50.0_f64,
            is_back in any::<bool>(),
            stands_deg in 0.0..360.0_f64,
            errors in errors(80),
        ) {
            let mut fixture = Fixture::new(resolution_deg);
            let turned_deg = (steps + 0.5) * resolution_deg + NOISE_DEG * 4.0;
            let turned_deg = if is_back { -turned_deg } else { turned_deg };
            let mut seen_at = None;
            for (look, error_deg) in errors.into_iter().enumerate() {
                let angle_deg = stands_deg + if look < 40 { 0.0 } else { turned_deg };
                if fixture.look(angle_deg, error_deg) && seen_at.is_none() {
                    seen_at = Some(look);
                }
            }
            prop_assert_eq!(seen_at, Some(41));
        }
    }

    proptest! {
        #[test]
        fn one_that_is_turned_while_it_settles_further_than_it_swings_is_seen_within_two_looks(
            resolution_deg in resolutions(),
            at in 2..18_usize,
            steps in 2.0..50.0_f64,
            is_back in any::<bool>(),
            stands_deg in 0.0..360.0_f64,
            errors in errors(30),
        ) {
            let mut fixture = Fixture::new(resolution_deg);
            let swing_deg = |look: usize| SWINGS_DEG * (-(look as f64) * 0.5 / CALMS_S).exp();
            let swings_deg = swing_deg(at - 1) + swing_deg(at);
            let turned_deg = (steps + 0.5) * resolution_deg + NOISE_DEG * 4.0 + swings_deg;
            let turned_deg = if is_back { -turned_deg } else { turned_deg };
            let mut seen_at = None;
            for (look, error_deg) in errors.into_iter().enumerate() {
                let angle_deg = stands_deg + if look < at { 0.0 } else { turned_deg };
                if fixture.look(angle_deg, error_deg) && seen_at.is_none() {
                    seen_at = Some(look);
                }
            }
            prop_assert_eq!(seen_at, Some(at + 1));
        }
    }

    #[test]
    fn one_position_that_is_misread_turns_nothing() {
        let mut fixture = Fixture::new(0.1);
        let seen =
            (0..160).filter(|look| fixture.look(if look % 40 == 39 { 250.0 } else { 80.0 }, 0.0));
        assert_eq!(seen.count(), 0);
        assert!(matches!(fixture.at, At::Stands { is_off: true, .. }), "the last one");
    }
}
