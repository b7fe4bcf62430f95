//! Scenarios, one for each check. Each returns `true` on success.

use std::time::Duration;

use tokio::time::{Instant, timeout};

use super::{
    Checks,
    scene::{genius, satrak, satrak_after},
};
use crate::{
    astro::{Angle, AzEl, Offset, TrackOffsets},
    contract::driver::{Command, Event, Intent, LinkState, OffsetChange, Safety, Snapshot},
    driver::session::testing,
    plan::{OnBoardPass, ProgramTrack, Target},
    sim::{InMemory as _, Trouble, rotator_genius, satrak},
    station::{LockOut, Station},
};

fn turn_to(azimuth_deg: f64) -> Command {
    Command::Position { azimuth: Some(Angle::from_degrees(azimuth_deg)), elevation: None }
}

/// Returns a track of a fixed direction with an azimuth offset of `beside_deg`, degrees.
fn fixed(azimuth_deg: f64, elevation_deg: f64, beside_deg: f64) -> Command {
    let target = Target::Fixed(AzEl::from_degrees(azimuth_deg, elevation_deg));
    let track = ProgramTrack::new(target, Station::default().site, Vec::new());
    Command::ProgramTrack(Box::new(ProgramTrack { offsets: azimuth(beside_deg), ..track }))
}

fn azimuth(degrees: f64) -> TrackOffsets {
    TrackOffsets::NONE.plus(Offset::Azimuth(Angle::from_degrees(degrees))).unwrap()
}

fn is_moving(shown: &Snapshot) -> bool {
    shown.state.measured.is_some_and(|measured| measured.moving())
}

fn is_forbidden(event: &Event) -> bool {
    matches!(event, Event::Safety(Safety::Forbidden { .. }))
}

/// Checks that a worker judges the path of the pass and the session then accepts the command.
pub(super) async fn watch_judging(checks: Checks) -> bool {
    let scene = satrak(checks).read().await;
    scene.send(Command::Track(Box::new(testing::pass())));
    scene.shows(5.0, |shown| shown.intent == Intent::Track).await
}

/// Checks that the session starts the program once the unit has the pass.
pub(super) async fn take_events(checks: Checks) -> bool {
    let scene = satrak(checks).read().await;
    scene.send(Command::Track(Box::new(testing::pass())));
    scene.seconds(30.0).await;
    scene.sent("TRACK=,1") == 1
}

pub(super) async fn report_found(checks: Checks) -> bool {
    genius(checks).tells(5.0, |event| matches!(event, Event::Connected(_))).await
}

/// Checks that the track continues after an outage of an unchanged unit.
pub(super) async fn watch_likeness(checks: Checks) -> bool {
    let scene = satrak_after(30.0, checks).read().await;
    let OnBoardPass { target, elements, site, .. } = testing::pass();
    let satellite = Target::Satellite(Box::new(elements));
    let track = ProgramTrack::new(satellite, site, vec![(target.start, target.end)]);
    scene.send(Command::ProgramTrack(Box::new(track)));
    scene.seconds(20.0).await;
    scene.set_off(true);
    scene.seconds(30.0).await;
    let before = scene.sent("GOTO=");
    scene.set_off(false);
    scene.seconds(30.0).await;
    before > 0 && scene.sent("GOTO=") > before
}

pub(super) async fn watch_program(checks: Checks) -> bool {
    let mut scene = satrak_after(30.0, checks).read().await;
    scene.starts_by_itself().await;
    scene.tells(5.0, |event| *event == Event::StartedByItself).await
}

/// Checks the alarm when somebody turns the antenna and leaves it there.
pub(super) async fn watch_hands(checks: Checks) -> bool {
    let mut scene = satrak(checks).read().await;
    scene.seconds(5.0).await;
    scene.unit.place([80.0, 80.0]);
    scene.tells(15.0, |event| matches!(event, Event::Safety(Safety::ForeignHands { .. }))).await
}

/// Checks the report of a lost reply to a motion that turns nothing, because the antenna is already
/// there.
pub(super) async fn resolve_doubt(checks: Checks) -> bool {
    let mut scene = genius(checks).read().await;
    scene.send(Command::Hold);
    scene.unit.set_fault(rotator_genius::Fault::Silence, true);
    scene.send(turn_to(173.0));
    scene.seconds(0.3).await;
    scene.unit.set_fault(rotator_genius::Fault::Silence, false);
    scene.tells(6.0, |event| matches!(event, Event::Unanswered(_))).await
}

