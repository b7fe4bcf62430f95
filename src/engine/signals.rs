//! Signals of the operating system.

use std::{io, thread};

use super::Client;
use crate::driver;

/// Watches for signals on a thread of its own: USR1 is STOP for all antennas, and the
/// first one that asks for the end calls `end`.
pub fn watch(station: Client, end: impl FnOnce() + Send + 'static) -> io::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
    let watch = async move {
        tokio::select! {
            told = driver::told_to_end() => match told {
                Ok(()) => end(),
                Err(error) => tracing::error!(%error, "signals are not heard"),
            },
            error = stop_on_signal(station.clone()) => {
                tracing::error!(%error, "the signal for STOP is not heard");
                if driver::told_to_end().await.is_ok() {
                    end();
                }
            }
        }
        // Still STOP while the station ends.
        let _ = stop_on_signal(station).await;
    };
    thread::Builder::new()
        .name("azel-signals".to_owned())
        .spawn(move || runtime.block_on(watch))?;
    Ok(())
}

/// Never ends but for an error.
#[cfg(unix)]
async fn stop_on_signal(station: Client) -> io::Error {
    use tokio::signal::unix::{SignalKind, signal};
    let mut stop = match signal(SignalKind::user_defined1()) {
        Ok(stop) => stop,
        Err(error) => return error,
    };
    while stop.recv().await.is_some() {
        let stopped = station.stop_all();
        tracing::warn!("STOP by signal, to {} antennas", stopped.antennas.len());
    }
    std::future::pending().await
}

#[cfg(not(unix))]
async fn stop_on_signal(_: Client) -> io::Error {
    std::future::pending().await
}
