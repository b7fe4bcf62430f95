//! A Rotator Genius: whole degrees, one speed, and coasting.

use azel::{
    astro::{AzEl, time::add_seconds},
    contract::driver::{Command, Event, Intent, Safety},
    controller::rotator_genius::{ROTATORS, Rotators},
    plan::{ProgramTrack, Target, TrackPhase, TrackStats},
    protocol::rotator_genius::{Moving, RotatorNumber, WholeDegrees},
    sim::rotator_genius::{Control, Fault, Options, RotatorOptions},
    station::{Antenna, Mount},
};

use super::{
    rig::{self, figures},
    sky::{self, Scene},
};

type Rig = rig::Rig<Control>;

/// Lead before AOS, seconds, in which the antenna reaches the start of the pass.
const LEAD_S: f64 = 180.0;

/// Returns an antenna as fast as the simulated rotators.
pub(super) fn antenna(rotators: Rotators) -> Antenna {
    let mut antenna = Antenna::genius("Mast", "in memory");
    antenna.connection.put(&ROTATORS, rotators).unwrap();
    antenna.limits.maximum_rate_deg_s = 4.0;
    antenna.mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 360.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    antenna
}

/// Returns a pair on a mount that flips over the zenith.
fn over() -> Antenna {
    let mut antenna = antenna(Rotators::Pair);
    if let Mount::AzEl { elevation_to_deg, .. } = &mut antenna.mount {
        *elevation_to_deg = 180.0;
    }
    antenna
}

pub(super) fn options(stop_offset_deg: u8) -> Options {
    let limit_cw = WholeDegrees::MAX;
    let azimuth = RotatorOptions { stop_offset_deg, limit_cw, ..RotatorOptions::default() };
    let elevation = RotatorOptions { stop_offset_deg, ..RotatorOptions::elevation() };
    Options { rotators: [azimuth, elevation], ..Options::default() }
}

pub(super) async fn connected(
    options: &Options,
    antenna: &Antenna,
    scene: &Scene,
) -> (Rig, Control) {
    let utc_origin = add_seconds(scene.pass.aos.time, -LEAD_S);
    let control = Control::new(options);
    let mut rig =
        Rig::new(control.clone(), utc_origin, |dial, clock| rig::session(antenna, dial, clock))
            .looking_every(rig::LOOK);
    rig.until("it is read", 5, |shown| shown.state.measured.is_some()).await;
    rig.seconds(1.0).await;
    rig.events();
    (rig, control)
}

async fn followed(stop_offset_deg: u8, scene: &Scene) -> TrackStats {
    followed_by(&options(stop_offset_deg), &antenna(Rotators::Pair), scene).await
}

/// Tracks with a unit whose elevation goes to `to_deg`, on a mount that flips.
async fn followed_over(to_deg: u16, scene: &Scene) -> TrackStats {
    let mut options = options(2);
    options.rotators[1].limit_cw = WholeDegrees::saturating(to_deg);
    followed_by(&options, &over(), scene).await
}

async fn followed_by(options: &Options, antenna: &Antenna, scene: &Scene) -> TrackStats {
    let (mut rig, _) = connected(options, antenna, scene).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    let stats = rig.until_over().await;
    let others = rig.events();
    let is_good = |event: &Event| matches!(event, Event::Awaits { .. } | Event::ProgramTracks(_));
    assert!(others.iter().all(is_good), "{others:?}");
    stats
}

#[tokio::test(start_paused = true)]
async fn a_usual_pass_is_followed_to_the_degree() {
    for stop_offset_deg in [1, 2] {
        let what = format!("Genius, usual, stop offset {stop_offset_deg}");
        let (rms, worst) = figures(&what, followed(stop_offset_deg, &sky::usual()).await);
        assert!(rms < 1.0 && worst < 3.5, "{rms} {worst}");
    }
}

