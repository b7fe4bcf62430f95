use std::time::Duration;

use jiff::ToSpan as _;

use super::*;
use crate::{
    contract::{
        alarms::AlarmState,
        driver::{LinkLoss, Mover, OffTargetCause, Response, Safety, Unit},
    },
    device::panel::{Check, CheckState},
    plan::{
        Barrier,
        on_board::{Cause, Ranked},
        pass_report::Explained,
    },
    station::Antenna,
};

const LOST: AlarmKind = AlarmKind::LinkLost(LinkLoss::Silent);
const LOST_OF: Option<AntennaId> = Some(AntennaId::FIRST);
const COMMAS: AlarmKind = AlarmKind::Unreadable("Decimal commas.");

fn time() -> Timestamp {
    "2026-08-12T00:00:00Z".parse().unwrap()
}

#[test]
fn the_same_matter_stands_once_and_comes_again_after_it_was_over() {
    let mut alarms = Alarms::default();
    alarms.raise(Some(AntennaId::FIRST), AlarmKind::ClockOff(1.5), time());
    alarms.raise(Some(AntennaId::FIRST), AlarmKind::ClockOff(1.6), time());
    alarms.raise(Some(AntennaId(2)), AlarmKind::ClockOff(1.6), time());
    assert_eq!(alarms.list().len(), 2);
    alarms.clear(Some(AntennaId::FIRST), time(), |kind| matches!(kind, AlarmKind::ClockOff(_)));
    alarms.raise(Some(AntennaId::FIRST), AlarmKind::ClockOff(2.0), time() + 90.seconds());
    assert_eq!(alarms.list().len(), 2, "in its row");
    let row = alarms.list().last().unwrap();
    assert_eq!((row.raised, row.last, row.count), (time(), time() + 90.seconds(), 2));
    assert_eq!((row.state(), &row.kind), (AlarmState::New, &AlarmKind::ClockOff(2.0)));
}

#[test]
fn a_driver_that_goes_on_standing_is_one_alarm_whose_figure_grows() {
    let mut alarms = Alarms::default();
    for seconds in 1..4 {
        alarms.raise(None, AlarmKind::DriverStands(Duration::from_secs(seconds)), time());
    }
    let kinds: Vec<&AlarmKind> = alarms.list().iter().map(|alarm| &alarm.kind).collect();
    assert_eq!(kinds, [&AlarmKind::DriverStands(Duration::from_secs(3))]);
}

#[test]
fn a_cause_that_is_found_later_comes_into_the_alarm_that_stands() {
    let mut alarms = Alarms::default();
    let is_missed = |kind: &AlarmKind| matches!(kind, AlarmKind::OffTarget { .. });
    let missed = |off_deg, cause| {
        let deviation = crate::astro::Angle::from_degrees(off_deg);
        Some(AlarmKind::OffTarget { deviation, cause })
    };
    let cause = OffTargetCause::Measured(Explained { causes: Vec::new(), error_deg: 0.9 });
    for (off_deg, cause) in [(0.8, None), (0.9, Some(cause.clone())), (0.7, None)] {
        alarms.follow(LOST_OF, time(), missed(off_deg, cause), is_missed);
    }
    let kinds: Vec<AlarmKind> = alarms.list().iter().map(|alarm| alarm.kind.clone()).collect();
    assert_eq!(kinds, [missed(0.8, Some(cause)).unwrap()]);
    alarms.follow(LOST_OF, time(), None, is_missed);
    assert_eq!(states(&alarms), [AlarmState::NewAndOver { over_since: time() }]);
}

#[test]
fn a_lost_link_says_why_it_cannot_be_had_again() {
    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, AlarmKind::LinkLost(LinkLoss::Closed), time());
    alarms.restate(LOST_OF, &AlarmKind::LinkLost(LinkLoss::OtherDevice));
    let kinds: Vec<&AlarmKind> = alarms.list().iter().map(|alarm| &alarm.kind).collect();
    assert_eq!(kinds, [&AlarmKind::LinkLost(LinkLoss::OtherDevice)]);
}

