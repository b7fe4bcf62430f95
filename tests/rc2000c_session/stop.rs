//! STOP: Azel sends it before everything else, even with the link off, and proves it only when all
//! axes stand.

use std::time::Duration;

use azel::{
    astro::Angle,
    contract::driver::{Command, Event, Intent, LinkState, StopState},
    controller::rc2000c::BAUD,
    device::settings::Value,
    sim::rc2000c::{Fault, Options, Quirk},
};

use super::rig::{Rig, antenna};

fn far() -> Command {
    let angle = |degrees| Some(Angle::from_degrees(degrees));
    Command::Position { azimuth: angle(260.0), elevation: angle(80.0) }
}

async fn on_its_way(options: &Options) -> Rig {
    let mut rig = Rig::connected(options, &antenna()).await;
    rig.send(Command::Hold);
    rig.send(far());
    rig.until("it moves", 3, |shown| shown.state.measured.unwrap().moving()).await;
    rig.seconds(2.0).await;
    rig
}

#[tokio::test(start_paused = true)]
async fn stop_while_off_dials_and_says_stop_first() {
    let mut rig = Rig::start(&Options::default(), &antenna());
    rig.seconds(5.0).await;
    rig.stop();
    let is_outcome = |event: &Event| matches!(event, Event::Stopped | Event::StopNotConfirmed);
    assert_eq!(rig.until_event(3, is_outcome).await, Event::Stopped);
    let frames = rig.control.received();
    assert_eq!(frames[0].1.to_bytes(), b"\x02\x32\x33XS0000\x03\x0b");
    assert_eq!(rig.received()[1], "0");
    // Azel leaves the panel to a local operator.
    rig.until("let go", 3, |shown| shown.link == LinkState::Off).await;
}

#[tokio::test(start_paused = true)]
async fn stop_goes_past_a_reply_that_is_waited_for() {
    let mut rig = on_its_way(&Options::default()).await;
    rig.control.set_fault(Fault::Silence, true);
    let polls = rig.times("1").len();
    rig.until("asked", 1, |_| true).await;
    while rig.times("1").len() == polls {
        rig.seconds(0.01).await;
    }
    let pressed = azel::clock::Instant::now();
    rig.stop();
    rig.seconds(0.02).await;
    let stopped = *rig.times("3X").first().unwrap();
    assert!(stopped - pressed < Duration::from_millis(20));
    assert_eq!(rig.shown().intent, Intent::Standby);
    assert!(matches!(rig.shown().stop, StopState::Stopping { .. }));
    rig.control.set_fault(Fault::Silence, false);
    rig.until_event(8, |event| *event == Event::Stopped).await;
    assert!(!rig.control.state().is_turning, "it has run out");
}

