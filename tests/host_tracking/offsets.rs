//! Offsets of a program track, changed while it runs.

use azel::{
    astro::{Angle, AzEl, Offset, TrackOffsets, time::add_seconds},
    contract::driver::{Command, Event, Intent, OffsetChange, Refusal},
    controller::rotator_genius::Rotators,
    orbit::Propagator,
    plan::{Barrier, Bounds, ProgramTrack, Target, TrackPhase},
    sim::{Control, Unit},
    station::{Antenna, KeepOut, Station},
};
use jiff::{SignedDuration, Timestamp};

use super::{
    genius, rc2000c,
    rig::Rig,
    satrak,
    sky::{self, Scene},
};

fn deg(degrees: f64) -> Angle {
    Angle::from_degrees(degrees)
}

fn step(step: Offset) -> Command {
    Command::Offset(OffsetChange::Step(step))
}

fn with(steps: &[Offset]) -> TrackOffsets {
    steps.iter().copied().try_fold(TrackOffsets::NONE, TrackOffsets::plus).unwrap()
}

fn target(scene: &Scene, at: Timestamp) -> AzEl {
    Propagator::new(&scene.elements).unwrap().look_from(sky::site(), at).unwrap().direction
}

fn offsets<U: Unit>(rig: &Rig<Control<U>>) -> TrackOffsets {
    rig.shown().program_track.as_ref().unwrap().offsets
}

/// Returns the measured minus the plain direction of the target at the time of the measurement,
/// degrees of azimuth and elevation.
fn beside_deg<U: Unit>(rig: &Rig<Control<U>>, scene: &Scene) -> [f64; 2] {
    let measured = rig.shown().state.measured.unwrap();
    let (at, plain) = (measured.direction().unwrap(), target(scene, measured.time));
    [
        (at.azimuth - plain.azimuth).wrapped_180().degrees(),
        (at.elevation - plain.elevation).degrees(),
    ]
}

/// Tracks the pass of `scene` until a third of it is over.
async fn tracking<U: Unit>(rig: &mut Rig<Control<U>>, scene: &Scene) {
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.until_utc(add_seconds(scene.pass.aos.time, scene.pass.duration_s() / 3.0)).await;
    assert_eq!(rig.phase(), Some(TrackPhase::Tracking));
    rig.events();
}

fn refusals(events: &[Event]) -> Vec<&Refusal> {
    let mut refused = Vec::new();
    for event in events {
        if let Event::NotSent(refusal) | Event::OffsetRefused(refusal) = event {
            refused.push(refusal);
        }
    }
    refused
}

/// Checks that offset steps lead the antenna away, zero leads it back, and undo leads it away
/// again.
async fn leads_away_and_back<U: Unit>(rig: &mut Rig<Control<U>>, scene: &Scene, within_deg: f64) {
    tracking(rig, scene).await;
    let steps = [Offset::Azimuth(deg(4.0)), Offset::Elevation(deg(3.0))];
    for offset in steps {
        rig.send(step(offset));
    }
    rig.seconds(6.0).await;
    let [azimuth, elevation] = beside_deg(rig, scene);
    assert!((azimuth - 4.0).abs() < within_deg, "{azimuth} {elevation}");
    assert!((elevation - 3.0).abs() < within_deg, "{azimuth} {elevation}");
    assert_eq!(offsets(rig), with(&steps));
    // The predicted direction includes the offsets.
    let measured = rig.shown().state.measured.unwrap();
    let predicted = rig.shown().program_track.clone().unwrap().predicted.unwrap();
    let off = measured.direction().unwrap().separation(predicted.direction);
    assert!(off.degrees() < within_deg * 1.5, "{off:?}");

    rig.send(Command::Offset(OffsetChange::Zero));
    rig.seconds(6.0).await;
    let [azimuth, elevation] = beside_deg(rig, scene);
    assert!(azimuth.abs() < within_deg && elevation.abs() < within_deg, "{azimuth} {elevation}");
    assert!(offsets(rig).is_none());

    rig.send(Command::Offset(OffsetChange::Undo));
    rig.send(Command::Offset(OffsetChange::Undo));
    rig.seconds(6.0).await;
    assert_eq!(offsets(rig), with(&steps[..1]));
    assert!(rig.shown().program_track.as_ref().unwrap().can_undo);
    let [azimuth, elevation] = beside_deg(rig, scene);
    assert!((azimuth - 4.0).abs() < within_deg && elevation.abs() < within_deg);
    assert_eq!(rig.events(), []);

    rig.until_over().await;
    assert_eq!(rig.phase(), Some(TrackPhase::Over));
    assert!(offsets(rig).is_none(), "they were for the pass");
}

