//! Settings that do not get through: the unit refuses them, another client changes them, or the
//! link breaks. The display shows the unit's values.

use std::time::Duration;

use azel::{
    contract::driver::{Command, Snapshot},
    device::settings::{Change, Hindrance, Value, WriteError, WriteStep},
    protocol::satrak::encode,
    sim::satrak::Fault,
};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

use super::{
    rig::Rig,
    script::{Scripted, plain},
    settings::{change, read, shown, text, write_settings},
};

fn threshold(value: f64) -> Change {
    change("general", [("elevation_threshold_deg", Value::Decimal(value))])
}

#[tokio::test(start_paused = true)]
async fn a_refused_setting_shows_the_code_and_what_the_unit_kept() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::RefuseSettings, true);
    let refused = write_settings(&mut rig, threshold(12.0)).await;
    assert_eq!(refused, Err(WriteError::Refused("ERR,7".to_owned())));
    assert_eq!(shown(&rig, "general", "elevation_threshold_deg"), "2.0");
    assert_eq!(rig.sent("SETTINGS=").len(), 1, "never again by itself");
    // Azel reads the settings back all the same.
    assert!(rig.sent("SETTINGS?").len() >= 3);
}

#[tokio::test(start_paused = true)]
async fn what_another_client_has_changed_is_not_overwritten() {
    let mut rig = Rig::usual().await;
    let seen = read(&mut rig, "general").await;
    let (mut near, far) = tokio::io::duplex(4096);
    let control = rig.control.clone();
    tokio::spawn(async move { control.serve(far).await });
    near.write_all(&encode("SETTINGS=,?,?,?,?,?,?,7.5,?,?,?,?")).await.unwrap();
    let mut answer = [0; 64];
    let count = near.read(&mut answer).await.unwrap();
    assert!(answer[..count].starts_with(b"$SETTINGS=,OK"));
    let mine = Change { expected: Some(seen), ..threshold(4.0) };
    assert_eq!(write_settings(&mut rig, mine).await, Err(WriteError::ChangedMeanwhile));
    assert_eq!(shown(&rig, "general", "minimum_elevation_deg"), "7.5", "the new value is shown");
    assert_eq!(shown(&rig, "general", "elevation_threshold_deg"), "2.0", "nothing was sent");
    let seen = rig.shown().state.groups["general"].last_read.clone().unwrap().values;
    let again = Change { expected: Some(seen), ..threshold(4.0) };
    assert_eq!(write_settings(&mut rig, again).await, Ok(()));
}

#[tokio::test(start_paused = true)]
async fn a_link_lost_in_the_middle_is_told_and_nothing_is_sent_again() {
    let mut rig = Rig::usual().await;
    rig.send(Command::WriteSettings(threshold(4.0)));
    rig.until("sending", 10, |shown| {
        shown.state.groups["general"].step == Some(WriteStep::Sending)
    })
    .await;
    rig.set_off(true);
    rig.until("over", 10, |shown| shown.state.groups["general"].written.is_some()).await;
    let result = rig.shown().state.groups["general"].written.as_ref().unwrap().result.clone();
    assert_eq!(result, Err(WriteError::LinkLost));
    assert_eq!(write_settings(&mut rig, threshold(5.0)).await, Err(WriteError::NoLink));
    rig.set_off(false);
    rig.until_up(20).await;
    rig.seconds(5.0).await;
    assert!(rig.sent("SETTINGS=").len() <= 1, "{:?}", rig.sent("SETTINGS="));
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_hangs_up_after_a_command_is_read_anew() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::HangUp, true);
    assert_eq!(write_settings(&mut rig, threshold(4.0)).await, Err(WriteError::LinkLost));
    rig.control.set_fault(Fault::HangUp, false);
    rig.until_up(20).await;
    let held = |shown: &Snapshot| {
        let held = shown.state.groups["general"].last_read.as_ref().unwrap();
        held.values["elevation_threshold_deg"] == Value::Decimal(4.0)
    };
    rig.until("read anew", 10, held).await;
    assert_eq!(rig.sent("SETTINGS=").len(), 1, "{:?}", rig.sent("SETTINGS="));
}

#[tokio::test(start_paused = true)]
async fn a_lost_answer_is_settled_by_the_read_back() {
    for (is_taken, result) in [(true, Ok(())), (false, Err(WriteError::Unanswered))] {
        let mut threshold_now = "2.0";
        let mut unit = Scripted::start(Box::new(move |payload| {
            let values = format!("SETTINGS?,1,100,1.0,2.0,60000,1,3.0,6.0,1,1,1,{threshold_now}");
            match payload {
                "SETTINGS?" => vec![(10, values)],
                set if set.starts_with("SETTINGS=") => {
                    threshold_now = if is_taken { "4.0" } else { "2.0" };
                    Vec::new()
                }
                other => plain(other),
            }
        }));
        unit.seconds(3.0).await;
        unit.handle.send(Command::WriteSettings(threshold(4.0))).unwrap();
        unit.seconds(10.0).await;
        let shown = unit.handle.snapshot();
        let written = shown.state.groups["general"].written.clone().unwrap();
        assert_eq!(written.result, result);
        assert_eq!(unit.sent("SETTINGS=").len(), 1);
    }
}

