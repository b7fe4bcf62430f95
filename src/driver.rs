//! Runs the antennas: links, sessions, intents and the gate, on a thread of
//! its own. The station sends commands and reads snapshots; it never waits, and
//! nothing here waits for it.

mod before_sleep;
pub mod dead_man;
mod debts;
mod gate;
mod intent;
mod link;
mod pulse;
mod safety;
mod session;
mod snapshot;
mod time_sync;
mod wire_log;

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

pub use crate::{clock::Clock, job::Wake};
pub use debts::{Debts, Unit};
pub use gate::Refusal;
pub use intent::Intent;
pub use link::{Dial, Stream, dial_line, dial_tcp};
pub use safety::{Mover, Response, Safety, Unlike};
pub use session::{Command, JOG_LEASE, Session, Wires};
pub use snapshot::{
    Event, Found, Inside, LinkLoss, LinkState, OnBoardView, Snapshot, StopState, StoppingWay,
    TrackProblem, TrackView,
};
pub use time_sync::{TimeSync, time_sync};
pub use wire_log::{MAX_LINES, Recorded, WireLog};

use self::{before_sleep::BeforeSleep, pulse::Pulse};
use crate::{
    clock::Instant,
    plan::{Bounds, on_board::KnownOrbit},
    station::{Antenna, Link, LockOut},
};

/// How many commands may wait. The station sends at most a few at a time.
const COMMANDS: usize = 64;
/// How many events may wait. When nobody reads, the oldest alarms matter most,
/// so further ones are dropped and counted in the log.
const EVENTS: usize = 256;
/// How long the end of the program waits for the last STOP: as long as a session
/// tries to reach a unit once more and to see it stand.
const FAREWELL: Duration = Duration::from_secs(6);

/// The longest rest of a session that breaks down again and again.
const MAX_REST: Duration = Duration::from_secs(5);

/// The near end of one antenna's session. Dropping it ends the session, which
/// ends a jog with a stop first.
pub struct AntennaHandle {
    commands: mpsc::Sender<Numbered>,
    stopper: Stopper,
    orders: Orders,
    events: mpsc::Receiver<Event>,
    wire: WireLog,
    orbit: Orbits,
    bounds: watch::Sender<Bounds>,
}

/// Numbers what is asked for, over all antennas of a station.
#[derive(Debug, Clone, Default)]
pub struct Orders(Arc<AtomicU64>);

impl Orders {
    /// The number of what is asked for now.
    pub fn next(&self) -> u64 {
        self.0.fetch_add(1, Ordering::SeqCst) + 1
    }
}

/// A command on its way to a session, with its number among all that was asked for.
struct Numbered {
    command: Command,
    number: u64,
}

/// Stops an antenna past every queue; it outlives the session.
#[derive(Clone)]
pub struct Stopper {
    stop: Arc<Notify>,
    /// What was asked for up to this number is void, wherever it still waits.
    void: Arc<AtomicU64>,
    orders: Orders,
    snapshots: watch::Receiver<Arc<Snapshot>>,
}

impl Stopper {
    /// Stops the antenna: never refused.
    pub fn stop(&self) {
        self.forget();
        self.stop.notify_one();
    }

    /// What was asked for until now is void, wherever it still waits.
    pub fn forget(&self) {
        self.void.fetch_max(self.orders.next(), Ordering::SeqCst);
    }

    /// Whether what was asked for with this number is void.
    pub fn is_void(&self, number: u64) -> bool {
        number <= self.void.load(Ordering::SeqCst)
    }

    /// Whether the antenna is to track, or tracks from here.
    pub fn tracks(&self) -> bool {
        self.snapshots.borrow().intent == Intent::Track
    }

    /// Whether a STOP of the whole station is for this antenna too.
    pub fn is_wanted(&self) -> bool {
        self.snapshots.borrow().wants_stop()
    }
}

/// The orbit of the satellite that the unit holds. It outlives a session that breaks
/// down, and is no command: a queue that is full does not hold it up.
type Orbits = Arc<watch::Sender<Option<Arc<KnownOrbit>>>>;

impl AntennaHandle {
    /// Stops the antenna: past every queue, never refused.
    pub fn stop(&self) {
        self.stopper.stop();
    }

