//! Pair of rotators of which only one turns the antenna.

use azel::{
    astro::Angle,
    contract::driver::{Command, Event, Refusal, Response, Safety},
    controller::rotator_genius::{ALONE, OTHER, Rotators},
    device::{MotionRequest, panel::Act, settings::Value},
    plan::Bounds,
    protocol::rotator_genius::{RotatorNumber, WholeDegrees},
    sim::rotator_genius::{Fault, Options, RotatorOptions},
    station::{Antenna, Monitor, Station},
};
use tokio::io::AsyncWriteExt as _;

use super::rig::{Rig, antenna, azimuth, pair, to};

fn two_azimuths() -> Options {
    Options { rotators: [azimuth("Mast", 90), azimuth("Tower", 300)], ..pair() }
}

fn send_other(degrees: i64) -> Command {
    let field = ALONE.action(OTHER).unwrap().fields[0].key;
    Command::Act(Act { action: OTHER, values: [(field, Value::Integer(degrees))].into() })
}

#[tokio::test(start_paused = true)]
async fn each_rotator_can_be_the_antennas() {
    for (rotators, axes, sent) in [
        (Rotators::First, [Some(90.0), Some(300.0)], "|A1120"),
        (Rotators::Second, [Some(300.0), Some(90.0)], "|A2120"),
    ] {
        let mut rig = Rig::connected(&two_azimuths(), rotators).await;
        assert_eq!(rig.axes_deg(), axes);
        let pointing = rig.shown().state.measured.unwrap().pointing;
        assert_eq!(pointing.azimuth.map(Angle::degrees), axes[0]);
        assert_eq!(pointing.elevation, None);
        rig.send(to(Some(120.0), None));
        rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
        assert_eq!(rig.orders(), [sent]);
    }
}

#[tokio::test(start_paused = true)]
async fn there_is_no_elevation_and_park_is_an_azimuth() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::First).await;
    rig.send(to(Some(10.0), Some(10.0)));
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::NotOffered)]);
    rig.send(Command::Park);
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["|A1000"]);
}

#[tokio::test(start_paused = true)]
async fn the_other_rotator_is_sent_by_its_action() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::First).await;
    rig.send(send_other(310));
    rig.seconds(0.1).await;
    let refused = rig.events();
    assert!(matches!(refused[..], [Event::NotSent(Refusal::Intent(_))]), "{refused:?}");
    rig.send(Command::Manual);
    rig.send(send_other(360));
    rig.seconds(1.0).await;
    // Within the limits of the unit, 360 means 0, which lies the long way round.
    assert_eq!(rig.orders(), ["|A2360"]);
    assert!(rig.rotator(2).is_turning);
    assert!(rig.shown().state.measured.unwrap().moving());
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn the_other_rotator_is_jogged_over_its_whole_range() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::First).await;
    rig.send(Command::Manual);
    // The elevation travel of the mount does not apply to the other rotator.
    rig.hold([0.0, 4.0], 1.0).await;
    rig.send(Command::EndJog);
    rig.seconds(2.0).await;
    assert_eq!(rig.orders(), ["|P2", "|S"]);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn neither_is_jogged_while_the_other_turns() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::First).await;
    rig.send(Command::Manual);
    rig.send(send_other(200));
    rig.seconds(1.0).await;
    rig.hold([4.0, 0.0], 0.5).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
    rig.send(Command::EndJog);
    rig.seconds(0.5).await;
    assert_eq!(rig.orders(), ["|A2200"], "and what runs is not stopped for it");
    // Wait until the other rotator stands.
    rig.until_still(60).await;
    rig.hold([4.0, 0.0], 0.5).await;
    assert_eq!(rig.orders(), ["|A2200", "|P1"]);
}

#[tokio::test(start_paused = true)]
async fn what_the_other_one_does_is_not_ended_for_this_antenna() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::First).await;
    rig.send(Command::Manual);
    rig.send(send_other(100));
    rig.seconds(1.0).await;
    rig.send(to(Some(120.0), None));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert!(rig.rotator(2).is_turning, "it has a longer way");
    rig.send(Command::Manual);
    rig.seconds(1.0).await;
    assert_eq!(rig.orders(), ["|A2100", "|A1120"]);
    rig.send(Command::Standby);
    rig.until_still(3).await;
    assert!(!rig.rotator(2).is_turning);
    assert_eq!(rig.orders(), ["|A2100", "|A1120", "|S"]);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_stop_is_proved_by_both_rotators() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::First).await;
    rig.send(Command::Manual);
    rig.send(send_other(100));
    rig.seconds(2.0).await;
    rig.stop();
    rig.until_event(3, |event| *event == Event::Stopped).await;
    assert!(!rig.rotator(2).is_turning);
    assert_eq!(rig.orders(), ["|A2100", "|S"]);
}

