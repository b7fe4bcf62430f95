//! Tests of the program as a user calls it from a shell.

use std::process::{Command, Output};

fn azel(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_azel"))
        .args(arguments)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .output()
        .expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_there_is_one_sentence_and_exit_code_1() {
    let output = azel(&[]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(text(&output.stdout), "");
    let said = text(&output.stderr);
    assert!(said.starts_with("Azel needs a display"), "{said}");
    assert_eq!(said.trim_end().lines().count(), 1, "{said}");
}

#[test]
fn help_and_version_are_answered() {
    let version = azel(&["--version"]);
    assert!(version.status.success());
    assert_eq!(text(&version.stdout), format!("azel {}\n", env!("CARGO_PKG_VERSION")));
    let help = azel(&["--help"]);
    assert!(help.status.success());
    for word in ["simulate", "--station", "--demo"] {
        assert!(text(&help.stdout).contains(word), "{word}");
    }
}

#[test]
fn the_demo_is_no_station_and_no_command() {
    for (arguments, why) in [
        (&["--demo", "--station", "x.toml"][..], "'--demo' cannot be used with '--station"),
        (&["--demo", "serve"], "cannot be used with a command"),
    ] {
        let output = azel(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(why), "{}", text(&output.stderr));
    }
}

#[test]
fn a_wrong_quirk_names_the_right_ones() {
    let output = azel(&["simulate", "satrak", "--quirk", "no_coma"]);
    assert!(!output.status.success());
    assert!(text(&output.stderr).contains("no_comma"), "{}", text(&output.stderr));
}

#[test]
fn an_address_that_is_taken_is_said() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let output = azel(&["simulate", "satrak", "--listen", &address]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains(&address), "{}", text(&output.stderr));
}

#[test]
fn every_simulator_names_its_faults() {
    let output = azel(&["simulate", "genius", "--fault", "stuck"]);
    assert!(!output.status.success());
    assert!(text(&output.stderr).contains("stuck_1"), "{}", text(&output.stderr));
}

#[test]
fn a_wrong_fault_of_an_rc2000c_names_the_right_ones() {
    let output = azel(&["simulate", "rc2000", "--fault", "az_jm"]);
    assert!(!output.status.success());
    assert!(text(&output.stderr).contains("az_jam"), "{}", text(&output.stderr));
}

#[test]
fn completions_and_man_pages_tell_the_commands_but_not_those_of_the_program_itself() {
    let output = azel(&["completions", "bash"]);
    assert!(output.status.success());
    assert!(text(&output.stdout).contains("--station"), "{}", text(&output.stdout));
    let folder = tempfile::tempdir().unwrap();
    assert!(azel(&["man", &folder.path().display().to_string()]).status.success());
    let mut pages: Vec<String> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|page| page.unwrap().file_name().into_string().unwrap())
        .collect();
    pages.sort_unstable();
    assert!(pages.contains(&"azel.1".to_owned()), "{pages:?}");
    assert!(pages.contains(&"azel-simulate-satrak.1".to_owned()), "{pages:?}");
    assert!(pages.iter().all(|page| !page.contains("dead")), "{pages:?}");
    let nowhere = azel(&["man", "/nowhere/at/all"]);
    assert_eq!(nowhere.status.code(), Some(1));
    assert!(text(&nowhere.stderr).contains("/nowhere/at/all"), "{}", text(&nowhere.stderr));
}

#[test]
fn a_check_names_what_cannot_be_used_in_a_station_file_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let antenna = "[[antenna]]\nname = 'Dish'\n[antenna.connection]\ncontroller = 'satrak'\n\
                   address = 'h:4001'\n";
    let check = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let output = azel(&["check", path.to_str().unwrap()]);
        (output.status.code(), text_of(&output))
    };
    let (code, said) = check(antenna);
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = check(&format!("[[keep_out]]\nname = 'mast'\ncorner = []\n{antenna}"));
    assert_eq!(code, Some(3), "{said}");
    for words in ["keep_out[0].corner (line 3)", "mast does not apply", "Dish will not move"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let (code, _) = check("[[keep_out]");
    assert_eq!(code, Some(1));
    let missing = azel(&["check", folder.path().join("none.toml").to_str().unwrap()]);
    assert_eq!(missing.status.code(), Some(1));
}

fn text_of(output: &Output) -> String {
    text(&output.stdout)
}
