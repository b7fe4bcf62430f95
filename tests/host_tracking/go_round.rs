//! Detours round keep-outs: over whole passes the measured direction stays outside, and Azel tracks
//! the target again on the other side.

use azel::{
    astro::{Angle, AzEl},
    contract::driver::{Command, Event},
    orbit::Propagator,
    plan::Bounds,
    sim::{Control, Unit},
    station::{Antenna, Entered, KeepOut, Station},
};

use super::{
    genius, rc2000c,
    rig::Rig,
    satrak,
    sky::{self, Scene},
};
use crate::common::workers::{hold_up_workers, with_one_worker};

/// Returns a keep-out at the middle of the pass: from the ground to 8 degrees above the pass, 8
/// degrees to both sides.
fn halfway(scene: &Scene, margin_deg: f64) -> KeepOut {
    let halfway =
        azel::astro::time::add_seconds(scene.pass.aos.time, scene.pass.duration_s() / 2.0);
    let propagator = Propagator::new(&scene.elements).unwrap();
    let at = propagator.look_from(sky::site(), halfway).unwrap().direction;
    mast(at.azimuth_deg(), at.elevation_deg() + 8.0, margin_deg)
}

fn mast(azimuth_deg: f64, top: f64, margin_deg: f64) -> KeepOut {
    let sides = [azimuth_deg - 8.0, azimuth_deg + 8.0];
    let corners = [(sides[0], -2.0), (sides[1], -2.0), (sides[1], top), (sides[0], top)];
    KeepOut { entered: Entered::GoRound, margin_deg, ..crate::common::mast(&corners) }
}

/// Tracks the pass round `mast`. Returns the min distance of the antenna from all margins, and its
/// distance from the target at LOS, degrees.
async fn follow_round<U: Unit>(
    rig: &mut Rig<Control<U>>,
    antenna: &Antenna,
    scene: &Scene,
    mast: KeepOut,
) -> [f64; 2] {
    let station = Station { site: sky::site(), keep_outs: vec![mast], ..Station::default() };
    let bounds = Bounds::new(&station, antenna);
    rig.handle().keep_within(bounds.clone());
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    let propagator = Propagator::new(&scene.elements).unwrap();
    let direction = |rig: &Rig<Control<U>>| -> AzEl {
        rig.shown().state.measured.unwrap().pointing.direction().unwrap()
    };
    let (mut min_deg, mut off_deg) = (f64::MAX, f64::MAX);
    while rig.clock.utc() < scene.pass.los.time {
        rig.seconds(0.2).await;
        let at = direction(rig);
        let clearance = bounds.at_time(rig.clock.utc()).nearest(at).unwrap();
        min_deg = min_deg.min(clearance.angle.degrees());
        let target = propagator.look_from(sky::site(), rig.clock.utc()).unwrap().direction;
        off_deg = target.separation(at).degrees();
    }
    let told = rig.events();
    let refused =
        |event: &Event| matches!(event, Event::NotSent(_) | Event::CannotProgramTrack(..));
    assert!(!told.iter().any(refused), "{told:?}");
    [min_deg, off_deg]
}

#[tokio::test(start_paused = true)]
async fn by_an_rc2000c() {
    let scene = sky::usual();
    let antenna = rc2000c::antenna(360.0);
    let mut rig = rc2000c::connected(&antenna, &scene).await;
    let [min_deg, off_deg] = follow_round(&mut rig, &antenna, &scene, halfway(&scene, 1.0)).await;
    println!("RC2000C: {min_deg:.2} outside, at last {off_deg:.2} beside");
    assert!(min_deg > -0.1, "{min_deg}");
    assert!(off_deg < 1.0, "{off_deg}");
}

#[tokio::test(start_paused = true)]
async fn by_a_genius_that_coasts() {
    let scene = sky::usual();
    let antenna = genius::antenna(azel::controller::rotator_genius::Rotators::Pair);
    let (mut rig, _control) = genius::connected(&genius::options(2), &antenna, &scene).await;
    let [min_deg, off_deg] = follow_round(&mut rig, &antenna, &scene, halfway(&scene, 4.0)).await;
    println!("Genius: {min_deg:.2} outside, at last {off_deg:.2} beside");
    // The antenna coasts by up to two degrees; its wider margin allows for them.
    assert!(min_deg > -3.0, "{min_deg}");
    assert!(off_deg < 3.0, "{off_deg}");
}

#[tokio::test(start_paused = true)]
async fn on_the_way_to_where_a_pass_begins() {
    let scene = sky::usual();
    let antenna = rc2000c::antenna(360.0);
    let mut rig = rc2000c::connected(&antenna, &scene).await;
    let begins = scene.pass.aos.direction.azimuth_deg();
    let side = if begins < 180.0 { 100.0 } else { -100.0 };
    rig.send(Command::Position {
        azimuth: Some(Angle::from_degrees(begins + side)),
        elevation: Some(Angle::from_degrees(20.0)),
    });
    rig.seconds(100.0).await;
    let between = mast(begins + side / 2.0, 60.0, 1.0);
    let [min_deg, off_deg] = follow_round(&mut rig, &antenna, &scene, between).await;
    println!("RC2000C, to its AOS: {min_deg:.2} outside, at last {off_deg:.2} beside");
    assert!(min_deg > -0.1, "{min_deg}");
    assert!(off_deg < 1.0, "{off_deg}");
}

#[tokio::test(start_paused = true)]
async fn by_a_satrak_on_crossed_axes() {
    let scene = sky::usual();
    let antenna = satrak::antenna();
    let (mut rig, _control) = satrak::connected(&antenna, &scene, 120.0).await;
    let [min_deg, off_deg] = follow_round(&mut rig, &antenna, &scene, halfway(&scene, 1.0)).await;
    println!("Satrak: {min_deg:.2} outside, at last {off_deg:.2} beside");
    assert!(min_deg > -0.1, "{min_deg}");
    // The antenna stays above its minimum elevation of five degrees.
    assert!(off_deg < 5.5, "{off_deg}");
}

#[test]
fn stop_waits_for_no_path_and_ends_what_waits_for_it() {
    with_one_worker(async {
        let scene = sky::usual();
        let antenna = satrak::antenna();
        let (mut rig, control) = satrak::connected(&antenna, &scene, 120.0).await;
        let keep_outs = vec![halfway(&scene, 1.0)];
        let station = Station { site: sky::site(), keep_outs, ..Station::default() };
        rig.handle().keep_within(Bounds::new(&station, &antenna));
        let sent = |word: &str| {
            let received = control.received().into_iter();
            received.filter(|(_, payload)| payload.starts_with(word)).count()
        };
        let before = sent("STOP=");
        let held_up = hold_up_workers();
        rig.send(Command::ProgramTrack(Box::new(scene.follow())));
        while !rig.shown().being_judged {
            tokio::task::yield_now().await;
        }
        rig.stop();
        while sent("STOP=") == before {
            tokio::task::yield_now().await;
        }
        assert!(rig.shown().being_judged, "STOP did not wait");
        drop(held_up);
        rig.seconds(20.0).await;
        assert!(!rig.shown().being_judged);
        assert!(rig.shown().program_track.is_none(), "nothing is begun after STOP");
    });
}
