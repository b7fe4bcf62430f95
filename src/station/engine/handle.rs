//! Handles on a running station for its owner and its clients.

use std::{
    io,
    net::SocketAddr,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        mpsc::{RecvTimeoutError, TryRecvError},
    },
    time::Duration,
};

use tokio::{
    io::{AsyncRead, AsyncWrite},
    sync::{Notify, mpsc, watch},
};

use super::{
    Engine, Settings,
    ports::{Board, converse},
    wake_of,
};
use crate::{
    clock::{Clock, Instant, Moment},
    contract::{
        Command, CommandOrigin, Event, Snapshot,
        control::ClientCommand,
        driver::{self, WireLog},
        passes::ListChoice,
    },
    driver::{Orders, Outside, Stopper},
    job::Wake,
    station::AntennaId,
};

/// Max number of pending requests; a client sends a few per frame.
const REQUESTS: usize = 256;
/// Max number of pending events.
const EVENTS: usize = 256;
/// Max time for a station to end: it reports its passes, and its sessions send and record their
/// last STOP.
const FAREWELL: Duration = Duration::from_secs(10);

/// Time without a publication after which a station counts as stuck.
const STANDS: Duration = Duration::from_secs(2);

/// Request to the station thread: a command with its origin, serial number and time.
pub(super) struct Request {
    pub(super) command: Command,
    pub(super) origin: CommandOrigin,
    pub(super) number: u64,
    pub(super) instant: Instant,
}

impl Request {
    /// Returns `true` for a held jog key.
    pub(super) fn is_jog(&self) -> bool {
        matches!(
            self.command,
            Command::Antenna(_, driver::Command::Jog { .. })
                | Command::Client(_, ClientCommand::Turn { .. })
        )
    }

    /// Returns `true` for a look at another pass that leaves the pass list unchanged.
    pub(super) fn is_look(&self, list: ListChoice) -> bool {
        matches!(self.command, Command::Look(attention) if attention.list == list)
    }
}

/// Items that must reach the station even if the queue of requests is full.
#[derive(Default)]
pub(super) struct Urgent {
    pub(super) stops: Vec<Stopped>,
    /// `true` if the program ends and cannot ask the operator.
    pub(super) ends_unasked: bool,
    /// `true` if the queue of requests was full.
    pub(super) has_turned_away: bool,
    /// `true` if the Azel that drives an antenna did not confirm STOP.
    pub(super) is_stop_lost: bool,
}

/// STOP that was already sent to the sessions.
#[derive(Debug, Clone)]
pub struct Stopped {
    pub instant: Instant,
    /// Origin of the STOP.
    pub origin: CommandOrigin,
    /// Antennas that received the STOP.
    pub antennas: Vec<AntennaId>,
    /// Antennas of another Azel; the station passes the STOP on to it.
    pub elsewhere: Vec<AntennaId>,
    /// Antennas in `antennas` that tracked at that time.
    pub(super) tracked: Vec<AntennaId>,
    /// `true` for a STOP of all antennas that are connected or were moved.
    pub(super) is_for_all: bool,
    /// Newest session at that time; later sessions did not receive this STOP.
    pub(super) newest_session: u64,
}

/// State that a station publishes.
#[derive(Clone)]
pub(super) struct Published {
    pub(super) snapshot: Arc<Snapshot>,
    /// Connections of each antenna, in the order of the antennas.
    pub(super) ends: Arc<[AntennaEnds]>,
}

/// Direct connections to an antenna's session, past the station.
pub(super) struct AntennaEnds {
    pub(super) id: AntennaId,
    pub(super) session: u64,
    /// `true` if another Azel drives the antenna.
    pub(super) is_elsewhere: bool,
    pub(super) stopper: Stopper,
    pub(super) wire: WireLog,
}

/// Interface of any client to a station. A client does not keep the station running.
#[derive(Clone)]
pub struct Client {
    requests: mpsc::WeakSender<Request>,
    urgent: Arc<Mutex<Urgent>>,
    woken: Arc<Notify>,
    orders: Orders,
    published: watch::Receiver<Published>,
    clock: Clock,
    origin: CommandOrigin,
    /// Connections of other programs to the station.
    board: Board,
}

