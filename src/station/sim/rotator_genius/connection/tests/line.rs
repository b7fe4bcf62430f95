//! Tests of the line's effects on commands and replies.

use super::*;

fn connect_with(faults: &[Fault], quirks: &[Quirk]) -> (Client, Control) {
    let faults = faults.iter().copied().collect();
    let quirks = quirks.iter().copied().collect();
    Client::new(&Options { quirks, faults, ..both_limits() })
}

#[tokio::test(start_paused = true)]
async fn both_forms_of_a_status_say_the_same() {
    let (mut client, control) = connect_with(&[], &[]);
    let wide = client.status().await;
    control.set_quirk(Quirk::Narrow, true);
    let mut client = Client::attached(&control);
    let narrow = client.status().await;
    assert!(wide.layout < narrow.layout);
    for (wide, narrow) in wide.rotators.iter().zip(&narrow.rotators) {
        assert_eq!(wide.position, narrow.position);
        assert_eq!((&wide.name, wide.limit_cw), (&narrow.name, narrow.limit_cw));
    }
}

#[tokio::test(start_paused = true)]
async fn the_longer_reply_to_a_go_to_repeats_the_target() {
    let (mut client, _control) = connect_with(&[], &[Quirk::GoToReply6]);
    let target = Some(angle(42));
    let acknowledgement = Acknowledgement::GoTo { target };
    let expected = Said::Acknowledgement { request: acknowledgement, is_accepted: true };
    assert_eq!(client.ask(go_to(ONE, 42)).await, expected);
}

#[tokio::test(start_paused = true)]
async fn requests_together_and_in_pieces_are_answered_in_order() {
    let (mut client, control) = connect_with(&[], &[]);
    client.write(b"|A1200|S|").await;
    client.write(b"h").await;
    for expected in [Acknowledgement::GoTo { target: None }, Acknowledgement::Stop] {
        let reply = Said::Acknowledgement { request: expected, is_accepted: true };
        assert_eq!(client.receive().await, Some(Received::Reply(reply)));
    }
    assert!(matches!(client.receive().await, Some(Received::Reply(Said::Status(_)))));
    let received: Vec<String> =
        control.received().into_iter().map(|(_, command)| command).collect();
    assert_eq!(received, ["|A1200", "|S", "|h"]);
}

#[tokio::test(start_paused = true)]
async fn pieces_and_merged_replies_are_read() {
    for fault in [Fault::Split, Fault::Merge] {
        let (mut client, _control) = connect_with(&[fault], &[]);
        client.send(&go_to(ONE, 200)).await;
        client.send(&Request::Read).await;
        client.send(&Request::Stop).await;
        for _ in 0..3 {
            assert!(matches!(client.receive().await, Some(Received::Reply(_))), "{fault}");
        }
        assert_eq!(client.receive().await, None, "{fault}");
    }
}

#[tokio::test(start_paused = true)]
async fn garbage_is_noise_and_hides_no_reply() {
    let (mut client, _control) = connect_with(&[Fault::Garbage], &[]);
    for request in [Request::Read, Request::Stop, Request::Read] {
        client.send(&request).await;
        assert_eq!(client.receive().await, Some(Received::Noise(NOISE.to_vec())));
        assert!(matches!(client.receive().await, Some(Received::Reply(_))));
    }
}

#[tokio::test(start_paused = true)]
async fn lost_replies_belong_to_commands_that_were_carried_out() {
    let (mut client, control) = connect_with(&[Fault::Silence], &[]);
    client.send(&go_to(ONE, 200)).await;
    assert_eq!(client.receive().await, None);
    assert_eq!(control.state().rotator(ONE).target, Some(angle(200)));
    control.set_fault(Fault::Silence, false);
    control.set_fault(Fault::DropReply, true);
    let mut client = Client::attached(&control);
    assert!(client.accepts(Request::Stop).await);
    assert!(client.accepts(Request::Stop).await);
    client.send(&go_to(ONE, 90)).await;
    assert_eq!(client.receive().await, None);
    assert_eq!(control.state().rotator(ONE).target, Some(angle(90)));
}

#[tokio::test(start_paused = true)]
async fn a_connection_ends_by_fault_or_by_hand() {
    let (mut client, control) = connect_with(&[Fault::HangUp], &[]);
    assert!(client.accepts(Request::Stop).await);
    assert!(client.accepts(Request::Stop).await);
    client.send(&Request::Stop).await;
    let mut buffer = [0; 8];
    assert_eq!(client.stream.read(&mut buffer).await.unwrap(), 0);
    let mut client = Client::attached(&control);
    assert!(client.accepts(go_to(ONE, 300)).await);
    control.drop_clients();
    assert_eq!(client.stream.read(&mut buffer).await.unwrap(), 0);
    assert_eq!(control.state().rotator(ONE).target, Some(angle(300)));
}
