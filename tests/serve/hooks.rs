//! Hooks of a station without a window: real programs and servers that fail in every way.

use std::{
    fs,
    io::{Read as _, Write as _},
    net::{TcpListener, TcpStream},
    path::PathBuf,
    sync::{Arc, mpsc},
    time::{Duration, Instant},
};

use azel::{
    astro::time::add_seconds,
    clock::Clock,
    contract::{
        Command,
        hooks::{HookOutcome, HookResult, HookRun, HookState, NotRun},
    },
    controller::SPECS,
    engine::{Client, Handle, Settings, record_path},
    orbit::{PassSearch, Propagator, bundled, passes},
    record::{Kind, RowKind},
    station::{self, Hook, HookAction, HookEvent, Station},
};
use jiff::ToSpan as _;

use super::{
    NOAA_20, Units, is_measured, lead_to_the_sun, named, named_thread, record::rows, start,
    wait_for,
};

/// Max time of any end that these tests wait for, seconds. Programs that hang would take minutes.
const SOON_S: f64 = 10.0;

fn command(words: &[&str]) -> HookAction {
    HookAction::Command(words.iter().map(|word| (*word).to_owned()).collect())
}

fn hook(name: &str, action: HookAction) -> Hook {
    Hook::new(name, HookEvent::Aos, action)
}

/// Hook whose call ends after a second.
fn short(name: &str, action: HookAction) -> Hook {
    Hook { timeout_s: 1.0, ..hook(name, action) }
}

/// A station without antennas, with a record.
struct Bench {
    station: Handle,
    record: PathBuf,
    _folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        station::save(&Station::default(), &path, SPECS).unwrap();
        let records = folder.path().join("records");
        let record = record_path(&records, &path);
        let settings = Settings {
            path: Some(path),
            library: Some(folder.path().join("elements")),
            records: Some(records),
            ..Settings::default()
        };
        let station = Handle::start(settings, Clock::system(), Arc::new(|| {})).unwrap();
        Self { station, record, _folder: folder }
    }

    fn try_hook(&self, hook: Hook) {
        self.station.client().send(Command::TryHook(Box::new(hook))).unwrap();
    }

    /// Calls a hook and returns its outcome.
    fn outcome(&self, hook: Hook) -> HookOutcome {
        let name = hook.name.clone();
        self.try_hook(hook);
        let outcome = ended(self.station.client(), &name);
        assert!(outcome.duration_s < SOON_S, "{name}: {outcome:?}");
        outcome
    }
}

fn runs(client: &Client, name: &str) -> Vec<HookRun> {
    let runs = client.snapshot().hooks.clone();
    runs.iter().filter(|run| run.hook == name).cloned().collect()
}

/// Waits for the end of the last call of a hook.
fn ended(client: &Client, name: &str) -> HookOutcome {
    wait_for(name, || match runs(client, name).pop()?.state {
        HookState::Ended(outcome) => Some(outcome),
        HookState::Running | HookState::NotRun(_) => None,
    })
}

fn is_running(process: &str) -> bool {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // A killed child of a killed parent stays as a zombie until init reaps it.
    stat.rsplit(") ").next().is_some_and(|state| !state.is_empty() && !state.starts_with('Z'))
}

#[test]
fn a_program_gets_the_values_and_not_the_environment_of_azel() {
    let bench = Bench::new();
    let outcome = bench.outcome(hook("Values", command(&["env"])));
    assert_eq!(outcome.result, HookResult::Exited(0));
    let lines: Vec<&str> = outcome.output.lines().collect();
    for line in ["AZEL_HOOK=Values", "AZEL_EVENT=aos", "AZEL_TRIAL=1", "AZEL_STATION=Station"] {
        assert!(lines.contains(&line), "{line} is missing: {lines:?}");
    }
    for name in ["AZEL_AOS=", "AZEL_LOS=", "AZEL_SATELLITE_NUMBER=", "AZEL_MAX_ELEVATION_DEG="] {
        assert!(lines.iter().any(|line| line.starts_with(name)), "{name} is missing: {lines:?}");
    }
    assert!(lines.iter().any(|line| line.starts_with("PATH=")));
    // Cargo sets these for the test, in place of a secret.
    assert!(std::env::vars().any(|(name, _)| name.starts_with("CARGO")));
    assert!(!outcome.output.contains("CARGO"), "{lines:?}");
}

