//! Fields of CSV and JSON, which the operator's handbook and `--help` must name.

use std::collections::BTreeSet;

use super::*;

/// Returns the fields in the table of the handbook.
fn documented() -> BTreeSet<String> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/operator/command-line.md");
    let handbook = std::fs::read_to_string(path).unwrap();
    let (_, table) = handbook.split_once("\n| field of a pass | unit | meaning |\n").unwrap();
    let rows = table.lines().skip(1).take_while(|line| line.starts_with('|'));
    let cells = rows.filter_map(|row| row.split('|').nth(1));
    cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)).map(str::to_owned).collect()
}

/// Returns the fields of CSV and of JSON.
fn written() -> [BTreeSet<String>; 2] {
    let of = |format| passes(&reference_elements(), &["--doppler", "145.8", "--format", format]);
    let csv = text(&of("csv").stdout);
    let head = csv.lines().next().unwrap().split(',').map(str::to_owned).collect();
    [head, rows(&of("json"))[0].as_object().unwrap().keys().cloned().collect()]
}

#[test]
fn the_handbook_names_the_fields_that_are_written() {
    for written in written() {
        assert_eq!(documented(), written);
    }
}

#[test]
fn the_help_names_the_fields_that_are_written() {
    let help = text(&azel(&["passes", "--help"]).stdout);
    let words: BTreeSet<&str> =
        help.split(|letter: char| !(letter.is_alphanumeric() || letter == '_')).collect();
    let [fields, _] = written();
    for name in fields {
        assert!(words.contains(&*name), "{name}");
    }
}

#[test]
fn the_help_says_what_directions_leave_out_and_how_lines_end() {
    for command in ["passes", "look"] {
        let help = text(&azel(&[command, "--help"]).stdout);
        let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
        for said in ["refraction is left out", "UT1 is taken as UTC", "no polar motion"] {
            assert!(help.contains(said), "{command}: {said}");
        }
    }
    let help = text(&azel(&["passes", "--help"]).stdout);
    assert!(help.contains("lines end with LF"), "{help}");
    let csv = passes(&reference_elements(), &["--format", "csv"]).stdout;
    assert!(csv.ends_with(b"\n") && !csv.contains(&b'\r'));
}
