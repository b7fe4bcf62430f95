//! The list of the day: what became of the passes of the schedule, and when automatic operation
//! was switched on, off or suspended.

use jiff::{Timestamp, tz::TimeZone};
use serde::{Deserialize, Serialize};

use super::operation::{
    Duty, GivenUp, Interruption, NotReady, OffBecause, Operation, Seen, is_same_pass,
};
use crate::{
    astro::{Angle, time::seconds_between},
    engine::{antenna::ErrorSample, passes::PassKey},
    station::AntennaId,
};

/// Most lines that are kept.
const MAX: usize = 400;
/// A direction that was measured longer ago tells nothing of now, seconds.
const FRESH_S: f64 = 3.0;
/// Share of a pass within half the beamwidth from which it counts as tracked.
const TRACKED: f64 = 0.995;

/// A line of the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DayLine {
    pub at: Timestamp,
    pub antenna: AntennaId,
    pub what: DayEvent,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DayEvent {
    SwitchedOn,
    SwitchedOff(OffBecause),
    Suspended(Interruption),
    WentOn,
    Flown(Flown),
    /// The clock of the unit was set between two passes.
    ClockSet {
        /// Seconds by which it was ahead of this computer's, negative if it was behind; `None` if it
        /// was never set.
        was_ahead_s: Option<f64>,
    },
    ClockNotSet {
        why: String,
    },
    /// Newer elements were uploaded to the unit between two passes, and verified.
    ElementsUploaded {
        file: String,
        satellites: usize,
    },
    ElementsNotUploaded {
        why: String,
    },
}

/// What became of a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Flown {
    pub pass: PassKey,
    /// Short name of the satellite.
    pub name: String,
    /// Seconds that were to be had.
    pub of_s: f64,
    /// Seconds of them within half the beamwidth.
    pub in_beam_s: f64,
    pub proved_at: Option<Timestamp>,
    /// Why most of the rest was lost; `None` where all of it was tracked.
    pub cause: Option<MissCause>,
}

impl Flown {
    pub fn lost_s(&self) -> f64 {
        (self.of_s - self.in_beam_s).max(0.0)
    }
}

/// Why a pass, or a part of it, was missed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MissCause {
    Off(OffBecause),
    Suspended(Interruption),
    LinkLost,
    /// After an outage nobody answered the question of tracking on.
    NotResumed,
    /// The unit or the gate refused it, or it could not be proved.
    Refused,
    NotReady(NotReady),
    /// The track was ended, because the antenna stayed off its target.
    OffTarget,
    /// It was tracked, but not all of it inside the beam.
    OutsideBeam,
}

/// A pass of the schedule while it is flown.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Flight {
    pub(super) duty: Duty,
    name: String,
    in_beam_s: f64,
    proved_at: Option<Timestamp>,
    /// Up to when it was looked at.
    seen_to: Timestamp,
    /// Seconds lost by each cause.
    lost: Vec<(MissCause, f64)>,
}

