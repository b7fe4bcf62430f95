//! Effects of lines: echoes, noise, pieces, lost and broken replies, wrong addresses.

use azel::{
    contract::driver::{Command, Event, LinkLoss, LinkState},
    device::{Direction, Finding, Meaning},
    protocol::rc2000c::Address,
    sim::rc2000c::{Fault, Options, Quirk},
};

use super::rig::{Rig, antenna};

#[tokio::test(start_paused = true)]
async fn echoes_noise_and_pieces_change_nothing() {
    for (quirk, faults) in [
        (Some(Quirk::Echo), vec![]),
        (None, vec![Fault::Garbage]),
        (None, vec![Fault::Split]),
        (Some(Quirk::Echo), vec![Fault::Garbage, Fault::Split]),
    ] {
        let options = Options {
            quirks: quirk.into_iter().collect(),
            faults: faults.iter().copied().collect(),
            ..Options::default()
        };
        let mut rig = Rig::connected(&options, &antenna()).await;
        rig.send(Command::Manual);
        rig.hold([2.0, 0.0], 2.0).await;
        assert!(rig.counts()[0] > 1560, "{options:?}");
        rig.send(Command::EndJog);
        rig.seconds(3.0).await;
        let traffic = rig.shown().state.traffic;
        assert_eq!((traffic.unanswered, traffic.unsolicited), (0, 0), "{options:?}");
        assert_eq!(traffic.odd > 0, quirk.is_some());
        assert_eq!(rig.events(), []);
    }
}

#[tokio::test(start_paused = true)]
async fn a_question_is_repeated_twice_and_the_answers_still_fit() {
    for fault in [Fault::DropReply, Fault::BitError, Fault::Truncate] {
        let mut rig = Rig::in_manual().await;
        rig.control.set_fault(fault, true);
        rig.seconds(30.0).await;
        assert!(rig.shown().link.is_open(), "{fault:?} {:?}", rig.shown().link);
        let traffic = rig.shown().state.traffic;
        assert!(traffic.unanswered > 5, "{traffic:?}");
        assert_eq!(traffic.unsolicited, 0, "{fault:?}");
        assert_eq!(traffic.damaged > 0, fault != Fault::DropReply, "{fault:?}");
        rig.stop();
        rig.until_event(8, |event| *event == Event::Stopped).await;
    }
}

#[tokio::test(start_paused = true)]
async fn silence_after_three_tries_is_a_lost_link_that_is_dialled_again() {
    let mut rig = Rig::in_manual().await;
    rig.control.set_fault(Fault::Silence, true);
    let before = rig.times("1").len();
    rig.until("lost", 6, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    assert_eq!(rig.events(), [Event::LinkLost(LinkLoss::Silent)]);
    assert_eq!(rig.times("1").len() - before, 3);
    rig.control.set_fault(Fault::Silence, false);
    rig.until_found().await;
}

#[tokio::test(start_paused = true)]
async fn another_address_hears_nothing_and_is_lost() {
    let options = Options { address: Address::new(51).unwrap(), ..Options::default() };
    let mut rig = Rig::start(&options, &antenna());
    rig.send(Command::Connect);
    rig.until("lost", 8, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    assert_eq!(rig.events(), [Event::LinkLost(LinkLoss::Silent)]);
    assert!(rig.received().is_empty());
    rig.stop();
    rig.seconds(5.0).await;
    assert!(rig.events().contains(&Event::StopNotConfirmed));
}

#[tokio::test(start_paused = true)]
async fn the_log_shows_every_frame_and_what_is_wrong_with_it() {
    let mut rig = Rig::in_manual().await;
    rig.control.set_fault(Fault::BitError, true);
    rig.seconds(10.0).await;
    rig.control.set_fault(Fault::BitError, false);
    rig.control.set_fault(Fault::Garbage, true);
    rig.seconds(5.0).await;
    let lines: Vec<azel::device::WireLine> =
        rig.wire().copy_from(0).iter().map(|recorded| recorded.line.clone()).collect();
    let sent = |line: &&azel::device::WireLine| line.direction == Direction::Sent;
    assert!(lines.iter().filter(sent).all(|line| line.bytes[0] == 0x02));
    assert_eq!(&*lines[0].bytes, b"\x02\x32\x30\x03\x03");
    assert_eq!(&*lines[1].bytes, b"\x06\x32\x302KCA14\x03\x79");
    assert!(lines[1].reply_after.is_some());
    assert_eq!(lines[0].meaning, Some(Meaning::plain("Asks for the type of the unit")));
    assert_eq!(lines[1].meaning, Some(Meaning::plain("Type of the unit")));
    let has = |wanted: fn(&Finding) -> bool| lines.iter().any(|line| wanted(&line.finding));
    assert!(has(|finding| matches!(finding, Finding::BadChecksum { .. })));
    assert!(has(|finding| matches!(finding, Finding::NoReply { is_repeated: true, .. })));
    assert!(has(|finding| matches!(finding, Finding::NoHeader)));
}

#[tokio::test(start_paused = true)]
async fn questions_by_hand_go_out_once_and_are_no_usual_polls() {
    let mut rig = Rig::in_manual().await;
    rig.seconds(5.0).await;
    let first = rig.wire().copy_from(0).len() as u64;
    rig.send(Command::Ask("STATUS".into()));
    rig.send(Command::Ask("DEVICE TYPE".into()));
    rig.send(Command::Ask("HELLO".into()));
    rig.seconds(3.0).await;
    let lines = rig.wire().copy_from(first);
    let by_hand = lines.iter().map(|recorded| &recorded.line).filter(|line| !line.is_poll);
    let said: Vec<_> = by_hand.map(|line| line.meaning.clone().unwrap().text).collect();
    let wanted =
        ["Asks for the status", "Status", "Asks for the type of the unit", "Type of the unit"];
    assert_eq!(said, wanted);
}
