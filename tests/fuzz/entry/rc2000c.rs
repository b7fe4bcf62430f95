//! Any bytes on the line of an RC2000C: raw, with software parity, and each line as the content of
//! a good frame.

use azel::protocol::{
    Parity,
    rc2000c::{Address, Decoder, Frame, FrameError, Reply, Request, checksum},
};

use super::no_infinity::is_finite;

pub(crate) fn run(bytes: &[u8]) {
    stream(bytes);
    let mut taken_off = bytes.to_vec();
    Parity::Software.check(&mut taken_off);
    stream(&taken_off);
    let mut sent: Vec<u8> = bytes.iter().map(|byte| byte & 0x7f).collect();
    let seven_bits = sent.clone();
    Parity::Software.prepare(&mut sent);
    Parity::Software.check(&mut sent);
    assert_eq!(sent, seven_bits);
    for line in bytes.split(|byte| *byte == b'\n') {
        if let [header, rest @ ..] = line {
            framed(*header, rest);
        }
    }
}

fn decode(bytes: &[u8], piece: usize) -> (Vec<Result<Frame, FrameError>>, u64) {
    let mut decoder = Decoder::new(Address::FACTORY);
    let mut seen = Vec::new();
    for piece in bytes.chunks(piece) {
        decoder.push(piece);
        seen.extend(decoder.by_ref());
    }
    seen.extend(decoder.line_is_quiet());
    assert_eq!(decoder.next(), None);
    (seen, decoder.skipped_bytes())
}

fn stream(bytes: &[u8]) {
    let (seen, skipped) = decode(bytes, 500);
    assert_eq!(decode(bytes, 1 + bytes.len() % 41), (seen.clone(), skipped));
    let framed: usize = seen.iter().flatten().map(|frame| frame.to_bytes().len()).sum();
    assert_eq!(framed as u64 + skipped, bytes.len() as u64);
    for frame in seen.iter().flatten() {
        understood(frame);
    }
}

/// Feeds a frame with `code_and_data` behind the header that `choice` selects.
fn framed(choice: u8, code_and_data: &[u8]) {
    const ETX: u8 = 0x03;
    let header = [0x02, 0x06, 0x15][usize::from(choice % 3)];
    let mut bytes = vec![header, Address::FACTORY.number()];
    bytes.extend(code_and_data.iter().map(|byte| 0x20 + byte.wrapping_sub(0x20) % 0x60));
    bytes.push(ETX);
    bytes.push(checksum(&bytes));
    stream(&bytes);
}

fn understood(frame: &Frame) {
    let bytes = frame.to_bytes();
    assert_eq!(checksum(&bytes), 0);
    if let Ok(reply) = Reply::parse(frame) {
        assert!(is_finite(&format!("{reply:?}")), "{reply:?}");
        let again = reply.to_frame(Address::FACTORY).to_bytes();
        assert_eq!(Reply::parse(&only(&again)), Ok(reply));
    }
    if let Ok(request) = Request::parse(frame) {
        let again = request.to_bytes(Address::FACTORY);
        assert_eq!(Request::parse(&only(&again)), Ok(request));
    }
}

fn only(bytes: &[u8]) -> Frame {
    let (mut seen, skipped) = decode(bytes, 500);
    assert_eq!((seen.len(), skipped), (1, 0));
    seen.remove(0).expect("it was written")
}
