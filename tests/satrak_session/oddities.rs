//! Every oddity and fault of the simulated unit.

use std::collections::BTreeSet;

use azel::{
    astro::{Angle, AzEl},
    contract::driver::{Command, Event, LinkLoss, LinkState, Snapshot},
    controller::satrak::checks,
    device::panel::{Check, CheckState},
    sim::satrak::{Fault, Options, Quirk},
};
use jiff::SignedDuration;

use super::{
    rig::{Rig, antenna, iss, options, track},
    script::Scripted,
};

const AIM_DEG: (f64, f64) = (100.0, 50.0);

fn odd(quirks: &[Quirk], faults: &[Fault]) -> Options {
    Options {
        quirks: quirks.iter().copied().collect::<BTreeSet<_>>(),
        faults: faults.iter().copied().collect::<BTreeSet<_>>(),
        ..options()
    }
}

/// Runs such a unit for half a minute, including a motion to a position.
async fn half_a_minute(quirks: &[Quirk], faults: &[Fault]) -> Rig {
    let mut rig = Rig::start(&odd(quirks, faults), &antenna());
    rig.until("position and faults", 20, |shown| {
        shown.state.measured.is_some() && shown.state.motion_lock.is_some()
    })
    .await;
    let (azimuth_deg, elevation_deg) = AIM_DEG;
    rig.send(Command::Position {
        azimuth: Some(Angle::from_degrees(azimuth_deg)),
        elevation: Some(Angle::from_degrees(elevation_deg)),
    });
    rig.seconds(30.0).await;
    rig
}

/// Checks that the antenna arrived by one command, and that Azel shows it there.
fn assert_arrived(rig: &mut Rig, what: &str) {
    let (azimuth_deg, elevation_deg) = AIM_DEG;
    let aim = AzEl::from_degrees(azimuth_deg, elevation_deg);
    let events = rig.events();
    assert!(
        events.iter().any(|event| matches!(event, Event::Arrived(_))),
        "{what}: {events:?} {:?}",
        rig.shown()
    );
    let shown = rig.shown();
    assert!(shown.link.is_open(), "{what}: {:?}", shown.link);
    let measured = shown.state.measured.unwrap();
    assert!(measured.direction().unwrap().separation(aim).degrees() < 0.05, "{what}: {measured:?}");
    assert_eq!(rig.sent("GOTO=").len(), 1, "{what}");
    let lost = events.iter().any(|event| matches!(event, Event::LinkLost(_)));
    assert!(!lost, "{what}: {events:?}");
}

#[tokio::test(start_paused = true)]
async fn each_oddity_of_the_firmware_is_taken_and_counted() {
    for (quirk, name) in Quirk::ALL {
        if quirk == Quirk::DecimalComma {
            continue;
        }
        let mut rig = half_a_minute(&[quirk], &[]).await;
        assert_arrived(&mut rig, name);
        let traffic = rig.shown().state.traffic;
        // The document itself prints a status without the comma, and auto-track is off here.
        let is_plain = matches!(quirk, Quirk::NoComma | Quirk::AutoTrackRestarts);
        assert_eq!(traffic.odd > 0, !is_plain, "{name}: {traffic:?}");
        assert_eq!([traffic.damaged, traffic.unreadable, traffic.unanswered], [0; 3], "{name}");
        let auto = rig.shown().state.program.unwrap().auto;
        assert_eq!(auto.is_none(), quirk == Quirk::Fields15, "{name}");
    }
}

#[tokio::test(start_paused = true)]
async fn all_harmless_oddities_together_are_taken() {
    let quirks: Vec<Quirk> = Quirk::ALL
        .into_iter()
        .map(|(quirk, _)| quirk)
        .filter(|quirk| *quirk != Quirk::DecimalComma)
        .collect();
    let faults = [Fault::Unsolicited, Fault::Garbage, Fault::Split];
    let mut rig = half_a_minute(&quirks, &faults).await;
    assert_arrived(&mut rig, "all");
    rig.send(track(iss()));
    rig.until_event(20, |event| matches!(event, Event::Tracking(_))).await;
    rig.stop();
    rig.until_event(4, |event| *event == Event::Stopped).await;
    assert!(!rig.control.state().is_tracking);
}

#[tokio::test(start_paused = true)]
async fn each_fault_of_the_line_is_lived_with_and_counted() {
    for (fault, name) in Fault::ALL {
        // Other tests cover a unit with false reports.
        let lies = matches!(fault, Fault::FrozenAngles | Fault::FalseRest);
        if lies || matches!(fault, Fault::Unit(_) | Fault::Silence | Fault::HangUp) {
            continue;
        }
        let mut rig = half_a_minute(&[], &[fault]).await;
        assert_arrived(&mut rig, name);
        let traffic = rig.shown().state.traffic;
        assert!(traffic.replies > 15, "{name}: {traffic:?}");
        assert_eq!(traffic.unsolicited > 0, fault == Fault::Unsolicited, "{name}: {traffic:?}");
        let is_damaged = matches!(fault, Fault::Garbage | Fault::BadChecksum);
        assert_eq!(traffic.damaged > 0, is_damaged, "{name}: {traffic:?}");
        let is_lossy = matches!(fault, Fault::DropReply | Fault::BadChecksum);
        assert_eq!(traffic.unanswered > 0, is_lossy, "{name}: {traffic:?}");
    }
}

