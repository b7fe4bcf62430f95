//! Byte-exact vectors of the Rotator Genius protocol, each in one piece and in many.

use azel::protocol::rotator_genius::*;
use serde_json::{Value, json};

struct Vector {
    id: String,
    bytes: Vec<u8>,
    is_idle_after: bool,
    messages: Value,
    rest: Vec<u8>,
    skipped: Vec<u8>,
}

fn vectors() -> Vec<Vector> {
    let json: Value = serde_json::from_str(include_str!("vectors/genius.json")).unwrap();
    let bytes = |hex: &Value| -> Vec<u8> {
        let pairs = hex.as_str().unwrap().as_bytes().chunks(2);
        pairs
            .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap())
            .collect()
    };
    let vectors = json.as_array().unwrap().iter();
    vectors
        .map(|vector| Vector {
            id: vector["id"].as_str().unwrap().to_owned(),
            bytes: bytes(&vector["hex"]),
            is_idle_after: vector["idle_after"].as_bool().unwrap(),
            messages: vector["messages"].clone(),
            rest: bytes(&vector["rest"]),
            skipped: bytes(&vector["skipped"]),
        })
        .collect()
}

/// Returns a reply in the terms of the vectors.
fn described(reply: &Reply) -> Value {
    match reply {
        Reply::Status(status) => json!(["h", {
            "layout": match status.layout {
                Layout::Wide => "wide72",
                Layout::Narrow => "narrow64",
            },
            "hdr": if status.panic.is_some() { 4 } else { 3 },
            "active": char::from(status.active).to_string(),
            "panic": status.panic,
            "r1": rotator(status.rotator(RotatorNumber::One)),
            "r2": rotator(status.rotator(RotatorNumber::Two)),
        }]),
        Reply::Acknowledgement { request: to, is_accepted } => {
            let verdict = if *is_accepted { "ok" } else { "failed" };
            match to {
                Acknowledgement::GoTo { target } => {
                    json!(["A", verdict, target.map(WholeDegrees::degrees)])
                }
                Acknowledgement::RotateClockwise => json!(["P", verdict]),
                Acknowledgement::RotateCounterClockwise => json!(["M", verdict]),
                Acknowledgement::Stop => json!(["S", verdict]),
                Acknowledgement::Configure => json!(["c", verdict]),
            }
        }
    }
}

fn rotator(rotator: &Rotator) -> Value {
    let degrees = |angle: Option<WholeDegrees>| angle.map(WholeDegrees::degrees);
    json!({
        "az": degrees(rotator.position.ok()),
        "az_note": match rotator.position {
            Ok(_) => "",
            Err(NoPosition::NoSensor) => "absent",
            Err(NoPosition::Blank) => "blank",
            Err(NoPosition::OutOfRange) => "range",
            Err(NoPosition::NotANumber) => "garbage",
        },
        "cw": degrees(rotator.limit_cw),
        "ccw": degrees(rotator.limit_ccw),
        "cfg": char::from(rotator.kind.letter()).to_string(),
        "moving": match rotator.moving {
            Moving::Stopped => "stop",
            Moving::Clockwise => "cw",
            Moving::CounterClockwise => "ccw",
        },
        "offset": rotator.offset_deg,
        "target": degrees(rotator.target),
        "start": degrees(rotator.start),
        "outside_limits": rotator.is_outside_limits,
        "name": rotator.name,
    })
}

fn decode(decoder: &mut Decoder, bytes: &[u8], piece: usize) -> Vec<Received> {
    let mut seen = Vec::new();
    for piece in bytes.chunks(piece) {
        decoder.push(piece);
        seen.extend(decoder.by_ref());
    }
    seen
}

