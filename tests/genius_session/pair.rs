//! Two rotators that turn one antenna.

use azel::{
    astro::AzEl,
    contract::driver::{Command, Event, Intent, Refusal, Safety},
    controller::rotator_genius::Rotators,
    device::panel::CheckState,
    plan::{Barrier, Bounds},
    protocol::rotator_genius::{RotatorNumber, WholeDegrees},
    sim::rotator_genius::{Fault, Options, RotatorOptions},
    station::Station,
};

use super::rig::{Rig, azimuth, pair, to};

fn swapped() -> Options {
    let Options { rotators: [azimuth, elevation], .. } = pair();
    Options { rotators: [elevation, azimuth], ..pair() }
}

#[tokio::test(start_paused = true)]
async fn a_position_is_two_commands_and_arrives() {
    let mut rig = Rig::pair().await;
    assert_eq!(rig.axes_deg(), [Some(173.0), Some(0.0)]);
    rig.send(to(Some(200.4), Some(44.6)));
    let arrived = rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["|A1200", "|A2045"]);
    assert_eq!(rig.rotator(1).target, None);
    let Event::Arrived(aim) = arrived else { unreachable!() };
    let whole = AzEl::from_degrees(200.0, 45.0);
    assert_eq!(aim, whole.into(), "as the device was told");
    assert_eq!(rig.axes_deg(), [Some(200.0), Some(45.0)]);
    assert_eq!(rig.events(), []);
    assert!(!rig.rotator(1).is_turning && !rig.rotator(2).is_turning);
}

#[tokio::test(start_paused = true)]
async fn the_kinds_decide_which_rotator_is_which_axis() {
    let mut rig = Rig::connected(&swapped(), Rotators::Pair).await;
    assert_eq!(rig.axes_deg(), [Some(173.0), Some(0.0)]);
    rig.send(to(Some(180.0), Some(10.0)));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["|A2180", "|A1010"]);
    let direction = rig.shown().state.measured.unwrap().direction().unwrap();
    assert!((direction.azimuth.degrees() - 180.0).abs() < 1.0);
    assert!((direction.elevation.degrees() - 10.0).abs() < 1.0);
}

#[tokio::test(start_paused = true)]
async fn one_angle_alone_moves_one_rotator() {
    let mut rig = Rig::pair().await;
    rig.send(to(None, Some(30.0)));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    rig.send(to(Some(170.0), None));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["|A2030", "|A1170"]);
}

#[tokio::test(start_paused = true)]
async fn beyond_the_zenith_the_antenna_points_to_the_other_side() {
    let mut options = pair();
    options.rotators[1] = RotatorOptions {
        position: WholeDegrees::new(120).unwrap(),
        limit_cw: WholeDegrees::new(180).unwrap(),
        ..RotatorOptions::elevation()
    };
    let rig = Rig::connected(&options, Rotators::Pair).await;
    assert_eq!(rig.axes_deg(), [Some(173.0), Some(120.0)]);
    let direction = rig.shown().state.measured.unwrap().direction().unwrap();
    assert!((direction.azimuth.degrees() - 353.0).abs() < 1e-9);
    assert!((direction.elevation.degrees() - 60.0).abs() < 1e-9);
}

#[tokio::test(start_paused = true)]
async fn two_rotators_of_one_kind_are_told_and_take_no_positions() {
    let options = Options { rotators: [azimuth("One", 10), azimuth("Two", 20)], ..pair() };
    let mut rig = Rig::connected(&options, Rotators::Pair).await;
    assert_eq!(rig.axes_deg(), [None, None]);
    assert_eq!(rig.shown().state.measured.unwrap().direction(), None);
    let shown = rig.shown();
    assert!(shown.state.checked_at >= shown.state.measured.map(|measured| measured.time));
    let check = shown.state.checks.iter().find(|check| check.name == "Kinds of the rotators");
    assert_eq!(check.unwrap().state, CheckState::Fault);
    assert_eq!(rig.reading("Heading 2"), "20°");
    rig.send(to(Some(50.0), None));
    rig.seconds(1.0).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
    assert_eq!(rig.orders(), [""; 0]);
    assert_eq!(rig.shown().intent, Intent::Standby);
}

#[tokio::test(start_paused = true)]
async fn a_rotator_without_a_sensor_is_told_and_not_sent_anywhere() {
    let mut rig = Rig::pair().await;
    rig.control
        .set_fault(Fault::NoSensor(azel::protocol::rotator_genius::RotatorNumber::Two), true);
    rig.seconds(1.0).await;
    assert_eq!(rig.axes_deg(), [Some(173.0), None]);
    let shown = rig.shown();
    let check = shown.state.checks.iter().find(|check| check.name == "Sensor of rotator 2");
    assert_eq!(check.unwrap().state, CheckState::Fault);
    rig.send(to(Some(180.0), Some(20.0)));
    rig.seconds(0.2).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
    assert_eq!(rig.orders(), [""; 0]);
    // Azel can still move the other axis.
    rig.send(to(Some(180.0), None));
    rig.until_event(20, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["|A1180"]);
}

