//! Tests of writing and reading the film.

use std::{fs, path::Path, sync::Arc};

use jiff::ToSpan as _;
use serde_json::{Value, json};

use super::{recorder, rows, start};
use crate::{
    clock::{Instant, Moment},
    record::{Film, Kind, Parts, Picture, RowKind, file, film::Camera, keeping},
    station::Retention,
};

/// Picture with two numbers, a part, and a value that changes every ten seconds.
struct FilmFigures {
    second: f64,
    value: i64,
    part: Arc<String>,
    stands: Arc<i64>,
}

fn time(second: f64) -> jiff::Timestamp {
    crate::astro::time::add_seconds(start(), second)
}

impl Picture for FilmFigures {
    fn moment(&self) -> Moment {
        Moment { utc: time(self.second), steady: Instant::now() }
    }

    fn draw(&self, parts: &mut Parts) -> serde_json::Result<Value> {
        let part = parts.number(&self.part)?;
        let is_same = parts.is_same("/stands".to_owned(), &self.stands);
        let stands = if is_same { Value::from("not drawn") } else { json!(*self.stands) };
        Ok(json!({
            "second": self.second, "value": self.value, "part": part, "stands": stands,
        }))
    }
}

/// Records one picture a second.
fn film(path: &Path, seconds: std::ops::Range<u32>, part: &Arc<String>) {
    let recorder = recorder(path);
    let mut stands = Arc::new(-1);
    for second in seconds {
        let (second, value) = (f64::from(second), i64::from(second / 10));
        if *stands != value {
            stands = Arc::new(value);
        }
        let (part, stands) = (Arc::clone(part), Arc::clone(&stands));
        recorder.film(Arc::new(FilmFigures { second, value, part, stands }));
        if value % 3 == 0 {
            recorder.flush();
        }
    }
}

fn shown(film: &mut Film, second: f64) -> Option<(f64, i64, String)> {
    let shown = film.seek(time(second)).unwrap()?;
    let (run, picture) = (shown.run, shown.picture.clone());
    let part = film.part(run, picture["part"].as_i64().unwrap()).unwrap();
    let part: String = serde_json::from_slice(&part).unwrap();
    assert_eq!(picture["stands"], picture["value"]);
    Some((picture["second"].as_f64()?, picture["value"].as_i64()?, part))
}

/// Returns `true` if the film shows the picture of second `expected` at `second`.
fn shows(film: &mut Film, second: f64, expected: f64) -> bool {
    shown(film, second).is_some_and(|(shown, ..)| (shown - expected).abs() < 1e-9)
}

#[test]
fn every_moment_is_shown_again_whichever_way_it_is_come_by() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    film(&path, 0..200, &Arc::new("first".to_owned()));
    film(&path, 300..320, &Arc::new("second".to_owned()));
    let mut film = Film::open(&path).unwrap();
    assert_eq!(film.span().unwrap(), Some((time(0.0), time(319.0))));
    assert_eq!(shown(&mut film, -1.0), None);
    for second in (0..200).chain((0..200).rev()).chain([7, 180, 61, 60, 62]) {
        let second = f64::from(second);
        let shown = shown(&mut film, second + 0.5).unwrap();
        assert_eq!(shown, (second, (second / 10.0) as i64, "first".to_owned()));
    }
    assert_eq!(shown(&mut film, 250.0).unwrap().1, 19, "the last one before");
    assert_eq!(shown(&mut film, 310.2).unwrap(), (310.0, 31, "second".to_owned()));
}

#[test]
fn a_hole_in_the_film_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let part = Arc::new(String::new());
    film(&path, 0..200, &part);
    film(&path, 300..420, &part);
    let film = Film::open(&path).unwrap();
    let hole = |start: f64, end: f64| film.hole(time(start), time(end)).unwrap();
    assert_eq!(hole(100.0, 310.0), Some((time(199.0), time(300.0))));
    assert_eq!(hole(250.0, 310.0), Some((time(250.0), time(300.0))));
    assert_eq!(hole(100.0, 250.0), None, "it stands there");
    assert_eq!(hole(20.0, 190.0), None);
    assert_eq!(hole(305.0, 419.0), None);
    assert_eq!(hole(-50.0, 5.0), Some((time(-50.0), time(0.0))), "nothing is kept from before");
    let hole_around = |second: f64| film.hole_at(time(second)).unwrap();
    let all = (time(199.0), time(300.0) + 1.microsecond());
    assert_eq!((hole_around(250.0), hole_around(199.5)), (Some(all), Some(all)));
    let first = (time(-1.0), time(0.0) + 1.microsecond());
    assert_eq!(hole_around(-1.0), Some(first), "before all film that is kept");
    for second in [0.5, 59.7, 199.0, 300.0, 300.5, 419.0, 500.0] {
        assert_eq!(hole_around(second), None, "{second}");
    }
}