impl Client {
    pub(super) fn new(
        requests: mpsc::WeakSender<Request>,
        woken: Arc<Notify>,
        orders: Orders,
        published: watch::Receiver<Published>,
        clock: Clock,
        origin: CommandOrigin,
    ) -> Self {
        let board = Board::new(wake_of(&woken));
        Self { requests, urgent: Arc::default(), woken, orders, published, clock, origin, board }
    }

    /// Returns a client whose commands have this origin in the record.
    #[must_use]
    pub fn acting_for(self, origin: CommandOrigin) -> Self {
        Self { origin, ..self }
    }

    /// Returns the clocks of the station.
    pub(super) fn clock(&self) -> &Clock {
        &self.clock
    }

    pub(super) fn board(&self) -> &Board {
        &self.board
    }

    /// Serves a program that `stream` connects to the port of an antenna, until the program hangs
    /// up or the port closes. `peer` is the program's address.
    pub async fn serve(
        &self,
        antenna: AntennaId,
        peer: SocketAddr,
        stream: impl AsyncRead + AsyncWrite,
    ) {
        let seat = self.board.seat(antenna, peer, None, self.clock.now().steady);
        if let Some(seat) = seat {
            converse(stream, seat, self.clone()).await;
        }
    }

    /// Returns the current time by the station's clocks.
    pub fn now(&self) -> Moment {
        self.clock.now()
    }

    /// Queues a command. Returns the command if the station has ended or is too busy; a busy
    /// station raises an alarm later.
    pub fn send(&self, command: Command) -> Result<(), Command> {
        self.send_numbered(command).map(drop)
    }

    /// Queues a command like [`Self::send`], and returns its number.
    pub(super) fn send_numbered(&self, command: Command) -> Result<u64, Command> {
        let number = self.orders.next();
        let Some(requests) = self.requests.upgrade() else { return Err(command) };
        let Ok(place) = requests.try_reserve() else {
            self.urgent().has_turned_away = true;
            return Err(command);
        };
        place.send(Request {
            command,
            origin: self.origin,
            number,
            instant: self.clock.now().steady,
        });
        Ok(number)
    }

    /// Stops every antenna that is connected or was moved from here, past every queue. A STOP is
    /// never refused. It also voids pending requests for the other antennas.
    pub fn stop_all(&self) -> Stopped {
        self.stop_those(None)
    }

    /// Stops one antenna, even if its unit must first be connected.
    pub fn stop(&self, antenna: AntennaId) -> Stopped {
        self.stop_those(Some(antenna))
    }

    fn stop_those(&self, one: Option<AntennaId>) -> Stopped {
        // Use the station's current antennas, not the shown ones.
        let ends = Arc::clone(&self.published.borrow().ends);
        let mut stopped = Stopped {
            instant: self.clock.now().steady,
            origin: self.origin,
            antennas: Vec::new(),
            elsewhere: Vec::new(),
            tracked: Vec::new(),
            is_for_all: one.is_none(),
            newest_session: ends.iter().map(|ends| ends.session).max().unwrap_or_default(),
        };
        let mut is_elsewhere = false;
        for AntennaEnds { id, stopper, is_elsewhere: is_held, .. } in ends.iter() {
            if *is_held && one.is_none_or(|one| *id == one) {
                is_elsewhere = true;
                stopped.elsewhere.push(*id);
            } else if one.map_or_else(|| stopper.is_wanted(), |one| *id == one) {
                // Check before the STOP: the session may react at once.
                if stopper.tracks() {
                    stopped.tracked.push(*id);
                }
                stopper.stop();
                stopped.antennas.push(*id);
            } else if one.is_none() {
                stopper.forget();
            }
        }
        // An antenna that is being reopened is missing from `ends`.
        if let Some(one) = one.filter(|_| stopped.antennas.is_empty() && !is_elsewhere) {
            stopped.antennas.push(one);
        }
        // Do not wake the station: it would take a processor from the session, whose work is more
        // urgent. The session wakes the station afterwards.
        self.urgent().stops.push(stopped.clone());
        if is_elsewhere {
            self.woken.notify_one();
        }
        stopped
    }

