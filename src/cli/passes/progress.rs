//! Progress line on the terminal for long work.

use std::{
    io::{self, IsTerminal as _, Write as _},
    sync::Mutex,
    time::{Duration, Instant},
};

/// Duration below which work needs no progress line.
const LONG: Duration = Duration::from_millis(700);
/// Interval between changes of the line.
const PERIOD: Duration = Duration::from_millis(100);

/// Progress line; silent unless standard error is a terminal.
pub(super) struct Progress {
    all: usize,
    next: Option<Mutex<Instant>>,
    start: Instant,
}

impl Progress {
    pub(super) fn new(all: usize) -> Self {
        let start = Instant::now();
        let next = io::stderr().is_terminal().then(|| Mutex::new(start + LONG));
        Self { all, next, start }
    }

    /// Shows that `done` satellites are done. Called by all threads.
    pub(super) fn show(&self, done: usize) {
        // A thread that would have to wait has nothing newer to show.
        let Some(Ok(mut next)) = self.next.as_ref().map(Mutex::try_lock) else { return };
        let now = Instant::now();
        if now >= *next {
            *next = now + PERIOD;
            let percent = 100 * done / self.all.max(1);
            let _ = write!(io::stderr(), "\r{percent:3} % of {} satellites ", self.all);
        }
    }

    /// Removes the line.
    pub(super) fn end(&self) {
        if self.next.is_some() && self.start.elapsed() >= LONG {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
