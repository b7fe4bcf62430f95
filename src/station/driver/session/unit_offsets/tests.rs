//! Tests of records on disk, and of offsets that an earlier run has left on the unit.

use std::{collections::BTreeMap, path::Path, sync::Arc, time::Duration};

use jiff::Timestamp;
use tokio::{io::AsyncWriteExt as _, time::sleep};

use super::*;
use crate::{
    astro::{Angle, Site, time::add_seconds},
    contract::driver::{Command, Snapshot, Unit},
    device::TrackTarget,
    driver::{
        AntennaHandle, Debts,
        session::testing::{self, antenna},
    },
    orbit::{PassSearch, Propagator, passes, read_elements},
    plan::on_board::KnownOrbit,
    protocol::satrak::encode,
    sim::satrak::{Control, Fault, Options},
};

/// Elements of the ISS in 2008, a published example.
const ELEMENTS: &str = "ISS (ZARYA)
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
";

fn site() -> Site {
    Site::new(41.01, 29.17, 100.0).unwrap()
}

/// Returns a high pass of the ISS.
fn pass() -> OnBoardPass {
    let elements = read_elements(ELEMENTS).elements.swap_remove(0);
    let (propagator, start) = (Propagator::new(&elements).unwrap(), elements.epoch());
    let aos_elevation = Angle::from_degrees(10.0);
    let search = PassSearch {
        aos_elevation,
        ..PassSearch::new(site(), start, add_seconds(start, 3.0 * 86_400.0))
    };
    let is_high = |pass: &crate::orbit::Pass| pass.max_elevation().degrees() > 40.0;
    let pass = passes(&propagator, &search, &|| false).into_iter().find(is_high).unwrap();
    let target = TrackTarget {
        catalog_number: 25_544,
        name: "ISS (ZARYA)".into(),
        element_file: None,
        start: pass.aos.time,
        end: pass.los.time,
    };
    OnBoardPass { target, elements, site: site(), is_agreed: false }
}

/// Returns a unit that starts `after_s` seconds after AOS.
fn unit(after_s: f64) -> (Control, Timestamp) {
    let pass = pass();
    let now = add_seconds(pass.target.start, after_s);
    let elements = BTreeMap::from([("stations.txt".to_owned(), vec![pass.elements])]);
    (Control::new(&Options { elements, ..Options::new(site(), now) }), now)
}

/// Starts a new run of the program at `now`.
fn run(control: &Control, now: Timestamp, folder: &Path) -> AntennaHandle {
    let debts = Debts::marked_in(Some(folder.to_owned()));
    let handle = testing::start_with(control.clone(), now, debts, |wires| wires);
    let OnBoardPass { elements, site, .. } = pass();
    handle.know_orbit(Some(Arc::new(KnownOrbit { elements, site })));
    handle
}

fn mark(folder: &Path) -> Option<ShiftedTrack> {
    Debts::marked_in(Some(folder.to_owned())).shifted(&Unit::new(&antenna()))
}

fn azimuth(degrees: f64) -> TrackOffsets {
    TrackOffsets::NONE.plus(Offset::Azimuth(Angle::from_degrees(degrees))).unwrap()
}

async fn wait(handle: &AntennaHandle, goal: &str, is_so: impl Fn(&Snapshot) -> bool) {
    for _ in 0..12_000 {
        if is_so(&handle.snapshot()) {
            return;
        }
        sleep(Duration::from_millis(10)).await;
    }
    panic!("not {goal}: {:?}", handle.snapshot().unit_offsets);
}

fn is_read(shown: &Snapshot) -> bool {
    shown.state.on_board.offsets.is_some() && shown.state.on_board.satellite.is_some()
}

fn holds(shown: &Snapshot, azimuth_deg: f64) -> bool {
    let offsets = shown.state.on_board.offsets;
    offsets.is_some_and(|unit| (unit.azimuth_deg - azimuth_deg).abs() < 1e-9)
}

/// Sends a payload as another client.
async fn send_foreign(control: &Control, payload: &str) {
    let (mut near, far) = tokio::io::duplex(4096);
    let serve = control.clone();
    tokio::spawn(async move { serve.serve(far).await });
    near.write_all(&encode(payload)).await.unwrap();
    sleep(Duration::from_secs(1)).await;
}

fn sent(control: &Control) -> Vec<String> {
    let received = control.received().into_iter().map(|(_, payload)| payload);
    received.filter(|payload| payload.starts_with("SETTINGS=")).collect()
}

