//! Antennas of every make, written to the station file and read from it.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::super::*;
use crate::{
    astro::HorizonMask,
    controller::{
        SPECS,
        rc2000c::{BAUD, BUS_ADDRESS, Calibration},
        rotator_genius::{ROTATORS, Rotators},
    },
    device::{CountPoint, settings::Value},
    station::{
        self, AfterPass, Antenna, AntennaId, LoadError, Loaded, Monitor, Mount, Note, NoteReason,
        Priority, Resume, SaveError, Station, TrackSettings, save,
    },
};

pub(super) fn load(path: &Path) -> Result<Loaded, LoadError> {
    station::load(path, SPECS)
}

pub(super) fn written(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    fs::write(&path, text).unwrap();
    (folder, path)
}

#[test]
fn a_station_comes_back_as_it_was_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep/station.toml");
    let mut station = Station::demo(&DemoAddresses {
        satrak: "192.168.10.21:4001".to_owned(),
        genius: "192.168.1.250:9006".to_owned(),
        rc2000c: "/dev/ttyUSB0".to_owned(),
    });
    station.name = "Şile \"1\"".to_owned();
    station.antennas.push(Antenna::satrak("Second", "host.example:5"));
    give_ids(&mut station);
    station.horizon_mask = HorizonMask::parse("350 2.5\n10, -0.1\n123.25 12").ok();
    save(&station, &path, SPECS).unwrap();
    let loaded = load(&path).unwrap();
    assert_eq!(loaded.notes, []);
    assert_eq!(loaded.station, station);
    save(&Station::default(), &path, SPECS).unwrap();
    assert_eq!(load(&path.with_extension("toml.old")).unwrap().station, station);
}

#[test]
fn a_file_that_is_no_toml_is_never_replaced() {
    let (_folder, path) = written("name = 'Here'\n[[antenna]\nname = 'A'\n");
    let before = fs::read(&path).unwrap();
    for _ in 0..2 {
        let saved = save(&Station::default(), &path, SPECS);
        assert!(matches!(&saved, Err(SaveError::Unreadable(file)) if *file == path), "{saved:?}");
    }
    assert_eq!(fs::read(&path).unwrap(), before);
    assert!(!path.with_extension("toml.old").exists());
}

#[test]
fn a_station_without_an_aos_elevation_keeps_that_of_its_first_antenna() {
    let antenna = "[[antenna]]\n[antenna.connection]\ncontroller = 'satrak'\naddress = 'h:1'\n\
                   [antenna.limits]\nminimum_elevation_deg = 12.5\n";
    for (text, wanted_deg) in [
        (antenna.to_owned(), 12.5),
        (format!("aos_elevation_deg = 3\n{antenna}"), 3.0),
        ("name = 'No antenna'".to_owned(), Station::default().aos_elevation_deg),
    ] {
        let (_folder, path) = written(&text);
        let station = load(&path).unwrap().station;
        assert!((station.aos_elevation_deg - wanted_deg).abs() < 1e-9, "{text}");
    }
}

#[test]
fn a_bad_field_costs_only_itself() {
    let (_folder, path) = written(
        "name = 'Here'\nelevation_floor_deg = 'ten'\nelevtion = 3\n\
         horizon_mask = '''\n0 5\n90 x'''\n\
         [site]\nlatitude_deg = 95.0\nlongitude_deg = 1.0\naltitude_m = 0.0\n\
         [[antenna]]\nname = 'A'\nbeam_width_deg = -1\n\
         [antenna.connection]\ncontroller = 'satrak'\naddress = 'h:4001'\n\
         [[antenna]]\nname = 'B'\n[antenna.connection]\ncontroller = 'satrak'\naddress = 'h'\n",
    );
    let Loaded { station, notes } = load(&path).unwrap();
    assert_eq!(station.name, "Here");
    assert_eq!(station.antennas.len(), 1);
    assert_eq!(station.antennas[0].name, "A");
    let places: Vec<&str> = notes.iter().map(|note| note.place.as_str()).collect();
    assert_eq!(
        places,
        [
            "site",
            "horizon_mask",
            "elevation_floor_deg",
            "antenna[0].beam_width_deg",
            "antenna[1].connection.address",
            "elevtion"
        ]
    );
    let NoteReason::Invalid(reason) = &notes[1].reason else { panic!("{:?}", notes[1]) };
    assert_eq!(reason, "line 2 does not hold an azimuth and an elevation in degrees");
    assert_eq!(notes[5].reason, NoteReason::Unknown);
}

