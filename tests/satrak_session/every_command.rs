//! All 32 commands of the document, each sent through the session to the unit. The bytes are those
//! of the document, and Azel shows each command as done.

use azel::{
    astro::Angle,
    contract::driver::{Command, Event},
    controller::satrak::settings::{FROM_GPS, FROM_THIS_PC, GROUPS},
    device::settings::{Change, Secret, Value},
    protocol::satrak::{Query, encode},
};

use super::{
    rig::{Rig, iss, track},
    settings::{change, read, text, write_settings},
};

/// Returns changes, with the payloads that the unit receives for them.
fn settings() -> Vec<(Change, &'static str)> {
    let time = |at: &str| Value::Time(at.parse().unwrap());
    vec![
        (change("clock", [("set_from", Value::Choice(FROM_GPS))]), "RTC_REUPDATE="),
        (
            change("general", [("lead_ms", Value::Integer(90_000))]),
            "SETTINGS=,?,?,?,?,90000,?,?,?,?,?,?",
        ),
        (change("gps", [("is_automatic", Value::Flag(false))]), "GPS_SETTINGS=,0,41.01N,29.17E"),
        (
            change(
                "window",
                [("start", time("2008-09-22T20:30:00Z")), ("stop", time("2008-09-22T20:35:00Z"))],
            ),
            "START_STOP_TIME=,20,30,0,22,9,2008,20,35,0,22,9,2008",
        ),
        (
            change("web", [("url", text("https://example.org/tle"))]),
            "SATELLITE_HTTP=,https://example.org/tle,1,0,0",
        ),
        (
            change(
                "ftp",
                [
                    ("address", text("10.0.1.2")),
                    ("user", text("username")),
                    ("password", Value::Secret(Secret::new("password"))),
                    ("file", text("stations.txt")),
                    ("satellite", text("TWIN")),
                ],
            ),
            // The record of the unit leaves out frames that hold a password.
            "SATELLITE_FTP",
        ),
        (
            change("file", [("file", text("stations.txt")), ("name", text("TWIN"))]),
            "SATELLITE=,stations.txt,TWIN,1,0",
        ),
        (
            change("angles", [("y_deg", Value::Decimal(40.0))]),
            "ANGLE_SETTINGS=,0,29127,160.0,7282,40.0",
        ),
        (change("reduction", [("y", Value::Decimal(4000.5))]), "REDUCTION=,4000,4000.5"),
        (change("image", [("file", text("sysImage.json"))]), "LOAD_IMAGE=,sysImage.json"),
    ]
}

#[tokio::test(start_paused = true)]
async fn all_of_them_reach_the_unit_as_documented() {
    let mut rig = Rig::usual().await;
    rig.seconds(60.0).await;
    for group in GROUPS {
        read(&mut rig, group.key).await;
    }
    let mut expected: Vec<String> = Vec::new();
    for (wish, payload) in settings() {
        write_settings(&mut rig, Change { is_unlocked: true, ..wish }).await.expect(payload);
        expected.push(payload.to_owned());
    }
    let from_pc = change("clock", [("set_from", Value::Choice(FROM_THIS_PC))]);
    write_settings(&mut rig, from_pc).await.unwrap();
    rig.send(Command::Manual);
    rig.hold([-1.5, 0.0], 1.0).await;
    rig.send(Command::EndJog);
    rig.seconds(5.0).await;
    rig.send(Command::Step { steps_deg: [2.0, 0.0] });
    rig.seconds(5.0).await;
    rig.send(Command::Position { azimuth: Some(Angle::from_degrees(74.61)), elevation: None });
    rig.seconds(2.0).await;
    rig.stop();
    rig.seconds(10.0).await;
    rig.events();
    rig.send(track(iss()));
    rig.until_event(30, |event| matches!(event, Event::Tracking(_))).await;
    rig.send(Command::AutoTrack(true));
    rig.seconds(2.0).await;
    rig.send(Command::AutoTrack(false));
    rig.seconds(2.0).await;
    rig.stop();
    rig.seconds(10.0).await;
    for payload in [
        "MOVE=,-1.5,0",
        "STEP=,2,0",
        "GOTO=,74.61,NONE",
        "STOP=",
        "TRACK=,1",
        "TRACK=,0",
        "TRACK_AUTO_ENABLE=,1",
        "TRACK_AUTO_ENABLE=,0",
        "TIME=,",
    ] {
        expected.push(payload.to_owned());
    }
    for (query, word) in Query::ALL {
        if query != Query::SatelliteFtp {
            expected.push(format!("{word}?"));
        }
    }
    let received = rig.payloads();
    for payload in &expected {
        let is_whole = !payload.ends_with(',') && payload != "SATELLITE_FTP";
        let came = received
            .iter()
            .any(|it| if is_whole { it == payload } else { it.starts_with(payload) });
        assert!(came, "{payload}: {received:#?}");
    }
    // The unit answers nothing with a wrong checksum.
    assert_eq!(encode("MOVE=,-3.5,0"), b"$MOVE=,-3.5,0*19\r\n");
    let traffic = rig.shown().state.traffic;
    assert_eq!((traffic.unreadable, traffic.damaged, traffic.unsolicited), (0, 0, 0));
}
