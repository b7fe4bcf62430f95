//! RC2000C codec on any input.

use std::time::Duration;

use azel::protocol::{Parity, rc2000c::*};
use proptest::prelude::*;

fn address() -> impl Strategy<Value = Address> {
    (49_u8..=111).prop_map(|number| Address::new(number).unwrap())
}

fn name() -> impl Strategy<Value = SatelliteName> {
    "[ -`{-~]{1,10}".prop_filter_map("blank", |name| SatelliteName::new(&name).ok())
}

fn motion() -> impl Strategy<Value = Motion> {
    let polarity = prop_oneof![Just(Polarity::Horizontal), Just(Polarity::Vertical)];
    let directions = prop::sample::select(vec![
        Direction::CounterClockwise,
        Direction::Clockwise,
        Direction::Down,
        Direction::Up,
    ]);
    let speeds = prop_oneof![Just(Speed::Slow), Just(Speed::Fast)];
    let turns = prop::sample::select(vec![
        PolarizationMove::JogClockwise,
        PolarizationMove::JogCounterClockwise,
        PolarizationMove::ToStored(Polarity::Horizontal),
        PolarizationMove::ToStored(Polarity::Vertical),
    ]);
    let drives = [DriveReset::Azimuth, DriveReset::Elevation, DriveReset::Polarization];
    prop_oneof![
        (name(), prop::option::of(polarity)).prop_filter_map("a position", |(name, polarity)| {
            AutoMove::satellite(name, polarity).ok().map(Motion::AutoMove)
        }),
        any::<(u16, u16)>().prop_map(|(az, el)| Motion::AutoMove(AutoMove::position(az, el))),
        (0_u16..=1023).prop_map(|units| {
            Motion::AutoMove(AutoMove::polarization(PolarizationUnits::new(units).unwrap()))
        }),
        (directions, speeds, 150_u64..=9999).prop_map(|(direction, speed, ms)| {
            Motion::Jog(Jog::new(direction, speed, Duration::from_millis(ms)).unwrap())
        }),
        turns.prop_map(Motion::Polarization),
        prop::sample::select(drives.to_vec()).prop_map(Motion::ResetDrive),
        Just(Motion::RestartTracking),
    ]
}

fn request() -> impl Strategy<Value = Request> {
    prop_oneof![
        Just(Request::Query(Query::DeviceType)),
        Just(Request::Query(Query::Status)),
        (1_u8..=50).prop_map(|index| {
            Request::Query(Query::SatelliteName(NameIndex::new(index).unwrap()))
        }),
        Just(Request::Stop),
        motion().prop_map(Request::Motion),
        any::<bool>().prop_map(|is_on| Request::Setting(Setting::AutoPolarization(is_on))),
        prop_oneof![Just(Band::C), Just(Band::K)]
            .prop_map(|band| Request::Setting(Setting::Band(band))),
    ]
}

/// Draws bytes that occur in frames, to reach every branch.
fn likely_bytes() -> impl Strategy<Value = Vec<u8>> {
    let likely = prop_oneof![
        4 => prop::sample::select(vec![0x02_u8, 0x03, 0x06, 0x15, 0x31, 0x32, 0x33, 0x46]),
        3 => 0x20_u8..0x80,
        1 => any::<u8>(),
    ];
    prop::collection::vec(likely, 0..200)
}

/// Draws whole frames and noise, as on a line.
fn stream() -> impl Strategy<Value = Vec<u8>> {
    let piece = prop_oneof![
        request().prop_map(|request| request.to_bytes(Address::FACTORY)),
        any::<[u8; 33]>().prop_map(|data| status_frame(Address::FACTORY, data)),
        likely_bytes(),
    ];
    prop::collection::vec(piece, 0..8).prop_map(|pieces| pieces.concat())
}

/// Returns a frame with a correct checksum around any 33 characters.
fn status_frame(address: Address, data: [u8; 33]) -> Vec<u8> {
    let mut bytes = vec![0x06, address.number(), 0x31];
    bytes.extend(data.map(|byte| 0x20 + byte % 0x60));
    bytes.push(0x03);
    bytes.push(checksum(&bytes));
    bytes
}

