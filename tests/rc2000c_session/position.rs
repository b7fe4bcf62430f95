//! Directions, which need the calibration of both axes.

use azel::{
    astro::{Angle, AzEl},
    contract::driver::{Command, Event, Intent, Refusal, Way},
    device::{Motion, MotionRequest, panel::CheckState},
    plan::Bounds,
    sim::rc2000c::{Fault, Options, Quirk},
    station::Station,
};

use super::rig::{Rig, antenna, check, uncalibrated};

fn to(az_deg: f64, el_deg: f64) -> Command {
    let angle = |degrees| Some(Angle::from_degrees(degrees));
    Command::Position { azimuth: angle(az_deg), elevation: angle(el_deg) }
}

async fn in_position() -> Rig {
    let mut rig = Rig::connected(&Options::default(), &antenna()).await;
    rig.send(Command::Hold);
    rig.seconds(0.1).await;
    rig
}

#[tokio::test(start_paused = true)]
async fn a_direction_goes_out_as_counts_once_and_arrives() {
    let mut rig = in_position().await;
    rig.send(to(170.0, 40.0));
    rig.seconds(1.0).await;
    let frames = rig.control.received();
    let moves: Vec<_> = frames.iter().filter(|(_, frame)| frame.code() == b'2').collect();
    assert_eq!(moves.len(), 1);
    assert_eq!(moves[0].1.to_bytes(), b"\x02\x32\x32 0163000830\x03\x2e");
    assert!(rig.shown().state.measured.unwrap().moving());
    assert!(rig.shown().pending);
    rig.until_event(20, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.counts(), [1630, 830]);
    assert_eq!(rig.orders().len(), 1, "it is sent once");
    let direction = rig.shown().state.measured.unwrap().direction().unwrap();
    assert!((direction.azimuth_deg() - 170.0).abs() < 1e-6);
    assert_eq!(rig.shown().intent, Intent::Position);
}

#[tokio::test(start_paused = true)]
async fn an_axis_that_stays_is_told_its_present_counts() {
    let mut rig = in_position().await;
    rig.send(Command::Position { azimuth: None, elevation: Some(Angle::from_degrees(40.0)) });
    rig.until_event(20, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["2 0152500830"]);
}

/// Moves the azimuth to an end of its travel, where the unit reports no counts for it.
async fn go_to_the_limit(rig: &mut Rig) {
    rig.send(to(90.0, 40.0));
    rig.until("the limit", 60, |shown| {
        shown.state.measured.is_some_and(|it| it.axes[0].minus_limit && !it.moving())
    })
    .await;
    let told = rig.until_event(6, |event| !matches!(event, Event::Safety(_))).await;
    assert!(matches!(told, Event::Arrived(_)), "{told:?}");
    rig.events();
}

#[tokio::test(start_paused = true)]
async fn an_axis_at_its_limit_stays_there_while_the_other_one_turns() {
    let mut rig = in_position().await;
    go_to_the_limit(&mut rig).await;
    rig.send(Command::Position { azimuth: None, elevation: Some(Angle::from_degrees(50.0)) });
    rig.seconds(20.0).await;
    assert_eq!(rig.orders().last().map(String::as_str), Some("2 0003001030"));
    let events = rig.events();
    assert!(matches!(events[..], [Event::Arrived(_)]), "{events:?}");
}

#[tokio::test(start_paused = true)]
async fn a_way_from_a_limit_down_to_the_minimum_elevation_is_not_stopped() {
    let mut low = antenna();
    low.limits.minimum_elevation_deg = 10.0;
    let mut rig = Rig::connected(&Options::default(), &low).await;
    go_to_the_limit(&mut rig).await;
    rig.send(to(200.0, 10.0));
    let told = rig.until_event(80, |event| !matches!(event, Event::EndedShort { .. })).await;
    assert!(matches!(told, Event::Arrived(_)), "{told:?}");
}

