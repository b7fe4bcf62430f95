//! Transfer in progress on its own thread.

use std::{
    future::Future,
    io,
    sync::mpsc::{self, TryRecvError},
    thread,
};

use tokio::{runtime, sync::watch};
use tokio_util::sync::CancellationToken;

use crate::{contract::transfer::Progress, job::Wake};

/// Transfer in progress. Dropping it cancels the transfer.
///
/// A transfer has its own thread and runtime because it unlocks keys and hashes files, which must
/// not delay a STOP.
pub struct Transfer<T> {
    progress: watch::Receiver<Option<Progress>>,
    result: mpsc::Receiver<T>,
    cancel: CancellationToken,
}

impl<T: Send + 'static> Transfer<T> {
    /// Starts the future that `work` makes, on a thread called `name`. `work` gets a callback for
    /// progress and a token for cancellation. The thread calls `wake` after each progress and at
    /// the end.
    pub fn start<F: Future<Output = T>>(
        name: &str,
        wake: Wake,
        work: impl FnOnce(Box<dyn FnMut(Progress)>, CancellationToken) -> F + Send + 'static,
    ) -> io::Result<Self> {
        let runtime = runtime::Builder::new_current_thread().enable_all().build()?;
        let (send_progress, progress) = watch::channel(None);
        let (send_result, result) = mpsc::sync_channel(1);
        let cancel = CancellationToken::new();
        let cancelled = cancel.clone();
        thread::Builder::new().name(name.to_owned()).spawn(move || {
            let notify = wake.clone();
            let tell = Box::new(move |progress| {
                send_progress.send_replace(Some(progress));
                notify();
            });
            let outcome = runtime.block_on(work(tell, cancelled));
            // The receiver may be gone already.
            let _ = send_result.send(outcome);
            wake();
            // Do not wait for a cancelled web request, which ends by its own timeout.
            runtime.shutdown_background();
        })?;
        Ok(Self { progress, result, cancel })
    }

    /// Returns the latest progress, if the work reports any.
    pub fn progress(&self) -> Option<Progress> {
        *self.progress.borrow()
    }

    /// Returns the result once. An error means that the work broke off without a result.
    pub fn poll(&self) -> Option<Result<T, BrokenOff>> {
        match self.result.try_recv() {
            Ok(result) => Some(Ok(result)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(BrokenOff)),
        }
    }

    /// Cancels the work. Its result still arrives and says where the work ended.
    pub fn cancel(&self) {
        self.cancel.cancel();
    }
}

impl<T> Drop for Transfer<T> {
    fn drop(&mut self) {
        self.cancel.cancel();
    }
}

/// Error of a transfer that ended without a result: a fault of Azel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the transfer failed inside Azel; look at the unit's folder and try again")]
pub struct BrokenOff;

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::contract::transfer::UploadStep;

    /// Starts `work` and returns the receiver of its wakes.
    fn start<F: Future<Output = u8>>(
        work: impl FnOnce(Box<dyn FnMut(Progress)>, CancellationToken) -> F + Send + 'static,
    ) -> (Transfer<u8>, mpsc::Receiver<()>) {
        let (send, woken) = mpsc::sync_channel(8);
        let wake: Wake = Arc::new(move || send.send(()).unwrap());
        (Transfer::start("test", wake, work).unwrap(), woken)
    }

    #[test]
    fn progress_and_result_arrive_and_wake() {
        let now = Progress { step: UploadStep::Write, done_bytes: 1, file_bytes: 2 };
        let (transfer, woken) = start(move |mut tell, _| async move {
            tell(now);
            7
        });
        woken.recv().unwrap();
        woken.recv().unwrap();
        assert_eq!(transfer.progress(), Some(now));
        assert_eq!(transfer.poll(), Some(Ok(7)));
        assert!(matches!(transfer.poll(), None | Some(Err(BrokenOff))));
    }

    #[test]
    fn a_cancel_and_a_drop_reach_the_work() {
        let wait = |_, cancel: CancellationToken| async move {
            cancel.cancelled().await;
            9
        };
        let (transfer, woken) = start(wait);
        assert_eq!(transfer.poll(), None);
        transfer.cancel();
        woken.recv().unwrap();
        assert_eq!(transfer.poll(), Some(Ok(9)));
        let (transfer, woken) = start(wait);
        drop(transfer);
        woken.recv().unwrap();
    }
}
