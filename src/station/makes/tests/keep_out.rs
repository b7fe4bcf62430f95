//! Keep-outs and automatic actions, written to the station file and read from it.

use std::fs;

use super::file::{load, written};
use crate::{
    controller::SPECS,
    station::{
        Antenna, AntennaId, Entered, KeepOut, Loaded, Monitor, Note, NoteReason, OnClose, Priority,
        Resume, Station, SunAvoidance, save,
    },
};

fn mast() -> KeepOut {
    KeepOut {
        name: "mast".to_owned(),
        reason: "Steel mast, 24 m away".to_owned(),
        entered: Entered::GoRound,
        antenna: Some("Satrak".to_owned()),
        margin_deg: 2.5,
        zone: KeepOut::zone_of(&[(350.0, 0.0), (350.0, 16.3), (370.1, 24.0), (370.0, -0.2)])
            .unwrap(),
    }
}

#[test]
fn keep_outs_and_what_is_done_by_itself_come_back_as_they_were_saved() {
    let mut satrak = Antenna::satrak("Satrak", "h:4001");
    satrak.monitor = Monitor::Alarm;
    satrak.resume = Resume::Continue;
    (satrak.sway_deg, satrak.resume_after_s) = (0.0, 600.0);
    let cap = KeepOut::zone_of(&[(0.0, 85.0), (180.0, 85.0), (360.0, 85.0)]).unwrap();
    let overhead = KeepOut {
        name: "overhead".to_owned(),
        reason: String::new(),
        entered: Entered::Warn,
        antenna: None,
        margin_deg: 0.0,
        zone: cap,
    };
    let station = Station {
        antennas: vec![satrak],
        keep_outs: vec![mast(), overhead],
        sun_avoidance: Some(SunAvoidance { radius_deg: 2.5, ahead_min: 0.0 }),
        on_close: Some(OnClose::Park),
        ..Station::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    save(&station, &path, SPECS).unwrap();
    let loaded = load(&path).unwrap();
    assert_eq!(loaded.notes, []);
    assert_eq!(loaded.station, station);
    let text = fs::read_to_string(&path).unwrap();
    for line in ["close = \"park\"", "monitor = \"alarm\"", "resume = true", "sway_deg = 0.0"] {
        assert!(text.lines().any(|found| found.trim().trim_end_matches(',') == line), "{line}");
    }
}

const SATRAK: &str = "[[antenna]]\nname = 'Satrak'\n[antenna.connection]\n\
                      controller = 'satrak'\naddress = 'h:4001'\n";

#[test]
fn a_keep_out_that_cannot_be_read_is_said_not_to_hold() {
    for (corners, expected) in [
        ("", "it has no corners"),
        ("corners = 3", "corners must be a list of pairs of azimuth and elevation"),
        ("corners = [[0, 0, 1]]", "corners must be a list of pairs of azimuth and elevation"),
        ("corners = [[0, 0], [0, 5]]", "a zone needs at least 3 corners"),
        (
            "corners = [[0, 0], [10, 20], [10, 0], [0, 20]]",
            "edges 1 and 3 cross or touch each other",
        ),
    ] {
        let (_folder, path) = written(&format!(
            "[[keep_out]]\nname = 'mast'\n{corners}\n[[keep_out]]\nname = 'roof'\n\
             corners = [[0, 0], [0, 5], [7, 5]]\n{SATRAK}"
        ));
        let Loaded { station, notes } = load(&path).unwrap();
        assert_eq!(station.keep_outs.len(), 1);
        assert_eq!(station.keep_outs[0].name, "roof");
        let reason =
            NoteReason::DoesNotHold { name: "mast".to_owned(), reason: expected.to_owned() };
        assert_eq!(notes, [Note { place: "keep_out[0]".to_owned(), line: Some(1), reason }]);
    }
    for (text, name) in [
        ("keep_out = 'mast'", "keep_out"),
        ("keep_out = ['mast']", "keep_out[0]"),
        ("sun_avoidance = 5", "Sun avoidance"),
        ("sun_avoidance = { ahead_min = 5 }", "Sun avoidance"),
        ("sun_avoidance = { radius_deg = 61 }", "Sun avoidance"),
    ] {
        let (_folder, path) = written(text);
        let Loaded { station, notes } = load(&path).unwrap();
        assert_eq!((station.keep_outs, station.sun_avoidance), (Vec::new(), None));
        let held_not = |note: &Note| matches!(&note.reason, NoteReason::DoesNotHold { name: found, .. } if found == name);
        assert!(notes.iter().any(held_not), "{text}: {notes:?}");
    }
}

#[test]
fn keep_outs_beyond_the_largest_number_do_not_hold_and_forbid_motion() {
    let zone = "corners = [[0, 0], [0, 5], [7, 5]]";
    let number = KeepOut::MAX_NUMBER + 1;
    let entries = (1..=number).map(|one| format!("[[keep_out]]\nname = 'mast {one}'\n{zone}\n"));
    let text = entries.collect::<Vec<_>>().concat();
    let (_folder, path) = written(&format!("{text}{SATRAK}"));
    let Loaded { station, notes } = load(&path).unwrap();
    assert_eq!(station.keep_outs.len(), KeepOut::MAX_NUMBER);
    let [note] = notes.as_slice() else { panic!("{notes:?}") };
    let NoteReason::DoesNotHold { name, reason } = &note.reason else { panic!("{note:?}") };
    assert_eq!((name.as_str(), reason.as_str()), ("mast 33", "a station has 32 keep-outs at most"));
    assert_eq!(station.unread.len(), 1, "it forbids motion");
    save(&station, &path, SPECS).unwrap();
    assert!(fs::read_to_string(&path).unwrap().contains("mast 33"), "nothing is lost");
}

#[test]
fn keep_outs_have_no_more_corners_than_can_be_judged_in_time() {
    let corners: Vec<String> = (0..100)
        .map(|corner| {
            let angle_rad = f64::from(corner) / 100.0 * std::f64::consts::TAU;
            format!("[{}, {}]", 40.0 + 9.0 * angle_rad.sin(), 40.0 + 9.0 * angle_rad.cos())
        })
        .collect();
    let corners = corners.join(", ");
    let entries =
        (1..=9).map(|one| format!("[[keep_out]]\nname = 'mast {one}'\ncorners = [{corners}]\n"));
    let text = entries.collect::<Vec<_>>().concat();
    let (_folder, path) = written(&format!("{text}{SATRAK}"));
    let Loaded { station, notes } = load(&path).unwrap();
    assert_eq!(station.keep_outs.len(), 8);
    let [note] = notes.as_slice() else { panic!("{notes:?}") };
    let NoteReason::DoesNotHold { name, reason } = &note.reason else { panic!("{note:?}") };
    let limit = "all keep-outs have 800 corners at most";
    assert_eq!((name.as_str(), reason.as_str()), ("mast 9", limit));
    assert_eq!(station.unread.len(), 1, "it forbids motion");
}

#[test]
fn a_keep_out_with_a_wrong_value_holds_all_the_more() {
    let corners = "corners = [[350, 0], [350, 16.3], [370.1, 24], [370, -0.2]]";
    let (_folder, path) = written(&format!(
        "[[keep_out]]\nname = ' '\nentered = 'maybe'\nantenna = 'Nobody'\nmargin_deg = 45\n\
         margn = 3\n{corners}\n[[keep_out]]\nname = 'mast'\nentered = 'go_round'\n\
         antenna = 'satrak'\nmargin_deg = 2.5\nreason = 'Steel mast, 24 m away'\n{corners}\n\
         [[keep_out]]\nname = 'mast'\nmargin_deg = 'x'\n{corners}\n\
         [sun_avoidance]\nradius_deg = 5\nahead_min = 121\n{SATRAK}"
    ));
    let Loaded { station, notes } = load(&path).unwrap();
    let strict = |name: &str, margin_deg| KeepOut {
        name: name.to_owned(),
        reason: String::new(),
        entered: Entered::Hard,
        antenna: None,
        margin_deg,
        ..mast()
    };
    assert_eq!(
        station.keep_outs,
        [strict("Keep-out 1", 30.0), mast(), strict("mast 2", KeepOut::DEFAULT_MARGIN_DEG)]
    );
    let sun = SunAvoidance { radius_deg: 5.0, ahead_min: SunAvoidance::DEFAULT_AHEAD_MIN };
    assert_eq!(station.sun_avoidance, Some(sun));
    let places: Vec<&str> = notes.iter().map(|note| note.place.as_str()).collect();
    assert_eq!(
        places,
        [
            "sun_avoidance.ahead_min",
            "keep_out[0].name",
            "keep_out[0].entered",
            "keep_out[0].antenna",
            "keep_out[0].margin_deg",
            "keep_out[0].margn",
            "keep_out[2].name",
            "keep_out[2].margin_deg",
        ]
    );
    assert!(mast().holds_for(" SATRAK") && !mast().holds_for("Genius"));
    assert!(strict("x", 0.0).holds_for("Genius"));
}

/// Station file in which three safety settings and some others cannot be read.
const UNREAD: &str = "# The roof.
nickname = 'west' # not known
favourites = [25544, 'NOAA 15']

[sun_avoidance]
radius_deg = 'five' # as on the door

[[keep_out]]
name = 'mast' # of steel
corner = [[0, 0], [10, 0], [10, 20]]

[[keep_out]]
name = 'roof'
corners = [[100, 0], [120, 0], [120, 20]]

[[pass]]
satellite = 'ISS'

[[antenna]]
id = 1
name = 'Satrak'
[antenna.connection]
controller = 'satrak'
address = 'h:4001'
[antenna.limits]
minimum_elevation_deg = '25' # the neighbour's roof

[[antenna]]
id = 2
[antenna.connection]
controller = 'unheard of'
address = 'h:4002'
";

#[test]
fn a_save_keeps_what_could_not_be_read() {
    let (_folder, path) = written(UNREAD);
    let Loaded { mut station, notes } = load(&path).unwrap();
    station.favourites.set_priority(25_544, Priority::ALL[0]);
    station.antennas[0].beam_width_deg = 3.5;
    save(&station, &path, SPECS).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    for line in [
        "nickname = 'west' # not known",
        "radius_deg = 'five' # as on the door",
        "name = 'mast' # of steel",
        "corner = [[0, 0], [10, 0], [10, 20]]",
        "satellite = 'ISS'",
        "minimum_elevation_deg = '25' # the neighbour's roof",
        "controller = 'unheard of'",
    ] {
        assert!(text.lines().any(|found| found == line), "{line}\n{text}");
    }
    assert!(text.contains("'NOAA 15'"), "{text}");
    let again = load(&path).unwrap();
    assert_eq!(again.station, station);
    let places = |notes: Vec<Note>| notes.into_iter().map(|note| note.place).collect::<Vec<_>>();
    assert_eq!(places(again.notes), places(notes));
}

#[test]
fn what_could_not_be_read_is_named_with_its_line() {
    let (_folder, path) = written(UNREAD);
    let Loaded { station, notes } = load(&path).unwrap();
    let line = |place: &str| notes.iter().find(|note| note.place == place).unwrap().line;
    for (place, expected) in [
        ("nickname", 2),
        ("favourites[1]", 3),
        ("sun_avoidance.radius_deg", 6),
        ("keep_out[0]", 8),
        ("keep_out[0].corner", 10),
        ("antenna[0].limits.minimum_elevation_deg", 26),
    ] {
        assert_eq!(line(place), Some(expected), "{place}");
    }
    let unread = station.unread.iter().map(|unread| (unread.place.as_str(), unread.antenna));
    assert_eq!(
        unread.collect::<Vec<_>>(),
        [
            ("sun_avoidance.radius_deg", None),
            ("sun_avoidance", None),
            ("antenna[0].limits.minimum_elevation_deg", Some(AntennaId(1))),
            ("keep_out[0].corner", None),
            ("keep_out[0]", None),
        ]
    );
}

#[test]
fn a_setting_that_the_operator_repairs_is_saved() {
    let (_folder, path) = written(UNREAD);
    let Loaded { mut station, .. } = load(&path).unwrap();
    station.antennas[0].limits.minimum_elevation_deg = 25.0;
    station.sun_avoidance = Some(SunAvoidance { radius_deg: 5.0, ahead_min: 0.0 });
    let saved = save(&station, &path, SPECS).unwrap();
    let places: Vec<&str> = saved.unread.iter().map(|unread| unread.place.as_str()).collect();
    assert_eq!(places, ["keep_out[0].corner", "keep_out[0]"], "the mast is still unknown");
    let again = load(&path).unwrap().station;
    assert_eq!(again.sun_avoidance, station.sun_avoidance);
    assert!((again.antennas[0].limits.minimum_elevation_deg - 25.0).abs() < 1e-9);
}