#[tokio::test(start_paused = true)]
async fn they_lead_an_rc2000c_away_and_back() {
    let scene = sky::usual();
    let mut rig = rc2000c::connected(&rc2000c::antenna(360.0), &scene).await;
    leads_away_and_back(&mut rig, &scene, 0.6).await;
}

#[tokio::test(start_paused = true)]
async fn they_lead_a_genius_away_and_back_by_whole_degrees() {
    let scene = sky::usual();
    let antenna = genius::antenna(Rotators::Pair);
    let (mut rig, _) = genius::connected(&genius::options(1), &antenna, &scene).await;
    leads_away_and_back(&mut rig, &scene, 2.0).await;
}

#[tokio::test(start_paused = true)]
async fn they_lead_a_satrak_in_program_track() {
    let scene = sky::usual();
    let (mut rig, control) = satrak::connected(&satrak::antenna(), &scene, 60.0).await;
    leads_away_and_back(&mut rig, &scene, 0.6).await;
    let settings = |payload: &str| payload.starts_with("SETTINGS=");
    assert!(!control.received().iter().any(|(_, payload)| settings(payload)));
}

#[tokio::test(start_paused = true)]
async fn ahead_in_time_is_where_the_satellite_will_be() {
    let scene = sky::usual();
    let mut rig = rc2000c::connected(&rc2000c::antenna(360.0), &scene).await;
    tracking(&mut rig, &scene).await;
    rig.send(step(Offset::Time(SignedDuration::from_secs(8))));
    rig.seconds(8.0).await;
    let measured = rig.shown().state.measured.unwrap();
    let later = target(&scene, add_seconds(measured.time, 8.0));
    let off = measured.direction().unwrap().separation(later);
    assert!(off.degrees() < 0.6, "{off:?}");
}

/// Returns a mast `away_deg` clockwise of the satellite at a third of the pass.
fn beside_the_pass(scene: &Scene, away_deg: f64) -> KeepOut {
    let third = add_seconds(scene.pass.aos.time, scene.pass.duration_s() / 3.0);
    let at = target(scene, third);
    let clockwise = at.azimuth_deg() + away_deg;
    let (low, high) = (at.elevation_deg() - 4.0, at.elevation_deg() + 4.0);
    let far = clockwise + 8.0;
    crate::common::mast(&[(clockwise, low), (far, low), (far, high), (clockwise, high)])
}

fn keep_out<U: Unit>(rig: &Rig<Control<U>>, antenna: &Antenna, mast: KeepOut) -> Bounds {
    let station = Station { site: sky::site(), keep_outs: vec![mast], ..Station::default() };
    let bounds = Bounds::new(&station, antenna);
    rig.handle().keep_within(bounds.clone());
    bounds
}

#[tokio::test(start_paused = true)]
async fn a_step_into_a_keep_out_is_refused_and_the_old_offsets_stay() {
    let scene = sky::usual();
    let antenna = rc2000c::antenna(360.0);
    let mut rig = rc2000c::connected(&antenna, &scene).await;
    let bounds = keep_out(&rig, &antenna, beside_the_pass(&scene, 6.0));
    tracking(&mut rig, &scene).await;
    rig.send(step(Offset::Azimuth(deg(0.5))));
    rig.seconds(0.5).await;
    rig.send(step(Offset::Azimuth(deg(9.0))));
    rig.seconds(0.5).await;
    let told = rig.events();
    let refused = refusals(&told);
    let mast = Barrier::KeepOut("mast".into());
    assert!(
        matches!(&refused[..], [Refusal::Forbidden { barrier, .. }] if *barrier == mast),
        "{told:?}"
    );
    assert_eq!(offsets(&rig), with(&[Offset::Azimuth(deg(0.5))]));
    while rig.clock.utc() < scene.pass.tca.time {
        rig.seconds(0.5).await;
        let at = rig.shown().state.measured.unwrap().direction().unwrap();
        let clearance = bounds.at_time(rig.clock.utc()).nearest(at).unwrap();
        assert!(clearance.angle.degrees() > -0.1, "{clearance:?}");
    }
}

