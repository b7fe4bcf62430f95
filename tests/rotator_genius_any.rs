//! Rotator Genius codec on any input.

use azel::protocol::rotator_genius::*;
use proptest::prelude::*;

/// Returns everything decoded from a stream in pieces, to its end.
fn decode<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Received> {
    let mut decoder = Decoder::new();
    let mut seen = Vec::new();
    for piece in pieces {
        decoder.push(piece);
        seen.extend(decoder.by_ref());
    }
    seen.extend(decoder.idle());
    seen
}

/// Draws bytes of replies, of requests and of neither.
fn stretch() -> impl Strategy<Value = Vec<u8>> {
    let number = || prop_oneof!["[0-9]{3}", " {0,2}[0-9]", Just("999".to_owned())];
    let rotator = |name: usize, offset: usize| {
        let numbers = (number(), number(), number(), number(), number());
        let marks = ("[AE]", "[0-2]", "[ -~]{4}", "[\0\x0101?]", "[ -~]{12}");
        (numbers, marks).prop_map(move |((az, cw, ccw, target, start), marks)| {
            let (kind, moving, degrees, limit, text) = marks;
            let degrees = &degrees[..offset];
            let text = &text[..name];
            format!(
                "{az:>3}{cw:>3}{ccw:>3}{kind}{moving}{degrees}{target:>3}{start:>3}{limit}{text}"
            )
        })
    };
    let status = |name, offset| {
        (rotator(name, offset), rotator(name, offset), "[02]", "[\0\x07]").prop_map(
            |(one, two, active, panic)| format!("|h{active}{panic}{one}{two}").into_bytes(),
        )
    };
    prop_oneof![
        4 => status(12, 4),
        2 => status(10, 2),
        2 => "\\|[APMSch][KF]".prop_map(String::into_bytes),
        1 => "\\|A[0-9 ]{3}[KF]".prop_map(String::into_bytes),
        1 => "[|hVASK0-9 ]{0,20}".prop_map(String::into_bytes),
        1 => any::<Vec<u8>>(),
    ]
}

fn stream() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(stretch(), 0..8).prop_map(|stretches| stretches.concat())
}

fn angle() -> impl Strategy<Value = WholeDegrees> {
    (0..=360_u16).prop_map(|degrees| WholeDegrees::new(degrees).unwrap())
}

fn number() -> impl Strategy<Value = RotatorNumber> {
    prop::sample::select(RotatorNumber::ALL.to_vec())
}

fn request() -> impl Strategy<Value = Request> {
    let direction = prop::sample::select(vec![Direction::Clockwise, Direction::CounterClockwise]);
    let kind = prop::sample::select(vec![RotatorKind::Azimuth, RotatorKind::Elevation]);
    let name = "[!-~¡-ÿ][ -~¡-ÿ]{0,8}[!-~¡-ÿ]".prop_map(|name| RotatorName::new(&name).unwrap());
    prop_oneof![
        Just(Request::Read),
        Just(Request::Stop),
        (number(), angle())
            .prop_map(|(rotator, target)| Request::Motion(Motion::GoTo { rotator, target })),
        (number(), direction).prop_map(|(rotator, direction)| Request::Motion(Motion::Rotate {
            rotator,
            direction
        })),
        (number(), angle(), angle(), kind, 0..=10_u8, name).prop_map(
            |(rotator, cw, ccw, kind, offset, name)| Request::Configure(
                Configuration::new(rotator, [cw, ccw], kind, offset, name).unwrap()
            )
        ),
    ]
}

proptest! {
    #[test]
    fn any_bytes_are_harmless(pieces in prop::collection::vec(any::<Vec<u8>>(), 0..20)) {
        decode(pieces.iter().map(Vec::as_slice));
        for piece in pieces {
            let _ = Request::parse(&piece);
        }
    }

    #[test]
    fn pieces_make_no_difference(
        stream in stream(),
        cuts in prop::collection::vec(any::<prop::sample::Index>(), 0..20),
    ) {
        let mut ends: Vec<usize> = cuts.iter().map(|cut| cut.index(stream.len() + 1)).collect();
        ends.sort_unstable();
        ends.push(stream.len());
        let mut from = 0;
        let pieces = ends.iter().map(|end| &stream[std::mem::replace(&mut from, *end)..*end]);
        let whole = decode([stream.as_slice()]);
        prop_assert_eq!(decode(pieces), whole.clone());
        prop_assert_eq!(decode(stream.chunks(1)), whole);
    }

    #[test]
    fn every_byte_is_a_reply_or_told(stream in stream()) {
        let mut decoder = Decoder::new();
        decoder.push(&stream);
        let mut seen: Vec<_> = decoder.by_ref().collect();
        prop_assume!(decoder.unfinished_bytes() == 0);
        seen.extend(decoder.idle());
        let mut told = 0;
        let mut go_tos = 0;
        for received in seen {
            told += match received {
                Received::Noise(run) => run.len(),
                Received::Reply(Reply::Status(status)) => {
                    let length = match status.layout { Layout::Wide => 71, Layout::Narrow => 63 };
                    length + usize::from(status.panic.is_some())
                }
                Received::Reply(Reply::Acknowledgement { request, .. }) => {
                    go_tos += usize::from(matches!(request, Acknowledgement::GoTo { .. }));
                    3
                }
                Received::LayoutChanged(_) | Received::OtherProtocol => 0,
            };
        }
        // The acknowledgement of a go-to has three bytes, or three more digits.
        let digits = stream.len() - told;
        prop_assert!(digits.is_multiple_of(3) && digits <= 3 * go_tos, "{} of {}", told, stream.len());
    }

    #[test]
    fn every_request_comes_back(request in request()) {
        prop_assert_eq!(Request::parse(&request.to_bytes()), Ok(request));
    }

    #[test]
    fn what_the_protocol_does_not_carry_is_not_built(degrees in any::<f64>()) {
        let built = WholeDegrees::nearest(degrees);
        prop_assert_eq!(built.is_ok(), (0.0..=360.0).contains(&degrees));
        if let Ok(angle) = built {
            prop_assert!((f64::from(angle.degrees()) - degrees).abs() <= 0.5);
        }
    }
}