/// Tracks the scene. Returns how often each motor reversed, and the number of positions sent.
async fn reversals(stop_offset_deg: u8, scene: &Scene) -> ([u32; 2], u32) {
    let antenna = antenna(Rotators::Pair);
    let (mut rig, control) = connected(&options(stop_offset_deg), &antenna, scene).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.until_utc(scene.pass.aos.time).await;
    let mut reversals = [0; 2];
    let mut before = [Moving::Stopped; 2];
    while rig.clock.utc() < scene.pass.los.time {
        rig.seconds(0.1).await;
        let now = RotatorNumber::ALL.map(|number| control.state().rotator(number).moving);
        for ((count, before), now) in reversals.iter_mut().zip(&mut before).zip(now) {
            *count += u32::from(*before != Moving::Stopped && now == opposite(*before));
            *before = if now == Moving::Stopped { *before } else { now };
        }
    }
    (reversals, rig.until_over().await.commands)
}

fn opposite(moving: Moving) -> Moving {
    match moving {
        Moving::Stopped => Moving::Stopped,
        Moving::Clockwise => Moving::CounterClockwise,
        Moving::CounterClockwise => Moving::Clockwise,
    }
}

/// Reversals wear the motors, and commands wear the relays of their drives.
#[tokio::test(start_paused = true)]
async fn a_motor_reverses_only_where_the_path_turns() {
    for stop_offset_deg in [1, 2] {
        let (count, commands) = reversals(stop_offset_deg, &sky::usual()).await;
        // The elevation turns once, at TCA.
        assert_eq!(count, [0, 1], "{stop_offset_deg}");
        assert!(commands < 180, "{commands}");
    }
}

#[tokio::test(start_paused = true)]
async fn through_north_it_goes_round_once() {
    let (_, worst) =
        figures("Genius, through north, 0 to 360", followed(2, &sky::through_north()).await);
    assert!(worst > 45.0);
}

#[tokio::test(start_paused = true)]
async fn close_to_the_zenith_it_slews_in_time() {
    let (rms, worst) = figures("Genius, 88 degrees", followed(2, &sky::overhead()).await);
    assert!(rms < 2.0 && worst < 8.0, "{rms} {worst}");
}

/// Returns the azimuths of all go-to commands, degrees.
fn azimuths(control: &Control) -> Vec<u16> {
    let received = control.received();
    let of = |command: &str| command.strip_prefix("|A1").and_then(|degrees| degrees.parse().ok());
    received.iter().filter_map(|(_, command)| of(command)).collect()
}