/// An azimuth offset may lead the axes away from a mast to correct an error of the mount. The
/// antenna then points at the satellite, which is inside the mast.
#[tokio::test(start_paused = true)]
async fn on_the_sky_it_does_not_enter_a_keep_out_that_the_axes_are_led_past() {
    let scene = sky::usual();
    let antenna = rc2000c::antenna(360.0);
    let mut rig = rc2000c::connected(&antenna, &scene).await;
    tracking(&mut rig, &scene).await;
    // Direction of the satellite in 40 s; the axes will be nine degrees beside it.
    let soon = target(&scene, add_seconds(rig.clock.utc(), 40.0));
    let (azimuth, elevation) = (soon.azimuth_deg(), soon.elevation_deg());
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners.map(|(az, el)| (azimuth + az, elevation + el));
    let bounds = keep_out(&rig, &antenna, crate::common::mast(&corners));
    let towards = (soon.azimuth - target(&scene, rig.clock.utc()).azimuth).wrapped_180();
    // The offset keeps the axes behind the satellite, so the satellite enters the keep-out first.
    rig.send(step(Offset::Azimuth(deg(if towards < Angle::ZERO { 9.0 } else { -9.0 }))));
    rig.seconds(5.0).await;
    assert_eq!(refusals(&rig.events()), [] as [&Refusal; 0]);
    let mut least_deg = f64::MAX;
    for _ in 0..60 {
        rig.seconds(1.0).await;
        let [beside, _] = beside_deg(&rig, &scene);
        let is_on_it = (beside.abs() - 9.0).abs() < 1.0;
        let on_sky = target(&scene, rig.clock.utc());
        if is_on_it {
            let clearance = bounds.at_time(rig.clock.utc()).nearest(on_sky).unwrap();
            least_deg = least_deg.min(clearance.angle.degrees());
        }
    }
    assert!(least_deg > -1.0, "it did not follow the satellite through the mast: {least_deg}");
    let told = rig.events();
    let is_mast = |refusal: &&&Refusal| refusal.barrier().is_some();
    assert_eq!(refusals(&told).iter().filter(is_mast).count(), 1, "told once: {told:?}");
}

#[tokio::test(start_paused = true)]
async fn beyond_what_the_axes_reach_a_step_is_refused() {
    let scene = sky::usual();
    let mut antenna = rc2000c::antenna(360.0);
    antenna.limits.minimum_elevation_deg = 5.0;
    let mut rig = rc2000c::connected(&antenna, &scene).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.seconds(5.0).await;
    assert!(matches!(rig.phase(), Some(TrackPhase::Waiting { .. })));
    rig.events();
    // The pass begins below the minimum elevation, and 0.1 s does not change that.
    rig.send(step(Offset::Time(SignedDuration::from_millis(-100))));
    rig.seconds(0.5).await;
    assert_eq!(rig.events(), []);
    rig.send(step(Offset::Elevation(deg(-3.0))));
    rig.seconds(0.5).await;
    let told = rig.events();
    assert!(matches!(&refusals(&told)[..], [Refusal::Elevation { .. }]), "{told:?}");
    for (offset, most) in [
        (Offset::Azimuth(deg(11.0)), Offset::Azimuth(deg(10.0))),
        (
            Offset::Time(SignedDuration::from_secs(999)),
            Offset::Time(SignedDuration::from_secs(300)),
        ),
    ] {
        rig.send(step(offset));
        rig.seconds(0.5).await;
        assert_eq!(refusals(&rig.events()), [&Refusal::OffsetTooLarge { max: most }]);
    }
    assert_eq!(offsets(&rig), with(&[Offset::Time(SignedDuration::from_millis(-100))]));
}

