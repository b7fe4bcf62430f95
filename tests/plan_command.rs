//! `azel plan` as called from a shell and read by another program.

use std::{
    collections::BTreeSet,
    fs,
    path::Path,
    process::{Command, Output},
};

use azel::{
    controller::SPECS,
    makes::DemoAddresses,
    orbit::{bundled, tle_lines},
    station::{Station, save},
};
use serde_json::Value;

fn plan(folder: &Path, arguments: &[&str]) -> Output {
    let file = |name: &str| folder.join(name).display().to_string();
    Command::new(env!("CARGO_BIN_EXE_azel"))
        .args(["plan", "--station", &file("station.toml"), "--elements", &file("active.tle")])
        .args(["--from", "2026-08-12T00:00:00Z"])
        .args(arguments)
        .output()
        .unwrap()
}

/// Returns a folder with the demo station and elements of its favourites.
pub(super) fn folder() -> tempfile::TempDir {
    folder_with(|_| ())
}

/// Returns a folder as [`folder`] does, with a change to the station but not to the elements.
pub(super) fn folder_with(change: impl FnOnce(&mut Station)) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let address = |port: u16| format!("127.0.0.1:{port}");
    let addresses =
        DemoAddresses { satrak: address(4001), genius: address(9006), rc2000c: address(4002) };
    let mut station = Station::demo(&addresses);
    let numbers = station.favourites.numbers();
    change(&mut station);
    save(&station, &folder.path().join("station.toml"), SPECS).unwrap();
    let catalog = bundled().unwrap();
    let sets = numbers.iter().filter_map(|number| catalog.get(*number));
    let lines = sets.flat_map(|elements| {
        let [first, second] = tle_lines(elements).unwrap();
        [elements.name().to_owned(), first, second]
    });
    let text: Vec<String> = lines.collect();
    fs::write(folder.path().join("active.tle"), text.join("\n")).unwrap();
    folder
}

pub(super) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn every_pass_is_taken_or_left_out_with_a_reason_in_every_form() {
    let folder = folder();
    let json = plan(folder.path(), &["--format", "json"]);
    assert_eq!(json.status.code(), Some(0), "{}", text(&json.stderr));
    let whole: Value = serde_json::from_slice(&json.stdout).unwrap();
    let passes = whole["passes"].as_array().unwrap();
    let count = |state: &str| passes.iter().filter(|pass| pass["state"] == state).count();
    let (entries, left_out) = (count("taken"), count("left out"));
    assert!(entries > 40, "{entries}");
    assert_eq!((&whole["format_version"], &whole["is_proved_best"]), (&1.into(), &true.into()));
    let names: BTreeSet<&String> =
        passes.iter().flat_map(|pass| pass.as_object().unwrap().keys()).collect();
    let handbook = include_str!("../docs/operator/command-line.md");
    let (_, table) = handbook.split_once("\n| field of a plan | unit | meaning |\n").unwrap();
    let rows = table.lines().skip(1).take_while(|line| line.starts_with('|'));
    let cells = rows.filter_map(|row| row.split('|').nth(1));
    let documented: BTreeSet<&str> =
        cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)).collect();
    assert!(documented.iter().copied().eq(names.into_iter().map(String::as_str)), "{documented:?}");

    let csv = text(&plan(folder.path(), &["--format", "csv"]).stdout);
    let rows = |start: &str| csv.lines().filter(|line| line.starts_with(start)).count();
    assert_eq!((rows("taken,"), rows("left out,")), (entries, left_out));
    let mut missed = passes.iter().filter(|pass| pass["state"] == "left out");
    assert!(missed.all(|pass| pass["reason"].is_string()), "{passes:#?}");

    let table = text(&plan(folder.path(), &[]).stdout);
    assert_eq!(table.lines().count(), 1 + entries + left_out, "{table}");
    let calendar = text(&plan(folder.path(), &["--format", "ics"]).stdout);
    assert_eq!(calendar.matches("BEGIN:VEVENT").count(), entries);
    assert_eq!(calendar.matches("TRIGGER;RELATED=START:-PT300S").count(), entries, "{calendar}");
}

