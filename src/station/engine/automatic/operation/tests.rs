use super::*;

const WARNING_S: f64 = 30.0;

fn time(second: f64) -> Timestamp {
    add_seconds(Timestamp::UNIX_EPOCH, second)
}

/// Returns a pass of satellite `number`, for which the antenna must set out 60 s before its start.
fn duty(number: u32, from_s: f64) -> Duty {
    Duty {
        pass: (number, time(from_s)),
        start: time(from_s),
        end: time(from_s + 600.0),
        go_at: time(from_s - 60.0),
        counted_s: 600.0,
        lost_at: None,
        begins_late: false,
        ends_early: false,
    }
}

const STANDS: Observation = Observation {
    is_live: true,
    is_silent: false,
    is_locked_out: false,
    can_be_sent: true,
    not_ready: None,
    takes: None,
    is_proved: false,
    awaits_operator: false,
    offers: None,
    may_be_planned: false,
    moves: false,
    is_moved_elsewhere: false,
    turns_unasked: false,
};

fn taking(number: u32) -> Observation {
    Observation { takes: Some(number), is_proved: true, moves: true, ..STANDS }
}

/// Antenna with its duties, observed once a second.
struct Fixture {
    operation: Operation,
    duties: Vec<Duty>,
    wishes: Wishes,
    now_s: f64,
}

impl Fixture {
    fn new(duties: &[Duty]) -> Self {
        Self {
            operation: Operation::switched_on(),
            duties: duties.to_vec(),
            wishes: Wishes {
                parks_within_s: None,
                longest_rest_s: 3600.0,
                announced_for_s: WARNING_S,
                pass_list_key: None,
            },
            now_s: 0.0,
        }
    }

    /// Returns all acts until `to_s` with their seconds, while `observe` supplies the state.
    fn run_until(&mut self, to_s: f64, observe: impl Fn(f64) -> Observation) -> Vec<(f64, Act)> {
        let mut acts = Vec::new();
        while self.now_s < to_s {
            let (now_s, now) = (self.now_s, time(self.now_s));
            let act = self.operation.step(&self.duties, observe(now_s), self.wishes, now);
            acts.extend(act.map(|act| (now_s, act)));
            self.now_s += 1.0;
        }
        acts
    }

    fn outcome(&mut self, outcome: Outcome) {
        self.operation.take_outcome(outcome);
    }
}

#[test]
fn nothing_is_done_until_the_operator_has_switched_it_on() {
    let mut fixture = Fixture::new(&[duty(1, 100.0)]);
    fixture.operation = Operation::Off(OffBecause::NotSwitchedOn);
    assert_eq!(fixture.run_until(900.0, |_| STANDS), []);
}

#[test]
fn the_first_motion_and_one_after_a_rest_are_announced_and_others_are_not() {
    let duties = [duty(1, 200.0), duty(2, 1000.0), duty(3, 9000.0)];
    let mut fixture = Fixture::new(&duties);
    let announced = |fixture: &Fixture| match &fixture.operation {
        Operation::On(On { doing: Doing::Announces { moves_at, pass }, .. }) => {
            Some((*moves_at, pass.0))
        }
        _ => None,
    };
    assert_eq!(fixture.run_until(110.0, |_| STANDS), []);
    assert_eq!(announced(&fixture), None);
    assert_eq!(fixture.run_until(111.0, |_| STANDS), []);
    assert_eq!(announced(&fixture), Some((time(140.0), 1)));
    assert_eq!(fixture.run_until(150.0, |_| STANDS), [(140.0, Act::Take(duties[0]))]);
    let flown = |number| move |_| taking(number);
    assert_eq!(fixture.run_until(810.0, flown(1)), []);
    assert_eq!(fixture.run_until(945.0, |_| STANDS), [(940.0, Act::Take(duties[1]))]);
    assert_eq!(fixture.run_until(1700.0, flown(2)), []);
    assert_eq!(fixture.run_until(8911.0, |_| STANDS), []);
    assert_eq!(announced(&fixture), Some((time(8940.0), 3)));
    assert_eq!(fixture.run_until(8950.0, |_| STANDS), [(8940.0, Act::Take(duties[2]))]);
}

#[test]
fn a_suspension_is_ended_by_the_operator_alone() {
    let duties = [duty(1, 200.0), duty(2, 1000.0)];
    let mut fixture = Fixture::new(&duties);
    fixture.run_until(150.0, |_| STANDS);
    fixture.operation.suspend(Interruption::ByHand, time(150.0));
    assert_eq!(fixture.run_until(500.0, |_| STANDS), []);
    fixture.duties.insert(1, duty(3, 700.0));
    assert_eq!(fixture.run_until(930.0, |_| STANDS), []);
    fixture.operation.go_on(time(930.0));
    assert_eq!(
        fixture.run_until(945.0, |_| STANDS).first(),
        Some(&(930.0, Act::Take(duty(3, 700.0))))
    );
}

