//! Settings of the unit: the bytes sent, and the display.

use std::sync::atomic::{AtomicU64, Ordering};

use azel::{
    contract::driver::Command,
    controller::satrak::settings::{FROM_GPS, FROM_THIS_PC, GROUPS},
    device::settings::{Access, Change, Secret, Value, Values, WriteError},
    protocol::satrak::encode,
    sim::satrak::Options,
};

use super::rig::{Rig, antenna, options};

/// Reads a whole group and returns its values.
pub(super) async fn read(rig: &mut Rig, group: &'static str) -> Values {
    rig.send(Command::ReadGroup(group));
    rig.until(group, 10, |shown| {
        shown.state.groups.get(group).is_some_and(|state| state.last_read.is_some())
    })
    .await;
    rig.shown().state.groups[group].last_read.clone().unwrap().values
}

/// Writes `change` to the unit and returns the outcome.
pub(super) async fn write_settings(rig: &mut Rig, change: Change) -> Result<(), WriteError> {
    static TICKET: AtomicU64 = AtomicU64::new(1);
    let (group, ticket) = (change.group, TICKET.fetch_add(1, Ordering::Relaxed));
    rig.send(Command::WriteSettings(Change { ticket, ..change }));
    rig.until("settled", 60, |shown| {
        let written = shown.state.groups.get(group).and_then(|state| state.written.as_ref());
        written.is_some_and(|written| written.change.ticket == ticket)
    })
    .await;
    let shown = rig.shown();
    assert_eq!(shown.state.groups[group].step, None);
    shown.state.groups[group].written.as_ref().unwrap().result.clone()
}

