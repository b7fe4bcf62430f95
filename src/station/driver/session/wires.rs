//! Session side of the channels to the station.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, atomic::Ordering};

use tokio::sync::{Mutex as AsyncMutex, Notify, mpsc, watch};

use super::contact::first_link;
use crate::{
    clock::Instant,
    contract::driver::{AxisLessons, Event, LinkLoss, LinkState, Snapshot, TrackProblem, WireLog},
    device::{Measured, WireLine},
    driver::{
        AntennaHandle, COMMANDS, EVENTS, Numbered, Orbits, Orders, PositionLog, Stopper, Wake,
        before_sleep::Awake,
    },
    plan::{Bounds, on_board::KnownOrbit},
    station::{Antenna, LockOut},
};

/// Input that ended a wait.
pub(super) enum SessionInput {
    Bytes(usize),
    Lost(LinkLoss),
    Command(Numbered),
    /// New bounds of the antenna.
    Bounds(Box<Bounds>),
    Stop,
    /// Imminent sleep of this computer.
    Sleep(Awake),
    Time,
    /// Loss of the station, which ends the session.
    Over,
}

/// Session side of the channels to the station. A session that breaks down leaves the channels to
/// its successor.
#[derive(Clone)]
pub struct Wires {
    /// Command queue, locked by the running session.
    commands: Arc<AsyncMutex<mpsc::Receiver<Numbered>>>,
    stopper: Stopper,
    before_sleep: Option<Arc<AsyncMutex<mpsc::Receiver<Awake>>>>,
    snapshots: watch::Sender<Arc<Snapshot>>,
    events: mpsc::Sender<Event>,
    wake: Wake,
    /// Reason why the session refuses the current command.
    problem: Arc<Mutex<Option<TrackProblem>>>,
    wire_log: WireLog,
    positions: PositionLog,
    orbit: Orbits,
    bounds: watch::Receiver<Bounds>,
}

impl Wires {
    /// Creates both sides of one antenna's channels.
    pub(in crate::driver) fn new(
        antenna: &Antenna,
        bounds: Bounds,
        now: Instant,
        wake: Wake,
        orders: &Orders,
    ) -> (Self, AntennaHandle) {
        let (send_command, commands) = mpsc::channel(COMMANDS);
        let (events, read_events) = mpsc::channel(EVENTS);
        let (_, link) = first_link(antenna, now);
        let first = Arc::new(Snapshot::before_anything(link));
        let (snapshots, read_snapshots) = watch::channel(first);
        let stopper = Stopper {
            stop: Arc::new(Notify::new()),
            void: Arc::default(),
            orders: orders.clone(),
            snapshots: read_snapshots,
        };
        let (wire_log, orbit) = (WireLog::default(), Orbits::default());
        let positions = PositionLog::default();
        let (keep_within, bounds) = watch::channel(bounds);
        let wires = Self {
            commands: Arc::new(AsyncMutex::new(commands)),
            stopper: stopper.clone(),
            before_sleep: None,
            snapshots,
            events,
            wake,
            problem: Arc::default(),
            wire_log: wire_log.clone(),
            positions: positions.clone(),
            orbit: Arc::clone(&orbit),
            bounds,
        };
        let handle = AntennaHandle {
            commands: send_command,
            stopper,
            orders: orders.clone(),
            events: read_events,
            wire: wire_log,
            positions,
            orbit,
            bounds: keep_within,
        };
        (wires, handle)
    }

    /// Returns the handle of an antenna without a session: it accepts no command.
    pub(in crate::driver) fn closed(antenna: &Antenna, now: Instant) -> AntennaHandle {
        let bounds = Bounds::of_antenna(antenna);
        let (wires, handle) = Self::new(antenna, bounds, now, Arc::new(|| {}), &Orders::default());
        let snapshot = Snapshot::before_anything(LinkState::Off);
        wires.snapshots.send_replace(Arc::new(snapshot));
        handle
    }

    /// Adds a channel that announces the sleep of this computer.
    pub(in crate::driver) fn with_sleep(mut self, before_sleep: mpsc::Receiver<Awake>) -> Self {
        self.before_sleep = Some(Arc::new(AsyncMutex::new(before_sleep)));
        self
    }

    /// Fills in the first snapshot before the session runs: the earlier lessons about the axes, and
    /// the lock-out of the unit.
    pub(in crate::driver) fn begin_with(
        &self,
        learned: [AxisLessons; 2],
        lock_out: Option<LockOut>,
    ) {
        self.snapshots.send_modify(|first| {
            let first = Arc::make_mut(first);
            first.learned = learned;
            first.locking = lock_out.is_some();
            first.lock_out = lock_out;
        });
    }

    /// Returns the last shown lock-out.
    pub(in crate::driver) fn shown_lock_out(&self) -> Option<LockOut> {
        self.snapshots.borrow().lock_out.clone()
    }

    /// Sends a STOP ahead of the next command.
    pub(in crate::driver) fn stop(&self) {
        self.stopper.stop();
    }

    /// Returns the number of the newest request that a STOP has voided.
    pub(in crate::driver) fn newest_void(&self) -> u64 {
        self.stopper.void.load(Ordering::SeqCst)
    }

