//! Byte-exact frames of the RC2000C, each in one piece and in many, with every expected
//! value, and with damage from the line.

use std::time::Duration;

use azel::protocol::{Parity, rc2000c::*};

/// Returns the names and bytes of the vectors.
fn vectors() -> Vec<(&'static str, Vec<u8>)> {
    include_str!("vectors/rc2000c.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let (name, hex) = line.split_once(" | ").unwrap();
            let bytes = hex.split(' ').map(|byte| u8::from_str_radix(byte, 16).unwrap());
            (name, bytes.collect())
        })
        .collect()
}

fn bytes_of(name: &str) -> Vec<u8> {
    vectors().into_iter().find(|(known, _)| *known == name).unwrap_or_else(|| panic!("{name}")).1
}

/// Returns a decoder for the address in the frame.
fn decoder_for(bytes: &[u8]) -> Decoder {
    Decoder::new(Address::new(bytes[1]).unwrap())
}

fn frame_of(name: &str) -> Frame {
    let bytes = bytes_of(name);
    let mut decoder = decoder_for(&bytes);
    decoder.push(&bytes);
    decoder.next().unwrap().unwrap()
}

fn reply(name: &str) -> Reply {
    Reply::parse(&frame_of(name)).unwrap()
}

fn status(name: &str) -> (Command, Status) {
    match reply(name) {
        Reply::Status { command, status } => (command, status),
        other => panic!("{name}: {other:?}"),
    }
}

fn satellite(name: &str) -> SatelliteName {
    SatelliteName::new(name).unwrap()
}

#[test]
fn every_frame_is_whole_in_any_pieces() {
    let vectors = vectors();
    assert_eq!(vectors.len(), 39);
    for (name, bytes) in vectors {
        assert_eq!(checksum(&bytes), 0, "{name}");
        for piece in [1, 2, 3, 7, usize::MAX] {
            let mut decoder = decoder_for(&bytes);
            let mut seen = Vec::new();
            for piece in bytes.chunks(piece) {
                decoder.push(piece);
                seen.extend(decoder.by_ref());
            }
            assert_eq!(seen.len(), 1, "{name}");
            assert_eq!(seen[0].as_ref().unwrap().to_bytes(), bytes, "{name}");
            assert_eq!(decoder.skipped_bytes(), 0, "{name}");
        }
    }
}

/// Returns the requests of the vectors, built from typed values.
fn requests() -> Vec<(&'static str, u8, Request)> {
    let motion = Request::Motion;
    let jog = |direction, speed, ms| {
        let jog = Jog::new(direction, speed, Duration::from_millis(ms)).unwrap();
        motion(Motion::Jog(jog))
    };
    let name = |index| Request::Query(Query::SatelliteName(NameIndex::new(index).unwrap()));
    let to = |polarity| {
        motion(Motion::AutoMove(AutoMove::satellite(satellite("SBS 6"), polarity).unwrap()))
    };
    let turn = |wanted| motion(Motion::Polarization(wanted));
    let reset = |drive| motion(Motion::ResetDrive(drive));
    let half = PolarizationUnits::new(500).unwrap();
    let horizontal = Polarity::Horizontal;
    vec![
        ("A=49 30h type query", 49, Request::Query(Query::DeviceType)),
        ("A=49 31h status", 49, Request::Query(Query::Status)),
        ("A=50 30h type query", 50, Request::Query(Query::DeviceType)),
        ("A=50 31h status", 50, Request::Query(Query::Status)),
        ("32h form1 SBS 6 H", 50, to(Some(horizontal))),
        ("32h form1 SBS 6 blank", 50, to(None)),
        ("32h form2 1525/750", 50, motion(Motion::AutoMove(AutoMove::position(1525, 750)))),
        ("32h form3 pol 500", 50, motion(Motion::AutoMove(AutoMove::polarization(half)))),
        ("33h jog CCW slow 0450", 50, jog(Direction::CounterClockwise, Speed::Slow, 450)),
        ("33h jog CW fast 0900", 50, jog(Direction::Clockwise, Speed::Fast, 900)),
        ("33h jog up slow 0300", 50, jog(Direction::Up, Speed::Slow, 300)),
        ("33h jog down fast 1500", 50, jog(Direction::Down, Speed::Fast, 1500)),
        ("33h stop", 50, Request::Stop),
        ("34h pol C", 50, turn(PolarizationMove::JogClockwise)),
        ("34h pol W", 50, turn(PolarizationMove::JogCounterClockwise)),
        ("34h pol H", 50, turn(PolarizationMove::ToStored(horizontal))),
        ("34h pol V", 50, turn(PolarizationMove::ToStored(Polarity::Vertical))),
        ("35h name 01", 50, name(1)),
        ("35h name 35", 50, name(35)),
        ("36h misc RA", 50, reset(DriveReset::Azimuth)),
        ("36h misc RE", 50, reset(DriveReset::Elevation)),
        ("36h misc RP", 50, reset(DriveReset::Polarization)),
        ("36h misc PN", 50, Request::Setting(Setting::AutoPolarization(true))),
        ("36h misc PF", 50, Request::Setting(Setting::AutoPolarization(false))),
        ("36h misc TR", 50, motion(Motion::RestartTracking)),
        ("36h misc TC", 50, Request::Setting(Setting::Band(Band::C))),
        ("36h misc TK", 50, Request::Setting(Setting::Band(Band::K))),
    ]
}

