//! An antenna in a forbidden direction: inside a keep-out, or too close to the Sun.

use azel::{
    astro::{AzEl, sun_moon},
    contract::driver::{Breach, Command, Event, Refusal, Safety, TrackProblem},
    plan::{Barrier, Bounds, ProgramTrack, Target},
    sim::satrak::Options,
    station::{Station, SunAvoidance, Unread},
};
use jiff::Timestamp;

use super::{
    rig::{Rig, antenna},
    scene::site,
};

/// Max rate on the way out, degrees a second: a quarter of the fastest rate.
const SLOW_DEG_S: f64 = 0.7;
const SUN: SunAvoidance = SunAvoidance { radius_deg: 5.0, ahead_min: 10.0 };

/// Returns a time late in a summer morning.
fn morning() -> Timestamp {
    "2026-08-12T07:30:00Z".parse().unwrap()
}

fn direction(rig: &Rig) -> AzEl {
    rig.shown().state.measured.unwrap().direction().unwrap()
}

fn within(station: &Station) -> Bounds {
    Bounds::new(station, &antenna())
}

/// Returns a station with a mast in the antenna's direction, 10 degrees wide and high.
fn masted(at: AzEl) -> Station {
    let (az, el) = (at.azimuth_deg(), at.elevation_deg());
    let wide = 5.0 / at.elevation.radians().cos();
    let corners = [
        (az - wide, el - 5.0),
        (az - wide, el + 5.0),
        (az + wide, el + 5.0),
        (az + wide, el - 5.0),
    ];
    let mast = crate::common::mast(&corners);
    Station { keep_outs: vec![mast], site: site(), ..Station::default() }
}

fn sunny() -> Station {
    Station { sun_avoidance: Some(SUN), site: site(), ..Station::default() }
}

fn go_to(at: AzEl) -> Command {
    Command::Position { azimuth: Some(at.azimuth), elevation: Some(at.elevation) }
}

fn mast(may_leave: bool) -> Breach {
    Breach { barrier: Barrier::KeepOut("mast".into()), unknown_axis: None, may_leave }
}

/// Starts an antenna in Manual, in the middle of a mast that was just drawn.
async fn in_a_mast() -> Rig {
    let mut rig = Rig::connected(&Options::new(site(), morning()), &antenna()).await;
    rig.send(go_to(AzEl::from_degrees(200.0, 45.0)));
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    rig.send(Command::Manual);
    rig.handle().keep_within(within(&masted(direction(&rig))));
    rig.until("inside", 5, |shown| shown.breach == Some(mast(false))).await;
    rig.events();
    rig
}

/// Holds and releases each of the four keys in turn; returns the refusals.
async fn try_all_keys(rig: &mut Rig, rate_deg_s: f64) -> Vec<Refusal> {
    for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let mut rates_deg_s = [0.0; 2];
        rates_deg_s[axis] = sign * rate_deg_s;
        rig.hold(rates_deg_s, 0.4).await;
        rig.send(Command::EndJog);
        rig.seconds(3.0).await;
    }
    let refused = |event| match event {
        Event::NotSent(refusal) => Some(refusal),
        _ => None,
    };
    rig.events().into_iter().filter_map(refused).collect()
}

