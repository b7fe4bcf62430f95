//! The near end of a running station.

use std::{
    io,
    sync::Arc,
    time::{Duration, Instant},
};

use tokio::sync::{mpsc, watch};

use super::{Command, Engine, Settings, Snapshot, antenna::AntennaId};
use crate::{
    clock::Clock,
    driver::{Orders, Stopper, WireLog},
    job::Wake,
};

/// How many requests may wait: a client sends a few a frame.
const REQUESTS: usize = 256;
/// How many events may wait.
const EVENTS: usize = 256;
/// A station ends within this: its sessions say their last STOP.
const FAREWELL: Duration = Duration::from_secs(8);

/// What goes to the thread of a station.
pub(super) enum Request {
    /// With its number among all that was asked for.
    Command(Command, u64),
    /// STOP went to these antennas.
    Stopped(Vec<AntennaId>, Instant),
    /// The station ends, and nobody can be asked.
    EndUnasked,
}

/// Something that a client is to know once.
#[derive(Debug, Clone, PartialEq)]
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
    pub(super) stopper: Stopper,
    pub(super) wire: WireLog,
}

/// What any client of a station can do. It does not keep the station running.
#[derive(Clone)]
pub struct Client {
    requests: mpsc::WeakSender<Request>,
    orders: Orders,
    published: watch::Receiver<Published>,
}

impl Client {
    pub(super) fn new(
        requests: mpsc::WeakSender<Request>,
        orders: Orders,
        published: watch::Receiver<Published>,
    ) -> Self {
        Self { requests, orders, published }
    }

    /// Hands over a command. It comes back when the station is too busy to take it or
    /// has ended, which must be told to the operator.
    pub fn send(&self, command: Command) -> Result<(), Command> {
        let number = self.orders.next();
        let Some(requests) = self.requests.upgrade() else { return Err(command) };
        match requests.try_reserve() {
            Ok(place) => {
                place.send(Request::Command(command, number));
                Ok(())
            }
            Err(_) => Err(command),
        }
    }

    /// Stops every antenna that is connected or was moved from here: past every queue,
    /// never refused. Those that it goes to.
    pub fn stop_all(&self) -> Vec<AntennaId> {
        self.stop_those(|ends| ends.stopper.is_wanted())
    }

    /// Stops one antenna, also where that takes a connection.
    pub fn stop(&self, antenna: AntennaId) -> Vec<AntennaId> {
        self.stop_those(|ends| ends.id == antenna)
    }

    fn stop_those(&self, wanted: impl Fn(&AntennaEnds) -> bool) -> Vec<AntennaId> {
        // What the station has now, whatever is shown.
        let ends = Arc::clone(&self.published.borrow().ends);
        let stopped: Vec<AntennaId> = (ends.iter().filter(|ends| wanted(ends)))
            .map(|ends| {
                ends.stopper.stop();
                ends.id
            })
            .collect();
        // A station that is too busy to hear of it shows what the sessions tell.
        self.request(Request::Stopped(stopped.clone(), Instant::now()));
        stopped
    }

    fn request(&self, request: Request) {
        if let Some(requests) = self.requests.upgrade() {
            drop(requests.try_send(request));
        }
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
    pub fn start(settings: Settings, clock: Clock, wake: Wake) -> io::Result<Self> {
        let (requests, inbox) = mpsc::channel(REQUESTS);
        let (tell, events) = mpsc::channel(EVENTS);
        let (begun, begin) = std::sync::mpsc::sync_channel(1);
        let (tell_ended, ended) = std::sync::mpsc::sync_channel(1);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build()?;
        let weak = requests.downgrade();
        std::thread::Builder::new().name("azel-station".to_owned()).spawn(move || {
            let outbox = super::Outbox { events: tell, wake };
            match Engine::new(&settings, clock, outbox, weak) {
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

    /// Takes what is published last.
    pub fn take(&mut self) -> &Arc<Snapshot> {
        if self.client.published.has_changed().unwrap_or_default() {
            self.shown = self.client.published.borrow_and_update().clone();
        }
        &self.shown.snapshot
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
        self.client.request(Request::EndUnasked);
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        let (closed, _) = mpsc::channel(1);
        drop(std::mem::replace(&mut self.requests, closed));
        if self.ended.recv_timeout(FAREWELL).is_err() {
            tracing::error!("the station did not end in time");
        }
    }
}
