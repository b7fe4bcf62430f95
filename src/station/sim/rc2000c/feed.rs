//! Polarization by a polarotor or a rotating feed. Rates are the simulator's own choices.

use std::ops::RangeInclusive;

use crate::protocol::rc2000c::{
    FeedPosition, FeedReading, PolarizationDevice, PolarizationMotion, Sense,
};

const RATE_UNITS_S: f64 = 60.0;
/// Duration of a jog, seconds; a real unit has it in its configuration.
const JOG_S: f64 = 0.5;
const POLAROTOR_TRAVEL: RangeInclusive<f64> = 0.0..=661.0;
/// User limits of the rotating feed, in its units.
const ROTATING_TRAVEL: RangeInclusive<f64> = 11.0..=1012.0;

#[derive(Debug, Clone, Copy, PartialEq)]
enum FeedGoal {
    Still,
    /// Jog with its remaining seconds; a positive sense is counter-clockwise.
    Jog(Sense, f64),
    Position(f64),
}

/// Device that turns the polarization.
#[derive(Debug, Clone)]
pub(super) struct Feed {
    is_rotating: bool,
    units: f64,
    goal: FeedGoal,
}

impl Feed {
    pub(super) fn new(units: u16) -> Self {
        Self { is_rotating: false, units: units.into(), goal: FeedGoal::Still }
    }

    /// Selects a rotating feed or a polarotor.
    pub(super) fn set_rotating(&mut self, is_rotating: bool) {
        self.is_rotating = is_rotating;
        let travel = self.travel();
        self.units = self.units.clamp(*travel.start(), *travel.end());
    }

    pub(super) fn is_rotating(&self) -> bool {
        self.is_rotating
    }

    fn travel(&self) -> RangeInclusive<f64> {
        if self.is_rotating { ROTATING_TRAVEL } else { POLAROTOR_TRAVEL }
    }

    pub(super) fn reaches(&self, units: u16) -> bool {
        self.travel().contains(&units.into())
    }

    pub(super) fn units(&self) -> u16 {
        self.units.round() as u16
    }

    /// Turns for a fixed time; a positive sense is counter-clockwise.
    pub(super) fn jog(&mut self, sense: Sense) {
        self.goal = FeedGoal::Jog(sense, JOG_S);
    }

    pub(super) fn go_to(&mut self, units: u16) {
        self.goal = FeedGoal::Position(units.into());
    }

    pub(super) fn motion(&self) -> PolarizationMotion {
        match self.goal {
            FeedGoal::Still => PolarizationMotion::Still,
            FeedGoal::Jog(Sense::Negative, _) => PolarizationMotion::JogClockwise,
            FeedGoal::Jog(Sense::Positive, _) => PolarizationMotion::JogCounterClockwise,
            FeedGoal::Position(_) => PolarizationMotion::ToStored,
        }
    }

    pub(super) fn reading(&self) -> FeedReading {
        if !self.is_rotating {
            return FeedReading::polarotor(self.units());
        }
        let at_limit = |position| FeedReading {
            device: PolarizationDevice::RotatingFeed,
            position,
            fine_steps: 0,
        };
        if self.units <= *ROTATING_TRAVEL.start() {
            at_limit(FeedPosition::ClockwiseLimit)
        } else if self.units >= *ROTATING_TRAVEL.end() {
            at_limit(FeedPosition::CounterClockwiseLimit)
        } else {
            FeedReading::rotating_feed(self.units())
        }
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        let max = RATE_UNITS_S * step_s;
        match &mut self.goal {
            FeedGoal::Still => {}
            FeedGoal::Jog(sense, left_s) => {
                let turned = RATE_UNITS_S * step_s.min(*left_s);
                *left_s -= step_s;
                self.units += if *sense == Sense::Positive { turned } else { -turned };
                if *left_s <= 0.0 {
                    self.goal = FeedGoal::Still;
                }
            }
            FeedGoal::Position(target) => {
                self.units += (*target - self.units).clamp(-max, max);
                if (*target - self.units).abs() < 0.5 {
                    self.goal = FeedGoal::Still;
                }
            }
        }
        let travel = self.travel();
        self.units = self.units.clamp(*travel.start(), *travel.end());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(feed: &mut Feed, seconds: f64) {
        for _ in 0..(seconds / 0.05).round() as usize {
            feed.advance(0.05);
        }
    }

    #[test]
    fn a_jog_lasts_its_time_and_counter_clockwise_grows() {
        let mut feed = Feed::new(300);
        feed.jog(Sense::Positive);
        assert_eq!(feed.motion(), PolarizationMotion::JogCounterClockwise);
        run(&mut feed, 1.0);
        assert_eq!((feed.units(), feed.motion()), (330, PolarizationMotion::Still));
        feed.jog(Sense::Negative);
        run(&mut feed, 1.0);
        assert_eq!(feed.units(), 300);
    }

    #[test]
    fn a_limit_shows_instead_of_a_number() {
        let mut feed = Feed::new(600);
        feed.go_to(661);
        run(&mut feed, 3.0);
        assert_eq!(feed.reading().position, FeedPosition::CounterClockwiseLimit);
        assert_eq!(feed.reading().units(), Some(661));
        feed.set_rotating(true);
        assert!(feed.reaches(1012) && !feed.reaches(1013) && !feed.reaches(10));
        feed.go_to(1012);
        run(&mut feed, 10.0);
        assert_eq!(feed.reading().position, FeedPosition::CounterClockwiseLimit);
        assert_eq!(feed.reading().units(), None);
    }
}
