//! Record of the link, without secrets, and manual questions.

use std::{sync::Arc, time::Duration};

use azel::{
    contract::driver::{Command, Event, Recorded},
    device::{Direction, Finding, WireLine},
    protocol::satrak::{Query, encode},
    sim::satrak::{Fault, Options},
};

use super::{
    rig::{Rig, antenna, options},
    script::{Script, Scripted, plain},
};

const FTP: &str = "SATELLITE_FTP?,10.0.1.2,user,hunter2,22,f.txt,AO-7,1,1";

/// Returns all recorded lines.
pub(super) fn all(read: impl Fn(u64) -> Vec<Arc<Recorded>>) -> Vec<WireLine> {
    let mut lines = Vec::new();
    loop {
        let more = read(lines.len() as u64);
        if more.is_empty() {
            return lines;
        }
        lines.extend(more.iter().map(|recorded| recorded.line.clone()));
    }
}

/// Returns the text of a line without its end.
pub(super) fn line_text(line: &WireLine) -> String {
    String::from_utf8_lossy(&line.bytes).trim_end().to_owned()
}

/// Returns the lines that begin with this word.
fn with(lines: &[WireLine], word: &str) -> Vec<WireLine> {
    lines.iter().filter(|line| line_text(line).starts_with(word)).cloned().collect()
}

async fn rig_with(fault: Fault) -> Rig {
    let mut rig =
        Rig::start(&Options { faults: [fault].into_iter().collect(), ..options() }, &antenna());
    rig.seconds(20.0).await;
    rig
}

#[tokio::test(start_paused = true)]
async fn both_directions_are_recorded_in_order_with_time_and_round_trip() {
    let mut rig = Rig::usual().await;
    rig.seconds(1.0).await;
    rig.stop();
    rig.seconds(1.0).await;
    let lines = all(|from| rig.wire().copy_from(from));
    let sent: Vec<String> =
        lines.iter().filter(|line| line.direction == Direction::Sent).map(line_text).collect();
    let received: Vec<String> = rig.payloads();
    let payload = |frame: &String| frame[1..frame.len() - 3].to_owned();
    assert_eq!(sent.iter().map(payload).collect::<Vec<_>>(), received);
    assert!(lines.windows(2).all(|pair| pair[0].time <= pair[1].time));
    for line in &lines {
        assert_eq!(line.finding, Finding::Good, "{}", line_text(line));
        assert_eq!(line.length, line.bytes.len());
        assert_eq!(line.reply_after.is_some(), line.direction == Direction::Received);
        assert!(line.reply_after.is_none_or(|after| after < Duration::from_millis(500)));
        assert_eq!(line.is_poll, line_text(line).contains('?'), "{}", line_text(line));
    }
    for word in ["$STOP=*25", "$STOP=,OK*0D", "$TRACK=,0*6E"] {
        assert_eq!(with(&lines, word).len(), 1, "{word}");
    }
}

#[tokio::test(start_paused = true)]
async fn damaged_lines_are_recorded_with_what_is_wrong() {
    let rig = rig_with(Fault::BadChecksum).await;
    let lines = all(|from| rig.wire().copy_from(from));
    let bad: Vec<_> =
        lines.iter().filter(|l| matches!(l.finding, Finding::BadChecksum { .. })).collect();
    assert_eq!(bad.len() as u64, rig.shown().state.traffic.damaged);
    assert!(bad.iter().any(|line| line_text(line).contains("?,")), "values are shown");
    let no_reply = |line: &&WireLine| matches!(line.finding, Finding::NoReply { .. });
    let missing = lines.iter().filter(no_reply).count();
    assert_eq!(missing as u64, rig.shown().state.traffic.unanswered);

    let rig = rig_with(Fault::Garbage).await;
    let lines = all(|from| rig.wire().copy_from(from));
    let damaged = lines.iter().filter(|line| line.finding != Finding::Good);
    assert_eq!(damaged.count() as u64, rig.shown().state.traffic.damaged);
}

#[tokio::test(start_paused = true)]
async fn a_question_that_is_repeated_is_no_usual_poll() {
    let rig = rig_with(Fault::DropReply).await;
    let lines = all(|from| rig.wire().copy_from(from));
    let lost = |line: &WireLine| matches!(line.finding, Finding::NoReply { is_repeated: true, waited } if waited.as_secs() == 2);
    let at = lines.iter().position(lost).expect("a reply is missing");
    assert!(lines[..at].iter().any(|line| line.is_poll));
    assert!(!lines[at + 1].is_poll && lines[at + 1].direction == Direction::Sent);
}

