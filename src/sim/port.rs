//! A simulated unit on a TCP port.

use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::task::JoinSet;

/// How often a unit lives on while nobody asks.
const HEARTBEAT: Duration = Duration::from_millis(250);

/// A running unit; clones are handles of the same one.
pub(super) trait Unit: Clone + Send + 'static {
    /// Lets the unit live until now.
    fn live_on(&self);

    /// Serves one client until it leaves.
    fn serve_client(&self, stream: TcpStream) -> impl Future<Output = io::Result<()>> + Send;
}

/// A port on which a unit serves its clients.
#[derive(Debug)]
pub(super) struct Port<U> {
    listener: TcpListener,
    unit: U,
    places: Arc<Semaphore>,
}

impl<U: Unit> Port<U> {
    /// Listens at `address`. Further clients than `max_clients` are closed at once.
    pub(super) async fn bind(address: SocketAddr, unit: U, max_clients: usize) -> io::Result<Self> {
        Ok(Self {
            listener: TcpListener::bind(address).await?,
            unit,
            places: Arc::new(Semaphore::new(max_clients.min(Semaphore::MAX_PERMITS))),
        })
    }

    pub(super) fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    pub(super) fn unit(&self) -> &U {
        &self.unit
    }

    /// Serves clients. Dropping the future ends the connections.
    pub(super) async fn run(self) {
        let mut heartbeat = tokio::time::interval(HEARTBEAT);
        let mut clients = JoinSet::new();
        loop {
            tokio::select! {
                accepted = self.listener.accept() => match accepted {
                    Ok((stream, peer)) => {
                        let Ok(place) = Arc::clone(&self.places).try_acquire_owned() else {
                            tracing::info!(target: "azel::sim", %peer, "one client too many");
                            continue;
                        };
                        tracing::info!(target: "azel::sim", %peer, "client");
                        let unit = self.unit.clone();
                        clients.spawn(async move {
                            let _place = place;
                            // Small frames are to leave at once; without it they leave too.
                            stream.set_nodelay(true).ok();
                            let result = unit.serve_client(stream).await;
                            tracing::info!(target: "azel::sim", ?result, %peer, "client left");
                        });
                    }
                    // Out of handles, or the client is gone again: the next heartbeat
                    // comes before the next try.
                    Err(error) => {
                        tracing::warn!(target: "azel::sim", %error, "no client accepted");
                        heartbeat.tick().await;
                    }
                },
                Some(_) = clients.join_next() => {}
                _ = heartbeat.tick() => self.unit.live_on(),
            }
        }
    }
}
