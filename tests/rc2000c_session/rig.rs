//! A session and a simulated unit with a stream in memory between them.

use std::{
    io,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::Duration,
};

use azel::{
    clock::Clock,
    controller::rc2000c::Calibration,
    device::{
        panel::{Act, CheckState},
        settings::Value,
    },
    driver::{AntennaHandle, Command, Dial, Event, Found, Session, Snapshot, Stream},
    sim::rc2000c::{Control, Options},
    station::{Antenna, CountPoint, Mount},
};
use jiff::Timestamp;
use tokio::time::{Instant, sleep};

/// How finely the operator looks.
const LOOK: Duration = Duration::from_millis(10);
/// No test needs more readings of the clock than this.
const MOST_READINGS: u64 = 2_000_000;

/// An operator in front of a running session.
pub(super) struct Rig {
    pub(super) control: Control,
    handle: Option<AntennaHandle>,
    session: tokio::task::JoinHandle<()>,
    events: Vec<Event>,
    is_off: Arc<AtomicBool>,
    dials: Arc<Mutex<Vec<Instant>>>,
}

/// An antenna of twenty counts a degree, as the simulated one is: azimuth 90 to
/// 270 degrees, elevation 0 to 90.
pub(super) fn antenna() -> Antenna {
    let point = |counts, degrees| CountPoint { counts, degrees };
    let calibration = Calibration {
        azimuth: vec![point(30, 90.0), point(3630, 270.0)],
        elevation: vec![point(30, 0.0), point(1830, 90.0)],
    };
    Antenna {
        mount: Mount::AzEl {
            azimuth_from_deg: 90.0,
            azimuth_to_deg: 270.0,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        },
        ..with_calibration(calibration)
    }
}

/// An antenna whose counts mean nothing yet.
pub(super) fn uncalibrated() -> Antenna {
    with_calibration(Calibration::default())
}

fn with_calibration(calibration: Calibration) -> Antenna {
    let mut antenna = Antenna::rc2000c("Dish", "in memory");
    calibration.put_into(&mut antenna.connection).unwrap();
    antenna
}

/// The session of `antenna` over links from `dial`, and its near end.
pub(super) fn session(antenna: &Antenna, dial: Dial) -> (Session, AntennaHandle) {
    let started = Instant::now();
    let readings = AtomicU64::new(0);
    let clock = Clock::new(move || {
        // In paused time a loop that never sleeps would go on for ever.
        assert!(readings.fetch_add(1, Ordering::Relaxed) < MOST_READINGS, "a busy loop");
        Timestamp::UNIX_EPOCH + started.elapsed()
    });
    Session::new(antenna.controller(), antenna, dial, clock, Arc::new(|| {}))
}

impl Rig {
    /// A running session that nobody has told to connect.
    pub(super) fn start(options: &Options, antenna: &Antenna) -> Self {
        let control = Control::new(options);
        let is_off = Arc::new(AtomicBool::new(false));
        let dials = Arc::new(Mutex::new(Vec::new()));
        let dial: Dial = {
            let (control, is_off, dials) = (control.clone(), is_off.clone(), dials.clone());
            Box::new(move || {
                dials.lock().unwrap().push(Instant::now());
                if is_off.load(Ordering::Relaxed) {
                    return Box::pin(async { Err(io::ErrorKind::ConnectionRefused.into()) });
                }
                let (near, far) = tokio::io::duplex(4096);
                let control = control.clone();
                tokio::spawn(async move { control.serve(far).await });
                Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
            })
        };
        let (session, handle) = session(antenna, dial);
        Self {
            control,
            handle: Some(handle),
            session: tokio::spawn(session.run()),
            events: Vec::new(),
            is_off,
            dials,
        }
    }

    /// A session that has read its unit and the list of satellites; all stands.
    pub(super) async fn connected(options: &Options, antenna: &Antenna) -> Self {
        let mut rig = Self::start(options, antenna);
        rig.send(Command::Connect);
        let is_read = |shown: &Snapshot| {
            reading(shown, "Stored satellites").is_some_and(|text| !text.ends_with('…'))
        };
        rig.until("the list is read", 20, is_read).await;
        rig.seconds(1.0).await;
        rig.events();
        rig
    }

    /// The usual unit and antenna, in the hands of the operator.
    pub(super) async fn in_manual() -> Self {
        let mut rig = Self::connected(&Options::default(), &antenna()).await;
        rig.send(Command::Manual);
        rig.seconds(0.1).await;
        rig
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.as_ref().unwrap().snapshot()
    }

    pub(super) fn wire(&self) -> &azel::driver::WireLog {
        self.handle.as_ref().unwrap().wire()
    }

    pub(super) fn send(&self, command: Command) {
        self.handle.as_ref().unwrap().send(command).unwrap();
    }