#[test]
fn another_cause_ends_the_alarm_of_the_one_before() {
    let mut alarms = Alarms::default();
    let elements = Cause::Elements { told_deg: 40.0, expected_deg: 71.0 };
    let differs = |cause| AlarmKind::UnitDiffers(Ranked { cause, max_error: None });
    for cause in [elements, Cause::Clock { ahead_s: 12.0 }, Cause::Clock { ahead_s: 14.0 }] {
        let is_of_matter = |kind: &AlarmKind| matches!(kind, AlarmKind::UnitDiffers(_));
        alarms.follow(LOST_OF, time(), Some(differs(cause)), is_of_matter);
    }
    let standing = alarms.list().last().unwrap();
    assert_eq!(standing.kind, differs(Cause::Clock { ahead_s: 14.0 }), "the figures of now");
    assert_eq!(
        states(&alarms),
        [AlarmState::NewAndOver { over_since: time() }, AlarmState::New],
        "the wrong cause is over"
    );
}

/// Returns the states of all rows.
fn states(alarms: &Alarms) -> Vec<AlarmState> {
    alarms.list().iter().map(Alarm::state).collect()
}

#[test]
fn an_alarm_has_four_states_and_says_since_when_it_is_over() {
    let end = time() + 8.seconds();
    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, LOST, time());
    assert_eq!(states(&alarms), [AlarmState::New]);
    alarms.acknowledge(alarms.newest_unseen().unwrap(), time());
    assert_eq!(states(&alarms), [AlarmState::Seen]);
    alarms.clear(LOST_OF, end, |_| true);
    assert_eq!(states(&alarms), [AlarmState::Over { over_since: end }]);

    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, LOST, time());
    alarms.clear(LOST_OF, end, |_| true);
    alarms.clear(LOST_OF, end + 1.hour(), |_| true);
    assert_eq!(states(&alarms), [AlarmState::NewAndOver { over_since: end }]);
    alarms.acknowledge(alarms.newest_unseen().unwrap(), end + 1.minute());
    assert_eq!(states(&alarms), [AlarmState::Over { over_since: end }]);
}

#[test]
fn a_moment_is_over_when_it_is_seen() {
    let mut alarms = Alarms::default();
    for _ in 0..3 {
        alarms.raise(None, AlarmKind::NotTaken, time());
    }
    assert_eq!((states(&alarms), alarms.list()[0].count), (vec![AlarmState::New], 3));
    alarms.acknowledge(alarms.newest_unseen().unwrap(), time() + 1.second());
    assert_eq!(states(&alarms), [AlarmState::Over { over_since: time() + 1.second() }]);
}

#[test]
fn what_came_again_is_not_acknowledged_with_what_was_seen() {
    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, LOST, time());
    let read = alarms.newest_unseen().unwrap();
    alarms.clear(LOST_OF, time(), |_| true);
    alarms.raise(LOST_OF, LOST, time() + 1.second());
    alarms.acknowledge(read, time());
    alarms.acknowledge_all(read, time());
    assert_eq!(states(&alarms), [AlarmState::New]);
}

#[test]
fn all_that_were_seen_are_acknowledged_at_once() {
    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, LOST, time());
    alarms.raise(None, AlarmKind::ClockNotSet, time());
    let newest = alarms.newest_unseen().unwrap();
    alarms.raise(None, AlarmKind::StopNotConfirmed, time());
    alarms.acknowledge_all(newest, time());
    assert_eq!(states(&alarms), [AlarmState::Seen, AlarmState::Seen, AlarmState::New]);
}

#[test]
fn what_is_over_stays_for_the_day() {
    let mut alarms = Alarms::default();
    for kind in [LOST, AlarmKind::ClockNotSet] {
        alarms.raise(LOST_OF, kind, time());
    }
    alarms.acknowledge(0, time());
    alarms.clear(LOST_OF, time(), |_| true);
    alarms.pass_time(time() + 24.hours() - 1.second());
    assert_eq!(alarms.list().len(), 2);
    alarms.pass_time(time() + 24.hours());
    assert_eq!(states(&alarms), [AlarmState::NewAndOver { over_since: time() }], "nobody saw it");
}