/// Starts a session whose unit tracks the pass.
async fn tracking(control: &Control, now: Timestamp, folder: &Path) -> AntennaHandle {
    let handle = run(control, now, folder);
    wait(&handle, "read", is_read).await;
    handle.send(Command::Track(Box::new(pass()))).unwrap();
    wait(&handle, "tracking", |shown| {
        shown.state.program.is_some_and(|program| program.enabled) && !shown.pending
    })
    .await;
    handle
}

/// Makes the unit track the pass with 0.2 degrees added, and ends the program.
async fn leave_in_pass(folder: &Path) -> (Control, Timestamp) {
    let (control, now) = unit(30.0);
    let handle = tracking(&control, now, folder).await;
    let step = Offset::Azimuth(Angle::from_degrees(0.2));
    handle.send(Command::Offset(OffsetChange::Step(step))).unwrap();
    while sent(&control).is_empty() {
        sleep(Duration::from_millis(1)).await;
    }
    let mark = mark(folder).expect("it is on the disk before it is on the unit");
    assert_eq!((mark.before, mark.put.last()), (TrackOffsets::NONE, Some(&azimuth(0.2))));
    wait(&handle, "in force", |shown| {
        shown.unit_offsets.as_ref().is_some_and(|unit| unit.offsets == azimuth(0.2))
    })
    .await;
    drop(handle);
    sleep(Duration::from_secs(5)).await;
    (control, add_seconds(now, 60.0))
}

/// Waits for the removal of the record.
async fn wait_removed(folder: &Path) {
    for _ in 0..300 {
        if mark(folder).is_none() {
            return;
        }
        sleep(Duration::from_secs(1)).await;
    }
    panic!("the record stays: {:?}", mark(folder));
}

fn is_found(shown: &Snapshot) -> bool {
    let unit = shown.unit_offsets.as_ref().filter(|unit| unit.offsets == azimuth(0.2));
    unit.is_some_and(|unit| matches!(unit.left, Some(LeftOffsets::Found { .. })))
}

#[tokio::test(start_paused = true)]
async fn what_an_earlier_run_left_is_taken_back_once_the_unit_does_not_track() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = leave_in_pass(folder.path()).await;
    send_foreign(&control, "TRACK=,0").await;
    let handle = run(&control, now, folder.path());
    wait(&handle, "taken back", |shown| shown.unit_offsets.is_none() && holds(shown, 0.0)).await;
    assert_eq!(sent(&control).len(), 2, "one to add them, one to take them back");
    wait_removed(folder.path()).await;
}

#[tokio::test(start_paused = true)]
async fn in_the_pass_that_goes_on_what_an_earlier_run_left_waits_for_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = leave_in_pass(folder.path()).await;
    let handle = run(&control, now, folder.path());
    wait(&handle, "told", is_found).await;
    sleep(Duration::from_mins(2)).await;
    assert!(is_found(&handle.snapshot()) && control.state().is_tracking);
    assert_eq!(sent(&control).len(), 1, "it would move the antenna");
    send_foreign(&control, "TRACK=,0").await;
    wait(&handle, "taken back", |shown| shown.unit_offsets.is_none() && holds(shown, 0.0)).await;
    wait_removed(folder.path()).await;
}

