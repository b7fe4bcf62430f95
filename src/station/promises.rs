//! Files that the next start must find: owed STOPs, auto-track to switch off, offsets to take back,
//! lock-outs, and the last state of automatic operation. Each is a small TOML file, and only this
//! module writes them.
//!
//! Invariant: a file ends as its newest request demands, however slow the disk is. At most one
//! worker writes a file at a time, and it always takes the newest request.

use std::{
    collections::BTreeMap,
    fmt, fs, io,
    path::{Path, PathBuf},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
};

use tokio::{runtime::Handle, sync::Notify, task::spawn_blocking};

use crate::whole_file;

/// Requested state of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum FileState {
    #[default]
    Absent,
    Holds(String),
    /// Like [`Self::Holds`], but keeps the previous content in a second file for the operator.
    HoldsAndKeepsOld(String),
}

/// Progress of the newest request for a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PromisedFile {
    OnDisk,
    Pending,
    /// The disk refused the request for this reason.
    Failed(String),
}

type Disk = dyn Fn(&Path, &FileState) -> io::Result<()> + Send + Sync;

/// All promises of this program. Clones share their state.
#[derive(Clone)]
pub struct Promises {
    shared: Arc<Shared>,
}

struct Shared {
    /// Function that brings a file into a state; it blocks.
    disk: Box<Disk>,
    /// Files whose newest request is not on the disk.
    files: Mutex<BTreeMap<PathBuf, Requested>>,
    /// Condition that wakes threads waiting for a file.
    written: Condvar,
    /// Notification that wakes tasks waiting for a file.
    changed: Notify,
}

#[derive(Default)]
struct Requested {
    state: FileState,
    /// Number of the newest request.
    newest: u64,
    /// Number of the newest request that a worker tried.
    tried: u64,
    /// Reason why the last tried request is not on the disk.
    failure: Option<String>,
    /// `true` while a worker writes this file.
    is_busy: bool,
}

impl Default for Promises {
    fn default() -> Self {
        Self::new(to_disk)
    }
}

impl fmt::Debug for Promises {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Promises").finish_non_exhaustive()
    }
}

impl Promises {
    /// Creates promises that `disk` writes.
    pub(crate) fn new(
        disk: impl Fn(&Path, &FileState) -> io::Result<()> + Send + Sync + 'static,
    ) -> Self {
        let shared = Shared {
            disk: Box::new(disk),
            files: Mutex::default(),
            written: Condvar::new(),
            changed: Notify::new(),
        };
        Self { shared: Arc::new(shared) }
    }

    /// Requests a state of the file at `path`. A worker writes the file. Outside of a runtime, this
    /// call blocks until the file is written.
    pub fn put(&self, path: &Path, state: FileState) {
        let Some(work) = self.request(path, state) else { return };
        let (promises, path) = (self.clone(), path.to_owned());
        let run = move || {
            work.run();
            if let PromisedFile::Failed(reason) = promises.promised(&path) {
                tracing::error!(reason, "a promise is not on the disk");
            }
        };
        match Handle::try_current() {
            Ok(_) => drop(spawn_blocking(run)),
            Err(_) => run(),
        }
    }

    /// Requests a state of the file at `path`, and blocks until the file is on the disk. The error
    /// is the reason why the file is not there.
    pub fn put_and_wait(&self, path: &Path, state: FileState) -> Result<(), String> {
        self.finish(path, self.request(path, state))
    }

    /// Queues a request and returns the work for it, or `None` while a worker writes this file.
    /// Never blocks on the disk.
    pub(crate) fn request(&self, path: &Path, state: FileState) -> Option<Work> {
        let mut files = self.files();
        let file = files.entry(path.to_owned()).or_default();
        file.newest += 1;
        file.state = state;
        let is_busy = std::mem::replace(&mut file.is_busy, true);
        (!is_busy).then(|| Work { promises: self.clone(), path: path.to_owned(), is_over: false })
    }

