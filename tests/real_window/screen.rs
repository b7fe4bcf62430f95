//! A virtual screen with the program on it, and a simulated Satrak beside it.

use azel::clock::Instant;
use std::{
    fs,
    io::{BufRead as _, BufReader},
    net::SocketAddr,
    path::PathBuf,
    process::{Child, Command, Stdio},
    sync::mpsc,
    thread,
    time::Duration,
};

/// Time limit of any wait in these tests, long enough for a slow machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// Position of Manual in a window of 1440 x 900 without the demo banner, pixels.
const MANUAL: [&str; 2] = ["1218", "456"];
const X_PLUS_X: &str = "1228";
/// Possible y positions of the key X+, pixels: notes above push the keys down by up to three lines.
const X_PLUS_Y: [&str; 3] = ["687", "640", "664"];

/// A process that is killed on drop.
pub(super) struct Running(Child);

impl Running {
    fn start(command: &mut Command) -> Self {
        Self(command.spawn().unwrap_or_else(|error| panic!("{command:?}: {error}")))
    }

    pub(super) fn id(&self) -> u32 {
        self.0.id()
    }

    /// Sends a signal to the process alone.
    pub(super) fn signal(&self, name: &str) {
        send_signal(name, &self.id().to_string());
    }

    /// Sends a signal to the process group, which the process must lead.
    pub(super) fn signal_group(&self, name: &str) {
        send_signal(name, &format!("-{}", self.id()));
    }

    /// Waits until the process ends, on its own or by a signal.
    pub(super) fn wait_for_end(&mut self) {
        wait_for("the process to end", || self.0.try_wait().expect("a child"));
    }

    pub(super) fn runs(&mut self) -> bool {
        self.0.try_wait().expect("a child").is_none()
    }

    /// Waits for the end of the program and returns its exit code; `None` after a signal.
    pub(super) fn exit_code(&mut self) -> Option<i32> {
        wait_for("the program to end", || self.0.try_wait().expect("a child")).code()
    }
}

fn send_signal(name: &str, to: &str) {
    let status = Command::new("kill").args(["-s", name, "--", to]).status().expect("kill");
    assert!(status.success(), "kill -s {name} -- {to}");
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Calls `ask` until it returns an answer, for at most [`PATIENCE`].
pub(super) fn wait_for<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(Instant::now() - start < PATIENCE, "waited too long for {what}");
        thread::sleep(Duration::from_millis(20));
    }
}

/// Virtual screen with its X server and a folder for the program's files.
pub(super) struct Screen {
    display: String,
    pub(super) server: Running,
    pub(super) folder: tempfile::TempDir,
}

impl Screen {
    /// Starts an X server with a screen of `size`, for example "1440x900", and waits until it takes
    /// clients. The server chooses a free number: a number of the test could be one whose lock an
    /// earlier server left behind.
    pub(super) fn new(size: &str) -> Self {
        let mut server = Running::start(
            Command::new("Xvfb")
                .args(["-displayfd", "1", "-screen", "0", &format!("{size}x24")])
                .args(["-nolisten", "tcp"])
                // Without this option, Xvfb restarts whenever its last client leaves, and drops a
                // new one.
                .arg("-noreset")
                .stdout(Stdio::piped())
                .stderr(Stdio::null()),
        );
        let mut number = String::new();
        BufReader::new(server.0.stdout.take().expect("piped"))
            .read_line(&mut number)
            .expect("the number of the display");
        assert!(!number.is_empty(), "Xvfb ended before it took clients");
        let display = format!(":{}", number.trim());
        Self { display, server, folder: tempfile::tempdir().expect("a folder") }
    }

