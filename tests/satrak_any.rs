//! Satrak codec on any input.

use azel::protocol::satrak::*;
use jiff::Timestamp;
use proptest::option;
use proptest::prelude::*;

fn decode(bytes: &[u8]) -> Vec<Result<Frame, FrameError>> {
    let mut decoder = Decoder::new();
    decoder.push(bytes);
    decoder.collect()
}

fn text() -> impl Strategy<Value = TextValue> {
    "[!-~ ]{1,40}".prop_filter_map("not carried", |text| TextValue::new("text", &text).ok())
}

fn password() -> impl Strategy<Value = Password> {
    text().prop_map(|text| Password::new(text.as_str()).unwrap())
}

fn moment() -> impl Strategy<Value = Timestamp> {
    // The years 2000 to 2099.
    (946_684_800_i64..4_102_444_800).prop_map(|second| Timestamp::from_second(second).unwrap())
}

fn motion() -> impl Strategy<Value = Motion> {
    let angle = |least: f64, most: f64| option::of(least..most);
    prop_oneof![
        (-100.0..100.0, -100.0..100.0)
            .prop_filter_map("still", |(x, y)| Move::new(x, y).ok().map(Motion::Move)),
        (-180.0..180.0, -180.0..180.0)
            .prop_filter_map("still", |(x, y)| Step::new(x, y).ok().map(Motion::Step)),
        (angle(0.0, 360.0), angle(-10.0, 90.0)).prop_filter_map("still", |(az, el)| Goto::new(
            az, el
        )
        .ok()
        .map(Motion::Goto)),
        Just(Motion::TrackOn),
        Just(Motion::AutoTrackOn),
    ]
}

fn settings() -> impl Strategy<Value = SettingsRequest> {
    let offset = || option::of(-10.0..10.0);
    let elevation = || option::of(0.0..90.0);
    let numbers = (offset(), offset(), elevation(), option::of(-360.0..360.0), elevation());
    let times = (option::of(-3_600_000_i64..=3_600_000), option::of(0_i64..=3_600_000));
    let choices = (
        option::of(any::<bool>()),
        option::of((0_i64..2).prop_map(PositionBase::from_code)),
        option::of((0_i64..3).prop_map(SspaMode::from_code)),
        option::of((0_i64..4).prop_map(SspaAutoRule::from_code)),
    );
    (numbers, times, choices).prop_filter_map("no change", |(numbers, times, choices)| {
        let change = SettingsChange {
            rtc_from_gps: choices.0,
            time_offset_ms: times.0,
            az_offset_deg: numbers.0,
            el_offset_deg: numbers.1,
            lead_ms: times.1,
            position_base: choices.1,
            minimum_elevation_deg: numbers.2,
            north_offset_deg: numbers.3,
            sspa: choices.2,
            sspa_auto: choices.3,
            elevation_threshold_deg: numbers.4,
        };
        SettingsRequest::new(&change).ok()
    })
}

fn angles() -> impl Strategy<Value = AngleChange> {
    let angles =
        || (-360.0..360.0, -360.0..360.0).prop_map(|(x, y)| SensorAngles::new(x, y).unwrap());
    prop_oneof![
        angles().prop_map(AngleChange::PresentPosition),
        (any::<u16>(), any::<u16>(), angles()).prop_map(|(x_sensor, y_sensor, angles)| {
            AngleChange::Given { x_sensor, y_sensor, angles }
        }),
    ]
}

fn sources() -> impl Strategy<Value = Setting> {
    prop_oneof![
        (text(), text(), any::<u16>(), any::<bool>()).prop_map(
            |(file, name, period, continue_tracking)| {
                Setting::Satellite(SatelliteChoice { file, name, period, continue_tracking })
            }
        ),
        (text(), any::<u16>(), any::<bool>(), any::<bool>()).prop_map(
            |(url, period_days, continue_on_error, continue_tracking)| {
                let url = UrlValue::new(url.as_str()).unwrap();
                Setting::SatelliteHttp(HttpTle {
                    url,
                    period_days,
                    continue_on_error,
                    continue_tracking,
                })
            }
        ),
        (
            (text(), text(), password(), any::<u16>()),
            option::of((text(), text())),
            any::<u16>(),
            any::<bool>()
        )
            .prop_map(
                |((address, user, password, port), chosen, period_days, continue_on_error)| {
                    let selection =
                        chosen.map(|(file, satellite)| TleSelection { file, satellite });
                    Setting::SatelliteFtp(FtpTle {
                        address,
                        user,
                        password,
                        port,
                        selection,
                        period_days,
                        continue_on_error,
                    })
                }
            ),
    ]
}

