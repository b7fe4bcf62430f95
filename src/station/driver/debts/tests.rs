use std::{fs, path::Path};

use super::*;
use crate::station::Antenna;

fn unit(address: &str) -> Unit {
    Unit { make: "satrak".to_owned(), address: address.to_owned() }
}

fn time(text: &str) -> Timestamp {
    text.parse().unwrap()
}

fn start() -> Timestamp {
    time("2026-08-12T01:02:03Z")
}

fn mark(debts: &Debts, unit: &Unit, session: u64) {
    debts.mark(unit, session, Mark { start: Some(start()), tried: None });
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = files(folder)
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

#[test]
fn a_mark_outlives_the_program_until_it_is_taken_away() {
    let folder = tempfile::tempdir().unwrap();
    let (one, other) = (unit("10.0.0.5:4001"), unit("10.0.0.5_4001"));
    let debts = || Debts::marked_in(Some(folder.path().join("marks")));
    mark(&debts(), &one, 1);
    let next = debts();
    assert_eq!(next.marked(&one), Some(Mark { start: Some(start()), tried: None }));
    assert_eq!(next.left_moving(), std::slice::from_ref(&one));
    assert_eq!(next.marked(&other), None, "another address");
    next.unmark(&one, 1);
    assert_eq!((next.left_moving(), next.marked(&one)), (Vec::new(), None));
    assert_eq!(debts().marked(&one), None);
    debts().unmark(&one, 1);
}

/// At any kill time, the next start finds either the whole promise or none.
#[test]
fn killed_at_any_step_of_a_write_or_removal_the_next_start_knows_old_or_new() {
    let one = unit("10.0.0.5:4001");
    let written = tempfile::tempdir().unwrap();
    mark(&Debts::marked_in(Some(written.path().to_owned())), &one, 1);
    let text = fs::read_to_string(written.path().join(file_name(&one, STOP))).unwrap();

    let folder = tempfile::tempdir().unwrap();
    let [temporary, file] =
        [".tmpa1B2c3", &*file_name(&one, STOP)].map(|name| folder.path().join(name));
    let is_left = || {
        let next = Debts::marked_in(Some(folder.path().to_owned()));
        assert_eq!(next.left_moving().is_empty(), next.marked(&one).is_none());
        next.is_marked(&one)
    };
    assert!(!is_left(), "before the temporary file");
    fs::write(&temporary, &text[..text.len() / 2]).unwrap();
    assert!(!is_left(), "the temporary file is half written");
    fs::write(&temporary, &text).unwrap();
    assert!(!is_left(), "before the rename");
    fs::rename(&temporary, &file).unwrap();
    assert!(is_left(), "after the rename, and before the removal");
    fs::write(&temporary, &text[..text.len() / 2]).unwrap();
    assert!(is_left(), "a newer one is half written");
    fs::remove_file(&file).unwrap();
    assert!(!is_left(), "after the removal");
    // Only the names distinguish the files of the other promises.
    let debts = || Debts::marked_in(Some(folder.path().to_owned()));
    fs::write(&temporary, text).unwrap();
    debts().mark_auto_track_off(&one, start()).unwrap();
    assert_eq!((debts().with_auto_track(), debts().left_moving()), (vec![one], Vec::new()));
}

/// The files have the format of version f93e9bd5.
#[test]
fn files_of_an_earlier_version_mean_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "satrak-Dish-Local-4001-1f0b7f5d.toml",
        "make = \"satrak\"\naddress = \"Dish.Local:4001\"\nsince = \"2026-08-12T01:02:03Z\"\n",
    );
    write(
        "satrak-Mast-Local-4001-00000000.auto-track.toml",
        "make = \"satrak\"\naddress = \"Mast.Local:4001\"\nsince = \"2026-08-12T01:02:03Z\"\n",
    );
    write(
        "satrak-Horn-Local-4001-00000000.offsets.toml",
        "make = \"satrak\"\naddress = \"Horn.Local:4001\"\nsince = \"2026-08-12T01:02:03Z\"\n\n\
         [before]\nazimuth_deg = 0.25\nelevation_deg = -0.1\n\n\
         [[put]]\nazimuth_deg = 0.25\nelevation_deg = -0.1\n\n[[put]]\nazimuth_deg = 0.45\n",
    );
    for _ in 0..2 {
        let debts = Debts::marked_in(Some(folder.path().to_owned()));
        let dish = Unit::new(&Antenna::satrak("Dish", "DISH.local:4001"));
        assert_eq!(dish, unit("dish.local:4001"));
        assert_eq!(debts.left_moving(), std::slice::from_ref(&dish));
        assert_eq!(debts.marked(&dish), Some(Mark { start: Some(start()), tried: None }));
        assert_eq!(debts.with_auto_track(), [unit("mast.local:4001")]);
        let shifted = debts.shifted(&unit("horn.local:4001")).unwrap();
        assert_eq!((shifted.start, shifted.track, shifted.is_found), (start(), None, true));
        let [before, put] = [shifted.before, *shifted.put.last().unwrap()];
        assert_eq!((before.azimuth().degrees(), before.elevation().degrees()), (0.25, -0.1));
        assert_eq!((put.azimuth().degrees(), put.elevation().degrees()), (0.45, 0.0));
        assert_eq!(names(folder.path()).len(), 3, "{:?}", names(folder.path()));
    }
    let debts = Debts::marked_in(Some(folder.path().to_owned()));
    debts.unmark(&unit("dish.local:4001"), 1);
    debts.settle_auto_track(&unit("mast.local:4001"));
    debts.set_shifted(&unit("horn.local:4001"), None);
    assert_eq!(names(folder.path()), [""; 0]);
}

