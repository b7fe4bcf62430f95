//! Idle sessions: a session sleeps while it has nothing to do, and its loop turns only when a task
//! is due.

use std::time::Duration;

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, LinkState, StopState},
    sim::satrak::Fault,
};
use tokio::time::timeout;

use super::rig::{Rig, iss, track};

/// Max clock readings a second: a turn of the loop makes a few, and each question and each reply is
/// a turn.
const READINGS_A_SECOND: u64 = 150;

/// Lets time pass and checks how busy the session was.
async fn assert_calm(rig: &mut Rig, seconds: u32, what: &str) {
    let (start, before) = (Instant::now(), rig.clock.readings());
    let within = Duration::from_secs(u64::from(seconds) * 2);
    timeout(within, rig.seconds(f64::from(seconds))).await.expect(what);
    assert!((Instant::now() - start) >= Duration::from_secs(u64::from(seconds)), "{what}");
    let readings = rig.clock.readings() - before;
    assert!(readings > 0, "{what}: the session is gone");
    let most = u64::from(seconds) * READINGS_A_SECOND;
    assert!(readings < most, "{what}: {readings} readings in {seconds} s");
}

#[tokio::test(start_paused = true)]
async fn at_rest() {
    let mut rig = Rig::usual().await;
    assert_calm(&mut rig, 60, "at rest").await;
}

#[tokio::test(start_paused = true)]
async fn while_the_link_is_lost() {
    let mut rig = Rig::usual().await;
    rig.set_off(true);
    assert_calm(&mut rig, 60, "lost").await;
    assert!(matches!(rig.shown().link, LinkState::Lost { .. }));
    rig.stop();
    assert_calm(&mut rig, 60, "lost, with a stop owed").await;
    assert!(matches!(rig.shown().stop, StopState::NotConfirmed { .. }));
    rig.set_off(false);
    rig.until_up(1).await;
}

#[tokio::test(start_paused = true)]
async fn while_the_unit_is_silent() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Silence, true);
    assert_calm(&mut rig, 5, "stale").await;
    assert_calm(&mut rig, 60, "silent").await;
    rig.stop();
    assert_calm(&mut rig, 60, "silent, with a stop owed").await;
}

#[tokio::test(start_paused = true)]
async fn while_a_motion_to_a_position_has_no_answer() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Silence, true);
    rig.send(Command::Park);
    assert_calm(&mut rig, 12, "park without an answer").await;
}

#[tokio::test(start_paused = true)]
async fn while_a_track_is_pending_and_while_it_waits_for_its_pass() {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    assert_calm(&mut rig, 1, "in preparation").await;
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    assert_calm(&mut rig, 20, "before the pass").await;
}

#[tokio::test(start_paused = true)]
async fn while_a_track_is_prepared_without_an_answer() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::DropReply, true);
    rig.send(track(iss()));
    assert_calm(&mut rig, 30, "in preparation, with lost replies").await;
}

#[tokio::test(start_paused = true)]
async fn while_the_outline_of_the_stop_button_is_shown() {
    let mut rig = Rig::usual().await;
    rig.stop();
    rig.until_event(2, |event| *event == Event::Stopped).await;
    assert_calm(&mut rig, 9, "the outline is shown").await;
    assert!(matches!(rig.shown().stop, StopState::Stopped { .. }));
    assert_calm(&mut rig, 5, "the outline fades").await;
    assert_eq!(rig.shown().stop, StopState::Ready);
}
