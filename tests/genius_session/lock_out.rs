//! Lock-out of a unit: Azel neither moves nor configures its rotators.

use azel::{
    contract::driver::{Command, Event, Intent, Refusal},
    device::settings::{Change, Value, WriteError},
    station::LockOut,
};

use super::rig::{Rig, to};

#[tokio::test(start_paused = true)]
async fn nothing_is_moved_or_configured_and_nothing_has_to_be_read_back() {
    let mut rig = Rig::pair().await;
    let lock_out = LockOut {
        operator: "Ada".to_owned(),
        reason: "new cable".to_owned(),
        start: "2026-11-22T10:00:00Z".parse().unwrap(),
    };
    rig.send(Command::Hold);
    rig.send(to(Some(90.0), None));
    rig.until("it moves", 3, |shown| shown.state.measured.unwrap().moving()).await;
    rig.send(Command::LockOut(lock_out));
    rig.until("locked out", 10, |shown| shown.lock_out.is_some() && !shown.locking).await;
    assert!(!rig.shown().state.measured.unwrap().moving(), "it was stopped first");
    assert_eq!(rig.shown().intent, Intent::Standby);
    rig.events();
    let before = rig.orders();

    rig.send(to(Some(120.0), None));
    let (by, reason) = ("Ada".to_owned(), "new cable".to_owned());
    let refused = Event::NotSent(Refusal::LockedOut { operator: by, reason });
    assert_eq!(rig.until_event(1, |_| true).await, refused);
    let group = *rig.shown().state.groups.keys().next().unwrap();
    let values = [("stop_offset_deg", Value::Integer(3))].into();
    let change = Change { ticket: 1, group, values, expected: None, is_unlocked: true };
    rig.send(Command::WriteSettings(change));
    rig.until("refused", 5, |shown| shown.state.groups[group].written.is_some()).await;
    let written = rig.shown().state.groups[group].written.clone().unwrap();
    assert_eq!(written.result, Err(WriteError::LockedOut));
    assert_eq!(rig.orders(), before);
}
