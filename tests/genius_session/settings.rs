//! Configuration of the rotators: the bytes sent, and the display.

use std::sync::atomic::{AtomicU64, Ordering};

use azel::{
    contract::driver::Command,
    controller::rotator_genius::Rotators,
    device::settings::{Change, ReadFailure, Value, Values, WriteError},
    driver::AntennaHandle,
    sim::rotator_genius::{Fault, Options, Quirk},
};

use super::{
    rig::{Rig, azimuth, pair, to},
    script::{Scripted, plain},
};

fn change<const N: usize>(group: &'static str, values: [(&'static str, Value); N]) -> Change {
    static TICKET: AtomicU64 = AtomicU64::new(1);
    let ticket = TICKET.fetch_add(1, Ordering::Relaxed);
    Change { ticket, group, values: values.into(), expected: None, is_unlocked: true }
}

fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

fn offset(degrees: i64) -> (&'static str, Value) {
    ("stop_offset_deg", Value::Integer(degrees))
}

/// Returns the outcome of the change with this ticket once the change is over.
fn outcome(handle: &AntennaHandle, asked: &Change) -> Option<Result<(), WriteError>> {
    let shown = handle.snapshot();
    let written = shown.state.groups.get(asked.group)?.written.as_ref()?;
    (written.change.ticket == asked.ticket).then(|| written.result.clone())
}

async fn write_settings(rig: &mut Rig, change: Change) -> Result<(), WriteError> {
    rig.send(Command::WriteSettings(change.clone()));
    for _ in 0..2000 {
        if let Some(result) = outcome(rig.handle(), &change) {
            assert_eq!(rig.shown().state.groups[change.group].step, None);
            return result;
        }
        rig.seconds(0.01).await;
    }
    panic!("it is never over: {change:?}");
}

fn held(rig: &Rig, group: &str) -> Values {
    rig.shown().state.groups[group].last_read.clone().unwrap().values
}

#[tokio::test(start_paused = true)]
async fn a_status_tells_what_can_be_told() {
    let rig = Rig::pair().await;
    let expected: Values = [
        ("limit_cw_deg", Value::Integer(359)),
        ("limit_ccw_deg", Value::Integer(0)),
        ("kind", Value::Choice(0)),
        ("name", text("Tower")),
    ]
    .into();
    assert_eq!(held(&rig, "rotator_1"), expected);
    let second = held(&rig, "rotator_2");
    assert_eq!(second["kind"], Value::Choice(1));
    assert_eq!(second["name"], text("Elevation"));
}

#[tokio::test(start_paused = true)]
async fn a_configuration_goes_out_whole_and_once_and_is_read_back() {
    let mut rig = Rig::pair().await;
    let limits = [("limit_cw_deg", Value::Integer(270)), ("limit_ccw_deg", Value::Integer(90))];
    let [cw, ccw] = limits;
    let asked = change("rotator_1", [cw, ccw, offset(3), ("name", text("T\u{fc}rm"))]);
    assert_eq!(write_settings(&mut rig, asked).await, Ok(()));
    assert_eq!(rig.orders(), ["|c1270090A03T\u{fc}rm      "]);
    assert_eq!(held(&rig, "rotator_1")["limit_cw_deg"], Value::Integer(270));
    assert_eq!(rig.reading("Rotator 1"), "Türm, azimuth");
    // The offset in the status is a different value.
    assert_eq!(rig.reading("Offset 1"), "0°");
    let asked = change("rotator_2", [offset(0), ("kind", Value::Choice(0))]);
    assert_eq!(write_settings(&mut rig, asked).await, Ok(()));
    assert_eq!(rig.orders()[1], "|c2090000A00Elevation ");
    rig.seconds(1.0).await;
    assert_eq!(rig.axes_deg(), [None, None], "two azimuth rotators are no pair");
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_sent_is_refused_before_it_is() {
    let long =
        Options { rotators: [azimuth("Rotator 2 -", 10), pair().rotators[1].clone()], ..pair() };
    let mut rig = Rig::connected(&long, Rotators::Pair).await;
    let cannot = |result: Result<(), WriteError>, key: &str| {
        let Err(WriteError::CannotBeSent { field, reason }) = result else { panic!("{result:?}") };
        assert_eq!(field, key);
        reason.to_string()
    };
    let asked = change("rotator_1", [offset(3)]);
    let why = cannot(write_settings(&mut rig, asked).await, "name");
    assert_eq!(why, "\"Rotator 2 -\" is longer than 10 characters, give another one");
    let asked = change("rotator_1", [("limit_cw_deg", Value::Integer(300)), ("name", text("R2"))]);
    cannot(write_settings(&mut rig, asked).await, "stop_offset_deg");
    let asked = change("rotator_1", [offset(11), ("name", text("R2"))]);
    cannot(write_settings(&mut rig, asked).await, "stop_offset_deg");
    let asked = change("rotator_2", [offset(1), ("limit_ccw_deg", Value::Integer(361))]);
    cannot(write_settings(&mut rig, asked).await, "limit_ccw_deg");
    let asked = change("rotator_2", [offset(1), ("name", text("Kıs"))]);
    cannot(write_settings(&mut rig, asked).await, "name");
    assert_eq!(rig.orders(), [""; 0]);
    let asked = change("rotator_1", [offset(3), ("name", text("Rotator 2"))]);
    assert_eq!(write_settings(&mut rig, asked).await, Ok(()));
    assert_eq!(rig.orders(), ["|c1359000A03Rotator 2 "]);
}

#[tokio::test(start_paused = true)]
async fn locked_unknown_moving_or_overtaken_changes_are_not_sent() {
    let mut rig = Rig::pair().await;
    let locked = Change { is_unlocked: false, ..change("rotator_1", [offset(3)]) };
    assert_eq!(write_settings(&mut rig, locked).await, Err(WriteError::Locked));
    let unknown = change("rotator_1", [("speed", Value::Integer(3))]);
    assert_eq!(write_settings(&mut rig, unknown).await, Err(WriteError::NoSuchSetting));
    let mut seen = held(&rig, "rotator_1");
    seen.insert("name", text("Other"));
    let overtaken = Change { expected: Some(seen), ..change("rotator_1", [offset(3)]) };
    assert_eq!(write_settings(&mut rig, overtaken).await, Err(WriteError::ChangedMeanwhile));
    rig.send(to(None, Some(60.0)));
    rig.seconds(2.0).await;
    let asked = change("rotator_1", [offset(3)]);
    assert_eq!(write_settings(&mut rig, asked).await, Err(WriteError::Moving));
    assert_eq!(rig.orders(), ["|A2060"]);
}

#[tokio::test(start_paused = true)]
async fn a_refused_configuration_is_told() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::Refuse, true);
    let asked = change("rotator_1", [offset(3), ("name", text("New"))]);
    assert_eq!(write_settings(&mut rig, asked).await, Err(WriteError::Refused("F".to_owned())));
    assert_eq!(rig.orders(), ["|c1359000A03New       "]);
    assert_eq!(held(&rig, "rotator_1")["name"], text("Tower"));
}