#[tokio::test(start_paused = true)]
async fn an_ok_that_changes_nothing_is_no_success() {
    let mut unit = Scripted::start(Box::new(|payload| match payload {
        "SETTINGS?" => {
            vec![(10, "SETTINGS?,1,100,1.0,2.0,60000,1,3.0,6.0,1,1,1,2.0".to_owned())]
        }
        other => plain(other),
    }));
    unit.seconds(3.0).await;
    unit.handle.send(Command::WriteSettings(threshold(4.0))).unwrap();
    unit.seconds(3.0).await;
    let written = unit.handle.snapshot().state.groups["general"].written.clone().unwrap();
    assert_eq!(written.result, Err(WriteError::Differs(vec!["elevation_threshold_deg"])));
}

#[tokio::test(start_paused = true)]
async fn a_slow_source_does_not_stop_the_polling() {
    let mut url = "";
    let mut unit = Scripted::start(Box::new(move |payload| match payload {
        "SATELLITE_HTTP?" => vec![(10, format!("SATELLITE_HTTP?,{url},1,0"))],
        set if set.starts_with("SATELLITE_HTTP=") => {
            url = "https://example.org/a";
            vec![(9000, "SATELLITE_HTTP=,OK".to_owned())]
        }
        other => plain(other),
    }));
    unit.seconds(3.0).await;
    let before = unit.sent("STATUS?").len();
    let wish = change("web", [("url", text("https://example.org/a"))]);
    unit.handle.send(Command::WriteSettings(wish)).unwrap();
    unit.seconds(8.0).await;
    assert_eq!(unit.handle.snapshot().state.groups["web"].step, Some(WriteStep::Sending));
    assert!(unit.sent("STATUS?").len() >= before + 8, "the position must not grow old");
    unit.seconds(4.0).await;
    let shown = unit.handle.snapshot();
    assert!(shown.link.is_open());
    assert_eq!(shown.state.groups["web"].written.as_ref().unwrap().result, Ok(()));
    assert_eq!(unit.sent("SATELLITE_HTTP=").len(), 1);
}

#[tokio::test(start_paused = true)]
async fn a_satellite_that_is_not_in_the_file_is_no_success() {
    let mut rig = Rig::usual().await;
    for (file, name, word) in
        [("stations.txt", "NOBODY", "satellite"), ("nothing.txt", "TWIN", "file")]
    {
        let wish = change("file", [("file", text(file)), ("name", text(name))]);
        let Err(WriteError::Useless(why)) = write_settings(&mut rig, wish).await else {
            panic!("{name} is not there");
        };
        assert!(why.contains(word), "{why}");
        rig.seconds(1.0).await;
    }
}

#[tokio::test(start_paused = true)]
async fn metal_that_moves_forbids_service_and_the_clock() {
    let mut rig = Rig::usual().await;
    rig.send(Command::Manual);
    rig.hold([1.0, 0.0], 1.0).await;
    rig.send(Command::Jog { rates_deg_s: [1.0, 0.0] });
    let service = change("reduction", [("x", Value::Decimal(4100.0))]);
    let service = Change { is_unlocked: true, ..service };
    rig.send(Command::WriteSettings(service));
    rig.hold([1.0, 0.0], 3.0).await;
    let shown = rig.shown();
    let written = shown.state.groups["reduction"].written.as_ref().unwrap();
    let moves = WriteError::Hindered { field: "x", hindrance: Hindrance::Moves };
    assert_eq!(written.result, Err(moves));
    assert!(rig.sent("REDUCTION=").is_empty());
    rig.stop();
    rig.seconds(5.0).await;
    let pc = change("clock", [("set_from", Value::Choice(0))]);
    assert_eq!(write_settings(&mut rig, pc).await, Ok(()));
}

#[tokio::test(start_paused = true)]
async fn a_stop_overtakes_settings_and_spoils_none() {
    let mut rig = Rig::usual().await;
    for (ticket, group) in [(1, "general"), (2, "gps"), (3, "web")] {
        let wish = match group {
            "general" => threshold(4.0),
            "gps" => change("gps", [("latitude_deg", Value::Decimal(41.5))]),
            _ => change("web", [("url", text("https://example.org/a"))]),
        };
        rig.send(Command::WriteSettings(Change { ticket, ..wish }));
    }
    rig.seconds(0.05).await;
    let pressed = azel::clock::Instant::now();
    rig.stop();
    rig.seconds(10.0).await;
    let first = rig.times("STOP=")[0];
    assert!(first - pressed < Duration::from_millis(20), "{:?}", first - pressed);
    for group in ["general", "gps", "web"] {
        let shown = rig.shown();
        assert_eq!(shown.state.groups[group].written.as_ref().unwrap().result, Ok(()), "{group}");
    }
}

#[tokio::test(start_paused = true)]
async fn what_is_not_there_cannot_be_set() {
    let mut rig = Rig::usual().await;
    let nothing = [
        change("general", [("tle_source", Value::Choice(1))]),
        change("versions", [("control_unit", text("x"))]),
        change("general", []),
    ];
    for wish in nothing {
        assert_eq!(write_settings(&mut rig, wish).await, Err(WriteError::NoSuchSetting));
    }
    let over = Value::Time("2001-01-01T00:00:00Z".parse().unwrap());
    let wish = change("window", [("stop", over)]);
    let result = write_settings(&mut rig, wish).await;
    assert!(matches!(result, Err(WriteError::CannotBeSent { field: "stop", .. })), "{result:?}");
    assert!(rig.orders().is_empty());
}
