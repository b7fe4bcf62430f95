//! Operating-system signals: STOP and the end of the program.

use std::{io, thread};

use super::Stopped;
use crate::driver;

/// Watches for signals on its own thread. USR1 calls `stop`, which is STOP for all antennas; the
/// first signal to end the program calls `end`.
pub fn watch(
    stop: impl Fn() -> Stopped + Send + 'static,
    end: impl FnOnce() + Send + 'static,
) -> io::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
    // Azel handles STOP until the process has ended.
    let watch = async move { tokio::join!(end_on_signal(end), stop_on_signal(stop)) };
    thread::Builder::new().name("azel-signals".to_owned()).spawn(move || {
        runtime.block_on(watch);
    })?;
    Ok(())
}

async fn end_on_signal(end: impl FnOnce()) {
    match driver::told_to_end().await {
        Ok(()) => end(),
        Err(error) => tracing::error!(%error, "signals are not heard"),
    }
}

#[cfg(unix)]
async fn stop_on_signal(stop_all: impl Fn() -> Stopped) {
    use tokio::signal::unix::{SignalKind, signal};
    let mut stop = match signal(SignalKind::user_defined1()) {
        Ok(stop) => stop,
        Err(error) => return tracing::error!(%error, "the signal for STOP is not heard"),
    };
    while stop.recv().await.is_some() {
        let stopped = stop_all();
        tracing::warn!("STOP by signal, to {} antennas", stopped.antennas.len());
    }
}

#[cfg(not(unix))]
async fn stop_on_signal(_: impl Fn() -> Stopped) {}
