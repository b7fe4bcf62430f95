//! Station without a window: real sockets to simulated units, and the program itself as a
//! process beside others.

mod hooks;
mod locks;
mod metrics;
mod ports;
pub(crate) mod promises;
pub(crate) mod record;

use std::{
    collections::BTreeMap,
    io::{BufRead as _, BufReader},
    net::SocketAddr,
    path::{Path, PathBuf},
    process::{Child, Command as Process, Output, Stdio},
    sync::{Arc, mpsc},
    thread,
    time::{Duration, Instant},
};

use azel::{
    astro::time::add_seconds,
    cli::serve::{Ended, Wake, until_the_end},
    clock::Clock,
    contract::{
        Command, Snapshot,
        alarms::{Alarm, AlarmKind, Priority},
        antenna::AntennaModel,
        claim::{HeldBy, HolderKind},
        driver::{self, Event, LinkLoss, Refusal},
        passes::PredictedPass,
    },
    controller::{SPECS, satrak::ELEMENT_FILE},
    engine::{
        Client, Handle, Settings,
        status::{AntennaStatus, LinkStatus},
    },
    orbit::bundled,
    plan::{ProgramTrack, Target},
    sim::{rc2000c, rotator_genius, satrak},
    station::{self, Antenna, AntennaId, OnClose, Station},
    ui::words,
};
use jiff::Timestamp;
use tokio::runtime::Runtime;

/// Time limit of any wait in these tests.
const PATIENCE: Duration = Duration::from_secs(30);
/// Interval at which a window renews a jog.
const RENEW: Duration = Duration::from_millis(60);
const NOAA_20: u32 = 43_013;

/// Returns a time at which NOAA 20 is up for another six minutes.
fn start() -> Timestamp {
    "2026-08-12T11:15:30Z".parse().unwrap()
}

fn clock() -> Clock {
    let begun = Instant::now();
    Clock::new(move || add_seconds(start(), begun.elapsed().as_secs_f64()))
}

/// A simulated unit of each make, and a folder with a station of them.
struct Units {
    dish: satrak::Control,
    mast: rotator_genius::Control,
    horn: rc2000c::Control,
    folder: tempfile::TempDir,
    _runtime: Runtime,
}

const ANY_PORT: ([u8; 4], u16) = ([127, 0, 0, 1], 0);

impl Units {
    fn start(change: impl FnOnce(&mut Station)) -> Self {
        let runtime = Runtime::new().expect("a runtime");
        let elements = bundled().unwrap().iter().cloned().collect();
        let options = satrak::Options {
            elements: BTreeMap::from([(satrak::BUNDLED_FILE.to_owned(), elements)]),
            ..satrak::Options::new(Station::default().site, start())
        };
        let mast_options = rotator_genius::Options {
            rotators: [
                rotator_genius::RotatorOptions::default(),
                rotator_genius::RotatorOptions::elevation(),
            ],
            ..rotator_genius::Options::default()
        };
        let any = SocketAddr::from(ANY_PORT);
        let (dish, mast, horn) = runtime.block_on(async {
            (
                satrak::Simulator::bind(any, options).await.expect("a port"),
                rotator_genius::Simulator::bind(any, mast_options).await.expect("a port"),
                rc2000c::Simulator::bind(any, &rc2000c::Options::default()).await.expect("a port"),
            )
        });
        let address = |at: std::io::Result<SocketAddr>| at.expect("an address").to_string();
        let mut satrak = Antenna::satrak("Dish", &address(dish.local_addr()));
        satrak.connection.put(&ELEMENT_FILE, satrak::BUNDLED_FILE).unwrap();
        let genius = Antenna::genius("Mast", &address(mast.local_addr()));
        let rc2000c = Antenna::rc2000c("Horn", &address(horn.local_addr()));
        let mut station = Station {
            antennas: vec![satrak, genius, rc2000c],
            favourites: [NOAA_20].into(),
            ..Station::default()
        };
        change(&mut station);
        let folder = tempfile::tempdir().expect("a folder");
        station::save(&station, &folder.path().join("station.toml"), SPECS)
            .expect("a station file");
        let controls = (dish.control(), mast.control(), horn.control());
        runtime.spawn(dish.run());
        runtime.spawn(mast.run());
        runtime.spawn(horn.run());
        let (dish, mast, horn) = controls;
        Self { dish, mast, horn, folder, _runtime: runtime }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("station.toml")
    }

