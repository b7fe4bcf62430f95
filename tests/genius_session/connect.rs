//! Connection from the first byte to a lost link and back.

use std::time::Duration;

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Event, Found, LinkLoss, LinkState, Refusal},
    controller::rotator_genius::Rotators,
    sim::rotator_genius::Fault,
};

use super::{
    rig::{Rig, antenna, pair},
    script::Scripted,
};

#[tokio::test(start_paused = true)]
async fn the_first_word_is_the_question_and_its_answer_is_shown() {
    let mut rig = Rig::start(&pair(), &antenna(Rotators::Pair));
    rig.until_up(1).await;
    rig.seconds(0.1).await;
    assert_eq!(rig.commands(), ["|h"]);
    assert_eq!(rig.events(), [Event::Connected(Found::Still)]);
    let measured = rig.shown().state.measured.unwrap();
    assert_eq!(measured.pointing.azimuth, Some(Angle::from_degrees(173.0)));
    assert_eq!(measured.pointing.elevation, Some(Angle::from_degrees(0.0)));
    assert_eq!(rig.shown().state.motion_lock, Some(false));
}

#[tokio::test(start_paused = true)]
async fn it_is_asked_twice_a_second_at_rest_and_four_times_while_it_moves() {
    let mut rig = Rig::pair().await;
    let before = rig.times("|h").len();
    rig.seconds(10.0).await;
    let at_rest = rig.times("|h").len() - before;
    assert!((19..=21).contains(&at_rest), "{at_rest}");
    assert_eq!(rig.shown().poll_period, Duration::from_millis(500));

    rig.send(super::rig::to(Some(250.0), None));
    rig.seconds(1.0).await;
    let before = rig.times("|h").len();
    rig.seconds(10.0).await;
    let moving = rig.times("|h").len() - before;
    assert!((39..=41).contains(&moving), "{moving}");
    assert_eq!(rig.shown().poll_period, Duration::from_millis(250));
}

#[tokio::test(start_paused = true)]
async fn one_that_accepts_and_stays_silent_is_stale_then_lost_and_comes_back() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::Silence, true);
    rig.until("stale", 2, |shown| matches!(shown.link, LinkState::Stale { .. })).await;
    let last_reply = rig.shown().state.traffic.last_reply.unwrap();
    let asked = rig.times("|h").len();
    rig.seconds(3.0).await;
    assert_eq!(rig.times("|h").len() - asked, 3, "a reply is waited for a second");
    rig.until_event(9, |event| *event == Event::LinkLost(LinkLoss::Silent)).await;
    let waited_s = (Instant::now() - last_reply).as_secs_f64();
    assert!((8.0..8.1).contains(&waited_s), "{waited_s}");
    rig.control.set_fault(Fault::Silence, false);
    rig.until_event(
        10,
        |event| matches!(event, Event::Back { found: Found::Still, after, .. } if after.as_secs() >= 8),
    )
    .await;
    rig.until_up(1).await;
}

#[tokio::test(start_paused = true)]
async fn one_that_is_silent_from_the_start_is_lost_after_eight_seconds() {
    let mut options = pair();
    options.faults.insert(Fault::Silence);
    let mut rig = Rig::start(&options, &antenna(Rotators::Pair));
    rig.until_event(9, |event| *event == Event::LinkLost(LinkLoss::Silent)).await;
    let waited = (Instant::now() - rig.started).as_secs_f64();
    assert!((8.0..8.1).contains(&waited), "{waited}");
    rig.send(super::rig::to(Some(10.0), None));
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::PositionUnknown)]);
}

#[tokio::test(start_paused = true)]
async fn a_refused_connection_is_told_and_tried_again() {
    let mut rig = Rig::start(&pair(), &antenna(Rotators::Pair));
    rig.set_off(true);
    rig.seconds(0.2).await;
    assert!(matches!(rig.events()[..], [Event::LinkLost(LinkLoss::Refused(_))]));
    rig.set_off(false);
    rig.until_event(2, |event| *event == Event::Connected(Found::Still)).await;
}

#[tokio::test(start_paused = true)]
async fn another_protocol_is_told_as_such_and_asked_nothing_more() {
    let mut device = Scripted::raw(b"V3.0.1 AUTH\n");
    device.seconds(0.3).await;
    assert_eq!(device.events(), [Event::LinkLost(LinkLoss::OtherDevice)]);
    let LinkState::Lost { reason, .. } = device.handle.snapshot().link.clone() else {
        panic!("{:?}", device.handle.snapshot().link)
    };
    assert_eq!(reason, LinkLoss::OtherDevice);
    assert_eq!(device.sent(), ["|h"]);
}

#[tokio::test(start_paused = true)]
async fn noise_alone_is_told_as_unreadable() {
    let mut device = Scripted::raw(b"hello\r\n");
    device.seconds(8.5).await;
    assert_eq!(device.events(), [Event::LinkLost(LinkLoss::Unreadable)]);
    assert!(device.handle.snapshot().state.traffic.damaged > 0);
}

#[tokio::test(start_paused = true)]
async fn a_new_link_is_not_late_for_the_position_of_the_one_before() {
    let mut rig = Rig::pair().await;
    rig.send(Command::Disconnect);
    rig.seconds(60.0).await;
    assert!(rig.shown().state.measured.is_some());
    rig.send(Command::Connect);
    for _ in 0..200 {
        rig.seconds(0.01).await;
        assert!(!matches!(rig.shown().link, LinkState::Stale { .. }), "{:?}", rig.shown().link);
    }
    rig.until_up(1).await;
}

#[tokio::test(start_paused = true)]
async fn a_web_server_that_closes_at_once_is_another_device() {
    let script =
        |_: &str| vec![(10, b"HTTP/1.1 400 Bad Request\r\n\r\n".to_vec()), (11, Vec::new())];
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.1).await;
    assert_eq!(device.events(), [Event::LinkLost(LinkLoss::OtherDevice)]);
}

#[tokio::test(start_paused = true)]
async fn a_device_that_is_let_go_of_is_left_alone() {
    let mut rig = Rig::pair().await;
    rig.send(Command::Disconnect);
    rig.seconds(1.0).await;
    assert_eq!(rig.shown().link, LinkState::Off);
    let asked = rig.commands().len();
    rig.seconds(10.0).await;
    assert_eq!(rig.commands().len(), asked);
    rig.send(Command::Connect);
    rig.until_up(1).await;
}
