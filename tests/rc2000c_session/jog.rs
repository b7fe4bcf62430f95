//! Jogs, which the unit times and Azel renews only while the operator holds the key.

use std::time::Duration;

use azel::{
    contract::driver::{Command, Event, LinkState, Refusal},
    controller::rc2000c::BAUD,
    device::{Motion, MotionRequest, settings::Value},
    plan::Barrier,
    sim::rc2000c::{AxisOptions, Fault, Options, Quirk},
};

use super::rig::{Rig, antenna, uncalibrated};

const FAST: f64 = 2.0;
const SLOW: f64 = 0.5;

#[tokio::test(start_paused = true)]
async fn a_held_key_is_renewed_at_half_its_time_and_its_release_stops() {
    let mut rig = Rig::in_manual().await;
    rig.hold([FAST, 0.0], 3.0).await;
    assert!(rig.shown().state.measured.unwrap().moving());
    assert_eq!(rig.shown().jog, Some([FAST, 0.0]));
    let frames = rig.control.received();
    let jog = frames.iter().find(|(_, frame)| frame.code() == b'3').unwrap();
    assert_eq!(jog.1.to_bytes(), b"\x02\x32\x33WF0600\x03\x17");
    let times = rig.times("3WF0600");
    assert!((9..=11).contains(&times.len()), "{}", times.len());
    for pair in times.windows(2) {
        let apart = (pair[1] - pair[0]).as_millis();
        assert!((295..450).contains(&apart), "{apart}");
    }
    let before = rig.counts()[0];
    assert!(before > 1525 + 60, "it has turned all the while: {before}");

    rig.send(Command::EndJog);
    rig.seconds(0.02).await;
    assert_eq!(rig.orders().last().unwrap(), "3XS0000");
    rig.seconds(3.0).await;
    assert!(!rig.control.state().is_turning);
    assert_eq!(rig.times("3W").len(), times.len(), "it is not begun again");
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn the_four_keys_and_two_speeds_make_the_letters_of_the_manual() {
    for (rates_deg_s, wanted) in [
        ([-FAST, 0.0], "3EF0600"),
        ([SLOW, 0.0], "3WS0600"),
        ([0.0, FAST], "3UF0600"),
        ([0.0, -SLOW], "3DS0600"),
    ] {
        let mut rig = Rig::in_manual().await;
        rig.hold(rates_deg_s, 0.5).await;
        assert_eq!(rig.orders()[0], wanted);
    }
}

#[tokio::test(start_paused = true)]
async fn an_axis_without_a_calibration_may_be_jogged() {
    let mut rig = Rig::connected(&Options::default(), &uncalibrated()).await;
    rig.send(Command::Manual);
    rig.hold([0.0, FAST], 1.0).await;
    assert!(rig.counts()[1] > 770);
    rig.send(Command::EndJog);
    rig.seconds(2.0).await;
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_stop_and_standstill_stand_between_two_axes() {
    let mut rig = Rig::in_manual().await;
    rig.hold([FAST, 0.0], 1.0).await;
    rig.hold([0.0, FAST], 3.0).await;
    let orders = rig.orders();
    let stop = orders.iter().position(|text| text == "3XS0000").unwrap();
    assert!(orders[..stop].iter().all(|text| text == "3WF0600"), "{orders:?}");
    let other = orders.iter().position(|text| text == "3UF0600").unwrap();
    assert!(orders[stop..other].iter().all(|text| text == "3XS0000"), "{orders:?}");
    assert!(orders[other..].iter().all(|text| text == "3UF0600"), "{orders:?}");
    let between = rig.times("3U")[0] - rig.times("3X")[0];
    // The simulated axis coasts for 0.8 s, which only its counts show.
    assert!(between > Duration::from_millis(600), "{between:?}");
    rig.hold([FAST, FAST], 4.0).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::OneAxis)]);
}

#[tokio::test(start_paused = true)]
async fn a_lease_that_is_not_renewed_ends_the_jog() {
    let mut rig = Rig::in_manual().await;
    rig.hold([FAST, 0.0], 1.0).await;
    rig.until_event(1, |event| *event == Event::JogLeaseOver).await;
    rig.seconds(0.02).await;
    assert_eq!(rig.orders().last().unwrap(), "3XS0000");
    let last = *rig.times("3W").last().unwrap();
    rig.seconds(5.0).await;
    assert_eq!(*rig.times("3W").last().unwrap(), last);
    assert!(!rig.control.state().is_turning);
}