#[test]
fn favourites_keep_their_priorities_and_an_old_list_has_the_default() {
    let (_folder, path) = written("favourites = [43013, { satellite = 25544, priority = 1 }, 7.5]");
    let loaded = load(&path).unwrap();
    let favourites = loaded.station.favourites.clone();
    assert_eq!(favourites.numbers(), [43_013, 25_544]);
    let priority = |number| loaded.station.priority(number).map(Priority::number);
    assert_eq!((priority(43_013), priority(25_544), priority(7)), (Some(3), Some(1), None));
    let places: Vec<_> = loaded.notes.iter().map(|note| note.place.as_str()).collect();
    assert_eq!(places, ["favourites[2]"]);
    station::save(&loaded.station, &path, SPECS).unwrap();
    assert_eq!(load(&path).unwrap().station.favourites, favourites);
    // A list with tables has another form in the file.
    let mut station = loaded.station;
    station.favourites.set_priority(43_013, Priority::ALL[4]);
    station::save(&station, &path, SPECS).unwrap();
    let loaded = load(&path).unwrap();
    let places: Vec<_> = loaded.notes.iter().map(|note| note.place.as_str()).collect();
    assert_eq!((loaded.station.favourites, places), (station.favourites, vec!["favourites[2]"]));
}

#[test]
fn a_second_antenna_of_the_same_name_gets_a_name_of_its_own() {
    let one = "[[antenna]]\nname = 'Mast'\n[antenna.connection]\n\
               controller = 'satrak'\naddress = 'h:4001'\n";
    let (_folder, path) = written(&format!("{one}{}{one}", one.replace("'Mast'", "' MAST 2'")));
    let Loaded { station, notes } = load(&path).unwrap();
    let names: Vec<&str> = station.antennas.iter().map(|antenna| &*antenna.name).collect();
    assert_eq!(names, ["Mast", " MAST 2", "Mast 3"]);
    assert_eq!(notes.len(), 1);
    assert_eq!(notes[0].place, "antenna[2].name");
    let NoteReason::Invalid(reason) = &notes[0].reason else { panic!("{:?}", notes[0]) };
    assert_eq!(reason, "another antenna has it too, this one is called Mast 3");
}

#[test]
fn what_cannot_be_read_is_left_alone() {
    let (_folder, path) = written("name = \"open");
    assert!(matches!(load(&path), Err(LoadError::Syntax { .. })));
    assert_eq!(fs::read_to_string(&path).unwrap(), "name = \"open");
    let (_folder, path) = written("version = 99");
    assert!(matches!(load(&path), Err(LoadError::Newer { found: 99, .. })));
    assert!(matches!(load(Path::new("/nowhere/at/all.toml")), Err(LoadError::Missing)));
    let (_folder, path) = written("");
    let utf_16: Vec<u8> = "\u{feff}name = 1".encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(&path, &utf_16).unwrap();
    let error = load(&path).unwrap_err();
    assert!(error.to_string().contains("save the file as UTF-8"), "{error}");
    assert!(save(&Station::default(), &path, SPECS).is_err());
    assert_eq!(fs::read(&path).unwrap(), utf_16);
}

#[test]
fn a_failed_save_keeps_the_old_file() {
    let (folder, path) = written("name = 'Old'");
    // Saving fails because a folder has the name of the file.
    let occupied = folder.path().join("taken");
    fs::create_dir_all(occupied.join("inside")).unwrap();
    assert!(matches!(save(&Station::default(), &occupied, SPECS), Err(SaveError::Write { .. })));
    assert_eq!(load(&path).unwrap().station.name, "Old");
}

