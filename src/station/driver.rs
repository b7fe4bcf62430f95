//! Antenna driver: links, sessions, intents and the gate, on a dedicated thread. The station sends
//! commands and reads snapshots; neither side waits for the other.

mod before_sleep;
pub mod dead_man;
mod debts;
#[cfg(test)]
mod dice;
mod gate;
mod link;
mod link_test;
mod motion_watch;
mod position_log;
mod pulse;
mod session;
mod time_sync;

use std::{
    future::{Future, poll_fn},
    io,
    panic::{self, AssertUnwindSafe},
    path::PathBuf,
    pin::Pin,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    task::Poll,
    thread,
    time::Duration,
};

use tokio::sync::{Notify, mpsc, watch};

use self::{before_sleep::BeforeSleep, pulse::Pulse};
pub use crate::{clock::Clock, job::Wake};
use crate::{
    clock::Instant,
    contract::driver::{AxisLessons, Command, Event, Intent, Safety, Snapshot, TimeSync, WireLog},
    plan::{Bounds, on_board::KnownOrbit},
    station::{Antenna, LockOut},
};
pub use debts::Debts;
pub use link::{Dial, Endpoint, Stream, UnitLock, dial_line, endpoints, known_endpoints};
pub use link_test::test_link;
pub use position_log::PositionLog;
pub use session::{JOG_LEASE, Session, Wires};
pub use time_sync::time_sync;

/// Max number of pending commands. The station sends only a few at a time.
const COMMANDS: usize = 64;
/// Max number of unread events. The oldest alarms matter most, so the session drops further events
/// and counts them in the log.
const EVENTS: usize = 256;
/// Max time that the end of the program waits for the last STOP: as long as a session retries to
/// reach a unit and to see it stand.
const FAREWELL: Duration = Duration::from_secs(6);

/// Longest pause of a session that breaks down repeatedly.
const MAX_REST: Duration = Duration::from_secs(5);

/// Station side of one antenna's session. Dropping this handle ends the session, which stops a jog
/// first.
pub struct AntennaHandle {
    commands: mpsc::Sender<Numbered>,
    stopper: Stopper,
    orders: Orders,
    events: mpsc::Receiver<Event>,
    wire: WireLog,
    positions: PositionLog,
    orbit: Orbits,
    bounds: watch::Sender<Bounds>,
}

/// Counter that numbers the requests to all antennas of a station.
#[derive(Debug, Clone, Default)]
pub struct Orders(Arc<AtomicU64>);

impl Orders {
    /// Returns the next request number.
    pub fn next(&self) -> u64 {
        self.0.fetch_add(1, Ordering::SeqCst) + 1
    }
}

/// Command in the queue of a session.
struct Numbered {
    command: Command,
    /// Number among all requests.
    number: u64,
    /// `true` if the sender waits for the answer in the snapshot.
    wants_answer: bool,
}

/// Handle that stops an antenna past every queue; outlives the session.
#[derive(Clone)]
pub struct Stopper {
    stop: Arc<Notify>,
    /// Highest void request number; requests up to this number are void in every queue.
    void: Arc<AtomicU64>,
    orders: Orders,
    snapshots: watch::Receiver<Arc<Snapshot>>,
}

impl Stopper {
    pub fn stop(&self) {
        self.forget();
        self.stop.notify_one();
    }

    /// Voids all requests made so far, in every queue.
    pub fn forget(&self) {
        self.void.fetch_max(self.orders.next(), Ordering::SeqCst);
    }

    /// Returns `true` if the request with this number is void.
    pub fn is_void(&self, number: u64) -> bool {
        number <= self.void.load(Ordering::SeqCst)
    }

    /// Returns `true` if Azel tracks with the antenna or is about to.
    pub fn tracks(&self) -> bool {
        self.snapshots.borrow().intent == Intent::Track
    }

    /// Returns `true` if a STOP of the whole station includes this antenna.
    pub fn is_wanted(&self) -> bool {
        self.snapshots.borrow().wants_stop()
    }
}

/// Orbit of the satellite on the unit. The channel outlives a session that breaks down, and
/// bypasses the command queue, which may be full.
type Orbits = Arc<watch::Sender<Option<Arc<KnownOrbit>>>>;

impl AntennaHandle {
    pub fn stop(&self) {
        self.stopper.stop();
    }

    /// Returns a handle that stops the antenna from any thread.
    pub fn stopper(&self) -> Stopper {
        self.stopper.clone()
    }

    pub fn orders(&self) -> &Orders {
        &self.orders
    }

    /// Sends a command. The error returns the command if the session is too busy; the caller must
    /// then inform the operator.
    pub fn send(&self, command: Command) -> Result<(), Command> {
        self.send_as(command, self.orders.next())
    }

