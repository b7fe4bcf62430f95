//! Thread that writes the record.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Arc, atomic::Ordering, mpsc},
    time::{Duration, Instant},
};

use jiff::Timestamp;
use rusqlite::{Connection, params};
use serde_json::json;

use super::{
    Entry, Kind, PassNote, RecordError, file,
    film::Camera,
    intake::{Missed, Order, RecordedSession, Shared, locked},
    keeping,
    tables::Tables,
};
use crate::{
    astro::time::seconds_between,
    clock::{self, Clock, Moment},
    contract::{driver::Recorded, record::Failing},
    device::Measured,
};

/// Time between two writes. A crash loses at most this time and the preceding turn of the station,
/// in total less than a second.
const EVERY: Duration = Duration::from_millis(500);
/// Pause between two attempts while nothing can be written.
const RETRY: Duration = Duration::from_secs(2);
/// Time between two checks of the file's size and of data beyond its retention.
const LOOK: Duration = Duration::from_secs(10);
/// Max number of entries that wait for the disk.
const WAITING: usize = 20_000;
/// Min step that counts as setting this computer's clock, seconds.
const CLOCK_SET_S: f64 = 60.0;

/// Device and number of a file.
#[cfg(unix)]
type FileId = (u64, u64);
#[cfg(not(unix))]
type FileId = ();

/// Returns the identity of a file; `None` if it does not exist.
#[cfg(unix)]
fn file_id(path: &Path) -> Option<FileId> {
    use std::os::unix::fs::MetadataExt as _;
    fs::metadata(path).ok().map(|file| (file.dev(), file.ino()))
}

/// Returns the identity of a file; `None` if it does not exist.
#[cfg(not(unix))]
fn file_id(path: &Path) -> Option<FileId> {
    path.exists().then_some(())
}

/// Session with its recording progress.
struct Source {
    recorded_session: RecordedSession,
    is_named: bool,
    next_line: u64,
    next_position: u64,
}

/// New content of a session, for one write.
struct SessionNews {
    lines: Vec<Arc<Recorded>>,
    first_position: u64,
    positions: Vec<Measured>,
    /// `true` if the session has ended and sends no more data.
    is_last: bool,
}

pub(super) struct Writer {
    path: PathBuf,
    clock: Clock,
    begun: Moment,
    /// Open file, and the number of this run in the file.
    open: Option<(Connection, i64)>,
    /// Identity of the last written file, and of its log.
    written: Option<FileId>,
    log: Option<FileId>,
    run: Option<i64>,
    sources: Vec<Source>,
    waiting: Vec<Entry>,
    passes: Vec<PassNote>,
    camera: Camera,
    /// Number of entries dropped since the last write.
    dropped: u64,
    written_at: Timestamp,
    looked_at: Option<Instant>,
    /// Clocks at the last check, with the computer's total sleep time.
    clocks: (Moment, Duration),
    /// Time of the last step of this computer's clock.
    clock_set_at: Option<clock::Instant>,
    shared: Arc<Shared>,
}

impl Writer {
    pub(super) fn new(clock: Clock, shared: Arc<Shared>) -> Self {
        let begun = clock.now();
        let path = locked(&shared.status).path.clone();
        let clocks = (begun, clock.asleep());
        Self {
            path,
            clock,
            begun,
            open: None,
            written: None,
            log: None,
            run: None,
            sources: Vec::new(),
            waiting: Vec::new(),
            passes: Vec::new(),
            camera: Camera::default(),
            dropped: 0,
            written_at: begun.utc,
            looked_at: None,
            clocks,
            clock_set_at: None,
            shared,
        }
    }