#[test]
fn an_antenna_that_somebody_moves_is_left_to_them_and_one_that_coasts_is_not() {
    let moved = |from_s: f64, to_s: f64| {
        move |now_s: f64| {
            let is_moved = (from_s..to_s).contains(&now_s);
            Observation { moves: is_moved, is_moved_elsewhere: is_moved, ..STANDS }
        }
    };
    let mut fixture = Fixture::new(&[duty(1, 500.0)]);
    fixture.run_until(100.0, moved(10.0, 14.0));
    assert!(fixture.operation.is_on());
    fixture.run_until(200.0, moved(110.0, 130.0));
    let start = time(115.0);
    let suspended = Operation::Suspended { interruption: Interruption::Elsewhere, start };
    assert_eq!(fixture.operation, suspended);
}

#[test]
fn a_track_that_somebody_ends_suspends_it() {
    let mut fixture = Fixture::new(&[duty(1, 200.0)]);
    fixture.run_until(150.0, |_| STANDS);
    fixture.run_until(250.0, |_| taking(1));
    fixture.operation.ended_by_unit(time(250.0));
    let suspended =
        Operation::Suspended { interruption: Interruption::EndedByUnit, start: time(250.0) };
    assert_eq!(fixture.operation, suspended);
}

/// The driver's stop causes the end of the track and the unrequested motion.
#[test]
fn a_stop_for_safety_stays_the_cause_whatever_follows_or_came_before() {
    let consequences: [fn(&mut Operation); 3] = [
        |operation| operation.ended_by_unit(time(250.0)),
        |operation| operation.suspend(Interruption::Elsewhere, time(250.0)),
        |operation| operation.suspend(Interruption::EndedByUnit, time(250.0)),
    ];
    for consequence in consequences {
        for is_first in [true, false] {
            let mut fixture = Fixture::new(&[duty(1, 200.0)]);
            fixture.run_until(150.0, |_| STANDS);
            fixture.run_until(250.0, |_| taking(1));
            if is_first {
                consequence(&mut fixture.operation);
            }
            fixture.operation.switch_off(OffBecause::Safety);
            consequence(&mut fixture.operation);
            assert_eq!(fixture.operation, Operation::Off(OffBecause::Safety));
        }
    }
}

#[test]
fn two_failures_in_a_row_switch_it_off_and_a_pass_between_them_does_not() {
    let duties = [duty(1, 200.0), duty(2, 1000.0), duty(3, 1800.0), duty(4, 2600.0)];
    let fails = |fixture: &mut Fixture, to_s: f64| {
        assert_eq!(fixture.run_until(to_s, |_| STANDS).len(), 1);
        fixture.outcome(Outcome::Failed);
    };
    let mut fixture = Fixture::new(&duties);
    fails(&mut fixture, 150.0);
    assert_eq!(fixture.run_until(900.0, |_| STANDS), [], "what it refused is not asked for again");
    fixture.run_until(945.0, |_| STANDS);
    fixture.run_until(1700.0, |_| taking(2));
    fails(&mut fixture, 1745.0);
    assert!(fixture.operation.is_on());
    fails(&mut fixture, 2545.0);
    assert_eq!(fixture.operation, Operation::Off(OffBecause::Failures));
    assert_eq!(fixture.run_until(4000.0, |_| STANDS), []);
}

#[test]
fn a_lost_link_costs_what_cannot_be_had_and_the_rest_is_taken() {
    let duties = [duty(1, 200.0), duty(2, 1000.0)];
    let mut fixture = Fixture::new(&duties);
    let lost = |_| Observation { is_live: false, can_be_sent: false, ..STANDS };
    assert_eq!(fixture.run_until(400.0, lost), []);
    let take = Act::Take(duties[0]);
    assert_eq!(
        fixture.run_until(470.0, |_| STANDS),
        [(430.0, take), (460.0, take)],
        "with a warning"
    );
    fixture.run_until(500.0, |_| taking(1));
    fixture.run_until(550.0, lost);
    assert_eq!(fixture.run_until(560.0, |_| STANDS), [(550.0, take)]);
    fixture.run_until(600.0, |_| taking(1));
    fixture.run_until(795.0, lost);
    assert_eq!(fixture.run_until(900.0, |_| STANDS), [], "too little of it is left");
    assert_eq!(fixture.run_until(945.0, |_| STANDS), [(940.0, Act::Take(duties[1]))]);
}

