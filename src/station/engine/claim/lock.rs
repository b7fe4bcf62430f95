//! One lock between processes. On Linux, the lock is a name in the machine's socket namespace that
//! no user can remove. On every system it is also a locked file, which names the holder; older
//! versions know only the file.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, Write as _},
    path::{Path, PathBuf},
    sync::Mutex,
};

use super::{LockFolder, LockFolders, unpoisoned};
use crate::contract::claim::HeldBy;

/// Reason why a lock was not taken.
pub(super) enum NotLocked {
    Held(HeldBy),
    Io(io::Error),
}

impl From<io::Error> for NotLocked {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Lock of this process. The operating system frees it at any end of the process.
#[derive(Debug)]
pub(in crate::engine) struct Lock {
    name: String,
    /// Content of the lock files: the holder.
    text: String,
    files: Mutex<Vec<LockFile>>,
    /// Process that has locked a file in place of a removed one.
    mutex: Mutex<Option<HeldBy>>,
    machine: machine::Name,
}

impl Lock {
    pub(super) fn take(name: &str, text: String, folders: &LockFolders) -> Result<Self, NotLocked> {
        let machine = machine::Name::take(name).map_err(|error| match error.kind() {
            io::ErrorKind::AddrInUse => NotLocked::Held(holder_in(name, folders)),
            _ => NotLocked::Io(error),
        })?;
        let mut files = Vec::new();
        for (place, folder) in folders.own.iter().enumerate() {
            match LockFile::take(folder, name, &text) {
                Ok(file) => files.push(file),
                Err(NotLocked::Io(error)) if place > 0 => {
                    tracing::debug!(%error, folder = %folder.path.display(), "no lock file");
                }
                Err(error) => return Err(error),
            }
        }
        let mut others = folders.others.iter().map(|folder| file_path(folder, name));
        if let Some(holder) = others.find_map(|path| holder_of(&path)) {
            return Err(NotLocked::Held(holder));
        }
        let (name, files) = (name.to_owned(), Mutex::new(files));
        Ok(Self { name, text, files, mutex: Mutex::default(), machine })
    }

    pub(in crate::engine) fn name(&self) -> &str {
        &self.name
    }

    /// Returns the process that has locked a file in place of a removed one. Both processes then
    /// believe that they hold the lock; the other one may be too old to give it up.
    pub(in crate::engine) fn taken_by(&self) -> Option<HeldBy> {
        unpoisoned(&self.mutex).clone()
    }

    /// Recreates and locks files that were removed.
    pub(super) fn renew(&self) {
        self.machine.drain();
        let mut holder = None;
        let mut files = unpoisoned(&self.files);
        for file in files.iter_mut().filter(|file| !file.is_in_place()) {
            match LockFile::take(&file.folder, &self.name, &self.text) {
                Ok(renewed) => *file = renewed,
                Err(NotLocked::Held(other)) => holder = Some(other),
                Err(NotLocked::Io(error)) if !file.is_loss_told => {
                    tracing::warn!(%error, path = %file.path.display(), "a lock file is gone");
                    file.is_loss_told = true;
                }
                Err(NotLocked::Io(_)) => {}
            }
        }
        *unpoisoned(&self.mutex) = holder;
    }
}

#[derive(Debug)]
struct LockFile {
    folder: LockFolder,
    path: PathBuf,
    file: File,
    is_loss_told: bool,
}

impl LockFile {
    fn take(folder: &LockFolder, name: &str, text: &str) -> Result<Self, NotLocked> {
        folder.make()?;
        let path = file_path(&folder.path, name);
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(&path)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(NotLocked::Held(HeldBy::Azel(super::read_holder(&mut file))));
            }
            Err(TryLockError::Error(error)) => return Err(error.into()),
        }
        file.set_len(0)?;
        file.write_all(text.as_bytes())?;
        Ok(Self { folder: folder.clone(), path, file, is_loss_told: false })
    }

    /// Returns `false` if the path leads to another file or none: the lock of a removed file
    /// protects nothing.
    #[cfg(unix)]
    fn is_in_place(&self) -> bool {
        use std::os::unix::fs::MetadataExt as _;
        let file_id = |metadata: fs::Metadata| (metadata.dev(), metadata.ino());
        let current = fs::metadata(&self.path).map(file_id);
        matches!((self.file.metadata().map(file_id), current), (Ok(ours), Ok(current)) if ours == current)
    }

    /// Returns `true` if the path exists: an open file cannot be removed on this system.
    #[cfg(not(unix))]
    fn is_in_place(&self) -> bool {
        self.path.exists()
    }
}

pub(in crate::engine) fn file_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.lock"))
}

/// Returns the process that has locked the file at `path`.
pub(in crate::engine) fn holder_of(path: &Path) -> Option<HeldBy> {
    // A shared lock needs only read access, and another user may own the file.
    let mut file = File::open(path).ok()?;
    match file.try_lock_shared() {
        Err(TryLockError::WouldBlock) => Some(HeldBy::Azel(super::read_holder(&mut file))),
        Ok(()) | Err(TryLockError::Error(_)) => None,
    }
}

