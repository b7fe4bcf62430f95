//! In-memory links between a session and a simulated unit.

use std::{
    io,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
};

use azel::{
    clock::Instant,
    driver::{Dial, Stream},
    sim::{Control, Unit},
};

/// A network that can be switched off; clones are the same network.
#[derive(Clone, Default)]
pub(crate) struct Network {
    is_off: Arc<AtomicBool>,
    dials: Arc<Mutex<Vec<Instant>>>,
}

impl Network {
    /// Returns a dial that opens links made by `link` while the network is on.
    pub(crate) fn dial(&self, mut link: impl FnMut() -> Box<dyn Stream> + Send + 'static) -> Dial {
        let network = self.clone();
        Box::new(move || {
            network.dials.lock().unwrap().push(Instant::now());
            if network.is_off.load(Ordering::Relaxed) {
                return Box::pin(async { Err(io::ErrorKind::ConnectionRefused.into()) });
            }
            let near = link();
            Box::pin(async { Ok(near) })
        })
    }

    /// Sets whether the network refuses new links.
    pub(crate) fn set_off(&self, is_off: bool) {
        self.is_off.store(is_off, Ordering::Relaxed);
    }

    pub(crate) fn dials(&self) -> Vec<Instant> {
        self.dials.lock().unwrap().clone()
    }
}

/// Returns a link that the unit serves.
pub(crate) fn link<U: Unit>(control: &Control<U>) -> Box<dyn Stream> {
    let (near, far) = tokio::io::duplex(4096);
    let control = control.clone();
    tokio::spawn(async move { control.serve(far).await });
    Box::new(near)
}