#[test]
fn a_pass_for_which_nothing_happens_is_given_up() {
    let duties = [duty(1, 200.0), duty(2, 1000.0), duty(3, 1800.0)];
    let mut fixture = Fixture::new(&duties);
    let take = Act::Take(duties[0]);
    assert_eq!(fixture.run_until(900.0, |_| STANDS), [(140.0, take), (170.0, take)]);
    assert!(fixture.operation.is_on());
    fixture.run_until(1700.0, |_| STANDS);
    assert_eq!(fixture.operation, Operation::Off(OffBecause::Failures));
}

#[test]
fn a_unit_that_is_not_ready_costs_its_passes_and_no_more() {
    let duties = [duty(1, 200.0), duty(2, 1000.0), duty(3, 1800.0), duty(4, 2600.0)];
    let mut fixture = Fixture::new(&duties);
    let faulty = Observation { not_ready: Some(NotReady::Fault), ..STANDS };
    assert_eq!(fixture.run_until(2550.0, |_| faulty), []);
    // The fault is cleared in the middle of the pass.
    let cleared = |now_s: f64| if now_s < 2700.0 { faulty } else { STANDS };
    assert_eq!(fixture.run_until(2740.0, cleared), [(2730.0, Act::Take(duties[3]))], "announced");
    assert!(fixture.operation.is_on());
}

#[test]
fn a_unit_that_would_miss_its_passes_is_tried_again_with_the_next() {
    let duties = [duty(1, 200.0), duty(2, 1000.0), duty(3, 1800.0)];
    let mut fixture = Fixture::new(&duties);
    for (to_s, duty) in [(150.0, duties[0]), (950.0, duties[1]), (1750.0, duties[2])] {
        let acts = fixture.run_until(to_s, |_| STANDS);
        assert_eq!(acts.last().map(|(_, act)| *act), Some(Act::Take(duty)));
        fixture.outcome(Outcome::WouldMiss);
    }
    assert!(fixture.operation.is_on());
}

#[test]
fn the_rest_of_a_pass_that_a_unit_would_miss_is_judged_again_until_it_is_over() {
    let duties = [duty(1, 200.0), duty(2, 1000.0)];
    let mut fixture = Fixture::new(&duties);
    let take = Act::Take(duties[0]);
    assert_eq!(fixture.run_until(141.0, |_| STANDS), [(140.0, take)]);
    for asked_s in [170.0, 200.0, 230.0] {
        fixture.outcome(Outcome::WouldMiss);
        assert_eq!(fixture.run_until(asked_s + 1.0, |_| STANDS), [(asked_s, take)]);
        assert_eq!(fixture.operation.not_ready(), Some(NotReady::WouldMiss));
    }
    fixture.run_until(240.0, |_| taking(1));
    assert!(fixture.operation.is_proved(), "the rest of it would be in the beam");
    assert_eq!(fixture.operation.not_ready(), None);
    fixture.outcome(Outcome::WouldMiss);
    let rest = fixture.run_until(935.0, |_| STANDS);
    assert_eq!(rest.first(), Some(&(260.0, take)));
    assert_eq!(rest.last(), Some(&(770.0, take)), "until too little of it is left");
    assert!(fixture.operation.is_on());
}

#[test]
fn a_unit_that_refuses_what_it_would_have_missed_before_is_asked_no_more() {
    let duties = [duty(1, 200.0)];
    let mut fixture = Fixture::new(&duties);
    fixture.run_until(141.0, |_| STANDS);
    fixture.outcome(Outcome::WouldMiss);
    fixture.run_until(171.0, |_| STANDS);
    fixture.outcome(Outcome::Failed);
    assert_eq!(fixture.run_until(790.0, |_| STANDS), []);
}

#[test]
fn a_late_motion_into_a_long_pass_that_a_unit_would_have_missed_is_announced() {
    let long = Duty { end: time(20_000.0), counted_s: 19_800.0, ..duty(1, 200.0) };
    let mut fixture = Fixture::new(&[long]);
    fixture.run_until(141.0, |_| STANDS);
    fixture.outcome(Outcome::WouldMiss);
    let judged = fixture.run_until(3740.0, |_| STANDS);
    assert_eq!(judged.last(), Some(&(3710.0, Act::Take(long))));
    assert_eq!(fixture.run_until(3770.0, |_| STANDS), [], "nobody expects a motion after an hour");
    let announces = |doing: &Operation| {
        matches!(doing, Operation::On(On { doing: Doing::Announces { .. }, .. }))
    };
    assert!(announces(&fixture.operation));
    assert_eq!(
        fixture.run_until(3775.0, |_| STANDS),
        [(3771.0, Act::Take(long))],
        "with a warning"
    );
}