#[tokio::test(start_paused = true)]
async fn an_action_that_is_refused_is_told() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::Second).await;
    rig.send(Command::Manual);
    rig.control.set_fault(Fault::Refuse, true);
    rig.send(send_other(200));
    let event = rig.until_event(1, |event| matches!(event, Event::Refused(..))).await;
    assert!(matches!(event, Event::Refused(MotionRequest::Action(OTHER), _)), "{event:?}");
    assert_eq!(rig.orders(), ["|A1200"]);
    rig.control.set_fault(Fault::NoSensor(RotatorNumber::One), true);
    rig.seconds(1.0).await;
    rig.send(send_other(200));
    rig.seconds(0.1).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
    assert_eq!(rig.orders(), ["|A1200"]);
}

#[tokio::test(start_paused = true)]
async fn a_rotator_without_a_sensor_that_is_not_ours_is_no_fault() {
    let rig = Rig::connected(&Options::default(), Rotators::First).await;
    assert_eq!(rig.axes_deg(), [Some(173.0), None]);
    let shown = rig.shown();
    assert!(shown.state.checks.iter().all(|check| !check.name.ends_with('2')));
    let plain = shown.state.readings.iter().find(|reading| reading.label == "Heading 2").unwrap();
    assert_eq!(plain.text, "the sensor is not connected");
    assert_eq!(plain.tone, azel::device::panel::Tone::Plain);
}

#[tokio::test(start_paused = true)]
async fn an_elevation_rotator_is_no_azimuth() {
    let options =
        Options { rotators: [RotatorOptions::elevation(), azimuth("Tower", 300)], ..pair() };
    let mut rig = Rig::connected(&options, Rotators::First).await;
    assert_eq!(rig.axes_deg(), [None, Some(300.0)]);
    assert_eq!(rig.shown().state.measured.unwrap().pointing.azimuth, None);
    assert_eq!(rig.reading("Heading 1"), "0°");
    rig.send(to(Some(10.0), None));
    rig.seconds(0.1).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
}

/// Returns bounds with a mast 20 degrees high, for an antenna of which only the azimuth turns.
fn before_a_mast(from_deg: f64, to_deg: f64) -> Bounds {
    before_a_mast_with(&antenna(Rotators::First), from_deg, to_deg)
}

fn before_a_mast_with(antenna: &Antenna, from_deg: f64, to_deg: f64) -> Bounds {
    before_a_mast_between(antenna, (from_deg, to_deg), (5.0, 20.0))
}

/// Returns bounds with a mast that a beam at the horizon does not touch.
fn before_a_high_mast(from_deg: f64, to_deg: f64) -> Bounds {
    let antenna = Antenna { beam_width_deg: 1.0, ..antenna(Rotators::First) };
    before_a_mast_between(&antenna, (from_deg, to_deg), (50.0, 70.0))
}

fn before_a_mast_between(
    antenna: &Antenna,
    (from_deg, to_deg): (f64, f64),
    (low_deg, high_deg): (f64, f64),
) -> Bounds {
    let corners =
        [(from_deg, low_deg), (to_deg, low_deg), (to_deg, high_deg), (from_deg, high_deg)];
    let mast = crate::common::mast(&corners);
    let station = Station { keep_outs: vec![mast], ..Station::default() };
    Bounds::new(&station, antenna)
}