#[test]
fn programs_that_fail_or_do_not_start_are_told_and_recorded() {
    let bench = Bench::new();
    assert_eq!(bench.outcome(hook("Fails", command(&["false"]))).result, HookResult::Exited(1));
    let missing = bench.outcome(hook("Missing", command(&["/nowhere/program"])));
    assert!(matches!(&missing.result, HookResult::CannotStart(_)), "{missing:?}");
    let echo = bench.outcome(hook("Words", command(&["echo", "a  b", "$HOME;`id`"])));
    assert_eq!(echo.output, "a  b $HOME;`id`\n", "no shell reads the arguments");
    let Bench { station, record, _folder } = bench;
    drop(station);
    let entries = rows(&record, RowKind::Entry(Kind::Hook));
    let runs: Vec<HookRun> =
        entries.iter().map(|row| serde_json::from_value(row.data.clone()).unwrap()).collect();
    let names: Vec<&str> = runs.iter().map(|run| run.hook.as_str()).collect();
    assert_eq!(names, ["Fails", "Missing", "Words"]);
    assert!(runs.iter().all(|run| run.is_trial && matches!(run.state, HookState::Ended(_))));
    assert!(runs[0].is_failure() && !runs[2].is_failure());
}

#[test]
fn a_program_that_hangs_is_killed_with_all_that_it_forked() {
    let bench = Bench::new();
    let outcome =
        bench.outcome(short("Hangs", command(&["sh", "-c", "sleep 600 & echo $$ $!; wait"])));
    assert_eq!(outcome.result, HookResult::TimedOut);
    let processes: Vec<&str> = outcome.output.split_whitespace().collect();
    assert_eq!(processes.len(), 2, "{outcome:?}");
    wait_for("the end of both", || {
        (!processes.iter().any(|process| is_running(process))).then_some(())
    });
}

#[test]
fn a_program_that_leaves_a_child_with_its_output_ends_at_once() {
    let bench = Bench::new();
    let outcome = bench.outcome(hook("Forks", command(&["sh", "-c", "sleep 20 & echo left"])));
    assert_eq!((outcome.result, &*outcome.output), (HookResult::Exited(0), "left\n"));
    assert!(outcome.duration_s < 5.0, "{}", outcome.duration_s);
}

#[test]
fn of_a_flood_the_first_four_kilobytes_stay() {
    let bench = Bench::new();
    let ends = command(&["head", "-c", "100000000", "/dev/zero"]);
    let outcome = bench.outcome(Hook { timeout_s: 9.0, ..hook("Ends", ends) });
    assert_eq!((outcome.output.len(), outcome.is_cut), (4096, true));
    assert_eq!(outcome.result, HookResult::Exited(0));
    let outcome = bench.outcome(short("Never ends", command(&["yes"])));
    assert_eq!((outcome.output.len(), outcome.is_cut), (4096, true));
    assert_eq!(outcome.result, HookResult::TimedOut);
}

#[test]
fn a_hook_that_hangs_delays_no_other() {
    let bench = Bench::new();
    let client = bench.station.client();
    let hangs = || Hook { timeout_s: 3.0, ..hook("Hangs", command(&["sleep", "600"])) };
    for _ in 0..5 {
        bench.try_hook(hangs());
    }
    let states = wait_for("five calls", || {
        let runs = runs(client, "Hangs");
        (runs.len() == 5).then(|| runs.into_iter().map(|run| run.state).collect::<Vec<_>>())
    });
    assert_eq!(states[..4], vec![HookState::Running; 4]);
    assert_eq!(states[4], HookState::NotRun(NotRun::Busy));
    let outcome = bench.outcome(hook("Other", command(&["true"])));
    assert_eq!(outcome.result, HookResult::Exited(0));
    assert!(outcome.duration_s < 2.0, "{}", outcome.duration_s);
    let last = ended_count(client, "Hangs", 4);
    assert!(last.iter().all(|result| *result == HookResult::TimedOut));
}

