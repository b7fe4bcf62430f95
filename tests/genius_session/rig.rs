//! A session and a simulated device with a stream in memory between them.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::Duration,
};

use azel::{
    astro::{Angle, time},
    clock::Clock,
    controller::rotator_genius::{ROTATORS, Rotators},
    driver::{
        AntennaHandle, Command, Dial, Event, LinkState, Session, Snapshot, StopState, Stream,
    },
    protocol::rotator_genius::WholeDegrees,
    sim::rotator_genius::{Control, Options, RotatorOptions, RotatorState},
    station::Antenna,
};
use jiff::Timestamp;
use tokio::time::{Instant, sleep};

/// How finely the operator looks.
const LOOK: Duration = Duration::from_millis(10);
/// No test needs more readings of the clock than this.
const MOST_READINGS: u64 = 2_000_000;

/// An antenna whose device turns what `rotators` says.
pub(super) fn antenna(rotators: Rotators) -> Antenna {
    let mut antenna = Antenna::genius("Mast", "in memory");
    antenna.connection.put(&ROTATORS, rotators).unwrap();
    antenna
}

/// An azimuth rotator at 173 degrees and an elevation one at the horizon.
pub(super) fn pair() -> Options {
    Options {
        rotators: [RotatorOptions::default(), RotatorOptions::elevation()],
        ..Options::default()
    }
}

/// An azimuth rotator of this name, where it is.
pub(super) fn azimuth(name: &str, position: u16) -> RotatorOptions {
    RotatorOptions {
        name: name.to_owned(),
        position: WholeDegrees::new(position).unwrap(),
        ..RotatorOptions::default()
    }
}

/// A position to be sent to; `None` leaves that angle.
pub(super) fn to(azimuth_deg: Option<f64>, elevation_deg: Option<f64>) -> Command {
    Command::Position {
        azimuth: azimuth_deg.map(Angle::from_degrees),
        elevation: elevation_deg.map(Angle::from_degrees),
    }
}

pub(super) fn is_stopping(stop: StopState) -> bool {
    matches!(stop, StopState::Stopping { .. })
}

/// The session of `antenna` over links from `dial`, and its near end.
pub(super) fn session(antenna: &Antenna, dial: Dial) -> (Session, AntennaHandle) {
    let readings = AtomicU64::new(0);
    let started = Instant::now();
    let clock = Clock::new(move || {
        // In paused time a loop that never sleeps would go on for ever.
        assert!(readings.fetch_add(1, Ordering::Relaxed) < MOST_READINGS, "a busy loop");
        time::add_seconds(Timestamp::UNIX_EPOCH, started.elapsed().as_secs_f64())
    });
    Session::new(antenna.controller(), antenna, dial, clock, Arc::new(|| {}))
}

/// An operator in front of a running session.
pub(super) struct Rig {
    pub(super) control: Control,
    pub(super) handle: Option<AntennaHandle>,
    session: tokio::task::JoinHandle<()>,
    events: Vec<Event>,
    is_off: Arc<AtomicBool>,
    pub(super) started: Instant,
}

impl Rig {
    /// A running session, not connected yet.
    pub(super) fn start(options: &Options, antenna: &Antenna) -> Self {
        let control = Control::new(options);
        let is_off = Arc::new(AtomicBool::new(false));
        let dial: Dial = {
            let (control, is_off) = (control.clone(), is_off.clone());
            Box::new(move || {
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
            started: Instant::now(),
        }
    }

    /// A session that has read its device.
    pub(super) async fn connected(options: &Options, rotators: Rotators) -> Self {
        let mut rig = Self::start(options, &antenna(rotators));
        rig.until("it is read", 5, |shown| shown.state.measured.is_some()).await;
        rig.seconds(0.1).await;
        rig.events();
        rig
    }

    /// The usual pair.
    pub(super) async fn pair() -> Self {
        Self::connected(&pair(), Rotators::Pair).await
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.as_ref().unwrap().snapshot()
    }

    pub(super) fn send(&self, command: Command) {
        self.handle.as_ref().unwrap().send(command).unwrap();
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

    /// Switches the device's network on or off; the metal goes on.
    pub(super) fn set_off(&self, is_off: bool) {
        self.is_off.store(is_off, Ordering::Relaxed);
        if is_off {
            self.control.drop_clients();
        }
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

    /// Waits for an event.
    pub(super) async fn until_event(
        &mut self,
        limit_s: u64,
        is_it: impl Fn(&Event) -> bool,
    ) -> Event {
        let end = Instant::now() + Duration::from_secs(limit_s);
        loop {
            self.collect();
            if let Some(at) = self.events.iter().position(&is_it) {
                return self.events.remove(at);
            }
            assert!(Instant::now() < end, "no such event\n{}", self.report());
            sleep(LOOK).await;
        }
    }

    pub(super) async fn until_up(&mut self, limit_s: u64) {
        self.until("up", limit_s, |shown| matches!(shown.link, LinkState::Up { .. })).await;
    }

    pub(super) async fn until_still(&mut self, limit_s: u64) {
        let stands = |shown: &Snapshot| shown.state.measured.is_some_and(|it| !it.moving());
        self.until("it stands", limit_s, stands).await;
    }

    /// Keeps a jog key down.
    pub(super) async fn hold(&mut self, rates_deg_s: [f64; 2], seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            self.send(Command::Jog { rates_deg_s });
            self.seconds(0.1).await;
        }
    }

    /// What is shown of the two axes, degrees.
    pub(super) fn axes_deg(&self) -> [Option<f64>; 2] {
        self.shown().state.measured.unwrap().axes.map(|axis| axis.angle_deg)
    }

    /// What is shown of a reading.
    pub(super) fn reading(&self, label: &str) -> String {
        let shown = self.shown();
        let reading = shown.state.readings.iter().find(|reading| reading.label == label);
        reading.map_or_else(String::new, |reading| reading.text.clone())
    }

    /// Where a rotator truly is; 1 or 2.
    pub(super) fn rotator(&self, number: usize) -> RotatorState {
        self.control.state().rotators[number - 1]
    }

    /// All commands that the device received, without the questions. A stop is
    /// sent again until it is proved, and stands here once.
    pub(super) fn orders(&self) -> Vec<String> {
        let mut orders = self.commands();
        orders.retain(|command| command != "|h");
        orders.dedup_by(|a, b| a == b && a == "|S");
        orders
    }

    /// All commands that the device received.
    pub(super) fn commands(&self) -> Vec<String> {
        self.control.received().into_iter().map(|(_, command)| command).collect()
    }

    /// When this command came in.
    pub(super) fn times(&self, command: &str) -> Vec<Instant> {
        let received = self.control.received().into_iter();
        received.filter(|(_, other)| other == command).map(|(at, _)| at).collect()
    }

    fn report(&self) -> String {
        let commands = self.control.received();
        let last = commands.iter().rev().take(40).rev();
        let lines: Vec<String> = last
            .map(|(at, command)| format!("{:?} {command}", at.duration_since(self.started)))
            .collect();
        format!("{:#?}\nevents {:?}\n{}", self.shown(), self.events, lines.join("\n"))
    }
}
