//! Connection: Azel sends nothing before the operator's order, then a probe, then questions.

use std::time::Duration;

use azel::{
    contract::driver::{Command, Event, Found, Intent, LinkState, Refusal, StopState},
    device::panel::CheckState,
    sim::rc2000c::{Fault, Mode, Options, Quirk},
    station::{Antenna, LockOut},
};

use super::rig::{Rig, antenna, check, reading, uncalibrated};

#[tokio::test(start_paused = true)]
async fn nothing_is_sent_before_the_operator_wants_it() {
    let mut rig = Rig::start(&Options::default(), &antenna());
    rig.seconds(60.0).await;
    assert_eq!((rig.dials().len(), rig.received().len()), (0, 0));
    assert_eq!(rig.shown().link, LinkState::Off);
    assert_eq!(rig.control.state().mode, Mode::Manual, "the panel is left to who stands there");
    rig.send(Command::Park);
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::PositionUnknown)]);
    assert_eq!(rig.dials().len(), 0);
}

#[tokio::test(start_paused = true)]
async fn where_the_station_file_says_so_it_connects_at_the_start_unless_it_is_locked_out() {
    let antenna = Antenna { connects_at_start: true, ..antenna() };
    let mut rig = Rig::start(&Options::default(), &antenna);
    rig.until_found().await;
    let lock_out = LockOut {
        operator: "Ada".to_owned(),
        reason: "feed off".to_owned(),
        start: "2026-11-22T10:00:00Z".parse().unwrap(),
    };
    let mut rig = Rig::start_locked_out(&antenna, lock_out);
    rig.seconds(60.0).await;
    assert_eq!((rig.dials().len(), rig.received().len()), (0, 0), "its panel is in use");
    assert_eq!(rig.shown().link, LinkState::Off);
}

#[tokio::test(start_paused = true)]
async fn the_first_word_is_who_it_is_and_then_what_it_does() {
    let mut rig = Rig::start(&Options::default(), &antenna());
    rig.send(Command::Connect);
    rig.until_found().await;
    rig.seconds(3.0).await;
    let received = rig.received();
    assert_eq!(received[..3], ["0", "1", "501"]);
    assert_eq!(rig.orders(), [""; 0], "nothing is set and nothing moves");
    let names: Vec<&String> = received.iter().filter(|text| text.starts_with('5')).collect();
    assert_eq!(names, ["501", "502", "503", "504", "505", "506"]);
    let frames = rig.control.received();
    assert_eq!(frames[0].1.to_bytes(), b"\x02\x32\x30\x03\x03");
    assert_eq!(frames[1].1.to_bytes(), b"\x02\x32\x31\x03\x02");
    assert_eq!(frames[2].1.to_bytes(), b"\x02\x32\x3501\x03\x07");

    let shown = rig.shown();
    assert!(matches!(shown.link, LinkState::Up { .. }));
    assert_eq!((shown.intent, shown.stop), (Intent::Standby, StopState::Ready));
    let measured = shown.state.measured.unwrap();
    let direction = measured.direction().unwrap();
    assert!((direction.azimuth_deg() - 164.75).abs() < 1e-9);
    assert!((direction.elevation_deg() - 36.0).abs() < 1e-9);
    assert_eq!(shown.state.motion_lock, Some(false));
    for (label, text) in [
        ("Unit", "2KCA 1.4"),
        ("Satellite", "SBS 6"),
        ("Azimuth", "1525 counts"),
        ("Elevation", "750 counts"),
        ("Polarization", "263 (polarotor)"),
        ("Polarity", "H"),
        ("Automatic polarization", "off"),
        ("Signal", "900, channel 1"),
        ("TRACK", "off, C band"),
        ("Alarm", "none"),
        ("Stored satellites", "SBS 6, GALAXY 5, SATCOM C3, GSTAR 3, TELSTAR 4, ANIK E2"),
    ] {
        assert_eq!(reading(&shown, label).as_deref(), Some(text), "{label}");
    }
    assert!(shown.state.checks.iter().all(|check| check.state == CheckState::Good));
    let measured = shown.state.measured.unwrap();
    assert!(shown.state.checked_at >= Some(measured.time), "read with the position");
    let traffic = shown.state.traffic;
    assert_eq!([traffic.damaged, traffic.unreadable, traffic.unanswered, traffic.odd], [0; 4]);
}

#[tokio::test(start_paused = true)]
async fn the_unit_is_asked_at_the_rates_of_the_station_with_a_gap_between() {
    let mut rig = Rig::in_manual().await;
    let before = rig.times("1").len();
    rig.seconds(10.0).await;
    let at_rest = rig.times("1").len() - before;
    assert!((16..=20).contains(&at_rest), "{at_rest}");
    assert_eq!(rig.shown().poll_period, Duration::from_millis(500));

    rig.send(Command::Position {
        azimuth: Some(azel::astro::Angle::from_degrees(120.0)),
        elevation: None,
    });
    rig.seconds(1.0).await;
    let before = rig.times("1").len();
    rig.seconds(5.0).await;
    let moving = rig.times("1").len() - before;
    assert!((14..=20).contains(&moving), "{moving}");
    let times: Vec<_> = rig.control.received().iter().map(|(at, _)| *at).collect();
    let least = times.windows(2).map(|pair| pair[1] - pair[0]).min().unwrap();
    assert!(least >= Duration::from_millis(50), "{least:?}");
}

