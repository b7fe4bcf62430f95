//! Findings and seeds of fuzzing, tested without a nightly toolchain by the same functions as in
//! `fuzz/targets`.

use std::{
    fs, io,
    panic::catch_unwind,
    path::{Path, PathBuf},
};

use crate::common::dice::Dice;

#[path = "fuzz/entry/all.rs"]
mod entry;

/// Feeds every file of every folder of `kind` to its function. Fails if there is no file, or if a
/// file is harmful.
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

/// Returns the entries of a folder, sorted, with their names.
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

/// Values that almost every setting rejects.
const ODD: [&str; 8] =
    ["'five'", "-1e9", "[]", "[1, 'x']", "{ a = 1 }", "true", "''", "[{ b = 2 }]"];

/// Station files from which fuzzing starts, with odd values and names in random places.
#[test]
fn any_damaged_station_file_keeps_what_it_cannot_use() {
    let (_, run) = entry::ALL.into_iter().find(|(target, _)| *target == "station").unwrap();
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seed = number("AZEL_SEED").unwrap_or(20_261_128);
    let cases = number("AZEL_CASES").unwrap_or(200);
    println!("damaged station files: {cases} cases from seed {seed}");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/seeds/station");
    let texts: Vec<String> =
        entries(&folder).into_iter().map(|(file, _)| fs::read_to_string(file).unwrap()).collect();
    for seed in seed..seed + cases {
        let mut dice = Dice::new(seed);
        let mut lines: Vec<String> =
            texts[dice.below(texts.len())].lines().map(str::to_owned).collect();
        for _ in 0..=dice.below(4) {
            let line = dice.below(lines.len());
            let Some((key, value)) = lines[line].split_once('=') else { continue };
            lines[line] = if dice.chance(0.3) {
                format!("{}x ={value}", key.trim_end())
            } else {
                format!("{key}= {}", ODD[dice.below(ODD.len())])
            };
        }
        let text = lines.join("\n");
        assert!(catch_unwind(|| run(text.as_bytes())).is_ok(), "seed {seed}:\n{text}");
    }
}