/// An earlier version must be able to read the files of this version.
#[test]
fn a_mark_has_the_form_of_earlier_versions() {
    let folder = tempfile::tempdir().unwrap();
    let (one, tried) = (unit("a:1"), time("2026-08-12T02:02:03Z"));
    let debts = Debts::marked_in(Some(folder.path().to_owned()));
    debts.mark(&one, 1, Mark { start: Some(start()), tried: Some(tried) });
    let text = fs::read_to_string(folder.path().join("satrak-a-1-f938eb55.toml"));
    assert_eq!(
        text.unwrap(),
        "make = \"satrak\"\naddress = \"a:1\"\nsince = \"2026-08-12T01:02:03Z\"\n\
         tried = \"2026-08-12T02:02:03Z\"\n"
    );
}

#[test]
fn the_age_of_a_mark_counts_from_the_last_try() {
    let folder = tempfile::tempdir().unwrap();
    let (one, tried) = (unit("a:1"), time("2026-08-12T02:02:03Z"));
    let debts = Debts::marked_in(Some(folder.path().to_owned()));
    debts.mark(&one, 1, Mark { start: Some(start()), tried: Some(tried) });
    let marked = Debts::marked_in(Some(folder.path().to_owned())).marked(&one).unwrap();
    assert_eq!((marked.start, marked.last_attempt()), (Some(start()), Some(tried)));
    assert_eq!(Mark { start: Some(start()), tried: None }.last_attempt(), Some(start()));
}

#[test]
fn a_mark_that_cannot_be_read_still_warns() {
    let folder = tempfile::tempdir().unwrap();
    let debts = Debts::marked_in(Some(folder.path().to_owned()));
    fs::write(folder.path().join(file_name(&unit("a:1"), STOP)), "since = ").unwrap();
    assert_eq!(debts.marked(&unit("a:1")).unwrap().start, None);
}

#[test]
fn the_removal_of_an_older_session_leaves_the_mark_of_a_newer_one() {
    let folder = tempfile::tempdir().unwrap();
    let debts = Debts::marked_in(Some(folder.path().to_owned()));
    let one = unit("a:1");
    let sessions = [(); 3].map(|()| debts.begin(&one, Arc::default()));
    mark(&debts, &one, sessions[0]);
    mark(&debts, &one, sessions[1]);
    debts.unmark(&one, sessions[0]);
    assert!(debts.is_marked(&one), "the newer session has marked it too");
    assert!(debts.take_over_mark(&one, sessions[2]).is_some());
    debts.unmark(&one, sessions[1]);
    assert!(debts.is_marked(&one), "the newest session has found it");
    debts.unmark(&one, sessions[2]);
    assert!(!debts.is_marked(&one));
}