#[test]
fn every_command_has_its_bytes_and_is_read_back() {
    for (name, address, request) in requests() {
        let bytes = request.to_bytes(Address::new(address).unwrap());
        assert_eq!(bytes, bytes_of(name), "{name}");
        assert!(bytes.len() <= MAX_COMMAND_BYTES);
        assert_eq!(Request::parse(&frame_of(name)), Ok(request), "{name}");
        let echo = ReplyError::Echo { code: request.command().code() };
        assert_eq!(Reply::parse(&frame_of(name)), Err(echo), "{name}");
    }
    let sent = vectors().iter().filter(|(_, bytes)| bytes[0] == 2).count();
    assert_eq!(requests().len() + 1, sent, "all but the unknown command");
    assert_eq!(
        Request::parse(&frame_of("bad unknown cmd 3Fh")),
        Err(RequestError::UnknownCode(0x3f))
    );
}

#[test]
fn device_types_and_exceptions_are_told_apart() {
    let device = |mount, version| Reply::DeviceType(DeviceType { mount, version });
    let expected = [
        ("30h reply 2KCA 14", device(MountKind::ElevationOverAzimuth, *b"14")),
        ("30h reply 2KCP13", device(MountKind::Polar, *b"13")),
        ("offline reply to 31h", Reply::Offline { code: 0x31 }),
        ("NAK to 32h", Reply::Refused { code: 0x32 }),
        ("NAK to 3Fh", Reply::Refused { code: 0x3f }),
        (
            "35h reply 01/12 SBS 6",
            Reply::SatelliteName(NameEntry { index: 1, count: 12, name: satellite("SBS 6") }),
        ),
    ];
    for (name, expected) in expected {
        assert_eq!(reply(name), expected, "{name}");
        assert_eq!(expected.to_frame(Address::FACTORY).to_bytes(), bytes_of(name), "{name}");
    }
    assert_eq!(
        reply("30h reply 2KCA 14"),
        Reply::parse(&decode_one(b"\x06\x32\x31\x32\x4b\x43\x41\x31\x34\x03\x78")).unwrap(),
        "the code in the reply may be wrong"
    );
}

fn decode_one(bytes: &[u8]) -> Frame {
    let mut decoder = decoder_for(bytes);
    decoder.push(bytes);
    decoder.next().unwrap().unwrap()
}

#[test]
fn an_idle_controller_is_read_in_full() {
    let (command, status) = status("S1 idle counts");
    assert_eq!(command, Command::Status);
    let code = PolarizationCode::Horizontal;
    let expected = Status {
        satellite: satellite("SBS 6"),
        name_display: NameDisplay::OnSatellite,
        azimuth: Position::Counts(1525),
        elevation: Position::Counts(750),
        feed: FeedReading {
            device: PolarizationDevice::Polarotor,
            position: FeedPosition::Shown(39),
            fine_steps: 3,
        },
        polarization_mode: Some(PolarizationMode { code, is_automatic: false }),
        azimuth_drive: AxisDrive::Still,
        elevation_drive: AxisDrive::Still,
        polarization_motion: PolarizationMotion::Still,
        alarm: Alarm::None,
        track: Some(Track { band: TrackBand::C, submode: Submode::Off }),
        receiver: Some(Receiver {
            channel: ReceiverChannel::One,
            agc: 635,
            allows_polarization: false,
        }),
    };
    assert_eq!(status, expected);
    assert_eq!(status.feed.units(), Some(263));
    assert!(!status.is_moving());
}

