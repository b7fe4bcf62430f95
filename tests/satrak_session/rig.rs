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
    driver::{AntennaHandle, Command, Dial, Event, LinkState, Snapshot, Stream, WireLog},
    plan::on_board::KnownOrbit,
    sim::satrak::{Control, Options},
    station::{Antenna, LockOut},
};
use jiff::Timestamp;
use tokio::time::{Instant, sleep};

pub(super) use super::scene::{antenna, iss, options, track, twin};
use super::scene::{orbit, session};

/// How finely the operator looks.
const LOOK: Duration = Duration::from_millis(10);

/// An operator in front of a running session.
pub(super) struct Rig {
    pub(super) control: Control,
    handle: Option<AntennaHandle>,
    session: tokio::task::JoinHandle<()>,
    events: Vec<Event>,
    is_off: Arc<AtomicBool>,
    clock_readings: Arc<AtomicU64>,
    dials: Arc<Mutex<Vec<Instant>>>,
    pub(super) started: Instant,
}

/// A link that the unit serves.
pub(super) fn plain_link(control: &Control) -> Box<dyn Stream> {
    let (near, far) = tokio::io::duplex(4096);
    let control = control.clone();
    tokio::spawn(async move { control.serve(far).await });
    Box::new(near)
}

impl Rig {
    /// A running session, not connected yet.
    pub(super) fn start(options: &Options, antenna: &Antenna) -> Self {
        Self::start_locked_out(options, antenna, None)
    }

    /// The same with a unit that may be locked out already.
    pub(super) fn start_locked_out(
        options: &Options,
        antenna: &Antenna,
        lock_out: Option<LockOut>,
    ) -> Self {
        let control = Control::new(options);
        Self::start_over(control, options.utc_origin, antenna, lock_out, plain_link)
    }

    /// The same on a unit that runs already, each link as `link` makes it.
    pub(super) fn start_over(
        control: Control,
        utc_origin: Timestamp,
        antenna: &Antenna,
        lock_out: Option<LockOut>,
        mut link: impl FnMut(&Control) -> Box<dyn Stream> + Send + 'static,
    ) -> Self {
        let is_off = Arc::new(AtomicBool::new(false));
        let dials = Arc::new(Mutex::new(Vec::new()));
        let dial: Dial = {
            let (control, is_off, dials) = (control.clone(), is_off.clone(), dials.clone());
            Box::new(move || {
                dials.lock().unwrap().push(Instant::now());
                if is_off.load(Ordering::Relaxed) {
                    return Box::pin(async { Err(io::ErrorKind::ConnectionRefused.into()) });
                }
                let near = link(&control);
                Box::pin(async { Ok(near) })
            })
        };
        let clock_readings = Arc::default();
        let (session, handle) = session(antenna, dial, utc_origin, Arc::clone(&clock_readings));
        handle.know_orbit(Some(orbit(25_544)));
        Self {
            control,
            handle: Some(handle),
            session: tokio::spawn(session.locked_out(lock_out).run()),
            events: Vec::new(),
            is_off,
            clock_readings,
            dials,
            started: Instant::now(),
        }
    }

    /// A session that has read its unit: everything is known, all stands.
    pub(super) async fn connected(options: &Options, antenna: &Antenna) -> Self {
        let mut rig = Self::start(options, antenna);
        rig.until("all is read", 5, |shown| shown.state.on_board.offsets.is_some()).await;
        rig.events();
        rig
    }

    /// The usual unit and antenna.
    pub(super) async fn usual() -> Self {
        Self::connected(&options(), &antenna()).await
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.as_ref().unwrap().snapshot()
    }

    pub(super) fn wire(&self) -> &WireLog {
        self.handle.as_ref().unwrap().wire()
    }

    pub(super) fn send(&self, command: Command) {
        self.handle.as_ref().unwrap().send(command).unwrap();
    }

    /// By which orbit the session judges what the unit does by itself.
    pub(super) fn know_orbit(&self, orbit: Option<Arc<KnownOrbit>>) {
        self.handle.as_ref().unwrap().know_orbit(orbit);
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

    /// How often the session has looked at its clock.
    pub(super) fn clock_readings(&self) -> u64 {
        self.clock_readings.load(Ordering::Relaxed)
    }

    /// Switches the unit's network on or off; the metal goes on.
    pub(super) fn set_off(&self, is_off: bool) {
        self.is_off.store(is_off, Ordering::Relaxed);
        if is_off {
            self.control.drop_clients();
        }
    }

    /// When the link was dialled.
    pub(super) fn dials(&self) -> Vec<Instant> {
        self.dials.lock().unwrap().clone()
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

    /// Waits for an event and takes all up to now.
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

    /// Keeps a jog key down.
    pub(super) async fn hold(&mut self, rates_deg_s: [f64; 2], seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            self.send(Command::Jog { rates_deg_s });
            self.seconds(0.1).await;
        }
    }

    /// All payloads that the unit received, without the questions.
    pub(super) fn orders(&self) -> Vec<String> {
        self.payloads().into_iter().filter(|payload| payload.contains('=')).collect()
    }

    /// All payloads that the unit received.
    pub(super) fn payloads(&self) -> Vec<String> {
        self.control.received().into_iter().map(|(_, payload)| payload).collect()
    }

    /// The near end of the session.
    pub(super) fn handle(&self) -> &AntennaHandle {
        self.handle.as_ref().unwrap()
    }

    /// The received payloads with this word.
    pub(super) fn sent(&self, word: &str) -> Vec<String> {
        self.payloads().into_iter().filter(|payload| payload.starts_with(word)).collect()
    }

    /// When payloads with this word came in.
    pub(super) fn times(&self, word: &str) -> Vec<Instant> {
        let received = self.control.received().into_iter();
        received.filter(|(_, payload)| payload.starts_with(word)).map(|(at, _)| at).collect()
    }

    fn report(&self) -> String {
        let orders = self.control.received();
        let last = orders.iter().rev().take(40).rev();
        let lines: Vec<String> = last
            .map(|(at, payload)| format!("{:?} {payload}", at.duration_since(self.started)))
            .collect();
        format!("{:#?}\nevents {:?}\n{}", self.shown(), self.events, lines.join("\n"))
    }
}
