//! Selection of elements and site, with its exit codes.

use super::*;

#[test]
fn only_what_concerns_the_objects_that_are_asked_for_counts() {
    let list = |objects: &[Value]| Value::from(objects.to_vec()).to_string();
    let good = object(&[]);
    let bad = object(&[
        ("OBJECT_NAME", "DAMAGED".into()),
        ("NORAD_CAT_ID", 7.into()),
        ("MEAN_MOTION", (-1).into()),
    ]);
    let nameless = object(&[
        ("OBJECT_NAME", "".into()),
        ("NORAD_CAT_ID", 8.into()),
        ("MEAN_MOTION", (-1).into()),
    ]);
    let newer_bad = object(&[("EPOCH", "2026-08-13T00:00:00".into()), ("INCLINATION", 400.into())]);
    let files = Files::new(&[
        ("mixed.json", list(&[good.clone(), bad, nameless])),
        ("good.json", list(&[good])),
        ("newer.json", list(&[newer_bad])),
        ("page.html", "<!DOCTYPE html><html>503</html>".to_owned()),
    ]);
    for (names, arguments, code, told) in [
        (&["mixed.json"][..], &[][..], 3, &["DAMAGED", "json:1: 8: "][..]),
        (&["mixed.json"], &["--catalog-number", "5"], 0, &[]),
        (&["mixed.json"], &["--name", "smalls"], 0, &[]),
        (&["mixed.json"], &["--catalog-number", "8,5"], 3, &["8: no elements of this", ": 8: "]),
        (&["mixed.json"], &["--name", "damag", "--name", "LLSA"], 3, &["damag: no", "DAMAGED: "]),
        (&["mixed.json"], &["--name", "absent"], 1, &["absent: no elements", "There are no"]),
        // The newest set of the object is unusable.
        (&["good.json", "newer.json"], &["--catalog-number", "5"], 3, &["SMALLSAT: inclination"]),
        (&["good.json", "page.html"], &[], 3, &["page.html: no elements, it is a web page"]),
        (&["good.json", "page.html"], &["--catalog-number", "5"], 3, &["page.html: no elements"]),
        (&["good.json", "absent.json"], &[], 3, &["absent.json cannot be read"]),
        (&["absent.json"], &[], 1, &["absent.json cannot be read", "There are no elements"]),
        (&["page.html"], &[], 1, &["it is a web page", "There are no elements"]),
    ] {
        let output = files.passes(names, arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{names:?} {arguments:?}: {said}");
        for told in told {
            assert!(said.contains(told), "{names:?} {arguments:?}: {said}");
        }
        if code == 0 {
            assert_eq!(said, "", "{names:?} {arguments:?}");
        }
    }
}

#[test]
fn the_order_of_files_changes_nothing() {
    let at = |epoch: &str, anomaly: f64| {
        let object = object(&[("EPOCH", epoch.into()), ("MEAN_ANOMALY", anomaly.into())]);
        Value::from(vec![object]).to_string()
    };
    let files = Files::new(&[
        ("a.json", at("2026-08-11T00:00:00", 10.0)),
        ("b.json", at("2026-08-12T00:00:00", 20.0)),
        ("c.json", at("2026-08-12T00:00:00", 30.0)),
        ("d.json", "No GP data found".to_owned()),
    ]);
    let all = ["a.json", "b.json", "c.json", "d.json"];
    let first = files.passes(&all, &[]);
    assert_eq!(first.status.code(), Some(3));
    for turn in 1..4 {
        let mut names = all;
        names.rotate_left(turn);
        assert_eq!(files.passes(&names, &[]), first);
    }
    assert_eq!(files.passes(&["a.json", "b.json"], &[]).status.code(), Some(0));
    assert_eq!(files.passes(&["b.json", "a.json"], &[]).status.code(), Some(0));
}

#[test]
fn a_folder_stands_for_the_element_files_in_it() {
    let list = Value::from(vec![object(&[])]).to_string();
    let files = Files::new(&[("a.json", list), ("notes.md", "no elements".to_owned())]);
    std::fs::create_dir(files.path("empty")).unwrap();
    let output = files.passes(&["."], &[]);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
    assert_eq!(output.stdout, files.passes(&["a.json"], &[]).stdout);
    let empty = files.passes(&["empty"], &[]);
    assert_eq!(empty.status.code(), Some(1));
    assert!(text(&empty.stderr).contains("no element files in it"), "{}", text(&empty.stderr));
}

#[test]
fn site_and_elevations_come_from_the_station_file() {
    let list = Value::from(vec![object(&[])]).to_string();
    let station = |site: &str| {
        format!(
            "name = 'Hill'\nelevation_floor_deg = 20.0\n{site}\n[[antenna]]\n\
             connection = {{ controller = 'satrak', address = 'localhost:1' }}\n\
             limits = {{ minimum_elevation_deg = 5.0 }}\n"
        )
    };
    let site = "[site]\nlatitude_deg = 41.02\nlongitude_deg = 29.17\naltitude_m = 100.0";
    let files = Files::new(&[
        ("a.json", list),
        ("station.toml", station(site)),
        ("no_site.toml", station("")),
        ("bad_site.toml", station(&site.replace("41.02", "141.02"))),
        ("bad_antenna.toml", station(site).replace("5.0", "500.0")),
    ]);
    let (a, path) = (files.path("a.json"), files.path("station.toml"));
    let of_station = |arguments: &[&str]| {
        let command = ["passes", "--elements", &a, "--station", &path];
        azel(&[&command[..], &WINDOW, arguments].concat())
    };
    let output = of_station(&["--format", "csv"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let spelled_out = files.passes(&["a.json"], &["--aos", "5", "--floor", "20"]);
    assert!(text(&output.stdout).lines().count() > 2);
    assert_eq!(text(&output.stdout), text(&spelled_out.stdout));
    // The command line takes precedence over the file.
    let own = of_station(&["--format", "csv", "--aos", "0", "--floor", "0", "--lat", "41.02"]);
    assert_eq!(text(&own.stdout), text(&files.passes(&["a.json"], &[]).stdout));
    // The option may also precede the command.
    let before = azel(&["--station", &path, "passes", "--elements", &a, "--format", "csv"]);
    assert_eq!(before.status.code(), Some(0), "{}", text(&before.stderr));
    let ics = text(&of_station(&["--format", "ics"]).stdout);
    assert!(ics.contains("LOCATION:Hill\r\n"), "{ics}");
    for (name, why) in [
        ("no_site.toml", "has no site"),
        ("bad_site.toml", "latitude 141.02"),
        ("bad_antenna.toml", "antenna[0].limits.minimum_elevation_deg"),
        ("x.toml", "no settings yet"),
    ] {
        let path = files.path(name);
        let output = azel(&["passes", "--station", &path, "--elements", &a]);
        assert_eq!(output.status.code(), Some(1), "{name}");
        let said = text(&output.stderr);
        assert!(said.contains(why) && said.contains(name), "{said}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn the_sources_of_the_station_are_groups() {
    let of =
        |number: u32| Value::from(vec![object(&[("NORAD_CAT_ID", number.into())])]).to_string();
    let files = Files::new(&[
        ("a.json", of(5)),
        ("b.json", of(6)),
        (
            "station.toml",
            "[site]\nlatitude_deg = 41.02\nlongitude_deg = 29.17\naltitude_m = 100.0\n".to_owned(),
        ),
    ]);
    let sources = format!(
        "[[source]]\nname = \"own\"\nfile = \"{}\"\n[[source]]\nname = \"other\"\nfile = \"{}\"\n\
         [[source]]\nname = \"web\"\nweb = \"https://example.org/x\"\n",
        files.path("a.json"),
        files.path("b.json")
    );
    std::fs::write(files.path("sources.toml"), sources).unwrap();
    let path = files.path("station.toml");
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_azel"))
            .args(["passes", "--station", &path, "--format", "json"])
            .args(WINDOW)
            .args(arguments)
            .env("XDG_DATA_HOME", files.path("data"))
            .output()
            .unwrap();
        let whole: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
        let rows = whole["passes"].as_array().into_iter().flatten();
        let numbers: std::collections::BTreeSet<u64> =
            rows.filter_map(|row| row["catalog_number"].as_u64()).collect();
        (output.status.code().unwrap(), Vec::from_iter(numbers), text(&output.stderr))
    };
    let (code, numbers, said) = run(&[]);
    assert_eq!((code, numbers), (3, vec![5, 6]), "{said}");
    assert!(said.contains("web: nothing of this source is held"), "{said}");
    assert_eq!(run(&["--group", "other"]), (0, vec![6], String::new()));
    let a = files.path("a.json");
    assert_eq!(run(&["--group", "other", "--elements", &a]), (0, vec![5, 6], String::new()));
    assert_eq!(run(&["--elements", &a]), (0, vec![5], String::new()));
    let (code, _, said) = run(&["--group", "weather"]);
    assert_eq!(code, 1);
    assert!(said.contains("no source weather; it has: own, other, web."), "{said}");
}

#[test]
fn old_elements_are_told_on_standard_error() {
    let list = Value::from(vec![object(&[])]).to_string();
    let files = Files::new(&[("a.json", list)]);
    let run = |from: &str| {
        let a = files.path("a.json");
        let arguments = ["passes", "--elements", &a, "--from", from, "--hours", "24"];
        azel(&[&arguments[..], &SITE].concat())
    };
    assert_eq!(text(&run("2026-08-20").stderr), "");
    for from in ["2026-08-26", "2026-07-20T03:00:00+03:00"] {
        let output = run(from);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(said.starts_with("Caution: 1 of 1 satellites"), "{said}");
        assert!(said.contains("SMALLSAT") && said.lines().count() == 1, "{said}");
    }
}

#[test]
#[cfg(unix)]
fn a_file_without_an_end_is_refused() {
    let output = azel(&[&["passes", "--elements", "/dev/zero"][..], &SITE].concat());
    assert_eq!(output.status.code(), Some(1));
    let told = "/dev/zero cannot be read: more than 268435456 bytes\n";
    assert!(text(&output.stderr).starts_with(told), "{}", text(&output.stderr));
}
