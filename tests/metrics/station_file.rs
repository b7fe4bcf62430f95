//! The port for metrics in the station file.

use std::fs;

use azel::{
    controller::SPECS,
    station::{self, MetricsPort, NoteReason, Station},
};

/// Loads a station file with this table, and returns the port and the notes.
fn load(table: &str) -> (Option<MetricsPort>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    station::save(&Station::default(), &path, SPECS).unwrap();
    let text = fs::read_to_string(&path).unwrap() + "\n" + table;
    fs::write(&path, text).unwrap();
    let loaded = station::load(&path, SPECS).unwrap();
    let mut station = loaded.station;
    let notes = loaded.notes.iter().map(|note| match &note.reason {
        NoteReason::Invalid(reason) => format!("{}: {reason}", note.place),
        NoteReason::Unknown => format!("{}: unknown", note.place),
        reason @ NoteReason::DoesNotHold { .. } => panic!("{reason:?}"),
    });
    let notes = notes.collect();
    let port = station.metrics;
    // Another change keeps the table, even if Azel could not read it.
    "Hill".clone_into(&mut station.name);
    station::save(&station, &path, SPECS).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(table) && text.contains("\"Hill\""), "{text}");
    assert_eq!(station::load(&path, SPECS).unwrap().station.metrics, port);
    (port, notes)
}

#[test]
fn a_station_has_no_port_for_metrics_by_default() {
    assert_eq!(load(""), (None, vec![]));
}

#[test]
fn a_port_of_this_computer_needs_no_permission_and_any_other_does() {
    for (listen, open_to_network) in [
        ("127.0.0.1:9464", false),
        ("127.0.0.1:9999", false),
        ("[::1]:9464", false),
        ("0.0.0.0:9464", true),
        ("192.168.1.5:9464", true),
    ] {
        let permission = if open_to_network { "open_to_network = true\n" } else { "" };
        let (port, notes) = load(&format!("[metrics]\nlisten = \"{listen}\"\n{permission}"));
        let listen = listen.parse().unwrap();
        assert_eq!((port, &notes[..]), (Some(MetricsPort { listen, open_to_network }), &[][..]));
    }
}

#[test]
fn a_table_that_cannot_be_used_is_reported_and_stays_in_the_file() {
    for (table, expected) in [
        ("[metrics]\nlisten = \"0.0.0.0:9464\"\n", "metrics: other computers can reach"),
        (
            "[metrics]\nlisten = \"192.168.1.5:9464\"\nopen_to_network = false\n",
            "metrics: other computers can reach",
        ),
        ("[metrics]\nlisten = \"localhost:9464\"\n", "metrics: listen must be an address and"),
        ("[metrics]\nlisten = 9464\n", "metrics: listen must be an address and"),
        ("[metrics]\nopen_to_network = 1\n", "metrics.open_to_network: must be true or false"),
        ("[[metrics]]\nlisten = \"127.0.0.1:9464\"\n", "metrics: must be a table"),
        ("[metrics]\nport = 9464\n", "metrics.port: unknown"),
    ] {
        let (_, notes) = load(table);
        assert!(notes.len() == 1 && notes[0].starts_with(expected), "{table}: {notes:?}");
    }
}
