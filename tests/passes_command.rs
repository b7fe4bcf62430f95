//! `azel passes` as called from a shell and read by another program.

mod asked;
mod chosen;
mod fields;
mod look;

use std::{
    io::Write as _,
    process::{Command, Output, Stdio},
};

use jiff::Timestamp;
use serde_json::Value;

const SITE: [&str; 6] = ["--lat", "41.02", "--lon", "29.17", "--alt", "100"];
const WINDOW: [&str; 4] = ["--from", "2026-08-12T00:00:00Z", "--hours", "72"];

fn command(place_and_time: &[&str], arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_azel"));
    command
        .args(["passes", "--elements", "-"])
        .args(place_and_time)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// Runs `azel passes` on elements given on standard input.
fn passes(elements: &str, arguments: &[&str]) -> Output {
    let mut child = command(&[&SITE[..], &WINDOW].concat(), arguments).spawn().unwrap();
    // Ignore errors: the program may have ended because of its arguments.
    let _ = child.stdin.take().unwrap().write_all(elements.as_bytes());
    child.wait_with_output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn reference() -> Value {
    serde_json::from_str(include_str!("data/reference_passes.json")).unwrap()
}

/// Returns all sets of the reference as TLE.
fn reference_elements() -> String {
    let sets = reference()["satellites"].clone();
    let line = |set: &Value, key: &str| set[key].as_str().unwrap().to_owned();
    sets.as_object()
        .unwrap()
        .values()
        .flat_map(|set| [line(set, "line1"), line(set, "line2")])
        .collect::<Vec<_>>()
        .join("\n")
}

fn rows(output: &Output) -> Vec<Value> {
    let whole: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(whole["format_version"], 1);
    whole.as_object().unwrap().values().find_map(Value::as_array).unwrap().clone()
}

#[test]
fn the_json_holds_the_passes_of_the_reference() {
    let output = passes(&reference_elements(), &["--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let rows = rows(&output);
    let reference = reference();
    let over_the_horizon = |pass: &&Value| pass["min_el"] == 0.0;
    let expected = reference["passes"].as_array().unwrap().iter().filter(over_the_horizon).count();
    assert_eq!(rows.len(), expected);
    let aos: Vec<Timestamp> =
        rows.iter().map(|row| row["aos_time"].as_str().unwrap().parse().unwrap()).collect();
    assert!(aos.is_sorted());
    for row in &rows {
        let (low, high) = (&row["aos_elevation_deg"], &row["max_elevation_deg"]);
        assert!(low.as_f64().unwrap() <= high.as_f64().unwrap(), "{row}");
        assert_eq!(row["tca_elevation_deg"], *high);
        assert!((0.0..360.0).contains(&row["los_azimuth_deg"].as_f64().unwrap()), "{row}");
    }
}

#[test]
fn floor_and_numbers_choose_and_threads_change_nothing() {
    let all = rows(&passes(&reference_elements(), &["--format", "json"]));
    let chosen = all[0]["catalog_number"].clone();
    let number = chosen.to_string();
    let arguments = ["--format", "json", "--floor", "20", "--catalog-number", &number];
    let some = rows(&passes(&reference_elements(), &arguments));
    let expected: Vec<_> = all
        .into_iter()
        .filter(|row| row["catalog_number"] == chosen)
        .filter(|row| row["max_elevation_deg"].as_f64().unwrap() >= 20.0)
        .collect();
    assert!(!expected.is_empty());
    assert_eq!(some, expected);
    let threads = [&arguments[..], &["--threads", "3"]].concat();
    assert_eq!(rows(&passes(&reference_elements(), &threads)), expected);
}

#[test]
fn a_mask_cuts_a_pass_into_its_clear_stretches() {
    let folder = tempfile::tempdir().unwrap();
    let mask = folder.path().join("mask.txt");
    std::fs::write(&mask, "# a tower to the south\n0 0\n150 0\n151 60\n209 60\n210 0\n").unwrap();
    let open = rows(&passes(&reference_elements(), &["--format", "json"]));
    let arguments = ["--format", "json", "--mask", mask.to_str().unwrap()];
    let masked = rows(&passes(&reference_elements(), &arguments));
    assert_ne!(masked.len(), open.len());
    for row in &masked {
        let azimuth = row["aos_azimuth_deg"].as_f64().unwrap();
        let elevation = row["aos_elevation_deg"].as_f64().unwrap();
        let behind_the_tower = (151.0..=209.0).contains(&azimuth);
        assert!(!behind_the_tower || elevation > 59.99, "{row}");
    }
}

/// Returns an object as OMM, with other values for some fields.
fn object(values: &[(&str, Value)]) -> Value {
    let mut object = serde_json::json!({
        "OBJECT_NAME": "SMALLSAT", "NORAD_CAT_ID": 5, "EPOCH": "2026-08-12T00:00:00",
        "MEAN_MOTION": 15.5, "ECCENTRICITY": 0.0002, "INCLINATION": 51.6,
        "RA_OF_ASC_NODE": 225.4, "ARG_OF_PERICENTER": 44.9, "MEAN_ANOMALY": 5.1,
        "BSTAR": 0.0001
    });
    for (field, value) in values {
        object[*field] = value.clone();
    }
    object
}

/// Runs `azel` with nothing on standard input.
fn azel(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_azel")).args(arguments).output().unwrap()
}

/// A folder of element files.
struct Files(tempfile::TempDir);

impl Files {
    fn new(files: &[(&str, String)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, content) in files {
            std::fs::write(folder.path().join(name), content).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }

    /// Runs `azel passes` with CSV output on the files with these `names`.
    fn passes(&self, names: &[&str], arguments: &[&str]) -> Output {
        let paths: Vec<String> = names.iter().map(|name| self.path(name)).collect();
        let mut command = vec!["passes", "--elements"];
        command.extend(paths.iter().map(String::as_str));
        azel(&[&command[..], &SITE, &WINDOW, &["--format", "csv"], arguments].concat())
    }
}

#[test]
fn every_unusable_object_is_named_and_the_exit_code_says_so() {
    let mut elements = reference_elements();
    let broken = elements.lines().next().unwrap().replace(" 0 ", " 4 ");
    elements = [&elements, broken.as_str(), "no elements at all"].join("\n");
    let output = passes(&elements, &["--format", "csv"]);
    assert_eq!(output.status.code(), Some(3));
    let said = text(&output.stderr);
    assert!(said.lines().any(|line| line.starts_with("-:")), "{said}");
    let output = passes(&elements, &["--format", "csv", "--catalog-number", "900,999999999"]);
    assert_eq!(output.status.code(), Some(3));
    let said = text(&output.stderr);
    assert!(said.contains("999999999: no elements of this object"), "{said}");
    let table = text(&output.stdout);
    assert!(table.lines().count() > 1, "{table}");
    assert!(table.lines().skip(1).all(|line| line.starts_with("900,")), "{table}");
}

#[test]
fn what_cannot_be_meant_is_refused_with_the_reason() {
    for (arguments, reason) in [
        (&["--hours", "-1"][..], "between 0 and"),
        (&["--hours", "NaN"], "between 0 and"),
        (&["--floor", "91"], "between -90 and 90"),
        (&["--from", "yesterday"], "2026-08-12T09:00:00+03:00"),
        (&["--from", "2026-08-12T00:00:00"], "an offset"),
        (&["--doppler", "-1"], "MHz"),
        (&["--name", ""], "--name"),
        (&["--group", "weather"], "needs --station"),
        (&["--threads", "0"], "--threads"),
        (&["--format", "pdf"], "table"),
    ] {
        let output = command(&SITE, arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(reason), "{}", text(&output.stderr));
    }
    for (place, reason) in [
        (["91", "29", "0"], "latitude 91 is not between"),
        (["41", "400", "0"], "longitude 400 is not between"),
        (["41", "29", "99999"], "altitude 99999 is not between"),
        (["NaN", "29", "0"], "latitude NaN"),
    ] {
        let [lat, lon, alt] = place;
        let output = azel(&["passes", "--elements", "-", "--lat", lat, "--lon", lon, "--alt", alt]);
        assert_eq!(output.status.code(), Some(2), "{place:?}");
        assert!(text(&output.stderr).contains(reason), "{}", text(&output.stderr));
    }
    for arguments in [&["passes"][..], &["passes", "--lat", "1", "--lon", "1", "--alt", "1"]] {
        let output = azel(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains("--elements"), "{}", text(&output.stderr));
    }
    let nothing = passes("", &[]);
    assert_eq!(nothing.status.code(), Some(1));
    let told = "-: no elements, it is empty\nThere are no elements to compute with.";
    assert_eq!(text(&nothing.stderr).trim(), told);
    let page = passes("<!DOCTYPE html><html>", &[]);
    assert!(text(&page.stderr).starts_with("-: no elements, it is a web page\n"));
    let missing = passes("", &["--mask", "/no/such/mask"]);
    assert_eq!(missing.status.code(), Some(1));
    assert!(text(&missing.stderr).contains("/no/such/mask"));
}

#[test]
fn a_reader_may_stop_early() {
    for format in ["table", "csv", "json", "ics"] {
        let arguments = ["--format", format];
        let mut child = command(&[&SITE[..], &WINDOW].concat(), &arguments).spawn().unwrap();
        drop(child.stdout.take());
        child.stdin.take().unwrap().write_all(reference_elements().as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        let told = (output.status.code(), text(&output.stderr));
        assert_eq!(told, (Some(0), String::new()), "{format}");
    }
}

#[test]
fn a_pass_has_range_light_epoch_and_doppler() {
    let elements = reference_elements();
    let arguments = ["--format", "json", "--doppler", "145.8"];
    let list = rows(&passes(&elements, &arguments));
    let mut sunlit = 0;
    for row in &list {
        let number = |name: &str| row[name].as_f64().unwrap();
        assert!(row["age_days"].as_f64().unwrap().abs() < 60.0, "{row}");
        assert!(row["epoch"].as_str().unwrap().parse::<Timestamp>().is_ok(), "{row}");
        assert!(row["dark_at_site"].is_boolean(), "{row}");
        sunlit += usize::from(row["sunlit"].as_bool().unwrap());
        let is_short = row["duration_s"].as_f64().unwrap() < 1000.0;
        if is_short && row["starts_before"] == false && row["ends_after"] == false {
            assert!(number("aos_range_km") > number("range_km"), "{row}");
            assert!(number("los_range_km") > number("range_km"), "{row}");
            // The satellite approaches, then recedes.
            assert!(number("aos_doppler_hz") > 0.0 && number("los_doppler_hz") < 0.0);
            assert!(number("aos_range_rate_km_s") < 0.0, "{row}");
        }
    }
    assert!(sunlit > 0 && sunlit < list.len(), "{sunlit} of {}", list.len());
    let table = text(&passes(&elements, &["--format", "csv", "--doppler", "145.8"]).stdout);
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    assert!(head.ends_with(&["aos_doppler_hz", "tca_doppler_hz", "los_doppler_hz"]), "{head:?}");
    for (line, row) in lines.zip(&list) {
        assert_eq!(line.len(), head.len());
        let field = |name: &str| line[head.iter().position(|head| *head == name).unwrap()];
        assert_eq!(field("epoch"), row["epoch"]);
        assert_eq!(field("range_km").parse().ok(), row["range_km"].as_f64());
        assert_eq!(field("los_doppler_hz").parse().ok(), row["los_doppler_hz"].as_f64());
        assert_eq!(field("sunlit"), row["sunlit"].to_string());
    }
}

#[test]
fn events_stay_when_the_window_moves() {
    let ids = |arguments: &[&str]| -> Vec<String> {
        let output = passes(&reference_elements(), &[&["--format", "ics"], arguments].concat());
        let calendar = text(&output.stdout).replace("\r\n ", "");
        calendar.lines().filter_map(|line| line.strip_prefix("UID:")).map(str::to_owned).collect()
    };
    let run = |from: &str| {
        let arguments = ["--from", from, "--hours", "24", "--format", "ics"];
        let mut child = command(&SITE, &arguments).spawn().unwrap();
        child.stdin.take().unwrap().write_all(reference_elements().as_bytes()).unwrap();
        let calendar = text(&child.wait_with_output().unwrap().stdout).replace("\r\n ", "");
        let ids = calendar.lines().filter_map(|line| line.strip_prefix("UID:"));
        ids.map(str::to_owned).collect::<std::collections::BTreeSet<_>>()
    };
    let all = ids(&[]);
    let set: std::collections::BTreeSet<_> = all.iter().cloned().collect();
    assert_eq!(set.len(), all.len());
    for from in ["2026-08-12T06:00:00Z", "2026-08-13T00:03:00Z", "2026-08-13T17:31:00Z"] {
        let moved = run(from);
        assert!(moved.len() > 10 && moved.is_subset(&set), "{from}");
    }
}

#[test]
fn numbers_that_no_orbit_has_are_refused_by_name_before_anything_is_computed() {
    let object = |field: &str, value: &str| {
        let damaged = [("OBJECT_NAME", "DAMAGED".into()), ("NORAD_CAT_ID", 7.into())];
        object(&[&damaged[..], &[(field, value.into())]].concat())
    };
    let good = object("NORAD_CAT_ID", "5");
    for (field, value, reason) in [
        ("MEAN_ANOMALY", "999999999999999999995.1", "mean anomaly 1e21 is not from -360 to 360"),
        ("MEAN_ANOMALY", "1e12", "mean anomaly 1000000000000.0 is not from -360 to 360"),
        ("MEAN_ANOMALY", "-361", "mean anomaly -361.0 is not from -360 to 360"),
        ("INCLINATION", "1e21", "inclination 1e21 is not from 0 to 180"),
        ("INCLINATION", "-1", "inclination -1.0 is not from 0 to 180"),
        ("RA_OF_ASC_NODE", "1e21", "right ascension of the node 1e21 is not from -360 to 360"),
        ("ARG_OF_PERICENTER", "1e21", "argument of perigee 1e21 is not from -360 to 360"),
        ("BSTAR", "15", "B* 15.0 is not from -10 to 10"),
        ("EPOCH", "1956-12-31T00:00:00", "epoch 1956-12-31T00:00:00 is not from 1957 to 2056"),
        ("EPOCH", "2057-01-01T00:00:00", "epoch 2057-01-01T00:00:00 is not from 1957 to 2056"),
    ] {
        let text_of_both = serde_json::json!([object(field, value), good]).to_string();
        let output = passes(&text_of_both, &["--format", "csv"]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{field} {value}: {said}");
        assert!(said.contains(&format!("DAMAGED: {reason}")), "{said}");
        assert!(text(&output.stdout).lines().count() > 1, "the other object has passes");
    }
}