pub(super) fn change<const N: usize>(
    group: &'static str,
    values: [(&'static str, Value); N],
) -> Change {
    Change { ticket: 0, group, values: values.into(), expected: None, is_unlocked: false }
}

pub(super) fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

/// Returns the value of a field as the form shows it.
pub(super) fn shown(rig: &Rig, group: &'static str, field: &'static str) -> String {
    let shown = rig.shown();
    let held = shown.state.groups[group].last_read.as_ref().unwrap();
    let group = GROUPS.iter().find(|known| known.key == group).unwrap();
    let value = held.values.get(field).unwrap_or_else(|| panic!("{field}: {held:?}"));
    group.field(field).unwrap().kind.text(value)
}

#[tokio::test(start_paused = true)]
async fn every_group_is_read_and_every_field_of_it_shown() {
    let mut rig = Rig::usual().await;
    // The receiver of a new unit needs some time.
    rig.seconds(60.0).await;
    for group in GROUPS {
        let values = read(&mut rig, group.key).await;
        // A new unit has found no satellite, and reports 0 for both.
        let of_satellite = ["catalog_number", "maximum_elevation_deg"];
        for field in group.fields.iter().filter(|field| field.access != Access::Write) {
            if of_satellite.contains(&field.key) {
                assert!(!values.contains_key(field.key), "{}: {}", group.key, field.key);
                continue;
            }
            assert!(values.contains_key(field.key), "{}: {}", group.key, field.key);
        }
    }
    for (question, bytes) in [
        ("VERSION?", "$VERSION?*65\r\n"),
        ("TIME?", "$TIME?*2A\r\n"),
        ("START_STOP_TIME?", "$START_STOP_TIME?*72\r\n"),
        ("SETTINGS?", "$SETTINGS?*3A\r\n"),
        ("ANGLE_SETTINGS?", "$ANGLE_SETTINGS?*24\r\n"),
        ("GPS_DATA?", "$GPS_DATA?*34\r\n"),
        ("TPOS?", "$TPOS?*27\r\n"),
        ("GPS_SETTINGS?", "$GPS_SETTINGS?*21\r\n"),
        ("SATELLITE?", "$SATELLITE?*64\r\n"),
        ("SATELLITE_HTTP?", "$SATELLITE_HTTP?*23\r\n"),
        ("SATELLITE_FTP?", "$SATELLITE_FTP?*79\r\n"),
        ("LOAD_IMAGE?", "$LOAD_IMAGE?*21\r\n"),
        ("REDUCTION?", "$REDUCTION?*66\r\n"),
    ] {
        // The record hides frames with a password.
        let told = question.replace("FTP?", "FTP");
        assert!(rig.payloads().iter().any(|sent| sent.starts_with(&told)), "{question}");
        assert_eq!(encode(question), bytes.as_bytes());
    }
    assert_eq!(shown(&rig, "versions", "control_unit"), "SATRAK CU V1.2 18/10/2017");
    assert_eq!(shown(&rig, "gps", "latitude_deg"), "41.01N");
    assert_eq!(shown(&rig, "receiver", "is_valid"), "On");
}

#[tokio::test(start_paused = true)]
async fn each_setting_goes_out_as_documented_and_is_read_back() {
    let mut rig = Rig::usual().await;
    rig.seconds(60.0).await;
    let time = |at: &str| Value::Time(at.parse().unwrap());
    let cases = [
        (
            change("general", [("minimum_elevation_deg", Value::Decimal(5.0))]),
            "SETTINGS=,?,?,?,?,?,?,5.0,?,?,?,?",
        ),
        (
            change(
                "general",
                [
                    ("clock_from_gps", Value::Flag(false)),
                    ("time_offset_ms", Value::Integer(-120)),
                    ("azimuth_offset_deg", Value::Decimal(0.15)),
                    ("elevation_offset_deg", Value::Decimal(-0.2)),
                    ("lead_ms", Value::Integer(90_000)),
                    ("position_base", Value::Choice(0)),
                    ("north_offset_deg", Value::Decimal(0.0)),
                    ("sspa", Value::Choice(2)),
                    ("sspa_rule", Value::Choice(3)),
                    ("elevation_threshold_deg", Value::Decimal(4.0)),
                ],
            ),
            "SETTINGS=,0,-120,0.15,-0.2,90000,0,?,0.0,2,3,4.0",
        ),
        (
            change(
                "gps",
                [
                    ("is_automatic", Value::Flag(false)),
                    ("latitude_deg", Value::Decimal(41.02)),
                    ("longitude_deg", Value::Decimal(29.17)),
                ],
            ),
            "GPS_SETTINGS=,0,41.02N,29.17E",
        ),
        (
            change(
                "window",
                [("start", time("2008-09-21T20:30:00Z")), ("stop", time("2008-09-21T20:35:00Z"))],
            ),
            "START_STOP_TIME=,20,30,0,21,9,2008,20,35,0,21,9,2008",
        ),
        (
            change("file", [("file", text("stations.txt")), ("name", text("TWIN"))]),
            "SATELLITE=,stations.txt,TWIN,1,0",
        ),
        (
            change(
                "web",
                [
                    ("url", text("https://example.org/tle?a=1,2")),
                    ("continue_tracking", Value::Flag(true)),
                ],
            ),
            "SATELLITE_HTTP=,https://example.org/tle?a=1%2C2,1,0,1",
        ),
        (change("clock", [("set_from", Value::Choice(FROM_GPS))]), "RTC_REUPDATE="),
    ];
    for (change, order) in cases {
        let (group, before) = (change.group, rig.orders().len());
        assert_eq!(write_settings(&mut rig, change).await, Ok(()), "{order}");
        let orders = rig.orders();
        let sent = &orders[before..];
        assert_eq!(sent, [order], "{group}");
    }
    assert_eq!(shown(&rig, "general", "elevation_threshold_deg"), "4.0");
    assert_eq!(shown(&rig, "file", "catalog_number"), "25545");
    assert_eq!(shown(&rig, "general", "tle_source"), "Web", "read again after the source");
}

#[tokio::test(start_paused = true)]
async fn the_password_of_the_ftp_source_comes_through_and_is_never_shown() {
    let mut rig = Rig::usual().await;
    let wish = change(
        "ftp",
        [
            ("address", text("10.0.1.2")),
            ("user", text("username")),
            ("password", Value::Secret(Secret::new("hunter2"))),
            ("port", Value::Integer(22)),
            ("file", text("stations.txt")),
            ("satellite", text("TWIN")),
            ("on_error", Value::Choice(1)),
        ],
    );
    // Azel reads the values back and compares them, the password too.
    assert_eq!(write_settings(&mut rig, wish).await, Ok(()));
    assert_eq!(shown(&rig, "general", "tle_source"), "FTP", "read again after the source");
    let record = format!("{:?} {:?}", rig.shown(), rig.payloads());
    assert!(!record.contains("hunter2"), "{record}");
    let another = change("ftp", [("password", Value::Secret(Secret::new("a,b")))]);
    let refused = write_settings(&mut rig, another).await;
    let named = matches!(refused, Err(WriteError::CannotBeSent { field: "password", .. }));
    assert!(named && !format!("{refused:?}").contains("a,b"), "{refused:?}");
}

#[tokio::test(start_paused = true)]
async fn the_clock_is_set_just_after_a_full_second() {
    let mut rig = Rig::usual().await;
    rig.seconds(0.4).await;
    let from_pc = change("clock", [("set_from", Value::Choice(FROM_THIS_PC))]);
    assert_eq!(write_settings(&mut rig, from_pc).await, Ok(()));
    let sent = rig.sent("TIME=");
    assert_eq!(sent.len(), 1, "{sent:?}");
    let ahead: f64 = shown(&rig, "clock", "ahead_s").parse().unwrap();
    assert!(ahead.abs() <= 0.2, "{ahead}");
}

#[tokio::test(start_paused = true)]
async fn an_update_of_the_clock_from_gps_is_shown_with_the_lock_delay() {
    let unset = Options { clock_is_unset: true, ..options() };
    let mut rig = Rig::connected(&unset, &antenna()).await;
    read(&mut rig, "clock").await;
    assert_eq!(shown(&rig, "clock", "is_from_gps"), "Off");
    rig.seconds(unset.gps_lock_after.as_secs_f64()).await;
    rig.seconds(1.0).await;
    assert_eq!(shown(&rig, "clock", "is_from_gps"), "On");
    read(&mut rig, "receiver").await;
    assert_eq!(shown(&rig, "receiver", "lock_delay_s"), "8");
}

#[tokio::test(start_paused = true)]
async fn service_settings_go_out_when_unlocked() {
    let mut rig = Rig::usual().await;
    let cases = [
        (
            change("angles", [("x_sensor", Value::Integer(29_127))]),
            "ANGLE_SETTINGS=,0,29127,160.0,7282,40.0",
        ),
        (
            change(
                "angles",
                [
                    ("reference", Value::Choice(1)),
                    ("x_deg", Value::Decimal(90.0)),
                    ("y_deg", Value::Decimal(90.0)),
                ],
            ),
            "ANGLE_SETTINGS=,1,0,90.0,0,90.0",
        ),
        (change("reduction", [("x", Value::Decimal(4100.0))]), "REDUCTION=,4100,4000"),
        (change("image", [("file", text("sysImage.json"))]), "LOAD_IMAGE=,sysImage.json"),
        (change("general", [("sspa", Value::Choice(1))]), "SETTINGS=,?,?,?,?,?,?,?,?,1,?,?"),
    ];
    for (change, order) in cases {
        assert_eq!(
            write_settings(&mut rig, change.clone()).await,
            Err(WriteError::Locked),
            "{order}"
        );
        let unlocked = Change { is_unlocked: true, ..change };
        assert_eq!(write_settings(&mut rig, unlocked).await, Ok(()), "{order}");
        assert_eq!(rig.orders().last().unwrap(), order);
    }
    assert_eq!(rig.orders().len(), 5, "a locked one never goes out");
}