/// Checks the end of a jog whose lease expired while the link accepted no bytes.
pub(super) async fn watch_jog(checks: Checks) -> bool {
    let mut scene = satrak(checks).read().await;
    let jog = || scene.send(Command::Jog { rates_deg_s: [1.0, 0.0] });
    scene.send(Command::Manual);
    for _ in 0..10 {
        jog();
        scene.seconds(0.1).await;
    }
    jog();
    scene.stall(true);
    scene.seconds(0.35).await;
    jog();
    scene.stall(false);
    scene.seconds(0.1).await;
    scene.tells(0.0, |event| *event == Event::JogLeaseOver).await
}

/// Checks the alarm for a rotator that does not turn.
pub(super) async fn watch_effect(checks: Checks) -> bool {
    let mut scene = genius(checks).read().await;
    let stuck = rotator_genius::Fault::Stuck(crate::protocol::rotator_genius::RotatorNumber::One);
    scene.unit.set_fault(stuck, true);
    scene.send(turn_to(100.0));
    scene.tells(20.0, |event| matches!(event, Event::Safety(Safety::NoEffect { .. }))).await
}

/// Checks the alarm for drives that are far too slow for the target.
pub(super) async fn watch_pointing(checks: Checks) -> bool {
    let mut scene = satrak(checks).read().await;
    scene.unit.set_trouble(Trouble::SlowDrives([0.02; 2]), true);
    scene.send(fixed(100.0, 40.0, 0.0));
    scene.tells(60.0, |event| matches!(event, Event::Safety(Safety::OffTarget { .. }))).await
}

/// Checks that the session does not refuse the second step.
pub(super) async fn watch_step(checks: Checks) -> bool {
    let scene = satrak(checks).read().await;
    scene.send(Command::Manual);
    for _ in 0..2 {
        scene.send(Command::Step { steps_deg: [1.0, 0.0] });
        scene.seconds(5.0).await;
    }
    scene.sent("STEP=") == 2
}

pub(super) async fn watch_halt(checks: Checks) -> bool {
    let mut scene = genius(checks).read().await;
    scene.handle.stop();
    scene.tells(5.0, |event| *event == Event::Stopped).await
}

/// Checks that the computer may sleep after the session has ended a jog.
pub(super) async fn let_sleep(checks: Checks) -> bool {
    let scene = satrak(checks).read().await;
    scene.send(Command::Manual);
    scene.send(Command::Jog { rates_deg_s: [1.0, 0.0] });
    scene.seconds(0.1).await;
    timeout(Duration::from_millis(2900), scene.sleeps.wait_until_quiet()).await.is_ok()
}

/// Checks the alarm when somebody turns the antenna while its drives stand.
pub(super) async fn watch_rest(checks: Checks) -> bool {
    let mut scene = satrak(checks).read().await;
    scene.seconds(5.0).await;
    scene.unit.place([80.0, 80.0]);
    scene.tells(5.0, |event| matches!(event, Event::Safety(Safety::FlagsContradict { .. }))).await
}

pub(super) async fn watch_place(checks: Checks) -> bool {
    let scene = genius(checks).read().await;
    scene.put_mast(&[(160.0, -5.0), (190.0, -5.0), (190.0, 30.0), (160.0, 30.0)]);
    scene.shows(5.0, |shown| shown.breach.is_some()).await
}

/// Checks that the gate uses the direction of the axes after a track with an offset, not the
/// target.
pub(super) async fn watch_offsets(checks: Checks) -> bool {
    let mut scene = satrak(checks).read().await;
    scene.send(fixed(110.0, 40.0, 8.0));
    scene.seconds(60.0).await;
    scene.send(Command::Standby);
    scene.seconds(5.0).await;
    scene.put_mast(&[(108.0, 35.0), (112.0, 35.0), (112.0, 45.0), (108.0, 45.0)]);
    !scene.tells(5.0, is_forbidden).await
}

pub(super) async fn watch_bounds(checks: Checks) -> bool {
    let mut scene = genius(checks).read().await;
    scene.put_mast(&[(160.0, -5.0), (190.0, -5.0), (190.0, 30.0), (160.0, 30.0)]);
    scene.tells(5.0, is_forbidden).await
}