    /// Waits for a STOP that has voided a newer request than `void`.
    pub(in crate::driver) async fn stopped_after(&self, void: u64) {
        while self.newest_void() <= void {
            self.stopper.stop.notified().await;
        }
    }

    fn problem(&self) -> MutexGuard<'_, Option<TrackProblem>> {
        // No code panics while it owns the lock, so the data of a poisoned lock is valid.
        self.problem.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the last reported problem since the previous call.
    pub(super) fn take_problem(&self) -> Option<TrackProblem> {
        self.problem().take()
    }

    /// Sends an event to the station.
    pub(in crate::driver) fn tell(&self, event: Event) {
        match &event {
            Event::NotSent(refusal) => *self.problem() = Some(refusal.clone().into()),
            Event::CannotProgramTrack(_, problem) => *self.problem() = Some(problem.clone()),
            _ => {}
        }
        // The driver must not wait, so it drops an event if the queue is full.
        if let Err(error) = self.events.try_send(event) {
            tracing::warn!(%error, "nobody reads the events; one was dropped");
        }
        (self.wake)();
    }

    /// Waits for the next input; a STOP comes first.
    pub(super) async fn next(&mut self) -> SessionInput {
        // The order matters: a STOP must not wait behind the commands that it voids. A random order
        // would also make two runs of one rehearsal differ.
        tokio::select! {
            biased;
            () = self.stopper.stop.notified() => SessionInput::Stop,
            awake = next_sleep(self.before_sleep.as_deref()) => SessionInput::Sleep(awake),
            bounds = next_bounds(&mut self.bounds) => SessionInput::Bounds(Box::new(bounds)),
            command = next_command(&self.commands, &self.stopper) => {
                command.map_or(SessionInput::Over, SessionInput::Command)
            }
        }
    }

    /// Voids all commands sent before a STOP, by any sender.
    pub(super) fn void_commands(&self) {
        self.stopper.forget();
    }

    /// Returns the current bounds of the antenna; [`Self::next`] reports later ones.
    pub(super) fn first_bounds(&mut self) -> Bounds {
        self.bounds.borrow_and_update().clone()
    }

    /// Returns the lessons about the axes, including lessons of a session that broke down.
    pub(super) fn learned(&self) -> [AxisLessons; 2] {
        self.snapshots.borrow().learned
    }

    pub(super) fn orbit(&self) -> Option<Arc<KnownOrbit>> {
        self.orbit.borrow().clone()
    }

    /// Publishes a snapshot if it has changed.
    pub(super) fn publish(&self, snapshot: Snapshot) {
        let mut is_worth_a_look = false;
        self.snapshots.send_if_modified(|shown| {
            let has_changed = **shown != snapshot;
            if has_changed {
                is_worth_a_look = !shown.shows_the_same(&snapshot);
                *shown = Arc::new(snapshot);
            }
            has_changed
        });
        // Ages and counters alone need no frame: the window updates them within a second.
        if is_worth_a_look {
            (self.wake)();
        }
    }

    /// Shows a lock-out from before the session runs.
    pub(super) fn show_lock_out(
        &self,
        lock_out: Option<LockOut>,
        is_locking: bool,
        link: LinkState,
    ) {
        self.snapshots.send_modify(|shown| {
            let shown = Arc::make_mut(shown);
            (shown.lock_out, shown.locking, shown.link) = (lock_out, is_locking, link);
        });
    }

    pub(super) fn log_position(&self, measured: Measured) {
        self.positions.push(measured);
    }

    /// Copies the link traffic to the wire log.
    pub(super) fn log_lines(&self, lines: impl Iterator<Item = WireLine>) {
        let mut is_awaited = false;
        for line in lines {
            is_awaited |= self.wire_log.push(line);
        }
        if is_awaited {
            (self.wake)();
        }
    }

    pub(super) fn stop_handle(&self) -> Arc<Notify> {
        Arc::clone(&self.stopper.stop)
    }
}

async fn next_sleep(before_sleep: Option<&AsyncMutex<mpsc::Receiver<Awake>>>) -> Awake {
    if let Some(before_sleep) = before_sleep
        && let Some(awake) = before_sleep.lock().await.recv().await
    {
        return awake;
    }
    std::future::pending().await
}

async fn next_bounds(bounds: &mut watch::Receiver<Bounds>) -> Bounds {
    if bounds.changed().await.is_err() {
        // The command channel reports the end.
        std::future::pending::<()>().await;
    }
    bounds.borrow_and_update().clone()
}

/// Returns `None` when the station is gone: the session begins no command sent just before the end.
async fn next_command(
    commands: &AsyncMutex<mpsc::Receiver<Numbered>>,
    stopper: &Stopper,
) -> Option<Numbered> {
    let mut commands = commands.lock().await;
    loop {
        let numbered = commands.recv().await?;
        if commands.is_closed() {
            return None;
        }
        if !numbered.command.row().void_after_stop || !stopper.is_void(numbered.number) {
            return Some(numbered);
        }
    }
}
