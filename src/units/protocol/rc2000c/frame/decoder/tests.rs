use super::*;

const POLL: &[u8] = b"\x02\x32\x31\x03\x02";
const OFFLINE_REPLY: &[u8] = b"\x06\x32\x31\x46\x03\x40";
const REFUSED: &[u8] = b"\x15\x32\x32\x03\x16";

fn decoder(bytes: &[u8]) -> Decoder {
    let mut decoder = Decoder::new(Address::FACTORY);
    decoder.push(bytes);
    decoder
}

fn headers(decoder: &mut Decoder) -> Vec<Header> {
    decoder.flatten().map(|frame| frame.header()).collect()
}

#[test]
fn frames_follow_each_other_without_gap() {
    let stream = [POLL, OFFLINE_REPLY, POLL, REFUSED].concat();
    let mut decoder = decoder(&stream);
    let headers_found = headers(&mut decoder);
    assert_eq!(headers_found, [Header::Command, Header::Ack, Header::Command, Header::Nak]);
    assert_eq!(decoder.skipped_bytes(), 0);
}

#[test]
fn noise_before_a_frame_loses_nothing() {
    for noise in [&b"\x06"[..], b"\x06\x06", b"\x15\x02", b"\x00\xff2", b"\x06\x32", b"\x06\x321"] {
        let mut decoder = decoder(&[noise, REFUSED].concat());
        assert_eq!(headers(&mut decoder), [Header::Nak], "{noise:02x?}");
        assert_eq!(decoder.skipped_bytes(), noise.len() as u64);
    }
}

#[test]
fn the_checksum_of_a_frame_begins_no_other() {
    // The checksum of the poll is 02, and the address follows.
    let mut decoder = decoder(&[POLL, b"2".as_slice(), REFUSED].concat());
    assert_eq!(headers(&mut decoder), [Header::Command, Header::Nak]);
}

#[test]
fn other_controllers_are_passed_over() {
    let mut decoder = decoder(b"\x06\x33\x31\x46\x03\x41\x15\x33\x32\x03\x17");
    assert_eq!(decoder.next(), None);
    assert_eq!(decoder.skipped_bytes(), 11);
}

#[test]
fn a_reply_of_another_length_is_refused_at_its_end() {
    let mut decoder = decoder(b"\x06\x32\x31\x03");
    let error = FrameError::BadLength { code: 0x31, data_bytes: 0 };
    assert_eq!(decoder.next(), Some(Err(error)));
}

#[test]
fn a_refusal_with_data_is_none() {
    let mut decoder = decoder(b"\x15\x32\x32F\x03\x50");
    let error = FrameError::BadLength { code: 0x32, data_bytes: 1 };
    assert_eq!(decoder.next(), Some(Err(error)));
}

#[test]
fn bytes_that_no_frame_holds_are_named() {
    for byte in [0x00, 0x1f, 0x06, 0x80, 0xff] {
        let mut decoder = decoder(&[b"\x06\x32\x31AB".as_slice(), &[byte]].concat());
        assert_eq!(decoder.next(), Some(Err(FrameError::BadByte { byte, index: 5 })));
    }
    assert_eq!(
        decoder(b"\x02\x32\x03\x33").next(),
        Some(Err(FrameError::BadByte { byte: 3, index: 2 }))
    );
}

#[test]
fn an_endless_frame_is_given_up_at_its_longest() {
    let endless = [b"\x06\x32\x31".as_slice(), &[b' '; 33]].concat();
    let mut decoder = decoder(&endless);
    assert_eq!(decoder.next(), None);
    decoder.push(b" ");
    assert_eq!(decoder.next(), Some(Err(FrameError::TooLong)));
}

#[test]
fn a_quiet_line_ends_a_frame_and_frees_what_it_held_back() {
    let mut decoder = decoder(b"\x06\x32\x35AB");
    assert_eq!(decoder.next(), None);
    assert_eq!(decoder.line_is_quiet(), [Err(FrameError::Incomplete { bytes: 5 })]);
    assert_eq!(decoder.line_is_quiet(), []);
    // The checksum is missing, and the next frame's header is no replacement.
    decoder.push(b"\x15\x32\x32\x03");
    decoder.push(REFUSED);
    let frames: Vec<_> = decoder.by_ref().collect();
    assert!(matches!(frames[..], [Err(FrameError::BadChecksum { .. }), Ok(_)]), "{frames:?}");
}

#[test]
fn memory_is_bounded() {
    let mut decoder = decoder(&[0x20; 5000]);
    assert!(decoder.pending.len() <= MAX_PENDING_BYTES);
    decoder.push(REFUSED);
    assert_eq!(decoder.next(), None);
    assert_eq!(decoder.skipped_bytes(), 5005);
    decoder.push(REFUSED);
    assert_eq!(headers(&mut decoder), [Header::Nak]);
}

#[test]
fn a_device_type_may_repeat_a_wrong_code() {
    let good = b"\x06\x32\x31\x32\x4b\x43\x41\x31\x34\x03\x78";
    assert!(matches!(decoder(good).next(), Some(Ok(_))));
    let other = b"\x06\x32\x31\x41\x4b\x43\x41\x31\x34\x03\x0b";
    assert!(matches!(decoder(other).next(), Some(Err(FrameError::BadLength { .. }))));
}
