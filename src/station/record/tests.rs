//! Tests of writing and reading the record.

mod along;
mod film;
mod passes;
mod past;

use std::{
    fs,
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use jiff::{Timestamp, ToSpan as _};
use serde_json::{Value, json};

use super::{
    Entry, Kind, Query, Record, RecordError, RecordedSession, Recorder, RowKind, file, keeping,
    testing,
};
use crate::{
    astro::Angle,
    clock::{Clock, Instant, Moment},
    contract::{
        driver::{MAX_LINES, WireLog},
        record::Row,
    },
    device::{Axis, AxisMotion, Direction, Drive, Finding, Meaning, Measured, Pointing, WireLine},
    driver::PositionLog,
    station::{AntennaId, Retention},
};

const DISH: AntennaId = AntennaId(4);

fn start() -> Timestamp {
    "2026-03-01T12:00:00Z".parse().unwrap()
}

fn clock() -> Clock {
    Clock::new(start)
}

fn recorder(path: &Path) -> Recorder {
    Recorder::start(path.to_owned(), clock(), Retention::default()).unwrap()
}

/// Logs of a recorded session.
struct Logs {
    wire: WireLog,
    positions: PositionLog,
    steady: Instant,
}

impl Logs {
    fn followed_by(recorder: &Recorder) -> Self {
        Self::new(DISH, recorder)
    }

    fn new(antenna: AntennaId, recorder: &Recorder) -> Self {
        let (wire, positions) = (WireLog::default(), PositionLog::default());
        recorder.follow(RecordedSession {
            moment: clock().now(),
            antenna,
            name: "Dish".to_owned(),
            make: "satrak",
            wire: wire.clone(),
            positions: positions.clone(),
        });
        Self { wire, positions, steady: Instant::now() }
    }

    fn line(&self, bytes: &[u8], finding: Finding, is_poll: bool) {
        self.wire.push(WireLine {
            meaning: Some(Meaning::plain("Asks for the position")),
            is_poll,
            reply_after: Some(Duration::from_millis(20)),
            ..WireLine::new(Direction::Sent, bytes, finding, start())
        });
    }

    fn position(&mut self, azimuth_deg: f64) {
        self.position_at(start(), azimuth_deg);
    }

    fn position_at(&mut self, time: Timestamp, azimuth_deg: f64) {
        self.steady += Duration::from_millis(100);
        let axis = |angle_deg| Axis {
            angle_deg,
            motion: AxisMotion::Minus,
            drive: Drive::On,
            plus_limit: false,
            minus_limit: true,
        };
        self.positions.push(Measured {
            time,
            requested: self.steady,
            received: self.steady,
            pointing: Pointing { azimuth: Some(Angle::from_degrees(azimuth_deg)), elevation: None },
            axes: [axis(Some(azimuth_deg - 360.0)), axis(None)],
        });
    }
}

fn entry(number: u32) -> Entry {
    let moment = Moment { steady: Instant::now(), utc: start() };
    Entry::new(moment, Some(DISH), Kind::Event, &json!({ "number": number }))
}

fn rows_of(path: &Path, query: &Query) -> Vec<Row> {
    let mut rows = Vec::new();
    let take = &mut |row| {
        rows.push(row);
        true
    };
    Record::open(path).unwrap().read(query, take).unwrap();
    rows
}

fn rows(path: &Path, row_kind: RowKind) -> Vec<Row> {
    rows_of(path, &Query { row_kinds: vec![row_kind], ..Query::default() })
}

fn events(path: &Path) -> Vec<u64> {
    let number = |row: &Row| row.data["number"].as_u64().unwrap();
    rows(path, RowKind::Entry(Kind::Event)).iter().map(number).collect()
}

#[test]
fn entries_positions_and_lines_are_read_as_they_were_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("records").join("a.sqlite");
    let recorder = recorder(&path);
    let mut logs = Logs::followed_by(&recorder);
    logs.line(b"?P\\\r", Finding::Good, false);
    logs.line(b"?P\r", Finding::Good, true);
    logs.line(b"?P", Finding::Unfinished, true);
    logs.position(359.123_44);
    recorder.note(entry(7));
    recorder.flush();

    let positions = rows(&path, RowKind::Position);
    let [position] = &positions[..] else { panic!("{positions:?}") };
    assert_eq!((position.time, position.antenna.as_deref()), (start(), Some("Dish")));
    assert_eq!(
        position.data,
        json!({
            "azimuth_deg": 359.1234, "elevation_deg": null, "axes_deg": [-0.8766, null],
            "motion": [-1, -1], "limits": 0b1010,
        })
    );
    let frames = rows(&path, RowKind::Frame);
    let frames_named =
        |name: &str| -> Vec<&Value> { frames.iter().map(|row| &row.data[name]).collect() };
    assert_eq!(frames_named("bytes"), [r"?P\\\r", r"?P\r", "?P"]);
    // The record omits the meaning of good polls: most lines are polls, and their bytes say the
    // same.
    let asks = json!("Asks for the position");
    assert_eq!(frames_named("meaning"), [&asks, &Value::Null, &asks]);
    assert_eq!(frames_named("fault"), [&Value::Null, &Value::Null, &json!("Unfinished")]);
    assert_eq!(events(&path), [7]);
    // Select rows by antenna and time.
    let of_kinds = |antenna: &str, begin: Option<Timestamp>, row_kinds: Vec<RowKind>| {
        rows_of(
            &path,
            &Query { antenna: Some(antenna.to_owned()), start: begin, row_kinds, end: None },
        )
        .len()
    };
    let rows = |antenna: &str, begin| of_kinds(antenna, begin, RowKind::all().collect());
    let raw = || vec![RowKind::Position, RowKind::Frame];
    assert_eq!((rows("Dish", None), rows("Mast", None)), (5, 0));
    assert_eq!((of_kinds("Dish", None, raw()), of_kinds("Mast", None, raw())), (4, 0));
    assert_eq!(rows("Dish", Some(start() + Duration::from_secs(1))), 0);
}

