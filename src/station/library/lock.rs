//! Locks between processes that share a library.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io,
    path::Path,
    thread,
    time::Duration,
};

/// Pause between two attempts to take a lock.
const RETRY: Duration = Duration::from_millis(10);
/// Max number of attempts to take a lock that its owner releases at once.
const MAX_TRIES: usize = 100;

/// Lock between processes; released when dropped or when its process ends.
#[derive(Debug)]
pub(super) struct Lock {
    file: File,
}

impl Lock {
    /// Takes the lock `name` in `folder`. Returns `None` while another process has it.
    pub(super) fn try_take(folder: &Path, name: &str) -> io::Result<Option<Self>> {
        fs::create_dir_all(folder)?;
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let file = options.open(folder.join(name))?;
        match file.try_lock() {
            Ok(()) => Ok(Some(Self { file })),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    /// Returns the locked file.
    pub(super) fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Takes a lock that every owner releases at once. Returns `None` after a second, or if no lock
    /// can be made.
    pub(super) fn wait(folder: &Path, name: &str) -> Option<Self> {
        for _ in 0..MAX_TRIES {
            match Self::try_take(folder, name) {
                Ok(None) => thread::sleep(RETRY),
                lock_result => return lock_result.ok().flatten(),
            }
        }
        None
    }
}
