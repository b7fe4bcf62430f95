//! Streams of recorded, documented and broken bytes.

use super::*;
use crate::protocol::rotator_genius::Acknowledgement;

/// Status recorded at a station: the second rotator points to 43 degrees.
const WIDE: &[u8] =
    b"|h2\x00999359  0A0   0999999\x00Tower        43359  0A0   0999999\x00Rotator 2   ";
/// The document's example with its last name, which is blank.
const NARROW: &[u8] = b"|h0\x00100005350A1009999990TOW1      999010060E0019999990          ";

fn take(decoder: &mut Decoder, bytes: &[u8]) -> Vec<Received> {
    decoder.push(bytes);
    decoder.collect()
}

fn stop() -> Received {
    Received::Reply(Reply::Acknowledgement { request: Acknowledgement::Stop, is_accepted: true })
}

fn status(received: &Received) -> &Status {
    match received {
        Received::Reply(Reply::Status(status)) => status,
        other => panic!("{other:?}"),
    }
}

#[test]
fn names_may_hold_anything() {
    let mut bytes = WIDE.to_vec();
    bytes[26..38].copy_from_slice(b"|h2\0|SKA0|A1");
    bytes[60..72].copy_from_slice(b"|h|SK|cF\0E0V");
    let items = take(&mut Decoder::new(), &bytes);
    assert_eq!(items.len(), 1);
    assert_eq!(status(&items[0]).rotators[0].name, "|h2\0|SKA0|A1");
    assert_eq!(status(&items[0]).rotators[1].name, "|h|SK|cF\0E0V");
}

#[test]
fn a_swallowed_panic_byte_moves_everything_by_one() {
    for (layout, whole) in [(Layout::Wide, WIDE), (Layout::Narrow, NARROW)] {
        let bytes: Vec<u8> = [&whole[..3], &whole[4..]].concat();
        let items = take(&mut Decoder::new(), &bytes);
        assert_eq!(items.len(), 1);
        assert_eq!((status(&items[0]).layout, status(&items[0]).panic), (layout, None));
        let with_it = take(&mut Decoder::new(), whole);
        assert_eq!(status(&items[0]).rotators, status(&with_it[0]).rotators);
    }
}

#[test]
fn another_form_is_announced_and_taken_from_the_second_on() {
    let mut decoder = Decoder::new();
    assert_eq!(status(&take(&mut decoder, WIDE)[0]).layout, Layout::Wide);
    let items = take(&mut decoder, &NARROW.repeat(2));
    assert_eq!(
        items[..2],
        [Received::LayoutChanged(Layout::Narrow), Received::Noise(NARROW.to_vec())]
    );
    assert_eq!(status(&items[2]).layout, Layout::Narrow);
    assert_eq!(items.len(), 3);
}

#[test]
fn silence_ends_what_is_unfinished() {
    let mut decoder = Decoder::new();
    // More than the name is missing. This part gives no reply, not even together with the next
    // status.
    decoder.push(&WIDE[..59]);
    assert_eq!(decoder.unfinished_bytes(), 59);
    assert_eq!(decoder.idle(), [Received::Noise(WIDE[..59].to_vec())]);
    assert_eq!(decoder.idle(), []);
    let items = take(&mut decoder, &WIDE[..61]);
    assert_eq!(items, []);
    assert_eq!(status(&decoder.idle()[0]).rotators[1].name, "R");
    assert_eq!(decoder.unfinished_bytes(), 0);
    // The decoder finds the reply after a piece of a status.
    decoder.push(b"|h2|SK");
    assert_eq!(decoder.idle(), [Received::Noise(b"|h2".to_vec()), stop()]);
}

#[test]
fn a_piece_of_a_status_does_not_spoil_the_next_one() {
    let items = take(&mut Decoder::new(), &[&WIDE[..9], WIDE].concat());
    assert_eq!(items[0], Received::Noise(WIDE[..9].to_vec()));
    assert_eq!(status(&items[1]).rotators[1].name, "Rotator 2");
}

#[test]
fn the_greeting_of_another_product_is_recognised_at_the_start_only() {
    let mut decoder = Decoder::new();
    assert_eq!(take(&mut decoder, b"V"), []);
    assert_eq!(take(&mut decoder, b"1.2 AUTH\n"), [Received::OtherProtocol]);
    assert_eq!(decoder.idle(), [Received::Noise(b"V1.2 AUTH\n".to_vec())]);
    for other in [&b"|SKV1"[..], b"\nV1", b"VK"] {
        let items = take(&mut Decoder::new(), other);
        assert!(!items.contains(&Received::OtherProtocol), "{other:?}");
    }
}

#[test]
fn a_stream_that_nobody_reads_fills_no_memory() {
    let mut decoder = Decoder::new();
    for _ in 0..100 {
        decoder.push(&WIDE.repeat(10));
    }
    assert_eq!(decoder.unfinished_bytes(), MAX_PENDING_BYTES);
    assert!(decoder.next().is_some());
    // The decoder has room again, but must not read on after a gap.
    decoder.push(WIDE);
    let items: Vec<_> = decoder.by_ref().collect();
    assert_eq!(items.len(), MAX_PENDING_BYTES / WIDE.len() - 1);
    // The decoder does not join the cut status to the next status.
    let rest = take(&mut decoder, WIDE);
    assert!(matches!(rest[0], Received::Noise(_)));
    assert_eq!(status(&rest[1]).rotators[1].name, "Rotator 2");
    let noise = take(&mut Decoder::new(), &[b'|'; 2 * MAX_NOISE_BYTES + 2]);
    assert_eq!(noise, vec![Received::Noise(vec![b'|'; MAX_NOISE_BYTES]); 2]);
}