#[test]
fn a_reader_goes_on_where_it_has_ended() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    let recorder = recorder(&path);
    recorder.note(entry(1));
    recorder.flush();
    let mut record = Record::open(&path).unwrap();
    let query = Query { row_kinds: vec![RowKind::Entry(Kind::Event)], ..Query::default() };
    let read = |record: &mut Record| {
        let mut numbers = Vec::new();
        let take = &mut |row: Row| {
            numbers.push(row.data["number"].as_u64().unwrap());
            true
        };
        record.read(&query, take).unwrap();
        numbers
    };
    assert_eq!(read(&mut record), [1]);
    assert_eq!(read(&mut record), [0; 0]);
    recorder.note(entry(2));
    recorder.note(entry(3));
    recorder.flush();
    assert_eq!(read(&mut record), [2, 3]);
}

#[test]
fn what_one_antenna_measured_before_another_and_told_later_is_read_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    let recorder = recorder(&path);
    let mut first = Logs::followed_by(&recorder);
    let mut second = Logs::new(AntennaId(5), &recorder);
    first.position_at(start() + Duration::from_secs(1), 10.0);
    second.position_at(start(), 20.0);
    recorder.flush();
    let mut record = Record::open(&path).unwrap();
    let query = Query { row_kinds: vec![RowKind::Position], ..Query::default() };
    let azimuths = |record: &mut Record| {
        let mut found = Vec::new();
        let take = &mut |row: Row| {
            found.push(row.data["azimuth_deg"].as_f64().unwrap());
            true
        };
        record.read(&query, take).unwrap();
        found
    };
    assert_eq!(azimuths(&mut record), [20.0, 10.0]);
    second.position_at(start() + Duration::from_millis(500), 21.0);
    recorder.flush();
    assert_eq!(azimuths(&mut record), [21.0]);
    assert_eq!(azimuths(&mut record), [0.0; 0]);
}

#[test]
fn what_waits_for_a_disk_is_written_later_and_nothing_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let blocked = folder.path().join("records");
    // A file blocks the place of the folder.
    fs::write(&blocked, "").unwrap();
    let path = blocked.join("a.sqlite");
    let recorder = recorder(&path);
    let mut logs = Logs::followed_by(&recorder);
    recorder.note(entry(1));
    logs.position(1.0);
    recorder.flush();
    let failing = recorder.status().failing.expect("nothing can be written");
    assert_eq!(failing.last_write, start());
    fs::remove_file(&blocked).unwrap();
    recorder.note(entry(2));
    logs.position(2.0);
    recorder.flush();
    assert_eq!(recorder.status().failing, None);
    assert_eq!(events(&path), [1, 2]);
    assert_eq!(rows(&path, RowKind::Position).len(), 2);
    assert_eq!(rows(&path, RowKind::Entry(Kind::Gap)), [], "nothing is missing");
}

