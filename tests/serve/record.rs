//! The record of a station without a window, and `azel log`.

use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Command as Process, Stdio},
    time::{Duration, Instant},
};

use azel::{
    contract::record::Row,
    engine::record_path,
    record::{Kind, Query, Record, RowKind},
};
use jiff::{SignedDuration, Timestamp};
use serde_json::Value;

use super::{PATIENCE, Served, Units, program, says, wait_for};

/// Number of kills in the short form; `AZEL_KILLS` sets another number, such as 100 for five
/// minutes.
const KILLS: u32 = 3;
/// Max time of the record that a crash may cost.
const LOST: SignedDuration = SignedDuration::from_secs(1);
/// Max time between two measured positions at two questions a second. Azel keeps positions measured
/// up to [`LOST`] before a crash; the last of them may be older by this time.
const BETWEEN: SignedDuration = SignedDuration::from_millis(700);

fn place(units: &Units) -> PathBuf {
    record_path(&units.folder.path().join("data/azel/records"), &units.path())
}

pub(crate) fn rows(path: &Path, what: RowKind) -> Vec<Row> {
    let mut rows = Vec::new();
    let query = Query { row_kinds: vec![what], ..Query::default() };
    let Ok(mut record) = Record::open(path) else { return rows };
    let read = record.read(&query, &mut |row| {
        rows.push(row);
        true
    });
    read.unwrap();
    rows
}