    /// Writes until the station ends.
    pub(super) fn run(mut self, orders: &mpsc::Receiver<Order>) {
        self.queue(Entry {
            moment: self.begun,
            antenna: None,
            kind: Kind::Run,
            data: json!({ "begun": env!("CARGO_PKG_VERSION") }),
        });
        let mut due = Instant::now();
        loop {
            let left = due.saturating_duration_since(Instant::now());
            if left.is_zero() {
                let is_written = self.write();
                due = Instant::now() + if is_written { EVERY } else { RETRY };
                continue;
            }
            match orders.recv_timeout(left) {
                Ok(Order::Entry(entry)) => self.queue(*entry),
                // Passes need no limit: there are a few dozen a day.
                Ok(Order::Pass(pass)) => self.passes.push(*pass),
                Ok(Order::Picture { picture, is_after_cut }) => {
                    if is_after_cut {
                        self.camera.cut();
                    }
                    self.camera.take(&*picture);
                }
                Ok(Order::Flush(done)) => {
                    self.write();
                    // The recorder may no longer wait.
                    let _ = done.send(());
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => break,
            }
        }
        let moment = self.clock.now();
        let data = json!({ "ended": true });
        self.queue(Entry { moment, antenna: None, kind: Kind::Run, data });
        self.write();
        if let Some((db, run)) = self.open.take() {
            let ended = db.execute(
                "UPDATE run SET ended_us = ?1 WHERE id = ?2",
                params![moment.utc.as_microsecond(), run],
            );
            if let Err(error) = ended {
                tracing::warn!(%error, "the end of this run is not in the record");
            }
        }
    }

    fn queue(&mut self, entry: Entry) {
        if self.waiting.len() >= WAITING {
            self.dropped += 1;
            return;
        }
        self.waiting.push(entry);
    }

    /// Writes new data. Returns `false` if the write failed.
    fn write(&mut self) -> bool {
        let begun = std::mem::take(&mut *locked(&self.shared.begun));
        self.sources.extend(begun.into_iter().map(Source::new));
        match self.try_write() {
            Ok(()) => {
                self.written_at = self.clock.utc();
                if locked(&self.shared.status).failing.take().is_some() {
                    tracing::warn!("the record goes on");
                }
                if self.looked_at.is_none_or(|instant| instant.elapsed() >= LOOK) {
                    self.look_after_file();
                }
                true
            }
            Err(error) => {
                self.open = None;
                let start = self.written_at;
                let failing = Failing {
                    last_write: start,
                    reason: error.to_string(),
                    waiting: self.waiting.len() as u64,
                };
                if locked(&self.shared.status).failing.replace(failing).is_none() {
                    tracing::error!(%error, path = %self.path.display(), "nothing is recorded");
                }
                if matches!(error, RecordError::NoRecord) {
                    self.written = None;
                    self.set_aside();
                }
                false
            }
        }
    }

    fn try_write(&mut self) -> Result<(), RecordError> {
        self.watch_file();
        let open = match self.open.take() {
            Some(open) => open,
            None => self.open_file()?,
        };
        self.written = file_id(&self.path);
        let (db, run) = self.open.insert(open);
        let news: Vec<SessionNews> = self.sources.iter().map(Source::news).collect();
        let turned_away = self.shared.turned_away.load(Ordering::Relaxed);
        let not_filmed = self.shared.not_filmed.load(Ordering::Relaxed);
        let mut missed = Missed {
            entries: self.dropped + turned_away,
            pictures: self.camera.dropped + not_filmed,
            ..Missed::default()
        };
        for (source, news) in self.sources.iter().zip(&news) {
            let first_line = news.lines.first().map_or(source.next_line, |line| line.number);
            missed.frames += first_line - source.next_line;
            missed.positions += news.first_position - source.next_position;
        }
        let tx = db.transaction()?;
        let tables = Tables { tx: &tx, run: *run, begun: self.begun };
        if missed != Missed::default() {
            tables.gap(missed, self.written_at, self.clock.now())?;
        }
        for (source, news) in self.sources.iter().zip(&news) {
            if !source.is_named {
                tables.antenna(&source.recorded_session)?;
            }
            tables.frames(source.recorded_session.antenna, &news.lines)?;
            tables.positions(
                source.recorded_session.antenna,
                news.first_position,
                &news.positions,
            )?;
        }
        for entry in &self.waiting {
            tables.entry(entry)?;
        }
        for pass in &self.passes {
            tables.pass(pass)?;
        }
        self.camera.write(&tx, *run)?;
        tx.commit()?;
        if missed != Missed::default() {
            locked(&self.shared.status).gaps += 1;
        }
        self.log = file_id(&with_ending(&self.path, "-wal"));
        // Clear these after the commit: failed data is written again.
        self.shared.turned_away.fetch_sub(turned_away, Ordering::Relaxed);
        self.shared.not_filmed.fetch_sub(not_filmed, Ordering::Relaxed);
        self.camera.is_written();
        self.dropped = 0;
        self.waiting.clear();
        self.passes.clear();
        for (source, news) in self.sources.iter_mut().zip(&news) {
            source.is_named = true;
            source.next_line = news.lines.last().map_or(source.next_line, |line| line.number + 1);
            source.next_position = news.first_position + news.positions.len() as u64;
        }
        let mut news = news.iter();
        self.sources.retain(|_| news.next().is_none_or(|news| !news.is_last));
        Ok(())
    }

    /// Leaves a file that somebody has removed or replaced, and notes this in the next file.
    fn watch_file(&mut self) {
        if self.written.is_none() || file_id(&self.path) == self.written {
            return;
        }
        (self.open, self.written) = (None, None);
        // Remove the log too: SQLite would write the log of the old file into its replacement.
        let log = with_ending(&self.path, "-wal");
        if self.log.is_some() && file_id(&log) == self.log {
            for path in [log, with_ending(&self.path, "-shm")] {
                if let Err(error) = fs::remove_file(&path) {
                    tracing::warn!(%error, path = %path.display(), "a log of the record stays");
                }
            }
        }
        let moment = self.clock.now();
        locked(&self.shared.status).removed = Some(moment.utc);
        tracing::error!(path = %self.path.display(), "somebody has removed the record");
        let data = json!({ "previous_record": "removed" });
        self.queue(Entry { moment, antenna: None, kind: Kind::Run, data });
    }

    fn open_file(&mut self) -> Result<(Connection, i64), RecordError> {
        let db = file::open(&self.path)?;
        let run = match self.run {
            // The file still contains this run.
            Some(run)
                if db.query_row("SELECT count(*) FROM run WHERE id = ?1", [run], |row| {
                    row.get::<_, i64>(0)
                })? > 0 =>
            {
                run
            }
            _ => {
                db.execute(
                    "INSERT INTO run (begun_us, program) VALUES (?1, ?2)",
                    params![self.begun.utc.as_microsecond(), env!("CARGO_PKG_VERSION")],
                )?;
                // A new file has no antenna names yet.
                self.sources.iter_mut().for_each(|source| source.is_named = false);
                self.camera.begin_anew();
                db.last_insert_rowid()
            }
        };
        self.run = Some(run);
        Ok((db, run))
    }

    /// Renames a file that is not a record, so that a new record can begin.
    fn set_aside(&self) {
        let suffix = format!("unreadable-{}", self.clock.utc().as_second());
        let backup = self.path.with_added_extension(suffix);
        for part in ["", "-wal", "-shm"] {
            let source = with_ending(&self.path, part);
            if source.exists() {
                let target = with_ending(&backup, part);
                if let Err(error) = fs::rename(&source, &target) {
                    tracing::error!(%error, "the unreadable record stays in its place");
                }
            }
        }
    }

    fn look_after_file(&mut self) {
        locked(&self.shared.status).bytes = size(&self.path);
        let now = self.clock.now();
        let asleep = self.clock.asleep();
        let (before, slept) = std::mem::replace(&mut self.clocks, (now, asleep));
        let passed = now.steady.saturating_duration_since(before.steady);
        let expected_s = (passed + asleep.saturating_sub(slept)).as_secs_f64();
        if (seconds_between(before.utc, now.utc) - expected_s).abs() > CLOCK_SET_S {
            self.clock_set_at = Some(now.steady);
        }
        let is_more = self.remove_old(now).unwrap_or_else(|error| {
            tracing::warn!(%error, "old parts of the record stay");
            false
        });
        if !is_more {
            self.looked_at = Some(Instant::now());
        }
    }

    /// Removes data beyond its retention if the clock is trusted. Returns `true` if more may be
    /// left.
    fn remove_old(&self, now: Moment) -> Result<bool, RecordError> {
        let Some((db, _)) = &self.open else { return Ok(false) };
        let elapsed = |time| now.steady.saturating_duration_since(time);
        let is_set = self.clock_set_at.is_some_and(|time| elapsed(time) < keeping::TRUSTED_AFTER);
        let now_us = now.utc.as_microsecond();
        if is_set || !keeping::trusts(db, now_us, elapsed(self.begun.steady))? {
            return Ok(false);
        }
        keeping::remove_old(db, *locked(&self.shared.keeping), now_us)
    }
}

impl Source {
    fn new(session: RecordedSession) -> Self {
        Self { recorded_session: session, is_named: false, next_line: 0, next_position: 0 }
    }

    fn news(&self) -> SessionNews {
        // Check before reading the logs; otherwise data logged in between would be lost.
        let is_last = self.recorded_session.wire.is_alone();
        let mut lines = self.recorded_session.wire.copy_from(self.next_line);
        while let Some(last) = lines.last() {
            let more = self.recorded_session.wire.copy_from(last.number + 1);
            if more.is_empty() {
                break;
            }
            lines.extend(more);
        }
        let (first_position, positions) =
            self.recorded_session.positions.read_from(self.next_position);
        SessionNews { lines, first_position, positions, is_last }
    }
}

/// Returns the size of the file and its log, bytes.
fn size(path: &Path) -> u64 {
    let bytes = |path: &Path| fs::metadata(path).map_or(0, |file| file.len());
    bytes(path) + bytes(&with_ending(path, "-wal"))
}

/// Returns the path with `ending` appended to its name, like SQLite names its log.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}
