//! Locks of units and stations, and the ways of STOP to the process that holds a lock.

use std::{
    os::unix::fs::{MetadataExt as _, PermissionsExt as _, symlink},
    path::{Path, PathBuf},
    process::{Command as Process, Output},
    thread,
    time::{Duration, Instant},
};

use azel::{
    controller::SPECS,
    engine::{
        reach::{self, Outcome, Reached},
        socket::Ask,
        status::LinkStatus,
    },
    station,
};
use serde_json::Value;

use super::{
    Served, Units, id, is_measured, lead_to_the_sun, named, program, says, status, wait_for,
};

fn runtime(units: &Units) -> PathBuf {
    units.folder.path().join("runtime")
}

fn run(mut program: Process, arguments: &[&str]) -> Output {
    program.args(arguments).output().expect("it runs")
}

/// Returns the program in an environment without a runtime folder, as cron and su leave it.
fn without_runtime(units: &Units) -> Process {
    let mut program = program(units);
    program.env_remove("XDG_RUNTIME_DIR");
    program
}

fn is_up(line: &Value) -> bool {
    line["antenna"] == "Dish" && line["about"] == "motion"
}

fn is_elsewhere(line: &Value) -> bool {
    line["antenna"] == "Dish" && line["text"] == "Driven by another Azel of this machine."
}

/// Checks that the second process leaves the unit alone and says so before it could ask the unit
/// anything.
fn leaves_the_unit_alone(served: &Served) {
    served.until(|line| {
        assert!(!is_up(line), "it drives the unit as well");
        is_elsewhere(line)
    });
}

/// Returns both outputs, for messages.
fn words(output: &Output) -> String {
    format!("{}{}", says(output), String::from_utf8_lossy(&output.stderr))
}

fn socket(folder: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    paths.into_iter().find(|path| path.extension().is_some_and(|end| end == "sock"))
}

#[test]
fn two_spellings_of_one_address_are_one_unit() {
    let units = Units::start(|_| {});
    let other = units.folder.path().join("other.toml");
    let mut station = station::load(&units.path(), SPECS).unwrap().station;
    station.antennas.retain(|antenna| antenna.name == "Mast");
    station.antennas[0].name = "Tower".to_owned();
    let address = &mut station.antennas[0].connection.address;
    *address = address.replace("127.0.0.1", "localhost");
    station::save(&station, &other, SPECS).unwrap();
    let (first, _end, _woken) = units.open();
    lead_to_the_sun(first.client());
    let (second, _end, _woken) = units.open_file(other);
    let client = second.client();
    let tower = wait_for("the second", || {
        assert_eq!(is_measured(client, "Tower"), None, "it drives the unit as well");
        let is_elsewhere = named(&client.snapshot(), "Tower").held_by.is_some();
        is_elsewhere.then(|| id(client, "Tower"))
    });
    assert!(status(first.client(), "Mast").intent != "standby");
    assert_eq!(client.stop(tower).elsewhere, [tower]);
    wait_for("STOP", || {
        let is_over = status(first.client(), "Mast").intent == "standby";
        (is_over && units.all_stand()).then_some(())
    });
    drop(first);
    wait_for("it takes over", || is_measured(client, "Tower"));
}

#[test]
fn two_links_to_one_serial_port_are_one_unit() {
    let pty = nix::pty::openpty(None, None).unwrap();
    let device = nix::unistd::ttyname(&pty.slave).unwrap();
    let units = Units::start(|_| {});
    let mut station = station::load(&units.path(), SPECS).unwrap().station;
    station.antennas.retain(|antenna| antenna.name == "Horn");
    let files = ["one", "two"].map(|name| {
        let link = units.folder.path().join(name);
        symlink(&device, &link).unwrap();
        station.antennas[0].connection.address = link.to_str().unwrap().to_owned();
        let file = link.with_extension("toml");
        station::save(&station, &file, SPECS).unwrap();
        file
    });
    let [one, two] = files;
    let (first, _end, _woken) = units.open_file(one);
    wait_for("the first", || named_or_not(&first, "Horn"));
    assert_eq!(named(&first.client().snapshot(), "Horn").held_by, None);
    let (second, _end, _woken) = units.open_file(two);
    wait_for("the second", || named_or_not(&second, "Horn"));
    assert!(named(&second.client().snapshot(), "Horn").held_by.is_some());
}

fn named_or_not(station: &azel::engine::Handle, name: &str) -> Option<()> {
    let snapshot = station.client().snapshot();
    snapshot.antennas.iter().any(|antenna| antenna.config.name == name).then_some(())
}

#[test]
fn environments_with_and_without_a_runtime_folder_are_one_user() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let first = Served::start(&units);
    first.until(is_up);
    let second = Served::started(without_runtime(&units));
    leaves_the_unit_alone(&second);
    for asked in [program(&units), without_runtime(&units)] {
        let stop = run(asked, &["stop"]);
        assert!(says(&stop).contains("Mast: stands"), "{}", words(&stop));
        assert_eq!(stop.status.code(), Some(0));
    }
    drop(first);
    second.until(is_up);
    let third = Served::start(&units);
    leaves_the_unit_alone(&third);
    for asked in [program(&units), without_runtime(&units)] {
        let stop = run(asked, &["stop"]);
        assert!(says(&stop).contains("Mast: stands"), "{}", words(&stop));
        assert_eq!(stop.status.code(), Some(0));
    }
}