#[tokio::test(start_paused = true)]
async fn outside_its_travel_an_azimuth_is_refused() {
    let scene = sky::usual();
    let antenna = rc2000c::antenna(200.0);
    let mut rig = rc2000c::connected(&antenna, &scene).await;
    let fixed = Target::Fixed(AzEl::from_degrees(196.0, 40.0));
    rig.send(Command::ProgramTrack(Box::new(ProgramTrack::new(fixed, sky::site(), Vec::new()))));
    rig.seconds(120.0).await;
    rig.events();
    rig.send(step(Offset::Azimuth(deg(5.0))));
    rig.seconds(0.5).await;
    let told = rig.events();
    assert!(matches!(&refusals(&told)[..], [Refusal::Travel { .. }]), "{told:?}");
    rig.send(step(Offset::Along(deg(1.0))));
    rig.seconds(0.5).await;
    assert_eq!(refusals(&rig.events()), [&Refusal::TargetStands]);
    assert!(!rig.shown().program_track.as_ref().unwrap().target_moves);
    rig.send(step(Offset::Azimuth(deg(3.0))));
    rig.seconds(5.0).await;
    let azimuth = rig.shown().state.measured.unwrap().pointing.azimuth.unwrap();
    assert!((azimuth.degrees() - 199.0).abs() < 0.3, "{azimuth:?}");
}

#[tokio::test(start_paused = true)]
async fn without_a_track_or_after_stop_there_is_nothing_to_offset() {
    let scene = sky::usual();
    let mut rig = rc2000c::connected(&rc2000c::antenna(360.0), &scene).await;
    let azimuth = || step(Offset::Azimuth(deg(1.0)));
    rig.events();
    rig.send(azimuth());
    rig.seconds(0.5).await;
    assert_eq!(refusals(&rig.events()), [&Refusal::NoTrack]);
    tracking(&mut rig, &scene).await;
    rig.send(azimuth());
    rig.seconds(2.0).await;
    // The STOP voids this offset, which was requested before.
    rig.send(azimuth());
    rig.stop();
    rig.seconds(10.0).await;
    let told = rig.events();
    assert_eq!(refusals(&told), [] as [&Refusal; 0], "{told:?}");
    assert_eq!((rig.phase(), rig.shown().intent), (None, Intent::Standby));
    let stood = rig.shown().state.measured.unwrap().pointing;
    rig.send(azimuth());
    rig.seconds(5.0).await;
    assert_eq!(refusals(&rig.events()), [&Refusal::NoTrack]);
    assert_eq!(rig.shown().state.measured.unwrap().pointing, stood, "nothing moves");
    // A new track begins without offsets.
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.seconds(2.0).await;
    assert!(offsets(&rig).is_none());
}

#[tokio::test(start_paused = true)]
async fn a_track_begins_with_the_offsets_that_it_is_given() {
    let scene = sky::usual();
    let mut rig = rc2000c::connected(&rc2000c::antenna(360.0), &scene).await;
    let given = with(&[Offset::Azimuth(deg(2.0))]);
    let follow = ProgramTrack { offsets: given, ..scene.follow() };
    rig.send(Command::ProgramTrack(Box::new(follow)));
    rig.until_utc(add_seconds(scene.pass.aos.time, scene.pass.duration_s() / 3.0)).await;
    let [azimuth, _] = beside_deg(&rig, &scene);
    assert!((azimuth - 2.0).abs() < 0.6, "{azimuth}");
    assert_eq!(offsets(&rig), given);
    assert!(!rig.shown().program_track.as_ref().unwrap().can_undo);
}

#[tokio::test(start_paused = true)]
async fn without_a_link_a_step_is_refused_and_the_track_goes_on() {
    let scene = sky::usual();
    let mut rig = rc2000c::connected(&rc2000c::antenna(360.0), &scene).await;
    tracking(&mut rig, &scene).await;
    rig.set_off(true);
    rig.seconds(2.0).await;
    rig.send(step(Offset::Azimuth(deg(1.0))));
    rig.seconds(0.5).await;
    assert!(refusals(&rig.events()).contains(&&Refusal::PositionUnknown));
    assert_eq!(rig.phase(), Some(TrackPhase::Tracking));
    assert!(offsets(&rig).is_none());
}