    fn open(&self) -> (Handle, mpsc::SyncSender<Wake>, mpsc::Receiver<Wake>) {
        self.open_file(self.path())
    }

    fn open_file(&self, path: PathBuf) -> (Handle, mpsc::SyncSender<Wake>, mpsc::Receiver<Wake>) {
        let settings = Settings {
            path: Some(path),
            library: Some(self.folder.path().join("elements")),
            dead_man: Some(env!("CARGO_BIN_EXE_azel").into()),
            claims: Some((self.folder.path().join("run").into(), HolderKind::Serve)),
            ..Settings::default()
        };
        let (wake, woken) = mpsc::sync_channel(1);
        let by_station = wake.clone();
        let station = Handle::start(
            settings,
            clock(),
            Arc::new(move || {
                let _ = by_station.try_send(Wake::Station);
            }),
        );
        (station.expect("a station"), wake, woken)
    }

    fn all_stand(&self) -> bool {
        let mast = self.mast.state().rotators;
        !self.dish.state().is_moving
            && !mast.iter().any(|rotator| rotator.is_turning)
            && !self.horn.state().is_turning
    }
}

fn wait_for<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let until = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(Instant::now() < until, "waited too long for {what}");
        thread::sleep(RENEW);
    }
}

fn named_thread<T: Send + 'static>(
    name: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> thread::JoinHandle<T> {
    thread::Builder::new().name(name.to_owned()).spawn(work).expect("a thread")
}

fn named<'a>(station: &'a Snapshot, name: &str) -> &'a AntennaModel {
    station.antennas.iter().find(|antenna| antenna.config.name == name).expect("an antenna")
}

fn status(client: &Client, name: &str) -> AntennaStatus {
    AntennaStatus::new(named(&client.snapshot(), name))
}

fn id(client: &Client, name: &str) -> AntennaId {
    named(&client.snapshot(), name).id()
}

fn send(client: &Client, antenna: AntennaId, command: driver::Command) {
    assert!(client.send(Command::Antenna(antenna, command)).is_ok(), "the station is too busy");
}

fn is_measured(client: &Client, name: &str) -> Option<()> {
    status(client, name).moves.map(|_| ())
}

/// Lets the dish track NOAA 20 on board.
fn track_on_board(client: &Client) {
    let dish = id(client, "Dish");
    wait_for("the dish", || is_measured(client, "Dish"));
    let pass = wait_for("the pass", || {
        let station = client.snapshot();
        station.pass_lists.next(start()).map(PredictedPass::key)
    });
    client.send(Command::Track { antenna: dish, pass, is_agreed: true }).unwrap();
    wait_for("tracking on board", || {
        let dish = status(client, "Dish");
        (dish.tracks.is_some() && dish.moves == Some(true)).then_some(())
    });
}

/// Starts a program track of the Sun with the mast.
fn lead_to_the_sun(client: &Client) {
    wait_for("the mast", || is_measured(client, "Mast"));
    let site = client.snapshot().station.site;
    let follow = ProgramTrack::new(Target::Sun, site, Vec::new());
    send(client, id(client, "Mast"), driver::Command::ProgramTrack(Box::new(follow)));
    wait_for("the mast moves", || (status(client, "Mast").moves == Some(true)).then_some(()));
}

/// Holds a jog key of the horn until the horn moves.
fn jog(client: &Client) {
    let horn = id(client, "Horn");
    send(client, horn, driver::Command::Connect);
    wait_for("the horn", || is_measured(client, "Horn"));
    send(client, horn, driver::Command::Manual);
    wait_for("the horn moves", || {
        hold(client);
        (status(client, "Horn").moves == Some(true)).then_some(())
    });
}