#[test]
fn a_unit_that_begins_what_it_would_have_missed_and_ends_it_has_failed() {
    let mut fixture = Fixture::new(&[duty(1, 200.0)]);
    fixture.run_until(141.0, |_| STANDS);
    fixture.outcome(Outcome::WouldMiss);
    fixture.run_until(171.0, |_| STANDS);
    fixture.run_until(180.0, |_| Observation { is_proved: false, ..taking(1) });
    fixture.operation.ended_by_unit(time(180.0));
    assert_eq!(fixture.run_until(790.0, |_| STANDS), []);
    assert_eq!(fixture.operation.not_ready(), None, "another reason counts now");
    assert!(matches!(&fixture.operation, Operation::On(On { failures: 1, .. })));
}

#[test]
fn a_unit_that_would_miss_only_what_it_has_loaded_is_asked_twice() {
    let duties = [duty(1, 200.0), duty(2, 1000.0)];
    let mut fixture = Fixture::new(&duties);
    let loading = |_: f64| Observation { is_proved: false, moves: false, ..taking(1) };
    let take = Act::Take(duties[0]);
    fixture.run_until(141.0, |_| STANDS);
    fixture.outcome(Outcome::WouldMiss);
    assert_eq!(fixture.run_until(171.0, |_| STANDS), [(170.0, take)], "no attempt so far");
    for asked_s in [200.0, 230.0] {
        fixture.run_until(asked_s - 20.0, loading);
        fixture.outcome(Outcome::WouldMiss);
        let acts = if asked_s < 230.0 { vec![(asked_s, take)] } else { Vec::new() };
        assert_eq!(fixture.run_until(asked_s + 1.0, |_| STANDS), acts);
    }
    assert_eq!(fixture.run_until(930.0, |_| STANDS), []);
    assert!(matches!(&fixture.operation, Operation::On(On { failures: 0, .. })));
    assert_eq!(fixture.run_until(945.0, |_| STANDS), [(940.0, Act::Take(duties[1]))]);
}

#[test]
fn it_parks_between_passes_where_the_time_is_enough() {
    let duties = [duty(1, 200.0), duty(2, 1000.0), duty(3, 2000.0)];
    let mut fixture = Fixture::new(&duties);
    fixture.wishes.parks_within_s = Some(300.0);
    assert_eq!(fixture.run_until(150.0, |_| STANDS), [(140.0, Act::Take(duties[0]))]);
    fixture.run_until(801.0, |_| taking(1));
    assert_eq!(fixture.run_until(945.0, |_| STANDS), [(940.0, Act::Take(duties[1]))]);
    fixture.run_until(1601.0, |_| taking(2));
    assert_eq!(
        fixture.run_until(1945.0, |_| STANDS),
        [(1601.0, Act::Park), (1940.0, Act::Take(duties[2]))]
    );
}

#[test]
fn a_lock_out_switches_it_off() {
    let mut fixture = Fixture::new(&[duty(1, 200.0)]);
    let locked = |now_s: f64| Observation { is_locked_out: now_s < 50.0, ..STANDS };
    assert_eq!(fixture.run_until(900.0, locked), []);
    assert_eq!(fixture.operation, Operation::Off(OffBecause::LockedOut));
}

#[test]
fn a_proof_that_the_unit_then_belies_is_no_success() {
    let duties = [duty(1, 200.0), duty(2, 1000.0)];
    let mut fixture = Fixture::new(&duties);
    for (to_s, number) in [(150.0, 1), (950.0, 2)] {
        fixture.run_until(to_s, |_| STANDS);
        fixture.run_until(to_s + 5.0, |_| taking(number));
        assert!(fixture.operation.is_proved(), "a track from here is proved at once");
        fixture.outcome(Outcome::Failed);
    }
    assert_eq!(fixture.operation, Operation::Off(OffBecause::Failures));
}

#[test]
fn a_clock_that_was_set_back_keeps_no_pass_and_is_followed_by_an_announcement() {
    let duties = [duty(1, 200.0), duty(2, 4000.0)];
    let mut fixture = Fixture::new(&duties[1..]);
    fixture.run_until(4100.0, |now_s| if now_s < 3950.0 { STANDS } else { taking(2) });
    assert!(fixture.operation.taking().is_some());
    fixture.now_s = 0.0;
    fixture.duties = duties.to_vec();
    assert_eq!(fixture.run_until(150.0, |_| STANDS), [(140.0, Act::Take(duties[0]))]);
}

