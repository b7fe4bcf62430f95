//! The near end of a running station.

use std::{
    io,
    sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc::RecvTimeoutError},
    time::Duration,
};

use serde::{Deserialize, Serialize};
use tokio::sync::{Notify, mpsc, watch};

use super::{Command, Engine, Settings, Snapshot};
use crate::{
    clock::{Clock, Instant, Moment},
    driver::{self, Orders, Outside, Stopper, WireLog},
    job::Wake,
    station::AntennaId,
};

/// How many requests may wait: a client sends a few a frame.
const REQUESTS: usize = 256;
/// How many events may wait.
const EVENTS: usize = 256;
/// A station ends within this: its sessions say their last STOP.
const FAREWELL: Duration = Duration::from_secs(8);

/// A station that shows nothing new for so long stands.
const STANDS: Duration = Duration::from_secs(2);

/// What goes to the thread of a station: a command, its number among all that was asked
/// for, and when it was asked for.
pub(super) struct Request {
    pub(super) command: Command,
    pub(super) number: u64,
    pub(super) at: Instant,
}

impl Request {
    /// A key is held.
    pub(super) fn is_jog(&self) -> bool {
        matches!(self.command, Command::Antenna(_, driver::Command::Jog { .. }))
    }
}

/// What must reach the station however many requests wait.
#[derive(Default)]
pub(super) struct Urgent {
    pub(super) stops: Vec<Stopped>,
    /// The station ends, and nobody can be asked.
    pub(super) ends_unasked: bool,
    /// A request found no room.
    pub(super) has_turned_away: bool,
    /// STOP is not known to have been carried out by the Azel that drives an antenna.
    pub(super) is_stop_lost: bool,
}

/// A STOP that has gone to the sessions already.
#[derive(Debug, Clone)]
pub struct Stopped {
    /// When.
    pub at: Instant,
    /// The antennas that it went to.
    pub antennas: Vec<AntennaId>,
    /// Those that another Azel drives, which it is sent on to.
    pub elsewhere: Vec<AntennaId>,
    /// Those of `antennas` that tracked then.
    pub(super) tracked: Vec<AntennaId>,
    /// It was for all that are connected or were moved.
    pub(super) is_for_all: bool,
    /// Sessions that began later have not heard it.
    pub(super) newest_session: u64,
}

/// Something that a client is to know once.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// The station was saved at this time, or why not.
    Saved(Result<jiff::Timestamp, String>),
    /// The station has changed, and not by being saved.
    Changed,
    /// What was to be done before the end is done.
    MayEnd,
}

/// What a station publishes.
#[derive(Clone)]
pub(super) struct Published {
    pub(super) snapshot: Arc<Snapshot>,
    /// By the place of the antenna.
    pub(super) ends: Arc<[AntennaEnds]>,
}

/// What goes past the station to and from an antenna.
pub(super) struct AntennaEnds {
    pub(super) id: AntennaId,
    pub(super) session: u64,
    /// Another Azel drives it.
    pub(super) is_elsewhere: bool,
    pub(super) stopper: Stopper,
    pub(super) wire: WireLog,
}

/// What any client of a station can do. It does not keep the station running.
#[derive(Clone)]
pub struct Client {
    requests: mpsc::WeakSender<Request>,
    urgent: Arc<Mutex<Urgent>>,
    /// Wakes the station.
    woken: Arc<Notify>,
    orders: Orders,
    published: watch::Receiver<Published>,
    clock: Clock,
}

impl Client {
    pub(super) fn new(
        requests: mpsc::WeakSender<Request>,
        woken: Arc<Notify>,
        orders: Orders,
        published: watch::Receiver<Published>,
        clock: Clock,
    ) -> Self {
        Self { requests, urgent: Arc::default(), woken, orders, published, clock }
    }

    /// The clocks of the station.
    pub fn now(&self) -> Moment {
        self.clock.now()
    }

    /// Hands over a command. It comes back when the station is too busy to take it or
    /// has ended; a station that is too busy tells the operator when it is not any more.
    pub fn send(&self, command: Command) -> Result<(), Command> {
        let number = self.orders.next();
        let Some(requests) = self.requests.upgrade() else { return Err(command) };
        let Ok(place) = requests.try_reserve() else {
            self.urgent().has_turned_away = true;
            return Err(command);
        };
        place.send(Request { command, number, at: self.clock.now().steady });
        Ok(())
    }

    /// Stops every antenna that is connected or was moved from here: past every queue,
    /// never refused. What was asked of the others is void too.
    pub fn stop_all(&self) -> Stopped {
        self.stop_those(None)
    }

    /// Stops one antenna, also where that takes a connection.
    pub fn stop(&self, antenna: AntennaId) -> Stopped {
        self.stop_those(Some(antenna))
    }