    pub(super) fn urgent(&self) -> MutexGuard<'_, Urgent> {
        // No code panics while it holds this lock, so the data is valid even if poisoned.
        self.urgent.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the last published snapshot.
    pub fn snapshot(&self) -> Arc<Snapshot> {
        Arc::clone(&self.published.borrow().snapshot)
    }

    /// Waits for the next snapshot. Returns `false` once the station has ended.
    pub async fn changed(&mut self) -> bool {
        self.published.changed().await.is_ok()
    }
}

/// Owner's handle on a running station. Dropping it ends the station, which first stops each jog.
pub struct Handle {
    client: Client,
    requests: mpsc::Sender<Request>,
    shown: Published,
    events: mpsc::Receiver<Event>,
    ended: std::sync::mpsc::Receiver<()>,
}

impl Handle {
    /// Starts a station on its own thread. The station calls `wake` after every visible change.
    pub fn start(settings: Settings, outside: impl Into<Outside>, wake: Wake) -> io::Result<Self> {
        let outside = outside.into();
        let (requests, inbox) = mpsc::channel(REQUESTS);
        let (tell, events) = mpsc::channel(EVENTS);
        let (begun, begin) = std::sync::mpsc::sync_channel(1);
        let (tell_ended, ended) = std::sync::mpsc::sync_channel(1);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build()?;
        let weak = requests.downgrade();
        std::thread::Builder::new().name("azel-station".to_owned()).spawn(move || {
            let at_end = Arc::clone(&wake);
            let outbox = super::Outbox { events: tell, wake };
            match Engine::new(&settings, outside, outbox, weak) {
                Ok((engine, client)) => {
                    // The caller may no longer wait for the client.
                    drop(begun.send(Ok(client)));
                    runtime.block_on(engine.run(inbox));
                }
                Err(error) => drop(begun.send(Err(error))),
            }
            let _ = tell_ended.send(());
            at_end();
        })?;
        let broken = |_| io::Error::other("the station broke down");
        let client = begin.recv().map_err(broken)??;
        let shown = client.published.borrow().clone();
        Ok(Self { client, requests, shown, events, ended })
    }

    /// Returns the client, for other parts that send commands or STOP.
    pub fn client(&self) -> &Client {
        &self.client
    }

    /// Takes the last published state. Returns `false` if it is unchanged since the last call.
    pub fn take(&mut self) -> bool {
        let is_new = self.client.published.has_changed().unwrap_or_default();
        if is_new {
            self.shown = self.client.published.borrow_and_update().clone();
        }
        is_new
    }

    /// Returns the last taken snapshot.
    pub fn snapshot(&self) -> &Arc<Snapshot> {
        &self.shown.snapshot
    }

    /// Returns the time without a publication, from two seconds on. A station normally publishes
    /// every second.
    pub fn stood_for(&self) -> Option<Duration> {
        let shown = self.client.published.borrow().snapshot.moment.steady;
        let stood = self.client.now().steady.saturating_duration_since(shown);
        (stood >= STANDS).then_some(stood)
    }

    /// Returns the wire log of an antenna.
    pub fn wire(&self, antenna: AntennaId) -> Option<WireLog> {
        let antenna_ends = self.shown.ends.iter().find(|ends| ends.id == antenna);
        antenna_ends.map(|ends| ends.wire.clone())
    }

    /// Takes the oldest unread event.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.try_recv().ok()
    }

    /// Returns `false` once the station no longer runs, for example after a panic.
    pub fn runs(&self) -> bool {
        !self.requests.is_closed()
    }

    /// Stops active antennas unless the station file says to leave them. Does not ask the operator.
    pub fn end_unasked(&self) {
        self.client.urgent().ends_unasked = true;
        self.client.woken.notify_one();
    }

    /// Begins to end the station. The last published state stays available.
    pub fn begin_end(&mut self) {
        let (closed, _) = mpsc::channel(1);
        self.requests = closed;
    }

    /// Returns `true` once the station has ended.
    pub fn has_ended(&self) -> bool {
        self.ended.try_recv() != Err(TryRecvError::Empty)
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        self.begin_end();
        // A station that panicked drops its sender, which ends this wait early.
        if self.ended.recv_timeout(FAREWELL) == Err(RecvTimeoutError::Timeout) {
            tracing::error!("the station did not end in time");
        }
    }
}