    /// Sends a command that was requested earlier, under its request number: a STOP in between
    /// voids the command.
    pub fn send_as(&self, command: Command, number: u64) -> Result<(), Command> {
        self.send_numbered(Numbered { command, number, wants_answer: false })
    }

    /// Sends a command like [`Self::send_as`]; the snapshot will show its outcome under `number`.
    pub fn send_answered(&self, command: Command, number: u64) -> Result<(), Command> {
        self.send_numbered(Numbered { command, number, wants_answer: true })
    }

    fn send_numbered(&self, numbered: Numbered) -> Result<(), Command> {
        self.commands.try_send(numbered).map_err(|error| error.into_inner().command)
    }

    pub fn snapshot(&self) -> Arc<Snapshot> {
        Arc::clone(&self.stopper.snapshots.borrow())
    }

    pub fn wire(&self) -> &WireLog {
        &self.wire
    }

    /// Returns the last measured positions.
    pub fn positions(&self) -> &PositionLog {
        &self.positions
    }

    /// Replaces the bounds of the antenna.
    pub fn keep_within(&self, bounds: Bounds) {
        self.bounds.send_replace(bounds);
    }

    /// Sets the orbit by which to judge a track that the unit runs on its own.
    pub fn know_orbit(&self, orbit: Option<Arc<KnownOrbit>>) {
        self.orbit.send_replace(orbit);
    }

    /// Takes the oldest unread event.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.try_recv().ok()
    }
}

/// Waits until the operating system asks the program to end.
pub async fn told_to_end() -> io::Result<()> {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        let mut terminate = signal(SignalKind::terminate())?;
        let mut hang_up = signal(SignalKind::hangup())?;
        tokio::select! {
            interrupted = tokio::signal::ctrl_c() => interrupted,
            _ = terminate.recv() => Ok(()),
            _ = hang_up.recv() => Ok(()),
        }
    }
    #[cfg(not(unix))]
    tokio::signal::ctrl_c().await
}

/// Clock, links and clock synchronisation check for the sessions.
#[derive(Clone)]
pub struct Outside {
    /// Clock of the sessions and of the code that runs them.
    pub clock: Clock,
    pub dial: Arc<Dialler>,
    /// Function that reads the synchronisation state of the clock; may block for seconds.
    pub time_sync: fn() -> TimeSync,
}

/// Function that prepares the links of an antenna to locked endpoints.
pub type Dialler = dyn Fn(&Antenna, Arc<dyn UnitLock>) -> Dial + Send + Sync;

impl From<Clock> for Outside {
    /// Uses real links. Reports the synchronisation of any clock other than the system clock as
    /// unknown.
    fn from(clock: Clock) -> Self {
        let time_sync = if clock.is_of_system() { time_sync } else { || TimeSync::NotKnown };
        Self { clock, dial: Arc::new(link::dial), time_sync }
    }
}

pub struct Driver {
    runtime: tokio::runtime::Handle,
    /// Thread of the runtime; `None` if the caller provides the runtime.
    thread: Option<DriverThread>,
    sessions: tokio_util::task::TaskTracker,
    outside: Outside,
    wake: Wake,
    orders: Orders,
    dead_man: Option<PathBuf>,
    debts: Debts,
}

struct DriverThread {
    end: Option<tokio::sync::oneshot::Sender<()>>,
    ended: std::sync::mpsc::Receiver<()>,
    before_sleep: BeforeSleep,
    pulse: Pulse,
    _watchdog: std::sync::mpsc::SyncSender<()>,
}

impl Driver {
    /// Starts the thread, which calls `wake` after every change.
    pub fn start(outside: impl Into<Outside>, wake: Wake) -> io::Result<Self> {
        let sessions = tokio_util::task::TaskTracker::new();
        let (runtime, thread) = DriverThread::start(sessions.clone(), &wake)?;
        let thread = Some(thread);
        Ok(Self { thread, sessions, ..Self::on_runtime(runtime, outside.into(), wake) })
    }

    /// Runs the sessions on a runtime of the caller, such as a rehearsal. This driver has no
    /// watchdog, and its end waits for no session.
    pub fn on_runtime(runtime: tokio::runtime::Handle, outside: Outside, wake: Wake) -> Self {
        Self {
            runtime,
            thread: None,
            sessions: tokio_util::task::TaskTracker::new(),
            outside,
            wake,
            orders: Orders::default(),
            dead_man: None,
            debts: Debts::default(),
        }
    }

    /// Sets `program` as the dead-man of manual motions. `program` is this program, which knows
    /// [`dead_man::SUBCOMMAND`].
    #[must_use]
    pub fn guarded_by(mut self, program: Option<PathBuf>) -> Self {
        self.dead_man = program;
        self
    }

