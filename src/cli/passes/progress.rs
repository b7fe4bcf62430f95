//! A line on the terminal that tells how far long work is.

use std::{
    io::{self, IsTerminal as _, Write as _},
    sync::Mutex,
    time::{Duration, Instant},
};

/// Work that is done sooner needs no line.
const LONG: Duration = Duration::from_millis(700);
/// How often the line changes.
const PERIOD: Duration = Duration::from_millis(100);

/// Says nothing unless standard error is a terminal.
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

    /// `done` satellites are done. Called by all threads.
    pub(super) fn show(&self, done: usize) {
        // A thread that would have to wait has nothing newer to say.
        let Some(Ok(mut next)) = self.next.as_ref().map(Mutex::try_lock) else { return };
        let now = Instant::now();
        if now >= *next {
            *next = now + PERIOD;
            let percent = 100 * done / self.all.max(1);
            let _ = write!(io::stderr(), "\r{percent:3} % of {} satellites ", self.all);
        }
    }

    /// Takes the line away again.
    pub(super) fn end(&self) {
        if self.next.is_some() && self.start.elapsed() >= LONG {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
