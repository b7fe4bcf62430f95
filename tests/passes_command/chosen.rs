//! Options that choose among the passes found, and the alarm of their events.

use super::*;

#[test]
fn short_passes_are_left_out_and_the_first_are_kept() {
    let list = |arguments: &[&str]| {
        rows(&passes(&reference_elements(), &[&["--format", "json"], arguments].concat()))
    };
    let duration_s = |row: &Value| row["duration_s"].as_f64().unwrap();
    let all = list(&[]);
    let long: Vec<Value> = all.iter().filter(|row| duration_s(row) >= 600.0).cloned().collect();
    assert!(long.len() > 5 && long.len() < all.len());
    assert_eq!(list(&["--min-duration", "600"]), long);
    assert_eq!(list(&["--max-passes", "5"]), all[..5]);
    assert_eq!(list(&["--max-passes", "1000000"]), all);
    // `--max-passes` counts only passes that pass `--min-duration`.
    assert_eq!(list(&["--min-duration", "600", "--max-passes", "4"]), long[..4]);
}

#[test]
fn an_event_has_the_alarm_that_was_asked_for() {
    let calendar = |arguments: &[&str]| {
        let arguments = [&["--format", "ics", "--max-passes", "3"], arguments].concat();
        text(&passes(&reference_elements(), &arguments).stdout)
    };
    assert!(!calendar(&[]).contains("VALARM"));
    let with_alarm = calendar(&["--alarm", "12.5"]);
    for line in ["BEGIN:VALARM", "ACTION:DISPLAY", "TRIGGER;RELATED=START:-PT750S"] {
        assert_eq!(with_alarm.matches(&format!("\r\n{line}\r\n")).count(), 3, "{with_alarm}");
    }
    // An alarm keeps its identity, as its event does.
    let ids = |text: &str| -> Vec<String> {
        text.lines().filter_map(|line| line.strip_prefix("UID:")).map(str::to_owned).collect()
    };
    assert_eq!(ids(&with_alarm).len(), 6);
    assert_eq!(ids(&with_alarm), ids(&calendar(&["--alarm", "3"])));
}

#[test]
fn options_without_a_meaning_are_refused() {
    for (arguments, reason) in [
        (&["--alarm", "-1"][..], "minutes"),
        (&["--alarm", "5", "--format", "csv"], "--format ics"),
        (&["--alarm", "5"], "--format ics"),
        (&["--max-passes", "0"], "--max-passes"),
        (&["--min-duration", "-1"], "seconds"),
        (&["--min-duration", "NaN"], "seconds"),
    ] {
        let output = passes(&reference_elements(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(reason), "{}", text(&output.stderr));
    }
}
