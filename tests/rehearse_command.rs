//! `azel rehearse` as called from a shell and read by another program.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use azel::station::Favourites;
use serde_json::Value;

use super::plan_command::{folder, folder_with, text};

fn rehearse(folder: &Path, arguments: &[&str]) -> Output {
    let file = |name: &str| folder.join(name).display().to_string();
    Command::new(env!("CARGO_BIN_EXE_azel"))
        .args(["rehearse", "--station", &file("station.toml"), "--elements", &file("active.tle")])
        .args(["--from", "2026-08-12T11:03:00Z", "--hours", "0.2"])
        .args(arguments)
        .output()
        .unwrap()
}

/// Returns all files of a folder, with their bytes.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.clone(), fs::read(path).unwrap())).collect()
}

#[test]
fn each_pass_stands_in_every_form_beside_its_promise_and_no_file_is_touched() {
    let folder = folder();
    let before = files(folder.path());
    let json = rehearse(folder.path(), &["--format", "json"]);
    assert_eq!(json.status.code(), Some(0), "{}", text(&json.stderr));
    assert!(text(&json.stderr).contains("no antenna has moved"));
    assert_eq!(files(folder.path()), before);
    let whole: Value = serde_json::from_slice(&json.stdout).unwrap();
    let passes = whole["passes"].as_array().unwrap();
    assert_eq!(passes.len(), 3, "{passes:?}");
    for pass in passes {
        let got_s = pass["flown"]["in_beam_s"].as_f64().unwrap();
        assert!(got_s > 0.97 * pass["promised_s"].as_f64().unwrap(), "{pass}");
    }

    let csv = text(&rehearse(folder.path(), &["--format", "csv"]).stdout);
    let rows: Vec<&str> = csv.lines().collect();
    assert_eq!(rows.len(), 1 + passes.len(), "{csv}");
    assert!(rows[1..].iter().all(|row| row.contains("Within half the beamwidth")), "{csv}");
    let table = text(&rehearse(folder.path(), &[]).stdout);
    assert_eq!(table.lines().count(), rows.len(), "{table}");
}

#[test]
fn a_fault_is_told_with_what_it_cost_and_a_wrong_one_with_the_list_of_right_ones() {
    let folder = folder();
    let fault = "link-lost,antenna=Satrak,after=6,for=60";
    let table = text(&rehearse(folder.path(), &["--fault", fault]).stdout);
    assert!(table.contains("lost: The unit did not answer."), "{table}");
    let wrong = rehearse(folder.path(), &["--fault", "fire"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(
        text(&wrong.stderr).contains("link-lost, power-cut, silence"),
        "{}",
        text(&wrong.stderr)
    );
    let nobody = rehearse(folder.path(), &["--fault", "noise,antenna=Nobody"]);
    assert_eq!(nobody.status.code(), Some(1));
    assert!(text(&nobody.stderr).contains("Nobody"), "{}", text(&nobody.stderr));
    let speed = rehearse(folder.path(), &["--speed", "201"]);
    assert_eq!(speed.status.code(), Some(2));
}

#[test]
fn objects_that_are_asked_for_need_not_be_favourites() {
    let folder = folder_with(|station| station.favourites = Favourites::default());
    let passes = |arguments: &[&str]| {
        let csv = rehearse(folder.path(), &[&["--format", "csv"], arguments].concat());
        assert_eq!(csv.status.code(), Some(0), "{}", text(&csv.stderr));
        text(&csv.stdout).lines().skip(1).map(str::to_owned).collect::<Vec<_>>()
    };
    let all = passes(&[]);
    assert_eq!(all.len(), 3, "{all:#?}");
    let number = all[0].split(',').nth(1).unwrap();
    let of_one = passes(&["--catalog-number", number]);
    assert!(!of_one.is_empty());
    let is_asked = |row: &String| row.split(',').nth(1) == Some(number);
    assert!(of_one.iter().all(is_asked), "{of_one:#?}");
}
