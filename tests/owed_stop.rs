//! Owed STOPs of a unit. After any change to the antenna in the settings, the STOP goes out first
//! on the next link. The tests use real sockets and a relay that cuts the link.

use std::{
    net::SocketAddr,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU32, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

use azel::{
    clock::Clock,
    contract::driver::{Command, LinkState, Snapshot, StopState, Unit},
    driver::{AntennaHandle, Driver},
    plan::Bounds,
    sim::satrak::{Control, Options, Simulator},
    station::{Antenna, Station},
};
use tokio::{
    net::{TcpListener, TcpStream},
    sync::watch,
};

/// Time limit of any wait in these tests.
const PATIENCE: Duration = Duration::from_secs(30);
/// Number of dials after which a closing program has given up delivering its STOP. Azel dials four
/// times a second while it owes a STOP.
const MANY_DIALS: u32 = 16;

/// A simulated unit behind a relay.
struct Scene {
    driver: Driver,
    control: Control,
    relay: SocketAddr,
    is_cut: watch::Sender<bool>,
    /// Number of dials while the relay was cut.
    dials: Arc<AtomicU32>,
    woken: mpsc::Receiver<()>,
    marks: tempfile::TempDir,
    _runtime: tokio::runtime::Runtime,
}

impl Scene {
    fn start() -> Self {
        let runtime = tokio::runtime::Runtime::new().unwrap();
        let any = SocketAddr::from(([127, 0, 0, 1], 0));
        let options = Options::new(Station::default().site, jiff::Timestamp::now());
        let simulator = runtime.block_on(Simulator::bind(any, options)).unwrap();
        let (unit, control) = (simulator.local_addr().unwrap(), simulator.control());
        runtime.spawn(simulator.run());
        let (is_cut, cut) = watch::channel(false);
        let listener = runtime.block_on(TcpListener::bind(any)).unwrap();
        let relay = listener.local_addr().unwrap();
        let dials = Arc::new(AtomicU32::new(0));
        let counted = Arc::clone(&dials);
        runtime.spawn(async move {
            while let Ok((near, _)) = listener.accept().await {
                let mut cut = cut.clone();
                counted.fetch_add(u32::from(*cut.borrow()), Ordering::Relaxed);
                tokio::spawn(async move {
                    if !*cut.borrow_and_update() {
                        tokio::select! {
                            () = copy(near, unit) => {}
                            _ = cut.changed() => {}
                        }
                    }
                });
            }
        });
        let (woke, woken) = mpsc::sync_channel(1);
        let wake = Arc::new(move || {
            let _ = woke.try_send(());
        });
        let marks = tempfile::tempdir().unwrap();
        let driver = Driver::start(Clock::system(), wake)
            .unwrap()
            .guarded_by(Some(env!("CARGO_BIN_EXE_azel").into()))
            .marking_in(Some(marks.path().to_owned()));
        Self { driver, control, relay, is_cut, dials, woken, marks, _runtime: runtime }
    }

    fn antenna(&self) -> Antenna {
        Antenna::satrak("Dish", &self.relay.to_string())
    }

    fn open(&self, antenna: &Antenna) -> AntennaHandle {
        self.driver.open(
            antenna,
            Bounds::of_antenna(antenna),
            Default::default(),
            None,
            Box::new(()),
        )
    }

    fn until(&self, handle: &AntennaHandle, what: &str, is_so: impl Fn(&Snapshot) -> bool) {
        let since = Instant::now();
        while !is_so(&handle.snapshot()) {
            assert!(since.elapsed() < PATIENCE, "not in time: {what} {:?}", handle.snapshot());
            // The change may have come before this wait.
            let _ = self.woken.recv_timeout(Duration::from_millis(50));
        }
    }

    /// Holds a jog key until the antenna moves, then cuts the link.
    fn cut_in_a_jog(&self, handle: &AntennaHandle) {
        self.until(handle, "all is read", |shown| shown.state.motion_lock == Some(false));
        handle.send(Command::Manual).unwrap();
        let is_held = AtomicBool::new(true);
        thread::scope(|scope| {
            let hold = || {
                while is_held.load(Ordering::Relaxed) {
                    let _ = handle.send(Command::Jog { rates_deg_s: [1.0, 0.0] });
                    thread::park_timeout(Duration::from_millis(50));
                }
            };
            thread::Builder::new().name("key".to_owned()).spawn_scoped(scope, hold).unwrap();
            self.until(handle, "it moves", |shown| {
                shown.state.measured.is_some_and(|measured| measured.moving())
            });
            assert_eq!(self.marks.path().read_dir().unwrap().count(), 1, "marked on disk");
            self.is_cut.send(true).unwrap();
            self.until(handle, "the link is lost", |shown| {
                matches!(shown.link, LinkState::Lost { .. })
            });
            is_held.store(false, Ordering::Relaxed);
        });
        handle.send(Command::EndJog).unwrap();
        handle.stop();
        self.until(handle, "STOP is owed", |shown| {
            matches!(shown.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. })
        });
    }

    /// Returns the orders that the unit has received after its first `before` frames, without
    /// questions.
    fn orders_since(&self, before: usize) -> Vec<String> {
        let received = self.control.received().into_iter().skip(before);
        received.map(|(_, frame)| frame).filter(|frame| !frame.contains('?')).collect()
    }
}