#[tokio::test(start_paused = true)]
async fn without_a_calibration_or_known_counts_nothing_is_sent() {
    let mut rig = Rig::connected(&Options::default(), &uncalibrated()).await;
    rig.send(Command::Hold);
    rig.send(to(170.0, 40.0));
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(MotionRequest::Motion(Motion::Position { .. }), reason) = event else {
        panic!("{event:?}")
    };
    assert_eq!(reason, "the azimuth is not calibrated");
    assert!(rig.times("2").is_empty());

    let mut rig = in_position().await;
    rig.control.set_quirk(Quirk::AngleDisplay, true);
    rig.seconds(1.0).await;
    rig.send(Command::Position { azimuth: None, elevation: Some(Angle::from_degrees(40.0)) });
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(_, reason) = event else { panic!("{event:?}") };
    assert_eq!(reason, "the azimuth is to stay, but its counts are not known");
    assert!(rig.times("2").is_empty());
}

#[tokio::test(start_paused = true)]
async fn with_an_angle_display_a_whole_direction_still_goes_out_as_counts() {
    let mut rig = in_position().await;
    rig.control.set_quirk(Quirk::AngleDisplay, true);
    rig.seconds(1.0).await;
    rig.send(to(170.0, 40.0));
    rig.until_event(20, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.times("2 0163000830").len(), 1);
}

#[tokio::test(start_paused = true)]
async fn what_the_mount_does_not_reach_stays_here() {
    let mut rig = in_position().await;
    rig.send(to(280.0, 40.0));
    rig.seconds(0.5).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Travel { axis: "Az", .. })]));
    assert!(rig.orders().is_empty());
}

#[tokio::test(start_paused = true)]
async fn a_refusal_ends_the_intent_with_the_likely_reason() {
    let mut rig = in_position().await;
    rig.control.set_fault(Fault::Refuse, true);
    rig.send(to(170.0, 40.0));
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(MotionRequest::Motion(Motion::Position { .. }), reason) = event else {
        panic!("{event:?}")
    };
    assert_eq!(reason, "the position lies beyond a limit of the unit");
    assert_eq!(rig.shown().intent, Intent::Standby);
    assert_eq!(rig.times("2").len(), 1);
}

#[tokio::test(start_paused = true)]
async fn a_lost_reply_is_not_followed_by_the_command_again() {
    let mut rig = in_position().await;
    rig.control.set_fault(Fault::Silence, true);
    rig.send(to(170.0, 40.0));
    rig.seconds(0.3).await;
    rig.control.set_fault(Fault::Silence, false);
    rig.until_event(20, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["2 0163000830"], "the state has told that it came through");
}

#[tokio::test(start_paused = true)]
async fn a_remote_mode_that_is_disabled_on_the_way_is_told() {
    let mut rig = in_position().await;
    rig.control.set_fault(Fault::RemoteDisabled, true);
    rig.send(to(170.0, 40.0));
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(_, reason) = event else { panic!("{event:?}") };
    assert_eq!(reason, "remote mode is disabled on the unit");
    assert_eq!(check(&rig.shown(), "Remote mode"), Some(CheckState::Fault));
}

#[tokio::test(start_paused = true)]
async fn a_new_direction_stops_the_way_to_the_old_one() {
    let mut rig = in_position().await;
    rig.send(to(200.0, 40.0));
    rig.seconds(2.0).await;
    rig.send(to(160.0, 40.0));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    let orders = rig.orders();
    assert_eq!(orders.first().unwrap(), "2 0223000830");
    assert_eq!(orders.last().unwrap(), "2 0143000830");
    assert!(orders[1..orders.len() - 1].iter().all(|text| text == "3XS0000"), "{orders:?}");
    assert!(orders.len() > 2);
}

/// Previews a direction and returns the way to it, or the refusal.
async fn looked_at(rig: &mut Rig, az_deg: f64, el_deg: f64) -> Result<Way, Refusal> {
    let to = AzEl::from_degrees(az_deg, el_deg).into();
    rig.send(Command::Preview(Some(to)));
    rig.seconds(0.1).await;
    let preview = rig.shown().preview.clone().expect("it was judged");
    assert_eq!(preview.target, to);
    preview.way.clone()
}

