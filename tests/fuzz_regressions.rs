//! Findings and seeds of fuzzing are harmless: tested without a nightly toolchain, by the
//! same functions as in `fuzz/targets`.

use std::{
    fs, io,
    panic::catch_unwind,
    path::{Path, PathBuf},
};

#[path = "fuzz/entry/all.rs"]
mod entry;

/// Feeds every file of every folder of `kind` to its function; there must be at least one,
/// and all must be harmless.
fn harmless(kind: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz").join(kind);
    let mut fed = 0;
    let mut harmful = Vec::new();
    for (path, name) in entries(&folder) {
        // One target has seeds for every form of elements.
        let is_of = |target: &str| name == target || name.starts_with(&format!("{target}_"));
        let (_, run) = entry::ALL.into_iter().find(|(target, _)| is_of(target)).unwrap();
        for (file, name) in entries(&path) {
            let bytes = fs::read(file).unwrap();
            fed += 1;
            if catch_unwind(|| run(&bytes)).is_err() {
                harmful.push(name);
            }
        }
    }
    assert!(fed > 0 && harmful.is_empty(), "{harmful:?} of {fed}");
}

/// Entries of a folder, with their names.
fn entries(folder: &Path) -> Vec<(PathBuf, String)> {
    let entry = |entry: io::Result<fs::DirEntry>| {
        let entry = entry.unwrap();
        (entry.path(), entry.file_name().into_string().unwrap())
    };
    let mut all: Vec<_> = fs::read_dir(folder).unwrap().map(entry).collect();
    all.sort();
    all
}

#[test]
fn what_was_found_once_stays_mended() {
    harmless("regressions");
}

#[test]
fn what_fuzzing_starts_from_is_harmless() {
    harmless("seeds");
}
