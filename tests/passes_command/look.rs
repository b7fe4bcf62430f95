//! The command `azel look`.

use super::*;

/// Runs `azel look` on a file of two objects.
fn look(arguments: &[&str]) -> Output {
    let list = Value::from(vec![object(&[]), object(&[("NORAD_CAT_ID", 6.into())])]).to_string();
    let files = Files::new(&[("a.json", list)]);
    let a = files.path("a.json");
    azel(&[&["look", "--elements", &a], &SITE[..], arguments].concat())
}

#[test]
fn a_satellite_is_looked_at_in_steps() {
    let from = ["--catalog-number", "5", "--from", "2026-08-12T06:00:00Z"];
    let run = |arguments: &[&str]| look(&[&from[..], arguments].concat());
    let table = run(&[]);
    assert_eq!(table.status.code(), Some(0), "{}", text(&table.stderr));
    assert_eq!(text(&table.stdout).lines().count(), 1 + 91 + 1);
    let json = run(&["--minutes", "1", "--step", "0.5", "--doppler", "437", "--format", "json"]);
    let list = rows(&json);
    assert_eq!(list.len(), 121);
    for two in list.windows(2) {
        let number = |row: usize, key: &str| two[row][key].as_f64().unwrap();
        let change = (number(1, "range_km") - number(0, "range_km")) / 0.5;
        let rate = 0.5 * (number(0, "range_rate_km_s") + number(1, "range_rate_km_s"));
        assert!((change - rate).abs() < 5e-3, "{two:?}");
        let shift_hz = -number(0, "range_rate_km_s") / 299_792.458 * 437e6;
        assert!((number(0, "doppler_hz") - shift_hz).abs() < 2.0, "{two:?}");
    }
    assert_eq!(list[120]["time"], "2026-08-12T06:01:00.000Z");
    let csv = text(&run(&["--minutes", "1", "--format", "csv"]).stdout);
    assert_eq!(csv.lines().count(), 8);
    // These arguments do not choose one of the two satellites.
    let both = look(&["--from", "2026-08-12"]);
    assert_eq!(both.status.code(), Some(1));
    let said = text(&both.stderr);
    assert!(said.starts_with("2 satellites are meant") && said.contains("6 SMALLSAT"), "{said}");
    assert_eq!(run(&["--step", "0"]).status.code(), Some(2));
}

#[test]
fn a_look_agrees_with_the_maximum_of_a_pass() {
    let elements = Value::from(vec![object(&[])]).to_string();
    let pass = rows(&passes(&elements, &["--format", "json"])).swap_remove(0);
    let at = pass["tca_time"].as_str().unwrap();
    let arguments = ["--catalog-number", "5", "--from", at, "--minutes", "0.01"];
    let geometric = ["--elevations", "geometric", "--format", "json"];
    let rows = rows(&look(&[&arguments[..], &geometric].concat()));
    let off = |key: &str, of_pass: &str| {
        (rows[0][key].as_f64().unwrap() - pass[of_pass].as_f64().unwrap()).abs()
    };
    assert!(off("azimuth_deg", "tca_azimuth_deg") < 0.02, "{rows:?} {pass}");
    assert!(off("elevation_deg", "tca_elevation_deg") < 1e-4, "{rows:?} {pass}");
    assert!(off("range_km", "range_km") < 0.01, "{rows:?} {pass}");
    assert!(off("range_rate_km_s", "tca_range_rate_km_s") < 1e-3, "{rows:?} {pass}");
}

#[test]
fn a_look_is_lifted_by_refraction_and_an_apparent_pass_is_longer() {
    let elements = Value::from(vec![object(&[])]).to_string();
    let listed = |kind: &[&str]| rows(&passes(&elements, &[&["--format", "json"], kind].concat()));
    let (plain, lifted) = (listed(&[]), listed(&["--elevations", "apparent"]));
    assert_eq!(plain, listed(&["--elevations", "geometric"]));
    assert_eq!(plain.len(), lifted.len());
    for (plain, lifted) in plain.iter().zip(&lifted) {
        let number = |row: &Value, key: &str| row[key].as_f64().unwrap();
        assert!(number(lifted, "duration_s") > number(plain, "duration_s") + 5.0, "{lifted}");
        assert!(number(lifted, "max_elevation_deg") > number(plain, "max_elevation_deg"));
        let elevation = |row: &Value| row["aos_elevation_deg"].as_f64().unwrap();
        assert!((elevation(plain) - elevation(lifted)).abs() < 1e-3, "{plain} {lifted}");
    }
    // At geometric AOS, refraction makes the antenna point above the horizon.
    let at = plain[0]["aos_time"].as_str().unwrap();
    let arguments = ["--catalog-number", "5", "--from", at, "--minutes", "0.01"];
    let elevation = |kind: &[&str]| {
        let rows = rows(&look(&[&arguments[..], &["--format", "json"], kind].concat()));
        rows[0]["elevation_deg"].as_f64().unwrap()
    };
    let lifted_deg = elevation(&[]) - elevation(&["--elevations", "geometric"]);
    assert!((0.4..0.7).contains(&lifted_deg), "{lifted_deg}");
    let table = text(&look(&arguments).stdout);
    assert!(table.ends_with("Elevations are apparent, with the refraction of radio waves.\n"));
    let table = text(&passes(&elements, &[]).stdout);
    assert!(table.ends_with("Elevations are geometric, without refraction.\n"), "{table}");
}