    /// Keeps records of manual motions in `folder`, for the next start.
    #[must_use]
    pub fn marking_in(mut self, folder: Option<PathBuf>) -> Self {
        self.debts = Debts::marked_in(folder);
        self
    }

    /// Returns how long the thread has not responded, if at least half a second. Until it runs
    /// again, Azel executes nothing, not even STOP. The driver calls `wake` when the thread hangs,
    /// each second until it runs, and when it runs again.
    pub fn stood_for(&self) -> Option<Duration> {
        self.thread.as_ref()?.pulse.stood_for()
    }

    /// Returns the function that reads the clock's synchronisation state; it may block for seconds.
    pub fn time_sync(&self) -> fn() -> TimeSync {
        self.outside.time_sync
    }

    /// Returns the runtime of the driver thread, for other work.
    pub fn runtime(&self) -> &tokio::runtime::Handle {
        &self.runtime
    }

    /// Starts the session of an antenna with earlier lessons about its axes. A lock-out may apply
    /// to the unit. The session drops `lock` when it ends.
    pub fn open(
        &self,
        antenna: &Antenna,
        bounds: Bounds,
        learned: [AxisLessons; 2],
        lock_out: Option<LockOut>,
        lock: Box<dyn UnitLock>,
    ) -> AntennaHandle {
        let (wires, handle) = Wires::new(
            antenna,
            bounds,
            self.outside.clock.now().steady,
            Arc::clone(&self.wake),
            &self.orders,
        );
        wires.begin_with(learned, lock_out);
        let wires = match &self.thread {
            Some(thread) => wires.with_sleep(thread.before_sleep.subscribe()),
            None => wires,
        };
        let Outside { clock, dial, .. } = self.outside.clone();
        let (antenna, debts) = (antenna.clone(), self.debts.clone());
        let lock: Arc<dyn UnitLock> = lock.into();
        let until_the_end = Arc::clone(&lock);
        let (dead_man, ends) = (self.dead_man.clone(), wires.clone());
        let open = move || {
            let (controller, dial) = (antenna.controller(), dial(&antenna, Arc::clone(&lock)));
            let (wires, debts) = (ends.clone(), debts.clone());
            // Includes the lock-out of a session that broke down.
            let lock_out = wires.shown_lock_out();
            let session =
                Session::with_wires(controller, &antenna, dial, clock.clone(), wires, debts)
                    .with_lock_out(lock_out);
            match &dead_man {
                Some(program) => session.with_dead_man(program.clone()),
                None => session,
            }
        };
        let work = async move {
            keep_alive(open, wires).await;
            drop(until_the_end);
        };
        self.sessions.spawn_on(work, &self.runtime);
        handle
    }

    /// Returns the handle of an antenna that another program drives: it has no session and accepts
    /// no command.
    pub fn leave_alone(antenna: &Antenna) -> AntennaHandle {
        Wires::closed(antenna, Instant::now())
    }

    /// Returns the counter of the requests to all antennas.
    pub fn orders(&self) -> &Orders {
        &self.orders
    }

    pub fn debts(&self) -> &Debts {
        &self.debts
    }
}

impl DriverThread {
    /// Starts the thread, and returns its runtime. The thread ends when all `sessions` have ended.
    fn start(
        sessions: tokio_util::task::TaskTracker,
        wake: &Wake,
    ) -> io::Result<(tokio::runtime::Handle, Self)> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let handle = runtime.handle().clone();
        let (end, told_to_end) = tokio::sync::oneshot::channel();
        let (tell_ended, ended) = std::sync::mpsc::sync_channel(1);
        let pulse = Pulse::default();
        runtime.spawn(pulse.clone().beat());
        let watchdog = pulse.watch(Arc::clone(wake))?;
        let before_sleep = BeforeSleep::default();
        before_sleep::watch(before_sleep.clone(), handle.clone())?;
        thread::Builder::new().name("azel-driver".to_owned()).spawn(move || {
            runtime.block_on(async {
                // An error means that the driver is gone; the sessions must end then, too.
                let _ = told_to_end.await;
                sessions.close();
                let _ = tokio::time::timeout(FAREWELL, sessions.wait()).await;
            });
            // The receiver may be gone already.
            let _ = tell_ended.send(());
        })?;
        let thread = Self { end: Some(end), ended, before_sleep, pulse, _watchdog: watchdog };
        Ok((handle, thread))
    }
}