fn hold(client: &Client) {
    send(client, id(client, "Horn"), driver::Command::Jog { rates_deg_s: [1.0, 0.0] });
}

/// Runs the station of `units` in the main loop of the program, drives it and ends it. Returns its
/// end and the time that the end took.
fn served(units: &Units, drive: impl FnOnce(&Client) + Send + 'static) -> (Ended, Duration) {
    let (station, end, woken) = units.open();
    let client = station.client().clone();
    let driving = named_thread("drives", move || {
        drive(&client);
        end.send(Wake::End).unwrap();
        Instant::now()
    });
    let mut lines = Vec::new();
    let ended = until_the_end(station, &woken, &mut |told| lines.push(told.clone()));
    let took = driving.join().expect("it is driven").elapsed();
    assert!(!lines.is_empty());
    (ended, took)
}

#[test]
fn ended_while_one_jogs_one_is_led_and_one_tracks_on_board_all_are_proved_to_stand() {
    let units = Units::start(|_| {});
    let (ended, took) = served(&units, |client| {
        track_on_board(client);
        lead_to_the_sun(client);
        jog(client);
        hold(client);
    });
    assert_eq!(ended.not_proved, [""; 0]);
    assert!(units.all_stand());
    assert!(!units.dish.state().is_tracking);
    assert!(took < Duration::from_secs(10), "{took:?}");
}

#[test]
fn what_the_station_leaves_goes_on_and_the_rest_is_stopped() {
    let units = Units::start(|station| station.on_close = Some(OnClose::Leave));
    let (ended, _) = served(&units, |client| {
        track_on_board(client);
        lead_to_the_sun(client);
    });
    assert_eq!(ended.not_proved, [""; 0]);
    assert!(units.dish.state().is_tracking);
    assert!(!units.mast.state().rotators.iter().any(|rotator| rotator.is_turning));
}

#[test]
fn one_that_does_not_answer_any_more_is_named() {
    let units = Units::start(|_| {});
    let dish = units.dish.clone();
    let (ended, took) = served(&units, move |client| {
        track_on_board(client);
        dish.set_fault(satrak::Fault::Silence, true);
    });
    assert_eq!(ended.not_proved, ["Dish"]);
    assert!(took < Duration::from_secs(25), "{took:?}");
}

#[test]
fn the_alarms_of_an_antenna_go_when_it_gets_another_unit() {
    let units = Units::start(|_| {});
    let (running, _end, _woken) = units.open();
    let client = running.client();
    wait_for("the dish", || is_measured(client, "Dish"));
    units.dish.set_fault(satrak::Fault::Silence, true);
    let of_the_old = |told: &Snapshot| {
        let lost = AlarmKind::LinkLost(LinkLoss::Silent);
        told.alarms.list().iter().any(|alarm| alarm.kind == lost)
    };
    wait_for("the alarm", || of_the_old(&client.snapshot()).then_some(()));
    let mut station = Station::clone(&client.snapshot().station);
    for antenna in station.antennas.iter_mut().filter(|antenna| antenna.name == "Dish") {
        // No server listens at this address.
        antenna.connection.address = "127.0.0.1:9".to_owned();
    }
    let wanted = station.clone();
    client.send(Command::SaveStation(Box::new(station))).unwrap();
    wait_for("the other unit", || (*client.snapshot().station == wanted).then_some(()));
    assert!(!of_the_old(&client.snapshot()));
}

