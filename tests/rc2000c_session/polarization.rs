//! Polarization: turned by hand, by the stored values, and by the unit.

use azel::{
    contract::driver::{Command, Event, Intent, Refusal},
    device::{MotionRequest, settings::Value},
    sim::rc2000c::Quirk,
};

use super::{
    rig::{Rig, reading},
    track::tracking,
};

async fn until_commands_are(rig: &mut Rig, text: &str) {
    rig.until(text, 40, |shown| reading(shown, "Polarization commands").as_deref() == Some(text))
        .await;
}

async fn refused(rig: &mut Rig) -> String {
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(MotionRequest::Action(_), reason) = event else { panic!("{event:?}") };
    reason
}

#[tokio::test(start_paused = true)]
async fn jogs_stored_values_and_units_go_out_byte_by_byte() {
    let mut rig = Rig::in_manual().await;
    rig.act("polarization_cw", []);
    rig.seconds(1.5).await;
    assert!(rig.control.state().polarization_units < 263);
    rig.act("polarization_ccw", []);
    rig.seconds(1.5).await;
    rig.act("polarity_v", []);
    rig.seconds(0.5).await;
    assert!(reading(&rig.shown(), "Polarization").unwrap().ends_with("on its way"));
    rig.seconds(8.0).await;
    assert_eq!(reading(&rig.shown(), "Polarity").as_deref(), Some("V"));
    rig.act("polarity_h", []);
    rig.seconds(8.0).await;
    rig.act("to_polarization", [("units", Value::Integer(500))]);
    rig.seconds(8.0).await;
    assert_eq!(rig.control.state().polarization_units, 500);
    let frames = rig.control.received();
    let bytes = frames.iter().filter(|(_, frame)| matches!(frame.code(), b'2' | b'4'));
    let bytes: Vec<Vec<u8>> = bytes.map(|(_, frame)| frame.to_bytes()).collect();
    assert_eq!(
        bytes,
        [
            &b"\x02\x32\x34C\x03\x44"[..],
            b"\x02\x32\x34W\x03\x50",
            b"\x02\x32\x34V\x03\x51",
            b"\x02\x32\x34H\x03\x4f",
            b"\x02\x32\x32P0050000000\x03\x54",
        ]
    );
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn in_standby_nothing_turns() {
    let mut rig = Rig::in_manual().await;
    rig.send(Command::Standby);
    rig.act("polarity_v", []);
    rig.seconds(0.5).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::Intent(Intent::Standby))]);
    assert!(rig.times("4").is_empty());
}

#[tokio::test(start_paused = true)]
async fn automatic_polarization_is_switched_shown_and_refuses_the_rest() {
    let mut rig = Rig::in_manual().await;
    rig.act("auto_polarization_on", []);
    rig.seconds(1.0).await;
    assert_eq!(reading(&rig.shown(), "Automatic polarization").as_deref(), Some("on"));
    rig.act("polarization_cw", []);
    assert_eq!(refused(&mut rig).await, "automatic polarization is on");
    rig.act("to_polarization", [("units", Value::Integer(500))]);
    assert_eq!(refused(&mut rig).await, "automatic polarization is on");
    rig.send(Command::Standby);
    rig.act("auto_polarization_off", []);
    rig.seconds(1.0).await;
    assert_eq!(reading(&rig.shown(), "Automatic polarization").as_deref(), Some("off"));
    let settings: Vec<String> =
        rig.orders().into_iter().filter(|text| text.starts_with('6')).collect();
    assert_eq!(settings, ["6PN", "6PF"]);
}

#[tokio::test(start_paused = true)]
async fn a_turn_that_track_does_not_allow_is_refused_before_it_is_sent() {
    let mut rig = tracking().await;
    until_commands_are(&mut rig, "not now").await;
    rig.events();
    rig.act("polarization_cw", []);
    rig.act("to_polarization", [("units", Value::Integer(500))]);
    rig.seconds(0.5).await;
    let is_explained = |event: &Event| match event {
        Event::NotSent(Refusal::Controller(why)) => why.contains("in this phase of TRACK"),
        _ => false,
    };
    let events = rig.events();
    assert!(events.len() == 2 && events.iter().all(is_explained), "{events:?}");
    assert!(rig.times("4").is_empty() && rig.times("2P").is_empty());
    rig.act("polarity_v", []);
    rig.seconds(0.5).await;
    assert_eq!(rig.times("4").len(), 1, "the unit carries it out after the peak-up");
    until_commands_are(&mut rig, "allowed").await;
    rig.act("polarization_cw", []);
    rig.seconds(0.5).await;
    assert_eq!(rig.times("4").len(), 2);
    rig.stop();
    rig.until_event(5, |event| *event == Event::Stopped).await;
    rig.until("off", 5, |shown| reading(shown, "Polarization commands").is_none()).await;
}

#[tokio::test(start_paused = true)]
async fn stop_holds_a_polarization_that_is_on_its_way_where_it_is() {
    let mut rig = Rig::in_manual().await;
    rig.act("to_polarization", [("units", Value::Integer(600))]);
    rig.seconds(2.0).await;
    let first_new = rig.orders().len();
    rig.stop();
    rig.until_event(3, |event| *event == Event::Stopped).await;
    rig.seconds(1.0).await;
    let orders = &rig.orders()[first_new..];
    assert_eq!(orders[0], "3XS0000");
    let holds: Vec<&String> = orders.iter().filter(|text| text.starts_with("2P")).collect();
    assert_eq!(holds.len(), 1, "{orders:?}");
    let held = rig.control.state().polarization_units;
    assert!((380..420).contains(&held), "{held}");
    rig.seconds(5.0).await;
    assert_eq!(rig.control.state().polarization_units, held);
}

#[tokio::test(start_paused = true)]
async fn a_release_of_a_jog_leaves_the_polarization_alone() {
    let mut rig = Rig::in_manual().await;
    rig.act("to_polarization", [("units", Value::Integer(600))]);
    rig.seconds(0.5).await;
    rig.hold([0.0, 0.5], 0.5).await;
    rig.send(Command::EndJog);
    rig.seconds(0.5).await;
    assert_eq!(rig.times("2P").len(), 1);
}

#[tokio::test(start_paused = true)]
async fn a_rotating_feed_is_named_and_beyond_its_travel_refused() {
    let mut rig = Rig::in_manual().await;
    rig.control.set_quirk(Quirk::RotatingFeed, true);
    rig.seconds(1.0).await;
    assert_eq!(reading(&rig.shown(), "Polarization").as_deref(), Some("263 (rotating feed)"));
    rig.act("to_polarization", [("units", Value::Integer(1020))]);
    assert_eq!(refused(&mut rig).await, "the polarization does not reach so far");
    rig.act("to_polarization", [("units", Value::Integer(1012))]);
    rig.seconds(15.0).await;
    let shown = reading(&rig.shown(), "Polarization").unwrap();
    assert_eq!(shown, "at the limit CCW (rotating feed)");
}