async fn copy(mut near: TcpStream, unit: SocketAddr) {
    if let Ok(mut far) = TcpStream::connect(unit).await {
        // Ignore errors: they mean a broken link.
        let _ = tokio::io::copy_bidirectional(&mut near, &mut far).await;
    }
}

#[test]
fn an_owed_stop_survives_settings_that_are_saved_while_the_link_is_down() {
    let scene = Scene::start();
    let handle = scene.open(&scene.antenna());
    scene.cut_in_a_jog(&handle);
    let before = scene.control.received().len();
    assert!(scene.control.state().is_moving, "the unit goes on by itself");

    drop(handle);
    let changed = Antenna { beam_width_deg: 0.9, name: "Renamed".to_owned(), ..scene.antenna() };
    let handle = scene.open(&changed);
    assert!(scene.driver.debts().owes(&Unit::new(&changed)));
    scene.is_cut.send(false).unwrap();
    scene.until(&handle, "standstill is proved", |shown| {
        matches!(shown.stop, StopState::Stopped { .. })
    });
    assert_eq!(scene.orders_since(before).first().map(String::as_str), Some("STOP="));
    assert!(!scene.control.state().is_moving);
    assert_eq!(scene.driver.debts().units(), []);
}

#[test]
fn that_a_unit_is_not_known_to_stand_outlives_a_change_of_its_settings() {
    let scene = Scene::start();
    let handle = scene.open(&scene.antenna());
    scene.until(&handle, "all is read", |shown| shown.state.motion_lock == Some(false));
    handle.send(Command::Hold).unwrap();
    let elevation = Some(azel::astro::Angle::from_degrees(30.0));
    handle.send(Command::Position { azimuth: None, elevation }).unwrap();
    scene.until(&handle, "it moves", |shown| {
        shown.state.measured.is_some_and(|measured| measured.moving())
    });
    handle.send(Command::Disconnect).unwrap();
    scene.until(&handle, "let go of", |shown| shown.link == LinkState::Off);
    assert!(handle.snapshot().unproved && handle.stopper().is_wanted());
    // The unit is out of reach, so nothing can prove that it stands.
    scene.is_cut.send(true).unwrap();
    drop(handle);
    let handle = scene.open(&Antenna { beam_width_deg: 0.9, ..scene.antenna() });
    scene.until(&handle, "it is known to the next session", |shown| shown.unproved);
    assert!(handle.stopper().is_wanted(), "STOP of the station is for it too");
}

#[test]
fn an_owed_stop_is_paid_to_a_unit_that_was_taken_out_of_the_settings() {
    let scene = Scene::start();
    let handle = scene.open(&scene.antenna());
    scene.cut_in_a_jog(&handle);
    let before = scene.control.received().len();
    drop(handle);
    let (since, dials) = (Instant::now(), scene.dials.load(Ordering::Relaxed));
    while scene.dials.load(Ordering::Relaxed) < dials + MANY_DIALS {
        assert!(since.elapsed() < PATIENCE, "it is not dialled any more");
        thread::park_timeout(Duration::from_millis(20));
    }
    scene.is_cut.send(false).unwrap();
    let since = Instant::now();
    while !scene.driver.debts().units().is_empty() {
        assert!(since.elapsed() < PATIENCE, "{:?}", scene.orders_since(before));
        thread::park_timeout(Duration::from_millis(20));
    }
    assert_eq!(scene.orders_since(before).first().map(String::as_str), Some("STOP="));
    assert!(!scene.control.state().is_moving);
}

#[test]
fn a_mark_of_an_earlier_run_makes_stop_the_first_word() {
    let scene = Scene::start();
    let handle = scene.open(&scene.antenna());
    scene.cut_in_a_jog(&handle);
    // Simulate the end of that program, which leaves only its mark.
    let left = std::fs::read_dir(scene.marks.path()).unwrap().next().unwrap().unwrap();
    let mark = std::fs::read(left.path()).unwrap();
    drop(handle);
    scene.is_cut.send(false).unwrap();
    let since = Instant::now();
    // A separate thread removes the mark after the debt.
    let is_marked = || scene.marks.path().read_dir().unwrap().count() > 0;
    while is_marked() || !scene.driver.debts().units().is_empty() {
        assert!(since.elapsed() < PATIENCE);
        thread::park_timeout(Duration::from_millis(20));
    }
    let Scene { driver, control, relay, woken: _, marks, .. } = &scene;
    let _ = driver;
    std::fs::write(left.path(), mark).unwrap();
    let before = control.received().len();
    let (woke, woken) = mpsc::sync_channel(1);
    let wake = Arc::new(move || {
        let _ = woke.try_send(());
    });
    let next =
        Driver::start(Clock::system(), wake).unwrap().marking_in(Some(marks.path().to_owned()));
    let antenna = Antenna::satrak("Dish", &relay.to_string());
    let handle =
        next.open(&antenna, Bounds::of_antenna(&antenna), Default::default(), None, Box::new(()));
    let since = Instant::now();
    while !matches!(handle.snapshot().stop, StopState::Stopped { .. }) {
        assert!(since.elapsed() < PATIENCE, "{:?}", handle.snapshot());
        let _ = woken.recv_timeout(Duration::from_millis(50));
    }
    assert_eq!(scene.orders_since(before).first().map(String::as_str), Some("STOP="));
    let since = Instant::now();
    while marks.path().read_dir().unwrap().count() > 0 {
        assert!(since.elapsed() < PATIENCE, "the mark stays");
        thread::park_timeout(Duration::from_millis(20));
    }
}