#[tokio::test(start_paused = true)]
async fn a_configuration_without_an_answer_is_judged_by_what_is_read() {
    let mut rig = Rig::pair().await;
    let asked = change("rotator_1", [offset(3), ("limit_cw_deg", Value::Integer(180))]);
    rig.send(Command::WriteSettings(asked.clone()));
    while rig.times("|c1180000A03Tower     ").is_empty() {
        rig.seconds(0.001).await;
    }
    rig.control.set_fault(Fault::Silence, true);
    rig.seconds(0.5).await;
    rig.control.set_fault(Fault::Silence, false);
    rig.seconds(3.0).await;
    assert_eq!(outcome(rig.handle(), &asked), Some(Ok(())));

    let script = |command: &str| if command.starts_with("|c") { vec![] } else { plain(command) };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    let asked = change("rotator_1", [offset(3), ("limit_cw_deg", Value::Integer(180))]);
    device.handle.send(Command::WriteSettings(asked.clone())).unwrap();
    device.seconds(3.0).await;
    assert_eq!(outcome(&device.handle, &asked), Some(Err(WriteError::Unanswered)));
    assert_eq!(device.orders(), ["|c1180000A03Tower     "], "once");
}

#[tokio::test(start_paused = true)]
async fn a_device_that_holds_something_else_is_told() {
    // The peer accepts everything and changes nothing.
    let mut device = Scripted::start(Rotators::Pair, Box::new(plain));
    device.seconds(0.5).await;
    let asked = change("rotator_2", [offset(3), ("limit_cw_deg", Value::Integer(80))]);
    device.handle.send(Command::WriteSettings(asked.clone())).unwrap();
    device.seconds(1.0).await;
    let differs = WriteError::Differs(vec!["limit_cw_deg"]);
    assert_eq!(outcome(&device.handle, &asked), Some(Err(differs)));
}

#[tokio::test(start_paused = true)]
async fn a_link_that_goes_leaves_it_open_what_the_device_holds() {
    let mut rig = Rig::pair().await;
    let asked = change("rotator_1", [offset(3), ("limit_cw_deg", Value::Integer(180))]);
    rig.send(Command::WriteSettings(asked.clone()));
    while rig.times("|c1180000A03Tower     ").is_empty() {
        rig.seconds(0.001).await;
    }
    rig.set_off(true);
    rig.seconds(0.1).await;
    let over = |rig: &Rig, asked: &Change| outcome(rig.handle(), asked);
    assert_eq!(over(&rig, &asked), Some(Err(WriteError::LinkLost)));
    let asked = change("rotator_1", [offset(3)]);
    rig.send(Command::WriteSettings(asked.clone()));
    rig.seconds(0.1).await;
    assert_eq!(over(&rig, &asked), Some(Err(WriteError::NoLink)));
    rig.set_off(false);
    rig.until_up(9).await;
    rig.seconds(1.0).await;
    assert_eq!(held(&rig, "rotator_1")["limit_cw_deg"], Value::Integer(180));
    assert_eq!(rig.orders().len(), 1, "it is not sent again");
}

#[tokio::test(start_paused = true)]
async fn without_a_present_value_nothing_is_sent() {
    let mut rig = Rig::pair().await;
    rig.control.set_fault(Fault::Silence, true);
    let asked = change("rotator_1", [offset(3)]);
    let result = write_settings(&mut rig, asked).await;
    assert_eq!(result, Err(WriteError::Unread(ReadFailure::Unanswered)));
    assert_eq!(rig.orders(), [""; 0]);
}

#[tokio::test(start_paused = true)]
async fn the_narrow_form_takes_a_configuration_too() {
    let mut options = pair();
    options.quirks.insert(Quirk::Narrow);
    let mut rig = Rig::connected(&options, Rotators::Pair).await;
    let asked = change("rotator_2", [offset(4), ("limit_cw_deg", Value::Integer(85))]);
    assert_eq!(write_settings(&mut rig, asked).await, Ok(()));
    assert_eq!(rig.orders(), ["|c2085000E04Elevation "]);
    assert_eq!(rig.reading("Offset 2"), "4°", "in this form it is the stop offset");
}