#[tokio::test(start_paused = true)]
async fn a_query_by_hand_is_sent_in_its_turn_and_its_answer_recorded() {
    let mut rig = Rig::usual().await;
    for (_, word) in Query::ALL {
        rig.send(Command::Ask(format!("{word}?").into()));
        rig.seconds(0.5).await;
        let lines = all(|from| rig.wire().copy_from(from));
        let by_hand: Vec<_> =
            with(&lines, &format!("${word}?")).into_iter().filter(|line| !line.is_poll).collect();
        let directions: Vec<_> = by_hand.iter().map(|line| line.direction).collect();
        assert_eq!(directions, [Direction::Sent, Direction::Received], "{word}");
        assert!(by_hand[1].reply_after.is_some());
    }
    assert!(!rig.events().iter().any(|event| matches!(event, Event::NotSent(_))));
}

#[tokio::test(start_paused = true)]
async fn only_one_request_is_outstanding_and_a_flood_is_cut() {
    let mut rig = Rig::usual().await;
    for _ in 0..40 {
        rig.send(Command::Ask("REDUCTION?".into()));
    }
    rig.seconds(5.0).await;
    let lines = all(|from| rig.wire().copy_from(from));
    let asked = rig.sent("REDUCTION?").len();
    assert!((1..=40).contains(&asked), "{asked}");
    let mut waits = false;
    for line in lines {
        let is_sent = line.direction == Direction::Sent;
        assert_ne!(waits, is_sent, "{}", line_text(&line));
        waits = is_sent;
    }
}

#[tokio::test(start_paused = true)]
async fn without_a_link_a_query_is_dropped_in_silence() {
    let mut rig = Rig::usual().await;
    rig.set_off(true);
    rig.until("lost", 5, |shown| !shown.link.is_open()).await;
    rig.events();
    rig.send(Command::Ask("VERSION?".into()));
    rig.seconds(1.0).await;
    assert_eq!(rig.events(), []);
}

/// Returns the script of a unit that sends its password in every way, asked or not.
fn telltale() -> Script {
    let mut count = 0;
    Box::new(move |payload| {
        let mut replies = plain(payload);
        if payload.starts_with("SATELLITE_FTP") {
            return vec![(10, FTP.to_owned())];
        }
        count += 1;
        if count % 3 == 0 {
            replies.push((20, FTP.to_owned()));
        }
        replies
    })
}

#[tokio::test(start_paused = true)]
async fn the_password_of_the_unit_is_in_no_recorded_line() {
    let mut unit = Scripted::start(telltale());
    unit.seconds(3.0).await;
    unit.handle.send(Command::Ask("SATELLITE_FTP?".into())).unwrap();
    unit.seconds(5.0).await;
    let lines = all(|from| unit.handle.wire().copy_from(from));
    let answers = with(&lines, "$SATELLITE_FTP?(hidden)");
    assert!(answers.len() > 2 && answers.iter().all(|line| line.is_shortened));
    assert!(answers.iter().any(|line| line.reply_after.is_some()));
    assert_eq!(answers[0].length, encode(FTP).len());
    assert!(!format!("{lines:?}").contains("hunter2"));
    let bytes = b"hunter2";
    assert!(lines.iter().all(|line| !line.bytes.windows(7).any(|seen| seen == bytes)));
}

#[tokio::test(start_paused = true)]
async fn no_piece_of_the_password_is_recorded_however_the_line_is_cut() {
    let good = encode(FTP);
    for at in 0..good.len() {
        for (name, bytes) in [
            ("broken", [&good[..at], b"\n", &good[at..]].concat()),
            ("spoiled", [&good[..at], b"\xff", &good[at + 1..]].concat()),
            ("headless", good[at..].to_vec()),
            ("cut short", [&good[..at], &encode("STOP=,OK")[..]].concat()),
        ] {
            let holds_some = (20..good.len() - 1).contains(&at) && name != "headless";
            let mut unit = Scripted::raw(bytes);
            unit.seconds(1.0).await;
            let lines = all(|from| unit.handle.wire().copy_from(from));
            let is_shortened = lines.iter().any(|line| line.is_shortened);
            assert!(is_shortened || !holds_some, "{name} {at}");
            let leak = lines
                .iter()
                .map(line_text)
                .find(|text| (0..4).any(|from| text.contains(&"hunter2"[from..from + 4])));
            assert_eq!(leak, None, "{name} {at}");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn what_has_come_without_an_end_is_recorded_when_the_link_goes() {
    let mut unit = Scripted::raw(b"$STATUS?,0,299.49".to_vec());
    unit.seconds(10.0).await;
    let lines = all(|from| unit.handle.wire().copy_from(from));
    let unfinished: Vec<_> =
        lines.iter().filter(|line| line.finding == Finding::Unfinished).map(line_text).collect();
    assert_eq!(unfinished, ["$STATUS?,0,299.49"]);
}
