//! Time from Esc pressed to `STOP=` on the wire to the first of three antennas, in the real window
//! on a virtual screen. The bench needs Xvfb and xdotool. With the path of another build of the
//! program in `AZEL_BESIDE`, it measures both builds in turn. An argument selects the rows whose
//! name contains it.

// A bench prints its results, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing)]

use std::{
    collections::BTreeMap,
    env,
    fmt::Write as _,
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::SocketAddr,
    process::{Child, ChildStdin, Command, Stdio},
    sync::mpsc,
    thread::sleep,
    time::Duration,
};

use azel::{
    clock::Instant,
    orbit::bundled,
    protocol::satrak::encode,
    sim::satrak::{BUNDLED_FILE, Options, Simulator},
    station::Station,
};
use jiff::{SignedDuration, Timestamp, tz::TimeZone};
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _},
    net::{TcpListener, TcpStream},
    runtime::Runtime,
};

/// EUTELSAT 7C, which is stationary in the sky of the default site.
const SATELLITE: u32 = 44_334;
/// Number of antennas, each with its own unit.
const ANTENNAS: usize = 3;
/// Duration of a held key, longer than the delay before the display repeats the key.
const HELD: Duration = Duration::from_millis(900);

struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn on_screen(display: &str, program: &str) -> Command {
    let mut command = Command::new(program);
    command.env("DISPLAY", display).env_remove("WAYLAND_DISPLAY").stderr(Stdio::null());
    command
}

/// Activity of the antenna when Esc is pressed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Doing {
    Nothing,
    /// A jog key is held.
    Jogging,
    /// On-board track.
    Tracking,
}

