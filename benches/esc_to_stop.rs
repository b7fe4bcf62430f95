//! The time from Esc pressed to `STOP=` on the wire, in the real window on a
//! virtual screen. Needs Xvfb and xdotool.

// A bench talks to whoever started it, and ends loudly.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, clippy::indexing_slicing)]

use std::{
    fs,
    io::Write as _,
    net::SocketAddr,
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use azel::{
    sim::satrak::{Control, Options, Simulator},
    station::Station,
};
use jiff::Timestamp;
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _},
    net::{TcpListener, TcpStream},
};

const PRESSES: usize = 200;
const DISPLAY: &str = ":94";

struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn on_screen(program: &str) -> Command {
    let mut command = Command::new(program);
    command.env("DISPLAY", DISPLAY).env_remove("WAYLAND_DISPLAY").stderr(Stdio::null());
    command
}

fn main() {
    let screen = Command::new("Xvfb")
        .args([DISPLAY, "-screen", "0", "1440x900x24", "-nolisten", "tcp"])
        .stderr(Stdio::null())
        .spawn();
    let _screen = Running(screen.expect("Xvfb is installed"));
    sleep(Duration::from_secs(1));
    for (name, hz, stall) in [
        ("poll at 2 Hz", 2.0, Duration::ZERO),
        ("poll at 10 Hz", 10.0, Duration::ZERO),
        ("poll at 10 Hz, replies stalled by 1.5 s", 10.0, Duration::from_millis(1500)),
    ] {
        measure(name, hz, stall);
    }
}

/// A way to the unit on which every reply takes `stall` longer and every
/// request goes straight through.
async fn stalling_way(unit: SocketAddr, stall: Duration) -> SocketAddr {
    let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a port");
    let address = listener.local_addr().expect("an address");
    tokio::spawn(async move {
        while let Ok((console, _)) = listener.accept().await {
            let unit = TcpStream::connect(unit).await.expect("the unit");
            let (mut from_console, mut to_console) = console.into_split();
            let (mut from_unit, mut to_unit) = unit.into_split();
            tokio::spawn(async move {
                tokio::io::copy(&mut from_console, &mut to_unit).await.ok();
            });
            let (send, mut replies) = tokio::sync::mpsc::channel::<(Instant, Vec<u8>)>(10_000);
            tokio::spawn(async move {
                let mut buffer = [0; 4096];
                while let Ok(count @ 1..) = from_unit.read(&mut buffer).await {
                    if send.send((Instant::now() + stall, buffer[..count].to_vec())).await.is_err()
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

fn measure(name: &str, hz: f64, stall: Duration) {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()
        .expect("a runtime");
    let options = Options::new(Station::default().site, Timestamp::now());
    let simulator =
        runtime.block_on(Simulator::bind(([127, 0, 0, 1], 0).into(), options)).expect("a port");
    let address = simulator.local_addr().expect("an address");
    let control = simulator.control();
    runtime.spawn(simulator.run());
    let address = runtime.block_on(stalling_way(address, stall));

    let folder = tempfile::tempdir().expect("a folder");
    let station = folder.path().join("station.toml");
    let text = format!(
        "[[antenna]]\n[antenna.connection]\ncontroller = \"satrak\"\naddress = \"{address}\"\n\
         [antenna.poll]\nidle_hz = {hz}\nmoving_hz = {hz}\n"
    );
    fs::write(&station, text).expect("a station file");
    let azel = on_screen(env!("CARGO_BIN_EXE_azel")).arg("--station").arg(&station).spawn();
    let _azel = Running(azel.expect("the program starts"));
    sleep(Duration::from_secs(4));
    let window = on_screen("xdotool")
        .args(["search", "--onlyvisible", "--name", "^Azel$", "windowfocus", "--sync"])
        .status();
    assert!(window.expect("xdotool is installed").success(), "no window");

    let keyboard = on_screen("xdotool").arg("-").stdin(Stdio::piped()).spawn();
    let mut keyboard = Running(keyboard.expect("xdotool is installed"));
    let mut keys = keyboard.0.stdin.take().expect("piped");
    let mut times: Vec<Duration> = (0..PRESSES)
        .map(|press| {
            // Not in step with the polling.
            sleep(Duration::from_millis(280 + (press as u64 * 37) % 90));
            let before = stops(&control).len();
            let pressed = Instant::now();
            keys.write_all(b"key Escape\n").expect("xdotool takes keys");
            loop {
                if let Some(arrived) = stops(&control).get(before) {
                    break arrived.saturating_duration_since(pressed);
                }
                assert!(pressed.elapsed() < Duration::from_secs(5), "no STOP for press {press}");
                sleep(Duration::from_micros(200));
            }
        })
        .collect();
    times.sort();
    println!(
        "{name}: p50 {:.1?}, p99 {:.1?}, slowest {:.1?} of {PRESSES}",
        times[PRESSES / 2],
        times[PRESSES * 99 / 100],
        times[PRESSES - 1]
    );
}

/// When each STOP came in.
fn stops(control: &Control) -> Vec<Instant> {
    let received = control.received().into_iter();
    received.filter(|(_, payload)| payload == "STOP=").map(|(at, _)| at.into_std()).collect()
}