#[test]
fn a_second_one_drives_nothing_until_the_first_has_ended() {
    let units = Units::start(|_| {});
    let (first, _end, _woken) = units.open();
    wait_for("the first", || is_measured(first.client(), "Mast"));
    let (second, _end, _woken) = units.open();
    let client = second.client();
    let mast = wait_for("the second", || {
        let mast = status(client, "Mast");
        (mast.link == LinkStatus::Elsewhere).then_some(mast)
    });
    assert_eq!(mast.moves, None);
    let told = client.snapshot();
    let says_so = |alarm: &Alarm| {
        !alarm.is_over()
            && alarm.antenna.is_none()
            && matches!(alarm.kind, AlarmKind::StationElsewhere(_))
    };
    assert!(told.alarms.list().iter().any(says_so));
    // The second station refuses a motion, because the first one drives the unit.
    let follow = ProgramTrack::new(Target::Sun, told.station.site, Vec::new());
    send(client, id(client, "Mast"), driver::Command::ProgramTrack(Box::new(follow)));
    wait_for("the refusal", || {
        let station = client.snapshot();
        let (news, _) = named(&station, "Mast").news.as_ref()?;
        matches!(news, Event::NotSent(Refusal::Elsewhere(_))).then_some(())
    });
    let is_led = |client: &Client| status(client, "Mast").intent != "standby";
    assert!(units.all_stand() && !is_led(first.client()));
    // A STOP at the second station stops the antenna of the first.
    lead_to_the_sun(first.client());
    assert!(is_led(first.client()));
    let stopped = client.stop_all();
    assert_eq!((stopped.antennas.len(), stopped.elsewhere.len()), (0, 3));
    wait_for("STOP", || (!is_led(first.client()) && units.all_stand()).then_some(()));
    drop(first);
    wait_for("it takes over", || is_measured(client, "Mast"));
    let told = client.snapshot();
    let is_over =
        |alarm: &Alarm| alarm.is_over() || !matches!(alarm.kind, AlarmKind::StationElsewhere(_));
    assert!(told.alarms.list().iter().all(is_over));
}

