//! Ports on which other programs point the antennas with Hamlib's rotctld protocol. The ports run
//! on their own thread and are clients of the station like a window: they read snapshots and queue
//! commands. The rules of control decide about these commands.

mod answers;
mod board;
mod connection;
mod program;

use std::{collections::HashMap, io, net::SocketAddr, thread, time::Duration};

use tokio::{
    net::TcpListener,
    sync::{mpsc, watch},
    task::JoinHandle,
};

use super::Client;
use crate::{contract::control::PortState, station::AntennaId};
pub(super) use board::Board;
pub(super) use connection::converse;

/// Max number of connections per port; Azel refuses further connections.
const MAX_CONNECTIONS: usize = 16;
/// Pause before Azel tries again to listen on a port that another program has.
const TRIES_AGAIN: Duration = Duration::from_secs(5);

/// Ports to listen on.
type Addresses = HashMap<AntennaId, SocketAddr>;
/// State of each port.
type States = HashMap<AntennaId, PortState>;

/// Listening ports of a station. Dropping `Ports` closes them.
pub(super) struct Ports {
    addresses: watch::Sender<Addresses>,
    states: watch::Receiver<States>,
}

impl Ports {
    /// Starts the thread, which does not listen on any port yet.
    pub(super) fn start(station: Client) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let (addresses, address_changes) = watch::channel(Addresses::new());
        let (state_sender, states) = watch::channel(States::new());
        let server = Server { station, states: state_sender };
        thread::Builder::new().name("azel-ports".to_owned()).spawn(move || {
            runtime.block_on(server.run(address_changes));
        })?;
        Ok(Self { addresses, states })
    }

    /// Listens on exactly these ports.
    pub(super) fn listen(&self, ports: impl Iterator<Item = (AntennaId, SocketAddr)>) {
        let ports: Addresses = ports.collect();
        self.addresses.send_if_modified(|addresses| {
            let is_new = *addresses != ports;
            *addresses = ports;
            is_new
        });
    }

    /// Returns the state of an antenna's port.
    pub(super) fn state(&self, antenna: AntennaId) -> PortState {
        self.states.borrow().get(&antenna).cloned().unwrap_or_default()
    }
}

struct Server {
    station: Client,
    states: watch::Sender<States>,
}

impl Server {
    /// Opens and closes ports until the station ends.
    async fn run(self, mut addresses: watch::Receiver<Addresses>) {
        let mut open: HashMap<AntennaId, (SocketAddr, JoinHandle<()>)> = HashMap::new();
        let (report, mut reports) = mpsc::channel(MAX_CONNECTIONS);
        loop {
            let ports = addresses.borrow_and_update().clone();
            open.retain(|id, (address, listener)| {
                let stays = ports.get(id) == Some(address);
                if !stays {
                    listener.abort();
                    self.station.board().close(*id);
                    self.states.send_modify(|states| drop(states.remove(id)));
                }
                stays
            });
            for (id, address) in ports {
                open.entry(id).or_insert_with(|| {
                    let listener = listen(id, address, self.station.clone(), report.clone());
                    (address, tokio::spawn(listener))
                });
            }
            tokio::select! {
                changed = addresses.changed() => if changed.is_err() {
                    return;
                },
                Some((id, state)) = reports.recv() => {
                    self.states.send_modify(|states| drop(states.insert(id, state)));
                    self.station.board().wake();
                }
            }
        }
    }
}

/// Accepts the connections of one port.
async fn listen(
    antenna: AntennaId,
    address: SocketAddr,
    station: Client,
    report: mpsc::Sender<(AntennaId, PortState)>,
) {
    let listener = loop {
        match TcpListener::bind(address).await {
            Ok(listener) => break listener,
            Err(error) => {
                tracing::warn!(%address, %error, "the port cannot be opened");
                // The receiver outlives this task.
                let _ = report.send((antenna, PortState::Failed(error.to_string()))).await;
                tokio::time::sleep(TRIES_AGAIN).await;
            }
        }
    };
    let listening = listener.local_addr().unwrap_or(address);
    let _ = report.send((antenna, PortState::Listening(listening))).await;
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                // Send at once: answers are short, and clients wait for each answer.
                if let Err(error) = stream.set_nodelay(true) {
                    tracing::debug!(%peer, %error, "no quick answers");
                }
                let program = program::name(peer, listening);
                let Some(seat) = station.board().seat(antenna, peer, program, station.now().steady)
                else {
                    tracing::warn!(%peer, "all connections of the port are taken");
                    continue;
                };
                tokio::spawn(converse(stream, seat, station.clone()));
            }
            Err(error) => {
                tracing::warn!(%address, %error, "a connection");
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}