#[test]
fn a_removed_runtime_folder_frees_no_unit_and_hinders_no_stop() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let first = Served::start(&units);
    first.until(is_up);
    std::fs::remove_dir_all(runtime(&units)).unwrap();
    let stop = run(program(&units), &["stop"]);
    assert!(matches!(stop.status.code(), Some(0 | 4)), "{}", words(&stop));
    let second = Served::start(&units);
    leaves_the_unit_alone(&second);
    wait_for("the socket", || socket(&runtime(&units).join("azel")));
    let stop = run(program(&units), &["stop"]);
    assert!(says(&stop).contains("Mast: stands"), "{}", words(&stop));
    assert_eq!(stop.status.code(), Some(0));
}

#[test]
fn without_any_socket_stop_goes_by_signal_to_the_process_that_holds_the_station() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let first = Served::start(&units);
    first.until(is_up);
    // Azel cannot make a folder where a file stands.
    std::fs::remove_dir_all(runtime(&units)).unwrap();
    std::fs::write(runtime(&units), "").unwrap();
    let stop = run(program(&units), &["stop"]);
    assert_eq!(stop.status.code(), Some(4), "{}", words(&stop));
    let process = format!("process {}", first.process.id());
    assert!(says(&stop).contains(&process), "{}", words(&stop));
    first.until(|line| line["antenna"] == "Mast" && line["text"] == "STOP is confirmed.");
}

#[test]
fn a_unit_whose_lock_file_another_process_has_taken_is_left_to_it() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let (station, _end, _woken) = units.open();
    let client = station.client();
    wait_for("the dish", || is_measured(client, "Dish"));
    let entries = std::fs::read_dir(units.folder.path().join("run")).unwrap().flatten();
    let is_of_dish = |path: &PathBuf| {
        std::fs::read_to_string(path).is_ok_and(|text| text.contains(r#""antenna":"Dish""#))
    };
    let path = entries.map(|entry| entry.path()).find(is_of_dish).unwrap();
    std::fs::remove_file(&path).unwrap();
    let file = std::fs::File::create(&path).unwrap();
    file.try_lock().unwrap();
    wait_for("it is left", || (status(client, "Dish").link == LinkStatus::Elsewhere).then_some(()));
    assert_eq!(is_measured(client, "Mast"), Some(()));
    drop(file);
    wait_for("it is taken again", || is_measured(client, "Dish"));
}

/// Creates a lock file that names `process` as the holder of the station, in the form of versions
/// before machine-wide locks. This process locks the file.
fn older_lock(units: &Units, process: u32) -> std::fs::File {
    drop(units.open());
    let run = units.folder.path().join("run");
    let path = socket(&run).unwrap().with_extension("lock");
    let file = std::fs::File::create(path).unwrap();
    file.try_lock().unwrap();
    let text = format!(
        r#"{{"kind":"serve","process":{process},"since":"2026-08-12T11:15:30Z","socket":null,"antenna":null}}"#
    );
    std::io::Write::write_all(&mut &file, text.as_bytes()).unwrap();
    file
}

#[test]
fn a_process_that_has_not_locked_the_file_gets_no_signal() {
    let units = Units::start(|_| {});
    let mut stranger = Process::new("sleep").arg("60").spawn().unwrap();
    let lock = older_lock(&units, stranger.id());
    let folders = units.folder.path().join("run").into();
    let stop = Ask::Stop { antenna: None };
    let ask = || reach::ask_station(&folders, &units.path(), &stop).unwrap();
    let reached = ask();
    let [Reached { outcome: Outcome::NotReached(_), .. }] = reached.as_slice() else {
        panic!("{reached:?}")
    };
    assert!(stranger.try_wait().unwrap().is_none(), "the signal ended it");
    stranger.kill().unwrap();
    stranger.wait().unwrap();
    drop(lock);
    wait_for("nobody holds it", || ask().is_empty().then_some(()));
}

#[test]
fn the_socket_of_an_ended_station_is_closed() {
    let units = Units::start(|station| station.antennas.truncate(1));
    for _ in 0..10 {
        drop(units.open());
        let path = socket(&units.folder.path().join("run")).unwrap();
        let connected = std::os::unix::net::UnixStream::connect(path);
        let refused = connected.map_err(|error| error.kind());
        assert_eq!(refused.err(), Some(std::io::ErrorKind::ConnectionRefused));
    }
}

#[test]
fn a_process_that_does_not_answer_is_named() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let first = Served::start(&units);
    first.until(is_up);
    // The lock files are gone with the folder, and a stopped process renews none.
    first.signal("STOP");
    std::fs::remove_dir_all(runtime(&units)).unwrap();
    let status = run(program(&units), &["status"]);
    first.signal("CONT");
    assert_eq!(status.status.code(), Some(1));
    let process = format!("process {}", first.process.id());
    assert!(words(&status).contains(&process), "{}", words(&status));
}

