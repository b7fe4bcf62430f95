//! Alert rules, dashboard and documentation name metrics that exist.

use std::{collections::BTreeSet, fs, path::Path};

use azel::contract::{Command, driver};

use super::{Families, running, scrape, until};
use crate::common::units;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// Returns the words of a text that have the form of a metric's name.
fn names(text: &str) -> BTreeSet<&str> {
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let words = text.split(|letter| !is_part(letter));
    words.filter(|word| word.starts_with("azel_") || word.starts_with("process_")).collect()
}

/// Returns the names of the samples of a family.
fn sample_name(family: &str, kind: &str) -> String {
    match kind {
        "counter" => format!("{family}_total"),
        "info" => format!("{family}_info"),
        _ => family.to_owned(),
    }
}

fn all_names(families: &Families) -> BTreeSet<String> {
    families.iter().map(|(name, family)| sample_name(name, &family.kind)).collect()
}

#[tokio::test(start_paused = true)]
async fn rules_and_dashboard_use_metrics_of_a_running_station() {
    let (_scene, client) = running(&units::station()).await;
    let dish = client.snapshot().antennas[0].id();
    let park = Command::Antenna(dish, driver::Command::Park);
    client.send(park).unwrap();
    client.stop(dish);
    until("the proof", || client.snapshot().antennas[0].tally.stops.proof).await;
    let families = scrape(&client).await;
    let known = all_names(&families);
    // The computer of a rehearsal does not report its clock, and nothing is tracked here.
    let may_be_absent = [
        "azel_time_synchronised",
        "azel_pointing_error_degrees",
        "azel_demanded_azimuth_degrees",
        "azel_demanded_elevation_degrees",
        "azel_unit_clock_offset_seconds",
        "azel_next_pass_start_timestamp_seconds",
    ];
    let shown: BTreeSet<String> = families
        .iter()
        .filter(|(_, family)| !family.samples.is_empty())
        .map(|(name, family)| sample_name(name, &family.kind))
        .collect();
    for (path, min) in [
        ("assets/monitoring/azel.rules.yml", 10),
        ("assets/monitoring/azel.test.yml", 8),
        ("assets/monitoring/grafana.json", 30),
    ] {
        let text = read(path);
        let used = names(&text);
        assert!(used.len() >= min, "{path}: {}", used.len());
        for name in used {
            assert!(known.contains(name), "{path}: there is no {name}");
            let is_shown = shown.contains(name) || may_be_absent.contains(&name);
            let is_of_linux = name.starts_with("process_") && !cfg!(target_os = "linux");
            assert!(is_shown || is_of_linux, "{path}: {name} has no sample");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn the_document_lists_every_metric_with_its_labels() {
    let (_scene, client) = running(&units::station()).await;
    let families = scrape(&client).await;
    let text = read("docs/operator/monitoring.md");
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("| `")).collect();
    let documented: BTreeSet<String> = rows
        .iter()
        .filter_map(|row| row.trim_start_matches("| `").split('`').next())
        .filter(|name| name.starts_with("azel_") || name.starts_with("process_"))
        .map(str::to_owned)
        .collect();
    assert_eq!(documented, all_names(&families));
    for (name, family) in &families {
        let name = sample_name(name, &family.kind);
        let row = rows.iter().find(|row| row.starts_with(&format!("| `{name}`"))).unwrap();
        let labels = family.samples.iter().flat_map(|(labels, _)| labels);
        for (label, value) in labels {
            let is_of_antenna = ["antenna", "make"].contains(&&**label);
            assert!(is_of_antenna || row.contains(&format!("`{label}`")), "{name}: {label}");
            let is_state = ["state", "intent", "party", "outcome", "priority", "kind", "mode"];
            let is_named = !is_state.contains(&&**label) || row.contains(&format!("`{value}`"));
            assert!(is_named, "{name}: {value}");
        }
    }
}

#[test]
fn the_dashboard_is_valid_and_its_panels_differ() {
    let dashboard: serde_json::Value =
        serde_json::from_str(&read("assets/monitoring/grafana.json")).unwrap();
    let panels = dashboard["panels"].as_array().unwrap();
    let ids: BTreeSet<u64> = panels.iter().map(|panel| panel["id"].as_u64().unwrap()).collect();
    assert_eq!(ids.len(), panels.len());
    for panel in panels.iter().filter(|panel| panel["type"] != "row") {
        let targets = panel["targets"].as_array().unwrap();
        assert!(!targets.is_empty() && panel["datasource"]["uid"] == "${datasource}", "{panel}");
    }
}
