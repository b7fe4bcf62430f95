//! Positions: the commands sent, and their results.

use azel::{
    contract::driver::{Event, Intent, Refusal},
    controller::rotator_genius::Rotators,
    device::{Motion, MotionRequest},
    protocol::rotator_genius::RotatorNumber,
    sim::rotator_genius::{Fault, Quirk},
};

use super::{
    rig::{Rig, pair, to},
    script::{Scripted, plain, status},
};

#[tokio::test(start_paused = true)]
async fn numbers_are_padded_and_360_stays_360() {
    // The unit points at 100 degrees.
    for (asked, sent) in [(7.4, "|A1007"), (0.0, "|A1000"), (359.7, "|A1359"), (360.0, "|A1360")] {
        let mut device = Scripted::start(Rotators::Pair, Box::new(plain));
        device.seconds(0.5).await;
        device.handle.send(to(Some(asked), None)).unwrap();
        device.seconds(0.5).await;
        assert_eq!(device.orders(), [sent], "{asked}");
        // Azel shows the whole degree that it sent to the unit.
        let aim = device.handle.snapshot().aim.and_then(|aim| aim.azimuth).unwrap().degrees();
        let told: f64 = sent[3..].parse().unwrap();
        assert!((aim - told % 360.0).abs() < 1e-9, "{asked}: {aim}");
    }
    // A direction of the sky becomes the nearest position of the axis.
    let script = |command: &str| match command {
        "|h" => vec![(10, status(350, 10, ['0', '0'], '\0'))],
        other => plain(other),
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.send(to(Some(0.0), None)).unwrap();
    device.seconds(0.5).await;
    assert_eq!(device.orders(), ["|A1360"]);
}

#[tokio::test(start_paused = true)]
async fn a_newer_wish_replaces_the_one_that_runs() {
    let mut rig = Rig::pair().await;
    rig.send(to(Some(250.0), Some(40.0)));
    rig.seconds(2.0).await;
    rig.send(to(Some(150.0), Some(30.0)));
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    // The rotator stops before it reverses.
    assert_eq!(rig.orders(), ["|A1250", "|A2040", "|S", "|A1150", "|A2030"]);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_refused_position_is_told_with_the_reason_and_stops_the_other_axis() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::Refuse, true);
    rig.send(to(Some(180.0), Some(20.0)));
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(asked, why) = event else { unreachable!() };
    assert!(matches!(asked, MotionRequest::Motion(Motion::Position { .. })));
    assert_eq!(why, "F for rotator 1: no reason is given; its limits are 0 and 359");
    rig.seconds(0.5).await;
    assert_eq!(rig.orders(), ["|A1180", "|S"], "half of a motion is none");
    assert_eq!(rig.shown().intent, Intent::Standby);
}

#[tokio::test(start_paused = true)]
async fn a_lost_answer_is_not_asked_for_again_and_the_motion_watched() {
    let mut lose = true;
    let mut is_turning = false;
    let script = move |command: &str| {
        is_turning |= command == "|A1120";
        match command {
            "|A1120" if std::mem::take(&mut lose) => vec![],
            "|h" if is_turning => vec![(10, status(119, 10, ['1', '0'], '\0'))],
            other => plain(other),
        }
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.send(to(Some(120.0), None)).unwrap();
    device.seconds(3.0).await;
    assert_eq!(device.orders(), ["|A1120"]);
    assert!(device.handle.snapshot().state.measured.unwrap().moving());
    let events = device.events();
    assert!(!events.iter().any(|event| matches!(event, Event::Unanswered(_))), "{events:?}");
}

#[tokio::test(start_paused = true)]
async fn a_lost_command_is_told_and_not_sent_again() {
    let script = |command: &str| if command.starts_with("|A") { vec![] } else { plain(command) };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.send(to(Some(120.0), Some(30.0))).unwrap();
    device.seconds(5.0).await;
    assert_eq!(device.orders(), ["|A1120", "|S"]);
    assert!(device.events().iter().any(|event| matches!(event, Event::Unanswered(_))));
}

#[tokio::test(start_paused = true)]
async fn one_that_is_stuck_ends_short() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::Stuck(RotatorNumber::One), true);
    rig.send(to(Some(220.0), None));
    rig.seconds(2.0).await;
    assert!(rig.shown().state.measured.unwrap().moving(), "it is driven");
    rig.control.set_fault(Fault::NoSensor(RotatorNumber::One), true);
    rig.until_event(10, |event| matches!(event, Event::EndedShort { .. })).await;
    assert_eq!(rig.orders(), ["|A1220"]);
}

#[tokio::test(start_paused = true)]
async fn the_longer_answer_is_taken_too() {
    let mut options = pair();
    options.quirks.insert(Quirk::GoToReply6);
    let mut rig = Rig::connected(&options, Rotators::Pair).await;
    rig.send(to(Some(180.0), Some(12.0)));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["|A1180", "|A2012"]);
    assert_eq!(rig.shown().state.traffic.unsolicited, 0);
}

#[tokio::test(start_paused = true)]
async fn what_the_mount_cannot_do_is_not_sent() {
    let mut rig = Rig::pair().await;
    rig.send(to(None, Some(-1.0)));
    rig.send(to(None, Some(90.5)));
    rig.send(to(Some(f64::NAN), None));
    rig.seconds(0.2).await;
    let events = rig.events();
    let [
        Event::NotSent(Refusal::Elevation { .. }),
        Event::NotSent(Refusal::Elevation { .. }),
        Event::NotSent(Refusal::Nothing),
    ] = events[..]
    else {
        panic!("{events:?}")
    };
    assert_eq!(rig.orders(), [""; 0]);
}