    /// What stops the antenna from anywhere.
    pub fn stopper(&self) -> Stopper {
        self.stopper.clone()
    }

    /// Numbers what is asked for.
    pub fn orders(&self) -> &Orders {
        &self.orders
    }

    /// Hands over a command. It comes back when the session is too busy to take
    /// it, which must be told to the operator.
    pub fn send(&self, command: Command) -> Result<(), Command> {
        self.send_as(command, self.orders.next())
    }

    /// The same of a command that was asked for earlier and got this number then: a
    /// STOP that came in between voids it.
    pub fn send_as(&self, command: Command, number: u64) -> Result<(), Command> {
        let numbered = Numbered { command, number };
        self.commands.try_send(numbered).map_err(|error| error.into_inner().command)
    }

    /// The newest snapshot.
    pub fn snapshot(&self) -> Arc<Snapshot> {
        Arc::clone(&self.stopper.snapshots.borrow())
    }

    /// What went over the link.
    pub fn wire(&self) -> &WireLog {
        &self.wire
    }

    /// Other bounds hold for the antenna from now on.
    pub fn keep_within(&self, bounds: Bounds) {
        self.bounds.send_replace(bounds);
    }

    /// Tells by which orbit to judge what the unit does by itself.
    pub fn know_orbit(&self, orbit: Option<Arc<KnownOrbit>>) {
        self.orbit.send_replace(orbit);
    }

    /// The oldest event that was not read yet.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.try_recv().ok()
    }
}

/// Waits until the operating system tells the program to end.
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

/// What sessions take from outside: their clocks and their links.
#[derive(Clone)]
pub struct Outside {
    /// Of the sessions and of whoever runs them.
    pub clock: Clock,
    /// Opens the links of an antenna.
    pub dial: Arc<dyn Fn(&Antenna) -> Dial + Send + Sync>,
}

impl From<Clock> for Outside {
    /// Real links.
    fn from(clock: Clock) -> Self {
        Self { clock, dial: Arc::new(dial) }
    }
}

/// The thread of the sessions.
pub struct Driver {
    runtime: tokio::runtime::Handle,
    end: Option<tokio::sync::oneshot::Sender<()>>,
    ended: std::sync::mpsc::Receiver<()>,
    sessions: tokio_util::task::TaskTracker,
    outside: Outside,
    wake: Wake,
    orders: Orders,
    dead_man: Option<PathBuf>,
    debts: Debts,
    before_sleep: BeforeSleep,
    pulse: Pulse,
    _watchdog: std::sync::mpsc::SyncSender<()>,
}