#[test]
fn an_auto_move_from_a_limit_is_read_in_full() {
    let (command, status) = status("S2 az CCW limit, el automove, rot feed");
    assert_eq!(command, Command::AutoMove);
    assert!(status.satellite.is_blank());
    assert_eq!(status.name_display, NameDisplay::Hidden);
    assert_eq!(status.azimuth, Position::Limit(LimitEnd::CounterClockwise));
    assert_eq!(status.elevation, Position::Counts(546));
    assert_eq!(status.azimuth_drive, AxisDrive::Still);
    assert_eq!(status.elevation_drive, AxisDrive::AutoMove);
    let code = PolarizationCode::None;
    assert_eq!(status.polarization_mode, Some(PolarizationMode { code, is_automatic: true }));
    assert_eq!(status.feed.device, PolarizationDevice::RotatingFeed);
    assert_eq!(status.feed.units(), Some(500));
    assert!(status.is_moving());
}

#[test]
fn tracking_with_angles_is_read_in_full() {
    let (_, status) = status("S3 angle display, track K step");
    assert_eq!(status.satellite, satellite("GSTAR 3"));
    assert_eq!(status.azimuth, Position::TenthsOfDegree(1784));
    assert_eq!(status.elevation, Position::TenthsOfDegree(442));
    assert_eq!(status.polarization_mode.unwrap().code, PolarizationCode::Vertical);
    assert_eq!(status.track, Some(Track { band: TrackBand::K, submode: Submode::Step }));
    let channel = ReceiverChannel::Two;
    let receiver = Receiver { channel, agc: 1023, allows_polarization: true };
    assert_eq!(status.receiver, Some(receiver));
    assert_eq!(frame_of("S3 angle display, track K step").data()[32], 0x7f);
}

#[test]
fn alarms_and_limits_are_read_in_full() {
    let (_, jammed) = status("S4 el DOWN limit alarm, az jammed, alarm 2");
    assert_eq!(jammed.azimuth, Position::Limit(LimitEnd::Clockwise));
    assert_eq!(jammed.elevation, Position::Limit(LimitEnd::Down));
    assert_eq!(jammed.azimuth_drive, AxisDrive::Jammed);
    assert_eq!(jammed.elevation_drive, AxisDrive::Limit);
    assert!(jammed.azimuth_drive.is_alarm() && jammed.elevation_drive.is_alarm());
    assert_eq!(jammed.feed.units(), Some(0));
    assert_eq!(jammed.alarm, Alarm::Azimuth);
    assert_eq!(jammed.track.unwrap().submode, Submode::JammedError);
    assert!(jammed.track.unwrap().submode.is_error());

    let (command, moving) = status("S5 alarm 20 up limit");
    assert_eq!(command, Command::Jog);
    assert_eq!(moving.name_display, NameDisplay::NearSatellite);
    assert_eq!(moving.azimuth, Position::Counts(9999));
    assert_eq!(moving.azimuth_drive, AxisDrive::Moving(Sense::Negative));
    assert_eq!(moving.elevation, Position::Limit(LimitEnd::Up));
    assert_eq!(moving.polarization_motion, PolarizationMotion::JogClockwise);
    assert_eq!(moving.alarm, Alarm::AxisOptions);
}

#[test]
fn a_status_is_written_as_it_was_read() {
    for (name, bytes) in vectors() {
        if name.starts_with('S') {
            let (command, status) = status(name);
            let frame = Reply::Status { command, status }.to_frame(Address::FACTORY);
            let read = Reply::parse(&decode_one(&frame.to_bytes())).unwrap();
            assert_eq!(read, Reply::Status { command, status }, "{name}");
            assert_eq!(frame.to_bytes().len(), bytes.len(), "{name}");
        }
    }
}

