//! Motions to a direction, and to the park position.

use azel::{
    astro::{Angle, AzEl},
    contract::driver::{Command, Event, Intent, Refusal},
    protocol::satrak::FaultKind,
    sim::satrak::Fault,
};

use super::rig::{Rig, antenna, iss, options, track};

fn position(azimuth_deg: Option<f64>, elevation_deg: Option<f64>) -> Command {
    Command::Position {
        azimuth: azimuth_deg.map(Angle::from_degrees),
        elevation: elevation_deg.map(Angle::from_degrees),
    }
}

#[tokio::test(start_paused = true)]
async fn a_position_is_sent_in_hundredths_and_pending_until_it_is_reached() {
    let mut rig = Rig::usual().await;
    rig.send(position(Some(125.104), Some(32.6)));
    rig.seconds(1.0).await;
    assert_eq!(rig.orders(), ["GOTO=,125.1,32.6"]);
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.pending), (Intent::Position, true));
    let aim = shown.aim.unwrap();
    let asked = AzEl::from_degrees(125.104, 32.6);
    assert!(aim.direction().unwrap().separation(asked).degrees() < 1e-6);
    assert!(shown.state.measured.unwrap().moving());
    assert_eq!(rig.events(), []);

    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.pending), (Intent::Position, false));
    assert!(shown.state.measured.unwrap().pointing.separation(aim).unwrap().degrees() < 0.05);
    assert!(!rig.control.state().is_moving);
    rig.seconds(10.0).await;
    assert_eq!(rig.events(), [], "told once");
    assert_eq!(rig.sent("GOTO=").len(), 1);
}

#[tokio::test(start_paused = true)]
async fn azimuth_alone_leaves_the_elevation_as_it_is() {
    let mut rig = Rig::usual().await;
    rig.send(position(Some(100.0), Some(40.0)));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    rig.send(position(Some(74.61), None));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["GOTO=,100,40", "GOTO=,74.61,NONE"]);
    let state = rig.control.state();
    assert!((state.az_deg - 74.61).abs() < 0.02 && (state.el_deg - 40.0).abs() < 0.02, "{state:?}");
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_reached_is_refused_and_ends_nothing() {
    // The limit is so low that the keyholes are the reason for the refusal.
    let mut low = antenna();
    low.limits.minimum_elevation_deg = 2.0;
    let mut rig = Rig::connected(&options(), &low).await;
    rig.send(position(Some(90.0), Some(20.0)));
    rig.seconds(1.0).await;
    for (azimuth, elevation) in [
        (Some(10.0), Some(1.9)),
        (None, Some(90.1)),
        (None, None),
        // Directions along the lower axis, and across it at the end of its travel.
        (Some(0.0), Some(4.0)),
        (Some(270.0), Some(4.0)),
    ] {
        rig.send(position(azimuth, elevation));
    }
    rig.seconds(0.1).await;
    let events = rig.events();
    let [low, high, nothing, keyhole, end] = &events[..] else { panic!("{events:?}") };
    let is_elevation =
        |event: &Event| matches!(event, Event::NotSent(Refusal::Elevation { lowest_deg: 2.0, .. }));
    assert!(is_elevation(low) && is_elevation(high), "{events:?}");
    assert_eq!(*nothing, Event::NotSent(Refusal::Nothing));
    assert!(matches!(keyhole, Event::NotSent(Refusal::Travel { axis: "Y", .. })), "{events:?}");
    assert!(matches!(end, Event::NotSent(Refusal::Travel { axis: "X", .. })), "{events:?}");
    assert_eq!(rig.orders(), ["GOTO=,90,20"]);
    assert_eq!((rig.shown().intent, rig.shown().pending), (Intent::Position, true));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
}

#[tokio::test(start_paused = true)]
async fn a_newer_position_stops_the_one_under_way_first() {
    let mut rig = Rig::usual().await;
    rig.send(position(Some(90.0), Some(20.0)));
    rig.seconds(3.0).await;
    rig.send(position(Some(270.0), Some(60.0)));
    let arrived = rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    let Event::Arrived(at) = arrived else { panic!("{arrived:?}") };
    assert!((at.direction().unwrap().azimuth_deg() - 270.0).abs() < 1e-6);
    let orders = rig.orders();
    let [first, stop, again @ .., second] = &orders[..] else { panic!("{orders:?}") };
    assert_eq!([first, stop, second], ["GOTO=,90,20", "STOP=", "GOTO=,270,60"]);
    let is_halt = |order: &String| order == "STOP=" || order == "TRACK=,0";
    assert!(again.iter().all(is_halt), "{orders:?}");
    let between =
        rig.times("GOTO=")[1].saturating_duration_since(rig.times("STOP=")[0]).as_secs_f64();
    // The simulated axis needs this long to slow down.
    assert!(between > 0.6, "not before it stands: {between}");
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn park_goes_to_the_park_position_and_stays_there() {
    let mut rig = Rig::usual().await;
    rig.send(position(Some(120.0), Some(60.0)));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    rig.send(Command::Park);
    rig.seconds(0.5).await;
    assert_eq!((rig.shown().intent, rig.shown().pending), (Intent::Park, true));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["GOTO=,120,60", "GOTO=,0,90"]);
    assert_eq!((rig.shown().intent, rig.shown().pending), (Intent::Park, false));
    assert!((rig.control.state().el_deg - 90.0).abs() < 0.02);
}

#[tokio::test(start_paused = true)]
async fn a_position_while_tracking_stops_first() {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(60.0).await;
    let before = rig.orders().len();
    rig.send(position(Some(90.0), Some(60.0)));
    rig.until_event(40, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders()[before..], ["STOP=", "TRACK=,0", "GOTO=,90,60"]);
    assert!(!rig.control.state().is_tracking);
    assert_eq!(rig.shown().target, None);
}

#[tokio::test(start_paused = true)]
async fn a_motor_that_does_not_turn_is_told() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Unit(FaultKind::XMotor), true);
    rig.until("locked", 2, |shown| shown.state.motion_lock == Some(true)).await;
    rig.send(position(Some(90.0), Some(20.0)));
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::Fault)]);
    assert_eq!(rig.orders(), [""; 0]);
    rig.control.set_fault(Fault::Unit(FaultKind::XMotor), false);
    rig.until("free", 2, |shown| shown.state.motion_lock == Some(false)).await;
}

#[tokio::test(start_paused = true)]
async fn a_motion_that_ends_elsewhere_is_told() {
    let mut rig = Rig::usual().await;
    rig.send(position(Some(90.0), Some(20.0)));
    rig.seconds(3.0).await;
    // The motor dies on the way, and the unit does not stop it by a command.
    rig.control.set_fault(Fault::Unit(FaultKind::XMotor), true);
    let event = rig.until_event(20, |event| matches!(event, Event::EndedShort { .. })).await;
    let Event::EndedShort { aim, position: at } = event else { panic!("{event:?}") };
    assert!(aim.separation(at).unwrap().degrees() > 10.0);
    assert!(!rig.shown().pending);
}