/// Returns the names of the checks that are not good.
fn bad(shown: &Snapshot) -> Vec<&'static str> {
    let is_bad = |check: &&Check| matches!(check.state, CheckState::Caution | CheckState::Fault);
    shown.state.checks.iter().filter(is_bad).map(|check| check.name).collect()
}

#[tokio::test(start_paused = true)]
async fn each_fault_of_the_unit_is_shown_and_the_dangerous_ones_forbid_motion() {
    for (fault, name) in Fault::ALL {
        let Fault::Unit(kind) = fault else { continue };
        let mut rig = Rig::connected(&odd(&[], &[fault]), &antenna()).await;
        let shown = rig.shown();
        assert_eq!(bad(&shown), [checks(None)[kind.index() - 1].name], "{name}");
        rig.send(Command::Park);
        rig.seconds(0.5).await;
        let refused = rig.events().iter().any(|event| matches!(event, Event::NotSent(_)));
        assert_eq!(Some(refused), shown.state.motion_lock, "{name}");
        assert_eq!(rig.sent("GOTO=").is_empty(), shown.state.motion_lock == Some(true), "{name}");
        rig.control.set_fault(fault, false);
        rig.until("cleared", 3, |shown| bad(shown).is_empty()).await;
        assert_eq!(rig.shown().state.motion_lock, Some(false), "{name}");
    }
}

#[tokio::test(start_paused = true)]
async fn decimal_commas_never_become_a_position() {
    let mut rig = Rig::start(&odd(&[Quirk::DecimalComma], &[]), &antenna());
    for _ in 0..300 {
        rig.seconds(0.1).await;
        assert_eq!(rig.shown().state.measured, None);
        assert_eq!(rig.shown().state.program, None);
    }
    assert!(rig.shown().state.traffic.unreadable > 5, "{:?}", rig.shown().state.traffic);
    assert!(rig.shown().state.unreadable.is_some(), "the likely cause is told");
    let lost = rig.events();
    let why = Event::LinkLost(LinkLoss::Unreadable);
    assert!(!lost.is_empty() && lost.iter().all(|event| *event == why), "{lost:?}");
    rig.send(Command::Park);
    rig.seconds(0.1).await;
    let events = rig.events();
    assert!(events.iter().any(|event| matches!(event, Event::NotSent(_))), "{events:?}");
    rig.stop();
    rig.seconds(0.7).await;
    assert!(!rig.sent("STOP=").is_empty(), "STOP goes out all the same");
    assert!(rig.sent("GOTO=").is_empty());
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_is_set_to_points_is_read_and_the_cause_forgotten() {
    let mut rig = Rig::start(&odd(&[Quirk::DecimalComma], &[]), &antenna());
    rig.until("the cause", 20, |shown| shown.state.unreadable.is_some()).await;
    rig.control.set_quirk(Quirk::DecimalComma, false);
    rig.until("a position", 30, |shown| shown.state.measured.is_some()).await;
    assert!(rig.shown().state.unreadable.is_none());
}

#[tokio::test(start_paused = true)]
async fn noise_is_told_as_unreadable_whether_it_ends_a_line_or_not() {
    for noise in [&b"\x80\xffABC?"[..], b"$STATUS?,0*00\r\n"] {
        let mut unit = Scripted::raw(noise.to_vec());
        unit.seconds(8.0).await;
        let lost: Vec<Event> = unit.events();
        assert_eq!(lost.first(), Some(&Event::LinkLost(LinkLoss::Unreadable)), "{noise:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_silent_unit_is_lost_and_tried_again() {
    let mut rig = Rig::start(&odd(&[], &[Fault::Silence]), &antenna());
    rig.seconds(30.0).await;
    let shown = rig.shown();
    assert_eq!(shown.state.measured, None);
    assert_eq!(shown.state.traffic.replies, 0);
    assert_eq!(rig.events(), [Event::LinkLost(LinkLoss::Silent)], "told once");
    assert!(rig.dials().len() >= 3);
    rig.until("lost", 30, |shown| {
        matches!(shown.link, LinkState::Lost { reason: LinkLoss::Silent, .. })
    })
    .await;
}

/// Returns the unit's check of the age of the elements that it tracks with.
async fn age_of_elements(outdated_after: SignedDuration) -> CheckState {
    let mut rig = Rig::connected(&Options { outdated_after, ..options() }, &antenna()).await;
    rig.send(track(iss()));
    rig.until_event(60, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(10.0).await;
    let shown = rig.shown();
    let mut checks = shown.state.checks.iter();
    checks.find(|check| check.name == "Age of the elements").unwrap().state
}

#[tokio::test(start_paused = true)]
async fn elements_are_out_of_date_at_the_age_that_the_unit_is_set_to() {
    assert_eq!(age_of_elements(SignedDuration::ZERO).await, CheckState::Caution);
    assert_eq!(age_of_elements(SignedDuration::MAX).await, CheckState::Good);
}
