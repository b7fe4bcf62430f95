//! Any bytes on the line of a Satrak: raw, and each line as the payload of a good frame.

use azel::protocol::satrak::{
    Decoder, Frame, MAX_LINE_BYTES, Meaning, ReceivedLine, Reply, Request, Setting, encode,
    explain_reply, explain_request,
};

use super::no_infinity::is_finite;

pub(crate) fn run(bytes: &[u8]) {
    stream(bytes);
    for payload in bytes.split(|byte| *byte == b'\n') {
        let is_text = payload.iter().all(|byte| (0x20..0x7f).contains(byte));
        if let (true, Ok(payload)) = (is_text, str::from_utf8(payload)) {
            framed(payload);
        }
    }
}

fn lines(bytes: &[u8], piece: usize) -> Vec<ReceivedLine> {
    let mut decoder = Decoder::new();
    let mut seen = Vec::new();
    for piece in bytes.chunks(piece) {
        decoder.push(piece);
        seen.extend(std::iter::from_fn(|| decoder.next_line()));
    }
    seen.extend(decoder.take_unfinished());
    seen
}

fn stream(bytes: &[u8]) {
    let whole = lines(bytes, MAX_LINE_BYTES);
    let total: usize = whole.iter().map(ReceivedLine::length).sum();
    assert!(total <= bytes.len());
    // The decoder gives an over-long line up at the end of a piece.
    if whole.iter().all(|line| line.length() <= MAX_LINE_BYTES) {
        assert_eq!(lines(bytes, 1 + bytes.len() % 41), whole);
    }
    for line in whole {
        for is_greeting in [false, true] {
            let shown = line.without_secrets(is_greeting);
            // Placeholders may be longer than the secrets they replace.
            assert!(shown.bytes.len() <= 10 * (MAX_LINE_BYTES + 1));
        }
        match &line.frame {
            Ok(frame) => understood(frame),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

fn framed(payload: &str) {
    let bytes = encode(payload);
    // The length limit does not count LF.
    if payload.is_empty() || bytes.len() - 1 > MAX_LINE_BYTES {
        return;
    }
    let mut seen = lines(&bytes, MAX_LINE_BYTES);
    assert_eq!(seen.len(), 1);
    let frame = seen.remove(0).frame.expect("its checksum is right");
    assert_eq!(frame.line(), payload);
    understood(&frame);
}

fn understood(frame: &Frame) {
    for values in [explain_reply(frame), explain_request(frame)] {
        let numbers: Vec<usize> = values.iter().map(|value| value.number).collect();
        assert_eq!(numbers, (1..=values.len()).collect::<Vec<_>>());
    }
    for meaning in [Meaning::of_reply(frame), Meaning::of_request(frame)] {
        assert!(!meaning.text.is_empty());
    }
    if let Ok(parsed) = Reply::parse(frame) {
        assert!(is_finite(&format!("{parsed:?}")), "{parsed:?}");
    }
    if let Ok(request) = Request::parse(frame) {
        assert!(is_finite(&format!("{request:?}")), "{request:?}");
        let again = Request::parse(&Frame::from_payload(&request.payload()));
        // Azel sends positions with two decimals, even if it received more.
        if !matches!(request, Request::Setting(Setting::GpsSettings(_))) {
            assert_eq!(again.as_ref(), Ok(&request));
        }
        let again = again.expect("what is sent is understood");
        assert_eq!(Request::parse(&Frame::from_payload(&again.payload())), Ok(again));
    }
}