#[test]
fn a_unit_of_two_station_files_is_driven_from_the_first_and_stopped_from_both() {
    let units = Units::start(|_| {});
    let other = units.folder.path().join("other.toml");
    let mut station = station::load(&units.path(), SPECS).unwrap().station;
    station.antennas.retain(|antenna| antenna.name == "Mast");
    station.antennas[0].name = "Tower".to_owned();
    station::save(&station, &other, SPECS).unwrap();
    let (first, _end, _woken) = units.open();
    lead_to_the_sun(first.client());
    let (second, _end, _woken) = units.open_file(other);
    let client = second.client();
    let tower = wait_for("the second", || {
        let tower = status(client, "Tower");
        (tower.link == LinkStatus::Elsewhere).then(|| id(client, "Tower"))
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

/// The program itself as a process, on the station of `units`.
struct Served {
    process: Child,
    lines: mpsc::Receiver<String>,
}

fn program(units: &Units) -> Process {
    let mut process = Process::new(env!("CARGO_BIN_EXE_azel"));
    let folder = units.folder.path();
    process
        .env("XDG_RUNTIME_DIR", folder.join("runtime"))
        .env("XDG_DATA_HOME", folder.join("data"))
        .env("XDG_CONFIG_HOME", folder.join("config"))
        // Keep the alarms of a test from the desktop and the speakers of its user.
        .env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere")
        .env("PATH", "")
        .args([Path::new("--station"), &units.path()]);
    process
}

impl Served {
    fn start(units: &Units) -> Self {
        Self::started(program(units))
    }

    fn started(mut program: Process) -> Self {
        program.args(["serve", "--format", "json"]);
        Self::spawned(program)
    }

    fn spawned(mut program: Process) -> Self {
        let mut process = program.stdout(Stdio::piped()).spawn().expect("the program starts");
        let output = process.stdout.take().expect("its output");
        let (send, lines) = mpsc::sync_channel(1000);
        named_thread("reads", move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                let _ = send.send(line);
            }
        });
        Self { process, lines }
    }

    fn until(&self, wanted: impl Fn(&serde_json::Value) -> bool) {
        let until = Instant::now() + PATIENCE;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let line = self.lines.recv_timeout(left).expect("a line in time");
            let told = serde_json::from_str(&line).expect("JSON");
            if wanted(&told) {
                return;
            }
        }
    }

    fn signal(&self, name: &str) {
        let id = self.process.id().to_string();
        let sent = Process::new("kill").args(["-s", name, &id]).status();
        assert!(sent.is_ok_and(|status| status.success()));
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn says(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn the_program_serves_is_asked_from_a_second_shell_and_ends_by_a_signal() {
    let units = Units::start(|_| {});
    let mut served = Served::start(&units);
    served.until(|told| told["antenna"] == "Mast" && told["about"] == "motion");
    let status = program(&units).arg("status").output().expect("it runs");
    assert!(says(&status).contains("Mast: link up, standby"), "{}", says(&status));

    let stop = program(&units).arg("stop").output().expect("it runs");
    assert!(says(&stop).contains("Mast: stands"), "{}", says(&stop));
    assert_eq!(stop.status.code(), Some(0));
    let nobody = program(&units).args(["stop", "--antenna", "Nobody"]).output().expect("it runs");
    assert_eq!(nobody.status.code(), Some(1));

    let lock = ["lock-out", "--antenna", "Dish", "--reason", "belts", "--by", "Ada"];
    let locked = program(&units).args(lock).output().expect("it runs");
    assert_eq!(says(&locked), "Dish is locked out and stands.\n");
    served.until(|told| told["antenna"] == "Dish" && told["about"] == "lock_out");
    let unlock = ["lock-out", "--antenna", "Dish", "--off"];
    let refused = program(&units).args(unlock).output().expect("it runs");
    assert_ne!(refused.status.code(), Some(0));
    let why = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(why.contains("by Ada: belts") && why.contains("--locked-by"), "{why}");
    let unlocked =
        program(&units).args(unlock).args(["--locked-by", "Ada"]).output().expect("it runs");
    assert_eq!(says(&unlocked), "Dish is not locked out any more.\n");
    let again = program(&units).args(lock).output().expect("it runs");
    assert_eq!(again.status.code(), Some(0));

    served.signal("USR1");
    served.until(|told| told["antenna"] == "Mast" && told["text"] == "STOP is confirmed.");

    let asked = Instant::now();
    served.signal("TERM");
    let ended = served.process.wait().expect("it ends");
    assert_eq!(ended.code(), Some(0));
    assert!(asked.elapsed() < Duration::from_secs(10), "{:?}", asked.elapsed());

    let gone = program(&units).arg("stop").output().expect("it runs");
    assert_eq!(gone.status.code(), Some(1));
}

#[test]
fn who_locks_out_an_antenna_writes_no_line_of_another_one() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let served = Served::start(&units);
    served.until(|told| told["antenna"] == "Mast" && told["about"] == "motion");
    let by = "Ada\u{1b}[2J\nMast: link up, stands";
    let lock = ["lock-out", "--antenna", "Dish", "--reason", "belts", "--by", by];
    program(&units).args(lock).output().expect("it runs");
    let status = says(&program(&units).arg("status").output().expect("it runs"));
    assert!(status.contains("locked out by Ada"), "{status}");
    assert!(!status.contains('\u{1b}'), "{status:?}");
    assert_eq!(status.lines().filter(|line| line.starts_with("Mast:")).count(), 1, "{status:?}");
}

#[test]
fn a_runtime_folder_that_is_open_to_others_is_closed() {
    use std::os::unix::fs::PermissionsExt as _;

    let units = Units::start(|station| station.antennas.truncate(2));
    let folder = units.folder.path().join("runtime/azel");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o777)).unwrap();
    let served = Served::start(&units);
    served.until(|told| told["antenna"] == "Mast" && told["about"] == "motion");
    let mode = std::fs::metadata(&folder).unwrap().permissions().mode();
    assert_eq!(mode & 0o077, 0, "mode {mode:o}");
}

