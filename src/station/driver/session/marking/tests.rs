//! Tests of marks that an earlier run left behind.

use std::{
    num::NonZeroU32,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use jiff::{SignedDuration, Timestamp};
use tokio::{task::spawn_blocking, time::sleep};

use super::*;
use crate::{
    clock::Clock,
    contract::driver::{Command, Event, LeftMoving, Safety, Unit},
    driver::{
        AntennaHandle, Debts, Dial, Orders,
        session::{
            Session, Wires,
            testing::{self, START, antenna},
        },
    },
    plan::Bounds,
    promises::{
        FileState,
        tests::{SlowDisk, full_disk},
    },
    sim::satrak::{Control, Fault},
    station::Antenna,
};

/// Starts a session with its marks in `folder`, and returns its unit.
fn start(folder: &Path) -> (Control, AntennaHandle, Debts) {
    let debts = Debts::marked_in(Some(folder.to_owned()));
    let (control, handle) = testing::start(debts.clone(), |wires| wires);
    (control, handle, debts)
}

/// Writes a mark of this age, like an earlier run that tried to stop the unit until `tried`.
fn leave_tried_mark(folder: &Path, age_s: i64, tried: Option<i64>) -> Timestamp {
    let ago = |age_s| START - SignedDuration::from_secs(age_s);
    let (debts, mark) = (
        Debts::marked_in(Some(folder.to_owned())),
        Mark { start: Some(ago(age_s)), tried: tried.map(ago) },
    );
    debts.mark(&Unit::new(&antenna()), 0, mark);
    // Wait until the worker has written the mark.
    while debts.mark_kept(&Unit::new(&antenna())) == PromisedFile::Pending {
        std::thread::yield_now();
    }
    ago(age_s)
}

fn leave_mark(folder: &Path, age_s: i64) -> Timestamp {
    leave_tried_mark(folder, age_s, None)
}

fn stops(control: &Control) -> usize {
    control.received().iter().filter(|(_, payload)| payload == "STOP=").count()
}

async fn seconds(seconds: u64) {
    for _ in 0..seconds * 100 {
        sleep(Duration::from_millis(10)).await;
    }
}

fn reports(handle: &mut AntennaHandle) -> Vec<Safety> {
    let events = std::iter::from_fn(|| handle.next_event());
    let matters = events.filter_map(|event| match event {
        Event::Safety(matter) => Some(matter),
        _ => None,
    });
    matters.collect()
}

#[tokio::test(start_paused = true)]
async fn after_a_restart_stop_is_the_first_word_to_what_was_moved_by_hand() {
    let folder = tempfile::tempdir().unwrap();
    let time = leave_mark(folder.path(), 590);
    let (control, mut handle, debts) = start(folder.path());
    seconds(5).await;
    assert_eq!(control.received()[0].1, "STOP=");
    assert_eq!(reports(&mut handle), [Safety::LeftMoving { start: Some(time), asks: false }]);
    assert_eq!(debts.marked(&Unit::new(&antenna())), None, "standstill is proved");
}

#[tokio::test(start_paused = true)]
async fn an_old_mark_asks_and_stays_until_the_operator_has_seen_it_stand() {
    let folder = tempfile::tempdir().unwrap();
    let time = leave_mark(folder.path(), 610);
    let (control, mut handle, debts) = start(folder.path());
    seconds(20).await;
    assert_eq!(stops(&control), 0);
    assert_eq!(reports(&mut handle), [Safety::LeftMoving { start: Some(time), asks: true }]);
    assert_eq!(handle.snapshot().left_moving, Some(LeftMoving { start: Some(time) }));
    let mark = Mark { start: Some(time), tried: None };
    assert_eq!(debts.marked(&Unit::new(&antenna())), Some(mark), "nothing is tried");
    handle.send(Command::SeenStanding).unwrap();
    seconds(1).await;
    assert_eq!(handle.snapshot().left_moving, None);
    assert_eq!(debts.marked(&Unit::new(&antenna())), None);
    assert_eq!(stops(&control), 0);
}

#[tokio::test(start_paused = true)]
async fn a_mark_that_cannot_be_read_asks_and_names_no_time() {
    let folder = tempfile::tempdir().unwrap();
    leave_mark(folder.path(), 10);
    let files = std::fs::read_dir(folder.path()).unwrap();
    files.for_each(|file| std::fs::write(file.unwrap().path(), "since = ").unwrap());
    let (control, mut handle, _) = start(folder.path());
    seconds(5).await;
    assert_eq!(stops(&control), 0);
    assert_eq!(reports(&mut handle), [Safety::LeftMoving { start: None, asks: true }]);
    assert_eq!(handle.snapshot().left_moving, Some(LeftMoving { start: None }));
}

/// STOP would take the panel from the person who works on the unit.
#[tokio::test(start_paused = true)]
async fn where_another_may_have_the_panel_a_mark_asks_however_young_it_is() {
    let (horn, folder) = (Antenna::rc2000c("Horn", "in memory"), tempfile::tempdir().unwrap());
    let debts = Debts::marked_in(Some(folder.path().to_owned()));
    let time = START - SignedDuration::from_secs(20);
    debts.mark(&Unit::new(&horn), 0, Mark { start: Some(time), tried: None });
    while debts.mark_kept(&Unit::new(&horn)) == PromisedFile::Pending {
        std::thread::yield_now();
    }
    let clock = Clock::at_speed(START, NonZeroU32::MIN);
    let (bounds, now) = (Bounds::of_antenna(&horn), clock.now().steady);
    let (wires, mut handle) = Wires::new(&horn, bounds, now, Arc::new(|| {}), &Orders::default());
    let dials = Arc::new(AtomicBool::new(false));
    let dialled = Arc::clone(&dials);
    let dial: Dial = Box::new(move || {
        dialled.store(true, Ordering::Relaxed);
        Box::pin(async { Err(std::io::ErrorKind::ConnectionRefused.into()) })
    });
    let session = Session::with_wires(horn.controller(), &horn, dial, clock, wires, debts);
    tokio::spawn(session.run());
    seconds(5).await;
    assert_eq!(reports(&mut handle), [Safety::LeftMoving { start: Some(time), asks: true }]);
    assert!(!dials.load(Ordering::Relaxed));
}

#[tokio::test(start_paused = true)]
async fn the_age_of_a_mark_counts_from_the_last_try() {
    let folder = tempfile::tempdir().unwrap();
    let time = leave_tried_mark(folder.path(), 3600, Some(90));
    let (control, mut handle, _) = start(folder.path());
    seconds(5).await;
    assert_eq!(control.received()[0].1, "STOP=");
    assert_eq!(reports(&mut handle), [Safety::LeftMoving { start: Some(time), asks: false }]);
}

#[tokio::test(start_paused = true)]
async fn a_unit_out_of_reach_for_an_hour_gets_its_stop_first_after_a_kill() {
    for is_old in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        if is_old {
            leave_mark(folder.path(), 3600);
        }
        let (control, handle, debts) = start(folder.path());
        seconds(5).await;
        control.set_fault(Fault::Silence, true);
        handle.stop();
        seconds(3600).await;
        // Simulate a kill of the program here: only its file remains.
        let mark = debts.marked(&Unit::new(&antenna())).unwrap();
        let now = START + SignedDuration::from_secs(3605);
        assert!(seconds_between(mark.last_attempt().unwrap(), now).abs() <= 90.0, "{mark:?}");
        let killed = tempfile::tempdir().unwrap();
        Debts::marked_in(Some(killed.path().to_owned())).mark(&Unit::new(&antenna()), 0, mark);
        let debts = Debts::marked_in(Some(killed.path().to_owned()));
        while debts.marked(&Unit::new(&antenna())).is_none() {
            sleep(Duration::from_millis(1)).await;
        }
        let (next, _handle) = testing::start_at(now, debts);
        seconds(5).await;
        assert_eq!(next.received()[0].1, "STOP=");
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_answers_for_an_old_mark_too() {
    let folder = tempfile::tempdir().unwrap();
    leave_mark(folder.path(), 3600);
    let (control, handle, debts) = start(folder.path());
    seconds(5).await;
    handle.stop();
    seconds(5).await;
    assert!(stops(&control) > 0);
    assert_eq!(handle.snapshot().left_moving, None);
    assert_eq!(debts.marked(&Unit::new(&antenna())), None);
}

#[tokio::test(start_paused = true)]
async fn a_mark_that_cannot_be_written_is_told_and_the_jog_goes_out() {
    let folder = tempfile::tempdir().unwrap();
    let no_folder = folder.path().join("file");
    std::fs::write(&no_folder, "").unwrap();
    let (control, mut handle, _) = start(&no_folder);
    seconds(5).await;
    // An unreadable mark counts as a mark of unknown age.
    handle.send(Command::SeenStanding).unwrap();
    reports(&mut handle);
    handle.send(Command::Manual).unwrap();
    for _ in 0..20 {
        handle.send(Command::Jog { rates_deg_s: [0.5, 0.0] }).unwrap();
        sleep(Duration::from_millis(50)).await;
    }
    assert_eq!(reports(&mut handle), [Safety::NoMark]);
    let is_moved = control.received().iter().any(|(_, payload)| payload.starts_with("MOVE="));
    assert!(is_moved, "{:?}", handle.snapshot());
}

#[test]
fn a_disk_that_hangs_does_not_hold_up_the_stop_that_is_owed_at_the_end() {
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.enable_all().start_paused(true).max_blocking_threads(1).build().unwrap();
    runtime.block_on(async {
        let folder = tempfile::tempdir().unwrap();
        let (control, handle, debts) = start(folder.path());
        seconds(5).await;
        control.set_fault(Fault::Silence, true);
        // From now on, the disk neither writes nor reads.
        let (disk, hangs) = std::sync::mpsc::sync_channel::<()>(1);
        spawn_blocking(move || hangs.recv());
        handle.stop();
        advance(100).await;
        drop(handle);
        advance(5_000).await;
        control.set_fault(Fault::Silence, false);
        advance(10_000).await;
        assert!(!debts.owes(&Unit::new(&antenna())), "standstill is proved");
        drop(disk);
    });
}

/// A slow disk delays the motion for 300 ms; the motion ends before the disk responds.
#[tokio::test(start_paused = true)]
async fn a_mark_that_the_disk_takes_late_does_not_outlive_standstill() {
    let folder = tempfile::tempdir().unwrap();
    let (promises, disk) = SlowDisk::new();
    let debts = Debts::with_promises(Some(folder.path().to_owned()), promises);
    let (control, mut handle) = testing::start(debts.clone(), |wires| wires);
    seconds(5).await;
    handle.send(Command::Manual).unwrap();
    let pressed = Instant::now();
    for _ in 0..20 {
        handle.send(Command::Jog { rates_deg_s: [0.5, 0.0] }).unwrap();
        advance(50).await;
    }
    assert!(matches!(disk.begun(), FileState::Holds(_)));
    assert_eq!(reports(&mut handle), [Safety::NoMark]);
    let received = control.received();
    let (moved, _) = received.iter().find(|(_, payload)| payload.starts_with("MOVE=")).unwrap();
    let held_up = *moved - pressed;
    assert!((MAX..MAX + Duration::from_millis(100)).contains(&held_up), "{held_up:?}");
    handle.send(Command::EndJog).unwrap();
    advance(10_000).await;
    assert!(!debts.owes(&Unit::new(&antenna())), "standstill is proved");
    disk.go_on();
    assert_eq!(disk.begun(), FileState::Absent);
    disk.go_on();
    debts.wait_for_disk(&Unit::new(&antenna())).await;
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[tokio::test(start_paused = true)]
async fn a_stop_that_the_disk_does_not_take_says_why_until_it_does() {
    let folder = tempfile::tempdir().unwrap();
    let is_full = Arc::new(AtomicBool::new(true));
    let debts = Debts::with_promises(Some(folder.path().to_owned()), full_disk(&is_full));
    let (control, mut handle) = testing::start(debts.clone(), |wires| wires);
    seconds(5).await;
    control.set_fault(Fault::Silence, true);
    handle.stop();
    seconds(4).await;
    let reason = handle.snapshot().not_on_disk.clone().expect("a reason");
    assert!(reason.contains("no storage space"), "{reason}");
    assert_eq!(reports(&mut handle), [Safety::NoMark, Safety::SilentInMotion]);
    is_full.store(false, Ordering::Relaxed);
    seconds(12).await;
    assert_eq!(handle.snapshot().not_on_disk, None);
    assert_eq!(reports(&mut handle), [], "it is told once");
    let next = Debts::marked_in(Some(folder.path().to_owned()));
    assert!(next.is_marked(&Unit::new(&antenna())));
}

/// Advances the paused clock while the disk hangs.
async fn advance(milliseconds: u64) {
    for _ in 0..milliseconds / 10 {
        tokio::time::advance(Duration::from_millis(10)).await;
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_that_is_owed_is_on_disk_until_it_is_proved() {
    let folder = tempfile::tempdir().unwrap();
    let (control, handle, debts) = start(folder.path());
    let is_marked = || debts.marked(&Unit::new(&antenna())).is_some();
    seconds(5).await;
    control.set_fault(Fault::Silence, true);
    handle.stop();
    wait("it is on disk", is_marked).await;
    seconds(20).await;
    assert!(is_marked(), "the unit does not answer");
    control.set_fault(Fault::Silence, false);
    wait("standstill is proved", || !is_marked()).await;
}

/// Waits until `is_reached` holds. Also lets real time pass, for the disk.
async fn wait(goal: &str, is_reached: impl Fn() -> bool) {
    for _ in 0..2_000 {
        if is_reached() {
            return;
        }
        sleep(Duration::from_millis(10)).await;
        std::thread::yield_now();
    }
    panic!("{goal}: never");
}