#[tokio::test(start_paused = true)]
async fn a_stop_is_believed_only_when_the_numbers_stand() {
    let mut rig = on_its_way(&Options::default()).await;
    rig.stop();
    rig.seconds(0.02).await;
    let mut acknowledged = 0;
    while rig.control.state().is_turning {
        // The drive has lost its power, but the axis still coasts.
        assert!(matches!(rig.shown().stop, StopState::Stopping { .. }), "{:?}", rig.shown().stop);
        acknowledged += 1;
        rig.seconds(0.01).await;
    }
    assert!(acknowledged > 20);
    rig.until_event(3, |event| *event == Event::Stopped).await;
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_goes_on_is_told_again_and_never_called_stopped() {
    let options =
        Options { quirks: [Quirk::StopSparesAutoMove].into_iter().collect(), ..Options::default() };
    let mut rig = on_its_way(&options).await;
    rig.stop();
    rig.until_event(5, |event| *event == Event::StopNotConfirmed).await;
    assert!(rig.times("3X").len() >= 3);
    assert!(matches!(rig.shown().stop, StopState::NotConfirmed { .. }));
    rig.until_event(120, |event| *event == Event::Stopped).await;
    assert!(!rig.control.state().is_turning);
}

#[tokio::test(start_paused = true)]
async fn a_stop_that_is_refused_is_told() {
    let mut rig = on_its_way(&Options::default()).await;
    rig.control.set_fault(Fault::RemoteDisabled, true);
    rig.stop();
    let event = rig.until_event(2, |event| matches!(event, Event::StopRefused(_))).await;
    assert_eq!(event, Event::StopRefused("remote mode is disabled on the unit".to_owned()));
    rig.until_event(5, |event| *event == Event::StopNotConfirmed).await;
}

#[tokio::test(start_paused = true)]
async fn stop_without_a_link_goes_out_first_on_the_next_one() {
    let mut rig = on_its_way(&Options::default()).await;
    rig.set_off(true);
    rig.seconds(1.0).await;
    rig.stop();
    rig.seconds(1.0).await;
    let before = rig.received().len();
    rig.set_off(false);
    rig.until_event(5, |event| *event == Event::Stopped).await;
    assert_eq!(rig.received()[before], "3XS0000");
}

#[tokio::test(start_paused = true)]
async fn orders_that_wait_are_dropped_by_a_stop() {
    let mut rig = Rig::in_manual().await;
    rig.act("polarization_cw", []);
    rig.act("polarization_ccw", []);
    rig.stop();
    rig.until_event(3, |event| *event == Event::Stopped).await;
    rig.seconds(3.0).await;
    assert!(rig.times("4").is_empty(), "{:?}", rig.orders());
}

#[tokio::test(start_paused = true)]
async fn a_stop_is_proved_on_the_slowest_lines_too() {
    for baud in [300, 600, 1200] {
        let mut slow = antenna();
        slow.connection.put(&BAUD, Value::Choice(baud.into())).unwrap();
        let mut rig = Rig::start(&Options { baud, ..Options::default() }, &slow);
        rig.send(Command::Connect);
        rig.until_found().await;
        rig.send(Command::Hold);
        rig.send(far());
        rig.until("it moves", 5, |shown| shown.state.measured.unwrap().moving()).await;
        rig.seconds(2.0).await;
        rig.stop();
        // At 300 baud a question and its reply take two seconds behind a halt.
        rig.until_event(10, |event| *event == Event::Stopped).await;
        assert!(!rig.control.state().is_turning, "{baud}");
        assert!(rig.times("3X").len() <= 2, "{baud}: {:?}", rig.orders());
    }
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_stood_when_it_was_let_go_wants_no_stop_and_one_that_moved_does() {
    let mut rig = Rig::connected(&Options::default(), &antenna()).await;
    assert!(rig.shown().wants_stop(), "it is connected");
    rig.send(Command::Disconnect);
    rig.until("off", 3, |shown| shown.link == LinkState::Off).await;
    assert!(!rig.shown().wants_stop(), "it was never moved");

    let mut rig = on_its_way(&Options::default()).await;
    rig.send(Command::Disconnect);
    rig.until("off", 3, |shown| shown.link == LinkState::Off).await;
    assert!(rig.shown().unproved && rig.shown().wants_stop(), "it may still move");
    rig.stop();
    rig.until_event(8, |event| *event == Event::Stopped).await;
    rig.until("let go", 3, |shown| shown.link == LinkState::Off).await;
    rig.until("not shown any more", 12, |shown| shown.stop == StopState::Ready).await;
    assert!(!rig.shown().wants_stop(), "it is proved to stand");
}

#[tokio::test(start_paused = true)]
async fn a_motion_that_nobody_stopped_is_over_when_the_antenna_has_stood_for_a_while() {
    let mut rig = Rig::connected(&Options::default(), &antenna()).await;
    rig.send(Command::Hold);
    let near = Command::Position { azimuth: Some(Angle::from_degrees(168.0)), elevation: None };
    rig.send(near);
    rig.until("it moves", 3, |shown| shown.state.measured.unwrap().moving()).await;
    assert!(rig.shown().unproved);
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    rig.until("proved", 10, |shown| !shown.unproved).await;
}
