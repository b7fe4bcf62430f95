//! Times of the calls of hooks.

use std::time::Duration;

use super::*;
use crate::{
    astro::AzEl,
    contract::driver::Safety,
    engine::hooks::values::ReportValues,
    station::{HookAction, RuleSubject},
};

const ISS: u32 = 25_544;
const DISH: AntennaId = AntennaId(1);
const YAGI: AntennaId = AntennaId(2);

fn time(second: f64) -> Timestamp {
    add_seconds("2026-08-12T10:00:00Z".parse().unwrap(), second)
}

/// A pass from second 1000 to second 1600.
fn pass() -> HookPass {
    HookPass {
        antenna: DISH,
        satellite: ISS,
        name: "ISS".to_owned(),
        aos: time(1000.0),
        tca: time(1300.0),
        los: time(1600.0),
        has_aos: true,
        has_los: true,
        directions: [AzEl::from_degrees(0.0, 5.0); 3],
        plan: PlanState::Automatic,
        report: None,
    }
}

fn hook(event: HookEvent, delay_s: f64) -> Hook {
    let action = HookAction::Command(vec!["true".to_owned()]);
    let name = format!("{} {delay_s}", event.word());
    Hook { delay_s, ..Hook::new(name, event, action) }
}

/// A timetable with a clock that the test sets.
struct Stage {
    timetable: Timetable,
    station: Station,
    steady: Instant,
    utc: Timestamp,
    passes: Vec<HookPass>,
}

impl Stage {
    fn new(hooks: Vec<Hook>) -> Self {
        let station = Station { hooks, ..Station::default() };
        let (steady, utc) = (Instant::now(), time(0.0));
        Self { timetable: Timetable::new(utc), station, steady, utc, passes: vec![pass()] }
    }

    fn moment(&self) -> Moment {
        Moment { steady: self.steady, utc: self.utc }
    }

    /// Sets UTC alone, as a person or a time service does.
    fn jump(&mut self, second: f64) -> Vec<(String, bool)> {
        self.utc = time(second);
        self.timetable.follow(self.passes.clone(), self.utc);
        let due = self.timetable.due(&self.station, self.moment());
        due.into_iter().map(|call| (call.hook.name, call.is_too_late)).collect()
    }

    /// Runs both clocks to a second, with a look at each second, and returns the calls.
    fn run_to(&mut self, second: f64) -> Vec<(f64, String)> {
        let mut calls = Vec::new();
        let start = seconds_between(time(0.0), self.utc);
        let mut now = start;
        while now < second {
            now += 1.0;
            self.steady += Duration::from_secs(1);
            for (name, is_too_late) in self.jump(now) {
                assert!(!is_too_late, "{name}");
                calls.push((now, name));
            }
        }
        calls
    }

    fn note(&mut self, event: HookEvent, antenna: Option<AntennaId>, matter: Matter) {
        let pass = (event != HookEvent::Alarm).then(pass);
        let occurrence = Occurrence { event, time: self.utc, antenna, pass, matter };
        let moment = self.moment();
        self.timetable.note(&occurrence, &self.station, moment);
    }
}

fn names(calls: &[(f64, &str)]) -> Vec<(f64, String)> {
    calls.iter().map(|(second, name)| (*second, (*name).to_owned())).collect()
}

#[test]
fn hooks_call_once_with_lead_and_lag() {
    let mut stage = Stage::new(vec![
        hook(HookEvent::Aos, -30.0),
        hook(HookEvent::Aos, 0.0),
        hook(HookEvent::Los, 5.0),
        hook(HookEvent::Los, 600.0),
    ]);
    let before = stage.run_to(1700.0);
    stage.passes.clear();
    let calls = [before, stage.run_to(4000.0)].concat();
    let expected = [(970.0, "aos -30"), (1000.0, "aos 0"), (1605.0, "los 5"), (2200.0, "los 600")];
    assert_eq!(calls, names(&expected));
}

