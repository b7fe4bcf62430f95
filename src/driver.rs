//! Runs the antennas: links, sessions, intents and the gate, on a thread of
//! its own. The window sends commands and reads snapshots; it never waits, and
//! nothing here waits for it.

mod clock;
pub mod files;
mod gate;
mod intent;
mod link;
mod session;
mod snapshot;
mod time_sync;
mod wire_log;

use std::{io, sync::Arc, thread, time::Duration};

use tokio::sync::{Notify, mpsc, watch};

pub use clock::Clock;
pub use gate::Refusal;
pub use intent::Intent;
pub use link::{Dial, Stream, dial_line, dial_tcp};
pub use session::{Command, Session, Wires};
pub use snapshot::{
    Event, FollowProblem, FollowView, Found, LinkLoss, LinkState, OnBoardView, Snapshot, StopState,
};
pub use time_sync::{TimeSync, time_sync};
pub use wire_log::{MOST_LINES, Recorded, WireLog};

use crate::station::{Antenna, Link};

/// How many commands may wait. The window sends at most a few a frame.
const COMMANDS: usize = 64;
/// How many events may wait. When nobody reads, the oldest alarms matter most,
/// so further ones are dropped and counted in the log.
const EVENTS: usize = 256;
/// How long the end of the program waits for the last STOP: as long as a session
/// tries to reach a unit once more and to see it stand.
const FAREWELL: Duration = Duration::from_secs(6);

/// Called after every new snapshot or event; wakes the window.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// The near end of one antenna's session. Dropping it ends the session, which
/// ends a jog with a stop first.
pub struct AntennaHandle {
    commands: mpsc::Sender<Command>,
    stop: Arc<Notify>,
    snapshots: watch::Receiver<Arc<Snapshot>>,
    events: mpsc::Receiver<Event>,
    wire: WireLog,
}

impl AntennaHandle {
    /// The near end of `wires`, without a thread behind it.
    pub fn new(
        commands: mpsc::Sender<Command>,
        stop: Arc<Notify>,
        snapshots: watch::Receiver<Arc<Snapshot>>,
        events: mpsc::Receiver<Event>,
    ) -> Self {
        Self { commands, stop, snapshots, events, wire: WireLog::default() }
    }

    /// Stops the antenna: past every queue, never refused.
    pub fn stop(&self) {
        self.stop.notify_one();
    }

    /// Hands over a command. It comes back when the session is too busy to take
    /// it, which must be told to the operator.
    pub fn send(&self, command: Command) -> Result<(), Command> {
        self.commands.try_send(command).map_err(mpsc::error::TrySendError::into_inner)
    }

    /// The session has ended, and not because of this handle.
    pub fn has_ended(&self) -> bool {
        self.commands.is_closed()
    }

    /// The newest snapshot.
    pub fn snapshot(&self) -> Arc<Snapshot> {
        Arc::clone(&self.snapshots.borrow())
    }

    /// What went over the link.
    pub fn wire(&self) -> &WireLog {
        &self.wire
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

/// The thread of the sessions.
pub struct Driver {
    runtime: tokio::runtime::Handle,
    end: Option<tokio::sync::oneshot::Sender<()>>,
    ended: std::sync::mpsc::Receiver<()>,
    sessions: tokio_util::task::TaskTracker,
    clock: Clock,
    wake: Wake,
}

impl Driver {
    /// Starts the thread. `wake` is called from it after every change.
    pub fn start(clock: Clock, wake: Wake) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let handle = runtime.handle().clone();
        let sessions = tokio_util::task::TaskTracker::new();
        let running = sessions.clone();
        let (end, told_to_end) = tokio::sync::oneshot::channel();
        let (tell_ended, ended) = std::sync::mpsc::sync_channel(1);
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
        Ok(Self { runtime: handle, end: Some(end), ended, sessions, clock, wake })
    }

    /// Where other work on the driver's thread is spawned.
    pub fn runtime(&self) -> &tokio::runtime::Handle {
        &self.runtime
    }

    /// Starts the session of one antenna.
    pub fn open(&self, antenna: &Antenna) -> AntennaHandle {
        let connection = &antenna.connection;
        let dial = match connection.kind().link {
            Link::Tcp => dial_tcp(connection.address.clone()),
            Link::Line { baud } => dial_line(&connection.address, connection.whole(baud)),
        };
        let (clock, wake) = (self.clock.clone(), Arc::clone(&self.wake));
        let (session, handle) = Session::new(antenna.controller(), antenna, dial, clock, wake);
        self.sessions.spawn_on(session.run(), &self.runtime);
        handle
    }
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
