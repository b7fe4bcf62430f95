//! A unit that does not answer while it moves.

use std::{
    collections::BTreeSet,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
    time::Duration,
};

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Event, LinkState, Safety},
    sim::satrak::Fault,
};

use super::{
    rig::Rig,
    script::{Scripted, plain},
};

fn is_it(event: &Event) -> bool {
    matches!(event, Event::Safety(Safety::SilentInMotion))
}

async fn on_its_way() -> Rig {
    let mut rig = Rig::usual().await;
    rig.send(Command::Position {
        azimuth: Some(Angle::from_degrees(200.0)),
        elevation: Some(Angle::from_degrees(20.0)),
    });
    rig.until("it moves", 3, |shown| shown.state.measured.unwrap().moving()).await;
    rig.events();
    rig
}

#[tokio::test(start_paused = true)]
async fn it_is_told_once_within_a_second_of_the_first_missing_reply_until_it_answers() {
    let mut rig = on_its_way().await;
    rig.control.set_fault(Fault::Silence, true);
    let began = Instant::now();
    rig.until_event(3, is_it).await;
    let told_s = (Instant::now() - began).as_secs_f64();
    // The report takes a poll period, 0.6 s for the first missing reply, and a second.
    assert!((1.0..0.5 + 0.6 + 1.0).contains(&told_s), "{told_s}");
    assert!(rig.shown().silent);
    rig.seconds(10.0).await;
    assert!(!rig.events().iter().any(is_it), "told again");
    rig.control.set_fault(Fault::Silence, false);
    rig.until("it answers", 15, |shown| !shown.silent).await;
}

#[tokio::test(start_paused = true)]
async fn of_one_that_stands_the_link_alone_is_told() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Silence, true);
    rig.until_event(10, |event| matches!(event, Event::LinkLost(_))).await;
    assert!(!rig.events().iter().any(is_it) && !rig.shown().silent);
}

#[tokio::test(start_paused = true)]
async fn a_link_that_closes_in_the_middle_of_a_motion_is_told_at_once() {
    let mut rig = on_its_way().await;
    rig.set_off(true);
    rig.seconds(0.1).await;
    let events = rig.events();
    assert!(
        matches!(events[..], [Event::Safety(Safety::SilentInMotion), Event::LinkLost(_)]),
        "{events:?}"
    );
    rig.set_off(false);
    rig.until("it answers", 15, |shown| !shown.silent).await;
}

#[tokio::test(start_paused = true)]
async fn while_it_moves_one_reply_that_is_lost_is_asked_for_again_at_once() {
    let mut rig = on_its_way().await;
    rig.control.set_fault(Fault::DropReply, true);
    rig.seconds(10.0).await;
    assert!(!rig.events().iter().any(is_it));
}

/// A reply does not name its question, so Azel matches replies only by their order.
#[tokio::test(start_paused = true)]
async fn replies_that_are_four_seconds_late_are_never_taken_for_newer_ones() {
    let are_late = Arc::new(AtomicBool::new(false));
    let switch = Arc::clone(&are_late);
    let mut unit = Scripted::start(Box::new(move |payload| {
        let late_ms = if switch.load(Relaxed) { 4_000 } else { 0 };
        let replies = plain(payload).into_iter();
        replies.map(|(delay_ms, reply)| (delay_ms + late_ms, reply)).collect()
    }));
    unit.seconds(2.0).await;
    are_late.store(true, Relaxed);
    let late_from = Instant::now() + Duration::from_secs(4);
    let mut readings = BTreeSet::new();
    for _ in 0..600 {
        unit.seconds(0.1).await;
        let shown = unit.handle.snapshot();
        let Some(measured) = shown.state.measured.filter(|measured| measured.received > late_from)
        else {
            continue;
        };
        assert!(!matches!(shown.link, LinkState::Up { .. }), "{:?}", shown.link);
        readings.insert(measured.received);
        assert!(measured.received - measured.requested >= Duration::from_secs(4), "{measured:?}");
    }
    assert!(readings.len() > 8, "{}", readings.len());
}