/// After a computer has slept, the renewal and the end of a jog are due at once.
#[tokio::test(start_paused = true)]
async fn a_session_that_was_held_up_ends_the_jog_and_does_not_renew_it() {
    // Delay the session at any point in the cycle of the jog.
    for place in 0..16 {
        let mut rig = Rig::in_manual().await;
        rig.hold([FAST, 0.0], 0.6).await;
        rig.seconds(f64::from(place) * 0.015).await;
        rig.send(Command::Jog { rates_deg_s: [FAST, 0.0] });
        rig.seconds(0.01).await;
        let sent = rig.times("3W").len();
        tokio::time::advance(Duration::from_millis(350)).await;
        rig.seconds(0.2).await;
        assert_eq!(rig.times("3W").len(), sent, "{place}");
        assert_eq!(rig.orders().last().unwrap(), "3XS0000", "{place}");
        rig.seconds(3.0).await;
        assert_eq!(rig.events(), [Event::JogLeaseOver]);
    }
}

#[tokio::test(start_paused = true)]
async fn a_line_of_1200_baud_is_fast_enough_to_jog_without_a_break() {
    let mut slow = antenna();
    slow.connection.put(&BAUD, Value::Choice(1200)).unwrap();
    let mut rig = Rig::connected(&Options { baud: 1200, ..Options::default() }, &slow).await;
    rig.send(Command::Manual);
    rig.seconds(0.5).await;
    rig.hold([FAST, 0.0], 5.0).await;
    let times = rig.times("3W");
    let longest = times.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
    assert!(longest < Duration::from_millis(550), "{longest:?}");
    assert_eq!(rig.events(), []);
    rig.stop();
    rig.until_event(5, |event| *event == Event::Stopped).await;
}

#[tokio::test(start_paused = true)]
async fn a_window_that_goes_away_stops_the_antenna() {
    let mut rig = Rig::in_manual().await;
    rig.hold([FAST, 0.0], 0.5).await;
    rig.drop_handle().await;
    assert_eq!(rig.orders().last().unwrap(), "3XS0000");
}

#[tokio::test(start_paused = true)]
async fn after_a_missed_reply_the_jog_is_not_renewed_and_the_unit_ends_it() {
    let mut rig = Rig::in_manual().await;
    rig.hold([FAST, 0.0], 1.0).await;
    rig.control.set_fault(Fault::Silence, true);
    let since = azel::clock::Instant::now();
    rig.hold([FAST, 0.0], 2.0).await;
    let after: Vec<_> = rig.times("3W").into_iter().filter(|at| *at > since).collect();
    assert!(after.len() <= 1, "{after:?}");
    assert!(!rig.times("3X").is_empty());
    let events = rig.events();
    let told = |event: &Event| {
        matches!(
            event,
            Event::JogPositionOld | Event::Unanswered(MotionRequest::Motion(Motion::Jog { .. }))
        )
    };
    assert!(events.iter().any(told), "{events:?}");
    assert!(!rig.control.state().is_turning, "the timer of the unit has ended it");
    rig.control.set_fault(Fault::Silence, false);
    rig.send(Command::EndJog);
    rig.seconds(3.0).await;
    assert_eq!(rig.shown().jog, None);
}

#[tokio::test(start_paused = true)]
async fn a_link_lost_in_a_jog_leaves_it_to_the_timer_and_comes_back_with_a_stop() {
    let mut rig = Rig::in_manual().await;
    rig.hold([FAST, 0.0], 1.0).await;
    let (before, dials) = (rig.received().len(), rig.dials().len());
    rig.set_off(true);
    // Wait until the last renewal is over and the axis has coasted.
    rig.seconds(1.5).await;
    assert!(matches!(rig.shown().link, LinkState::Lost { .. }));
    assert!(!rig.control.state().is_turning, "nobody had to say stop");
    rig.seconds(0.5).await;
    assert_eq!(rig.received().len(), before);
    let tries = rig.dials().split_off(dials);
    let waits: Vec<_> = tries.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let quarter = Duration::from_millis(240)..Duration::from_millis(260);
    assert!(waits.len() >= 5 && waits.iter().all(|wait| quarter.contains(wait)), "{waits:?}");
    rig.set_off(false);
    rig.seconds(2.0).await;
    assert_eq!(rig.received()[before], "3XS0000");
    assert!(!rig.received()[before..].iter().any(|text| text.starts_with("3W")));
}