#[test]
fn the_hand_over_sheet_is_one_page_of_the_first_24_hours() {
    let folder = folder();
    let sheet = |hours: &str| {
        let output = plan(folder.path(), &["--format", "html", "--hours", hours]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let html = text(&output.stdout);
        // Leave out the minute of the print.
        let (before, printed) = html.split_once("Printed ").unwrap();
        format!("{before}{}", printed.split_once('<').unwrap().1)
    };
    let page = sheet("24");
    let csv = text(&plan(folder.path(), &["--format", "csv"]).stdout);
    let taken = csv.lines().filter(|line| line.starts_with("taken,")).count();
    assert!(page.contains(&format!(">{taken} passes<")), "{page}");
    let span = ">Wed 2026-08-12 00:00Z to Thu 2026-08-13 00:00Z (UTC)<";
    assert!(page.contains(span), "{page}");
    assert_eq!(page, sheet("24"));
    assert!(sheet("48").contains(span));
}

#[test]
fn a_station_file_that_is_not_there_ends_with_a_sentence() {
    let output = Command::new(env!("CARGO_BIN_EXE_azel"))
        .args(["plan", "--station", "/nowhere/station.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("/nowhere/station.toml"));
}

/// Returns the first line of an element set with an epoch this much later, seconds.
fn later_epoch(line: &str, seconds: f64) -> String {
    let day: f64 = line[20..32].parse().unwrap();
    let line = format!("{}{:012.8}{}", &line[..20], day + seconds / 86_400.0, &line[32..68]);
    let digit = |sign: char| sign.to_digit(10).unwrap_or(u32::from(sign == '-'));
    let sum = line.chars().map(digit).sum::<u32>() % 10;
    format!("{line}{sum}")
}

#[test]
fn events_of_a_plan_keep_their_identities_when_the_elements_are_renewed() {
    // Keep one antenna, because another one might take a pass.
    let folder = folder_with(|station| station.antennas.truncate(1));
    let calendar = || {
        let output = plan(folder.path(), &["--format", "ics"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        text(&output.stdout).replace("\r\n ", "")
    };
    let without_stamps = |calendar: &str| -> Vec<String> {
        calendar.lines().filter(|line| !line.starts_with("DTSTAMP")).map(str::to_owned).collect()
    };
    let ids = |calendar: &str| -> BTreeSet<String> {
        calendar.lines().filter(|line| line.starts_with("UID:")).map(str::to_owned).collect()
    };
    let first = calendar();
    assert_eq!(without_stamps(&first), without_stamps(&calendar()));
    // Each event has an alarm.
    assert_eq!(ids(&first).len(), 2 * first.matches("BEGIN:VEVENT").count());

    let file = folder.path().join("active.tle");
    let renew = |line: &str| match line.strip_prefix("1 ") {
        Some(_) => later_epoch(line, 0.4),
        None => line.to_owned(),
    };
    let elements: Vec<String> = fs::read_to_string(&file).unwrap().lines().map(renew).collect();
    fs::write(&file, elements.join("\n")).unwrap();
    let renewed = calendar();
    assert_ne!(without_stamps(&first), without_stamps(&renewed));
    let (first, renewed) = (ids(&first), ids(&renewed));
    assert_eq!(first.symmetric_difference(&renewed).collect::<Vec<_>>(), [&""; 0]);
}

#[test]
fn a_unit_gets_no_passes_of_a_satellite_whose_name_it_cannot_take() {
    let folder = folder();
    let file = folder.path().join("active.tle");
    let elements = fs::read_to_string(&file).unwrap();
    assert!(elements.contains("ISS (ZARYA)"), "{elements}");
    fs::write(&file, elements.replace("ISS (ZARYA)", "ISS (ZARYA*)")).unwrap();
    let json = plan(folder.path(), &["--catalog-number", "25544", "--format", "json"]);
    assert_eq!(json.status.code(), Some(0), "{}", text(&json.stderr));
    let whole: Value = serde_json::from_slice(&json.stdout).unwrap();
    let passes = whole["passes"].as_array().unwrap();
    let antennas: Vec<&Value> = passes.iter().map(|pass| &pass["antenna"]).collect();
    // Program track of the other units does not send the satellite's name.
    assert!(antennas.iter().any(|antenna| *antenna == "Genius"), "{passes:#?}");
    assert!(antennas.iter().all(|antenna| *antenna != "Satrak"), "{passes:#?}");

    let folder = folder_with(|station| station.antennas.truncate(1));
    fs::copy(&file, folder.path().join("active.tle")).unwrap();
    let of_iss = |format| plan(folder.path(), &["--catalog-number", "25544", "--format", format]);
    let csv = text(&of_iss("csv").stdout);
    let reason = ",Not possible: this unit cannot take the satellite's name";
    assert!(csv.lines().count() > 1, "{csv}");
    assert!(csv.lines().skip(1).any(|line| line.contains(reason)), "{csv}");
    assert!(!csv.contains("taken,"), "{csv}");
    let whole: Value = serde_json::from_slice(&of_iss("json").stdout).unwrap();
    let passes = whole["passes"].as_array().unwrap();
    let said = reason.trim_start_matches(',');
    assert!(passes.iter().any(|pass| pass["reason"] == said), "{passes:#?}");
}