fn decode(bytes: &[u8], pieces: usize) -> (Vec<Result<Frame, FrameError>>, u64) {
    let mut decoder = Decoder::new(Address::FACTORY);
    let mut seen = Vec::new();
    for piece in bytes.chunks(pieces) {
        decoder.push(piece);
        seen.extend(decoder.by_ref());
    }
    seen.extend(decoder.line_is_quiet());
    (seen, decoder.skipped_bytes())
}

proptest! {
    #[test]
    fn any_bytes_are_harmless(pieces in prop::collection::vec(any::<Vec<u8>>(), 0..20)) {
        let mut decoder = Decoder::new(Address::FACTORY);
        for piece in pieces {
            decoder.push(&piece);
            for frame in decoder.by_ref().flatten() {
                let _ = (Reply::parse(&frame), Request::parse(&frame));
            }
        }
        decoder.line_is_quiet();
        prop_assert_eq!(decoder.next(), None);
    }

    #[test]
    fn pieces_make_no_difference(stream in stream(), piece in 1_usize..60) {
        prop_assert_eq!(decode(&stream, piece), decode(&stream, 500));
    }

    #[test]
    fn every_byte_is_either_in_a_frame_or_skipped(stream in stream()) {
        let (seen, skipped) = decode(&stream, 500);
        let framed: usize = seen.iter().flatten().map(|frame| frame.to_bytes().len()).sum();
        prop_assert_eq!(framed as u64 + skipped, stream.len() as u64);
        for frame in seen.into_iter().flatten() {
            prop_assert_eq!(checksum(&frame.to_bytes()), 0);
            let _ = (Reply::parse(&frame), Request::parse(&frame));
        }
    }

    #[test]
    fn every_request_comes_back(request in request(), address in address()) {
        let bytes = request.to_bytes(address);
        prop_assert!(bytes.len() <= MAX_COMMAND_BYTES && bytes.is_ascii());
        let mut decoder = Decoder::new(address);
        decoder.push(&bytes);
        prop_assert_eq!(Request::parse(&decoder.next().unwrap().unwrap()), Ok(request));
    }

    #[test]
    fn any_status_comes_back(data in any::<[u8; 33]>(), address in address()) {
        let mut decoder = Decoder::new(address);
        decoder.push(&status_frame(address, data));
        let reply = Reply::parse(&decoder.next().unwrap().unwrap()).unwrap();
        decoder.push(&reply.to_frame(address).to_bytes());
        prop_assert_eq!(Reply::parse(&decoder.next().unwrap().unwrap()), Ok(reply));
    }

    #[test]
    fn one_wrong_bit_is_never_another_message(
        request in request(),
        data in any::<[u8; 33]>(),
        address in address(),
        at in any::<prop::sample::Index>(),
    ) {
        for good in [request.to_bytes(address), status_frame(address, data)] {
            let mut bad = good.clone();
            let bit = at.index(good.len() * 8);
            bad[bit / 8] ^= 1 << (bit % 8);
            let mut decoder = Decoder::new(address);
            decoder.push(&bad);
            // The decoder describes this only exception.
            let is_offline = bad[0] == 0x06 && bad[3] == b'F' && bad[4] == 0x03;
            for frame in decoder.by_ref().flatten() {
                // Damage may shorten a command. The length check then refuses it.
                prop_assert!(Request::parse(&frame).is_err());
                let is_refusal = matches!(Reply::parse(&frame), Err(ReplyError::Echo { .. }));
                prop_assert!(is_refusal || is_offline, "{frame:?}");
            }
        }
    }

    #[test]
    fn software_parity_is_transparent(stream in stream()) {
        let seven_bits: Vec<u8> = stream.iter().map(|byte| byte & 0x7f).collect();
        let mut bytes = seven_bits.clone();
        Parity::Software.prepare(&mut bytes);
        prop_assert!(bytes.iter().all(|byte| byte.count_ones().is_multiple_of(2)));
        Parity::Software.check(&mut bytes);
        prop_assert_eq!(bytes, seven_bits);
    }
}
