//! Byte-exact vectors of the Satrak protocol, each in one piece and byte by byte, with
//! every expected value.

use azel::protocol::satrak::*;
use jiff::Timestamp;
use serde_json::Value;

struct Vector {
    id: String,
    is_sent: bool,
    bytes: Vec<u8>,
    tokens: Vec<(String, Value)>,
}

fn vectors() -> Vec<Vector> {
    let json: Value = serde_json::from_str(include_str!("vectors/satrak.json")).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    json.as_array()
        .unwrap()
        .iter()
        .map(|vector| Vector {
            id: text(&vector["id"]),
            is_sent: vector["dir"] == "tx",
            bytes: text(&vector["hex"])
                .as_bytes()
                .chunks(2)
                .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap())
                .collect(),
            tokens: vector["tokens"]
                .as_array()
                .unwrap()
                .iter()
                .map(|token| (text(&token[0]), token[1].clone()))
                .collect(),
        })
        .collect()
}

fn bytes_of(id: &str) -> Vec<u8> {
    vectors().into_iter().find(|vector| vector.id == id).unwrap().bytes
}

fn decode(bytes: &[u8], piece: usize) -> Vec<Result<Frame, FrameError>> {
    let mut decoder = Decoder::new();
    let mut seen = Vec::new();
    for piece in bytes.chunks(piece) {
        decoder.push(piece);
        seen.extend(decoder.by_ref());
    }
    seen
}

fn frame_of(id: &str) -> Frame {
    decode(&bytes_of(id), usize::MAX).remove(0).unwrap()
}

fn parsed(id: &str) -> ParsedReply {
    Reply::parse(&frame_of(id)).unwrap()
}

fn time(text: &str) -> Timestamp {
    text.parse().unwrap()
}

#[test]
fn every_vector_is_cut_into_its_tokens() {
    for Vector { id, bytes, tokens, .. } in vectors() {
        for piece in [1, 2, 3, 7, usize::MAX] {
            let seen = decode(&bytes, piece);
            assert_eq!(seen.len(), tokens.len(), "{id}");
            for (seen, (word, fields)) in seen.iter().zip(&tokens) {
                if word == "DROP" {
                    let error = seen.as_ref().unwrap_err();
                    let is_checksum = matches!(error, FrameError::BadChecksum { .. });
                    assert_eq!(is_checksum, fields.as_str().unwrap().contains("want"), "{id}");
                    continue;
                }
                let frame = seen.as_ref().unwrap();
                assert_eq!(frame.word(), word, "{id}");
                assert_eq!(serde_json::to_value(frame.fields()).unwrap(), *fields, "{id}");
            }
        }
    }
}

/// Returns the requests of the vectors, built from typed values, by the numbers of their vectors.
fn requests() -> Vec<(&'static str, Request)> {
    let text = |text| TextValue::new("text", text).unwrap();
    let motion = Request::Motion;
    let setting = Request::Setting;
    let iridium = || text("iridium.txt");
    let name = || text("IRIDIUM 70 [+]");
    let change = SettingsChange { minimum_elevation_deg: Some(5.0), ..SettingsChange::default() };
    vec![
        ("S02", Request::Query(Query::Status)),
        ("S03", Request::Query(Query::Faults)),
        ("S04", Request::Query(Query::Version)),
        ("S05", Request::Halt(Halt::Stop)),
        ("S06", motion(Motion::Move(Move::new(-3.5, 0.0).unwrap()))),
        ("S07", motion(Motion::Step(Step::new(2.0, 0.0).unwrap()))),
        ("S08", motion(Motion::Goto(Goto::new(Some(125.1), Some(32.6)).unwrap()))),
        ("S09", motion(Motion::Goto(Goto::new(Some(74.61), None).unwrap()))),
        ("S10", motion(Motion::Goto(Goto::new(None, Some(40.5)).unwrap()))),
        ("S11", motion(Motion::TrackOn)),
        ("S12", Request::Halt(Halt::TrackOff)),
        ("S13", Request::Halt(Halt::AutoTrackOff)),
        ("S14", setting(Setting::Time(ClockTime::new(time("2017-03-17T16:43:00Z")).unwrap()))),
        (
            "S15",
            setting(Setting::StartStopTime(
                TrackWindow::new(time("2017-08-11T20:30:00Z"), time("2017-08-11T20:35:00Z"))
                    .unwrap(),
            )),
        ),
        ("S16", setting(Setting::Settings(SettingsRequest::new(&change).unwrap()))),
        (
            "S17",
            setting(Setting::GpsSettings(GpsSettingsChange {
                automatic: false,
                position: Position::new(41.02, 29.17).unwrap(),
            })),
        ),
        (
            "S18",
            setting(Setting::Satellite(SatelliteChoice {
                file: iridium(),
                name: name(),
                period: 1,
                continue_tracking: false,
            })),
        ),
        (
            "S19",
            setting(Setting::SatelliteHttp(HttpTle {
                url: UrlValue::new("https://example.org/tle?a=1,2").unwrap(),
                period_days: 1,
                continue_on_error: true,
                continue_tracking: false,
            })),
        ),
        (
            "S20",
            setting(Setting::SatelliteFtp(FtpTle {
                address: text("10.0.1.2"),
                user: text("username"),
                password: Password::new("password").unwrap(),
                port: 22,
                selection: Some(TleSelection { file: iridium(), satellite: name() }),
                period_days: 1,
                continue_on_error: true,
            })),
        ),
        (
            "S21",
            setting(Setting::AngleSettings(AngleChange::Given {
                x_sensor: 39049,
                y_sensor: 36838,
                angles: SensorAngles::new(160.0, 40.0).unwrap(),
            })),
        ),
        ("S22", setting(Setting::LoadImage(text("sysImage.json")))),
        ("S23", setting(Setting::Reduction(Reduction::new(4000.0, 4000.0).unwrap()))),
        ("S24", setting(Setting::RtcReupdate)),
    ]
}

