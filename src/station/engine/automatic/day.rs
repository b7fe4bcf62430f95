//! List of the day: outcomes of scheduled passes, and times when automatic operation was switched
//! on, off or suspended.

use jiff::{Timestamp, tz::TimeZone};

use super::operation::{Duty, Observation, is_same_pass};
use crate::{
    astro::time::seconds_between,
    contract::automatic::{DayLine, Flown, GivenUp, MissCause, NotReady, Operation},
    plan::pass_report::{LossCause, LostStretch, PassReport},
};

/// Max number of kept lines.
const MAX: usize = 400;
/// Min share of a pass within half the beamwidth for a tracked pass.
const TRACKED: f64 = 0.995;

/// Scheduled pass while an antenna flies it.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::engine) struct Flight {
    pub(in crate::engine) duty: Duty,
    name: String,
    proved_at: Option<Timestamp>,
    /// End of the observed time.
    seen_to: Timestamp,
    /// Times when automatic operation did not track the pass, with the reason.
    hindered: Vec<Hindered>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Hindered {
    start: Timestamp,
    end: Timestamp,
    miss_cause: MissCause,
}

impl Flight {
    pub(super) fn new(duty: Duty, name: String) -> Self {
        let seen_to = duty.start;
        Self { duty, name, proved_at: None, seen_to, hindered: Vec::new() }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Observes the antenna's automatic operation at `now`.
    pub(super) fn see(&mut self, operation: &Operation, observation: Observation, now: Timestamp) {
        let taking = operation.taking();
        let taking = taking.filter(|taking| is_same_pass(taking.pass, self.duty.pass));
        self.proved_at = self.proved_at.or(taking.and_then(|taking| taking.proved_at));
        let (start, end) = (self.seen_to, now.min(self.duty.end));
        if start >= end {
            return;
        }
        self.seen_to = end;
        let miss_cause = match operation {
            Operation::Off(because) => Some(MissCause::Off(*because)),
            Operation::Suspended { interruption, .. } => Some(MissCause::Suspended(*interruption)),
            // The link's own loss is the reason.
            Operation::On(_) if !observation.is_live => None,
            Operation::On(_) if observation.awaits_operator => Some(MissCause::NotResumed),
            Operation::On(_) => {
                match (observation.not_ready, taking.and_then(|taking| taking.given_up)) {
                    (Some(not_ready), _) => Some(MissCause::NotReady(not_ready)),
                    (None, Some(GivenUp::WouldMiss)) => {
                        Some(MissCause::NotReady(NotReady::WouldMiss))
                    }
                    (None, Some(GivenUp::Refused)) => Some(MissCause::Refused),
                    (None, Some(GivenUp::OffTarget)) => Some(MissCause::OffTarget),
                    (None, None) => None,
                }
            }
        };
        let Some(miss_cause) = miss_cause else { return };
        match self.hindered.last_mut() {
            Some(last) if last.miss_cause == miss_cause && last.end == start => last.end = end,
            _ => self.hindered.push(Hindered { start, end, miss_cause }),
        }
    }

    /// Returns the outcome of the pass from its report; without a report, nothing was measured.
    pub(in crate::engine) fn end(self, report: Option<&PassReport>) -> Flown {
        let of_s = self.duty.counted_s;
        let in_beam_s = report.map_or(0.0, |report| report.in_beam_s.min(of_s));
        let is_whole = in_beam_s >= TRACKED * of_s;
        let cause = if is_whole { None } else { Some(self.cause(report)) };
        let Self { duty, name, proved_at, .. } = self;
        Flown { pass: duty.pass, name, of_s, in_beam_s, proved_at, cause }
    }

    /// Returns the cause of most of the lost time, leaving out the mount's losses if there are
    /// others.
    fn cause(&self, report: Option<&PassReport>) -> MissCause {
        let Duty { start, end, .. } = self.duty;
        let nothing = [LostStretch { start, end, cause: LossCause::NotMeasured }];
        let losses = report.map_or(&nothing[..], |report| &report.losses);
        let could_be_had = losses.iter().filter(|lost| !lost.cause.is_of_mount());
        let by_far = self.longest(could_be_had).or_else(|| self.longest(losses.iter()));
        by_far.unwrap_or(MissCause::Lost(LossCause::OutsideBeam))
    }

    fn longest<'a>(&self, losses: impl Iterator<Item = &'a LostStretch>) -> Option<MissCause> {
        let mut seconds: Vec<(MissCause, f64)> = Vec::new();
        let mut add = |cause: MissCause, lost_s: f64| match seconds
            .iter_mut()
            .find(|(miss_cause, _)| *miss_cause == cause)
        {
            Some((_, sum_s)) => *sum_s += lost_s,
            None => seconds.push((cause, lost_s)),
        };
        for lost in losses {
            let mut left_s = lost.seconds();
            for hindered in &self.hindered {
                let (start, end) = (hindered.start.max(lost.start), hindered.end.min(lost.end));
                let common_s = seconds_between(start, end).max(0.0);
                if common_s > 0.0 {
                    add(hindered.miss_cause, common_s);
                    left_s -= common_s;
                }
            }
            add(MissCause::Lost(lost.cause), left_s);
        }
        let longest = seconds.into_iter().max_by(|(_, a), (_, b)| a.total_cmp(b));
        longest.map(|(cause, _)| cause)
    }
}