#[test]
fn every_vector_gives_its_messages_whole_and_in_pieces() {
    let vectors = vectors();
    assert_eq!(vectors.len(), 16);
    for Vector { id, bytes, is_idle_after, messages, rest, skipped } in vectors {
        for piece in [usize::MAX, 1, 2, 5, 37] {
            let mut decoder = Decoder::new();
            let mut seen = decode(&mut decoder, &bytes, piece);
            assert!(is_idle_after || decoder.unfinished_bytes() == rest.len(), "{id} {piece}");
            if rest.is_empty() {
                // Without remaining bytes, this adds only unfinished noise.
                seen.extend(decoder.idle());
            }
            assert!(bytes.ends_with(&rest), "{id}");
            let mut replies = Vec::new();
            let mut noise = Vec::new();
            for received in seen {
                match received {
                    Received::Reply(reply) => replies.push(described(&reply)),
                    Received::Noise(run) => noise.push(run),
                    other => panic!("{id} {piece}: {other:?}"),
                }
            }
            assert_eq!(Value::from(replies), messages, "{id} {piece}");
            // The decoder resyncs at most once and reports every byte of it.
            assert!(noise.len() <= 1, "{id} {piece}");
            assert_eq!(noise.concat(), skipped, "{id} {piece}");
        }
    }
}

#[test]
fn all_vectors_in_one_stream_lose_nothing() {
    // All vectors except broken ones and those that need silence or the other form.
    let kept = ["G01", "G02", "G03", "G09", "G10", "G11", "G13", "G15", "G17", "G18", "G20"];
    let kept: Vec<_> =
        vectors().into_iter().filter(|vector| kept.contains(&vector.id.as_str())).collect();
    let stream: Vec<u8> = kept.iter().flat_map(|vector| vector.bytes.clone()).collect();
    let messages: Vec<Value> =
        kept.iter().flat_map(|vector| vector.messages.as_array().unwrap().clone()).collect();
    for piece in [usize::MAX, 1, 2, 5, 37] {
        let seen = decode(&mut Decoder::new(), &stream, piece);
        let replies = seen.iter().filter_map(|received| match received {
            Received::Reply(reply) => Some(described(reply)),
            _ => None,
        });
        assert_eq!(replies.collect::<Vec<_>>(), messages, "{piece}");
    }
}

#[test]
fn every_request_has_its_exact_bytes() {
    use RotatorNumber::{One, Two};
    let angle = |degrees| WholeDegrees::new(degrees).unwrap();
    let go_to =
        |rotator, degrees| Request::Motion(Motion::GoTo { rotator, target: angle(degrees) });
    let rotate = |rotator, direction| Request::Motion(Motion::Rotate { rotator, direction });
    let configuration = Configuration::new(
        One,
        [angle(30), angle(300)],
        RotatorKind::Azimuth,
        0,
        RotatorName::new("TOW1").unwrap(),
    );
    for (id, request, bytes) in [
        ("R01", Request::Read, &[0x7c, 0x68][..]),
        ("R02", go_to(One, 42), &[0x7c, 0x41, 0x31, 0x30, 0x34, 0x32]),
        ("R03", go_to(Two, 158), &[0x7c, 0x41, 0x32, 0x31, 0x35, 0x38]),
        ("R04", go_to(One, 360), &[0x7c, 0x41, 0x31, 0x33, 0x36, 0x30]),
        ("R05", go_to(One, 0), &[0x7c, 0x41, 0x31, 0x30, 0x30, 0x30]),
        ("R06", rotate(One, Direction::Clockwise), &[0x7c, 0x50, 0x31]),
        ("R07", rotate(Two, Direction::CounterClockwise), &[0x7c, 0x4d, 0x32]),
        ("R08", Request::Stop, &[0x7c, 0x53]),
        (
            "R09",
            Request::Configure(configuration.unwrap()),
            &[
                0x7c, 0x63, 0x31, 0x30, 0x33, 0x30, 0x33, 0x30, 0x30, 0x41, 0x30, 0x30, 0x54, 0x4f,
                0x57, 0x31, 0x20, 0x20, 0x20, 0x20, 0x20, 0x20,
            ],
        ),
    ] {
        assert_eq!(request.to_bytes(), bytes, "{id}");
        assert_eq!(Request::parse(bytes), Ok(request), "{id}");
    }
}