#[test]
fn a_removed_or_replaced_socket_comes_back() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let first = Served::start(&units);
    first.until(is_up);
    let folder = runtime(&units).join("azel");
    let path = socket(&folder).unwrap();
    let stops = || {
        let stop = run(program(&units), &["stop"]);
        assert!(matches!(stop.status.code(), Some(0 | 4)), "{}", words(&stop));
        (stop.status.code() == Some(0) && says(&stop).contains("Mast: stands")).then_some(())
    };
    std::fs::remove_file(&path).unwrap();
    wait_for("a new socket", stops);
    std::fs::remove_file(&path).unwrap();
    std::fs::create_dir(&path).unwrap();
    wait_for("a socket in place of the folder", stops);
    let mode = std::fs::metadata(&path).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}

#[test]
fn a_stop_reaches_a_unit_that_another_station_file_has() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let other = units.folder.path().join("other.toml");
    std::fs::copy(units.path(), &other).unwrap();
    let first = Served::start(&units);
    first.until(is_up);
    let mut asked = Process::new(env!("CARGO_BIN_EXE_azel"));
    asked
        .env("XDG_RUNTIME_DIR", runtime(&units))
        .env("XDG_DATA_HOME", units.folder.path().join("data"))
        .args([Path::new("--station"), &other]);
    let stop = run(asked, &["stop"]);
    assert!(says(&stop).contains("Mast: stands"), "{}", words(&stop));
    assert_eq!(stop.status.code(), Some(0));
}

#[test]
fn a_held_stop_key_starts_no_thread_for_each_press() {
    let units = Units::start(|_| {});
    let (first, _end, _woken) = units.open();
    lead_to_the_sun(first.client());
    let (second, _end, _woken) = units.open();
    let client = second.client();
    wait_for("the second", || {
        named_or_not(&second, "Mast")?;
        named(&client.snapshot(), "Mast").held_by.is_some().then_some(())
    });
    let threads = || {
        let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
        let names = tasks.map(|task| std::fs::read_to_string(task.path().join("comm")));
        names
            .filter(|name| name.as_ref().is_ok_and(|name| name.starts_with("azel-stop-elsew")))
            .count()
    };
    let (mut most, begun) = (0, Instant::now());
    while begun.elapsed() < Duration::from_secs(2) {
        client.stop_all();
        most = most.max(threads());
        thread::sleep(Duration::from_millis(33));
    }
    // Other tests run beside this one, each with its own threads.
    assert!(most <= 8, "{most} threads");
    wait_for("STOP", || {
        let is_over = status(first.client(), "Mast").intent == "standby";
        (is_over && units.all_stand()).then_some(())
    });
    // Azel does not lose a press that comes while it awaits the answer to an earlier one.
    lead_to_the_sun(first.client());
    client.stop_all();
    wait_for("STOP again", || {
        let is_over = status(first.client(), "Mast").intent == "standby";
        (is_over && units.all_stand()).then_some(())
    });
}

#[test]
fn the_socket_is_open_to_a_group_only_if_the_service_is_told_so() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let system = units.folder.path().join("system");
    std::fs::create_dir(&system).unwrap();
    let first = Served::start(&units);
    first.until(is_up);
    let own = socket(&runtime(&units).join("azel")).unwrap();
    assert_eq!(std::fs::metadata(&own).unwrap().permissions().mode() & 0o777, 0o600);
    drop(first);
    let group = Process::new("id").arg("-gn").output().expect("it runs");
    let group = says(&group).trim().to_owned();
    let mut open = program(&units);
    open.env("RUNTIME_DIRECTORY", &system);
    open.args(["serve", "--format", "json", "--group", &group]);
    let second = Served::spawned(open);
    second.until(is_up);
    let shared = socket(&system).expect("a socket in the folder of the service");
    let metadata = std::fs::metadata(&shared).unwrap();
    assert_eq!(metadata.permissions().mode() & 0o777, 0o660);
    assert_eq!(metadata.gid(), std::fs::metadata(units.folder.path()).unwrap().gid());
    let folder = std::fs::metadata(&system).unwrap();
    assert_eq!(folder.permissions().mode() & 0o777, 0o710);
    let mut asked = program(&units);
    asked.env("RUNTIME_DIRECTORY", &system);
    let stop = run(asked, &["stop"]);
    assert_eq!(stop.status.code(), Some(0), "{}", words(&stop));
    drop(second);

    let mut nobody = program(&units);
    nobody.args(["serve", "--group", "no-such-group-as-this"]);
    let refused = nobody.output().expect("it runs");
    assert_eq!(refused.status.code(), Some(1));
    assert!(words(&refused).contains("no-such-group-as-this"));
}