#[tokio::test(start_paused = true)]
async fn what_an_earlier_run_left_waits_while_the_unit_is_locked_out() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = leave_in_pass(folder.path()).await;
    send_foreign(&control, "TRACK=,0").await;
    let handle = run(&control, now, folder.path());
    let (operator, reason) = ("Ada".to_owned(), "belts".to_owned());
    handle
        .send(Command::LockOut(crate::station::LockOut { operator, reason, start: now }))
        .unwrap();
    wait(&handle, "told", is_found).await;
    sleep(Duration::from_mins(1)).await;
    assert_eq!(sent(&control).len(), 1);
    handle.send(Command::Unlock).unwrap();
    wait(&handle, "taken back", |shown| shown.unit_offsets.is_none() && holds(shown, 0.0)).await;
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_refuses_is_asked_again_by_the_next_start_too() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = leave_in_pass(folder.path()).await;
    send_foreign(&control, "TRACK=,0").await;
    control.set_fault(Fault::RefuseSettings, true);
    let handle = run(&control, now, folder.path());
    wait(&handle, "told", |shown| {
        let unit = shown.unit_offsets.as_ref().filter(|unit| unit.offsets == azimuth(0.2));
        unit.is_some_and(|unit| matches!(unit.left, Some(LeftOffsets::Failed(_))))
    })
    .await;
    drop(handle);
    sleep(Duration::from_secs(5)).await;
    assert!(mark(folder.path()).is_some());
    control.set_fault(Fault::RefuseSettings, false);
    let handle = run(&control, add_seconds(now, 60.0), folder.path());
    wait(&handle, "taken back", |shown| shown.unit_offsets.is_none() && holds(shown, 0.0)).await;
    wait_removed(folder.path()).await;
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_applies_settings_late_is_watched_until_both_are_restored() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = unit(30.0);
    let handle = tracking(&control, now, folder.path()).await;
    let steps =
        [Offset::Azimuth(Angle::from_degrees(0.2)), Offset::Elevation(Angle::from_degrees(0.1))];
    let total = steps.into_iter().try_fold(TrackOffsets::NONE, TrackOffsets::plus).unwrap();
    for step in steps {
        handle.send(Command::Offset(OffsetChange::Step(step))).unwrap();
    }
    wait(&handle, "in force", |shown| {
        shown.unit_offsets.as_ref().is_some_and(|unit| unit.offsets == total && !unit.is_changing)
    })
    .await;
    control.set_fault(Fault::LateSettings, true);
    handle.stop();
    let half = |shown: &Snapshot| {
        let offsets = shown.state.on_board.offsets;
        holds(shown, 0.0) && offsets.is_some_and(|unit| (unit.elevation_deg - 0.1).abs() < 1e-9)
    };
    wait(&handle, "the azimuth alone is restored", half).await;
    sleep(Duration::from_secs(1)).await;
    assert!(mark(folder.path()).is_some(), "the elevation is still owed");
    let shown = handle.snapshot();
    let left = shown.unit_offsets.clone().expect("the elevation is told");
    assert_eq!(left.offsets.elevation(), Angle::from_degrees(0.1));
    // The unit drops the late settings.
    control.set_fault(Fault::LateSettings, false);
    let restored = |shown: &Snapshot| {
        let offsets = shown.state.on_board.offsets;
        holds(shown, 0.0) && offsets.is_some_and(|unit| unit.elevation_deg.abs() < 1e-9)
    };
    wait(&handle, "both are restored", restored).await;
    wait_removed(folder.path()).await;
}

#[tokio::test(start_paused = true)]
async fn an_offset_that_the_unit_applies_after_the_track_is_taken_back_too() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = unit(30.0);
    let handle = tracking(&control, now, folder.path()).await;
    control.set_fault(Fault::LateSettings, true);
    let step = Offset::Elevation(Angle::from_degrees(0.2));
    handle.send(Command::Offset(OffsetChange::Step(step))).unwrap();
    while sent(&control).is_empty() {
        sleep(Duration::from_millis(1)).await;
    }
    handle.stop();
    let elevation = |shown: &Snapshot, degrees: f64| {
        let offsets = shown.state.on_board.offsets;
        offsets.is_some_and(|unit| (unit.elevation_deg - degrees).abs() < 1e-9)
    };
    wait(&handle, "applied", |shown| elevation(shown, 0.2)).await;
    for _ in 0..4 {
        sleep(Duration::from_secs(40)).await;
    }
    assert!(elevation(&handle.snapshot(), 0.0), "{:?}", handle.snapshot().state.on_board.offsets);
    wait_removed(folder.path()).await;
}

/// At any kill time of the program, the unit ends without the offset.
#[tokio::test(start_paused = true)]
async fn killed_at_any_step_of_an_offset_the_next_start_leaves_none_on_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = leave_in_pass(folder.path()).await;
    send_foreign(&control, "TRACK=,0").await;
    let copies: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(Result::unwrap).collect();
    let [file] = &copies[..] else { panic!("{copies:?}") };
    let text = std::fs::read(file.path()).unwrap();
    for (step, is_recorded, held_deg) in [
        ("before the record", false, "0.0"),
        ("recorded, not written", true, "0.0"),
        ("written", true, "0.2"),
        ("taken back, before the removal", true, "0.0"),
        ("after the removal", false, "0.0"),
    ] {
        let killed = tempfile::tempdir().unwrap();
        std::fs::write(killed.path().join(".tmpAbCdEf"), &text[..20]).unwrap();
        if is_recorded {
            std::fs::write(killed.path().join(file.file_name()), &text).unwrap();
        }
        send_foreign(&control, &format!("SETTINGS=,?,?,{held_deg},?,?,?,?,?,?,?,?")).await;
        let handle = run(&control, now, killed.path());
        wait(&handle, step, |shown| holds(shown, 0.0) && shown.unit_offsets.is_none()).await;
        wait_removed(killed.path()).await;
        drop(handle);
        sleep(Duration::from_secs(5)).await;
    }
}