/// Runs a session, and starts a new session after a breakdown. The antenna may be moving unwatched,
/// so the new session sends STOP first.
async fn keep_alive(open: impl Fn() -> Session, wires: Wires) {
    let mut broke = 0_u32;
    let mut own_stop = wires.newest_void();
    while caught(Box::pin(async { Box::pin(open().run()).await })).await.is_none() {
        wires.tell(Event::Safety(Safety::SessionBroke));
        // The first restart is immediate. Later restarts pause, so that a broken session does not
        // block the others. An operator's STOP ends the pause.
        let rest = tokio::time::sleep(MAX_REST.min(Duration::from_millis(200) * broke));
        tokio::select! {
            () = rest => {}
            () = wires.stopped_after(own_stop) => {}
        }
        wires.stop();
        own_stop = wires.newest_void();
        broke = broke.saturating_add(1);
    }
}

/// Returns `None` if `work` panicked.
async fn caught<F: Future>(mut work: Pin<Box<F>>) -> Option<F::Output> {
    poll_fn(move |context| {
        let polled = panic::catch_unwind(AssertUnwindSafe(|| work.as_mut().poll(context)));
        polled.map_or(Poll::Ready(None), |polled| polled.map(Some))
    })
    .await
}

/// Waits, with a timeout, until every session has sent its last STOP.
impl Drop for DriverThread {
    fn drop(&mut self) {
        drop(self.end.take());
        if self.ended.recv_timeout(FAREWELL + Duration::from_millis(500)).is_err() {
            tracing::error!("the driver did not end in time");
        }
    }
}

#[cfg(test)]
mod tests {
    use std::{num::NonZeroU32, sync::atomic::AtomicUsize};

    use super::{
        session::testing::{START, antenna},
        *,
    };

    fn wait_for(goal: &str, is_so: impl Fn() -> bool) {
        let deadline = Instant::now() + Duration::from_secs(20);
        while !is_so() {
            assert!(Instant::now() < deadline, "{goal}");
            thread::sleep(Duration::from_millis(20));
        }
    }

    #[test]
    fn a_thread_that_is_held_up_is_told_and_wakes_the_window() {
        let (woken, wakes) = std::sync::mpsc::sync_channel(100);
        let wake: Wake = Arc::new(move || {
            let _ = woken.try_send(());
        });
        let driver = Driver::start(Clock::system(), wake).unwrap();
        let (go_on, held_up) = std::sync::mpsc::sync_channel::<()>(1);
        driver.runtime().spawn(async move { held_up.recv() });
        wait_for("it stands", || driver.stood_for().is_some());
        wakes.recv_timeout(Duration::from_secs(20)).unwrap();
        drop(go_on);
        wait_for("it runs", || driver.stood_for().is_none());
        wakes.recv_timeout(Duration::from_secs(20)).unwrap();
    }

    #[test]
    fn the_lock_out_of_a_unit_is_shown_before_its_session_runs() {
        let driver = Driver::start(Clock::system(), Arc::new(|| {})).unwrap();
        let (go_on, held_up) = std::sync::mpsc::sync_channel::<()>(1);
        driver.runtime().spawn(async move { held_up.recv() });
        let antenna = antenna();
        let lock_out = LockOut {
            operator: "Ada".to_owned(),
            reason: "gear box open".to_owned(),
            start: jiff::Timestamp::UNIX_EPOCH,
        };
        let (bounds, locked) = (Bounds::of_antenna(&antenna), Some(lock_out.clone()));
        let learned = [AxisLessons::default(); 2];
        let handle = driver.open(&antenna, bounds, learned, locked, Box::new(()));
        let first = handle.snapshot();
        assert_eq!((first.lock_out.as_ref(), first.locking), (Some(&lock_out), true));
        drop(go_on);
    }

    #[tokio::test(start_paused = true)]
    async fn stop_waits_for_no_session_that_rests_after_a_breakdown() {
        let clock = Clock::at_speed(START, NonZeroU32::MIN);
        let (antenna, now) = (antenna(), clock.now().steady);
        let bounds = Bounds::of_antenna(&antenna);
        let (wires, handle) =
            Wires::new(&antenna, bounds, now, Arc::new(|| {}), &Orders::default());
        let dialled = Arc::new(AtomicUsize::new(0));
        let (counts, ends) = (Arc::clone(&dialled), wires.clone());
        let open = move || {
            let counts = Arc::clone(&counts);
            let dial: Dial = Box::new(move || {
                counts.fetch_add(1, Ordering::Relaxed);
                panic!("the link breaks down with its session");
            });
            let debts = Debts::marked_in(None);
            Session::with_wires(
                antenna.controller(),
                &antenna,
                dial,
                clock.clone(),
                ends.clone(),
                debts,
            )
        };
        tokio::spawn(keep_alive(open, wires));
        // By now, the session pauses for about five seconds before each restart.
        tokio::time::sleep(Duration::from_secs(61)).await;
        let before = dialled.load(Ordering::Relaxed);
        handle.stop();
        tokio::time::sleep(Duration::from_millis(1)).await;
        assert_eq!(dialled.load(Ordering::Relaxed), before + 1);
    }
}