#[tokio::test(start_paused = true)]
async fn a_target_at_north_keeps_away_from_the_end_of_the_travel() {
    let scene = sky::usual();
    let target = Target::Fixed(AzEl::from_degrees(359.8, 40.0));
    let follow = ProgramTrack { target, passes: Vec::new(), ..scene.follow() };
    for highest_deg in [360, 359] {
        let mut options = options(1);
        options.rotators[0].limit_cw = WholeDegrees::saturating(highest_deg);
        let (mut rig, control) = connected(&options, &antenna(Rotators::Pair), &scene).await;
        rig.send(Command::ProgramTrack(Box::new(follow.clone())));
        rig.seconds(120.0).await;
        let sent = azimuths(&control);
        assert!(!sent.is_empty() && sent.iter().all(|deg| *deg == 357), "{sent:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn over_the_zenith_it_need_not_go_round() {
    let stats = followed_over(180, &sky::through_north()).await;
    let (rms, worst) = figures("Genius, through north, 0 to 360 and 180", stats);
    assert!(rms < 1.2 && worst < 4.0, "{rms} {worst}");
}

#[tokio::test(start_paused = true)]
async fn over_the_zenith_the_sky_shows_where_it_points() {
    let scene = sky::through_north();
    let mut options = options(2);
    options.rotators[1].limit_cw = WholeDegrees::saturating(180);
    let (mut rig, _) = connected(&options, &over(), &scene).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.until_utc(scene.pass.tca.time).await;
    let shown = rig.shown();
    let view = shown.program_track.clone().unwrap();
    let measured = shown.state.measured.unwrap();
    assert!(measured.axes[1].angle_deg.unwrap() > 90.0);
    let predicted = view.predicted.unwrap().direction;
    for at in [measured.direction(), view.commanded.unwrap().direction()] {
        let off = at.unwrap().separation(predicted).degrees();
        assert!(off < 4.0 && at.unwrap().elevation_deg() < 90.0, "{at:?} {predicted:?}");
    }
    // A position command brings the antenna back.
    let (azimuth, elevation) = (Some(predicted.azimuth), Some(predicted.elevation));
    rig.send(Command::Position { azimuth, elevation });
    rig.until_event(120, |event| matches!(event, Event::Arrived(_))).await;
    let measured = rig.shown().state.measured.unwrap();
    assert!(measured.axes[1].angle_deg.unwrap() < 90.0);
    assert!(measured.direction().unwrap().separation(predicted).degrees() < 1.5);
}

#[tokio::test(start_paused = true)]
async fn over_the_zenith_it_hardly_slews() {
    let stats = followed_over(180, &sky::overhead()).await;
    let (rms, worst) = figures("Genius, 88 degrees, elevation to 180", stats);
    assert!(rms < 2.0 && worst < 9.0, "{rms} {worst}");
}

#[tokio::test(start_paused = true)]
async fn it_is_not_sent_where_the_device_does_not_go() {
    let stats = followed_over(90, &sky::through_north()).await;
    let (_, worst) = figures("Genius, through north, device to 90", stats);
    assert!(worst > 45.0);
}

#[tokio::test(start_paused = true)]
async fn a_rotator_alone_follows_in_azimuth() {
    let scene = sky::usual();
    let (mut rig, control) = connected(&options(2), &antenna(Rotators::First), &scene).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    let stats = rig.until_over().await;
    let (rms, _) = figures("Genius, azimuth alone", stats);
    assert!(rms < 1.3, "{rms}");
    let elevation_deg = control.state().rotators[1].angle_deg;
    assert!(elevation_deg.abs() < 1e-9, "{elevation_deg}");
}

#[tokio::test(start_paused = true)]
async fn a_refusal_of_the_device_ends_it_with_its_reason() {
    let scene = sky::usual();
    let mut options = options(2);
    // The limits of the unit exclude the pass.
    options.rotators[0].position = WholeDegrees::saturating(10);
    options.rotators[0].limit_cw = WholeDegrees::saturating(12);
    options.rotators[0].limit_ccw = WholeDegrees::saturating(8);
    let (mut rig, _) = connected(&options, &antenna(Rotators::Pair), &scene).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.until_event(5, |event| matches!(event, Event::Refused(..))).await;
    rig.seconds(1.0).await;
    assert_eq!((rig.phase(), rig.shown().intent), (None, Intent::Standby));
}

#[tokio::test(start_paused = true)]
async fn a_rotator_that_takes_the_commands_and_does_nothing_is_stopped() {
    let scene = sky::usual();
    let (mut rig, control) = connected(&options(1), &antenna(Rotators::Pair), &scene).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.until("up", 1000, |shown| {
        shown.program_track.as_ref().is_some_and(|track| track.phase == TrackPhase::Tracking)
    })
    .await;
    rig.events();
    control.set_fault(Fault::Stuck(RotatorNumber::One), true);
    control.set_fault(Fault::Stuck(RotatorNumber::Two), true);
    let before = control.received().len();
    let names_axis = |event: &Event| {
        matches!(event, Event::Safety(Safety::NoEffect { axis: Some("Az" | "El") }))
    };
    rig.until_event(400, names_axis).await;
    assert_eq!(rig.shown().intent, Intent::Standby);
    rig.seconds(0.1).await;
    let received = control.received().split_off(before);
    assert!(received.iter().any(|(_, command)| command == "|S"), "{received:?}");
}

#[tokio::test(start_paused = true)]
async fn a_rotator_that_loses_its_sensor_ends_the_track() {
    for number in [RotatorNumber::One, RotatorNumber::Two] {
        let scene = sky::usual();
        let (mut rig, control) = connected(&options(2), &antenna(Rotators::Pair), &scene).await;
        rig.send(Command::ProgramTrack(Box::new(scene.follow())));
        rig.until("up", 1000, |shown| {
            shown.program_track.as_ref().is_some_and(|track| track.phase == TrackPhase::Tracking)
        })
        .await;
        control.set_fault(Fault::NoSensor(number), true);
        rig.seconds(12.0).await;
        assert_eq!((rig.phase(), rig.shown().intent), (None, Intent::Standby), "{number:?}");
    }
}
