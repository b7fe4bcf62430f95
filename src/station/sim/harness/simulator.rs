//! Simulated unit on a TCP port.

use std::{io, net::SocketAddr, sync::Arc, time::Duration};

use tokio::{net::TcpListener, sync::Semaphore, task::JoinSet};

use super::{Control, Unit};

/// Interval at which a unit advances without requests.
pub(in crate::sim) const HEARTBEAT: Duration = Duration::from_millis(250);

/// Unit that listens on a TCP port.
#[derive(Debug)]
pub struct Simulator<U: Unit> {
    listener: TcpListener,
    control: Control<U>,
    places: Arc<Semaphore>,
}

impl<U: Unit> Simulator<U> {
    /// Listens at `address`; port 0 selects a free port. Closes connections beyond `max_clients` at
    /// once.
    pub(in crate::sim) async fn listen(
        address: SocketAddr,
        control: Control<U>,
        max_clients: usize,
    ) -> io::Result<Self> {
        Ok(Self {
            listener: TcpListener::bind(address).await?,
            control,
            places: Arc::new(Semaphore::new(max_clients.min(Semaphore::MAX_PERMITS))),
        })
    }

    /// Returns the address at which the unit listens.
    pub fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Returns a handle for watching and disturbing the unit.
    pub fn control(&self) -> Control<U> {
        self.control.clone()
    }

    /// Serves clients. Dropping the future ends the unit and its connections.
    pub async fn run(self) {
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
                        let control = self.control.clone();
                        clients.spawn(async move {
                            let _place = place;
                            // Send small frames at once; a failure only delays them.
                            stream.set_nodelay(true).ok();
                            let result = control.serve(stream).await;
                            tracing::info!(target: "azel::sim", ?result, %peer, "client left");
                        });
                    }
                    // No handles are left, or the client has already gone: accept again after the
                    // next heartbeat.
                    Err(error) => {
                        tracing::warn!(target: "azel::sim", %error, "no client accepted");
                        heartbeat.tick().await;
                    }
                },
                Some(_) = clients.join_next() => {}
                _ = heartbeat.tick() => self.control.live_on(),
            }
        }
    }
}