impl Flight {
    pub(super) fn new(duty: Duty, name: String) -> Self {
        let seen_to = duty.from;
        Self { duty, name, in_beam_s: 0.0, proved_at: None, seen_to, lost: Vec::new() }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Looks at the antenna at `now`, with the last measured error of this pass.
    pub(super) fn see(
        &mut self,
        operation: &Operation,
        seen: Seen,
        error: Option<&ErrorSample>,
        half_beam: Angle,
        now: Timestamp,
    ) {
        let taking = operation.taking();
        let taking = taking.filter(|taking| is_same_pass(taking.pass, self.duty.pass));
        self.proved_at = self.proved_at.or(taking.and_then(|taking| taking.proved_at));
        let to = now.min(self.duty.until);
        let passed_s = seconds_between(self.seen_to, to);
        if passed_s <= 0.0 {
            return;
        }
        self.seen_to = to;
        let is_fresh = |error: &&ErrorSample| seconds_between(error.time, now) < FRESH_S;
        if error.filter(is_fresh).is_some_and(|error| error.off_beam <= half_beam) {
            self.in_beam_s += passed_s;
            return;
        }
        let cause = match operation {
            Operation::Off(because) => MissCause::Off(*because),
            Operation::Suspended { by, .. } => MissCause::Suspended(*by),
            Operation::On(_) if !seen.is_live => MissCause::LinkLost,
            Operation::On(_) if seen.awaits_operator => MissCause::NotResumed,
            Operation::On(_) => match (seen.not_ready, taking.and_then(|taking| taking.given_up)) {
                (Some(why), _) => MissCause::NotReady(why),
                (None, Some(GivenUp::WouldMiss)) => MissCause::NotReady(NotReady::WouldMiss),
                (None, Some(GivenUp::Refused)) => MissCause::Refused,
                (None, Some(GivenUp::OffTarget)) => MissCause::OffTarget,
                (None, None) => MissCause::OutsideBeam,
            },
        };
        match self.lost.iter_mut().find(|(known, _)| *known == cause) {
            Some((_, lost_s)) => *lost_s += passed_s,
            None => self.lost.push((cause, passed_s)),
        }
    }

    /// What became of it.
    pub(super) fn end(self) -> Flown {
        let of_s = self.duty.counted_s;
        let in_beam_s = self.in_beam_s.min(of_s);
        let is_whole = in_beam_s >= TRACKED * of_s;
        let most = self.lost.iter().max_by(|(_, a), (_, b)| a.total_cmp(b));
        let cause = most.map_or(MissCause::OutsideBeam, |(cause, _)| *cause);
        Flown {
            pass: self.duty.pass,
            name: self.name,
            of_s,
            in_beam_s,
            proved_at: self.proved_at,
            cause: (!is_whole).then_some(cause),
        }
    }
}

/// Adds a line, and drops those of earlier days (UTC).
pub(super) fn add(list: &mut Vec<DayLine>, line: DayLine) {
    let day = |at: Timestamp| at.to_zoned(TimeZone::UTC).date();
    let today = day(line.at);
    list.retain(|known| day(known.at) == today);
    if list.len() >= MAX {
        list.remove(0);
    }
    list.push(line);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::time::add_seconds;

    fn at(second: f64) -> Timestamp {
        add_seconds(Timestamp::UNIX_EPOCH, second)
    }

    fn flight() -> Flight {
        let duty = Duty {
            pass: (7, at(100.0)),
            from: at(100.0),
            until: at(200.0),
            go_at: at(50.0),
            counted_s: 100.0,
            begins_late: false,
            ends_early: false,
        };
        Flight::new(duty, "SAT".to_owned())
    }

    /// Looks once a second at an antenna that is off its satellite by so much.
    fn see(
        flight: &mut Flight,
        seconds: std::ops::Range<i32>,
        operation: &Operation,
        is_live: bool,
        off_deg: Option<f64>,
    ) {
        for second in seconds {
            let now = at(f64::from(second));
            let error = off_deg.map(|off_deg| ErrorSample {
                time: now,
                off_beam: Angle::from_degrees(off_deg),
                azimuth: Angle::ZERO,
                elevation: Angle::ZERO,
            });
            let half_beam = Angle::from_degrees(0.5);
            let seen = Seen { is_live, ..Seen::default() };
            flight.see(operation, seen, error.as_ref(), half_beam, now);
        }
    }

    #[test]
    fn a_pass_inside_the_beam_from_end_to_end_is_tracked() {
        let mut flight = flight();
        see(&mut flight, 50..230, &Operation::switched_on(), true, Some(0.1));
        let flown = flight.end();
        assert!((flown.in_beam_s - 100.0).abs() < 1e-6, "{flown:?}");
        assert_eq!(flown.cause, None);
    }

    #[test]
    fn what_was_not_measured_inside_the_beam_is_lost_and_most_of_it_names_the_cause() {
        let on = Operation::switched_on();
        let off = Operation::Off(OffBecause::Stop);
        let by = Interruption::ByHand;
        let suspended = Operation::Suspended { by, since: at(0.0) };
        let lost = |parts: &[(std::ops::Range<i32>, &Operation, bool, Option<f64>)]| {
            let mut flight = flight();
            for (seconds, operation, is_live, off_deg) in parts {
                see(&mut flight, seconds.clone(), operation, *is_live, *off_deg);
            }
            let flown = flight.end();
            (flown.lost_s(), flown.cause)
        };
        let without_link = [(90..151, &on, false, None), (151..210, &on, true, Some(0.1))];
        assert_eq!(lost(&without_link), (50.0, Some(MissCause::LinkLost)));
        let beside = [(90..210, &on, true, Some(0.6))];
        assert_eq!(lost(&beside), (100.0, Some(MissCause::OutsideBeam)));
        let stopped = [(90..141, &on, true, Some(0.1)), (141..210, &off, true, None)];
        assert_eq!(lost(&stopped), (60.0, Some(MissCause::Off(OffBecause::Stop))));
        let by_hand = [(90..111, &on, false, None), (111..210, &suspended, true, Some(9.0))];
        assert_eq!(lost(&by_hand), (100.0, Some(MissCause::Suspended(by))));
    }

    #[test]
    fn an_old_measurement_tells_nothing() {
        let mut flight = flight();
        let error = ErrorSample {
            time: at(100.0),
            off_beam: Angle::ZERO,
            azimuth: Angle::ZERO,
            elevation: Angle::ZERO,
        };
        for second in 100..=200 {
            let now = at(f64::from(second));
            let half_beam = Angle::from_degrees(0.5);
            let seen = Seen { is_live: true, ..Seen::default() };
            flight.see(&Operation::switched_on(), seen, Some(&error), half_beam, now);
        }
        assert!((flight.end().in_beam_s - 2.0).abs() < 1e-6);
    }

    #[test]
    fn the_list_is_that_of_one_day() {
        let mut list = Vec::new();
        let line = |second: f64| DayLine {
            at: at(second),
            antenna: AntennaId(1),
            what: DayEvent::SwitchedOn,
        };
        for second in [10.0, 86_399.0, 86_401.0] {
            add(&mut list, line(second));
        }
        assert_eq!(list, [line(86_401.0)]);
    }
}
