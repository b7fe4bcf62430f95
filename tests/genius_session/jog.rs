//! Jogging: a key press turns a rotator, its release stops it, and no motion outlasts the key.

use std::time::Duration;

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, Intent, LinkState, Refusal},
    controller::rotator_genius::Rotators,
    protocol::rotator_genius::{Moving, RotatorNumber},
    sim::rotator_genius::Fault,
};

use super::{
    rig::Rig,
    script::{Scripted, plain, status},
};

async fn in_manual() -> Rig {
    let rig = Rig::pair().await;
    rig.send(Command::Manual);
    rig
}

#[tokio::test(start_paused = true)]
async fn a_held_key_turns_one_rotator_and_its_release_stops() {
    let mut rig = in_manual().await;
    rig.hold([4.0, 0.0], 2.0).await;
    assert_eq!(rig.orders(), ["|P1"]);
    assert_eq!(rig.rotator(1).moving, Moving::Clockwise);
    assert_eq!(rig.shown().jog, Some([4.0, 0.0]));
    rig.send(Command::EndJog);
    rig.seconds(0.02).await;
    assert_eq!(rig.orders(), ["|P1", "|S"]);
    rig.until_still(3).await;
    assert!(!rig.rotator(1).is_turning, "it is not said to stand before it does");
    assert_eq!(rig.events(), []);
    assert_eq!(rig.shown().intent, Intent::Manual);
}

#[tokio::test(start_paused = true)]
async fn each_way_of_each_rotator_has_its_command() {
    let mut rig = in_manual().await;
    for (rates, seconds) in [([-4.0, 0.0], 1.0), ([0.0, 3.0], 4.0), ([0.0, -0.1], 0.5)] {
        rig.hold(rates, seconds).await;
        rig.send(Command::EndJog);
        rig.until_still(3).await;
        // The reading must be steady for a while before the next jog may begin.
        rig.seconds(1.5).await;
    }
    assert_eq!(rig.orders(), ["|M1", "|S", "|P2", "|S", "|M2", "|S"]);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_lease_that_is_not_renewed_ends_the_jog() {
    let mut rig = in_manual().await;
    rig.hold([4.0, 0.0], 1.0).await;
    rig.until_event(1, |event| *event == Event::JogLeaseOver).await;
    rig.seconds(0.02).await;
    assert_eq!(rig.orders(), ["|P1", "|S"]);
    let held = rig.times("|S")[0].saturating_duration_since(rig.times("|P1")[0]).as_secs_f64();
    assert!((1.15..1.25).contains(&held), "{held}");
}

#[tokio::test(start_paused = true)]
async fn turning_round_stops_first_and_waits_for_standstill() {
    let mut rig = in_manual().await;
    rig.hold([4.0, 0.0], 2.0).await;
    rig.hold([-4.0, 0.0], 3.0).await;
    assert_eq!(rig.orders(), ["|P1", "|S", "|M1"]);
    // The rotator coasts for a second, and then its reading must be steady for a while.
    let between = rig.times("|M1")[0].saturating_duration_since(rig.times("|S")[0]).as_secs_f64();
    assert!((1.0..2.3).contains(&between), "{between}");
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn one_axis_at_a_time() {
    let mut rig = in_manual().await;
    rig.send(Command::Jog { rates_deg_s: [4.0, 4.0] });
    rig.send(Command::Step { steps_deg: [1.0, 0.0] });
    rig.seconds(0.2).await;
    assert_eq!(
        rig.events(),
        [Event::NotSent(Refusal::OneAxis), Event::NotSent(Refusal::NotOffered)]
    );
    assert_eq!(rig.orders(), [""; 0]);
}

#[tokio::test(start_paused = true)]
async fn a_window_that_goes_away_while_a_key_is_held_stops_the_antenna() {
    let mut rig = in_manual().await;
    rig.hold([0.0, 4.0], 0.5).await;
    rig.drop_handle().await;
    assert_eq!(rig.orders(), ["|P2", "|S"]);
}

#[tokio::test(start_paused = true)]
async fn after_a_link_lost_in_a_jog_the_first_word_is_a_stop() {
    let mut rig = in_manual().await;
    rig.hold([4.0, 0.0], 1.0).await;
    let before = rig.commands().len();
    rig.control.drop_clients();
    rig.seconds(0.05).await;
    assert!(matches!(rig.shown().link, LinkState::Lost { .. }));
    assert!(rig.rotator(1).is_turning, "the device goes on by itself");
    rig.until_up(2).await;
    rig.seconds(0.05).await;
    assert_eq!(rig.commands()[before..before + 2], ["|S", "|h"]);
    rig.until_still(3).await;
    assert_eq!(rig.orders(), ["|P1", "|S"], "it does not start again");
}

#[tokio::test(start_paused = true)]
async fn a_jog_that_is_refused_ends_with_the_reason() {
    let mut rig = in_manual().await;
    rig.control.set_fault(Fault::Refuse, true);
    rig.hold([4.0, 0.0], 0.5).await;
    let refused = rig.until_event(1, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(_, why) = refused else { unreachable!() };
    assert_eq!(why, "F for rotator 1: no reason is given; its limits are 0 and 359");
    assert_eq!(rig.orders()[..2], ["|P1", "|S"]);
    assert!(!rig.rotator(1).is_turning);
}

#[tokio::test(start_paused = true)]
async fn without_a_sensor_no_jog() {
    let mut rig = in_manual().await;
    rig.control.set_fault(Fault::NoSensor(RotatorNumber::One), true);
    rig.seconds(1.0).await;
    rig.hold([4.0, 0.0], 0.5).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::AngleUnknown { axis: "Az" })]);
    rig.send(Command::EndJog);
    rig.hold([0.0, 4.0], 0.5).await;
    rig.send(Command::EndJog);
    rig.seconds(0.1).await;
    assert_eq!(rig.orders(), ["|P2", "|S"]);
}

