//! The fields of CSV and JSON are those that the operator's handbook and `--help` name.

use std::collections::BTreeSet;

use super::*;

/// Names in a cell of the table: `tca_…` and `tca.…` stand for the first name, of another point.
fn names(cell: &str) -> Vec<String> {
    let quoted: Vec<&str> = cell.split('`').skip(1).step_by(2).collect();
    let of_aos = quoted.first().and_then(|first| first.strip_prefix("aos")).unwrap_or_default();
    quoted
        .iter()
        .map(|name| match name.split_once('…') {
            Some((point, "")) => format!("{}{of_aos}", point.trim_end_matches(['_', '.'])),
            _ => (*name).to_owned(),
        })
        .collect()
}

/// Fields of CSV and of JSON by the table in the handbook.
fn documented() -> [BTreeSet<String>; 2] {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/operator.md");
    let handbook = std::fs::read_to_string(path).unwrap();
    let (_, table) = handbook.split_once("\n| CSV | JSON | unit | meaning |\n").unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .skip(1)
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.split('|').skip(1).collect())
        .collect();
    [0, 1].map(|column| rows.iter().flat_map(|cells| names(cells[column])).collect())
}

/// Fields of an object of JSON, those of objects in it after a point.
fn fields(object: &Value) -> BTreeSet<String> {
    let of_one = |(name, value): (&String, &Value)| -> Vec<String> {
        match value {
            Value::Object(_) => {
                fields(value).iter().map(|inner| format!("{name}.{inner}")).collect()
            }
            _ => vec![name.clone()],
        }
    };
    object.as_object().unwrap().iter().flat_map(of_one).collect()
}

fn written() -> [BTreeSet<String>; 2] {
    let of = |format| passes(&reference_elements(), &["--doppler", "145.8", "--format", format]);
    let csv = text(&of("csv").stdout);
    let head = csv.lines().next().unwrap().split(',').map(str::to_owned).collect();
    [head, fields(&rows(&of("json"))[0])]
}

#[test]
fn the_handbook_names_the_fields_that_are_written() {
    let ([csv, json], [written_csv, written_json]) = (documented(), written());
    assert_eq!(csv, written_csv);
    assert_eq!(json, written_json);
}

#[test]
fn the_help_names_the_fields_that_are_written() {
    let help = text(&azel(&["passes", "--help"]).stdout);
    let words: BTreeSet<&str> =
        help.split(|letter: char| !(letter.is_alphanumeric() || letter == '_')).collect();
    let [_, json] = written();
    for name in json.iter().flat_map(|path| path.split('.')) {
        assert!(words.contains(name), "{name}");
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