#[test]
fn the_pass_that_the_unit_was_left_with_is_taken_over_without_a_motion_and_no_other_track() {
    let tracks = |number: u32| {
        move |_: f64| Observation {
            offers: Some(number),
            is_moved_elsewhere: true,
            moves: true,
            ..STANDS
        }
    };
    let duties = [duty(1, 200.0)];
    let mut fixture = Fixture::new(&duties);
    (fixture.now_s, fixture.wishes.pass_list_key) = (300.0, Some(duties[0].pass));
    assert_eq!(fixture.run_until(302.0, tracks(1)), [(300.0, Act::TakeOver(duties[0]))]);
    assert_eq!(fixture.run_until(310.0, |_| taking(1)), []);
    assert!(fixture.operation.is_proved(), "and without a warning");

    for (held_pass, number) in [(Some(duties[0].pass), 2), (None, 1), (Some((1, time(9_999.0))), 1)]
    {
        let mut other = Fixture::new(&duties);
        (other.now_s, other.wishes.pass_list_key) = (300.0, held_pass);
        assert_eq!(other.run_until(310.0, tracks(number)), [], "somebody else's");
        assert!(matches!(other.operation, Operation::Suspended { .. }));
    }
}

#[test]
fn nothing_is_sent_while_somebody_else_moves_the_antenna() {
    let mut fixture = Fixture::new(&[duty(1, 200.0), duty(2, 1000.0)]);
    fixture.run_until(150.0, |_| STANDS);
    fixture.run_until(850.0, |_| taking(1));
    // No nudge lasts long enough to suspend automatic operation.
    let nudged = |now_s: f64| {
        let is_moved = now_s as i64 % 5 != 0;
        Observation { is_moved_elsewhere: is_moved, moves: is_moved, ..STANDS }
    };
    let acts = fixture.run_until(945.0, nudged);
    assert!(acts.iter().all(|(at_s, _)| *at_s as i64 % 5 == 0), "{acts:?}");
}

#[test]
fn a_late_reply_now_and_then_does_not_begin_the_warning_again() {
    let duties = [duty(1, 200.0)];
    let first = |is_live: &dyn Fn(f64) -> bool| {
        let mut fixture = Fixture::new(&duties);
        let acts =
            fixture.run_until(400.0, |now_s| Observation { is_live: is_live(now_s), ..STANDS });
        acts.first().copied()
    };
    let at_once = first(&|_| true);
    assert!(matches!(at_once, Some((_, Act::Take(_)))), "{at_once:?}");
    assert_eq!(first(&|now_s| now_s as i64 % 4 != 1), at_once);
}

#[test]
fn what_was_announced_is_announced_anew_when_it_could_not_be_done() {
    let duties = [duty(1, 200.0)];
    let mut fixture = Fixture::new(&duties);
    // The announcement ends while the unit does not answer.
    let acts = fixture.run_until(400.0, |now_s| {
        let is_live = !(120.0..300.0).contains(&now_s);
        Observation { is_live, is_silent: !is_live, ..STANDS }
    });
    assert_eq!(acts.first(), Some(&(330.0, Act::Take(duties[0]))), "after another warning");

    let mut dropped = Fixture::new(&duties);
    dropped.run_until(120.0, |_| STANDS);
    assert!(matches!(&dropped.operation, Operation::On(On { doing: Doing::Announces { .. }, .. })));
    dropped.duties.clear();
    dropped.run_until(122.0, |_| STANDS);
    assert!(matches!(&dropped.operation, Operation::On(On { doing: Doing::Rests, .. })));
}

#[test]
fn a_pass_that_the_operator_tracks_already_is_not_begun_again() {
    let mut fixture = Fixture::new(&[duty(1, 200.0)]);
    fixture.now_s = 300.0;
    assert_eq!(fixture.run_until(400.0, |_| taking(1)), []);
    assert!(fixture.operation.is_proved());
}

#[test]
fn a_park_that_somebody_ends_suspends_it() {
    let mut fixture = Fixture::new(&[duty(1, 200.0), duty(2, 4000.0)]);
    fixture.wishes.parks_within_s = Some(120.0);
    fixture.run_until(150.0, |_| STANDS);
    fixture.run_until(810.0, |_| taking(1));
    assert!(!fixture.run_until(815.0, |_| STANDS).is_empty(), "it parks");
    fixture.operation.ended_by_unit(time(820.0));
    let suspended =
        Operation::Suspended { interruption: Interruption::EndedByUnit, start: time(820.0) };
    assert_eq!(fixture.operation, suspended);
}