/// Returns the process that has the lock called `name`, from its files.
fn holder_in(name: &str, folders: &LockFolders) -> HeldBy {
    let mut files = folders.paths().map(|folder| file_path(folder, name));
    files.find_map(|path| holder_of(&path)).unwrap_or(HeldBy::Azel(None))
}

/// Returns the process that has the lock called `name`.
pub(super) fn holder_of_name(name: &str, folders: &LockFolders) -> Option<HeldBy> {
    let is_taken =
        machine::Name::take(name).is_err_and(|error| error.kind() == io::ErrorKind::AddrInUse);
    if is_taken {
        return Some(holder_in(name, folders));
    }
    folders.paths().find_map(|folder| holder_of(&file_path(folder, name)))
}

#[cfg(target_os = "linux")]
pub(in crate::engine) mod machine {
    //! Names in Linux's abstract socket namespace. One namespace covers the machine (more exactly,
    //! a network namespace, like the reachable units), and nobody can remove a name. Linux tells a
    //! connecting process who listens.

    use std::{
        io,
        os::{
            linux::net::SocketAddrExt as _,
            unix::net::{SocketAddr, UnixListener},
        },
    };

    /// Max number of pending connections, the default of Linux.
    const QUEUE: usize = 4096;

    #[derive(Debug)]
    pub(in crate::engine::claim) struct Name(UnixListener);

    impl Name {
        pub(in crate::engine::claim) fn take(name: &str) -> io::Result<Self> {
            let address = SocketAddr::from_abstract_name(address(name))?;
            let listener = UnixListener::bind_addr(&address)?;
            listener.set_nonblocking(true)?;
            Ok(Self(listener))
        }

        /// Accepts and closes the connections of processes that asked who listens, before they fill
        /// the queue.
        pub(in crate::engine::claim) fn drain(&self) {
            for _ in 0..QUEUE {
                if self.0.accept().is_err() {
                    break;
                }
            }
        }
    }

    /// Returns the socket name of a lock, with a prefix that tells it from other programs' names.
    pub(in crate::engine) fn address(name: &str) -> String {
        format!("azel/{name}")
    }
}

#[cfg(not(target_os = "linux"))]
mod machine {
    //! Stand-in for other systems, which have no such names: only files lock there.

    #[derive(Debug)]
    pub(super) struct Name;

    impl Name {
        #[allow(clippy::unnecessary_wraps, reason = "it can fail on Linux")]
        pub(super) fn take(_: &str) -> std::io::Result<Self> {
            Ok(Self)
        }

        #[allow(clippy::unused_self, reason = "on Linux there is something to do")]
        pub(super) fn drain(&self) {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn take(name: &str, folders: &LockFolders) -> Result<Lock, NotLocked> {
        Lock::take(name, "{}".to_owned(), folders)
    }

    /// Returns a name that no other test uses on this machine.
    fn name(folder: &Path) -> String {
        format!("test-{}", folder.file_name().unwrap().display())
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_lock_is_of_the_machine_whatever_becomes_of_its_folder() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        let (one, two) = (folder.path().join("one"), folder.path().join("two"));
        let lock = take(&name, &one.clone().into()).ok().unwrap();
        assert!(matches!(take(&name, &two.clone().into()), Err(NotLocked::Held(_))));
        fs::remove_dir_all(&one).unwrap();
        assert!(matches!(take(&name, &one.clone().into()), Err(NotLocked::Held(_))));
        lock.renew();
        assert!(holder_of(&file_path(&one, &name)).is_some());
        assert_eq!(lock.taken_by(), None);
        drop(lock);
        assert!(take(&name, &two.into()).is_ok());
    }

    #[test]
    fn an_older_version_is_recognised_by_its_file_in_any_folder() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        let [first, second, other] =
            ["first", "second", "other"].map(|name| folder.path().join(name));
        let own = [&first, &second].map(|path| LockFolder { path: path.clone(), group: None });
        let folders = LockFolders { own: own.to_vec(), others: vec![other.clone()] };
        for older in [first, second, other] {
            fs::create_dir_all(&older).unwrap();
            let file = File::create(file_path(&older, &name)).unwrap();
            file.try_lock().unwrap();
            assert!(matches!(take(&name, &folders), Err(NotLocked::Held(_))), "{older:?}");
            drop(file);
            assert!(take(&name, &folders).is_ok(), "{older:?}");
        }
    }

    #[test]
    fn a_file_that_another_process_locks_in_place_of_a_removed_one_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        let lock = take(&name, &folder.path().to_owned().into()).ok().unwrap();
        let path = file_path(folder.path(), &name);
        fs::remove_file(&path).unwrap();
        let other = File::create(&path).unwrap();
        other.try_lock().unwrap();
        lock.renew();
        assert_eq!(lock.taken_by(), Some(HeldBy::Azel(None)));
        drop(other);
        lock.renew();
        assert_eq!(lock.taken_by(), None);
        assert!(holder_of(&path).is_some());
    }
}