#[test]
fn what_did_not_fit_is_counted_and_marked() {
    let folder = tempfile::tempdir().unwrap();
    let blocked = folder.path().join("records");
    fs::write(&blocked, "").unwrap();
    let path = blocked.join("a.sqlite");
    let recorder = recorder(&path);
    let logs = Logs::followed_by(&recorder);
    for _ in 0..MAX_LINES + 7 {
        logs.line(b"x", Finding::Good, true);
    }
    recorder.flush();
    fs::remove_file(&blocked).unwrap();
    recorder.flush();
    let gaps = rows(&path, RowKind::Entry(Kind::Gap));
    let [gap] = &gaps[..] else { panic!("{gaps:?}") };
    let counts = ["frames", "positions", "entries"].map(|name| gap.data[name].as_u64().unwrap());
    assert_eq!(counts, [7, 0, 0]);
    assert_eq!(rows(&path, RowKind::Frame).len(), MAX_LINES);
    recorder.flush();
    assert_eq!(rows(&path, RowKind::Entry(Kind::Gap)).len(), 1, "marked once");
    assert_eq!(recorder.status().gaps, 1);
}

#[test]
fn a_file_that_is_no_record_is_kept_beside_a_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    fs::write(&path, "letters to my grandmother, of some length, so that it is no header").unwrap();
    let recorder = recorder(&path);
    recorder.note(entry(1));
    recorder.flush();
    recorder.flush();
    assert_eq!(events(&path), [1]);
    let files = fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path());
    let files = files.filter(|file| file.to_string_lossy().contains("unreadable"));
    let texts: Vec<String> = files.map(|file| fs::read_to_string(file).unwrap()).collect();
    assert!(matches!(&texts[..], [text] if text.starts_with("letters")), "{texts:?}");
}

#[test]
fn a_record_of_a_newer_program_is_left_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    drop(recorder(&path));
    let db = rusqlite::Connection::open(&path).unwrap();
    db.pragma_update(None, "user_version", 3).unwrap();
    drop(db);
    let before = fs::read(&path).unwrap();
    let recorder = recorder(&path);
    recorder.note(entry(1));
    recorder.flush();
    let failing = recorder.status().failing.unwrap();
    assert!(failing.reason.starts_with("the record was written by a newer Azel (schema 3; "));
    assert!(matches!(Record::open(&path), Err(RecordError::Newer(3))));
    drop(recorder);
    assert_eq!(fs::read(&path).unwrap(), before);
}

#[test]
fn a_record_that_is_removed_while_it_is_written_is_begun_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    let recorder = recorder(&path);
    let mut logs = Logs::followed_by(&recorder);
    logs.position(1.0);
    recorder.note(entry(1));
    recorder.flush();
    fs::remove_file(&path).unwrap();
    logs.position(2.0);
    recorder.note(entry(2));
    recorder.flush();
    recorder.flush();
    assert_eq!(recorder.status().removed, Some(start()));
    let removed = json!({ "previous_record": "removed" });
    let runs = rows(&path, RowKind::Entry(Kind::Run));
    assert_eq!(runs.iter().filter(|row| row.data == removed).count(), 1);
    assert_eq!(events(&path), [2]);
    let positions = rows(&path, RowKind::Position);
    assert_eq!(positions.len(), 1);
    assert_eq!(positions[0].antenna.as_deref(), Some("Dish"), "it is named again");
}

#[test]
fn a_record_in_whose_place_another_file_is_put_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let (path, other) = (folder.path().join("a.sqlite"), folder.path().join("b.sqlite"));
    drop(recorder(&other));
    let recorder = recorder(&path);
    recorder.note(entry(1));
    recorder.flush();
    assert_eq!(recorder.status().removed, None);
    fs::rename(&other, &path).unwrap();
    recorder.note(entry(2));
    recorder.flush();
    assert_eq!(recorder.status().removed, Some(start()));
    assert_eq!(events(&path), [2]);
}

#[test]
fn old_positions_and_lines_go_and_entries_stay() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    {
        let recorder = recorder(&path);
        let mut logs = Logs::followed_by(&recorder);
        logs.position(1.0);
        logs.line(b"x", Finding::Good, true);
        recorder.note(entry(1));
        recorder.flush();
        assert_eq!(rows(&path, RowKind::Position).len(), 1);
    }
    let later = || start() + Duration::from_hours(8 * 24);
    let keeping = Retention { raw_days: 7.0, years: 1.0 };
    let recorder = Recorder::start(path.clone(), Clock::new(later), keeping).unwrap();
    recorder.flush();
    assert_eq!(rows(&path, RowKind::Position), []);
    assert_eq!(rows(&path, RowKind::Frame), []);
    assert_eq!(events(&path), [1]);
    drop(recorder);
    for day in (36..=400).step_by(28) {
        start_on_day(&path, day, keeping);
    }
    assert_eq!(events(&path), [0; 0]);
}