#[test]
fn everything_sent_is_exact_and_read_back_by_a_unit() {
    let requests = requests();
    let sent: Vec<String> =
        vectors().into_iter().filter(|vector| vector.is_sent).map(|vector| vector.id).collect();
    let built: Vec<&str> = requests.iter().map(|(id, _)| *id).collect();
    assert_eq!(sent, built);
    for (id, request) in requests {
        assert_eq!(request.to_bytes(), bytes_of(id), "{id}");
        let frame = frame_of(id);
        assert_eq!(frame.command(), Some((request.word(), request.verb())), "{id}");
        assert_eq!(Request::parse(&frame), Ok(request), "{id}");
    }
}

#[test]
fn the_remaining_queries_have_the_documents_checksums() {
    for (query, bytes) in [
        (Query::Clock, "$TIME?*2A"),
        (Query::StartStopTime, "$START_STOP_TIME?*72"),
        (Query::Settings, "$SETTINGS?*3A"),
        (Query::AngleSettings, "$ANGLE_SETTINGS?*24"),
        (Query::GpsData, "$GPS_DATA?*34"),
        (Query::TimedPosition, "$TPOS?*27"),
        (Query::GpsSettings, "$GPS_SETTINGS?*21"),
        (Query::Satellite, "$SATELLITE?*64"),
        (Query::SatelliteHttp, "$SATELLITE_HTTP?*23"),
        (Query::SatelliteFtp, "$SATELLITE_FTP?*79"),
        (Query::ImageStatus, "$LOAD_IMAGE?*21"),
        (Query::Reduction, "$REDUCTION?*66"),
    ] {
        assert_eq!(Request::Query(query).to_bytes(), format!("{bytes}\r\n").as_bytes());
    }
}

fn document_status() -> Status {
    Status {
        fault: false,
        az_deg: 299.49,
        el_deg: 34.35,
        limits: Limits::default(),
        tracking_enabled: false,
        track_state: TrackState::NotInTrackTime,
        rtc_from_gps: false,
        gps_lock_delay_s: 0.0,
        x_motion: AxisMotion::Still,
        y_motion: AxisMotion::Still,
        x_deg: 80.0,
        y_deg: 35.0,
        auto_track: Some(true),
    }
}

#[test]
fn status_with_15_16_and_17_fields() {
    for (id, auto_track, notes) in [
        ("S25", Some(true), vec![]),
        ("S26", Some(true), vec![]),
        ("S27", None, vec![Note::MissingFields(1)]),
        ("S29", Some(true), vec![Note::ExtraFields(1)]),
    ] {
        let ParsedReply { word, verb, reply, notes: seen } = parsed(id);
        assert_eq!((word, verb), (Word::Status, Verb::Query), "{id}");
        assert_eq!(reply, Reply::Status(Status { auto_track, ..document_status() }), "{id}");
        assert_eq!(seen, notes, "{id}");
    }
    let count = ReplyError::Count {
        word: Word::Status,
        found: 14,
        min: 15,
        max: 18,
        looks_like_decimal_commas: false,
    };
    assert_eq!(Reply::parse(&frame_of("S30")), Err(count));
}

#[test]
fn faults_of_the_documents_example() {
    let Reply::Faults(faults) = parsed("S32").reply else { panic!("no faults") };
    let states: Vec<_> = faults.iter().map(|(_, state)| state).collect();
    assert_eq!(states[..11], [Some(FaultState::Clear); 11]);
    assert_eq!(states[11..], [None]);
}

