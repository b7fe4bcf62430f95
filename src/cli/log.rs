//! Log on standard error, which never waits for its reader.
//!
//! Lines go into a queue of limited size, and a separate thread writes them. While nobody
//! reads (a stopped pager, a terminal after Ctrl S), further lines are dropped and
//! counted, and the count is the next line that is written.
//!
//! Invariant: while the window is open, nothing else of Azel writes to standard error, for
//! the standard library would lock it to one thread at a time.

use std::{
    env,
    ffi::OsStr,
    io::{self, IsTerminal as _, Write},
    mem,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread,
    time::Duration,
};

use jiff::Timestamp;
use tracing_subscriber::{
    filter::Targets, fmt::MakeWriter, layer::SubscriberExt as _, util::SubscriberInitExt as _,
};

/// Size limit of the queue in bytes: some thousand lines.
const MAX_BYTES: usize = 1 << 20;
/// Time that the end of the program waits for a reader.
const FAREWELL: Duration = Duration::from_secs(1);

/// Variable of the environment that sets the filter of the log.
const FILTER: &str = "AZEL_LOG";
const INVALID_FILTER: &str = "AZEL_LOG is not a valid filter, so the default applies. \
                              Write levels and parts of the program, such as “warn,azel=info”.";

/// Log of this process.
#[derive(Clone)]
pub struct Log {
    lines: Lines,
}

/// Queue of lines for a reader who is never waited for.
#[derive(Clone)]
pub struct Lines {
    queue: Arc<Queue>,
}

/// Line that reports a number of dropped lines.
type OfDropped = fn(u64) -> String;

#[derive(Default)]
struct Queue {
    waiting: Mutex<Waiting>,
    filled: Condvar,
    written: Condvar,
}

#[derive(Default)]
struct Waiting {
    /// Complete lines.
    text: Vec<u8>,
    /// Number of lines dropped behind `text`.
    dropped: u64,
    /// Lines taken from the queue are still being written.
    is_writing: bool,
}

impl Log {
    /// Starts the log of this process, filtered by `AZEL_LOG`, or by `default` if that is
    /// missing, empty or invalid. The log reports an invalid filter.
    pub fn start(default: Targets) -> io::Result<Self> {
        let log = Self { lines: Lines::writing_to(standard(io::stderr())?, of_dropped_in_log)? };
        let chosen = env::var_os(FILTER).filter(|filter| !filter.is_empty());
        let (filter, is_invalid) = match chosen.as_deref().map(parse) {
            Some(Some(filter)) => (filter, false),
            Some(None) => (default, true),
            None => (default, false),
        };
        let wants_plain = env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let lines = tracing_subscriber::fmt::layer()
            .with_ansi(io::stderr().is_terminal() && !wants_plain)
            .with_writer(log.clone());
        tracing_subscriber::registry().with(filter).with(lines).init();
        if is_invalid {
            log.say(INVALID_FILTER);
        }
        Ok(log)
    }

    /// Adds a line, whatever the filter.
    pub fn say(&self, line: &str) {
        self.lines.say(line);
    }

    /// Waits until everything is written, at most a second.
    pub fn finish(&self) {
        self.lines.finish();
    }
}

/// Returns `None` if `filter` is not a list of levels and targets.
fn parse(filter: &OsStr) -> Option<Targets> {
    filter.to_str()?.parse().ok()
}

fn of_dropped_in_log(dropped: u64) -> String {
    let now = Timestamp::now();
    format!(
        "{now:.6}  WARN azel::cli::log: {dropped} lines of the log were dropped: \
         standard error was not read"
    )
}

impl Lines {
    /// Queue of lines for standard output.
    pub fn to_standard_output(of_dropped: OfDropped) -> io::Result<Self> {
        Self::writing_to(standard(io::stdout())?, of_dropped)
    }

    fn writing_to(
        mut sink: impl Write + Send + 'static,
        of_dropped: OfDropped,
    ) -> io::Result<Self> {
        let queue = Arc::<Queue>::default();
        let far = Arc::clone(&queue);
        thread::Builder::new().name("azel-log".to_owned()).spawn(move || {
            loop {
                let (text, dropped) = far.take();
                write(&mut sink, &text, dropped, of_dropped);
                far.wrote();
            }
        })?;
        Ok(Self { queue })
    }

    pub fn say(&self, line: &str) {
        self.queue.push(format!("{line}\n").as_bytes());
    }

    /// Waits until everything is written, at most a second.
    pub fn finish(&self) {
        self.finish_within(FAREWELL);
    }