fn setting() -> impl Strategy<Value = Setting> {
    prop_oneof![
        moment().prop_map(|time| Setting::Time(ClockTime::new(time).unwrap())),
        (moment(), moment()).prop_filter_map("order", |(start, stop)| {
            TrackWindow::new(start, stop).ok().map(Setting::StartStopTime)
        }),
        settings().prop_map(Setting::Settings),
        angles().prop_map(Setting::AngleSettings),
        Just(Setting::RtcReupdate),
        // Azel sends positions with two decimals.
        (any::<bool>(), -9000_i32..=9000, -18000_i32..=18000).prop_map(|(automatic, lat, lon)| {
            let position = Position::new(f64::from(lat) / 100.0, f64::from(lon) / 100.0).unwrap();
            Setting::GpsSettings(GpsSettingsChange { automatic, position })
        }),
        sources(),
        text().prop_map(Setting::LoadImage),
        (0.001..1e6, 0.001..1e6)
            .prop_map(|(x, y)| Setting::Reduction(Reduction::new(x, y).unwrap())),
    ]
}

fn request() -> impl Strategy<Value = Request> {
    prop_oneof![
        (0..Query::ALL.len()).prop_map(|at| Request::Query(Query::ALL[at].0)),
        prop_oneof![Just(Halt::Stop), Just(Halt::TrackOff), Just(Halt::AutoTrackOff)]
            .prop_map(Request::Halt),
        motion().prop_map(Request::Motion),
        setting().prop_map(Request::Setting),
    ]
}

/// Draws payloads that begin like the unit's.
fn payload() -> impl Strategy<Value = String> {
    let word = (0..Word::ALL.len()).prop_map(|at| Word::ALL[at].name());
    let value = prop_oneof!["[0-9.+-]{0,6}", "[ -~]{0,8}", Just("ERR".into()), Just("OK".into())];
    (word, "[?=]", prop::collection::vec(value, 0..24))
        .prop_map(|(word, sign, values)| format!("{word}{sign},{}", values.join(",")))
}

proptest! {
    #[test]
    fn any_bytes_are_harmless(pieces in prop::collection::vec(any::<Vec<u8>>(), 0..20)) {
        let mut decoder = Decoder::new();
        for piece in pieces {
            decoder.push(&piece);
            for frame in decoder.by_ref().flatten() {
                let _ = Reply::parse(&frame);
                let _ = Request::parse(&frame);
            }
        }
    }

    #[test]
    fn any_payload_is_harmless(payload in payload()) {
        for frame in decode(&encode(&payload)).into_iter().flatten() {
            let _ = Reply::parse(&frame);
            let _ = Request::parse(&frame);
        }
    }

    #[test]
    fn pieces_make_no_difference(payloads in prop::collection::vec(payload(), 0..4), cut in 1_usize..50) {
        let stream: Vec<u8> = payloads.iter().flat_map(|payload| encode(payload)).collect();
        let mut decoder = Decoder::new();
        let mut seen = Vec::new();
        for piece in stream.chunks(cut) {
            decoder.push(piece);
            seen.extend(decoder.by_ref());
        }
        prop_assert_eq!(seen, decode(&stream));
    }

    #[test]
    fn every_request_comes_back(request in request()) {
        let frames = decode(&request.to_bytes());
        prop_assert_eq!(frames.len(), 1);
        let frame = frames[0].as_ref().unwrap();
        prop_assert!(frame.oddities().is_empty());
        prop_assert_eq!(frame.command(), Some((request.word(), request.verb())));
        prop_assert_eq!(Request::parse(frame).unwrap(), request);
    }

    #[test]
    fn one_wrong_byte_is_never_another_message(
        request in request(),
        at in any::<prop::sample::Index>(),
        byte in any::<u8>(),
    ) {
        let good = request.to_bytes();
        let sent = decode(&good).remove(0).unwrap();
        let mut bad = good.clone();
        bad[at.index(good.len())] = byte;
        for frame in decode(&bad).into_iter().flatten() {
            // A dollar sign in the middle starts a shorter message, which the checksum accepts
            // once in 256 times.
            let is_tail = frame.line().len() < sent.line().len() && byte == b'$';
            prop_assert!(is_tail || frame.line() == sent.line(), "{frame:?}");
        }
    }

    #[test]
    fn no_debug_text_holds_the_password(user in text(), password in "[a-zA-Z0-9]{12}") {
        let source = FtpTle {
            address: TextValue::new("address", "10.0.1.2").unwrap(),
            user,
            password: Password::new(&password).unwrap(),
            port: 21,
            selection: None,
            period_days: 1,
            continue_on_error: false,
        };
        let request = Request::Setting(Setting::SatelliteFtp(source));
        let shown = format!("{request:?}");
        prop_assert!(!shown.contains(&password));
        let frame = decode(&request.to_bytes()).remove(0).unwrap();
        let shown = format!("{frame:?} {}", frame.redacted());
        prop_assert!(!shown.contains(&password));
        // A refused line shows no secret either, wherever it is cut.
        let bytes = request.to_bytes();
        for from in 0..bytes.len() {
            for broken in decode(&bytes[from..]).into_iter().filter_map(Result::err) {
                let shown = format!("{broken:?} {broken}");
                prop_assert!(!shown.contains(&password));
            }
        }
    }
}
