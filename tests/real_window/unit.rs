//! A simulated Satrak in this process, on a real socket. It accepts one client at a time and
//! records the requests of each with their times.

use std::{
    net::SocketAddr,
    sync::{Arc, Mutex},
    time::Duration,
};

use azel::{
    astro::Site,
    clock::Instant,
    orbit,
    sim::satrak::{BUNDLED_FILE, Control, Options},
};
use jiff::Timestamp;
use tokio::{net::TcpListener, runtime::Runtime};

use super::screen::wait_for;

/// Payload that a held X+ key sends.
const MOVE: &str = "MOVE=,0.5,0";
const STOP: &str = "STOP=";

pub(super) struct Unit {
    pub(super) address: SocketAddr,
    control: Control,
    /// Times at which the served clients connected.
    clients: Arc<Mutex<Vec<Instant>>>,
    _runtime: Runtime,
}

impl Unit {
    pub(super) fn start() -> Self {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .thread_name("satrak")
            .enable_all()
            .build()
            .expect("a runtime");
        let _entered = runtime.enter();
        let bundled = orbit::bundled().expect("elements").iter().cloned().collect();
        let control = Control::new(&Options {
            elements: [(BUNDLED_FILE.to_owned(), bundled)].into(),
            ..Options::new(Site::default(), Timestamp::now())
        });
        let listener = runtime.block_on(TcpListener::bind("127.0.0.1:0")).expect("a port");
        let address = listener.local_addr().expect("an address");
        let clients = Arc::<Mutex<Vec<Instant>>>::default();
        runtime.spawn(serve(listener, control.clone(), Arc::clone(&clients)));
        Self { address, control, clients, _runtime: runtime }
    }

    /// Returns the payloads received since then, with their times.
    pub(super) fn heard_since(&self, since: Instant) -> Vec<(Instant, String)> {
        let heard = self.control.received().into_iter();
        heard.filter(|(at, _)| *at >= since).collect()
    }

    fn hears_since(&self, since: Instant, word: &str) -> Option<Instant> {
        self.heard_since(since)
            .into_iter()
            .find(|(_, heard)| heard.starts_with(word))
            .map(|it| it.0)
    }

    pub(super) fn is_told_to_move_since(&self, since: Instant) -> bool {
        self.hears_since(since, MOVE).is_some()
    }

    pub(super) fn is_told_to_stop_since(&self, since: Instant) -> bool {
        self.hears_since(since, STOP).is_some()
    }

    /// Waits for STOP, and then until the antenna stands. Returns the time that STOP took.
    pub(super) fn wait_for_stop(&self, since: Instant) -> Duration {
        let at = wait_for("STOP", || self.hears_since(since, STOP));
        wait_for("standstill", || (!self.is_moving()).then_some(()));
        at.saturating_duration_since(since)
    }

    pub(super) fn is_moving(&self) -> bool {
        self.control.state().is_moving
    }

    /// Returns the times at which the clients connected, newest last.
    pub(super) fn clients(&self) -> Vec<Instant> {
        self.clients.lock().expect("nobody panics with it").clone()
    }

    /// Waits until a client has asked twice for the status.
    pub(super) fn wait_until_read_since(&self, since: Instant) {
        wait_for("the state to be read", || {
            let heard = self.heard_since(since);
            let asked = heard.iter().filter(|(_, word)| word.starts_with("STATUS?")).count();
            (asked >= 2).then_some(())
        });
    }
}

/// Serves one client at a time, and closes the connection of any other.
async fn serve(listener: TcpListener, control: Control, clients: Arc<Mutex<Vec<Instant>>>) {
    let place = Arc::new(tokio::sync::Semaphore::new(1));
    while let Ok((stream, _)) = listener.accept().await {
        let Ok(taken) = Arc::clone(&place).try_acquire_owned() else { continue };
        clients.lock().expect("nobody panics with it").push(Instant::now());
        let control = control.clone();
        tokio::spawn(async move {
            let _taken = taken;
            stream.set_nodelay(true).ok();
            // Ignore how the client leaves.
            let _ = control.serve(stream).await;
        });
    }
}
