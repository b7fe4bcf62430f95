//! Tests of a record's passes in order of time.

use jiff::{Timestamp, ToSpan as _};
use serde_json::json;

use super::{DISH, clock, recorder, start};
use crate::{
    astro::Site,
    clock::{Instant, Moment},
    contract::record::{ListedKind, PassQuery},
    plan::pass_report::PassVerdict,
    record::{
        Entry, Kind, Neighbour, PassNote, missed, neighbour, passes, passes_within, testing,
        times_between, times_of_pass,
    },
    station::AntennaId,
};

const NOAA_20: u32 = 43013;
const ISS: u32 = 25544;

fn time(minute: i64) -> Timestamp {
    start() + minute.minutes()
}

/// Returns a pass that starts at `minute`.
fn note(antenna: AntennaId, satellite: u32, minute: i64) -> PassNote {
    testing::note(antenna, satellite, time(minute))
}

#[test]
fn each_pass_is_the_neighbour_of_the_next_and_other_antennas_count_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let other = AntennaId(5);
    // The passes are in order of their ends.
    let notes = [
        note(DISH, ISS, 0),
        note(DISH, NOAA_20, 60),
        note(other, NOAA_20, 61),
        note(DISH, ISS, 95),
    ];
    testing::record(&path, notes);
    let found = |reference, is_next| {
        let pass = neighbour(&path, reference, is_next).unwrap();
        pass.map(|pass| (pass.id, pass.report.start))
    };
    assert_eq!(found(Neighbour::Pass(1), true), Some((2, time(60))));
    assert_eq!(found(Neighbour::Pass(2), true), Some((4, time(95))), "not the same pass again");
    assert_eq!(found(Neighbour::Pass(4), false), Some((3, time(61))));
    assert_eq!(found(Neighbour::Pass(3), false), Some((1, time(0))));
    assert_eq!(found(Neighbour::Pass(1), false), None);
    assert_eq!(found(Neighbour::Pass(4), true), None);
    assert_eq!(found(Neighbour::Moment(time(65)), true), Some((2, time(60))), "the one under way");
    assert_eq!(found(Neighbour::Moment(time(65)), false), Some((1, time(0))));
    assert_eq!(found(Neighbour::Pass(77), true), None, "no such pass");
}

#[test]
fn a_stretch_has_the_times_of_the_passes_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    testing::record(&path, [note(DISH, ISS, 0), note(DISH, NOAA_20, 60), note(DISH, ISS, 95)]);
    let site = Site::default();
    let marks = times_between(&path, time(5), time(65), site).unwrap();
    let [iss, noaa] = &marks[..] else { panic!("{marks:?}") };
    assert_eq!((&*iss.name, iss.aos, iss.los), ("ISS", time(0), time(10)));
    assert_eq!(noaa.aos, time(60));
    assert_eq!(noaa.lost, [(time(61), time(62))]);
    let tca = noaa.tca.unwrap();
    assert!((time(60)..=time(70)).contains(&tca), "{tca}");
    assert_eq!(times_between(&path, time(20), time(50), site).unwrap(), []);
    assert_eq!(times_of_pass(&path, 2, site).unwrap().as_ref(), Some(noaa));
    assert_eq!(times_of_pass(&path, 9, site).unwrap(), None);
}

/// Returns the day entry of a pass that began at `minute`, written eleven minutes later.
fn day_line(satellite: u32, name: &str, minute: i64) -> Entry {
    let moment = Moment { utc: time(minute + 11), steady: Instant::now() };
    let flown = json!({ "pass": [satellite, time(minute)], "name": name });
    Entry::new(moment, Some(DISH), Kind::Day, &json!({ "what": { "flown": flown } }))
}

#[test]
fn a_pass_that_was_to_be_tracked_and_has_no_report_is_missed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let recorder = recorder(&path);
    for entry in [
        day_line(NOAA_20, "NOAA 20", -600),
        day_line(ISS, "ISS", 0),
        day_line(NOAA_20, "NOAA 20", 60),
        Entry::new(clock().now(), Some(DISH), Kind::Day, &json!({ "what": "switched_on" })),
    ] {
        recorder.note(entry);
    }
    recorder.note_pass(note(DISH, ISS, 0));
    recorder.note_pass(note(AntennaId(5), NOAA_20, 61));
    recorder.flush();
    let found = |query: PassQuery| {
        let page = passes(&path, &query).unwrap();
        let missed = missed(&path, &query, &page).unwrap();
        missed.into_iter().map(|missed_entry| missed_entry.time).collect::<Vec<_>>()
    };
    let all = PassQuery { count: 10, ..PassQuery::default() };
    let (old, new) = (time(-589), time(71));
    assert_eq!(found(all.clone()), [new, old], "another antenna tracked the last one");
    let page = PassQuery { count: 1, ..all.clone() };
    assert_eq!(found(page), [new], "as far back as the page");
    let kind = |kind| PassQuery { kind: Some(kind), ..all.clone() };
    assert_eq!(found(kind(ListedKind::NotTracked)), [new, old]);
    assert_eq!(found(kind(ListedKind::Tracked(PassVerdict::Poor))), []);
    let tracked = passes(&path, &kind(ListedKind::NotTracked)).unwrap();
    assert_eq!(tracked.passes, []);
    for (text, count) in
        [("noaa", 2), ("iss", 0), ("43013", 2), ("2026-03-01", 2), ("2026-03-02", 0)]
    {
        let query = PassQuery { text: text.to_owned(), ..all.clone() };
        assert_eq!(found(query).len(), count, "{text}");
    }
    let of_other = PassQuery { antenna: Some(AntennaId(5)), ..all };
    assert_eq!(found(of_other), []);
}

#[test]
fn the_passes_within_a_time_are_found_by_their_aos_however_many() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let recorder = recorder(&path);
    for (antenna, satellite, start) in
        [(5, NOAA_20, 900), (3, ISS, 300), (3, ISS, -1), (3, ISS, 1000), (3, NOAA_20, 0)]
    {
        recorder.note_pass(note(AntennaId(antenna), satellite, start));
    }
    recorder.flush();
    let found = |query: PassQuery| {
        let passes = passes_within(&path, &query, &(time(0)..time(1000)), Site::default()).unwrap();
        passes.iter().map(|opened| opened.pass.report.start).collect::<Vec<_>>()
    };
    let all = PassQuery { count: 1, ..PassQuery::default() };
    assert_eq!(
        found(all.clone()),
        [time(0), time(300), time(900)],
        "in order, and not the newest alone"
    );
    let of_one = PassQuery { antenna: Some(AntennaId(5)), ..all.clone() };
    assert_eq!(found(of_one), [time(900)]);
    assert_eq!(found(PassQuery { text: "noaa".to_owned(), ..all }), [time(0), time(900)]);
}
