use std::time::Duration;

use jiff::Timestamp;
use proptest::prelude::*;

use super::*;
use crate::{
    astro::Angle,
    device::{
        Controller, Device, Extent, Motion,
        panel::{Act, CheckState},
        settings::{Change, Value, Values},
    },
};

const STATUS: &[u8] =
    b"|h2\x00173359  0A0   0999999\x00Tower         0 90  0E1   0 45  0\x00Elevation   ";

/// A step of a test script: an event at a device.
#[derive(Debug, Clone)]
enum ScriptStep {
    Wait(u64),
    Receive(Vec<u8>),
    Start(Motion),
    Act(&'static str, i64),
    WriteSettings,
    Halt,
    LinkUp,
    LinkDown,
}

fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let noise = prop::collection::vec(any::<u8>(), 0..40);
    let torn =
        (0..STATUS.len(), 0..STATUS.len()).prop_map(|(a, b)| STATUS[a.min(b)..a.max(b)].to_vec());
    let words: Vec<&[u8]> = vec![b"|AK", b"|AF", b"|PK", b"|MK", b"|SK", b"|SF", b"|cK", b"V3"];
    let word = prop::sample::select(words).prop_map(<[u8]>::to_vec);
    prop_oneof![4 => Just(STATUS.to_vec()), 1 => torn, 1 => noise, 4 => word]
}

fn motion() -> impl Strategy<Value = Motion> {
    let angle = || prop::option::of((-400.0..800.0).prop_map(Angle::from_degrees));
    let rates = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
    prop_oneof![
        (angle(), angle()).prop_map(|(azimuth, elevation)| Motion::Position { azimuth, elevation }),
        prop::sample::select(rates.to_vec())
            .prop_map(|(x_deg_s, y_deg_s)| Motion::Jog { x_deg_s, y_deg_s }),
        Just(Motion::StartProgram),
        Just(Motion::Step { x_deg: 1.0, y_deg: 0.0 }),
    ]
}

fn step() -> impl Strategy<Value = ScriptStep> {
    prop_oneof![
        6 => (0_u64..1500).prop_map(ScriptStep::Wait),
        6 => bytes().prop_map(ScriptStep::Receive),
        3 => motion().prop_map(ScriptStep::Start),
        1 => (prop::sample::select(vec![OTHER, RESCUE, "none"]), -10_i64..400)
            .prop_map(|(action, degrees)| ScriptStep::Act(action, degrees)),
        1 => Just(ScriptStep::WriteSettings),
        1 => Just(ScriptStep::Halt),
        1 => Just(ScriptStep::LinkUp),
        1 => Just(ScriptStep::LinkDown),
    ]
}

fn settings_write() -> Change {
    let values = [("stop_offset_deg", Value::Integer(2))].into();
    Change { ticket: 1, group: "rotator_1", values, expected: None, is_unlocked: true }
}

proptest! {
    #[test]
    fn whatever_happens_it_sends_whole_commands_and_never_spins(
        steps in prop::collection::vec(step(), 0..60),
        rotators in prop::sample::select(vec![Rotators::Pair, Rotators::First, Rotators::Second]),
    ) {
        let rates = PollRates { idle_hz: 2.0, moving_hz: 4.0 };
        let mut genius = Genius::new(rates, rotators);
        let mut now = Moment { steady: Instant::now(), utc: Timestamp::UNIX_EPOCH };
        genius.link_up(now);
        for step in steps {
            match step {
                ScriptStep::Wait(ms) => now.steady += Duration::from_millis(ms),
                ScriptStep::Receive(bytes) => genius.receive(&bytes, now),
                ScriptStep::Start(motion) => {
                    let _ = genius.objection(&motion.into(), now);
                    genius.start(motion);
                }
                ScriptStep::Act(action, degrees) => {
                    let values: Values = [actions::DIRECTION.entry(degrees)].into();
                    genius.act(Act { action, values });
                }
                ScriptStep::WriteSettings => genius.write_settings(settings_write(), now),
                ScriptStep::Halt => prop_assert_eq!(genius.halt(Extent::Motion, now), b"|S"),
                ScriptStep::LinkUp => genius.link_up(now),
                ScriptStep::LinkDown => genius.link_down(now),
            }
            let mut sent = 0;
            while let Some(bytes) = genius.poll(now) {
                prop_assert!(Request::parse(&bytes).is_ok(), "{bytes:?}");
                genius.sent(&bytes, now);
                sent += 1;
                prop_assert!(sent < 10, "it sends without an end");
            }
            prop_assert!(genius.due(now) > now.steady, "nothing is left to do now");
            while genius.next_wire_line().is_some() {}
        }
    }
}