fn ended_count(client: &Client, name: &str, count: usize) -> Vec<HookResult> {
    wait_for(name, || {
        let runs = runs(client, name).into_iter();
        let results: Vec<HookResult> = runs
            .filter_map(|run| match run.state {
                HookState::Ended(outcome) => Some(outcome.result),
                HookState::Running | HookState::NotRun(_) => None,
            })
            .collect();
        (results.len() == count).then_some(results)
    })
}

/// Starts a server for one request, which `answer` handles. Returns its address and its thread,
/// which returns the request.
fn server(
    answer: impl FnOnce(&mut TcpStream) + Send + 'static,
) -> (String, std::thread::JoinHandle<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/hook", listener.local_addr().unwrap());
    let thread = named_thread("server", move || {
        let (mut stream, _) = listener.accept().unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        let (mut request, mut buffer) = (Vec::new(), [0; 4096]);
        loop {
            let text = String::from_utf8_lossy(&request).into_owned();
            if let Some((head, body)) = text.split_once("\r\n\r\n") {
                let length = head.lines().find_map(|line| {
                    let (name, value) = line.split_once(':')?;
                    let is_it = name.eq_ignore_ascii_case("content-length");
                    value.trim().parse::<usize>().ok().filter(|_| is_it)
                });
                if length.is_none_or(|length| body.len() >= length) {
                    break;
                }
            }
            match stream.read(&mut buffer) {
                Ok(0) | Err(_) => break,
                Ok(count) => request.extend_from_slice(&buffer[..count]),
            }
        }
        answer(&mut stream);
        String::from_utf8_lossy(&request).into_owned()
    });
    (url, thread)
}

fn send(stream: &mut TcpStream, status: &str, headers: &str, body: &str) {
    let length = body.len();
    let text = format!("HTTP/1.1 {status}\r\nContent-Length: {length}\r\n{headers}\r\n{body}");
    // Ignore errors: the client may have left.
    let _ = stream.write_all(text.as_bytes());
}

#[test]
fn a_server_gets_the_values_as_json_and_its_refusal_is_told() {
    let bench = Bench::new();
    let (url, thread) = server(|stream| send(stream, "200 OK", "", "thanks"));
    let outcome = bench.outcome(hook("Web", HookAction::Webhook(url)));
    assert_eq!((outcome.result, &*outcome.output), (HookResult::Answered(200), "thanks"));
    let request = thread.join().unwrap();
    assert!(request.starts_with("POST /hook HTTP/1.1\r\n"), "{request}");
    assert!(request.to_lowercase().contains("content-type: application/json"), "{request}");
    let (_, body) = request.split_once("\r\n\r\n").unwrap();
    let values: serde_json::Value = serde_json::from_str(body).unwrap();
    assert_eq!((&values["hook"], &values["event"]), (&"Web".into(), &"aos".into()));
    assert_eq!(values["is_trial"], true);
    assert!(values["pass"]["aos"].is_string() && values["satellite"]["number"].is_u64());

    let (url, _thread) = server(|stream| send(stream, "500 Broken", "", "no"));
    let outcome = bench.outcome(hook("Broken", HookAction::Webhook(url)));
    assert_eq!((outcome.result, &*outcome.output), (HookResult::Answered(500), "no"));
    let closed = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let outcome = bench.outcome(hook("Nobody", HookAction::Webhook(format!("http://{closed}/"))));
    assert!(matches!(&outcome.result, HookResult::NoAnswer(_)), "{outcome:?}");
}

#[test]
fn a_server_that_redirects_is_not_followed() {
    let bench = Bench::new();
    let other = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("Location: http://{}/other\r\n", other.local_addr().unwrap());
    let (url, _thread) = server(move |stream| send(stream, "307 Moved", &target, ""));
    let outcome = bench.outcome(hook("Moved", HookAction::Webhook(url)));
    assert_eq!(outcome.result, HookResult::Answered(307));
    other.set_nonblocking(true).unwrap();
    assert!(other.accept().is_err(), "the other host got the values");
}