#[test]
fn an_alarm_on_the_shelf_is_quiet_and_comes_back_when_its_time_is_up() {
    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, LOST, time());
    alarms.unopened = false;
    alarms.shelve(0, ShelveTime::TenMinutes, time());
    let end = time() + 10.minutes();
    alarms.clear(LOST_OF, time(), |_| true);
    alarms.raise(LOST_OF, LOST, time() + 1.minute());
    alarms.pass_time(end - 1.second());
    assert_eq!(states(&alarms), [AlarmState::Shelved { end }]);
    assert_eq!((alarms.newest_unseen(), alarms.unopened), (None, false));
    alarms.pass_time(end);
    assert_eq!((states(&alarms), alarms.unopened), (vec![AlarmState::New], true));

    let id = alarms.newest_unseen().unwrap();
    alarms.shelve(id, ShelveTime::OneHour, end);
    alarms.unshelve(id);
    assert_eq!(states(&alarms), [AlarmState::Seen]);
    alarms.shelve(id, ShelveTime::OneHour, end);
    alarms.clear(LOST_OF, end, |_| true);
    alarms.pass_time(end + 2.hours());
    assert_eq!(states(&alarms), [AlarmState::Over { over_since: end }]);
}

#[test]
fn an_alarm_that_was_shelved_by_a_clock_ahead_is_not_quiet_for_years() {
    let mut alarms = Alarms::default();
    let ahead = time() + 24.hours() * 400;
    alarms.raise(LOST_OF, LOST, ahead);
    alarms.shelve(0, ShelveTime::OneHour, ahead);
    alarms.pass_time(time());
    assert_eq!(states(&alarms), [AlarmState::New]);
}

#[test]
fn a_top_priority_alarm_is_never_shelved() {
    for kind in [
        AlarmKind::StopNotConfirmed,
        AlarmKind::StopRefused("ERR,7".to_owned()),
        AlarmKind::StopNotElsewhere,
        AlarmKind::Owed(Unit::new(&Antenna::satrak("Dish", "10.0.0.5:4001"))),
        AlarmKind::Safety(Safety::DeadManFired),
        AlarmKind::Safety(Safety::FlagsContradict { axis: "X", turned_deg: 2.0 }),
        AlarmKind::Safety(Safety::Forbidden {
            barrier: Barrier::Sun,
            driver: Mover::Somebody,
            response: Response::Reported,
        }),
    ] {
        let mut alarms = Alarms::default();
        alarms.raise(LOST_OF, kind.clone(), time());
        alarms.shelve(0, ShelveTime::TenMinutes, time());
        assert_eq!(states(&alarms), [AlarmState::New], "{kind:?}");
    }
}

#[test]
fn the_first_cause_comes_first_and_what_follows_behind_it() {
    let mut alarms = Alarms::default();
    alarms.raise(None, AlarmKind::Elements("old".to_owned()), time());
    alarms.raise(Some(AntennaId(2)), AlarmKind::TrackingEnded, time());
    for kind in [LOST, AlarmKind::StopNotConfirmed, AlarmKind::TrackingEnded] {
        alarms.raise(LOST_OF, kind, time());
    }
    alarms.raise(Some(AntennaId(2)), AlarmKind::ClockNotSet, time());
    let order: Vec<(u64, Option<u64>)> =
        alarms.in_order().iter().map(|placed| (placed.alarm.id, placed.follows)).collect();
    let expected = [(2, None), (3, Some(2)), (4, Some(2)), (5, None), (1, None), (0, None)];
    assert_eq!(order, expected);
}

#[test]
fn an_effect_of_an_effect_belongs_to_the_first_cause() {
    let mut alarms = Alarms::default();
    alarms.raise(None, AlarmKind::DriverStands(Duration::from_secs(3)), time());
    alarms.raise(LOST_OF, LOST, time());
    alarms.clear(None, time(), |_| true);
    alarms.raise(LOST_OF, AlarmKind::TrackingEnded, time() + 1.second());
    let order = |alarms: &Alarms| -> Vec<(u64, Option<u64>)> {
        alarms.in_order().iter().map(|placed| (placed.alarm.id, placed.follows)).collect()
    };
    assert_eq!(order(&alarms), [(1, None), (2, Some(1)), (0, None)], "the first cause is over");
    alarms.clear(LOST_OF, time() + 2.second(), |_| true);
    assert_eq!(order(&alarms), [(0, None), (1, Some(0)), (2, Some(0))]);
}

