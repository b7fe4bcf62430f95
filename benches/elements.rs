//! Time to read 30,000 objects in each form: `cargo bench --bench elements`.
//!
//! The objects are the bundled objects, repeated under other numbers to reach the total.

// A bench prints its results, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::{fmt::Write as _, hint::black_box, time::Instant};

use azel::orbit::{Elements, bundled, read_elements, write_omm_csv, write_omm_json, write_tle};
use serde_json::{Map, Value};

const OBJECTS: usize = 30_000;
/// First number of the repeated objects, low enough for a TLE.
const FIRST_NUMBER: usize = 300_000;
/// Number of runs; the shortest counts.
const RUNS: usize = 7;

type Message = Map<String, Value>;

fn messages() -> Vec<Message> {
    let catalog = bundled().unwrap();
    let json = written(|out| write_omm_json(catalog.iter(), out));
    let known: Vec<Message> = serde_json::from_str(&json).unwrap();
    let more = known.iter().cycle().zip(FIRST_NUMBER..).map(|(message, number)| {
        let mut message = message.clone();
        message.insert("NORAD_CAT_ID".to_owned(), number.into());
        message
    });
    known.iter().cloned().chain(more).take(OBJECTS).collect()
}

fn written<T>(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<T>) -> String {
    let mut out = Vec::new();
    write(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// Returns the fields of a message, with their values.
fn fields(message: &Message) -> impl Iterator<Item = (&str, String)> {
    message.iter().map(|(key, value)| {
        (key.as_str(), value.as_str().map_or_else(|| value.to_string(), str::to_owned))
    })
}

fn kvn(messages: &[Message]) -> String {
    let mut text = String::new();
    for message in messages {
        text += "CCSDS_OMM_VERS = 2.0\nCREATION_DATE = 2026-08-11T00:00:00\nORIGINATOR = X\n\
                 CENTER_NAME = EARTH\nREF_FRAME = TEME\nTIME_SYSTEM = UTC\nMEAN_ELEMENT_THEORY = SGP4\n";
        for (key, value) in fields(message) {
            writeln!(text, "{key} = {value}").unwrap();
        }
    }
    text
}

fn xml(messages: &[Message]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ndm>\n".to_owned();
    for message in messages {
        text += "<omm id=\"CCSDS_OMM_VERS\" version=\"2.0\"><header><CREATION_DATE/><ORIGINATOR/>\
                 </header><body><segment><metadata><CENTER_NAME>EARTH</CENTER_NAME>\n";
        for (key, value) in fields(message) {
            let value = value.replace('&', "&amp;").replace('<', "&lt;");
            writeln!(text, "<{key}>{value}</{key}>").unwrap();
        }
        text += "</metadata></segment></body></omm>\n";
    }
    text + "</ndm>\n"
}

fn measure(form: &str, text: &str, expected: &[Elements]) {
    let mut shortest_s = f64::INFINITY;
    for _ in 0..RUNS {
        let start = Instant::now();
        let report = black_box(read_elements(black_box(text)));
        shortest_s = shortest_s.min(start.elapsed().as_secs_f64());
        assert!(report.elements == expected && report.refused.is_empty(), "{form}");
    }
    let (ms, mb) = (shortest_s * 1e3, text.len() as f64 / 1e6);
    println!("{form:>8} {ms:>7.1} ms {mb:>6.1} MB {:>6.0} MB/s", mb / shortest_s);
}

fn main() {
    let messages = messages();
    let json = serde_json::to_string(&messages).unwrap();
    let elements = read_elements(&json).elements;
    assert_eq!(elements.len(), OBJECTS);
    measure("TLE", &written(|out| write_tle(&elements, out)), &elements);
    measure("OMM JSON", &json, &elements);
    measure("OMM CSV", &written(|out| write_omm_csv(&elements, out)), &elements);
    measure("OMM XML", &xml(&messages), &elements);
    measure("OMM KVN", &kvn(&messages), &elements);
}