/// Adds a line, and removes lines of earlier days (UTC).
pub(super) fn add(list: &mut Vec<DayLine>, line: DayLine) {
    let day = |time: Timestamp| time.to_zoned(TimeZone::UTC).date();
    let today = day(line.time);
    list.retain(|day_line| day(day_line.time) == today);
    if list.len() >= MAX {
        list.remove(0);
    }
    list.push(line);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::time::add_seconds,
        contract::automatic::{DayEvent, Interruption, OffBecause},
        engine::automatic::Operate,
        plan::pass_report::PassVerdict,
        station::AntennaId,
    };

    fn time(second: f64) -> Timestamp {
        add_seconds(Timestamp::UNIX_EPOCH, second)
    }

    fn flight() -> Flight {
        let duty = Duty {
            pass: (7, time(100.0)),
            start: time(100.0),
            end: time(200.0),
            go_at: time(50.0),
            counted_s: 100.0,
            lost_at: None,
            begins_late: false,
            ends_early: false,
        };
        Flight::new(duty, "SAT".to_owned())
    }

    /// Returns a report of the test pass with these losses.
    fn report(losses: &[(f64, f64, LossCause)]) -> PassReport {
        let losses: Vec<LostStretch> = losses
            .iter()
            .map(|(start, end, cause)| LostStretch {
                start: time(*start),
                end: time(*end),
                cause: *cause,
            })
            .collect();
        let lost_s: f64 = losses.iter().map(LostStretch::seconds).sum();
        PassReport {
            verdict: PassVerdict::Poor,
            counted_s: 100.0,
            known_s: 100.0,
            in_beam_s: 100.0 - lost_s,
            rms: None,
            worst: None,
            losses,
        }
    }

    /// Observes automatic operation once a second.
    fn see(flight: &mut Flight, seconds: std::ops::Range<i32>, operation: &Operation) {
        for second in seconds {
            let observation = Observation { is_live: true, ..Observation::default() };
            flight.see(operation, observation, time(f64::from(second)));
        }
    }

    #[test]
    fn a_pass_has_the_seconds_of_its_report() {
        let mut flight = flight();
        see(&mut flight, 50..230, &Operation::switched_on());
        let flown = flight.end(Some(&report(&[(100.0, 100.4, LossCause::NotMeasured)])));
        assert!((flown.in_beam_s - 99.6).abs() < 1e-6, "{flown:?}");
        assert_eq!(flown.cause, None);
    }

    #[test]
    fn the_cause_is_that_of_most_of_what_could_be_had() {
        use LossCause::{LateStart, LinkLost, NotCommanded, OutsideBeam, Slew};
        let on = Operation::switched_on();
        let switched_off = Operation::Off(OffBecause::Stop);
        let interruption = Interruption::ByHand;
        let suspended = Operation::Suspended { interruption, start: time(0.0) };
        let lost = |losses_of: &[(std::ops::Range<i32>, &Operation)], losses| {
            let mut flight = flight();
            for (seconds, operation) in losses_of {
                see(&mut flight, seconds.clone(), operation);
            }
            let flown = flight.end(Some(&report(losses)));
            (flown.lost_s(), flown.cause)
        };
        let all = [(90..210, &on)];
        let without_link = [(100.0, 150.0, LinkLost), (150.0, 160.0, OutsideBeam)];
        assert_eq!(lost(&all, &without_link), (60.0, Some(MissCause::Lost(LinkLost))));
        let late = [(100.0, 110.0, LateStart), (120.0, 160.0, Slew)];
        assert_eq!(lost(&all, &late), (50.0, Some(MissCause::Lost(LateStart))));
        let stopped = [(90..141, &on), (141..210, &switched_off)];
        let losses = [(100.0, 110.0, LateStart), (140.0, 200.0, NotCommanded)];
        assert_eq!(lost(&stopped, &losses), (70.0, Some(MissCause::Off(OffBecause::Stop))));
        let by_hand = [(90..111, &on), (111..210, &suspended)];
        let losses = [(100.0, 200.0, NotCommanded)];
        assert_eq!(lost(&by_hand, &losses), (100.0, Some(MissCause::Suspended(interruption))));
    }

    #[test]
    fn causes_are_written_as_before() {
        let text = |cause: MissCause| serde_json::to_string(&cause).unwrap();
        let lost = MissCause::Lost(LossCause::LinkLost);
        let refused = MissCause::Refused;
        let miss_cause = MissCause::Off(OffBecause::Stop);
        for (cause, written) in
            [(lost, "\"link_lost\""), (refused, "\"refused\""), (miss_cause, "{\"off\":\"stop\"}")]
        {
            assert_eq!(serde_json::from_str::<MissCause>(written).unwrap(), cause);
            assert_eq!(text(cause), written);
        }
    }

    #[test]
    fn the_list_is_that_of_one_day() {
        let mut list = Vec::new();
        let line = |second: f64| DayLine {
            time: time(second),
            antenna: AntennaId(1),
            event: DayEvent::SwitchedOn,
        };
        for second in [10.0, 86_399.0, 86_401.0] {
            add(&mut list, line(second));
        }
        assert_eq!(list, [line(86_401.0)]);
    }
}
