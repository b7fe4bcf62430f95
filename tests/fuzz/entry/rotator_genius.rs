//! Any bytes on the line of a Rotator Genius.

use azel::protocol::rotator_genius::{
    Acknowledgement, Decoder, Layout, MAX_NOISE_BYTES, Received, Reply, Request,
};

/// Bytes in one piece; fewer than the max that waits in the decoder.
const PIECE: usize = 2048;

pub(crate) fn run(bytes: &[u8]) {
    let whole = decode(bytes, PIECE);
    assert_eq!(decode(bytes, 1 + bytes.len() % 73), whole);
    every_byte_is_told(bytes);
    // The simulator expects the first byte to begin a request.
    for start in (0..bytes.len()).filter(|at| bytes[*at] == b'|').take(16) {
        let rest = &bytes[start..];
        for length in (2..=rest.len().min(40)).filter(|length| {
            let letter = rest.get(1).copied().unwrap_or_default();
            Request::length(letter) == Some(*length)
        }) {
            request(&rest[..length]);
        }
    }
    request(bytes);
}

fn decode(bytes: &[u8], piece: usize) -> Vec<Received> {
    let mut decoder = Decoder::new();
    let mut seen = Vec::new();
    for piece in bytes.chunks(piece) {
        decoder.push(piece);
        seen.extend(decoder.by_ref());
    }
    seen.extend(decoder.idle());
    assert_eq!(decoder.unfinished_bytes(), 0);
    seen
}

/// Checks that the decoder reports every byte as a reply or as noise. Only the end of the last name
/// may be added.
fn every_byte_is_told(bytes: &[u8]) {
    let mut decoder = Decoder::new();
    let mut seen = Vec::new();
    for piece in bytes.chunks(PIECE) {
        decoder.push(piece);
        seen.extend(decoder.by_ref());
    }
    let unfinished = decoder.unfinished_bytes();
    let told: usize = seen.iter().map(length).sum();
    let go_tos = seen.iter().filter(|received| is_go_to(received)).count();
    // The decoder holds noise before an unfinished reply back until the reply ends.
    let held: usize = decoder.idle().iter().map(length).sum();
    // The acknowledgement of a go-to has three bytes, or three more digits.
    let most = told + 3 * go_tos + held.max(unfinished) + 12;
    assert!(told + unfinished <= bytes.len() && bytes.len() <= most, "{told} {held} {unfinished}");
}

fn is_go_to(received: &Received) -> bool {
    let Received::Reply(Reply::Acknowledgement { request: to, .. }) = received else {
        return false;
    };
    matches!(to, Acknowledgement::GoTo { .. })
}

fn length(received: &Received) -> usize {
    match received {
        Received::Noise(run) => {
            assert!((1..=MAX_NOISE_BYTES).contains(&run.len()));
            run.len()
        }
        Received::Reply(Reply::Status(status)) => {
            let length = match status.layout {
                Layout::Wide => 71,
                Layout::Narrow => 63,
            };
            length + usize::from(status.panic.is_some())
        }
        Received::Reply(Reply::Acknowledgement { .. }) => 3,
        Received::LayoutChanged(_) | Received::OtherProtocol => 0,
    }
}

fn request(bytes: &[u8]) {
    if let Ok(request) = Request::parse(bytes) {
        assert_eq!(Request::parse(&request.to_bytes()), Ok(request));
    }
}
