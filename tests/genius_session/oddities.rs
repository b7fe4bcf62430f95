//! Oddities and faults of the unit, which the session handles correctly.

use azel::{
    contract::driver::{Event, LinkState},
    controller::rotator_genius::Rotators,
    device::panel::CheckState,
    sim::rotator_genius::{Fault, Quirk},
};

use super::{
    rig::{Rig, pair, to},
    script::{Scripted, plain, status},
};

#[tokio::test(start_paused = true)]
async fn every_quirk_is_taken() {
    for (quirk, name) in Quirk::ALL {
        let mut options = pair();
        options.quirks.insert(quirk);
        let mut rig = Rig::connected(&options, Rotators::Pair).await;
        assert_eq!(rig.axes_deg(), [Some(173.0), Some(0.0)], "{name}");
        rig.send(to(Some(180.0), Some(20.0)));
        rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
        assert_eq!(rig.orders(), ["|A1180", "|A2020"], "{name}");
        let traffic = rig.shown().state.traffic;
        assert_eq!((traffic.damaged, traffic.unanswered, traffic.unsolicited), (0, 0, 0), "{name}");
    }
}

#[tokio::test(start_paused = true)]
async fn the_narrow_form_is_read() {
    let mut options = pair();
    options.quirks.insert(Quirk::Narrow);
    let rig = Rig::connected(&options, Rotators::Pair).await;
    assert_eq!(rig.reading("Rotator 1"), "Tower, azimuth");
}

#[tokio::test(start_paused = true)]
async fn a_form_that_changes_costs_one_status() {
    let mut rig = Rig::pair().await;
    rig.control.set_quirk(Quirk::Narrow, true);
    rig.seconds(4.0).await;
    assert_eq!(rig.shown().state.traffic.odd, 1);
    assert!(matches!(rig.shown().link, LinkState::Up { .. }));
}

#[tokio::test(start_paused = true)]
async fn torn_merged_and_noisy_replies_are_put_together() {
    for fault in [Fault::Split, Fault::Merge, Fault::Garbage] {
        let mut options = pair();
        options.faults.insert(fault);
        let mut rig = Rig::connected(&options, Rotators::Pair).await;
        rig.send(to(Some(185.0), Some(20.0)));
        rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
        assert_eq!(rig.orders(), ["|A1185", "|A2020"], "{fault}");
        rig.seconds(5.0).await;
        let traffic = rig.shown().state.traffic;
        assert_eq!(traffic.unanswered, 0, "{fault}");
        assert_eq!(traffic.damaged > 0, fault == Fault::Garbage, "{fault}");
        assert!(matches!(rig.shown().link, LinkState::Up { .. }), "{fault}");
    }
}

#[tokio::test(start_paused = true)]
async fn lost_replies_and_a_hanging_up_peer_are_lived_with() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::DropReply, true);
    rig.seconds(30.0).await;
    assert!(!matches!(rig.shown().link, LinkState::Lost { .. }));
    assert!(rig.shown().state.traffic.unanswered > 5);
    assert_eq!(rig.events(), []);
    rig.control.set_fault(Fault::DropReply, false);
    rig.control.set_fault(Fault::HangUp, true);
    rig.seconds(10.0).await;
    rig.control.set_fault(Fault::HangUp, false);
    rig.until_up(10).await;
    rig.seconds(2.0).await;
    assert_eq!(rig.orders(), [""; 0], "nothing moves for it");
}

#[tokio::test(start_paused = true)]
async fn a_panic_code_is_shown_and_forbids_nothing() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::Panic, true);
    rig.seconds(1.0).await;
    assert_eq!(rig.reading("Panic code"), "0x07");
    let shown = rig.shown();
    let check = shown.state.checks.iter().find(|check| check.name == "Panic code").unwrap();
    assert_eq!(check.state, CheckState::Caution);
    rig.send(to(Some(180.0), None));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
}

#[tokio::test(start_paused = true)]
async fn a_status_without_the_end_of_its_last_name_is_completed_when_it_is_quiet() {
    let script = |command: &str| match command {
        "|h" => {
            let whole = status(100, 10, ['0', '0'], '\0');
            let name = whole.len() - 3;
            vec![(10, whole[..name].to_vec())]
        }
        other => plain(other),
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(5.0).await;
    let shown = device.handle.snapshot();
    assert!(matches!(shown.link, LinkState::Up { .. }));
    assert_eq!(shown.state.measured.unwrap().axes[0].angle_deg, Some(100.0));
    assert_eq!((shown.state.traffic.damaged, shown.state.traffic.unanswered), (0, 0));
}

#[tokio::test(start_paused = true)]
async fn late_answers_are_taken_for_what_they_answer() {
    // Every answer comes after its time limit.
    let script = |command: &str| {
        plain(command).into_iter().map(|(_, reply)| (1200, reply)).collect::<Vec<_>>()
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(20.0).await;
    let shown = device.handle.snapshot();
    let measured = shown.state.measured.unwrap();
    assert!(!matches!(shown.link, LinkState::Lost { .. }), "{:?}", shown.link);
    let way = (measured.received - measured.requested).as_secs_f64();
    assert!(way >= 1.2, "never younger than it is: {way}");
}