    pub(super) fn act<const N: usize>(
        &self,
        action: &'static str,
        values: [(&'static str, Value); N],
    ) {
        self.send(Command::Act(Act { action, values: values.into_iter().collect() }));
    }

    /// The same, with the operator's word that it may lead anywhere.
    pub(super) fn act_unseen<const N: usize>(
        &self,
        action: &'static str,
        values: [(&'static str, Value); N],
    ) {
        self.send(Command::ActUnseen(Act { action, values: values.into_iter().collect() }));
    }

    pub(super) fn stop(&self) {
        self.handle.as_ref().unwrap().stop();
    }

    /// The window is gone.
    pub(super) async fn drop_handle(&mut self) {
        drop(self.handle.take());
        (&mut self.session).await.unwrap();
        // The far end reads what was written last.
        sleep(LOOK).await;
    }

    /// Switches the network of the unit on or off; the metal goes on.
    pub(super) fn set_off(&self, is_off: bool) {
        self.is_off.store(is_off, Ordering::Relaxed);
        if is_off {
            self.control.drop_clients();
        }
    }

    /// How often the link was dialled.
    pub(super) fn dials(&self) -> usize {
        self.dials.lock().unwrap().len()
    }

    fn collect(&mut self) {
        if let Some(handle) = &mut self.handle {
            self.events.extend(std::iter::from_fn(|| handle.next_event()));
        }
    }

    /// The events since the last call.
    pub(super) fn events(&mut self) -> Vec<Event> {
        self.collect();
        std::mem::take(&mut self.events)
    }

    pub(super) async fn seconds(&mut self, seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            sleep(LOOK.min(end - Instant::now())).await;
            self.collect();
        }
    }

    /// Waits until it is shown; `limit_s` seconds at most.
    pub(super) async fn until(
        &mut self,
        what: &str,
        limit_s: u64,
        is_so: impl Fn(&Snapshot) -> bool,
    ) {
        let end = Instant::now() + Duration::from_secs(limit_s);
        while !is_so(&self.shown()) {
            assert!(Instant::now() < end, "not within {limit_s} s: {what}\n{}", self.report());
            sleep(LOOK).await;
            self.collect();
        }
    }

    /// Waits for an event and takes all up to it.
    pub(super) async fn until_event(
        &mut self,
        limit_s: u64,
        is_it: impl Fn(&Event) -> bool,
    ) -> Event {
        let end = Instant::now() + Duration::from_secs(limit_s);
        loop {
            self.collect();
            if let Some(at) = self.events.iter().position(&is_it) {
                return self.events.drain(..=at).next_back().unwrap();
            }
            assert!(Instant::now() < end, "no such event\n{}", self.report());
            sleep(LOOK).await;
        }
    }

    pub(super) async fn until_found(&mut self) {
        let is_found =
            |event: &Event| matches!(event, Event::Connected(Found::Still) | Event::Back { .. });
        self.until_event(12, is_found).await;
    }

    /// Keeps a jog key down.
    pub(super) async fn hold(&mut self, rates_deg_s: [f64; 2], seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            self.send(Command::Jog { rates_deg_s });
            self.seconds(0.1).await;
        }
    }

    /// All that the unit received, as code and data: `1` is the question for the
    /// status.
    pub(super) fn received(&self) -> Vec<String> {
        self.timed().into_iter().map(|(_, text)| text).collect()
    }

    /// What the unit received beyond questions.
    pub(super) fn orders(&self) -> Vec<String> {
        let is_order = |text: &String| !text.starts_with(['0', '1', '5']);
        self.received().into_iter().filter(is_order).collect()
    }

    /// When commands that begin so came in.
    pub(super) fn times(&self, start: &str) -> Vec<Instant> {
        let timed = self.timed().into_iter();
        timed.filter(|(_, text)| text.starts_with(start)).map(|(at, _)| at).collect()
    }

    fn timed(&self) -> Vec<(Instant, String)> {
        let text = |frame: &azel::protocol::rc2000c::Frame| {
            let data = String::from_utf8_lossy(frame.data());
            format!("{}{data}", char::from(frame.code()))
        };
        self.control.received().iter().map(|(at, frame)| (*at, text(frame))).collect()
    }

    /// Where the axes stand, in counts.
    pub(super) fn counts(&self) -> [u16; 2] {
        let state = self.control.state();
        [state.az_counts, state.el_counts]
    }

    fn report(&self) -> String {
        let received = self.timed();
        let last = received.iter().rev().take(40).rev();
        let lines: Vec<String> = last.map(|(at, text)| format!("{at:?} {text}")).collect();
        format!("{:#?}\nevents {:?}\n{}", self.shown(), self.events, lines.join("\n"))
    }
}

/// The text of a line of the panel.
pub(super) fn reading(shown: &Snapshot, label: &str) -> Option<String> {
    let lines = shown.state.readings.iter();
    lines.filter(|line| line.label == label).map(|line| line.text.clone()).next()
}

/// How a checked thing is.
pub(super) fn check(shown: &Snapshot, name: &str) -> Option<CheckState> {
    shown.state.checks.iter().find(|check| check.name == name).map(|check| check.state)
}