#[tokio::test(start_paused = true)]
async fn a_sensor_that_is_lost_in_a_jog_ends_it() {
    let mut is_turning = false;
    let mut asked = 0;
    let script = move |command: &str| {
        is_turning = (is_turning || command == "|P1") && command != "|S";
        asked += usize::from(is_turning && command == "|h");
        match command {
            "|h" if is_turning && asked > 4 => vec![(10, status(999, 10, ['1', '0'], '\0'))],
            "|h" if is_turning => vec![(10, status(100, 10, ['1', '0'], '\0'))],
            other => plain(other),
        }
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.send(Command::Manual).unwrap();
    for _ in 0..30 {
        device.handle.send(Command::Jog { rates_deg_s: [4.0, 0.0] }).unwrap();
        device.seconds(0.1).await;
    }
    assert_eq!(device.orders()[..2], ["|P1", "|S"]);
    let unknown = Event::NotSent(Refusal::AngleUnknown { axis: "Az" });
    let events = device.events();
    assert!(events.contains(&unknown), "{events:?}");
}

#[tokio::test(start_paused = true)]
async fn a_jog_ends_when_the_answers_stay_away() {
    let mut rig = in_manual().await;
    rig.hold([4.0, 0.0], 1.0).await;
    rig.control.set_fault(Fault::Silence, true);
    rig.hold([4.0, 0.0], 1.5).await;
    assert_eq!(rig.orders()[..2], ["|P1", "|S"]);
    assert!(rig.events().contains(&Event::JogPositionOld));
    let measured = rig.shown().state.measured.unwrap().requested;
    let age_s = (rig.times("|S")[0] - measured).as_secs_f64();
    assert!((1.0..1.15).contains(&age_s), "{age_s}");
}

#[tokio::test(start_paused = true)]
async fn the_second_rotator_is_not_jogged_while_the_first_turns() {
    // Somebody at the front panel turns the first rotator.
    let script = |command: &str| match command {
        "|h" => vec![(10, status(100, 10, ['1', '0'], '\0'))],
        other => plain(other),
    };
    let mut device = Scripted::start(Rotators::First, Box::new(script));
    device.seconds(0.5).await;
    // Hold sends a STOP that stays unproved, because the first rotator keeps turning.
    device.handle.send(Command::Hold).unwrap();
    device.seconds(0.1).await;
    assert_eq!(device.orders(), ["|S"]);
    device.handle.send(Command::Jog { rates_deg_s: [0.0, 4.0] }).unwrap();
    device.seconds(0.2).await;
    assert_eq!(device.orders(), ["|S"]);
}

#[tokio::test(start_paused = true)]
async fn one_degree_between_two_questions_is_no_great_rate() {
    let (mut is_turning, mut elevation_deg) = (false, 40);
    let script = move |command: &str| {
        is_turning = (is_turning || command == "|M2") && command != "|S";
        // A drive at 4 degrees a second may show its next degree at any moment, also right after
        // STOP.
        if is_turning && command == "|h" || command == "|S" {
            elevation_deg -= 1;
        }
        let moving = ['0', if is_turning { '2' } else { '0' }];
        match command {
            "|h" => vec![(10, status(100, elevation_deg, moving, '\0'))],
            other => plain(other),
        }
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.send(Command::Manual).unwrap();
    device.seconds(1.5).await;
    device.events();
    let asked_ago = |device: &Scripted| Instant::now() - *device.times("|h").last().unwrap();
    for _ in 0..100 {
        device.handle.send(Command::Jog { rates_deg_s: [0.0, -4.0] }).unwrap();
        device.seconds(0.01).await;
    }
    let just = Duration::from_millis(15)..Duration::from_millis(40);
    while !just.contains(&asked_ago(&device)) {
        device.handle.send(Command::Jog { rates_deg_s: [0.0, -4.0] }).unwrap();
        device.seconds(0.01).await;
    }
    device.handle.send(Command::EndJog).unwrap();
    device.seconds(3.0).await;
    assert_eq!(device.orders()[..2], ["|M2", "|S"]);
    assert_eq!(device.events(), []);
}
