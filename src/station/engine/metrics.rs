//! Metrics of the station for monitoring programs: `GET /metrics` in the `OpenMetrics` format.
//!
//! The server runs on its own thread, and only while the station file sets a port. It reads the
//! published snapshot and can neither send a command nor reach a session.

mod antenna;
mod connection;
mod families;
mod http;
mod process;
mod station;

use std::{
    collections::VecDeque,
    io,
    net::SocketAddr,
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::Duration,
};

use tokio::{
    io::{AsyncRead, AsyncWrite},
    net::TcpListener,
    sync::watch,
    task::JoinHandle,
};

use super::{Client, Engine, StationClaim};
use crate::{
    clock::{Instant, Moment},
    contract::{Snapshot, control::PortState},
    job::Wake,
};
use families::Families;

/// Max number of connections. A new connection ends the oldest one, so that slow clients cannot
/// lock others out.
const MAX_CONNECTIONS: usize = 8;
/// Time for which Azel answers with the same text, so that a flood of requests costs little.
const FRESH: Duration = Duration::from_secs(1);
/// Pause before Azel tries again to listen on a port that another program has.
const TRIES_AGAIN: Duration = Duration::from_secs(5);

/// Server of the metrics. Dropping it closes the port.
pub(super) struct Metrics {
    station: Client,
    server: Option<Server>,
}

/// Thread of the server, once a port was set.
struct Server {
    address: watch::Sender<Option<SocketAddr>>,
    state: watch::Receiver<PortState>,
}

impl Metrics {
    pub(super) fn new(station: Client) -> Self {
        Self { station, server: None }
    }

    /// Listens on this port, or on none. `wake` is called after each change of the port's state.
    fn listen(&mut self, address: Option<SocketAddr>, wake: &Wake) {
        if self.server.is_none() && address.is_some() {
            match Server::start(self.station.clone(), Arc::clone(wake)) {
                Ok(server) => self.server = Some(server),
                Err(error) => tracing::error!(%error, "no thread for the metrics"),
            }
        }
        let Some(server) = &self.server else { return };
        server.address.send_if_modified(|current| {
            let is_new = *current != address;
            *current = address;
            is_new
        });
    }

    /// Returns the state of the port.
    pub(super) fn state(&self) -> PortState {
        self.server.as_ref().map(|server| server.state.borrow().clone()).unwrap_or_default()
    }
}

impl Engine {
    /// Opens and closes the port for metrics according to the settings. Only the Azel that has the
    /// station opens it.
    pub(super) fn open_metrics(&mut self) {
        let is_ours = !matches!(self.station_claim, StationClaim::Theirs(_));
        let port = self.station.metrics.filter(|port| is_ours && !port.lacks_permission());
        if let Some(metrics) = &mut self.metrics {
            metrics.listen(port.map(|port| port.listen), &self.wake);
        }
    }
}

impl Client {
    /// Answers one request for the metrics on `stream`.
    pub async fn scrape(&self, stream: impl AsyncRead + AsyncWrite) {
        connection::answer(stream, &Scrapes::new(self.clone())).await;
    }
}

impl Server {
    fn start(station: Client, wake: Wake) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let (address, addresses) = watch::channel(None);
        let (state_sender, state) = watch::channel(PortState::Closed);
        thread::Builder::new().name("azel-metrics".to_owned()).spawn(move || {
            let scrapes = Arc::new(Scrapes::new(station));
            let report = |state| {
                state_sender.send_replace(state);
                wake();
            };
            runtime.block_on(serve(scrapes, addresses, report));
        })?;
        Ok(Self { address, state })
    }
}

/// Serves the current port until the station ends.
async fn serve(
    scrapes: Arc<Scrapes>,
    mut addresses: watch::Receiver<Option<SocketAddr>>,
    report: impl Fn(PortState),
) {
    loop {
        let address = *addresses.borrow_and_update();
        let listening = async {
            match address {
                Some(address) => listen(address, &scrapes, &report).await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            changed = addresses.changed() => if changed.is_err() {
                return;
            },
            () = listening => {}
        }
        report(PortState::Closed);
    }
}

/// Accepts connections to one port. Never returns.
async fn listen(address: SocketAddr, scrapes: &Arc<Scrapes>, report: &impl Fn(PortState)) {
    let listener = loop {
        match TcpListener::bind(address).await {
            Ok(listener) => break listener,
            Err(error) => {
                tracing::warn!(%address, %error, "the port for metrics cannot be opened");
                report(PortState::Failed(error.to_string()));
                tokio::time::sleep(TRIES_AGAIN).await;
            }
        }
    };
    report(PortState::Listening(listener.local_addr().unwrap_or(address)));
    let mut connections = Connections::default();
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                let scrapes = Arc::clone(scrapes);
                connections.add(tokio::spawn(async move {
                    connection::answer(stream, &scrapes).await;
                }));
            }
            Err(error) => {
                tracing::warn!(%address, %error, "a connection for metrics");
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}

/// Tasks of the connections, oldest first. Dropping the list ends all of them.
#[derive(Default)]
struct Connections(VecDeque<JoinHandle<()>>);

impl Connections {
    fn add(&mut self, connection: JoinHandle<()>) {
        self.0.retain(|connection| !connection.is_finished());
        if self.0.len() >= MAX_CONNECTIONS
            && let Some(oldest) = self.0.pop_front()
        {
            oldest.abort();
        }
        self.0.push_back(connection);
    }
}

impl Drop for Connections {
    fn drop(&mut self) {
        for connection in &self.0 {
            connection.abort();
        }
    }
}

/// Texts for the clients, each used for a second.
struct Scrapes {
    station: Client,
    last: Mutex<Option<(Instant, Arc<str>)>>,
}

impl Scrapes {
    fn new(station: Client) -> Self {
        Self { station, last: Mutex::new(None) }
    }

    /// Returns the metrics, at most a second old; `None` if they cannot be written as text.
    fn text(&self) -> Option<Arc<str>> {
        // No code panics while it holds this lock, so the data is valid even if poisoned.
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let now = self.station.now();
        if let Some((time, text)) = &*last
            && now.steady.saturating_duration_since(*time) < FRESH
        {
            return Some(Arc::clone(text));
        }
        let text: Arc<str> = text_of(&self.station.snapshot(), now)
            .inspect_err(|error| tracing::error!(%error, "the metrics cannot be written"))
            .ok()?
            .into();
        *last = Some((now.steady, Arc::clone(&text)));
        Some(text)
    }
}

/// Returns the text of all metrics that a snapshot shows at `now`.
fn text_of(snapshot: &Snapshot, now: Moment) -> Result<String, std::fmt::Error> {
    let metrics = station::METRICS.into_iter().chain(antenna::METRICS).chain(process::METRICS);
    let mut families = Families::new(metrics);
    station::add(&mut families, snapshot, now);
    for model in &snapshot.antennas {
        antenna::add(&mut families, model, &snapshot.schedule.schedule, now);
    }
    process::add(&mut families);
    families.into_text()
}