#[tokio::test(start_paused = true)]
async fn steps_that_come_while_one_is_recorded_are_recorded_too() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = unit(30.0);
    let handle = tracking(&control, now, folder.path()).await;
    let step = Offset::Azimuth(Angle::from_degrees(0.1));
    for _ in 0..5 {
        handle.send(Command::Offset(OffsetChange::Step(step))).unwrap();
    }
    wait(&handle, "in force", |shown| {
        let unit = shown.unit_offsets.as_ref();
        unit.is_some_and(|unit| unit.offsets == azimuth(0.5) && !unit.is_changing)
    })
    .await;
    assert!(mark(folder.path()).unwrap().put.contains(&azimuth(0.5)));
    handle.stop();
    wait(&handle, "taken back", |shown| shown.unit_offsets.is_none() && holds(shown, 0.0)).await;
}

#[tokio::test(start_paused = true)]
async fn what_the_unit_makes_of_an_offset_is_known_and_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = unit(30.0);
    let mut handle = tracking(&control, now, folder.path()).await;
    let step = Offset::Azimuth(Angle::from_degrees(0.2));
    handle.send(Command::Offset(OffsetChange::Step(step))).unwrap();
    while sent(&control).is_empty() {
        sleep(Duration::from_millis(1)).await;
    }
    // Simulate a unit that stores other values than it receives.
    send_foreign(&control, "SETTINGS=,?,?,0.25,?,?,?,?,?,?,?,?").await;
    wait(&handle, "known", |shown| {
        let unit = shown.unit_offsets.as_ref();
        unit.is_some_and(|unit| unit.offsets == azimuth(0.25) && !unit.is_changing)
    })
    .await;
    let events: Vec<Event> = std::iter::from_fn(|| handle.next_event()).collect();
    let is_differing =
        |event: &Event| matches!(event, Event::OffsetNotTaken(WriteError::Differs(_)));
    assert!(events.iter().any(is_differing), "{events:?}");
    assert!(mark(folder.path()).unwrap().put.contains(&azimuth(0.25)));
    handle.stop();
    wait(&handle, "taken back", |shown| shown.unit_offsets.is_none() && holds(shown, 0.0)).await;
}

#[tokio::test(start_paused = true)]
async fn in_the_pass_that_goes_on_they_are_found_too() {
    let folder = tempfile::tempdir().unwrap();
    let (control, now) = leave_in_pass(folder.path()).await;
    let handle = run(&control, now, folder.path());
    wait(&handle, "told", |shown| {
        shown.unit_offsets.as_ref().is_some_and(|unit| unit.left.is_some())
    })
    .await;
    let is_watched = |shown: &Snapshot| shown.on_board.is_some();
    wait(&handle, "watched", is_watched).await;
    let step = Offset::Azimuth(Angle::from_degrees(0.1));
    handle.send(Command::Offset(OffsetChange::Step(step))).unwrap();
    wait(&handle, "taken up", |shown| {
        let unit = shown.unit_offsets.as_ref();
        unit.is_some_and(|unit| unit.offsets == azimuth(0.3) && unit.left.is_none())
    })
    .await;
    handle.stop();
    wait(&handle, "taken back", |shown| shown.unit_offsets.is_none() && holds(shown, 0.0)).await;
}

#[tokio::test(start_paused = true)]
async fn what_the_unit_does_not_hold_any_more_is_not_offered() {
    for azimuth_deg in [0.0, 0.5] {
        let folder = tempfile::tempdir().unwrap();
        let (control, now) = leave_in_pass(folder.path()).await;
        send_foreign(&control, "TRACK=,0").await;
        send_foreign(&control, &format!("SETTINGS=,?,?,{azimuth_deg},?,?,?,?,?,?,?,?")).await;
        let handle = run(&control, now, folder.path());
        wait(&handle, "read", |shown| holds(shown, azimuth_deg)).await;
        sleep(Duration::from_secs(1)).await;
        assert_eq!(handle.snapshot().unit_offsets, None, "{azimuth_deg}");
        wait_removed(folder.path()).await;
    }
}

#[tokio::test(start_paused = true)]
async fn without_a_record_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    // Create a file in place of the folder.
    let blocked = folder.path().join("marks");
    std::fs::write(&blocked, "").unwrap();
    let (control, now) = unit(30.0);
    let mut handle = tracking(&control, now, &blocked).await;
    let step = Offset::Azimuth(Angle::from_degrees(0.2));
    handle.send(Command::Offset(OffsetChange::Step(step))).unwrap();
    sleep(Duration::from_secs(5)).await;
    let events: Vec<Event> = std::iter::from_fn(|| handle.next_event()).collect();
    assert!(events.contains(&Event::OffsetRefused(Refusal::NoOffsetsRecord)), "{events:?}");
    assert_eq!((sent(&control).len(), handle.snapshot().unit_offsets.clone()), (0, None));
}