#[tokio::test(start_paused = true)]
async fn a_refused_jog_ends_with_the_likely_reason() {
    let mut rig = Rig::in_manual().await;
    rig.control.set_fault(Fault::Refuse, true);
    rig.send(Command::Jog { rates_deg_s: [FAST, 0.0] });
    let event = rig.until_event(1, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(MotionRequest::Motion(Motion::Jog { .. }), reason) = event else {
        panic!("{event:?}")
    };
    assert_eq!(reason, "the unit does not say why");
    assert_eq!(rig.times("3W").len(), 1);
}

#[tokio::test(start_paused = true)]
async fn a_limit_blocks_its_own_direction_only() {
    let quirks = [Quirk::RefuseAtLimit].into_iter().collect();
    let mut rig = Rig::connected(&Options { quirks, ..Options::default() }, &antenna()).await;
    rig.send(Command::Manual);
    // With a calibration, the minimum elevation ends the jog before the limit does.
    rig.hold([0.0, -FAST], 30.0).await;
    let events = rig.events();
    let barrier = Barrier::MinimumElevation;
    assert!(
        matches!(&events[0], Event::NotSent(Refusal::Forbidden { barrier: hit, .. }) if *hit == barrier),
        "{events:?}"
    );

    let mut rig = Rig::connected(&Options::default(), &uncalibrated()).await;
    rig.send(Command::Manual);
    rig.hold([0.0, -FAST], 30.0).await;
    assert_eq!(rig.counts()[1], 30);
    assert!(rig.shown().state.measured.unwrap().axes[1].minus_limit);
    rig.send(Command::EndJog);
    rig.seconds(2.0).await;
    rig.events();
    rig.hold([0.0, -FAST], 0.5).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::Limit { axis: "El", plus: false })]);
    rig.send(Command::EndJog);
    rig.hold([0.0, FAST], 2.0).await;
    assert!(rig.counts()[1] > 60, "the way out is free");
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn an_alarm_during_a_held_jog_ends_it() {
    let mut rig = Rig::in_manual().await;
    rig.hold([FAST, 0.0], 1.0).await;
    rig.control.set_fault(Fault::AzimuthOvercurrent, true);
    let since = azel::clock::Instant::now();
    rig.hold([FAST, 0.0], 3.0).await;
    let later: Vec<_> = rig.times("3W").into_iter().filter(|at| *at > since).collect();
    assert!(later.len() <= 2, "{later:?}");
    assert!(rig.times("3X")[0] - since < Duration::from_millis(700));
    assert!(rig.events().contains(&Event::NotSent(Refusal::Fault)));
}

/// Starts an antenna with a minimum elevation of 30 degrees, 36 degrees up. Its azimuth stands at
/// its limit and reports no angle.
async fn at_the_limit_of_its_azimuth() -> Rig {
    let azimuth = AxisOptions { travel: 1524..=3630, ..AxisOptions::AZIMUTH };
    let mut antenna = antenna();
    antenna.limits.minimum_elevation_deg = 30.0;
    let mut rig = Rig::connected(&Options { azimuth, ..Options::default() }, &antenna).await;
    rig.send(Command::Manual);
    rig.hold([-SLOW, 0.0], 2.0).await;
    rig.send(Command::EndJog);
    rig.seconds(3.0).await;
    let [azimuth, _] = rig.shown().state.measured.unwrap().axes;
    assert_eq!((azimuth.angle_deg, azimuth.minus_limit), (None, true));
    rig.events();
    rig
}

#[tokio::test(start_paused = true)]
async fn an_azimuth_at_its_limit_does_not_lift_the_minimum_elevation() {
    let mut rig = at_the_limit_of_its_azimuth().await;
    rig.hold([0.0, -FAST], 15.0).await;
    rig.seconds(3.0).await;
    let elevation_deg = f64::from(rig.counts()[1] - 30) / 20.0;
    assert!(elevation_deg >= 29.5, "{elevation_deg}");
    let refused = |event: &Event| {
        matches!(event, Event::NotSent(Refusal::Forbidden { barrier, .. })
            if *barrier == Barrier::MinimumElevation)
    };
    assert!(rig.events().iter().any(refused));
    // Nothing blocks the elevation on its way up.
    rig.send(Command::EndJog);
    rig.hold([0.0, FAST], 2.0).await;
    assert!(f64::from(rig.counts()[1] - 30) / 20.0 > elevation_deg + 2.0);
}