#[test]
fn clocks_and_positions_with_time() {
    let Reply::Clock(clock) = parsed("S33").reply else { panic!("no clock") };
    assert_eq!(clock, UnitTime { time: time("2000-01-01T04:35:43Z"), has_milliseconds: false });
    assert!(!clock.is_set());
    let Reply::Clock(clock) = parsed("S34").reply else { panic!("no clock") };
    assert_eq!(clock, UnitTime { time: time("2017-03-17T16:43:00.250Z"), has_milliseconds: true });
    assert!(clock.is_set());
    let position =
        TimedPosition { x_deg: 306.0, y_deg: 48.74, time: time("2017-10-17T15:33:41.818Z") };
    assert_eq!(parsed("S35").reply, Reply::TimedPosition(position));
    let gps = GpsData {
        valid: true,
        position: Some(Position::new(41.01, 29.17).unwrap()),
        time: Some(time("2017-10-19T06:00:02Z")),
    };
    assert_eq!(parsed("S36").reply, Reply::GpsData(gps));
}

#[test]
fn settings_of_the_documents_example() {
    let settings = Settings {
        rtc_from_gps: true,
        time_offset_ms: 100,
        az_offset_deg: 1.0,
        el_offset_deg: 2.0,
        lead_ms: 60_000,
        position_base: PositionBase::Resolver,
        minimum_elevation_deg: 3.0,
        north_offset_deg: 6.0,
        sspa: SspaMode::On,
        sspa_auto: SspaAutoRule::CarrierLock,
        tle_mode: TleMode::Web,
        elevation_threshold_deg: 2.0,
    };
    assert_eq!(parsed("S38").reply, Reply::Settings(settings));
}

#[test]
fn answers_to_settings() {
    let set = |word, reply| ParsedReply { word, verb: Verb::Set, reply, notes: vec![] };
    assert_eq!(parsed("S39"), set(Word::Move, Reply::Done));
    assert_eq!(parsed("S40"), set(Word::Move, Reply::Refused { code: "7".into() }));
    let blank = vec![Note::Oddity(Oddity::BlankBeforeSign)];
    let expected = ParsedReply { notes: blank, ..set(Word::TrackAutoEnable, Reply::Done) };
    assert_eq!(parsed("S42"), expected);
    let line_feed = vec![Note::Oddity(Oddity::LineFeedOnly)];
    assert_eq!(parsed("S49"), ParsedReply { notes: line_feed, ..set(Word::Stop, Reply::Done) });
    assert_eq!(frame_of("S47").oddities(), [Oddity::LowerCaseChecksum]);
}

#[test]
fn texts_keep_their_commas() {
    let version = Version {
        control_unit: "SATRAK CU V1.2 18/10/2017".into(),
        drive_unit: Some("SATRAK DU V1.22 18/10/2017".into()),
        others: vec![],
    };
    assert_eq!(parsed("S43").reply, Reply::Version(version));
    let satellite = Satellite {
        file: "amateur.txt".into(),
        name: "AO-7, OSCAR 7".into(),
        period: 1,
        catalog_number: 7530,
        maximum_elevation_deg: 78.4,
    };
    assert_eq!(parsed("S44").reply, Reply::Satellite(satellite));
    let http = SatelliteHttp {
        url: "https://x.y/z?a=1,2".into(),
        period_days: 3,
        on_error: UpdateErrorAction::Continue,
    };
    assert_eq!(parsed("S45").reply, Reply::SatelliteHttp(http));
}

#[test]
fn a_word_of_another_product_is_data() {
    let frame = frame_of("S01");
    assert_eq!(frame.command(), None);
    assert_eq!(Reply::parse(&frame), Err(ReplyError::UnknownWord("DATETIMEG?=".into())));
}

#[test]
fn every_vector_has_a_meaning_and_its_values_are_explained() {
    for Vector { id, is_sent, bytes, tokens } in vectors() {
        let frames = decode(&bytes, usize::MAX);
        for (frame, (word, _)) in frames.into_iter().zip(tokens) {
            let Ok(frame) = frame else {
                assert_eq!(word, "DROP", "{id}");
                continue;
            };
            let (meaning, values) = if is_sent {
                (Meaning::of_request(&frame), explain_request(&frame))
            } else {
                (Meaning::of_reply(&frame), explain_reply(&frame))
            };
            assert!(!meaning.text.is_empty(), "{id}");
            assert!(!meaning.text.contains("password"), "{id}");
            // The odd vectors are an echoed question, an unknown word, an error, and a status with
            // too few values.
            let is_odd = match meaning.tone {
                Tone::Plain | Tone::Change | Tone::Good => false,
                Tone::Caution | Tone::Bad => true,
            };
            assert_eq!(is_odd, ["S01", "S30", "S40", "S47"].contains(&id.as_str()), "{id}");
            let unknown = values.iter().filter(|value| value.name == "not in the document");
            let expected = match id.as_str() {
                "S01" => 7,
                "S29" => 1,
                _ => 0,
            };
            assert_eq!(unknown.count(), expected, "{id} {values:?}");
        }
    }
}