#[tokio::test(start_paused = true)]
async fn without_a_calibration_the_direction_is_not_known_and_that_is_told() {
    let mut rig = Rig::connected(&Options::default(), &uncalibrated()).await;
    let shown = rig.shown();
    assert_eq!(shown.state.measured.unwrap().direction(), None);
    assert_eq!(reading(&shown, "Azimuth").as_deref(), Some("1525 counts"));
    assert_eq!(check(&shown, "Calibration"), Some(CheckState::Caution));
    rig.control.set_quirk(Quirk::AngleDisplay, true);
    rig.seconds(1.0).await;
    let direction = rig.shown().state.measured.unwrap().direction().unwrap();
    assert!((direction.elevation_deg() - 36.0).abs() < 0.11, "{direction:?}");
    assert_eq!(reading(&rig.shown(), "Elevation").as_deref(), Some("36.0°"));
}

#[tokio::test(start_paused = true)]
async fn a_unit_whose_remote_mode_is_disabled_is_up_and_says_so() {
    let options =
        Options { faults: [Fault::RemoteDisabled].into_iter().collect(), ..Options::default() };
    let mut rig = Rig::start(&options, &antenna());
    rig.send(Command::Connect);
    rig.seconds(20.0).await;
    let shown = rig.shown();
    assert!(matches!(shown.link, LinkState::Up { .. }), "{:?}", shown.link);
    assert_eq!(shown.state.measured, None);
    assert_eq!(check(&shown, "Remote mode"), Some(CheckState::Fault));
    assert!(rig.received().len() < 60, "it is not asked without a pause");
    assert_eq!(rig.events(), []);
    rig.control.set_fault(Fault::RemoteDisabled, false);
    rig.until_found().await;
    rig.seconds(3.0).await;
    assert_eq!(check(&rig.shown(), "Remote mode"), Some(CheckState::Good));
    assert_eq!(reading(&rig.shown(), "Unit").as_deref(), Some("2KCA 1.4"));
    assert!(reading(&rig.shown(), "Stored satellites").unwrap().ends_with("ANIK E2"));
}

#[tokio::test(start_paused = true)]
async fn disconnecting_leaves_the_unit_alone_and_connecting_comes_back() {
    let mut rig = Rig::in_manual().await;
    rig.send(Command::Disconnect);
    rig.seconds(1.0).await;
    assert_eq!((rig.shown().link.clone(), rig.shown().intent), (LinkState::Off, Intent::Standby));
    let before = rig.received().len();
    rig.seconds(30.0).await;
    assert_eq!(rig.received().len(), before);
    rig.send(Command::Connect);
    rig.until_event(5, |event| *event == Event::Connected(Found::Still)).await;
}

#[tokio::test(start_paused = true)]
async fn an_older_unit_and_one_with_a_wrong_code_are_understood() {
    let quirks = [Quirk::Rc2000a, Quirk::LeftWords, Quirk::TypeCode].into_iter().collect();
    let options = Options { quirks, ..Options::default() };
    let rig = Rig::connected(&options, &antenna()).await;
    let shown = rig.shown();
    assert_eq!(reading(&shown, "Unit").as_deref(), Some("RC2K 1.4"));
    assert_eq!((reading(&shown, "TRACK"), reading(&shown, "Signal")), (None, None));
    assert_eq!(check(&shown, "Kind of unit"), Some(CheckState::Caution));
}

fn lock_out() -> LockOut {
    LockOut {
        operator: "Ada".to_owned(),
        reason: "feed off".to_owned(),
        start: "2026-11-22T10:00:00Z".parse().unwrap(),
    }
}

#[tokio::test(start_paused = true)]
async fn a_lock_out_gives_the_panel_to_who_works_there_and_stop_alone_takes_it() {
    let mut rig = Rig::in_manual().await;
    rig.send(Command::LockOut(lock_out()));
    rig.until("let go of", 5, |shown| shown.link == LinkState::Off).await;
    assert_eq!(rig.shown().lock_out, Some(lock_out()));
    rig.events();
    let (dials, said) = (rig.dials().len(), rig.received().len());
    rig.send(Command::Connect);
    rig.seconds(30.0).await;
    let refused = Event::NotSent(Refusal::PanelLockedOut { operator: "Ada".to_owned() });
    assert_eq!(rig.events(), [refused]);
    assert_eq!((rig.dials().len(), rig.received().len()), (dials, said), "not even a question");

    rig.stop();
    rig.until_event(10, |event| *event == Event::Stopped).await;
    assert!(rig.orders().iter().any(|order| order.starts_with("3X")), "{:?}", rig.orders());
    rig.until("let go of again", 5, |shown| shown.link == LinkState::Off).await;
    rig.events();

    rig.send(Command::Unlock);
    rig.send(Command::Connect);
    rig.until_event(5, |event| *event == Event::Connected(Found::Still)).await;
}

#[tokio::test(start_paused = true)]
async fn a_lock_out_stops_what_moves_before_it_lets_go() {
    let mut rig = Rig::in_manual().await;
    rig.send(Command::Hold);
    let azimuth = Some(azel::astro::Angle::from_degrees(220.0));
    rig.send(Command::Position { azimuth, elevation: None });
    rig.until("it moves", 5, |shown| shown.state.measured.unwrap().moving()).await;
    rig.send(Command::LockOut(lock_out()));
    rig.until_event(10, |event| *event == Event::Stopped).await;
    rig.until("let go of", 5, |shown| shown.link == LinkState::Off).await;
    let there = rig.counts();
    rig.seconds(5.0).await;
    assert_eq!(rig.counts(), there);
    assert!(!rig.shown().unproved);
}

#[tokio::test(start_paused = true)]
async fn without_a_link_a_lock_out_ends_the_dialling() {
    let mut rig = Rig::in_manual().await;
    rig.set_off(true);
    rig.until("lost", 10, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    rig.send(Command::LockOut(lock_out()));
    rig.until("off", 5, |shown| shown.link == LinkState::Off).await;
    let dials = rig.dials().len();
    rig.set_off(false);
    rig.seconds(30.0).await;
    assert_eq!(rig.dials().len(), dials);
}
