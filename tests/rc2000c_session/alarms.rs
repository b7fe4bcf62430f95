//! Alarms: Azel shows their names, refuses the motions that they forbid, and clears them on
//! request.

use azel::{
    contract::driver::{Command, Event, Intent, Refusal},
    device::{panel::CheckState, settings::Value},
    protocol::rc2000c::Alarm,
    sim::rc2000c::Fault,
};

use super::rig::{Rig, check, reading};

#[tokio::test(start_paused = true)]
async fn a_jammed_drive_is_named_forbids_motion_and_is_reset_after_a_stop() {
    let mut rig = Rig::in_manual().await;
    rig.control.set_fault(Fault::AzimuthJam, true);
    rig.act("to_counts", [("az_counts", Value::Integer(2000)), ("el_counts", Value::Integer(750))]);
    rig.seconds(3.0).await;
    let shown = rig.shown();
    assert_eq!(check(&shown, "Azimuth drive"), Some(CheckState::Fault));
    assert_eq!(check(&shown, "Azimuth alarm"), Some(CheckState::Fault));
    assert_eq!(check(&shown, "Elevation drive"), Some(CheckState::Good));
    assert_eq!(shown.state.motion_lock, Some(true));
    rig.events();
    rig.send(Command::Jog { rates_deg_s: [0.0, 2.0] });
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::Fault)]);

    rig.control.set_fault(Fault::AzimuthJam, false);
    rig.seconds(1.0).await;
    assert_eq!(rig.shown().state.motion_lock, Some(true), "the alarm stays");
    let before = rig.orders().len();
    rig.act("reset_azimuth", []);
    rig.seconds(2.0).await;
    assert_eq!(rig.orders()[before..], ["3XS0000", "6RA"]);
    let frames = rig.control.received();
    let reset = frames.iter().find(|(_, frame)| frame.code() == b'6').unwrap();
    assert_eq!(reset.1.to_bytes(), b"\x02\x32\x36RA\x03\x16");
    assert_eq!(rig.shown().state.motion_lock, Some(false));
    assert_eq!(check(&rig.shown(), "Azimuth drive"), Some(CheckState::Good));
    rig.send(Command::Manual);
    rig.hold([2.0, 0.0], 1.0).await;
    assert!(rig.control.state().is_turning);
}

#[tokio::test(start_paused = true)]
async fn a_runaway_is_seen_moving_and_stopped_only_when_it_stands() {
    let mut rig = Rig::in_manual().await;
    rig.control.set_fault(Fault::ElevationRunaway, true);
    rig.seconds(1.0).await;
    assert_eq!(check(&rig.shown(), "Elevation drive"), Some(CheckState::Fault));
    assert!(rig.shown().state.measured.unwrap().moving());
    rig.stop();
    rig.until_event(5, |event| *event == Event::StopNotConfirmed).await;
    rig.control.set_fault(Fault::ElevationRunaway, false);
    rig.until_event(5, |event| *event == Event::Stopped).await;
    assert_eq!(check(&rig.shown(), "Elevation drive"), Some(CheckState::Fault), "until reset");
    rig.act("reset_elevation", []);
    rig.seconds(1.0).await;
    assert_eq!(rig.orders().last().unwrap(), "6RE");
    assert_eq!(check(&rig.shown(), "Elevation drive"), Some(CheckState::Good));
}

#[tokio::test(start_paused = true)]
async fn every_alarm_of_the_display_has_a_name_and_some_forbid_motion() {
    let mut rig = Rig::in_manual().await;
    let mut locking = Vec::new();
    for alarm in Alarm::ALL.into_iter().skip(1) {
        rig.control.set_fault(Fault::Alarm(alarm), true);
        rig.seconds(0.7).await;
        let shown = rig.shown();
        let name = reading(&shown, "Alarm").unwrap();
        assert_eq!(check(&shown, &name), Some(CheckState::Fault), "{alarm:?}");
        let held = shown.state.checks.iter().find(|check| check.name == name).unwrap();
        assert!(held.advice.ends_with('.'), "{alarm:?}");
        if shown.state.motion_lock == Some(true) {
            locking.push(alarm);
        }
        rig.control.set_fault(Fault::Alarm(alarm), false);
    }
    assert_eq!(
        locking,
        [Alarm::AzimuthCount, Alarm::ElevationCount, Alarm::AzimuthLimits, Alarm::ElevationLimits]
    );
    assert_eq!(rig.shown().intent, Intent::Manual);
    assert!(rig.orders().is_empty(), "nothing is reset by itself");
}

#[tokio::test(start_paused = true)]
async fn a_reset_of_a_feed_that_is_not_there_is_explained() {
    let mut rig = Rig::in_manual().await;
    rig.act("reset_polarization", []);
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(_, reason) = event else { panic!("{event:?}") };
    assert_eq!(reason, "there is no rotating feed");
    assert_eq!(rig.orders(), ["3XS0000", "6RP"]);
}
