//! Blocking worker thread that a test can keep busy.

use std::{future::Future, sync::mpsc};

/// Runs a test in paused time with one thread for blocking work.
pub(crate) fn with_one_worker(test: impl Future<Output = ()>) {
    let mut builder = tokio::runtime::Builder::new_current_thread();
    let runtime = builder.enable_all().start_paused(true).max_blocking_threads(1).build();
    runtime.unwrap().block_on(test);
}

/// Keeps the only thread for blocking work busy until the sender is dropped.
pub(crate) fn hold_up_workers() -> mpsc::SyncSender<()> {
    let (held_up, end) = mpsc::sync_channel(0);
    drop(tokio::task::spawn_blocking(move || end.recv()));
    held_up
}