/// A window with its unit and its measurements.
struct Bench {
    name: String,
    keys: ChildStdin,
    /// Requests that arrive for the first antenna, with their times.
    arrivals: mpsc::Receiver<(Instant, &'static str)>,
    unit: SocketAddr,
    times: Vec<Duration>,
    _folder: tempfile::TempDir,
    _azel: Running,
    _keyboard: Running,
    _runtime: Runtime,
}

fn main() {
    let ours = ("this", env!("CARGO_BIN_EXE_azel").to_owned());
    let beside = env::var("AZEL_BESIDE").ok().map(|program| ("beside", program));
    let programs: Vec<(&str, String)> = std::iter::once(ours).chain(beside).collect();
    // Cargo itself passes `--bench`.
    let chosen = env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let chosen = chosen.unwrap_or_default();
    for (what, hz, stall, doing, presses) in [
        ("poll at 2 Hz", 2.0, Duration::ZERO, Doing::Nothing, 120),
        ("poll at 10 Hz", 10.0, Duration::ZERO, Doing::Nothing, 120),
        ("replies stalled by 1.5 s", 10.0, Duration::from_millis(1500), Doing::Nothing, 60),
        ("in a held jog", 10.0, Duration::ZERO, Doing::Jogging, 40),
        ("while the unit tracks", 10.0, Duration::ZERO, Doing::Tracking, 40),
    ] {
        if !what.contains(&chosen) {
            continue;
        }
        // Each program has its own screen, where it keeps the focus.
        let mut benches: Vec<(Running, Bench)> = programs
            .iter()
            .map(|(name, program)| {
                let (screen, display) = screen();
                (screen, Bench::start(name, program, &display, hz, stall))
            })
            .collect();
        // The programs take turns, so that all meet the same load.
        for press in 0..presses {
            for (_, bench) in &mut benches {
                bench.press(press, doing);
            }
        }
        for (_, bench) in benches {
            bench.report(what);
        }
    }
}

/// Starts an X server with a free number, waits until it takes clients, and returns it with the
/// name of its display.
fn screen() -> (Running, String) {
    let screen = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1440x900x24", "-nolisten", "tcp"])
        // Without this option, Xvfb restarts whenever its last client leaves, and drops a new
        // client.
        .arg("-noreset")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let mut screen = Running(screen.expect("Xvfb is installed"));
    let mut number = String::new();
    BufReader::new(screen.0.stdout.take().expect("piped"))
        .read_line(&mut number)
        .expect("the number of the display");
    assert!(!number.is_empty(), "Xvfb ended before it took clients");
    (screen, format!(":{}", number.trim()))
}

/// First words of the requests whose arrival the relay reports.
const TOLD: [&str; 2] = ["MOVE=", "STOP="];

/// Starts a relay to the unit, and returns its address. The relay delays every reply by `stall`,
/// but no request, and reports the arrival of each of [`TOLD`].
async fn stalling_way(
    unit: SocketAddr,
    stall: Duration,
    tell: mpsc::SyncSender<(Instant, &'static str)>,
) -> SocketAddr {
    let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a port");
    let address = listener.local_addr().expect("an address");
    tokio::spawn(async move {
        while let Ok((console, _)) = listener.accept().await {
            let unit = TcpStream::connect(unit).await.expect("the unit");
            let (mut from_console, mut to_console) = console.into_split();
            let (mut from_unit, mut to_unit) = unit.into_split();
            let tell = tell.clone();
            tokio::spawn(async move {
                let mut buffer = [0; 4096];
                while let Ok(count @ 1..) = from_console.read(&mut buffer).await {
                    let (arrived, bytes) = (Instant::now(), &buffer[..count]);
                    let text = String::from_utf8_lossy(bytes);
                    for word in TOLD.into_iter().filter(|word| text.contains(word)) {
                        tell.try_send((arrived, word)).ok();
                    }
                    if to_unit.write_all(bytes).await.is_err() {
                        break;
                    }
                }
            });
            let (send, mut replies) =
                tokio::sync::mpsc::channel::<(std::time::Instant, Vec<u8>)>(10_000);
            tokio::spawn(async move {
                let mut buffer = [0; 4096];
                while let Ok(count @ 1..) = from_unit.read(&mut buffer).await {
                    if send
                        .send((std::time::Instant::now() + stall, buffer[..count].to_vec()))
                        .await
                        .is_err()
                    {
                        break;
                    }
                }
            });
            tokio::spawn(async move {
                while let Some((due, bytes)) = replies.recv().await {
                    tokio::time::sleep_until(due.into()).await;
                    if to_console.write_all(&bytes).await.is_err() {
                        break;
                    }
                }
            });
        }
    });
    address
}

impl Bench {
    fn start(name: &str, program: &str, display: &str, hz: f64, stall: Duration) -> Self {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .expect("a runtime");
        let satellite = bundled().expect("elements").get(SATELLITE).expect("it is there").clone();
        let options = Options {
            elements: BTreeMap::from([(BUNDLED_FILE.to_owned(), vec![satellite])]),
            max_clients: 2,
            ..Options::new(Station::default().site, Timestamp::now())
        };
        let mut text = String::new();
        let mut first = None;
        for number in 1..=ANTENNAS {
            let bound = Simulator::bind(([127, 0, 0, 1], 0).into(), options.clone());
            let simulator = runtime.block_on(bound).expect("a port");
            let unit = simulator.local_addr().expect("an address");
            runtime.spawn(simulator.run());
            let (tell, arrivals) = mpsc::sync_channel(1000);
            let address = runtime.block_on(stalling_way(unit, stall, tell));
            first.get_or_insert((unit, arrivals));
            write!(
                text,
                "[[antenna]]\nname = \"Dish {number}\"\n\
                 [antenna.connection]\ncontroller = \"satrak\"\naddress = \"{address}\"\n\
                 [antenna.poll]\nidle_hz = {hz}\nmoving_hz = {hz}\n"
            )
            .expect("a text takes all");
        }
        let (unit, arrivals) = first.expect("an antenna");
        let folder = tempfile::tempdir().expect("a folder");
        let station = folder.path().join("station.toml");
        fs::write(&station, text).expect("a station file");
        let azel = on_screen(display, program).arg("--station").arg(&station).spawn();
        let azel = Running(azel.expect("the program starts"));
        sleep(Duration::from_secs(4));
        let window = on_screen(display, "xdotool")
            .args(["search", "--onlyvisible", "--name", "^Azel$", "windowfocus", "--sync"])
            .status();
        assert!(window.expect("xdotool is installed").success(), "no window");
        let keyboard = on_screen(display, "xdotool").arg("-").stdin(Stdio::piped()).spawn();
        let mut keyboard = Running(keyboard.expect("xdotool is installed"));
        let keys = keyboard.0.stdin.take().expect("piped");
        Self {
            name: name.to_owned(),
            keys,
            arrivals,
            unit,
            times: Vec::new(),
            _folder: folder,
            _azel: azel,
            _keyboard: keyboard,
            _runtime: runtime,
        }
    }

    fn press(&mut self, press: u64, doing: Doing) {
        if doing == Doing::Jogging {
            // Manual is unavailable before standstill is proved.
            sleep(Duration::from_millis(2500));
            self.type_in("key m");
            sleep(Duration::from_millis(500));
            let pressed = Instant::now();
            self.type_in("keydown Right");
            self.next("MOVE=", pressed);
            sleep(HELD);
        }
        if doing == Doing::Tracking {
            sleep(Duration::from_millis(2500));
            self.track();
            sleep(Duration::from_millis(1500));
        }
        // The varying delay keeps the presses out of step with the polling.
        sleep(Duration::from_millis(280 + (press * 37) % 90));
        let pressed = Instant::now();
        self.type_in("key Escape");
        let arrived = self.next("STOP=", pressed);
        self.times.push(arrived.saturating_duration_since(pressed));
        if doing == Doing::Jogging {
            self.type_in("keyup Right");
        }
    }

    /// Starts a track of the unit as another client.
    fn track(&self) {
        let elements = bundled().expect("elements");
        let name = elements.get(SATELLITE).expect("it is there").name();
        let now = Timestamp::now();
        let [from, until] = [-60, 3600].map(|seconds| {
            let at = TimeZone::UTC.to_datetime(now + SignedDuration::from_secs(seconds));
            at.strftime("%-H,%-M,%-S,%-d,%-m,%Y").to_string()
        });
        let stream = std::net::TcpStream::connect(self.unit).expect("the unit");
        let mut replies = BufReader::new(stream.try_clone().expect("a handle")).lines();
        for payload in [
            format!("SATELLITE=,{BUNDLED_FILE},{name},1,0"),
            format!("START_STOP_TIME=,{from},{until}"),
            "TRACK=,1".to_owned(),
        ] {
            (&stream).write_all(&encode(&payload)).expect("the unit reads");
            let reply = replies.next().expect("a reply").expect("a line");
            assert!(reply.contains("OK"), "{payload}: {reply}");
        }
    }

    fn type_in(&mut self, line: &str) {
        writeln!(self.keys, "{line}").expect("xdotool takes keys");
    }

    /// Returns the arrival of the first request with `word` after `from`.
    fn next(&self, word: &str, from: Instant) -> Instant {
        loop {
            let told = self.arrivals.recv_timeout(Duration::from_secs(5));
            let (arrived, told) = told.expect("the request arrives");
            if told == word && arrived >= from {
                return arrived;
            }
        }
    }

    fn report(mut self, what: &str) {
        self.times.sort();
        let count = self.times.len();
        let below = |percent: usize| self.times[count * percent / 100];
        // With fewer measurements, p99 would equal the slowest.
        let p99 = if count > 100 { format!("p99 {:.1?}, ", below(99)) } else { String::new() };
        println!(
            "{what}, {}: p50 {:.1?}, p90 {:.1?}, {p99}slowest {:.1?} of {count}",
            self.name,
            below(50),
            below(90),
            self.times[count - 1]
        );
    }
}
