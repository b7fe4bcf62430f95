//! Work that is too long for one frame. Each job runs on a named thread and has one result, or
//! [`BrokeOff`].

use std::{
    cell::Cell,
    marker::PhantomData,
    panic::{self, AssertUnwindSafe},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

/// Callback for any thread that has a new result or change for the receiver.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Error of work that panicked or got no thread; the log has the reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the work failed inside Azel")]
pub struct BrokeOff;

thread_local! {
    static RUNS_IN_PLACE: Cell<bool> = const { Cell::new(false) };
}

/// Guard that makes jobs of its thread run in place and end at once: in a rehearsal, no time passes
/// while they work.
pub struct InPlace(PhantomData<*const ()>);

impl InPlace {
    pub fn begin() -> Self {
        RUNS_IN_PLACE.set(true);
        Self(PhantomData)
    }
}

impl Drop for InPlace {
    fn drop(&mut self) {
        RUNS_IN_PLACE.set(false);
    }
}

/// Returns `true` if an [`InPlace`] lives on this thread.
pub fn is_in_place() -> bool {
    RUNS_IN_PLACE.get()
}

/// Work under way. Dropping the job cancels the work.
pub struct Job<T> {
    result: mpsc::Receiver<T>,
    cancelled: Arc<AtomicBool>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts `work` on a thread called `name`. The argument of `work` is a function that returns
    /// `true` once the job is dropped. Without a thread, the job ends with [`BrokeOff`].
    pub fn start(
        name: &str,
        wake: Wake,
        work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> T + Send + 'static,
    ) -> Self {
        let (send, result) = mpsc::sync_channel(1);
        let cancelled = Arc::new(AtomicBool::new(false));
        let (is_cancelled, wake_without) = (Arc::clone(&cancelled), Arc::clone(&wake));
        let whole = move || {
            // The result channel is dropped before the wake, also after a panic: a woken thread
            // then finds the end of the work.
            let _wake = WakeAtEnd(wake);
            let send = send;
            let outcome = work(&|| is_cancelled.load(Ordering::Relaxed));
            // The job may have been dropped.
            let _ = send.send(outcome);
        };
        if is_in_place() {
            // A caller that asks for the result receives `BrokeOff`.
            panic::catch_unwind(AssertUnwindSafe(whole)).ok();
        } else if let Err(error) = thread::Builder::new().name(name.to_owned()).spawn(whole) {
            tracing::error!(%error, name, "there is no thread for this work");
            wake_without();
        }
        Self { result, cancelled }
    }

    /// Waits for the result, at most `timeout`.
    pub fn wait(&self, timeout: Duration) -> Option<T> {
        self.result.recv_timeout(timeout).ok()
    }

    /// Returns the result once; `None` while the work goes on.
    pub fn end(&self) -> Option<Result<T, BrokeOff>> {
        match self.result.try_recv() {
            Ok(result) => Some(Ok(result)),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(BrokeOff)),
        }
    }

    /// Returns the result and clears `job`; `None` while the work goes on.
    pub fn take(job: &mut Option<Self>) -> Option<Result<T, BrokeOff>> {
        let end = job.as_ref()?.end()?;
        *job = None;
        Some(end)
    }
}

struct WakeAtEnd(Wake);

impl Drop for WakeAtEnd {
    fn drop(&mut self) {
        (self.0)();
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start<T: Send + 'static>(
        work: impl FnOnce() -> T + Send + 'static,
    ) -> (Option<Job<T>>, mpsc::Receiver<()>) {
        let (woken, wakes) = mpsc::sync_channel(1);
        let wake: Wake = Arc::new(move || woken.send(()).unwrap());
        (Some(Job::start("job", wake, move |_| work())), wakes)
    }

    #[test]
    fn work_goes_on_and_has_one_result() {
        let (go_on, waits) = mpsc::sync_channel(1);
        let (mut job, wakes) = start(move || waits.recv().unwrap());
        assert_eq!(Job::take(&mut job), None);
        go_on.send(7).unwrap();
        wakes.recv().unwrap();
        assert_eq!(Job::take(&mut job), Some(Ok(7)));
        assert!(job.is_none());
        assert_eq!(Job::take(&mut job), None);
    }

    #[test]
    fn work_that_panics_is_told_and_wakes_the_window() {
        let (mut job, wakes) = start(|| panic!("on purpose"));
        wakes.recv().unwrap();
        assert_eq!(Job::<()>::take(&mut job), Some(Err(BrokeOff)));
        assert!(job.is_none());
    }

    #[test]
    fn in_place_work_is_over_when_it_has_been_started() {
        let here = thread::current().id();
        let in_place = InPlace::begin();
        let (mut job, _wakes) = start(move || thread::current().id() == here);
        assert_eq!(Job::take(&mut job), Some(Ok(true)));
        let (mut broken, _wakes) = start(|| panic!("on purpose"));
        assert_eq!(Job::<()>::take(&mut broken), Some(Err(BrokeOff)));
        drop(in_place);
        let (mut job, wakes) = start(move || thread::current().id() == here);
        wakes.recv().unwrap();
        assert_eq!(Job::take(&mut job), Some(Ok(false)));
    }
}