#[tokio::test(start_paused = true)]
async fn out_of_a_keep_out_it_goes_by_hand_slowly_and_by_the_operators_word_alone() {
    let mut rig = in_a_mast().await;
    let refused = try_all_keys(&mut rig, SLOW_DEG_S).await;
    assert_eq!(refused.len(), 4, "{refused:?}");
    let inside = Refusal::Inside(Barrier::KeepOut("mast".into()));
    assert!(refused.contains(&inside), "{refused:?}");
    assert_eq!(rig.sent("MOVE="), Vec::<String>::new());

    rig.send(Command::AllowWayOut);
    rig.until("allowed", 2, |shown| shown.breach == Some(mast(true))).await;
    let refused = try_all_keys(&mut rig, 3.0).await;
    assert!(refused.iter().any(|why| matches!(why, Refusal::TooFast { .. })), "{refused:?}");
    assert_eq!(rig.sent("MOVE="), Vec::<String>::new(), "slowly");
    rig.send(go_to(AzEl::from_degrees(200.0, 80.0)));
    rig.seconds(1.0).await;
    let fixed = Target::Fixed(AzEl::from_degrees(200.0, 80.0));
    let follow = ProgramTrack::new(fixed, site(), Vec::new());
    rig.send(Command::ProgramTrack(Box::new(follow)));
    rig.until_event(2, |event| matches!(event, Event::CannotProgramTrack(..))).await;
    rig.seconds(1.0).await;
    assert_eq!(rig.sent("GOTO=").len(), 1, "by hand");

    rig.send(Command::Manual);
    rig.seconds(3.0).await;
    rig.events();
    let refused = try_all_keys(&mut rig, SLOW_DEG_S).await;
    assert!(!rig.sent("MOVE=").is_empty() && refused.len() < 4, "{refused:?}");
}

#[tokio::test(start_paused = true)]
async fn the_word_for_the_way_out_ends_after_a_minute_and_outside() {
    let mut rig = in_a_mast().await;
    rig.send(Command::AllowWayOut);
    rig.until("allowed", 2, |shown| shown.breach == Some(mast(true))).await;
    rig.seconds(61.0).await;
    assert_eq!(rig.shown().breach, Some(mast(false)));
    let refused = try_all_keys(&mut rig, SLOW_DEG_S).await;
    assert_eq!(refused.len(), 4, "{refused:?}");

    rig.send(Command::AllowWayOut);
    rig.handle().keep_within(within(&Station::default()));
    rig.until("outside", 5, |shown| shown.breach.is_none()).await;
    rig.handle().keep_within(within(&masted(direction(&rig))));
    rig.until("inside again", 5, |shown| shown.breach.is_some()).await;
    assert_eq!(rig.shown().breach, Some(mast(false)), "it may leave, not enter again");
}

/// Starts a unit that points at the Sun, and then adds the rule to avoid the Sun.
async fn in_the_way_of_the_sun() -> Rig {
    let mut rig = Rig::connected(&Options::new(site(), morning()), &antenna()).await;
    rig.send(go_to(sun_moon::sun(site(), morning())));
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    rig.handle().keep_within(within(&sunny()));
    rig.until("inside", 5, |shown| shown.breach.is_some()).await;
    rig
}

#[tokio::test(start_paused = true)]
async fn an_antenna_that_the_sun_comes_to_is_moved_away_in_one_step_and_never_by_itself() {
    let mut rig = in_the_way_of_the_sun().await;
    let told = |event: &Event| {
        matches!(event, Event::Safety(Safety::Forbidden { barrier: Barrier::Sun, .. }))
    };
    rig.until_event(5, told).await;
    rig.seconds(120.0).await;
    assert_eq!(rig.sent("GOTO=").len(), 1, "never by itself");

    let before = direction(&rig);
    rig.send(Command::MoveAway);
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.sent("GOTO=").len(), 2);
    let way = before.separation(direction(&rig)).degrees();
    assert!((0.5..2.0 * SUN.radius_deg + 1.0).contains(&way), "{way}");
    rig.until("outside", 5, |shown| shown.breach.is_none()).await;
    rig.events();
    // The direction stays clear for the time ahead.
    rig.seconds(SUN.ahead_min * 60.0 - 30.0).await;
    assert_eq!((rig.shown().breach.clone(), rig.events()), (None, Vec::new()));
}