impl Driver {
    /// Starts the thread. `wake` is called from it after every change.
    pub fn start(outside: impl Into<Outside>, wake: Wake) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let handle = runtime.handle().clone();
        let sessions = tokio_util::task::TaskTracker::new();
        let running = sessions.clone();
        let (end, told_to_end) = tokio::sync::oneshot::channel();
        let (tell_ended, ended) = std::sync::mpsc::sync_channel(1);
        let pulse = Pulse::default();
        runtime.spawn(pulse.clone().beat());
        let watchdog = pulse.watch(Arc::clone(&wake))?;
        let before_sleep = BeforeSleep::default();
        before_sleep::watch(before_sleep.clone(), handle.clone())?;
        thread::Builder::new().name("azel-driver".to_owned()).spawn(move || {
            runtime.block_on(async {
                // An error means that the near end is gone, which says the same.
                let _ = told_to_end.await;
                running.close();
                let _ = tokio::time::timeout(FAREWELL, running.wait()).await;
            });
            // Nobody may be waiting any more.
            let _ = tell_ended.send(());
        })?;
        Ok(Self {
            runtime: handle,
            end: Some(end),
            ended,
            sessions,
            outside: outside.into(),
            wake,
            orders: Orders::default(),
            dead_man: None,
            debts: Debts::default(),
            before_sleep,
            pulse,
            _watchdog: watchdog,
        })
    }

    /// Starts `program` as the dead-man of motions by hand: this program, which
    /// knows [`dead_man::SUBCOMMAND`].
    #[must_use]
    pub fn guarded_by(mut self, program: Option<PathBuf>) -> Self {
        self.dead_man = program;
        self
    }

    /// Keeps marks of motions by hand in `folder`, so that the next start knows of
    /// them.
    #[must_use]
    pub fn marking_in(mut self, folder: Option<PathBuf>) -> Self {
        self.debts = Debts::marked_in(folder);
        self
    }

    /// For how long the thread has not responded, from half a second on: what is
    /// sent meanwhile, STOP too, is not carried out. `wake` is called when it
    /// stands, each second while it does, and when it runs again.
    pub fn stood_for(&self) -> Option<Duration> {
        self.pulse.stood_for()
    }

    /// Where other work on the driver's thread is spawned.
    pub fn runtime(&self) -> &tokio::runtime::Handle {
        &self.runtime
    }

    /// Starts the session of one antenna, whose unit may be locked out. `until_the_end` is
    /// dropped when the session has ended.
    pub fn open(
        &self,
        antenna: &Antenna,
        bounds: Bounds,
        lock_out: Option<LockOut>,
        until_the_end: Box<dyn Send>,
    ) -> AntennaHandle {
        let (wires, handle) = Wires::new(
            antenna,
            bounds,
            self.outside.clock.now().steady,
            Arc::clone(&self.wake),
            &self.orders,
        );
        let wires = wires.hearing(self.before_sleep.hear());
        let Outside { clock, dial } = self.outside.clone();
        let (antenna, debts) = (antenna.clone(), self.debts.clone());
        let (dead_man, ends) = (self.dead_man.clone(), wires.clone());
        let open = move || {
            let (controller, dial) = (antenna.controller(), dial(&antenna));
            let (wires, debts) = (ends.clone(), debts.clone());
            let session = Session::over(controller, &antenna, dial, clock.clone(), wires, debts)
                .locked_out(lock_out.clone());
            match &dead_man {
                Some(program) => session.guarded_by(program.clone()),
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

    /// An antenna that is driven from elsewhere: it has no session, and takes nothing.
    pub fn leave_alone(antenna: &Antenna) -> AntennaHandle {
        Wires::closed(antenna, Instant::now())
    }

    /// Numbers what is asked for of all its antennas.
    pub fn orders(&self) -> &Orders {
        &self.orders
    }

    /// The STOPs that are owed.
    pub fn debts(&self) -> &Debts {
        &self.debts
    }
}

/// Opens the links of `antenna`.
fn dial(antenna: &Antenna) -> Dial {
    let connection = &antenna.connection;
    match connection.spec().link {
        Link::Tcp => dial_tcp(connection.address.clone()),
        Link::Line { baud } => dial_line(&connection.address, connection.whole(baud)),
    }
}

/// Runs a session, and another one where it breaks down: the antenna may move
/// unwatched, so STOP is the first word of the next.
async fn keep_alive(open: impl Fn() -> Session, wires: Wires) {
    let mut broke = 0_u32;
    while caught(Box::pin(async { Box::pin(open().run()).await })).await.is_none() {
        wires.stop();
        wires.tell(Event::Safety(Safety::SessionBroke));
        // The first restart waits for nothing; one that breaks again and again must
        // not keep the other sessions from running.
        tokio::time::sleep(MAX_REST.min(Duration::from_millis(200) * broke)).await;
        broke = broke.saturating_add(1);
    }
}

/// The outcome of `work`; `None` when it panicked.
async fn caught<F: Future>(mut work: Pin<Box<F>>) -> Option<F::Output> {
    poll_fn(move |context| {
        let polled = panic::catch_unwind(AssertUnwindSafe(|| work.as_mut().poll(context)));
        polled.map_or(Poll::Ready(None), |polled| polled.map(Some))
    })
    .await
}

/// Waits, within reason, until every session has said its last STOP.
impl Drop for Driver {
    fn drop(&mut self) {
        drop(self.end.take());
        if self.ended.recv_timeout(FAREWELL + Duration::from_millis(500)).is_err() {
            tracing::error!("the driver did not end in time");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait_for(what: &str, is_so: impl Fn() -> bool) {
        let until = Instant::now() + Duration::from_secs(20);
        while !is_so() {
            assert!(Instant::now() < until, "{what}");
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
}