#[tokio::test(start_paused = true)]
async fn both_rotators_are_shown_with_all_that_they_tell() {
    let mut rig = Rig::pair().await;
    assert_eq!(rig.reading("Rotator 1"), "Tower, azimuth");
    assert_eq!(rig.reading("Rotator 2"), "elevation", "named after its axis");
    assert_eq!(rig.reading("Limits 1"), "0° to 359°");
    assert_eq!(rig.reading("Offset 1"), "0°");
    rig.send(to(Some(213.0), None));
    rig.seconds(5.0).await;
    let shown = rig.shown();
    let target = shown.state.readings.iter().find(|reading| reading.label == "Target 1").unwrap();
    assert_eq!(target.text, "213°");
    let share = target.share.unwrap();
    // The rotator has turned for 5 s at 4 degrees a second, with a ramp of 1 s.
    assert!((0.3..0.6).contains(&share), "{share}");
    assert!(rig.reading("Heading 1").ends_with("°, turning clockwise"));
}

/// Starts a pair with these bounds, in Manual and 60 degrees up, whose azimuth has lost its sensor.
async fn without_an_azimuth(station: &Station, minimum_elevation_deg: f64) -> Rig {
    let mut elevation = RotatorOptions::elevation();
    elevation.position = WholeDegrees::new(60).unwrap();
    let options = Options { rotators: [RotatorOptions::default(), elevation], ..pair() };
    let mut rig = Rig::connected(&options, Rotators::Pair).await;
    let mut antenna = super::rig::antenna(Rotators::Pair);
    antenna.limits.minimum_elevation_deg = minimum_elevation_deg;
    rig.handle().keep_within(Bounds::new(station, &antenna));
    rig.control.set_fault(Fault::NoSensor(RotatorNumber::One), true);
    // After this time, the azimuth may be anywhere within its travel.
    rig.seconds(100.0).await;
    rig.send(Command::Manual);
    rig.events();
    rig
}

fn elevation_deg(rig: &Rig) -> f64 {
    rig.axes_deg()[1].unwrap()
}

#[tokio::test(start_paused = true)]
async fn an_azimuth_without_a_sensor_does_not_lift_the_minimum_elevation() {
    let mut rig = without_an_azimuth(&Station::default(), 40.0).await;
    rig.hold([0.0, -4.0], 15.0).await;
    rig.seconds(3.0).await;
    assert!(elevation_deg(&rig) >= 39.0, "{}", elevation_deg(&rig));
    let events = rig.events();
    let is_refused = |event: &Event| {
        matches!(event, Event::NotSent(Refusal::Forbidden { barrier, .. })
            if *barrier == Barrier::MinimumElevation)
    };
    assert!(events.iter().any(is_refused), "{events:?}");
}

#[tokio::test(start_paused = true)]
async fn while_the_azimuth_is_unknown_a_keep_out_may_be_anywhere_below() {
    let mast = crate::common::mast(&[(10.0, -5.0), (30.0, -5.0), (30.0, 20.0), (10.0, 20.0)]);
    let station = Station { keep_outs: vec![mast], ..Station::default() };
    let mut rig = without_an_azimuth(&station, 0.0).await;
    rig.hold([0.0, -4.0], 20.0).await;
    rig.seconds(3.0).await;
    let at_deg = elevation_deg(&rig);
    assert!((21.0..40.0).contains(&at_deg), "{at_deg}");
    let barrier = || Barrier::KeepOut("mast".into());
    let is_refused = |event: &Event| matches!(event, Event::NotSent(Refusal::Forbidden { barrier: hit, .. }) if *hit == barrier());
    assert!(rig.events().iter().any(is_refused));
    rig.send(Command::EndJog);
}

#[tokio::test(start_paused = true)]
async fn a_motion_below_a_keep_out_that_may_be_anywhere_needs_the_operators_hold() {
    let mast = crate::common::mast(&[(10.0, -5.0), (30.0, -5.0), (30.0, 70.0), (10.0, 70.0)]);
    let station = Station { keep_outs: vec![mast], ..Station::default() };
    let mut rig = without_an_azimuth(&station, 0.0).await;
    rig.hold([0.0, -4.0], 1.0).await;
    let barrier = Barrier::KeepOut("mast".into());
    let unchecked = Event::NotSent(Refusal::Unchecked { axis: "Az", barrier });
    assert_eq!(rig.events(), std::slice::from_ref(&unchecked));
    let inside = rig.shown().breach.clone().unwrap();
    assert_eq!((inside.unknown_axis, inside.may_leave), (Some("Az"), false));
    rig.send(Command::EndJog);
    rig.send(Command::AllowWayOut);
    rig.seconds(0.1).await;
    rig.hold([0.0, -4.0], 3.0).await;
    assert!(elevation_deg(&rig) < 58.0);
    assert_eq!(rig.events(), []);
    rig.send(Command::EndJog);
    rig.seconds(60.0).await;
    rig.hold([0.0, -4.0], 1.0).await;
    assert_eq!(rig.events(), [unchecked], "the minute is over");
    rig.send(Command::EndJog);
    rig.stop();
    let by_flags = Event::Safety(Safety::StoppedByFlags { axis: "Az" });
    rig.until_event(5, |event| *event == by_flags).await;
    assert_eq!(rig.events(), [Event::Stopped]);
}