#[test]
fn red_alarms_that_stand_come_before_all_that_are_over() {
    let mut alarms = Alarms::default();
    alarms.raise(None, AlarmKind::Elements("old".to_owned()), time());
    alarms.raise(LOST_OF, LOST, time());
    alarms.raise(Some(AntennaId(2)), AlarmKind::StopNotConfirmed, time() + 1.second());
    alarms.clear(Some(AntennaId(2)), time() + 2.second(), |_| true);
    let order: Vec<u64> = alarms.in_order().iter().map(|placed| placed.alarm.id).collect();
    assert_eq!(order, [1, 2, 0]);
}

#[test]
fn alarms_of_a_removed_antenna_go_but_for_what_its_unit_is_owed() {
    let owed = AlarmKind::Owed(Unit::new(&Antenna::satrak("Dish", "10.0.0.5:4001")));
    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, LOST, time());
    alarms.clear(LOST_OF, time(), |_| true);
    alarms.raise(LOST_OF, AlarmKind::StopNotConfirmed, time());
    alarms.raise(None, owed.clone(), time());
    alarms.keep_only(&[AntennaId(2)]);
    let kinds: Vec<&AlarmKind> = alarms.list().iter().map(|alarm| &alarm.kind).collect();
    assert_eq!(kinds, [&owed]);
}

#[test]
fn a_full_list_keeps_top_priority_alarms() {
    let mut alarms = Alarms::default();
    alarms.raise(LOST_OF, AlarmKind::StopNotConfirmed, time());
    for number in 0..1000_u32 {
        alarms.raise(None, AlarmKind::Settings(number.to_string()), time());
    }
    assert_eq!(alarms.list()[0].kind, AlarmKind::StopNotConfirmed);
}

#[test]
fn a_unit_that_writes_decimal_commas_raises_one_alarm() {
    let unreadable = AlarmKind::LinkLost(LinkLoss::Unreadable);
    let orders = [
        [unreadable.clone(), COMMAS],
        [AlarmKind::LinkLost(LinkLoss::Silent), COMMAS],
        [COMMAS, unreadable.clone()],
    ];
    for order in orders {
        let mut alarms = Alarms::default();
        for kind in order {
            alarms.raise(Some(AntennaId::FIRST), kind, time());
        }
        let kinds: Vec<&AlarmKind> = alarms.list().iter().map(|alarm| &alarm.kind).collect();
        assert_eq!(kinds, [&COMMAS]);
        alarms.raise(Some(AntennaId(2)), unreadable.clone(), time());
        alarms.raise(Some(AntennaId::FIRST), AlarmKind::LinkLost(LinkLoss::Closed), time());
        assert_eq!(alarms.list().len(), 3, "another antenna, another loss");
    }
}

#[test]
fn a_check_is_over_when_it_is_told_to_be_good_or_worse() {
    let check = |name, state| Check::new(name, state, "Look at it.");
    let raised = check("Drive", CheckState::Caution);
    assert!(!is_over(&raised, std::slice::from_ref(&raised)));
    assert!(!is_over(&raised, &[check("Drive", CheckState::Unknown)]));
    assert!(is_over(&raised, &[check("Drive", CheckState::Good)]));
    assert!(is_over(&raised, &[check("Drive", CheckState::Fault)]));
    assert!(is_over(&raised, &[check("Clock", CheckState::Caution)]));
}

#[test]
fn a_check_that_is_told_in_other_words_is_the_same_matter() {
    let check = Check::new("X position sensor", CheckState::Fault, "Look at it.");
    let disconnected = Check { unit_text: "Not connected".into(), ..check.clone() };
    let mut alarms = Alarms::default();
    alarms.raise(Some(AntennaId::FIRST), AlarmKind::Check(check), time());
    alarms.raise(Some(AntennaId::FIRST), AlarmKind::Check(disconnected), time());
    assert_eq!(alarms.list().len(), 1);
}

#[test]
fn the_list_is_bounded() {
    let mut alarms = Alarms::default();
    for number in 0..1000_u32 {
        alarms.raise(None, AlarmKind::Settings(number.to_string()), time());
    }
    assert_eq!(alarms.list().len(), MAX);
}
