//! Record of the link for the console.

use azel::{
    contract::driver::{Command, Event},
    device::{Direction, Finding, WireLine},
    sim::rotator_genius::Fault,
};

use super::{
    rig::{Rig, to},
    script::Scripted,
};

fn lines(handle: &azel::driver::AntennaHandle) -> Vec<WireLine> {
    handle.wire().copy_from(0).iter().map(|recorded| recorded.line.clone()).collect()
}

#[tokio::test(start_paused = true)]
async fn commands_and_replies_stand_in_the_log_as_they_went() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::Garbage, true);
    rig.send(to(Some(180.0), None));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    rig.stop();
    rig.seconds(1.0).await;
    let lines = lines(rig.handle());
    let says = |line: &WireLine, words: &str| {
        line.finding == Finding::Unchecked
            && line.meaning.as_ref().is_some_and(|it| it.text == words)
    };
    let find = |direction, bytes: &[u8]| {
        lines.iter().find(|it| it.direction == direction && &*it.bytes == bytes).unwrap()
    };
    assert!(says(find(Direction::Sent, b"|A1180"), "Turns rotator 1 to 180°"));
    assert!(says(find(Direction::Sent, b"|S"), "Stops both rotators"));
    let poll = find(Direction::Sent, b"|h");
    assert!(poll.is_poll && says(poll, "Asks for the status"));
    let taken = find(Direction::Received, b"|AK");
    assert!(says(taken, "Accepted"));
    assert!(taken.reply_after.unwrap().as_millis() < 50);
    assert!(find(Direction::Received, b"|SK").reply_after.is_some());
    let statuses = lines.iter().filter(|line| says(line, "Status"));
    for status in statuses {
        assert_eq!(status.length, 72);
        assert!(status.bytes.starts_with(b"|h2\0") && status.reply_after.is_some());
        assert!(status.is_poll);
    }
    let noise = lines.iter().find(|line| line.finding == Finding::NoHeader).unwrap();
    assert_eq!(&*noise.bytes, b"\x00\xff~|A12\r\n|");
}

#[tokio::test(start_paused = true)]
async fn what_does_not_come_stands_in_the_log_too() {
    let mut device = Scripted::raw(b"|h2");
    device.seconds(3.0).await;
    let lines = lines(&device.handle);
    assert!(lines.iter().any(|line| matches!(line.finding, Finding::NoReply { .. })));
    let noise = lines.iter().find(|line| line.finding == Finding::NoHeader).unwrap();
    assert_eq!(&*noise.bytes, b"|h2");
}

#[tokio::test(start_paused = true)]
async fn a_status_asked_by_hand_goes_out_once_and_is_no_usual_poll() {
    let mut rig = Rig::pair().await;
    rig.send(Command::Ask("STATUS".into()));
    rig.send(Command::Ask("HELLO".into()));
    rig.seconds(3.0).await;
    let lines = lines(rig.handle());
    let by_hand: Vec<_> = lines.iter().filter(|line| !line.is_poll).collect();
    let directions: Vec<_> = by_hand.iter().map(|line| line.direction).collect();
    assert_eq!(directions, [Direction::Sent, Direction::Received], "{by_hand:?}");
}
