//! An operator in front of a running session, with a simulated controller at the
//! other end of a stream in memory.

use std::{
    future::Future,
    io,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering},
    },
    time::Duration,
};

use azel::{
    astro::time::add_seconds,
    clock::Clock,
    device::Moves,
    driver::{AntennaHandle, Command, Dial, Event, Session, Snapshot, Stream},
    plan::{FollowPhase, FollowStats},
    station::Antenna,
};
use jiff::Timestamp;
use tokio::{
    io::DuplexStream,
    sync::watch,
    time::{Instant, sleep},
};

/// How finely the operator looks.
const LOOK: Duration = Duration::from_millis(20);
/// No test needs more readings of the clock than this.
const MOST_READINGS: u64 = 4_000_000;

/// A running session.
pub(super) struct Rig {
    handle: AntennaHandle,
    events: Vec<Event>,
    is_off: Arc<AtomicBool>,
    set_by_s: Arc<AtomicI64>,
    asleep_s: Arc<AtomicU64>,
    /// Changes when the link is to break.
    breaks: watch::Sender<u32>,
    utc_origin: Timestamp,
    started: Instant,
}

impl Rig {
    /// A session of `antenna` that begins at `utc_origin`; `serve` answers a new
    /// link.
    pub(super) fn start<Served>(
        controller: Box<dyn Moves>,
        antenna: &Antenna,
        utc_origin: Timestamp,
        serve: impl Fn(DuplexStream) -> Served + Send + 'static,
    ) -> Self
    where
        Served: Future<Output = io::Result<()>> + Send + 'static,
    {
        let started = Instant::now();
        let is_off = Arc::new(AtomicBool::new(false));
        let breaks = watch::Sender::new(0);
        let dial: Dial = {
            let (is_off, breaks) = (Arc::clone(&is_off), breaks.clone());
            Box::new(move || {
                if is_off.load(Ordering::Relaxed) {
                    return Box::pin(async { Err(io::ErrorKind::ConnectionRefused.into()) });
                }
                let (near, far) = tokio::io::duplex(4096);
                let served = serve(far);
                let mut broken = breaks.subscribe();
                tokio::spawn(async move {
                    tokio::select! {
                        // An error is a link that broke.
                        _ = served => {}
                        _ = broken.changed() => {}
                    }
                });
                Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
            })
        };
        let readings = AtomicU64::new(0);
        let (set_by_s, asleep_s) = (Arc::new(AtomicI64::new(0)), Arc::new(AtomicU64::new(0)));
        let (offset_s, slept_s) = (Arc::clone(&set_by_s), Arc::clone(&asleep_s));
        let clock = Clock::new(move || {
            // In paused time a loop that never sleeps would go on for ever.
            assert!(readings.fetch_add(1, Ordering::Relaxed) < MOST_READINGS, "a busy loop");
            let offset_s = offset_s.load(Ordering::Relaxed) as f64;
            add_seconds(utc_origin, started.elapsed().as_secs_f64() + offset_s)
        });
        let clock = clock.sleeping(move || Duration::from_secs(slept_s.load(Ordering::Relaxed)));
        let (session, handle) = Session::new(controller, antenna, dial, clock, Arc::new(|| {}));
        tokio::spawn(session.run());
        Self { handle, events: Vec::new(), is_off, breaks, set_by_s, asleep_s, utc_origin, started }
    }

    /// Sets the clock of the computer ahead of the right time by so many seconds.
    pub(super) fn set_clock(&self, by_s: i64) {
        self.set_by_s.store(by_s, Ordering::Relaxed);
    }

    /// The computer sleeps: UTC goes on meanwhile, the steady clock stands.
    pub(super) fn sleep_for(&self, seconds: u32) {
        self.set_by_s.fetch_add(i64::from(seconds), Ordering::Relaxed);
        self.asleep_s.fetch_add(u64::from(seconds), Ordering::Relaxed);
    }

    pub(super) fn utc(&self) -> Timestamp {
        add_seconds(self.utc_origin, self.started.elapsed().as_secs_f64())
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.snapshot()
    }

    pub(super) fn send(&self, command: Command) {
        self.handle.send(command).unwrap();
    }

    pub(super) fn stop(&self) {
        self.handle.stop();
    }

    /// Breaks the link, for as long as it is off.
    pub(super) fn set_off(&self, is_off: bool) {
        self.is_off.store(is_off, Ordering::Relaxed);
        self.breaks.send_modify(|count| *count += 1);
    }

    fn collect(&mut self) {
        self.events.extend(std::iter::from_fn(|| self.handle.next_event()));
    }

    /// The events since the last call.
    pub(super) fn events(&mut self) -> Vec<Event> {
        self.collect();
        std::mem::take(&mut self.events)
    }

    pub(super) async fn seconds(&mut self, seconds: f64) {
        sleep(Duration::try_from_secs_f64(seconds).unwrap()).await;
        self.collect();
    }

    pub(super) async fn until_utc(&mut self, time: Timestamp) {
        let left_s = azel::astro::time::seconds_between(self.utc(), time);
        self.seconds(left_s.max(0.0)).await;
    }

    /// Waits until it is shown; `limit_s` seconds at most.
    pub(super) async fn until(
        &mut self,
        what: &str,
        limit_s: f64,
        is_so: impl Fn(&Snapshot) -> bool,
    ) {
        let end = Instant::now() + Duration::try_from_secs_f64(limit_s).unwrap();
        while !is_so(&self.shown()) {
            self.collect();
            assert!(
                Instant::now() < end,
                "not within {limit_s} s: {what}\n{:#?}\n{:?}",
                self.shown(),
                self.events
            );
            sleep(LOOK).await;
        }
        self.collect();
    }

    /// Waits for an event.
    pub(super) async fn until_event(
        &mut self,
        limit_s: f64,
        is_it: impl Fn(&Event) -> bool,
    ) -> Event {
        let end = Instant::now() + Duration::try_from_secs_f64(limit_s).unwrap();
        loop {
            self.collect();
            if let Some(at) = self.events.iter().position(&is_it) {
                return self.events.remove(at);
            }
            assert!(Instant::now() < end, "no such event: {:?}\n{:#?}", self.events, self.shown());
            sleep(LOOK).await;
        }
    }

    /// Waits for the end of the pass that is followed.
    pub(super) async fn until_over(&mut self) -> FollowStats {
        let is_over = |event: &Event| matches!(event, Event::FollowOver { .. });
        match self.until_event(3000.0, is_over).await {
            Event::FollowOver { stats, .. } => stats,
            other => panic!("{other:?}"),
        }
    }

    /// Where the target is in its passes, as far as one is followed.
    pub(super) fn phase(&self) -> Option<FollowPhase> {
        self.shown().following.as_ref().map(|view| view.phase)
    }
}

/// Prints a line of the table, and gives root mean square and worst error in
/// degrees.
pub(super) fn figures(what: &str, stats: FollowStats) -> (f64, f64) {
    let [rms, worst] = [stats.rms(), stats.worst()].map(|off| off.unwrap().degrees());
    println!("{what:44} | rms {rms:6.3} | worst {worst:7.3} | {:4} commands", stats.commands);
    (rms, worst)
}