#[test]
fn a_debt_goes_to_the_newest_session_of_its_unit() {
    let (debts, unit) = (Debts::default(), unit("a:1"));
    let (old, new) = (Arc::new(Notify::new()), Arc::new(Notify::new()));
    let first = debts.begin(&unit, old);
    debts.owe(&unit);
    assert!(!debts.hand_over(&unit, first), "nobody else is there");
    let second = debts.begin(&unit, Arc::clone(&new));
    assert!(second > first && debts.hand_over(&unit, first));
    assert!(is_notified(&new), "STOP is its first word");
    debts.settle(&unit);
    assert_eq!(debts.units(), []);
}

#[test]
fn auto_track_that_is_to_be_off_hands_no_stop_to_the_next_session() {
    let (debts, unit) = (Debts::default(), unit("a:1"));
    let first = debts.begin(&unit, Arc::default());
    debts.owe_auto_track_off(&unit);
    assert!(!debts.is_followed(&unit, first));
    let stop = Arc::new(Notify::new());
    debts.begin(&unit, Arc::clone(&stop));
    assert!(debts.is_followed(&unit, first) && !is_notified(&stop));
    assert_eq!(debts.with_auto_track(), std::slice::from_ref(&unit));
    debts.settle_auto_track(&unit);
    assert!(!debts.owes_auto_track_off(&unit));
}

#[test]
fn auto_track_that_is_to_be_off_outlives_the_program_until_it_is_settled() {
    let folder = tempfile::tempdir().unwrap();
    let debts = || Debts::marked_in(Some(folder.path().join("marks")));
    let (one, other) = (unit("10.0.0.5:4001"), unit("10.0.0.6:4001"));
    let first = debts();
    mark(&first, &other, 1);
    first.mark_auto_track_off(&one, Timestamp::UNIX_EPOCH).unwrap();
    first.owe_auto_track_off(&other);
    assert_eq!(first.with_auto_track(), [one.clone(), other.clone()]);
    assert_eq!(debts().marked(&one), None, "it is no STOP");
    let second = debts();
    assert_eq!(second.with_auto_track(), std::slice::from_ref(&one));
    second.leave(&one);
    assert_eq!(debts().with_auto_track(), std::slice::from_ref(&one), "another Azel owes it");
    let third = debts();
    third.settle_auto_track(&one);
    assert_eq!(debts().with_auto_track(), []);
    assert!(debts().marked(&other).is_some());
}

#[test]
fn a_record_of_auto_track_that_cannot_be_read_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(file_name(&unit("a:1"), AUTO_TRACK));
    fs::write(&path, "since = ").unwrap();
    assert_eq!(Debts::marked_in(Some(folder.path().to_owned())).with_auto_track(), []);
    assert!(path.exists());
}

#[test]
fn that_a_unit_is_not_known_to_stand_outlives_its_session() {
    let (debts, unit) = (Debts::default(), unit("a:1"));
    let first = debts.begin(&unit, Arc::default());
    let start = Instant::now();
    debts.keep_unproved(&unit, first, Some(start));
    let second = debts.begin(&unit, Arc::default());
    assert_eq!(debts.unproved_since(&unit), Some(start));
    debts.keep_unproved(&unit, first, None);
    assert_eq!(debts.unproved_since(&unit), Some(start), "the older one knows no better");
    debts.keep_unproved(&unit, second, None);
    assert_eq!(debts.unproved_since(&unit), None);
}

/// Returns `true` if a permit is available.
fn is_notified(notify: &Notify) -> bool {
    use std::{
        future::Future as _,
        task::{Context, Waker},
    };
    let mut notified = Box::pin(notify.notified());
    notified.as_mut().poll(&mut Context::from_waker(Waker::noop())).is_ready()
}
