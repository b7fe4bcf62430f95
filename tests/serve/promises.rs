//! State that the next start must find, tested with killed processes and with disks that take
//! nothing.

use std::path::Path;

use azel::{controller::SPECS, sim::satrak, station};

use super::{Served, Units, program, says, wait_for};

/// Returns `true` if a finished file below `folder` has a name that starts with `name`.
fn find(folder: &Path, name: &str) -> bool {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.into_iter().any(|entry| {
        let file_name = entry.file_name().to_string_lossy().into_owned();
        let ends_so = entry.path().extension().is_some_and(|extension| extension == "toml");
        let is_it = file_name.starts_with(name) && ends_so;
        is_it || (entry.path().is_dir() && find(&entry.path(), name))
    })
}

/// Presses STOP while the dish does not answer, and kills the program once the STOP is on disk.
fn killed_while_a_stop_is_owed(units: &Units) {
    let mut served = Served::start(units);
    wait_for("it is read", || {
        let status = program(units).arg("status").output().expect("it runs");
        says(&status).contains("azimuth").then_some(())
    });
    units.dish.set_fault(satrak::Fault::Silence, true);
    served.signal("USR1");
    served.until(|told| told["antenna"] == "Dish" && told["text"] != "STOP is confirmed.");
    wait_for("STOP is not proved", || {
        let status = program(units).arg("status").output().expect("it runs");
        says(&status).contains("STOP IS NOT PROVED").then_some(())
    });
    wait_for("its record on disk", || find(units.folder.path(), "satrak-").then_some(()));
    served.signal("KILL");
    served.process.wait().expect("it ends");
    units.dish.set_fault(satrak::Fault::Silence, false);
}

/// Starts the program again and returns it with its first payload to the dish.
fn first_word(units: &Units) -> (Served, String) {
    let before = units.dish.received().len();
    let served = Served::start(units);
    let first = wait_for("its first word", || {
        units.dish.received().get(before).map(|(_, payload)| payload.clone())
    });
    (served, first)
}

#[test]
fn a_stop_that_is_owed_outlives_a_program_that_is_killed() {
    let units = Units::start(|station| station.antennas.truncate(1));
    killed_while_a_stop_is_owed(&units);
    let (_served, first) = first_word(&units);
    assert_eq!(first, "STOP=");
}

#[test]
fn a_stop_that_is_owed_to_a_unit_of_no_antenna_outlives_a_kill() {
    let units = Units::start(|station| station.antennas.truncate(2));
    killed_while_a_stop_is_owed(&units);
    let mut station = station::load(&units.path(), SPECS).unwrap().station;
    station.antennas.retain(|antenna| antenna.name == "Mast");
    std::fs::remove_file(units.path()).unwrap();
    station::save(&station, &units.path(), SPECS).unwrap();
    let (_served, first) = first_word(&units);
    assert_eq!(first, "STOP=");
    wait_for("standstill", || (!find(units.folder.path(), "satrak-")).then_some(()));
}

#[test]
fn a_stop_that_the_disk_does_not_take_is_acknowledged_as_such() {
    let units = Units::start(|station| station.antennas.truncate(1));
    // A file stands where Azel would make the folder of marks.
    let data = units.folder.path().join("data/azel");
    std::fs::create_dir_all(&data).unwrap();
    std::fs::write(data.join("marks"), "").unwrap();
    let mut served = Served::start(&units);
    wait_for("it is read", || {
        let status = program(&units).arg("status").output().expect("it runs");
        says(&status).contains("azimuth").then_some(())
    });
    units.dish.set_fault(satrak::Fault::Silence, true);
    let stop = program(&units).arg("stop").output().expect("it runs");
    assert!(says(&stop).contains("Dish: NOT known to stand"), "{}", says(&stop));
    assert!(says(&stop).contains("STOP of Dish is sent, NOT on disk"), "{}", says(&stop));
    assert_eq!(stop.status.code(), Some(4));
    served.until(|told| {
        told["about"] == "alarm" && told["text"].as_str().is_some_and(|it| it.contains("on disk"))
    });
    // Later, the disk takes the mark.
    std::fs::remove_file(data.join("marks")).unwrap();
    wait_for("it is on disk", || find(&data, "satrak-").then_some(()));
    let stop = program(&units).arg("stop").output().expect("it runs");
    assert!(!says(&stop).contains("on disk"), "{}", says(&stop));
    served.signal("TERM");
    assert_eq!(served.process.wait().expect("it ends").code(), Some(4), "it is not proved");
}

#[test]
fn lock_outs_that_the_disk_does_not_take_hold_and_are_acknowledged_as_such() {
    let units = Units::start(|station| station.antennas.truncate(2));
    // Azel can read the list but not save it: a folder stands in the place of the old list.
    let list = units.folder.path().join(station::LOCK_OUTS_FILE);
    std::fs::write(&list, "version = 1\n").unwrap();
    std::fs::create_dir(list.with_added_extension("old")).unwrap();
    let served = Served::start(&units);
    served.until(|told| told["antenna"] == "Mast" && told["about"] == "motion");
    let lock = |name: &str| {
        let arguments = ["lock-out", "--antenna", name, "--reason", "belts", "--by", "Ada"];
        program(&units).args(arguments).output().expect("it runs")
    };
    for name in ["Dish", "Mast"] {
        let locked = lock(name);
        assert!(says(&locked).contains("NOT on disk"), "{}", says(&locked));
        assert_eq!(locked.status.code(), Some(4));
    }
    let status = says(&program(&units).arg("status").output().expect("it runs"));
    assert_eq!(status.matches("locked out by Ada").count(), 2, "{status}");
    served.until(|told| {
        let text = told["text"].as_str();
        told["about"] == "alarm"
            && text.is_some_and(|it| it.contains("not kept for the next start"))
    });
}
