//! A simulated Satrak behind a real socket, and a window with the real app.

use std::{
    collections::BTreeMap,
    io::{BufRead as _, BufReader, Write as _},
    net::{SocketAddr, TcpStream},
    num::NonZeroU32,
    ops::RangeInclusive,
    path::Path,
    thread,
    time::Duration,
};

use azel::{
    app::App,
    clock::{Clock, Instant},
    controller::satrak::ELEMENT_FILE,
    driver::Outside,
    engine::Settings,
    model::{Model, View},
    orbit::{Elements, bundled},
    protocol::satrak::{Frame, Reply, Status, encode},
    sim::satrak::{BUNDLED_FILE, Control, Options, Simulator},
    station::{Antenna, Station},
};
use egui::Role;
use egui_kittest::{Harness, kittest::Queryable as _};
use jiff::Timestamp;
use tokio::sync::oneshot;

use crate::window_stories::rig;

/// Time limit of any wait of a story.
const PATIENCE: Duration = Duration::from_secs(20);

const DEFAULT_DELAY: RangeInclusive<Duration> =
    Duration::from_millis(5)..=Duration::from_millis(30);

pub(crate) type RealWindow = Harness<'static, App>;

/// A unit that runs until it is dropped.
pub(crate) struct Unit {
    pub(crate) address: SocketAddr,
    pub(crate) control: Control,
    _end: oneshot::Sender<()>,
}

impl Unit {
    /// Starts a unit with the elements of the station, and a clock that starts at `utc`.
    pub(crate) fn start(utc: Timestamp) -> Self {
        Self::with_delay(utc, DEFAULT_DELAY)
    }

    /// Starts a unit as [`Self::start`] does, with delayed answers.
    pub(crate) fn with_delay(utc: Timestamp, reply_delay: RangeInclusive<Duration>) -> Self {
        let catalog = bundled().unwrap();
        let favourites = rig::station().favourites.numbers().into_iter();
        let elements = favourites.map(|number| catalog.get(number).unwrap().clone()).collect();
        Self::run(Options { reply_delay, ..holding(elements, utc) })
    }

    /// Starts a unit with these elements, and a clock that starts at `utc`.
    pub(crate) fn of_elements(elements: Vec<Elements>, utc: Timestamp) -> Self {
        Self::run(holding(elements, utc))
    }

    fn run(options: Options) -> Self {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        let free_port = SocketAddr::from(([127, 0, 0, 1], 0));
        let simulator = runtime.block_on(Simulator::bind(free_port, options)).unwrap();
        let (address, control) = (simulator.local_addr().unwrap(), simulator.control());
        let (end, ended) = oneshot::channel::<()>();
        let run = move || {
            runtime.block_on(async {
                tokio::select! {
                    () = simulator.run() => {}
                    _ = ended => {}
                }
            });
        };
        thread::Builder::new().name("unit".to_owned()).spawn(run).unwrap();
        Self { address, control, _end: end }
    }

    /// Returns the station with this unit as its antenna.
    pub(crate) fn station(&self) -> Station {
        let mut antenna = Antenna::satrak("Satrak", &self.address.to_string());
        antenna.connection.put(&ELEMENT_FILE, BUNDLED_FILE).unwrap();
        Station { antennas: vec![antenna], ..rig::station() }
    }

    /// Returns the status that the unit reports to a new client, if it accepts one.
    pub(crate) fn status(&self) -> Option<Status> {
        let mut stream = TcpStream::connect(self.address).ok()?;
        stream.set_read_timeout(Some(PATIENCE)).ok()?;
        stream.write_all(&encode("STATUS?")).ok()?;
        let mut line = String::new();
        BufReader::new(stream).read_line(&mut line).ok()?;
        let payload = line.strip_prefix('$')?.split('*').next()?;
        match Reply::parse(&Frame::from_payload(payload)).ok()?.reply {
            Reply::Status(status) => Some(status),
            other => panic!("{other:?}"),
        }
    }
}

fn holding(elements: Vec<Elements>, utc: Timestamp) -> Options {
    Options {
        elements: BTreeMap::from([(BUNDLED_FILE.to_owned(), elements)]),
        reply_delay: DEFAULT_DELAY,
        ..Options::new(rig::station().site, utc)
    }
}

/// Returns a running clock that starts at `utc`.
pub(crate) fn clock_from(utc: Timestamp) -> Clock {
    Clock::at_speed(utc, NonZeroU32::MIN)
}

/// Opens a window with the real app on the settings at `path`.
pub(crate) fn open(path: &Path, outside: impl Into<Outside>) -> RealWindow {
    open_as(path, outside, |app| app)
}

/// Opens a window as [`open`] does, with an app that `change` alters before its first frame.
pub(crate) fn open_as(
    path: &Path,
    outside: impl Into<Outside>,
    change: impl FnOnce(App) -> App + 'static,
) -> RealWindow {
    let outside = outside.into();
    let settings = Settings {
        path: Some(path.to_owned()),
        library: Some(path.with_file_name("elements")),
        dead_man: Some(env!("CARGO_BIN_EXE_azel").into()),
        ..Settings::default()
    };
    Harness::builder()
        .with_size(rig::LARGE)
        .build_eframe(move |cc| change(App::new(&cc.egui_ctx, &settings, outside).unwrap()))
}

/// Opens Operate on the demo station, once its antennas are there.
pub(crate) fn open_demo(folder: &tempfile::TempDir) -> RealWindow {
    let mut window = open(&folder.path().join("station.toml"), Clock::system());
    step_until(&mut window, "the set-up and the antennas", |model| {
        model.antennas.len() == 3 && model.view == View::Setup
    });
    window.get_by_role_and_label(Role::Button, "Stay in the demo").click();
    step_until(&mut window, "the demonstration", |model| model.view == View::Operate);
    window
}

/// Runs frames until the condition holds.
pub(crate) fn step_until(window: &mut RealWindow, what: &str, is_so: impl Fn(&Model) -> bool) {
    wait_until(what, || {
        window.step();
        is_so(window.state().model())
    });
}

/// Waits until the condition holds. Only this function sleeps, because real sockets need waiting.
pub(crate) fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !is_so() {
        assert!(Instant::now() < end, "not in time: {what}");
        thread::sleep(Duration::from_millis(10));
    }
}
