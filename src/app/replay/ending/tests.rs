//! Automatic end of a replay.

use std::sync::Arc;

use jiff::ToSpan as _;

use super::*;
use crate::{
    clock::{Instant, Moment},
    contract::alarms::AlarmKind,
    engine::alarms::KeepAlarms,
    plan::schedule::{PassKey, testing},
    station::AntennaId,
};

fn time(second: i64) -> Timestamp {
    let start: Timestamp = "2026-11-14T19:00:00Z".parse().unwrap();
    start + second.seconds()
}

/// Returns a live station at this second.
fn live(second: i64) -> Model {
    Model::before_anything(Moment { utc: time(second), steady: Instant::now() })
}

/// Returns a live station with a pass that an antenna is to track from `start` on.
fn planned(second: i64, start: i64) -> Model {
    let mut model = live(second);
    let (start, end) = (time(start), time(start + 600));
    let pass = PassKey { satellite: 43013, aos: start };
    let entry = testing::entry(AntennaId(1), pass, end);
    Arc::make_mut(&mut model.shown_mut().schedule).schedule.entries.push(entry);
    model
}

#[test]
fn a_replay_ends_two_minutes_before_a_planned_pass() {
    assert_eq!(why_over(time(0), &planned(500, 621)), None);
    let replay_end = why_over(time(0), &planned(501, 621));
    let (antenna, satellite) = ("an antenna".to_owned(), "43013".to_owned());
    assert_eq!(replay_end, Some(ReplayEnd::Pass { antenna, satellite, start: time(621) }));
    assert_eq!(why_over(time(510), &planned(511, 621)), None, "the operator began it after that");
    assert_eq!(why_over(time(0), &planned(700, 621)), None, "the pass has begun");
    assert_eq!(why_over(time(0), &live(500)), None);
}

#[test]
fn a_replay_ends_on_a_new_alarm_of_the_first_priority_alone() {
    let alarm = |kind: AlarmKind, second| {
        let mut model = live(20);
        model.shown_mut().alarms.raise(None, kind, time(second));
        model
    };
    let grave = AlarmKind::StopNotConfirmed;
    assert_eq!(why_over(time(0), &alarm(grave.clone(), 10)), Some(ReplayEnd::Alarm));
    assert_eq!(why_over(time(15), &alarm(grave.clone(), 10)), None, "it was there before");
    let mut graver_model = alarm(grave, 10);
    let id = graver_model.alarms.newest_unseen().unwrap();
    graver_model.shown_mut().alarms.acknowledge(id, time(11));
    assert_eq!(why_over(time(0), &graver_model), None);
    let slight = AlarmKind::NoRecord("the disk is full".to_owned());
    assert_ne!(alarm(slight.clone(), 10).alarms.list()[0].priority(), Priority::First);
    assert_eq!(why_over(time(0), &alarm(slight, 10)), None);
}