#[test]
fn pictures_that_were_lost_within_a_run_are_told_as_a_hole() {
    let folder = tempfile::tempdir().unwrap();
    let blocked = folder.path().join("records");
    let path = blocked.join("record.sqlite");
    let recorder = recorder(&path);
    // Some pictures are so large that they exceed the max size of pending pictures.
    let take = |second: u32, size: usize| {
        let (second, value) = (f64::from(second), i64::from(second / 10));
        let part = Arc::new("x".repeat(size));
        recorder.film(Arc::new(FilmFigures { second, value, part, stands: Arc::new(value) }));
    };
    (0..30).for_each(|second| take(second, 10));
    recorder.flush();
    // A file blocks the place of the folder.
    let aside_path = folder.path().join("aside");
    fs::rename(&blocked, &aside_path).unwrap();
    fs::write(&blocked, "").unwrap();
    for second in 30..70 {
        take(second, 1 << 20);
    }
    recorder.flush();
    fs::remove_file(&blocked).unwrap();
    fs::rename(&aside_path, &blocked).unwrap();
    (70..90).for_each(|second| take(second, 10));
    recorder.flush();

    let mut film = Film::open(&path).unwrap();
    let (end, start) = film.hole_at(time(40.0)).unwrap().expect("a hole");
    let gaps = rows(&path, RowKind::Entry(Kind::Gap));
    let lost: u64 = gaps.iter().map(|gap| gap.data["pictures"].as_u64().unwrap()).sum();
    assert_eq!(end, time(29.0));
    assert_eq!(start, time(30.0 + lost as f64) + 1.microsecond(), "{gaps:?}");
    assert!((16..40).contains(&lost), "{lost}");
    assert_eq!(film.hole(time(10.0), time(80.0)).unwrap(), Some((end, start - 1.microsecond())));
    assert_eq!(film.hole(time(10.0), time(29.0)).unwrap(), None);
    let again = 30.0 + lost as f64;
    for second in [10.0, 28.0, again, again + 1.0, 80.0] {
        assert_eq!(film.hole_at(time(second + 0.5)).unwrap(), None);
        assert!(shows(&mut film, second + 0.5, second));
    }
}

#[test]
fn a_picture_for_which_there_was_no_room_is_told_as_a_hole() {
    let mut camera = Camera::default();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let part = Arc::new(String::new());
    for second in (0..10).chain(20..30) {
        let (second, value) = (f64::from(second), i64::from(second));
        if value == 20 {
            camera.cut();
        }
        let (part, stands) = (Arc::clone(&part), Arc::new(value));
        camera.take(&FilmFigures { second, value, part, stands });
    }
    let mut db = file::open(&path).unwrap();
    let tx = db.transaction().unwrap();
    camera.write(&tx, 1).unwrap();
    tx.commit().unwrap();
    let mut film = Film::open(&path).unwrap();
    assert_eq!(film.hole_at(time(15.0)).unwrap(), Some((time(9.0), time(20.0) + 1.microsecond())));
    assert_eq!(film.hole_at(time(25.5)).unwrap(), None);
    assert!(shows(&mut film, 25.5, 25.0));
}

#[test]
fn a_reel_that_is_written_again_as_one_piece_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let recorder = recorder(&path);
    let take = |second: f64| {
        let (value, part) = (second as i64, Arc::default());
        recorder.film(Arc::new(FilmFigures { second, value, part, stands: Arc::new(value) }));
    };
    take(0.0);
    recorder.flush();
    let mut film = Film::open(&path).unwrap();
    assert!(shows(&mut film, 5.0, 0.0));
    for second in [1.0, 2.0, 90.0] {
        take(second);
    }
    recorder.flush();
    assert!(shows(&mut film, 5.0, 2.0));
}

#[test]
fn the_film_goes_on_while_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let recorder = recorder(&path);
    let part = Arc::new(String::new());
    let take = |second| {
        let value = second as i64;
        let (part, stands) = (Arc::clone(&part), Arc::new(value));
        recorder.film(Arc::new(FilmFigures { second, value, part, stands }));
        recorder.flush();
    };
    take(0.0);
    let mut film = Film::open(&path).unwrap();
    assert_eq!(shown(&mut film, 5.0).unwrap().1, 0);
    take(1.0);
    assert_eq!(shown(&mut film, 5.0).unwrap().1, 1);
    take(90.0);
    assert_eq!(shown(&mut film, 5.0).unwrap().1, 1);
    assert_eq!(shown(&mut film, 95.0).unwrap().1, 90);
}

#[test]
fn what_is_older_than_it_is_kept_goes_and_the_rest_can_be_shown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    film(&path, 0..400, &Arc::new("part".to_owned()));
    let db = file::open(&path).unwrap();
    let keeping = Retention { raw_days: 1.0, ..Retention::default() };
    let now = (time(150.0) + 24.hours()).as_microsecond();
    while keeping::remove_old(&db, keeping, now).unwrap() {}
    let mut film = Film::open(&path).unwrap();
    let (first, _) = film.span().unwrap().unwrap();
    assert!((time(120.0)..time(190.0)).contains(&first), "{first}");
    assert_eq!(shown(&mut film, 60.0), None);
    assert_eq!(shown(&mut film, 399.0).unwrap().2, "part");
    let much_later = now + 24 * 3_600_000_000;
    while keeping::remove_old(&db, keeping, much_later).unwrap() {}
    let left: i64 = db.query_row("SELECT count(*) FROM part", [], |row| row.get(0)).unwrap();
    assert_eq!((left, film.span().unwrap()), (0, None));
}

#[test]
fn a_record_from_before_the_film_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let db = file::open(&path).unwrap();
    db.execute_batch("DROP TABLE reel; DROP TABLE part; PRAGMA user_version = 1").unwrap();
    drop(db);
    assert!(Film::open(&path).is_err());
    film(&path, 0..11, &Arc::default());
    assert_eq!(shown(&mut Film::open(&path).unwrap(), 10.0).unwrap().1, 1);
}