#[test]
fn every_single_wrong_bit_is_refused() {
    for (name, good) in vectors() {
        for at in 0..good.len() * 8 {
            let mut bad = good.clone();
            bad[at / 8] ^= 1 << (at % 8);
            let mut decoder = decoder_for(&good);
            decoder.push(&bad);
            let mut seen: Vec<_> = decoder.by_ref().collect();
            seen.extend(decoder.line_is_quiet());
            assert!(seen.iter().all(Result::is_err), "{name}: bit {at}: {seen:?}");
            // The damage does not cost the next frame.
            decoder.push(&bad);
            decoder.push(&good);
            let frames: Vec<_> = decoder.flatten().collect();
            assert_eq!(frames.len(), 1, "{name}: bit {at}");
            assert_eq!(frames[0].to_bytes(), good, "{name}: bit {at}");
        }
    }
}

#[test]
fn every_frame_cut_short_is_given_up_when_the_line_is_quiet() {
    for (name, good) in vectors() {
        for length in 2..good.len() {
            let mut decoder = decoder_for(&good);
            decoder.push(&good[..length]);
            assert_eq!(decoder.next(), None, "{name}: {length}");
            let seen = decoder.line_is_quiet();
            assert_eq!(seen, [Err(FrameError::Incomplete { bytes: length })], "{name}");
            decoder.push(&good);
            assert!(decoder.next().unwrap().is_ok(), "{name}: {length}");
        }
    }
}

#[test]
fn frames_back_to_back_all_come_out() {
    let ours: Vec<_> = vectors().into_iter().filter(|(_, bytes)| bytes[1] == 50).collect();
    let stream: Vec<u8> = ours.iter().flat_map(|(_, bytes)| bytes.clone()).collect();
    let mut decoder = Decoder::new(Address::FACTORY);
    let mut frames = Vec::new();
    for piece in stream.chunks(64) {
        decoder.push(piece);
        frames.extend(decoder.by_ref().map(Result::unwrap));
    }
    let seen: Vec<u8> = frames.iter().flat_map(Frame::to_bytes).collect();
    assert_eq!(seen, stream);
}

#[test]
fn noise_before_a_frame_does_not_lose_it() {
    for (name, good) in vectors() {
        for noise in [&[0x06][..], &[0x15], &[0x02], &[0x06, good[1]], &[0x02, good[1], 0x31]] {
            let mut decoder = decoder_for(&good);
            decoder.push(noise);
            decoder.push(&good);
            let frames: Vec<_> = decoder.flatten().map(|frame| frame.to_bytes()).collect();
            assert_eq!(frames, std::slice::from_ref(&good), "{name}: {noise:02x?}");
        }
    }
}

#[test]
fn our_echo_is_told_from_the_reply_behind_it() {
    // The checksums of these commands look like STX, ETX and ACK.
    for address in [0x32, 0x33, 0x36] {
        let address = Address::new(address).unwrap();
        let request = Request::Query(Query::Status);
        let answer = Reply::Offline { code: 0x31 };
        let mut decoder = Decoder::new(address);
        decoder.push(&request.to_bytes(address));
        decoder.push(&answer.to_frame(address).to_bytes());
        let seen: Vec<_> = decoder.map(|frame| Reply::parse(&frame.unwrap())).collect();
        assert_eq!(seen, [Err(ReplyError::Echo { code: 0x31 }), Ok(answer)]);
    }
}

#[test]
fn software_parity_carries_every_frame_and_breaks_every_wrong_bit() {
    for (name, good) in vectors() {
        let mut sent = good.clone();
        Parity::Software.prepare(&mut sent);
        for at in 0..sent.len() * 8 {
            let mut bad = sent.clone();
            bad[at / 8] ^= 1 << (at % 8);
            Parity::Software.check(&mut bad);
            let mut decoder = decoder_for(&good);
            decoder.push(&bad);
            assert_eq!(decoder.flatten().count(), 0, "{name}: bit {at}");
        }
        Parity::Software.check(&mut sent);
        assert_eq!(sent, good, "{name}");
    }
}
