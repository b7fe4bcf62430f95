//! Any bytes in the small files beside the station: lock-outs, list of sources, index of the
//! library and its notes of unfinished sources.

use std::{fs, path::Path};

use azel::{
    library::{Library, Limits, load_sources, save_sources},
    orbit::{Source, SourcePlace},
    station::{Antenna, LOCK_OUTS_FILE, LockOuts},
};
use jiff::Timestamp;

pub(crate) fn run(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("a place on the disk");
        path
    };
    lock_outs(&put(LOCK_OUTS_FILE));
    sources(&put("sources.toml"));
    put("index.toml");
    put("unfinished.toml");
    put("reading.toml");
    library(folder.path());
}

/// Checks that an unreadable file locks out every unit.
fn lock_outs(path: &Path) {
    let now = Timestamp::UNIX_EPOCH;
    let (mut first, problem) = LockOuts::load(path, now);
    let unit = Antenna::satrak("Dish", "10.0.0.1:4001").connection;
    assert!(problem.is_none() || first.find(&unit).is_some());
    // Naming the unit ends the lock-out of all units when the file is saved.
    let own = first.find(&unit).cloned();
    first.set(&unit, own, std::iter::empty());
    let text = first.text().expect("what was loaded can be saved");
    fs::write(path, text).expect("a file");
    first.saved();
    assert_eq!(LockOuts::load(path, now), (first, None));
}

fn sources(path: &Path) {
    match load_sources(path) {
        Ok(first) => {
            save_sources(&first, path).expect("what was loaded can be saved");
            assert_eq!(load_sources(path).expect("what was saved is read"), first);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Checks that no content of its notes keeps the library from reading a source, or from reporting
/// that the source was set aside.
fn library(folder: &Path) {
    let own = folder.join("own.tle");
    fs::write(&own, "").expect("a place on the disk");
    let sources = [
        Source { name: "own".to_owned(), place: SourcePlace::File(own), refresh: None },
        Source {
            name: "web".to_owned(),
            place: SourcePlace::Web("https://a.example/x".to_owned()),
            refresh: None,
        },
    ];
    if let Ok(library) = Library::open(folder, Limits::default()) {
        assert_eq!(library.load(&sources).1.len(), sources.len());
        let names = sources.each_ref().map(|source| source.name.clone());
        library.read_again(&sources, &names);
        let (_, reports) = library.load(&sources);
        assert!(reports.iter().all(|report| !report.is_set_aside));
    }
}