#[test]
fn what_a_make_alone_has_comes_back_as_it_was_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let mut genius = Antenna {
        mount: Mount::AzEl {
            azimuth_from_deg: -90.0,
            azimuth_to_deg: 450.5,
            elevation_from_deg: -5.0,
            elevation_to_deg: 180.0,
        },
        follow: TrackSettings {
            period_s: 0.5,
            dead_band_deg: 1.25,
            latency_s: 0.0,
            after: AfterPass::Next,
        },
        ..Antenna::genius("Tower", "tower.example:9006")
    };
    genius.connection.put(&ROTATORS, Rotators::Second).unwrap();
    let calibration = Calibration {
        azimuth: vec![
            CountPoint { counts: 0, degrees: -12.5 },
            CountPoint { counts: 65_535, degrees: 372.25 },
        ],
        elevation: Vec::new(),
    };
    let mut rc2000c = Antenna::rc2000c("Dish", "serial.example:4002");
    rc2000c.connection.put(&BAUD, Value::Choice(1200)).unwrap();
    rc2000c.connection.put(&BUS_ADDRESS, 111).unwrap();
    calibration.put_into(&mut rc2000c.connection).unwrap();
    let mut station = Station { antennas: vec![genius, rc2000c], ..Station::default() };
    give_ids(&mut station);
    save(&station, &path, SPECS).unwrap();
    let loaded = load(&path).unwrap();
    assert_eq!(loaded.notes, []);
    assert_eq!(loaded.station, station);
}

/// Returns the only antenna of a file, and the paths of the settings that were not adopted.
fn antenna(text: &str) -> (Antenna, Vec<String>) {
    let (_folder, path) = written(&format!("[[antenna]]\n{text}"));
    let Loaded { station, notes } = load(&path).unwrap();
    let place = |note: Note| note.place.trim_start_matches("antenna[0].").to_owned();
    let places = notes.into_iter().map(place).collect();
    (station.antennas.into_iter().next().unwrap(), places)
}

#[test]
fn a_bad_field_of_an_rc2000c_costs_only_itself() {
    let bare_antenna = Antenna::rc2000c("RC2000C", "COM3");
    let (read, places) = antenna(
        "[antenna.connection]\ncontroller = 'rc2000c'\naddress = 'COM3'\nbaud = 19200\n\
         bus_address = 48\nelement_file = 'x'\n[antenna.connection.calibration]\n\
         azimuth = [{ counts = 30, degrees = 90 }]\n\
         elevation = [{ counts = 70000, degrees = 0 }, { counts = 1, degrees = 9 }]\n",
    );
    assert_eq!(read, bare_antenna);
    assert_eq!(
        places,
        [
            "connection.baud",
            "connection.bus_address",
            "connection.calibration.azimuth",
            "connection.calibration.elevation",
            "connection.element_file",
        ]
    );
    let (read, places) = antenna(
        "[antenna.connection]\ncontroller = 'rc2000c'\naddress = 'COM3'\n\
         [antenna.connection.calibration]\n\
         azimuth = [{ counts = 30, degrees = 90 }, { counts = 3630, degrees = 270.0 }]\n\
         elevation = [{ counts = 30, degrees = 0 }, { counts = 30, degrees = 9 }]\n",
    );
    let calibration = Calibration::from_connection(&read.connection);
    assert_eq!((calibration.azimuth.len(), calibration.elevation.len()), (2, 0));
    assert_eq!(places, ["connection.calibration.elevation"]);
}

#[test]
fn a_bad_field_of_a_genius_costs_only_itself() {
    let bare_antenna = Antenna::genius("Genius", "h:9006");
    let (read, places) = antenna(
        "[antenna.connection]\ncontroller = 'genius'\naddress = 'h:9006'\nrotators = 'both'\n\
         [antenna.mount]\ntype = 'xy'\nelevation_from_deg = 95\n\
         [antenna.follow]\nperiod_s = 0\ndead_band_deg = -1\nlatency_s = 'none'\nafter = 3\n",
    );
    assert_eq!(read, bare_antenna);
    assert_eq!(
        places,
        [
            "connection.rotators",
            "mount.type",
            "mount.elevation_from_deg",
            "follow.period_s",
            "follow.dead_band_deg",
            "follow.latency_s",
            "follow.after",
        ]
    );
}