#[tokio::test(start_paused = true)]
async fn a_keep_out_applies_to_an_azimuth_alone_at_any_elevation() {
    for (monitor, response) in
        [(Monitor::Stop, Response::Stopped), (Monitor::Alarm, Response::Reported)]
    {
        let options = Options { max_clients: 2, ..two_azimuths() };
        let mut rig = Rig::start(&options, &Antenna { monitor, ..antenna(Rotators::First) });
        rig.until("it is read", 5, |shown| shown.state.measured.is_some()).await;
        rig.handle().keep_within(before_a_high_mast(110.0, 130.0));
        rig.seconds(1.0).await;
        // Another program turns the rotator clockwise.
        let mut other = crate::common::network::link(&rig.control);
        other.write_all(b"|P1").await.unwrap();
        let is_told = |event: &Event| matches!(event, Event::Safety(Safety::Forbidden { .. }));
        let told = rig.until_event(30, is_told).await;
        let Event::Safety(Safety::Forbidden { response: made, .. }) = told else {
            panic!("{told:?}")
        };
        assert_eq!(made, response);
        rig.seconds(5.0).await;
        let azimuth_deg = rig.axes_deg()[0].unwrap();
        assert_eq!(azimuth_deg < 109.0, monitor == Monitor::Stop, "{azimuth_deg}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_foreign_motion_is_stopped_before_the_beam_enters_a_keep_out() {
    let mut antenna = antenna(Rotators::First);
    // The beam is 5 degrees further clockwise than the axis reads.
    antenna.pointing_model.azimuth_offset_deg = -5.0;
    let options = Options { max_clients: 2, ..two_azimuths() };
    let mut rig = Rig::start(&options, &antenna);
    rig.until("it is read", 5, |shown| shown.state.measured.is_some()).await;
    rig.handle().keep_within(before_a_mast_with(&antenna, 110.0, 130.0));
    rig.seconds(1.0).await;
    let mut other = crate::common::network::link(&rig.control);
    other.write_all(b"|P1").await.unwrap();
    let is_told = |event: &Event| matches!(event, Event::Safety(Safety::Forbidden { .. }));
    rig.until_event(30, is_told).await;
    rig.seconds(5.0).await;
    let azimuth_deg = rig.axes_deg()[0].unwrap();
    // Judged by the axis reading, Azel would stop the rotator 5 degrees later.
    assert!((91.0..96.0).contains(&azimuth_deg), "{azimuth_deg}");
}

#[tokio::test(start_paused = true)]
async fn an_azimuth_inside_a_keep_out_is_jogged_out() {
    let mut rig = Rig::connected(&two_azimuths(), Rotators::First).await;
    rig.handle().keep_within(before_a_high_mast(80.0, 130.0));
    rig.send(Command::Manual);
    rig.until("inside", 5, |shown| shown.breach.is_some()).await;
    rig.send(Command::AllowWayOut);
    rig.seconds(0.1).await;
    rig.hold([4.0, 0.0], 0.5).await;
    rig.send(Command::EndJog);
    rig.seconds(3.0).await;
    assert_eq!(rig.axes_deg()[0], Some(90.0), "deeper");
    for _ in 0..20 {
        rig.hold([-1.0, 0.0], 1.0).await;
        rig.send(Command::EndJog);
        rig.seconds(1.0).await;
    }
    assert!(rig.axes_deg()[0].unwrap() < 80.0);
    assert_eq!(rig.shown().breach, None);
}

#[tokio::test(start_paused = true)]
async fn a_rotator_that_may_turn_over_north_is_judged_both_ways_round() {
    let (north, south) = ((358.0, 362.0), (200.0, 210.0));
    // Each case has limits on one way round or on both. An axis beyond a limit goes back across it.
    for (limits, (at, target_deg), mast, is_refused) in [
        ([190, 170], (320, 40.0), north, true),
        ([190, 170], (320, 40.0), south, false),
        ([350, 170], (320, 40.0), north, true),
        ([350, 170], (320, 40.0), south, true),
        ([210, 190], (195, 170.0), (178.0, 182.0), true),
        ([90, 270], (275, 90.0), (178.0, 182.0), true),
    ] {
        let mut rotators = [azimuth("Mast", at), azimuth("Tower", 300)];
        let [ccw, cw] = limits.map(|degrees| WholeDegrees::new(degrees).unwrap());
        (rotators[0].limit_ccw, rotators[0].limit_cw) = (ccw, cw);
        let mut rig = Rig::connected(&Options { rotators, ..pair() }, Rotators::First).await;
        rig.handle().keep_within(before_a_mast(mast.0, mast.1));
        rig.seconds(1.0).await;
        rig.send(to(Some(target_deg), None));
        rig.seconds(0.5).await;
        let events = rig.events();
        let forbidden = matches!(events[..], [Event::NotSent(Refusal::Forbidden { .. })]);
        assert_eq!(forbidden, is_refused, "{limits:?} {mast:?}: {events:?}");
        assert_eq!(rig.orders().is_empty(), is_refused, "{limits:?} {mast:?}");
    }
}