#[tokio::test(start_paused = true)]
async fn the_park_position_is_taken_where_it_is_nearer() {
    let mut dish = antenna();
    let sun = sun_moon::sun(site(), morning());
    let beside = sun.displaced(270.0, 5.3);
    dish.park.azimuth_deg = beside.azimuth_deg();
    dish.park.elevation_deg = beside.elevation_deg();
    let mut rig = Rig::connected(&Options::new(site(), morning()), &dish).await;
    rig.send(go_to(sun.displaced(270.0, 1.0)));
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    rig.handle().keep_within(within(&sunny()));
    rig.until("inside", 5, |shown| shown.breach.is_some()).await;
    rig.send(Command::MoveAway);
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.shown().intent, azel::contract::driver::Intent::Park);
}

#[tokio::test(start_paused = true)]
async fn the_sun_is_followed_by_the_operators_word_and_the_avoidance_lifted_for_that_alone() {
    let mut rig = Rig::connected(&Options::new(site(), morning()), &antenna()).await;
    rig.handle().keep_within(within(&sunny()));
    let follow = || ProgramTrack::new(Target::Sun, site(), Vec::new());
    rig.send(Command::ProgramTrack(Box::new(follow())));
    let refused = rig.until_event(5, |event| matches!(event, Event::CannotProgramTrack(..))).await;
    let Event::CannotProgramTrack(_, TrackProblem::Refused(Refusal::Forbidden { barrier, .. })) =
        refused
    else {
        panic!("{refused:?}")
    };
    assert_eq!((barrier, rig.shown().sun_lifted), (Barrier::Sun, false));

    rig.send(Command::ProgramTrackIntoSun(Box::new(follow())));
    rig.until("lifted", 5, |shown| shown.sun_lifted).await;
    rig.seconds(90.0).await;
    let shown = rig.shown();
    let predicted = shown.program_track.as_ref().unwrap().predicted.unwrap().direction;
    assert!(direction(&rig).separation(predicted).degrees() < 0.5, "{predicted:?}");
    assert_eq!((shown.breach.clone(), shown.sun_lifted), (None, true));
    let alarms = rig.events().into_iter().filter(|event| matches!(event, Event::Safety(_)));
    assert_eq!(alarms.collect::<Vec<_>>(), Vec::<Event>::new());

    rig.stop();
    rig.until("inside", 10, |shown| shown.breach.is_some() && !shown.sun_lifted).await;
    rig.send(Command::ProgramTrack(Box::new(follow())));
    rig.until_event(5, |event| matches!(event, Event::CannotProgramTrack(..))).await;
}

#[tokio::test(start_paused = true)]
async fn while_a_keep_out_is_unread_it_moves_slowly_by_hand_and_by_a_hold_alone() {
    let mut rig = Rig::connected(&Options::new(site(), morning()), &antenna()).await;
    let unread = vec![Unread { place: "keep_out[0]".to_owned(), antenna: None }];
    rig.handle().keep_within(within(&Station { unread, ..sunny() }));
    rig.seconds(1.0).await;
    let place = "keep_out[0]".into();
    let refused = Refusal::SettingsUnread { place };
    rig.send(go_to(AzEl::from_degrees(200.0, 45.0)));
    rig.send(Command::Park);
    rig.send(Command::AutoTrack(true));
    rig.send(Command::Manual);
    rig.hold([SLOW_DEG_S, 0.0], 0.5).await;
    rig.send(Command::EndJog);
    rig.seconds(1.0).await;
    let not_sent = || Event::NotSent(refused.clone());
    assert_eq!(rig.events(), [not_sent(), not_sent(), not_sent(), not_sent()]);
    let inside = rig.shown().breach.clone().unwrap();
    assert_eq!(inside.barrier, Barrier::Unread("keep_out[0]".into()));
    rig.send(Command::AllowWayOut);
    rig.seconds(0.1).await;
    let before = direction(&rig);
    rig.hold([SLOW_DEG_S, 0.0], 4.0).await;
    assert!(before.separation(direction(&rig)).degrees() > 1.0);
    assert_eq!(rig.events(), []);
}
