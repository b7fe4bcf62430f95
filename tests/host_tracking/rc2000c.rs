//! An RC2000C: counts of a calibrated sensor, and a travel of more than a turn.

use azel::{
    astro::{Angle, time::add_seconds},
    contract::driver::{Command, Event},
    controller::rc2000c::Calibration,
    device::CountPoint,
    plan::TrackStats,
    sim::rc2000c::{Control, Options},
    station::{Antenna, Mount},
};

use super::{
    rig::{self, figures},
    sky::{self, Scene},
};

type Rig = rig::Rig<Control>;

/// Lead before AOS, seconds, in which the antenna reaches the start of the pass.
const LEAD_S: f64 = 240.0;
/// Rate of the simulated axes, counts per second.
const COUNTS_S: f64 = 40.0;

/// Returns an antenna whose azimuth axis travels from north to `azimuth_to_deg` on the 3600 counts
/// of the simulated unit.
pub(super) fn antenna(azimuth_to_deg: f64) -> Antenna {
    antenna_to(azimuth_to_deg, 90.0)
}

/// Returns such an antenna whose elevation axis also travels to `elevation_to_deg`, on 1800 counts.
fn antenna_to(azimuth_to_deg: f64, elevation_to_deg: f64) -> Antenna {
    let point = |counts, degrees| CountPoint { counts, degrees };
    let calibration = Calibration {
        azimuth: vec![point(30, 0.0), point(3630, azimuth_to_deg)],
        elevation: vec![point(30, 0.0), point(1830, elevation_to_deg)],
    };
    let mut antenna = Antenna::rc2000c("Dish", "in memory");
    calibration.put_into(&mut antenna.connection).unwrap();
    antenna.mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg,
        elevation_from_deg: 0.0,
        elevation_to_deg,
    };
    antenna.limits.minimum_elevation_deg = 0.0;
    antenna.limits.maximum_rate_deg_s = COUNTS_S * azimuth_to_deg / 3600.0;
    antenna
}

async fn followed(antenna: &Antenna, scene: &Scene) -> TrackStats {
    let mut rig = connected(antenna, scene).await;
    over(&mut rig, scene).await
}

pub(super) async fn connected(antenna: &Antenna, scene: &Scene) -> Rig {
    let utc_origin = add_seconds(scene.pass.aos.time, -LEAD_S);
    let mut rig = Rig::new(Control::new(&Options::default()), utc_origin, |dial, clock| {
        rig::session(antenna, dial, clock)
    })
    .looking_every(rig::LOOK);
    rig.send(Command::Connect);
    rig.until("it is read", 20, |shown| {
        shown.state.measured.is_some() && shown.state.motion_lock.is_some()
    })
    .await;
    rig.seconds(2.0).await;
    rig
}

/// Tracks the pass of `scene`, and fails at an unexpected event.
async fn over(rig: &mut Rig, scene: &Scene) -> TrackStats {
    rig.events();
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    let stats = rig.until_over().await;
    let others = rig.events();
    let is_good = |event: &Event| matches!(event, Event::Awaits { .. } | Event::ProgramTracks(_));
    assert!(others.iter().all(is_good), "{others:?}");
    stats
}

#[tokio::test(start_paused = true)]
async fn a_usual_pass_is_followed_within_the_dead_band() {
    let (rms, worst) = figures("RC2000C, usual", followed(&antenna(360.0), &sky::usual()).await);
    assert!(rms < 0.5 && worst < 1.5, "{rms} {worst}");
}

#[tokio::test(start_paused = true)]
async fn through_north_an_overlap_saves_the_way_round() {
    let scene = sky::through_north();
    let plain =
        figures("RC2000C, through north, 0 to 360", followed(&antenna(360.0), &scene).await);
    let overlap =
        figures("RC2000C, through north, 0 to 450", followed(&antenna(450.0), &scene).await);
    assert!(plain.1 > 45.0, "{plain:?}");
    assert!(overlap.0 < 0.5 && overlap.1 < 1.5, "{overlap:?}");
}

#[tokio::test(start_paused = true)]
async fn close_to_the_zenith_it_slews_in_time() {
    let (rms, worst) =
        figures("RC2000C, 88 degrees", followed(&antenna(360.0), &sky::overhead()).await);
    assert!(rms < 4.0 && worst < 15.0, "{rms} {worst}");
}

#[tokio::test(start_paused = true)]
async fn over_the_zenith_it_neither_goes_round_nor_slews() {
    let over = antenna_to(360.0, 180.0);
    let north = followed(&over, &sky::through_north()).await;
    let (rms, worst) = figures("RC2000C, through north, 0 to 360 and 180", north);
    assert!(rms < 0.5 && worst < 1.5, "{rms} {worst}");
    let overhead = followed(&over, &sky::overhead()).await;
    let (rms, worst) = figures("RC2000C, 88 degrees, elevation to 180", overhead);
    assert!(rms < 0.5 && worst < 2.4, "{rms} {worst}");
}

#[tokio::test(start_paused = true)]
async fn a_rate_that_was_set_wrong_is_learned_on_the_way_to_the_pass() {
    let scene = sky::overhead();
    for share in [0.5, 2.0] {
        let mut antenna = antenna(360.0);
        antenna.limits.maximum_rate_deg_s *= share;
        let unknown = followed(&antenna, &scene).await;
        let mut rig = connected(&antenna, &scene).await;
        let away = scene.pass.aos.direction.azimuth + Angle::from_degrees(100.0);
        rig.send(Command::Position { azimuth: Some(away.wrapped_360()), elevation: None });
        rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
        let learned = over(&mut rig, &scene).await;
        let rates_deg_s = rig.shown().rates_deg_s.unwrap();
        let real_deg_s = self::antenna(360.0).limits.maximum_rate_deg_s;
        assert!((rates_deg_s[0] / real_deg_s - 1.0).abs() < 0.1, "{rates_deg_s:?} {real_deg_s}");
        let figures =
            |what, stats| figures(&format!("RC2000C, 88 degrees, {share} rate, {what}"), stats);
        let (_, before) = figures("not known", unknown);
        let (rms, worst) = figures("learned", learned);
        assert!(rms < 1.0 && worst < 5.0 && worst < before - 3.0, "{rms} {worst} {before}");
    }
}