#[test]
fn a_pass_that_moves_takes_its_calls_along_and_calls_once() {
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, -30.0), hook(HookEvent::Los, 0.0)]);
    assert_eq!(stage.run_to(960.0), []);
    // Newer elements: the satellite comes later.
    stage.passes[0].aos = time(1020.0);
    stage.passes[0].los = time(1620.0);
    assert_eq!(stage.run_to(995.0), names(&[(990.0, "aos -30")]));
    // And again, after the call.
    stage.passes[0].aos = time(1040.0);
    assert_eq!(stage.run_to(1700.0), names(&[(1620.0, "los 0")]));
}

#[test]
fn a_pass_that_the_plan_takes_within_the_lead_calls_at_once() {
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, -600.0), hook(HookEvent::Aos, 0.0)]);
    let passes = std::mem::take(&mut stage.passes);
    assert_eq!(stage.run_to(900.0), []);
    stage.passes = passes;
    assert_eq!(stage.run_to(1100.0), names(&[(901.0, "aos -600"), (1000.0, "aos 0")]));
}

#[test]
fn a_pass_that_the_plan_drops_before_aos_calls_no_more_but_for_its_end() {
    let hooks =
        || vec![hook(HookEvent::Aos, -30.0), hook(HookEvent::Aos, 0.0), hook(HookEvent::Los, 0.0)];
    let mut stage = Stage::new(hooks());
    assert_eq!(stage.run_to(960.0), []);
    stage.passes.clear();
    assert_eq!(stage.run_to(2000.0), [], "dropped before the first call");

    let mut stage = Stage::new(hooks());
    assert_eq!(stage.run_to(980.0), names(&[(970.0, "aos -30")]));
    stage.passes.clear();
    assert_eq!(stage.run_to(2000.0), names(&[(1600.0, "los 0")]), "a recorder must end");

    // STOP during the pass ends the track, and the plan drops the rest.
    let mut stage = Stage::new(hooks());
    stage.run_to(1100.0);
    stage.passes.clear();
    assert_eq!(stage.run_to(2000.0), names(&[(1600.0, "los 0")]));
}

#[test]
fn the_state_in_the_plan_is_that_of_the_call() {
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, 0.0), hook(HookEvent::Los, 0.0)]);
    stage.passes[0].plan = PlanState::Planned;
    let mut states = Vec::new();
    for second in [900.0, 1000.0, 1100.0, 1600.0] {
        stage.utc = time(second);
        stage.timetable.follow(stage.passes.clone(), stage.utc);
        for call in stage.timetable.due(&stage.station, stage.moment()) {
            states.push(call.occurrence.pass.unwrap().plan);
        }
        if second >= 1000.0 {
            stage.passes.clear();
        }
    }
    assert_eq!(states, [PlanState::Planned, PlanState::Dropped]);
}

#[test]
fn the_start_of_the_station_repeats_no_call_of_the_run_before() {
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, -30.0), hook(HookEvent::Aos, 0.0)]);
    stage.timetable = Timetable::new(time(980.0));
    stage.utc = time(980.0);
    assert_eq!(stage.run_to(1100.0), names(&[(1000.0, "aos 0")]));
}

#[test]
fn a_clock_that_jumps_calls_nothing_late_and_nothing_twice() {
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, 0.0), hook(HookEvent::Los, 0.0)]);
    stage.run_to(990.0);
    // Three hours ahead: both events are jumped over.
    let skipped = stage.jump(11_800.0);
    assert_eq!(skipped, [("aos 0".to_owned(), true), ("los 0".to_owned(), true)]);
    // And back: a call that was dropped stays dropped.
    assert_eq!(stage.jump(990.0), []);
    assert_eq!(stage.run_to(1700.0), []);

    let mut stage = Stage::new(vec![hook(HookEvent::Aos, 0.0)]);
    assert_eq!(stage.run_to(1100.0).len(), 1);
    assert_eq!(stage.jump(900.0), []);
    assert_eq!(stage.run_to(1700.0), [], "the hook has called for this pass");

    // A small step is no reason to lose a call.
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, 0.0)]);
    stage.run_to(995.0);
    assert_eq!(stage.jump(1020.0), [("aos 0".to_owned(), false)]);
}

