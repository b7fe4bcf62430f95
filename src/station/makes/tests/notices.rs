//! Settings for notices, written to the station file and read from it.

use std::fs;

use super::file::{load, written};
use crate::{
    controller::SPECS,
    station::{HoursOfDay, Loaded, Notices, Station, Tones, save},
};

#[test]
fn notices_come_back_as_they_were_saved_and_older_files_have_their_defaults() {
    let (_folder, path) = written("name = 'Old'");
    let old = load(&path).unwrap();
    assert_eq!((old.station.notices, old.notes), (Notices::default(), Vec::new()));
    let notices = Notices {
        notifications: false,
        sounds: false,
        warning_tones: Tones::Rising,
        caution_tones: Tones::None,
        reminder_tones: Tones::Falling,
        quiet: Some(HoursOfDay::NIGHT),
        reminder_min: 7.5,
        reminders: [25_544, 43_013].into(),
    };
    let station = Station { notices, ..Station::default() };
    save(&station, &path, SPECS).unwrap();
    let loaded = load(&path).unwrap();
    assert_eq!((loaded.station, loaded.notes), (station, Vec::new()));
    assert!(fs::read_to_string(&path).unwrap().contains("from = \"22:00\""));
}

#[test]
fn wrong_notices_are_named_and_make_nothing_quiet() {
    for (text, place) in [
        ("sounds = 'off'", "notices.sounds"),
        ("warning_tones = 'loud'", "notices.warning_tones"),
        ("notifications = 0", "notices.notifications"),
        ("reminder_min = 0.5", "notices.reminder_min"),
        ("reminders = ['ISS']", "notices.reminders"),
        ("sound = false", "notices.sound"),
        ("quiet = { from = '22:00', to = '22:00' }", "notices.quiet"),
        ("quiet = { from = '22:00', to = '26:00' }", "notices.quiet.to"),
        ("quiet = { from = 22, to = '06:00' }", "notices.quiet.from"),
        ("quiet = true", "notices.quiet"),
    ] {
        let (_folder, path) = written(&format!("[notices]\n{text}\n"));
        let Loaded { station, notes } = load(&path).unwrap();
        assert_eq!(station.notices, Notices::default(), "{text}");
        assert_eq!(notes.first().map(|note| &*note.place), Some(place), "{notes:?}");
    }
}
