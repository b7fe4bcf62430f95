//! Work that is too long for a frame, on a named thread, with one result.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use crate::driver::Wake;

/// A piece of work under way. Dropping it cancels it.
pub(super) struct Job<T> {
    result: mpsc::Receiver<T>,
    cancelled: Arc<AtomicBool>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts `work` on a thread called `name`. It is given a question that
    /// turns true when nobody wants the result any more.
    pub(super) fn start(
        name: &str,
        wake: Wake,
        work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> T + Send + 'static,
    ) -> io::Result<Self> {
        let (send, result) = mpsc::sync_channel(1);
        let cancelled = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&cancelled);
        thread::Builder::new().name(name.to_owned()).spawn(move || {
            let outcome = work(&|| asked.load(Ordering::Relaxed));
            // Nobody may be waiting any more.
            let _ = send.send(outcome);
            wake();
        })?;
        Ok(Self { result, cancelled })
    }

    /// Waits for the end of the work, at most this long.
    pub(super) fn wait(&self, most: Duration) -> Option<T> {
        self.result.recv_timeout(most).ok()
    }

    /// The result, once.
    pub(super) fn poll(&self) -> Option<T> {
        self.result.try_recv().ok()
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}