/// Returns a pair that was read once, and the time at which it is asked again.
fn asked_again(is_watched: bool) -> (Genius, Moment) {
    let mut now = Moment { steady: Instant::now(), utc: Timestamp::UNIX_EPOCH };
    let mut unit = Genius::new(PollRates { idle_hz: 2.0, moving_hz: 4.0 }, Rotators::Pair);
    unit.link_up(now);
    unit.watch_closely(is_watched);
    assert_eq!(unit.poll(now).as_deref(), Some(&b"|h"[..]));
    unit.receive(STATUS, now);
    now.steady += Duration::from_millis(500);
    assert_eq!(unit.poll(now).as_deref(), Some(&b"|h"[..]));
    (unit, now)
}

#[test]
fn a_new_link_forgets_what_the_checks_found() {
    let (mut unit, now) = asked_again(false);
    let states =
        |unit: &Genius| unit.state().checks.iter().map(|check| check.state).collect::<Vec<_>>();
    assert!(!states(&unit).is_empty() && !states(&unit).contains(&CheckState::Unknown));
    unit.link_up(now);
    assert!(!states(&unit).is_empty());
    assert!(states(&unit).iter().all(|state| *state == CheckState::Unknown));
    assert_eq!(unit.state().checked_at, None);
}

#[test]
fn a_lost_status_leaves_the_position_of_a_moving_antenna_young() {
    let (mut unit, mut now) = asked_again(true);
    let lost = now.steady;
    now.steady += Duration::from_millis(600);
    assert_eq!(unit.poll(now).as_deref(), Some(&b"|h"[..]));
    let repeated = now.steady;
    unit.receive(STATUS, now);
    assert_eq!(unit.state().measured.unwrap().requested, lost, "it may answer either question");
    assert_eq!(unit.poll(now).as_deref(), Some(&b"|h"[..]), "without a pause");
    now.steady += Duration::from_millis(30);
    unit.receive(STATUS, now);
    assert_eq!(unit.state().measured.unwrap().requested, repeated);
}

#[test]
fn a_surplus_status_is_waited_for_while_the_antenna_stands() {
    let (mut unit, mut now) = asked_again(false);
    now.steady += Duration::from_secs(1);
    assert_eq!(unit.poll(now).as_deref(), Some(&b"|h"[..]));
    unit.receive(STATUS, now);
    now.steady += DRAIN.checked_sub(Duration::from_millis(1)).unwrap();
    assert_eq!(unit.poll(now), None);
    now.steady += Duration::from_millis(1);
    assert_eq!(unit.poll(now).as_deref(), Some(&b"|h"[..]));
    unit.receive(STATUS, now);
    assert_eq!(unit.state().measured.unwrap().requested, now.steady);
}

#[test]
fn a_position_wanted_while_an_older_one_is_waited_for_is_asked_for_after_it() {
    let (mut unit, mut now) = asked_again(true);
    now.steady += Duration::from_millis(100);
    unit.ask_position(now);
    assert_eq!(unit.poll(now), None);
    unit.receive(STATUS, now);
    assert_eq!(unit.poll(now).as_deref(), Some(&b"|h"[..]));
}