#[test]
fn ends_of_an_axis_that_cross_are_not_used() {
    let genius = "[antenna.connection]\ncontroller = 'genius'\naddress = 'h:9006'\n";
    let (read, places) = antenna(&format!(
        "{genius}[antenna.mount]\nazimuth_from_deg = 180\nazimuth_to_deg = 170\n\
         elevation_from_deg = 30\nelevation_to_deg = 20\n"
    ));
    assert_eq!(read.mount.travel_deg(), [(180.0, 360.0), (30.0, 90.0)]);
    assert_eq!(places, ["mount.azimuth_to_deg", "mount.elevation_to_deg"]);
    // The default upper end no longer fits, so Azel uses the min valid one.
    let (read, places) = antenna(&format!("{genius}[antenna.mount]\nazimuth_from_deg = 360\n"));
    assert_eq!(read.mount.travel_deg(), [(360.0, 361.0), (0.0, 90.0)]);
    assert_eq!(places, Vec::<String>::new());
}

#[test]
fn a_serial_port_is_for_an_rc2000c_alone() {
    for controller in ["satrak", "genius"] {
        let (_folder, path) = written(&format!(
            "[[antenna]]\n[antenna.connection]\ncontroller = '{controller}'\naddress = 'COM3'\n"
        ));
        let Loaded { station, notes } = load(&path).unwrap();
        assert_eq!(station.antennas, []);
        assert_eq!(notes[0].place, "antenna[0].connection.address");
    }
}

/// Station file with antennas of every make. Azel must always be able to read it.
const WRITTEN: &str = include_str!("station.toml");
/// The same station from a version without antenna ids and AOS elevation.
const BEFORE_IDS: &str = include_str!("station-before-ids.toml");

#[test]
fn the_file_is_what_it_always_was() {
    let mut station = Station::demo(&DemoAddresses {
        satrak: "192.168.10.21:4001".to_owned(),
        genius: "192.168.1.250:9006".to_owned(),
        rc2000c: "/dev/ttyUSB0".to_owned(),
    });
    station.antennas.push(Antenna::satrak("Second", "host.example:5"));
    let mut tower = Antenna::genius("G2", "host.example:6");
    if let Mount::AzEl { elevation_to_deg, .. } = &mut tower.mount {
        *elevation_to_deg = 180.0;
    }
    station.antennas.push(tower);
    station.antennas.push(Antenna::rc2000c("Third", "COM3"));
    give_ids(&mut station);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    save(&station, &path, SPECS).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), WRITTEN);
    assert_eq!(load(&path).unwrap().station, station);
    let (_folder, path) = written(BEFORE_IDS);
    let Loaded { station: read, notes } = load(&path).unwrap();
    assert_eq!((read, notes), (station, Vec::new()));
}

/// Numbers the antennas consecutively.
fn give_ids(station: &mut Station) {
    for (antenna, number) in station.antennas.iter_mut().zip(1..) {
        antenna.id = AntennaId(number);
    }
}

#[test]
fn an_antenna_keeps_its_id_and_no_other_gets_it() {
    let antenna = |name: &str, id: &str| {
        format!(
            "[[antenna]]\n{id}name = '{name}'\n[antenna.connection]\ncontroller = 'satrak'\n\
             address = '{name}:1'\n"
        )
    };
    let text = antenna("a", "") + &antenna("b", "id = 1\n") + &antenna("c", "id = 1\n");
    let (_folder, path) =
        written(&(text + &antenna("d", "id = 'x'\n") + &antenna("e", "id = 9\n")));
    let Loaded { station, notes } = load(&path).unwrap();
    let ids: Vec<u32> = station.antennas.iter().map(|antenna| antenna.id.0).collect();
    assert_eq!(ids, [2, 1, 3, 4, 9]);
    let places: Vec<&str> = notes.iter().map(|note| &*note.place).collect();
    assert_eq!(places, ["antenna[2].id", "antenna[3].id"]);
}

#[test]
fn what_an_antenna_does_by_itself_has_its_defaults() {
    let connection = "[antenna.connection]\ncontroller = 'genius'\naddress = 'h:9006'\n";
    let (read, places) = antenna(&format!(
        "monitor = 'no'\nsway_deg = 2.1\nresume = 'yes'\nresume_after_s = -1\n{connection}"
    ));
    assert_eq!(read, Antenna::genius("Genius", "h:9006"));
    assert_eq!(places, ["monitor", "sway_deg", "resume", "resume_after_s"]);
    assert_eq!((read.monitor, read.resume), (Monitor::Stop, Resume::Ask));
    let (_folder, path) = written("close = 'now'");
    let Loaded { station, notes } = load(&path).unwrap();
    assert_eq!((station.on_close, &*notes[0].place), (None, "close"));
}