/// Checks that the session detects the end of a motion without a STOP.
pub(super) async fn watch_standstill(checks: Checks) -> bool {
    let scene = genius(checks).read().await;
    scene.send(turn_to(160.0));
    scene.shows(5.0, is_moving).await && scene.shows(30.0, |shown| !shown.unproved).await
}

pub(super) async fn watch_lock_out(checks: Checks) -> bool {
    let scene = satrak(checks).read().await;
    let start = testing::START;
    let (operator, reason) = ("Ada".to_owned(), "gear".to_owned());
    scene.send(Command::LockOut(LockOut { operator, start, reason }));
    scene.seconds(0.1).await;
    scene.shows(10.0, |shown| !shown.locking).await
}

pub(super) async fn watch_auto_track(checks: Checks) -> bool {
    let scene = satrak(checks).read().await;
    scene.send(Command::AutoTrack(false));
    scene.seconds(5.0).await;
    scene.sent("TRACK_AUTO_ENABLE=,0") > 0
}

/// Checks that an offset of the unit's own track takes effect.
pub(super) async fn watch_unit_offsets(checks: Checks) -> bool {
    let scene = satrak_after(30.0, checks).read().await;
    if !scene.tracks().await {
        return false;
    }
    scene.send(Command::Offset(OffsetChange::Step(Offset::Azimuth(Angle::from_degrees(1.0)))));
    let is_on =
        |shown: &Snapshot| shown.unit_offsets.as_ref().is_some_and(|view| !view.is_changing);
    scene.shows(20.0, is_on).await
}

/// Checks that an old STOP causes no further work.
pub(super) async fn forget_old_stop(checks: Checks) -> bool {
    let scene = genius(checks).read().await;
    let start = scene.readings();
    scene.seconds(10.0).await;
    let idle = scene.readings() - start;
    scene.handle.stop();
    scene.seconds(20.0).await;
    let start = scene.readings();
    scene.seconds(10.0).await;
    scene.readings() - start < idle * 2
}

pub(super) async fn start_queued(checks: Checks) -> bool {
    let scene = genius(checks).read().await;
    scene.send(turn_to(160.0));
    scene.shows(5.0, is_moving).await
}

pub(super) async fn watch_slew(checks: Checks) -> bool {
    let mut scene = genius(checks).read().await;
    scene.send(turn_to(160.0));
    scene.tells(20.0, |event| matches!(event, Event::Arrived(_))).await
}

pub(super) async fn watch_tracking(checks: Checks) -> bool {
    let scene = genius(checks).read().await;
    scene.send(fixed(160.0, 20.0, 0.0));
    scene.shows(5.0, is_moving).await
}

/// Checks a unit that tracks a known satellite on its own.
pub(super) async fn watch_on_board(checks: Checks) -> bool {
    let scene = satrak_after(30.0, checks).read().await;
    scene.starts_by_itself().await;
    scene.shows(20.0, |shown| shown.on_board.is_some()).await
}

pub(super) async fn watch_silence(checks: Checks) -> bool {
    let mut scene = satrak_after(-90.0, checks).read().await;
    let [azimuth, elevation] = [100.0, 30.0].map(|deg| Some(Angle::from_degrees(deg)));
    scene.send(Command::Position { azimuth, elevation });
    assert!(scene.shows(5.0, is_moving).await);
    scene.unit.set_fault(satrak::Fault::Silence, true);
    let is_told = scene.tells(2.0, |event| *event == Event::Safety(Safety::SilentInMotion)).await;
    is_told && !matches!(scene.shown().link, LinkState::Lost { .. })
}

/// Returns the time from the command of a second motion until its send time; the first motion
/// delays it.
pub(super) async fn start_after_halt(checks: Checks) -> Duration {
    let scene = genius(checks).read().await;
    scene.send(turn_to(100.0));
    assert!(scene.shows(5.0, is_moving).await);
    let (sent, start) = (scene.sent("|A"), Instant::now());
    scene.send(turn_to(200.0));
    while scene.sent("|A") == sent {
        scene.seconds(0.001).await;
        assert!(start.elapsed() < Duration::from_secs(30));
    }
    start.elapsed()
}