/// Records briefly on the given day after the start.
fn start_on_day(path: &Path, day: u64, keeping: Retention) {
    let clock = Clock::new(move || start() + Duration::from_hours(24 * day));
    let recorder = Recorder::start(path.to_owned(), clock, keeping).unwrap();
    recorder.flush();
    recorder.flush();
}

#[test]
fn a_clock_that_is_years_ahead_at_the_start_removes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    testing::record(&path, [testing::note(DISH, 43013, start())]);
    let wrong = || start() + Duration::from_hours(30 * 365 * 24);
    let recorder = recorder(&path);
    let mut logs = Logs::followed_by(&recorder);
    logs.position(1.0);
    recorder.note(entry(1));
    recorder.flush();
    drop(recorder);
    let count = || {
        let kinds = [RowKind::Position, RowKind::Pass, RowKind::Entry(Kind::Event)];
        kinds.map(|kind| rows(&path, kind).len())
    };
    // Entries that the first start wrote with the wrong clock do not make it trusted.
    for _ in 0..2 {
        let recorder =
            Recorder::start(path.clone(), Clock::new(wrong), Retention::default()).unwrap();
        recorder.flush();
        recorder.flush();
        assert_eq!(count(), [1, 1, 1]);
    }
    let right = || start() + Duration::from_hours(8 * 24);
    let recorder = Recorder::start(path.clone(), Clock::new(right), Retention::default()).unwrap();
    recorder.flush();
    assert_eq!(count(), [0, 1, 1]);
}

#[test]
fn the_file_gives_its_space_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    {
        let recorder = recorder(&path);
        let logs = Logs::followed_by(&recorder);
        for _ in 0..MAX_LINES {
            logs.line(&[b'x'; 100], Finding::Good, true);
        }
        recorder.flush();
    }
    let full = fs::metadata(&path).unwrap().len();
    let later = || start() + Duration::from_hours(8 * 24);
    let recorder = Recorder::start(path.clone(), Clock::new(later), Retention::default()).unwrap();
    for _ in 0..20 {
        recorder.flush();
    }
    drop(recorder);
    let left = fs::metadata(&path).unwrap().len();
    assert!(left < full / 2, "{left} of {full} bytes");
}

#[test]
fn a_clock_that_may_be_wrong_is_trusted_after_a_day() {
    let folder = tempfile::tempdir().unwrap();
    let db = file::open(&folder.path().join("a.sqlite")).unwrap();
    let us = |days: i64| (start() + (24 * days).hours()).as_microsecond();
    let trusts = |days, hours| keeping::trusts(&db, us(days), Duration::from_hours(hours)).unwrap();
    assert!(trusts(0, 0), "of a new record");
    assert!(trusts(29, 0), "after a pause");
    assert!(!trusts(60, 0) && !trusts(60, 23));
    assert!(trusts(58, 0), "the last time was not noted");
    assert!(trusts(90, 24));
    assert!(trusts(91, 0));
    assert!(trusts(40, 0) && trusts(91, 0), "a clock that is behind changes nothing");
    assert!(trusts(40, 24), "it was ahead before");
    assert!(!trusts(91, 0));
    // A station that closes every evening has a clock that continues from day to day.
    assert!(trusts(93, 2), "a pause of 50 days");
    assert!(!trusts(900, 2) && !trusts(900, 3), "each start has the same wrong clock");
    assert!(!trusts(1_900, 2), "another one");
    assert!(trusts(94, 2));
}

#[test]
fn a_clock_that_jumps_removes_nothing() {
    static JUMPED: AtomicBool = AtomicBool::new(false);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    let clock = Clock::new(|| {
        let years = if JUMPED.load(Ordering::Relaxed) { 70 } else { 0 };
        start() + Duration::from_hours(years * 365 * 24)
    });
    let recorder = Recorder::start(path.clone(), clock, Retention::default()).unwrap();
    let mut logs = Logs::followed_by(&recorder);
    logs.position(1.0);
    recorder.note(entry(1));
    JUMPED.store(true, Ordering::Relaxed);
    recorder.flush();
    recorder.flush();
    assert_eq!((rows(&path, RowKind::Position).len(), events(&path)), (1, vec![1]));
}

#[cfg(unix)]
#[test]
fn a_record_is_for_its_owner_alone() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.sqlite");
    let recorder = recorder(&path);
    recorder.flush();
    let mode = fs::metadata(&path).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}
