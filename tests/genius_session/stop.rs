//! STOP: Azel sends it before everything else, never refuses it, and ends it only with a proved
//! standstill.

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, Intent, LinkState, StopState},
    controller::rotator_genius::Rotators,
    sim::rotator_genius::Fault,
};

use super::{
    rig::{Rig, is_stopping, to},
    script::{Scripted, plain, status},
};

#[tokio::test(start_paused = true)]
async fn a_stop_in_a_go_to_is_sent_at_once_and_shown_until_proved() {
    let mut rig = Rig::pair().await;
    rig.send(to(Some(250.0), Some(80.0)));
    rig.seconds(3.0).await;
    let pressed = Instant::now();
    rig.stop();
    rig.seconds(0.02).await;
    assert_eq!(rig.orders(), ["|A1250", "|A2080", "|S"]);
    assert_eq!(rig.times("|S"), [pressed]);
    assert!(is_stopping(rig.shown().stop));
    rig.until("stopped", 3, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    assert!(!rig.rotator(1).is_turning && !rig.rotator(2).is_turning, "coasting is no standstill");
    assert_eq!(rig.events(), [Event::Stopped]);
    assert_eq!(rig.shown().intent, Intent::Standby);
}

#[tokio::test(start_paused = true)]
async fn a_stop_does_not_wait_for_a_reply_that_is_owed() {
    let mut rig = Rig::pair().await;
    rig.send(to(Some(250.0), None));
    rig.seconds(3.0).await;
    rig.control.set_fault(Fault::Silence, true);
    rig.seconds(0.7).await;
    let pressed = Instant::now();
    rig.stop();
    rig.seconds(0.02).await;
    assert_eq!(rig.times("|S"), [pressed]);
    rig.until_event(4, |event| *event == Event::StopNotConfirmed).await;
    assert!(!rig.rotator(1).is_turning, "it stands, but that is not known");
    assert!(rig.times("|S").len() >= 3, "a stop is repeated until proved");
    rig.control.set_fault(Fault::Silence, false);
    rig.until("stopped", 20, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
}

#[tokio::test(start_paused = true)]
async fn a_stop_between_the_two_commands_of_a_position_drops_the_second() {
    let mut first = true;
    let script = move |command: &str| {
        if command.starts_with("|A") && std::mem::take(&mut first) {
            return vec![(300, b"|AK".to_vec())];
        }
        plain(command)
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.6).await;
    device.handle.send(to(Some(120.0), Some(40.0))).unwrap();
    device.seconds(0.1).await;
    device.handle.stop();
    device.seconds(1.0).await;
    assert_eq!(device.orders(), ["|A1120", "|S"]);
    let traffic = device.handle.snapshot().state.traffic;
    assert_eq!((traffic.unsolicited, traffic.unanswered), (0, 0));
}

#[tokio::test(start_paused = true)]
async fn a_status_that_was_asked_for_before_the_stop_proves_nothing() {
    let script = |command: &str| match command {
        "|h" => vec![(400, status(100, 10, ['0', '0'], '\0'))],
        other => plain(other),
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(1.2).await;
    let asked = *device.times("|h").last().unwrap();
    assert!((Instant::now() - asked).as_millis() < 400, "a reply is owed");
    let pressed = Instant::now();
    device.handle.stop();
    while !matches!(device.handle.snapshot().stop, StopState::Stopped { .. }) {
        device.seconds(0.01).await;
    }
    let next = device.times("|h").into_iter().find(|at| *at > pressed).unwrap();
    assert!(Instant::now() >= next + std::time::Duration::from_millis(400));
}

#[tokio::test(start_paused = true)]
async fn a_refused_stop_is_told_and_sent_again() {
    let script = |command: &str| match command {
        "|S" => vec![(10, b"|SF".to_vec())],
        "|h" => vec![(10, status(100, 10, ['1', '0'], '\0'))],
        other => plain(other),
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.stop();
    device.seconds(3.5).await;
    let events = device.events();
    assert!(events.contains(&Event::StopRefused("F".to_owned())), "{events:?}");
    assert!(events.contains(&Event::StopNotConfirmed));
    assert!(device.times("|S").len() >= 4);
}

#[tokio::test(start_paused = true)]
async fn flags_of_motion_keep_the_stop_owed_until_the_operator_has_seen_it_stand() {
    // The peer reports motion, but its angle stays.
    let script = |command: &str| match command {
        "|h" => vec![(10, status(100, 10, ['1', '0'], '\0'))],
        other => plain(other),
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.stop();
    device.seconds(30.0).await;
    let events = device.events();
    assert!(!events.contains(&Event::Stopped), "{events:?}");
    let shown = device.handle.snapshot();
    assert!(matches!(shown.stop, StopState::NotConfirmed { .. }) && shown.unproved, "{shown:?}");
    let stops = device.times("|S").len();
    device.handle.send(Command::SeenStanding).unwrap();
    device.seconds(10.0).await;
    let shown = device.handle.snapshot();
    assert_eq!((shown.stop, shown.unproved), (StopState::Ready, false));
    assert_eq!(device.times("|S").len(), stops);
}

#[tokio::test(start_paused = true)]
async fn a_stop_without_a_link_is_the_first_thing_sent_when_it_is_back() {
    let mut rig = Rig::pair().await;
    rig.send(to(Some(350.0), None));
    rig.seconds(2.0).await;
    rig.set_off(true);
    rig.until("lost", 1, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    let before = rig.commands().len();
    rig.stop();
    rig.seconds(1.0).await;
    assert!(rig.rotator(1).is_turning, "the device heard nothing");
    rig.set_off(false);
    rig.until_up(9).await;
    rig.seconds(0.05).await;
    assert_eq!(rig.commands()[before], "|S");
    rig.until("stopped", 4, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
}

#[tokio::test(start_paused = true)]
async fn standby_ends_a_motion() {
    let mut rig = Rig::pair().await;
    rig.send(to(Some(250.0), None));
    rig.seconds(2.0).await;
    rig.send(Command::Standby);
    rig.until_still(3).await;
    assert_eq!(rig.orders(), ["|A1250", "|S"]);
}