    fn stop_those(&self, one: Option<AntennaId>) -> Stopped {
        // What the station has now, whatever is shown.
        let ends = Arc::clone(&self.published.borrow().ends);
        let mut stopped = Stopped {
            at: self.clock.now().steady,
            antennas: Vec::new(),
            elsewhere: Vec::new(),
            tracked: Vec::new(),
            is_for_all: one.is_none(),
            newest_session: ends.iter().map(|ends| ends.session).max().unwrap_or_default(),
        };
        let mut is_elsewhere = false;
        for AntennaEnds { id, stopper, is_elsewhere: held, .. } in ends.iter() {
            if *held && one.is_none_or(|one| *id == one) {
                is_elsewhere = true;
                stopped.elsewhere.push(*id);
            } else if one.map_or_else(|| stopper.is_wanted(), |one| *id == one) {
                // The session may be quicker than these lines.
                if stopper.tracks() {
                    stopped.tracked.push(*id);
                }
                stopper.stop();
                stopped.antennas.push(*id);
            } else if one.is_none() {
                stopper.forget();
            }
        }
        // One of an antenna that is opened anew right now is not among them.
        if let Some(one) = one.filter(|_| stopped.antennas.is_empty() && !is_elsewhere) {
            stopped.antennas.push(one);
        }
        // The station is not woken for it: it would take a processor from the session that
        // has something better to do, and that wakes it with what it has done.
        self.urgent().stops.push(stopped.clone());
        if is_elsewhere {
            self.woken.notify_one();
        }
        stopped
    }

    pub(super) fn urgent(&self) -> MutexGuard<'_, Urgent> {
        // No code panics while it holds the lock.
        self.urgent.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is published last.
    pub fn snapshot(&self) -> Arc<Snapshot> {
        Arc::clone(&self.published.borrow().snapshot)
    }

    /// Waits for the next snapshot; `false` when the station has ended.
    pub async fn changed(&mut self) -> bool {
        self.published.changed().await.is_ok()
    }
}

/// The near end of a running station. Dropping it ends the station: each jog with a
/// stop first.
pub struct Handle {
    client: Client,
    requests: mpsc::Sender<Request>,
    shown: Published,
    events: mpsc::Receiver<Event>,
    ended: std::sync::mpsc::Receiver<()>,
}

impl Handle {
    /// Starts a station on a thread of its own. `wake` is called from it after every
    /// change that is worth showing.
    pub fn start(settings: Settings, outside: impl Into<Outside>, wake: Wake) -> io::Result<Self> {
        let outside = outside.into();
        let (requests, inbox) = mpsc::channel(REQUESTS);
        let (tell, events) = mpsc::channel(EVENTS);
        let (begun, begin) = std::sync::mpsc::sync_channel(1);
        let (tell_ended, ended) = std::sync::mpsc::sync_channel(1);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build()?;
        let weak = requests.downgrade();
        std::thread::Builder::new().name("azel-station".to_owned()).spawn(move || {
            let outbox = super::Outbox { events: tell, wake };
            match Engine::new(&settings, outside, outbox, weak) {
                Ok((engine, client)) => {
                    // Nobody may be waiting any more.
                    drop(begun.send(Ok(client)));
                    runtime.block_on(engine.run(inbox));
                }
                Err(error) => drop(begun.send(Err(error))),
            }
            let _ = tell_ended.send(());
        })?;
        let gone = |_| io::Error::other("the station broke down");
        let client = begin.recv().map_err(gone)??;
        let shown = client.published.borrow().clone();
        Ok(Self { client, requests, shown, events, ended })
    }

    /// What else may send commands and stop.
    pub fn client(&self) -> &Client {
        &self.client
    }

    /// Takes what is published last; `false` where that is known already.
    pub fn take(&mut self) -> bool {
        let is_new = self.client.published.has_changed().unwrap_or_default();
        if is_new {
            self.shown = self.client.published.borrow_and_update().clone();
        }
        is_new
    }

    /// What was taken last.
    pub fn snapshot(&self) -> &Arc<Snapshot> {
        &self.shown.snapshot
    }

    /// For how long the station has shown nothing new, from two seconds on: it does
    /// each second.
    pub fn stood_for(&self) -> Option<Duration> {
        let shown = self.client.published.borrow().snapshot.at.steady;
        let stood = self.client.now().steady.saturating_duration_since(shown);
        (stood >= STANDS).then_some(stood)
    }

    /// What went over the link of an antenna.
    pub fn wire(&self, antenna: AntennaId) -> Option<WireLog> {
        let of = self.shown.ends.iter().find(|ends| ends.id == antenna);
        of.map(|ends| ends.wire.clone())
    }

    /// The oldest event that was not read yet.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.try_recv().ok()
    }

    /// Whether the station runs: it does not only where it broke down.
    pub fn runs(&self) -> bool {
        !self.requests.is_closed()
    }

    /// Does what the station file says for the end, where nobody can be asked.
    pub fn end_unasked(&self) {
        self.client.urgent().ends_unasked = true;
        self.client.woken.notify_one();
    }

    /// Begins to end the station. What is published last stays.
    pub fn begin_end(&mut self) {
        let (closed, _) = mpsc::channel(1);
        self.requests = closed;
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        self.begin_end();
        // One that broke down tells nothing.
        if self.ended.recv_timeout(FAREWELL) == Err(RecvTimeoutError::Timeout) {
            tracing::error!("the station did not end in time");
        }
    }
}