#[test]
fn a_server_that_never_answers_or_never_ends_is_left() {
    let bench = Bench::new();
    let (end, hold) = mpsc::sync_channel::<()>(0);
    let (url, thread) = server(move |_| {
        // The channel never carries a message; it closes with the test.
        let _ = hold.recv();
    });
    let outcome = bench.outcome(short("Silent", HookAction::Webhook(url)));
    assert_eq!(outcome.result, HookResult::TimedOut);
    drop(end);
    thread.join().unwrap();

    let (url, thread) = server(|stream| {
        let head = "HTTP/1.1 200 OK\r\nContent-Length: 1000000000000\r\n\r\n";
        let mut is_open = stream.write_all(head.as_bytes()).is_ok();
        while is_open {
            is_open = stream.write_all(&[b'x'; 4096]).is_ok();
        }
    });
    let outcome = bench.outcome(hook("Endless", HookAction::Webhook(url)));
    assert_eq!(outcome.result, HookResult::Answered(200));
    assert_eq!((outcome.output.len(), outcome.is_cut), (4096, true));
    thread.join().unwrap();
}

#[test]
fn stop_is_not_delayed_by_hooks_that_hang_and_flood() {
    let units = Units::start(|_| {});
    let (station, _end, _woken) = units.open();
    let client = station.client();
    for (name, words) in [("Hangs", &["sleep", "600"][..]), ("Floods", &["yes"])] {
        for _ in 0..4 {
            let hook = Hook { timeout_s: 40.0, ..hook(name, command(words)) };
            client.send(Command::TryHook(Box::new(hook))).unwrap();
        }
    }
    lead_to_the_sun(client);
    let all_run = || runs(client, "Floods").len() == 4 && runs(client, "Hangs").len() == 4;
    wait_for("the calls", || all_run().then_some(()));
    let pressed = Instant::now();
    client.stop_all();
    wait_for("standstill", || units.all_stand().then_some(()));
    assert!(pressed.elapsed() < Duration::from_secs(6), "{:?}", pressed.elapsed());
    assert!(runs(client, "Hangs").iter().all(|run| run.state == HookState::Running));
}

/// Returns the first AOS of a high pass of NOAA 20 over the station.
fn first_aos(station: &Station) -> jiff::Timestamp {
    let elements = bundled().unwrap().get(NOAA_20).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        ..PassSearch::new(station.site, start(), start() + 24.hours())
    };
    let found = passes(&propagator, &search, &|| false);
    let is_high = |pass: &&azel::orbit::Pass| pass.max_elevation().degrees() > 30.0;
    found.iter().filter(|pass| !pass.starts_before).find(is_high).unwrap().aos.time
}

#[test]
fn hooks_call_at_the_aos_of_a_planned_pass() {
    let units = Units::start(|station| {
        station.antennas.truncate(1);
        station.hooks = vec![
            Hook { delay_s: -175.0, ..hook("Early", command(&["env"])) },
            hook("Other satellite", command(&["env"])),
        ];
        station.hooks[1].subject = Some(azel::station::RuleSubject::Satellite(25_544));
    });
    let text = fs::read_to_string(units.path()).unwrap();
    let station = station::load(&units.path(), SPECS).unwrap().station;
    assert!(text.contains("delay_s = -175"), "{text}");
    // The antenna needs time to reach the start of the pass.
    let begin = add_seconds(first_aos(&station), -180.0);
    let begun = Instant::now();
    let clock = Clock::new(move || add_seconds(begin, begun.elapsed().as_secs_f64()));
    let settings = Settings {
        path: Some(units.path()),
        library: Some(units.folder.path().join("elements")),
        ..Settings::default()
    };
    let station = Handle::start(settings, clock, Arc::new(|| {})).unwrap();
    let client = station.client();
    wait_for("the dish", || is_measured(client, "Dish"));
    let outcome = ended(client, "Early");
    let run = runs(client, "Early").pop().unwrap();
    assert!(!run.is_trial && run.antenna == Some(named(&client.snapshot(), "Dish").id()));
    assert_eq!(run.pass.map(|(number, _)| number), Some(NOAA_20));
    for line in ["AZEL_TRIAL=0", "AZEL_PLAN=planned", "AZEL_SATELLITE_NUMBER=43013"] {
        assert!(outcome.output.lines().any(|other| other == line), "{line}: {}", outcome.output);
    }
    assert_eq!(runs(client, "Other satellite"), []);
}