    pub(super) fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command
            .env("DISPLAY", &self.display)
            .env_remove("WAYLAND_DISPLAY")
            .env("HOME", self.folder.path())
            .env_remove("XDG_CONFIG_HOME")
            .env_remove("XDG_DATA_HOME");
        command
    }

    /// Starts the program on this screen. Returns it with the id of its window.
    pub(super) fn azel(&self, arguments: &[&str]) -> (Running, String) {
        let mut command = self.command(env!("CARGO_BIN_EXE_azel"));
        self.window_of(command.args(arguments).env("AZEL_LOG", "error"))
    }

    /// Starts `command`, which opens the program's window on this screen.
    pub(super) fn window_of(&self, command: &mut Command) -> (Running, String) {
        // Keep the alarms of a test from the desktop and the speakers of its user.
        command.env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere").env("PATH", "");
        let mut running = Running::start(command);
        let window = wait_for("the window", || {
            let ended = running.0.try_wait().expect("a child");
            assert!(ended.is_none(), "the program has ended without a window: {ended:?}");
            let found = self.xdotool(&["search", "--onlyvisible", "--name", "^Azel$"]);
            found.lines().last().map(str::to_owned)
        });
        self.xdotool(&["windowfocus", "--sync", &window]);
        (running, window)
    }

    /// Asks the window to close, as a window manager does on a click.
    pub(super) fn close(&self, window: &str) {
        use x11rb::{
            connection::Connection as _,
            protocol::xproto::{ClientMessageEvent, ConnectionExt as _, EventMask},
        };
        let window: u32 = window.parse().expect("a window");
        let (connection, _) = x11rb::connect(Some(&self.display)).expect("the screen");
        let atom = |name: &str| {
            let asked = connection.intern_atom(false, name.as_bytes()).expect("a request");
            asked.reply().expect("an atom").atom
        };
        let delete = [atom("WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0];
        let message = ClientMessageEvent::new(32, window, atom("WM_PROTOCOLS"), delete);
        connection
            .send_event(false, window, EventMask::NO_EVENT, message)
            .expect("a request")
            .check()
            .expect("the window is there");
        connection.flush().expect("the screen");
    }

    /// Switches to Manual and presses the key X+ at one of its possible places. Each attempt tries
    /// another place.
    pub(super) fn press_x_plus(&self, attempt: usize) {
        let [x, y] = MANUAL;
        self.xdotool(&["mousemove", x, y, "click", "1"]);
        let y = X_PLUS_Y.iter().cycle().nth(attempt).expect("a cycle has no end");
        self.xdotool(&["mousemove", X_PLUS_X, y, "mousedown", "1"]);
    }

    /// Returns the number of antennas marked on disk as moved by hand and not proved to stand.
    pub(super) fn marks(&self) -> usize {
        let folder = self.folder.path().join(".local/share/azel/marks");
        fs::read_dir(folder).map_or(0, Iterator::count)
    }

    pub(super) fn release_key(&self) {
        self.xdotool(&["mouseup", "1"]);
    }

    pub(super) fn xdotool(&self, arguments: &[&str]) -> String {
        let output = self.command("xdotool").args(arguments).output().expect("xdotool");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// Returns the pixels of the screen, three bytes each.
    pub(super) fn picture(&self) -> Vec<u8> {
        let output = self
            .command("import")
            .args(["-window", "root", "-depth", "8", "rgb:-"])
            .output()
            .expect("ImageMagick");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    }

    pub(super) fn station_file(&self, satrak: SocketAddr) -> PathBuf {
        let path = self.folder.path().join("station.toml");
        let text = format!(
            "name = \"Bench\"\n[[antenna]]\nname = \"Satrak\"\n[antenna.connection]\n\
             controller = \"satrak\"\naddress = \"{satrak}\"\nelement_file = \"active.txt\"\n"
        );
        fs::write(&path, text).expect("a station file");
        path
    }
}

/// A simulated Satrak in a process of its own, with its output.
pub(super) struct Satrak {
    pub(super) address: SocketAddr,
    _process: Running,
    lines: mpsc::Receiver<String>,
}

impl Satrak {
    pub(super) fn start(listen: &str) -> Self {
        let mut process = Running::start(
            Command::new(env!("CARGO_BIN_EXE_azel"))
                .args(["simulate", "satrak", "--listen", listen])
                .env("NO_COLOR", "1")
                .stderr(Stdio::piped()),
        );
        let stderr = process.0.stderr.take().expect("piped");
        let (send, lines) = mpsc::sync_channel(100_000);
        thread::Builder::new()
            .name("satrak log".to_owned())
            .spawn(move || {
                for line in BufReader::new(stderr).lines().map_while(Result::ok) {
                    if send.send(line).is_err() {
                        break;
                    }
                }
            })
            .expect("a thread");
        let mut satrak =
            Self { address: SocketAddr::from(([127, 0, 0, 1], 0)), _process: process, lines };
        let line = satrak.wait_for_line("a simulated Satrak listens");
        let address = line.split("address=").nth(1).expect("an address");
        satrak.address = address.trim().parse().expect("an address");
        satrak
    }

    /// Returns the next line with `word`, unless it takes longer than half a second.
    pub(super) fn line_soon(&mut self, word: &str) -> Option<String> {
        let until = Instant::now() + Duration::from_millis(500);
        while let Ok(line) =
            self.lines.recv_timeout(until.saturating_duration_since(Instant::now()))
        {
            if line.contains(word) {
                return Some(line);
            }
        }
        None
    }

    /// Waits for the next line with `word` after the end of the last search.
    pub(super) fn wait_for_line(&mut self, word: &str) -> String {
        wait_for(word, || {
            while let Ok(line) = self.lines.try_recv() {
                if line.contains(word) {
                    return Some(line);
                }
            }
            None
        })
    }
}