    /// Blocks until the newest request for the file at `path` is on the disk.
    pub(crate) fn finish(&self, path: &Path, work: Option<Work>) -> Result<(), String> {
        if let Some(work) = work {
            work.run();
        }
        let mut files = self.files();
        loop {
            match promised(&files, path) {
                PromisedFile::OnDisk => return Ok(()),
                PromisedFile::Failed(reason) => return Err(reason),
                PromisedFile::Pending => {
                    let woken = self.shared.written.wait(files);
                    files = woken.unwrap_or_else(PoisonError::into_inner);
                }
            }
        }
    }

    pub fn promised(&self, path: &Path) -> PromisedFile {
        promised(&self.files(), path)
    }

    /// Waits until no request for these files is pending.
    pub async fn settled(&self, paths: &[PathBuf]) {
        loop {
            let changed = self.shared.changed.notified();
            tokio::pin!(changed);
            changed.as_mut().enable();
            if paths.iter().all(|path| self.promised(path) != PromisedFile::Pending) {
                return;
            }
            changed.await;
        }
    }

    /// Returns the requested or stored content of the file at `path`; a pending request takes
    /// precedence over the disk. Returns `None` if there is no such file. Blocks.
    pub fn read(&self, path: &Path) -> io::Result<Option<String>> {
        if let Some(file) = self.files().get(path) {
            return Ok(match &file.state {
                FileState::Absent => None,
                FileState::Holds(text) | FileState::HoldsAndKeepsOld(text) => Some(text.clone()),
            });
        }
        match fs::read_to_string(path) {
            Ok(text) => Ok(Some(text)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn files(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Requested>> {
        // No code panics while it holds this lock, so the data is valid even if poisoned.
        self.shared.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn promised(files: &BTreeMap<PathBuf, Requested>, path: &Path) -> PromisedFile {
    let Some(file) = files.get(path) else { return PromisedFile::OnDisk };
    match &file.failure {
        _ if file.is_busy => PromisedFile::Pending,
        Some(reason) => PromisedFile::Failed(reason.clone()),
        None => PromisedFile::Pending,
    }
}

/// Right to write one file. Dropping it before [`Self::run`] ends counts as a failure.
#[must_use]
pub(crate) struct Work {
    promises: Promises,
    path: PathBuf,
    is_over: bool,
}

impl Work {
    /// Writes the file until no newer request is pending. Blocks.
    pub(crate) fn run(mut self) {
        while let Some((number, state)) = self.next() {
            let result = (self.promises.shared.disk)(&self.path, &state);
            let failure = result.err().map(|error| format!("{error}: {}", self.path.display()));
            self.with_file(|file| {
                file.tried = number;
                file.failure = failure;
            });
        }
    }

    /// Returns the newest request, or ends this work if it was already tried.
    fn next(&mut self) -> Option<(u64, FileState)> {
        let request = self.with_file(|file| {
            let is_new = file.tried != file.newest;
            file.is_busy = is_new;
            is_new.then(|| (file.newest, file.state.clone()))
        });
        self.is_over = request.is_none();
        if self.is_over {
            self.tell();
        }
        request
    }

    fn with_file<T: Default>(&self, change: impl FnOnce(&mut Requested) -> T) -> T {
        let mut files = self.promises.files();
        let Some(file) = files.get_mut(&self.path) else { return T::default() };
        let result = change(file);
        if !file.is_busy && file.failure.is_none() {
            files.remove(&self.path);
        }
        result
    }

    fn tell(&self) {
        self.promises.shared.written.notify_all();
        self.promises.shared.changed.notify_waiters();
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        if !self.is_over {
            self.with_file(|file| {
                file.is_busy = false;
                file.failure = Some("Azel ended before the disk took it".to_owned());
            });
            self.tell();
        }
    }
}

fn to_disk(path: &Path, state: &FileState) -> io::Result<()> {
    match state {
        FileState::Absent => whole_file::remove(path),
        FileState::Holds(text) => whole_file::replace(path, text.as_bytes()),
        FileState::HoldsAndKeepsOld(text) => {
            whole_file::replace_and_keep_old(path, text.as_bytes())
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