/// Runs `azel log` with these arguments and returns its lines.
fn log(units: &Units, arguments: &[&str]) -> Vec<Value> {
    let output = program(units).arg("log").args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    says(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn the_log_tells_what_was_asked_of_a_station_and_what_was_measured() {
    let units = Units::start(|_| {});
    let mut served = Served::start(&units);
    served.until(|told| told["antenna"] == "Mast" && told["about"] == "motion");
    let mut follower = program(&units)
        // The follower may start after the STOP.
        .args(["log", "--follow", "--from", "2000-01-01", "--kind", "stop"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let stop = program(&units).args(["stop", "--antenna", "Mast"]).output().unwrap();
    assert!(says(&stop).contains("Mast: stands"));
    let lines = BufReader::new(follower.stdout.take().unwrap()).lines();
    let mut told = lines.map(|line| serde_json::from_str::<Value>(&line.unwrap()).unwrap());
    let pressed = told.find(|told| told["data"]["by"] == "program").unwrap();
    assert_eq!(pressed["kind"], "stop");
    follower.kill().unwrap();
    follower.wait().unwrap();
    served.signal("TERM");
    served.process.wait().unwrap();

    let entries = log(&units, &[]);
    let of = |kind: &str| -> Vec<&Value> {
        entries.iter().filter(|entry| entry["kind"] == kind).collect()
    };
    assert_eq!(of("run").len(), 2, "its beginning and its end");
    let station = of("station");
    assert_eq!(station[0]["data"]["station"]["antenna"][1]["name"], "Mast");
    assert!(of("link").iter().any(|link| link["antenna"] == "Dish"));
    assert!(of("state").iter().any(|state| state["data"]["link"] == "up"));
    let ends = of("command");
    assert!(
        ends.iter()
            .any(|it| it["data"]["by"] == "serve" && it["data"]["command"]["CloseAfter"] == "Hold"),
        "{ends:?}"
    );
    let stopped = of("stop");
    assert!(stopped.iter().any(|it| it["antenna"] == "Mast" && it["data"] == "Stopped"));
    // Compare times: as texts, a time with fewer digits would come later.
    let time = |entry: &Value| entry["time"].as_str().unwrap().parse::<Timestamp>().unwrap();
    assert!(entries.is_sorted_by_key(time), "{:?}", entries.iter().map(time).collect::<Vec<_>>());

    let raw = log(&units, &["--antenna", "Mast", "--kind", "position,frame"]);
    let positions = raw.iter().filter(|row| row["kind"] == "position");
    let angles = positions.map(|row| row["data"]["azimuth_deg"].as_f64().unwrap());
    assert!(angles.count() > 1);
    let is_sent = |row: &&Value| row["data"]["is_sent"] == true;
    assert!(raw.iter().filter(is_sent).count() > 1);
    assert!(raw.iter().all(|row| row["antenna"] == "Mast"));
    let from = raw[raw.len() / 2]["time"].as_str().unwrap();
    let later = log(&units, &["--antenna", "Mast", "--kind", "position,frame", "--from", from]);
    assert!(later.len() < raw.len() && later.len() >= raw.len() / 2);
    let unknown = program(&units).args(["log", "--kind", "weather"]).output().unwrap();
    assert_eq!(unknown.status.code(), Some(2));
}

/// Counts the STOPs in a run that another program pressed.
fn stops_in_run(path: &Path, run: u32) -> usize {
    let stops = rows(path, RowKind::Entry(Kind::Stop)).into_iter();
    stops.filter(|row| row.run == i64::from(run) && row.data["by"] == "program").count()
}

#[test]
fn a_program_that_is_killed_loses_less_than_a_second_of_its_record() {
    let kills = std::env::var("AZEL_KILLS").map_or(KILLS, |kills| kills.parse().unwrap());
    let units = Units::start(|_| {});
    let path = place(&units);
    let mut worst = SignedDuration::ZERO;
    let mut before = 0;
    let mut entries = (0, 0);
    for kill in 1..=kills {
        let begun = Timestamp::now();
        let served = Served::start(&units);
        // The clocks of the units show another time of day than this program.
        wait_for("positions of this run", || {
            let rows = rows(&path, RowKind::Position);
            rows.iter().any(|row| row.run == i64::from(kill) && row.time > begun).then_some(())
        });
        let mut pressed = Vec::new();
        let until = Instant::now() + Duration::from_millis(1500);
        while Instant::now() < until {
            let stop = program(&units).args(["stop", "--antenna", "Mast"]).output().unwrap();
            assert!(stop.status.success(), "{}", String::from_utf8_lossy(&stop.stderr));
            pressed.push(Timestamp::now());
        }
        // Kill the program at some time between two writes.
        let until = Instant::now() + Duration::from_millis(u64::from(kill * 137 % 500));
        wait_for("the moment", || (Instant::now() >= until).then_some(()));
        let killed = Timestamp::now();
        served.signal("KILL");
        drop(served);
        let rows = rows(&path, RowKind::Position);
        let newest = rows.iter().map(|row| row.time).max().unwrap();
        let lost = killed.duration_since(newest);
        assert!(lost <= LOST + BETWEEN, "kill {kill}: {lost:?}");
        worst = worst.max(lost);
        let stops = stops_in_run(&path, kill);
        let kept = pressed.iter().filter(|pressed| killed.duration_since(**pressed) >= LOST);
        let (kept, all) = (kept.count(), pressed.len());
        assert!((kept..=all).contains(&stops), "kill {kill}: {kept} of {all} STOPs, {stops} found");
        entries = (entries.0 + stops, entries.1 + all);
        assert!(rows.len() > before, "what was there stays");
        before = rows.len();
        let db = rusqlite::Connection::open(&path).unwrap();
        let found: String = db.query_row("PRAGMA integrity_check", [], |row| row.get(0)).unwrap();
        assert_eq!(found, "ok");
    }
    println!(
        "{kills} kills, {before} positions, the newest at most {worst:?} old; {} of {} pressed STOPs",
        entries.0, entries.1
    );
}

/// Disk of one megabyte that exists until it is dropped.
struct SmallDisk<'a>(&'a Path);

impl<'a> SmallDisk<'a> {
    fn at(path: &'a Path) -> Self {
        fs::create_dir_all(path).unwrap();
        let mounted = Process::new("mount")
            .args(["-t", "tmpfs", "-o", "size=1m", "tmpfs"])
            .arg(path)
            .status();
        assert!(mounted.unwrap().success(), "only root may mount a disk");
        Self(path)
    }
}

impl Drop for SmallDisk<'_> {
    fn drop(&mut self) {
        let _ = Process::new("umount").arg(self.0).status();
    }
}

#[test]
#[ignore = "mounts a disk of its own, which only root may"]
fn a_full_disk_costs_nothing_that_was_written_and_the_record_goes_on_when_there_is_room() {
    let units = Units::start(|_| {});
    let path = place(&units);
    let disk = SmallDisk::at(path.parent().unwrap());
    let served = Served::start(&units);
    let count = || rows(&path, RowKind::Position).len();
    wait_for("a record", || (count() > 5).then_some(()));
    let ballast = disk.0.join("ballast");
    // The file takes the rest of the disk.
    let _ = fs::write(&ballast, vec![0; 1 << 20]);
    served.until(|told| told["text"].as_str().is_some_and(|it| it.contains("the disk is full")));
    let before = count();
    assert!(before > 5);
    let is_live = || {
        let status = program(&units).args(["status", "--json"]).output().unwrap();
        says(&status).contains("\"up\"")
    };
    assert!(is_live(), "the links do not mind");
    fs::remove_file(&ballast).unwrap();
    let until = Instant::now() + PATIENCE;
    wait_for("the record goes on", || {
        assert!(Instant::now() < until);
        (count() > before).then_some(())
    });
    served.until(|told| told["about"] == "alarm_over");
    // The full disk delayed no measurement.
    let positions = rows(&path, RowKind::Position);
    let of_dish = positions.iter().filter(|row| row.antenna.as_deref() == Some("Dish"));
    let times: Vec<Timestamp> = of_dish.map(|row| row.time).collect();
    let longest = times.windows(2).map(|pair| pair[1].duration_since(pair[0])).max().unwrap();
    assert!(longest <= BETWEEN, "{longest:?}");
    // The logs of the sessions held the data that the full disk did not take.
    assert_eq!(rows(&path, RowKind::Entry(Kind::Gap)), []);
    drop(served);
}