#[tokio::test(start_paused = true)]
async fn a_direction_that_is_only_looked_at_is_judged_like_a_motion_and_moves_nothing() {
    let mut rig = in_position().await;
    // Azel judges a direction in Standby too.
    rig.send(Command::Standby);
    let from = rig.shown().state.measured.unwrap().direction().unwrap();
    let way = looked_at(&mut rig, 180.0, 40.0).await.unwrap();
    let rate_deg_s = antenna().limits.maximum_rate_deg_s;
    let turn_deg = (180.0 - from.azimuth_deg()).abs().max((40.0 - from.elevation_deg()).abs());
    assert!((way.arrives_s.unwrap() - turn_deg / rate_deg_s).abs() < 0.1, "{way:?}");
    assert!(way.path[0].separation(from).degrees() < 1e-6);
    assert!(way.path.last().unwrap().separation(AzEl::from_degrees(180.0, 40.0)).degrees() < 0.1);
    assert!(!way.is_round_a_corner);

    let beyond = looked_at(&mut rig, 20.0, 40.0).await;
    assert!(matches!(beyond, Err(Refusal::Travel { .. })), "{beyond:?}");

    // Azel refuses a direction inside the mast; the way to one beyond leads over the mast.
    let corners_deg = [(140.0, -5.0), (150.0, -5.0), (150.0, 60.0), (140.0, 60.0)];
    let mast = crate::common::mast(&corners_deg);
    let station = Station { keep_outs: vec![mast], ..Station::default() };
    rig.handle().keep_within(Bounds::new(&station, &antenna()));
    let forbidden = looked_at(&mut rig, 145.0, 20.0).await;
    assert!(matches!(forbidden, Err(Refusal::Forbidden { .. })), "{forbidden:?}");
    let over = looked_at(&mut rig, 120.0, 75.0).await.unwrap();
    assert!(over.is_round_a_corner, "{over:?}");

    rig.seconds(5.0).await;
    assert!(rig.orders().is_empty(), "nothing was sent");
    assert_eq!((rig.events(), rig.shown().intent), (vec![], Intent::Standby));
    rig.send(Command::Preview(None));
    rig.seconds(0.1).await;
    assert_eq!(rig.shown().preview, None);
}

#[tokio::test(start_paused = true)]
async fn an_axis_that_turns_beside_one_at_its_limit_is_found_as_left() {
    let mut rig = in_position().await;
    go_to_the_limit(&mut rig).await;
    rig.send(Command::Position { azimuth: None, elevation: Some(Angle::from_degrees(80.0)) });
    rig.until("it moves", 5, |shown| shown.state.measured.unwrap().moving()).await;
    rig.set_off(true);
    rig.seconds(4.0).await;
    rig.events();
    rig.set_off(false);
    let is_back = |event: &Event| matches!(event, Event::Back { .. });
    let back = rig.until_event(30, is_back).await;
    assert!(matches!(back, Event::Back { is_explained: true, .. }), "{back:?}");
}

#[tokio::test(start_paused = true)]
async fn after_a_lost_link_a_way_ends_at_its_corner() {
    let mut rig = in_position().await;
    let corners_deg = [(190.0, -5.0), (200.0, -5.0), (200.0, 60.0), (190.0, 60.0)];
    let station =
        Station { keep_outs: vec![crate::common::mast(&corners_deg)], ..Station::default() };
    rig.handle().keep_within(Bounds::new(&station, &antenna()));
    rig.send(to(220.0, 75.0));
    rig.until("it moves", 5, |shown| shown.state.measured.unwrap().moving()).await;
    let sent = rig.orders();
    rig.set_off(true);
    rig.seconds(60.0).await;
    assert!(rig.shown().state.measured.is_some_and(|it| it.moving()), "nothing has been read");
    rig.events();
    rig.set_off(false);
    // The antenna stands where Azel sent it.
    rig.until_event(30, |event| matches!(event, Event::Back { is_explained: true, .. })).await;
    let is_short = |event: &Event| matches!(event, Event::EndedShort { .. });
    let short = rig.until_event(60, is_short).await;
    rig.seconds(60.0).await;
    assert_eq!(rig.orders(), sent, "the next leg needs the operator");
    let Event::EndedShort { aim, position: at } = short else { unreachable!() };
    assert!(aim.separation(AzEl::from_degrees(220.0, 75.0).into()).unwrap().degrees() < 0.1);
    assert!(at.separation(aim).unwrap().degrees() > 10.0, "{at:?}");
}