#[test]
fn an_alarm_says_which_antennas_a_setting_that_cannot_be_read_keeps_still() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let text = std::fs::read_to_string(units.path()).unwrap();
    let text = text.replacen("[antenna.limits]", "[antenna.limits]\nminimum_elevation = 5", 1);
    let damaged = format!("{text}\n[[keep_out]]\nname = 'mast'\ncorners = []\n");
    std::fs::write(units.path(), damaged).unwrap();
    let (running, _end, _woken) = units.open();
    let told = wait_for("the alarms", || {
        let snapshot = running.client().snapshot();
        let alarms = snapshot.alarms.list().iter();
        let told: Vec<_> = alarms
            .filter(|alarm| matches!(alarm.kind, AlarmKind::SafetySetting { .. }))
            .map(|alarm| (alarm.kind.priority(), words::alarm(&alarm.kind, "", start())))
            .collect();
        (!told.is_empty()).then_some(told)
    });
    let says = |words: &str| told.iter().any(|(_, told)| told.contains(words));
    assert!(says("Until it is repaired, the antennas do not move by themselves."), "{told:?}");
    assert!(says("Until it is repaired, Dish does not move by itself."), "{told:?}");
    assert!(told.iter().all(|(priority, _)| *priority == Priority::First), "{told:?}");
}

#[test]
fn a_station_file_that_could_not_be_read_is_not_replaced() {
    // Somebody may repair the file while Azel runs. Its antennas are still not those that Azel
    // shows.
    for is_mended in [false, true] {
        let units = Units::start(|station| station.antennas.truncate(2));
        let whole = std::fs::read_to_string(units.path()).unwrap();
        let damaged = whole.replacen("[site]", "[site", 1);
        assert_ne!(damaged, whole);
        std::fs::write(units.path(), &damaged).unwrap();
        let (running, _end, _woken) = units.open();
        let client = running.client();
        wait_for("the station", || client.snapshot().station_unread.then_some(()));
        let there = if is_mended { whole } else { damaged };
        std::fs::write(units.path(), &there).unwrap();
        client.send(Command::SaveStation(Box::default())).unwrap();
        let is_refusal = |alarm: &Alarm| matches!(&alarm.kind, AlarmKind::Settings(why) if why.contains("would replace it"));
        wait_for("the refusal", || {
            client.snapshot().alarms.list().iter().any(is_refusal).then_some(())
        });
        assert_eq!(std::fs::read_to_string(units.path()).unwrap(), there);
    }
}

#[test]
fn output_that_nobody_reads_holds_up_nothing() {
    let units = Units::start(|_| {});
    let process = program(&units).arg("serve").stdout(Stdio::piped()).spawn();
    let mut served =
        Served { process: process.expect("the program starts"), lines: mpsc::sync_channel(1).1 };
    wait_for("the socket", || {
        let stop = program(&units).arg("stop").output().expect("it runs");
        says(&stop).contains("Mast: stands").then_some(())
    });
    served.signal("TERM");
    assert_eq!(served.process.wait().expect("it ends").code(), Some(0));
}

#[test]
fn a_unit_that_cannot_be_locked_is_left_alone_until_it_can() {
    let units = Units::start(|station| station.antennas.truncate(2));
    let locks = units.folder.path().join("run");
    // Azel cannot make a folder where a file stands.
    std::fs::write(&locks, "").unwrap();
    let (station, _end, _woken) = units.open();
    let client = station.client();
    let alarm = |snapshot: &Snapshot| {
        let is_it = |alarm: &Alarm| {
            matches!(&alarm.kind, AlarmKind::UnitElsewhere(HeldBy::Unknown(_))) && !alarm.is_over()
        };
        snapshot.alarms.list().iter().any(is_it)
    };
    wait_for("the alarm", || alarm(&client.snapshot()).then_some(()));
    assert!(units.dish.received().is_empty() && units.mast.received().is_empty());
    std::fs::remove_file(&locks).unwrap();
    wait_for("the link", || is_measured(client, "Dish"));
    wait_for("the end of the alarm", || (!alarm(&client.snapshot())).then_some(()));
}
