//! Tests of events during a pass.

use jiff::{Timestamp, ToSpan as _};
use serde_json::{Value, json};

use super::{DISH, recorder, rows_of, start};
use crate::{
    astro::Site,
    clock::{Instant, Moment},
    contract::record::Row,
    record::{Entry, Kind, Query, RowKind, open_pass, testing},
};

const NOAA_20: u32 = 43013;

fn time(minute: i64) -> Timestamp {
    start() + minute.minutes()
}

fn of_all(minute: i64, kind: Kind, data: &Value) -> Entry {
    Entry::new(Moment { utc: time(minute), steady: Instant::now() }, None, kind, data)
}

fn stop(minute: i64, antennas: &[u64], elsewhere: &[u64]) -> Entry {
    let data = json!({"by": "window", "antennas": antennas, "elsewhere": elsewhere});
    of_all(minute, Kind::Stop, &data)
}

fn gap(start_minute: i64, end: i64) -> Entry {
    let data = json!({"since": time(start_minute), "entries": 0, "positions": 9, "frames": 0, "pictures": 0});
    of_all(end, Kind::Gap, &data)
}

#[test]
fn gaps_and_stops_that_were_pressed_for_an_antenna_are_told_of_its_pass() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    testing::record(&path, [testing::note(DISH, NOAA_20, time(0))]);
    let recorder = recorder(&path);
    let (dish, other) = (u64::from(DISH.0), u64::from(DISH.0) + 1);
    for entry in [
        gap(-20, -10),
        gap(-8, -3),
        stop(1, &[other, dish], &[]),
        stop(2, &[other], &[]),
        stop(3, &[], &[dish]),
        gap(9, 30),
        gap(40, 50),
    ] {
        recorder.note(entry);
    }
    recorder.flush();
    let opened = open_pass(&path, 1, Site::default()).unwrap().unwrap();
    let events = |rows: &[Row]| -> Vec<(String, Timestamp)> {
        rows.iter().map(|row| (row.kind.clone(), row.time)).collect()
    };
    let expected = [("gap", -3), ("stop", 1), ("stop", 3), ("gap", 30)]
        .map(|(name, minute)| (name.to_owned(), time(minute)));
    assert_eq!(events(&opened.entries), expected);
    // A reader of the antenna's log also gets these rows.
    let query = Query {
        antenna: Some("Dish".to_owned()),
        row_kinds: vec![RowKind::Entry(Kind::Stop), RowKind::Entry(Kind::Gap)],
        ..Query::default()
    };
    assert_eq!(rows_of(&path, &query).len(), 6, "all but the STOP of the other antenna");
}
