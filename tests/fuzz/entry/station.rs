//! Any station file: after loading, saving and loading again, it means the same and keeps its
//! unreadable parts.

use std::fs;

use azel::{
    controller::SPECS,
    station::{KeepOut, Loaded, Note, SaveError, Station, load, save},
};

use super::no_infinity::is_finite;

pub(crate) fn run(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("station.toml");
    fs::write(&path, bytes).expect("a place on the disk");
    let (first, unread) = match load(&path, SPECS) {
        Ok(Loaded { station, notes }) => (station, places(&notes)),
        Err(error) => {
            assert!(!error.to_string().is_empty());
            assert_eq!(fs::read(&path).expect("it is there"), bytes);
            return;
        }
    };
    assert!(is_finite(&format!("{first:?}")), "{first:?}");
    if let Err(error) = save(&first, &path, SPECS) {
        assert!(matches!(error, SaveError::WouldDrop { .. }), "{error}");
        assert!(!unread.is_empty());
        assert_eq!(fs::read(&path).expect("it is there"), bytes);
        return;
    }
    let old = fs::read(path.with_added_extension("old")).expect("the old file is kept");
    assert_eq!(old, bytes);
    let text = fs::read_to_string(&path).expect("it was saved");
    let Loaded { station: second, notes } = load(&path, SPECS).expect("what was saved is read");
    assert_eq!(places(&notes), unread, "{text}");
    same(&first, &second);
    save(&second, &path, SPECS).expect("what was loaded can be saved");
    assert_eq!(fs::read_to_string(&path).expect("it was saved"), text);
    for antenna in &second.antennas {
        drop(antenna.controller());
    }
}

/// Returns the places of the notes, without names and ids, because the loader fills in a missing
/// one.
fn places(notes: &[Note]) -> Vec<String> {
    let key = |place: &str| place.rsplit('.').next().map(str::to_owned);
    let is_filled_in = |place: &str| key(place).is_some_and(|key| key == "name" || key == "id");
    let places = notes.iter().map(|note| note.place.clone());
    places.filter(|place| !is_filled_in(place)).collect()
}

fn same(first: &Station, second: &Station) {
    // An angle in radians does not keep the last digit of its degrees.
    let without_zones = |station: &Station| Station { keep_outs: Vec::new(), ..station.clone() };
    assert_eq!(without_zones(first), without_zones(second));
    assert_eq!(first.keep_outs.len(), second.keep_outs.len());
    for (one, other) in first.keep_outs.iter().zip(&second.keep_outs) {
        assert_eq!(KeepOut::corners_deg(&one.zone), KeepOut::corners_deg(&other.zone));
        assert_eq!(KeepOut { zone: one.zone.clone(), ..other.clone() }, *one);
    }
    assert_eq!(first.loosened_in(second), None);
    assert_eq!(second.loosened_in(first), None);
}
