//! Settings that change the pointing, which wait until the antenna stands.

use azel::{
    contract::driver::{Command, Event, Refusal},
    device::settings::{Change, Hindrance, Value, WriteError},
};

use super::{
    rig::{Rig, iss, track},
    settings::{change, text, write_settings},
};

fn elevation_offset(offset_deg: f64) -> Change {
    change("general", [("elevation_offset_deg", Value::Decimal(offset_deg))])
}

fn hindered(field: &'static str, hindrance: Hindrance) -> Result<(), WriteError> {
    Err(WriteError::Hindered { field, hindrance })
}

async fn tracking() -> Rig {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(150.0).await;
    rig.events();
    rig
}

#[tokio::test(start_paused = true)]
async fn an_offset_does_not_move_an_antenna_that_tracks() {
    let mut rig = tracking().await;
    let before = rig.control.state().el_deg;
    let result = write_settings(&mut rig, elevation_offset(10.0)).await;
    assert_eq!(result, hindered("elevation_offset_deg", Hindrance::Tracks));
    let why = Refusal::Setting { field: "Elevation offset", hindrance: Hindrance::Tracks };
    assert_eq!(rig.events(), [Event::NotSent(why)]);
    rig.seconds(9.0).await;
    let moved = rig.control.state().el_deg - before;
    assert!(moved.abs() < 5.0 && rig.sent("SETTINGS=").is_empty(), "{moved}");
    let rule = change("general", [("sspa_rule", Value::Choice(2))]);
    assert_eq!(write_settings(&mut rig, rule).await, Ok(()), "what points nowhere is free");
    rig.stop();
    rig.until_event(5, |event| *event == Event::Stopped).await;
    assert_eq!(write_settings(&mut rig, elevation_offset(10.0)).await, Ok(()));
}

#[tokio::test(start_paused = true)]
async fn every_setting_that_points_waits_while_the_unit_tracks() {
    let mut rig = tracking().await;
    let until = Value::Time("2030-01-01T00:00:00Z".parse().unwrap());
    for (group, field, value) in [
        ("general", "azimuth_offset_deg", Value::Decimal(1.0)),
        ("general", "time_offset_ms", Value::Integer(60_000)),
        ("general", "north_offset_deg", Value::Decimal(90.0)),
        ("general", "position_base", Value::Choice(0)),
        ("general", "minimum_elevation_deg", Value::Decimal(40.0)),
        ("general", "lead_ms", Value::Integer(1)),
        ("gps", "latitude_deg", Value::Decimal(12.3)),
        ("window", "stop", until),
        ("file", "name", text("TWIN")),
        ("web", "url", text("https://example.org/a")),
        ("ftp", "address", text("10.0.1.2")),
        ("clock", "set_from", Value::Choice(0)),
        ("angles", "x_deg", Value::Decimal(10.0)),
        ("reduction", "x", Value::Decimal(4100.0)),
    ] {
        let wish = Change { is_unlocked: true, ..change(group, [(field, value)]) };
        let result = write_settings(&mut rig, wish).await;
        assert_eq!(result, hindered(field, Hindrance::Tracks), "{group}");
    }
    let after_start = rig.orders().into_iter().skip_while(|order| order != "TRACK=,1").count();
    assert_eq!(after_start, 1, "{:?}", rig.orders());
}

#[tokio::test(start_paused = true)]
async fn a_window_is_not_set_while_the_unit_starts_by_itself() {
    let mut rig = Rig::usual().await;
    rig.send(Command::AutoTrack(true));
    rig.until("auto", 5, |shown| shown.state.program.unwrap().auto == Some(true)).await;
    let window =
        change("window", [("start", Value::Time(iss().start)), ("stop", Value::Time(iss().end))]);
    let result = write_settings(&mut rig, window.clone()).await;
    assert_eq!(result, hindered("start", Hindrance::AutoTrack));
    let twin = change("file", [("file", text("stations.txt")), ("name", text("TWIN"))]);
    assert_eq!(write_settings(&mut rig, twin).await, hindered("file", Hindrance::AutoTrack));
    rig.send(Command::AutoTrack(false));
    rig.until("no auto", 5, |shown| shown.state.program.unwrap().auto == Some(false)).await;
    assert_eq!(write_settings(&mut rig, window).await, Ok(()));
}

#[tokio::test(start_paused = true)]
async fn a_jog_and_a_stop_under_way_hold_such_a_setting_up() {
    let mut rig = Rig::usual().await;
    rig.send(Command::Manual);
    rig.hold([1.0, 0.0], 1.0).await;
    rig.send(Command::WriteSettings(elevation_offset(1.0)));
    rig.hold([1.0, 0.0], 0.3).await;
    let result = |rig: &Rig| {
        let written = rig.shown().state.groups["general"].written.clone();
        written.map(|written| written.result.clone())
    };
    assert_eq!(result(&rig), Some(hindered("elevation_offset_deg", Hindrance::Moves)));
    rig.stop();
    rig.seconds(0.02).await;
    let stopped = write_settings(&mut rig, elevation_offset(2.0)).await;
    assert_eq!(stopped, hindered("elevation_offset_deg", Hindrance::Stopping));
}

#[tokio::test(start_paused = true)]
async fn what_waits_in_the_queue_is_not_sent_once_the_unit_is_to_track() {
    let mut rig = Rig::usual().await;
    for ticket in 100..110 {
        let azimuth = Value::Decimal(ticket as f64 / 100.0);
        let wish = change("general", [("azimuth_offset_deg", azimuth)]);
        rig.send(Command::WriteSettings(Change { ticket, ..wish }));
    }
    rig.send(track(iss()));
    rig.until_event(20, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(5.0).await;
    let orders = rig.orders();
    let start = orders.iter().position(|order| order == "TRACK=,1").unwrap();
    assert!(!orders[start..].iter().any(|order| order.starts_with("SETTINGS=")), "{orders:?}");
    let last = rig.shown().state.groups["general"].written.clone().unwrap();
    assert!(matches!(last.result, Err(WriteError::Hindered { .. })), "{last:?}");
}