    fn finish_within(&self, timeout: Duration) {
        let is_pending = |waiting: &mut Waiting| waiting.is_writing || !waiting.text.is_empty();
        drop(self.queue.written.wait_timeout_while(self.queue.lock(), timeout, is_pending));
    }
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, line: &[u8]) {
        let mut waiting = self.lock();
        // Lines dropped then belong behind all waiting lines, and before all that come after the
        // thread's next look.
        if waiting.dropped > 0 || waiting.text.len() + line.len() > MAX_BYTES {
            waiting.dropped += 1;
        } else {
            waiting.text.extend_from_slice(line);
        }
        self.filled.notify_one();
    }

    /// Waits for lines, and returns them with the number dropped behind them.
    fn take(&self) -> (Vec<u8>, u64) {
        let is_empty = |waiting: &mut Waiting| waiting.text.is_empty() && waiting.dropped == 0;
        let waiting = self.filled.wait_while(self.lock(), is_empty);
        let mut waiting = waiting.unwrap_or_else(PoisonError::into_inner);
        waiting.is_writing = true;
        (mem::take(&mut waiting.text), mem::take(&mut waiting.dropped))
    }

    fn wrote(&self) {
        self.lock().is_writing = false;
        self.written.notify_all();
    }
}

/// Writes `text`, then the number of lines `dropped` behind it.
fn write(sink: &mut impl Write, text: &[u8], dropped: u64, of_dropped: OfDropped) {
    // An error is ignored: the stream is closed.
    let _ = sink.write_all(text);
    if dropped > 0 {
        let _ = writeln!(sink, "{}", of_dropped(dropped));
    }
    let _ = sink.flush();
}

/// Opens a standard stream without the standard library's lock: a thread waiting in it
/// would hold up all others that write there.
#[cfg(unix)]
fn standard(stream: impl std::os::fd::AsFd) -> io::Result<std::fs::File> {
    Ok(stream.as_fd().try_clone_to_owned()?.into())
}

/// On Windows a console accepts text only through the standard library.
#[cfg(not(unix))]
fn standard<T: Write + Send + 'static>(stream: T) -> io::Result<T> {
    Ok(stream)
}

/// A complete line from the subscriber.
pub struct LineWriter<'a>(&'a Queue);

impl Write for LineWriter<'_> {
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        self.0.push(line);
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<'a> MakeWriter<'a> for Log {
    type Writer = LineWriter<'a>;

    fn make_writer(&'a self) -> LineWriter<'a> {
        LineWriter(&self.lines.queue)
    }
}

#[cfg(test)]
mod tests {
    use std::{
        sync::mpsc::{Receiver, SyncSender, sync_channel},
        time::Instant,
    };

    use super::*;

    /// Sink that blocks until it is released, then accepts everything.
    struct Sink {
        reached: SyncSender<()>,
        opened: Receiver<()>,
        is_open: bool,
        text: Arc<Mutex<String>>,
    }

    impl Write for Sink {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if !self.is_open {
                self.reached.send(()).unwrap();
                self.is_open = self.opened.recv().is_ok();
            }
            self.text.lock().unwrap().push_str(std::str::from_utf8(bytes).unwrap());
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    /// A log with a blocked sink: its lines, the signal of the first write, the release, and
    /// the text written.
    fn blocked() -> (Lines, Receiver<()>, SyncSender<()>, Arc<Mutex<String>>) {
        let (reach, reached) = sync_channel(1);
        let (open, opened) = sync_channel(1);
        let text = Arc::default();
        let sink = Sink { reached: reach, opened, is_open: false, text: Arc::clone(&text) };
        (Lines::writing_to(sink, of_dropped_in_log).unwrap(), reached, open, text)
    }

    #[test]
    fn a_sink_that_takes_nothing_holds_up_nobody() {
        let (log, _reached, _open, text) = blocked();
        let start = Instant::now();
        for _ in 0..100 {
            log.say(&"x".repeat(MAX_BYTES / 10));
        }
        log.say(&"x".repeat(10 * MAX_BYTES));
        log.finish_within(Duration::from_millis(50));
        assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
        assert!(log.queue.lock().text.len() <= MAX_BYTES);
        assert_eq!(*text.lock().unwrap(), "");
    }

    #[test]
    fn the_number_of_dropped_lines_stands_where_they_would_have_stood() {
        let (log, reached, open, text) = blocked();
        log.say("first");
        // Otherwise the thread would look again in the middle of the following steps.
        reached.recv().unwrap();
        for number in 0..20 {
            log.say(&format!("{number} {}", "x".repeat(MAX_BYTES / 10)));
        }
        open.send(()).unwrap();
        log.finish_within(Duration::from_secs(20));
        log.say("after");
        log.finish_within(Duration::from_secs(20));
        let text = text.lock().unwrap();
        let starts: Vec<&str> =
            text.lines().map(|line| line.split(" x").next().unwrap_or(line)).collect();
        let ["first", retained @ .., notice, last] = &starts[..] else { panic!("{starts:?}") };
        let dropped = 20 - retained.len();
        assert!(dropped > 0);
        assert_eq!(
            *retained,
            (0..retained.len()).map(|number| number.to_string()).collect::<Vec<_>>()
        );
        assert!(notice.contains(&format!("WARN azel::cli::log: {dropped} lines")), "{notice}");
        assert_eq!(*last, "after");
    }

    #[test]
    fn what_is_said_last_is_written_before_the_end() {
        let (log, _reached, open, text) = blocked();
        open.send(()).unwrap();
        log.say("The window could not be opened.");
        log.finish_within(Duration::from_secs(20));
        assert_eq!(*text.lock().unwrap(), "The window could not be opened.\n");
    }
}