#[test]
fn a_lag_after_an_event_is_by_the_steady_clock_and_never_hours_late() {
    let mut stage = Stage::new(vec![hook(HookEvent::TrackingEnd, 60.0)]);
    stage.run_to(1600.0);
    stage.note(HookEvent::TrackingEnd, Some(DISH), Matter::None);
    assert_eq!(stage.run_to(1700.0), names(&[(1660.0, "tracking_end 60")]));

    stage.note(HookEvent::TrackingEnd, Some(DISH), Matter::None);
    // The clock is set back: the lag goes on.
    assert_eq!(stage.jump(500.0), []);
    assert_eq!(stage.run_to(600.0), names(&[(560.0, "tracking_end 60")]));

    stage.note(HookEvent::TrackingEnd, Some(DISH), Matter::None);
    stage.steady += Duration::from_mins(1);
    let late = stage.jump(9000.0);
    assert_eq!(late, [("tracking_end 60".to_owned(), true)], "the computer slept");
}

#[test]
fn a_hook_of_all_antennas_calls_once_for_a_pass_and_one_of_an_antenna_for_its_own() {
    let of_yagi = Hook { antenna: Some(YAGI), ..hook(HookEvent::Aos, 0.0) };
    let of_other = Hook {
        name: "other".to_owned(),
        subject: Some(RuleSubject::Satellite(7)),
        ..hook(HookEvent::Aos, 0.0)
    };
    let all = Hook { name: "all".to_owned(), ..hook(HookEvent::Aos, 0.0) };
    let disabled = Hook { name: "disabled".to_owned(), is_on: false, ..all.clone() };
    let mut stage = Stage::new(vec![of_yagi, of_other, all, disabled]);
    stage.passes.push(HookPass { antenna: YAGI, ..pass() });
    assert_eq!(stage.run_to(1100.0), names(&[(1000.0, "all"), (1000.0, "aos 0")]));
}

#[test]
fn a_satellite_that_does_not_rise_or_set_has_no_aos_or_los() {
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, 0.0), hook(HookEvent::Los, 0.0)]);
    stage.passes[0].has_aos = false;
    stage.passes[0].has_los = false;
    assert_eq!(stage.run_to(1700.0), []);
    // A list that begins during the pass does not move AOS.
    let mut stage = Stage::new(vec![hook(HookEvent::Aos, 60.0)]);
    stage.run_to(1010.0);
    stage.passes[0] = HookPass { aos: time(1005.0), has_aos: false, ..pass() };
    assert_eq!(stage.run_to(1100.0), names(&[(1060.0, "aos 60")]));
}

#[test]
fn a_hundred_hooks_call_at_the_same_aos() {
    let hooks =
        (0..100).map(|number| Hook { name: format!("hook {number}"), ..hook(HookEvent::Aos, 0.0) });
    let mut stage = Stage::new(hooks.collect());
    let calls = stage.run_to(1700.0);
    assert_eq!(calls.len(), 100);
    assert!(calls.iter().all(|(second, _)| (second - 1000.0).abs() < 1e-6));
}

#[test]
fn alarms_and_reports_reach_their_hooks() {
    let own = Hook { antenna: Some(DISH), ..hook(HookEvent::Alarm, 0.0) };
    let all = Hook { name: "all".to_owned(), ..hook(HookEvent::Alarm, 0.0) };
    let mut stage = Stage::new(vec![own, all, hook(HookEvent::Los, 10.0)]);
    stage.run_to(1500.0);
    let kind = Box::new(AlarmKind::Safety(Safety::DeadManFired));
    stage.note(HookEvent::Alarm, None, Matter::Alarm(kind.clone()));
    assert_eq!(stage.run_to(1501.0), names(&[(1501.0, "all")]));
    stage.note(HookEvent::Alarm, Some(DISH), Matter::Alarm(kind));
    assert_eq!(stage.run_to(1502.0), names(&[(1502.0, "alarm 0"), (1502.0, "all")]));

    stage.run_to(1605.0);
    let report = ReportValues::sample();
    let span = (time(1002.0), time(1598.0));
    stage.timetable.add_report(DISH, ISS, span, &report);
    stage.timetable.follow(Vec::new(), time(1606.0));
    let moment = Moment { utc: time(1610.0), steady: stage.steady };
    let [call] = &stage.timetable.due(&stage.station, moment)[..] else { panic!("no call") };
    assert_eq!(call.occurrence.pass.as_ref().unwrap().report, Some(report));
}
