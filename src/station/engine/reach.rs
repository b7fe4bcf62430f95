//! Ways to reach a process that holds a lock: its socket, or a signal if the socket does not
//! answer.

use std::{fmt, io, path::PathBuf};

use tokio::task::JoinSet;

use super::{
    claim::{
        LockFolders,
        lock::{file_path, holder_of},
        place_lock, socket_path, station_lock, written_lock,
    },
    socket::{Answer, Ask, Connection, send},
};
use crate::{
    contract::claim::{HeldBy, Holder},
    driver::endpoints,
    station::Antenna,
};

/// Outcome of a request to one process.
#[derive(Debug)]
pub struct Reached {
    /// Holder of the lock; `None` for a process that answers at the socket without holding the
    /// lock.
    pub holder: Option<LockHolder>,
    pub outcome: Outcome,
}

#[derive(Debug)]
pub enum Outcome {
    Answered(Answer),
    /// The process received STOP for all antennas as a signal. Their standstill is not proved.
    Signalled,
    NotReached(String),
}

/// Process that holds a lock.
#[derive(Debug, Clone, PartialEq)]
pub struct LockHolder {
    process: Option<u32>,
    /// Content of the lock file.
    holder: Option<Holder>,
    evidence: Evidence,
}

/// Evidence that the process holds the lock.
#[derive(Debug, Clone, PartialEq)]
enum Evidence {
    /// Lock file that the process has locked.
    File(PathBuf),
    /// Name in this machine's socket namespace that the process listens at.
    #[cfg(target_os = "linux")]
    Name(String),
}

/// Request that was sent, or the outcome of a failed one.
pub(super) enum Delivered {
    Asked(Connection),
    Over(Outcome),
}

impl fmt::Display for LockHolder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.holder, self.process) {
            (Some(holder), _) => HeldBy::Azel(Some(holder.clone())).fmt(f),
            (None, Some(process)) => write!(f, "another Azel (process {process})"),
            (None, None) => HeldBy::Azel(None).fmt(f),
        }
    }
}

/// Asks every process that holds the station file at `path`, including processes with another
/// environment. Blocks until all have answered.
pub fn ask_station(
    folders: &LockFolders,
    path: &std::path::Path,
    ask: &Ask,
) -> io::Result<Vec<Reached>> {
    blocking(async {
        let mut holders = holders(folders, &station_lock(path)).await;
        let mut tasks = JoinSet::new();
        // The lock file of an older version may be missing while its socket exists.
        for folder in folders.paths() {
            let Ok(connection) = send(&socket_path(folder, path), ask).await else { continue };
            let is_behind = |holder: &LockHolder| {
                holder.process.is_some() && holder.process == connection.process
            };
            let holder = holders.iter().position(is_behind).map(|place| holders.swap_remove(place));
            tasks.spawn(outcome(holder, ask.clone(), Delivered::Asked(connection)));
        }
        for holder in holders {
            let delivered = holder.deliver(ask).await;
            tasks.spawn(outcome(Some(holder), ask.clone(), delivered));
        }
        tasks.join_all().await
    })
}

/// Stops the units of these antennas in every process that holds one. Blocks during name lookups,
/// and until all processes have answered.
pub fn stop_units(folders: &LockFolders, antennas: &[Antenna]) -> io::Result<Vec<Reached>> {
    blocking(async {
        let mut all: Vec<LockHolder> = Vec::new();
        for antenna in antennas {
            let places = endpoints(&antenna.connection).unwrap_or_default();
            let places = places.iter().map(place_lock);
            for lock in std::iter::once(written_lock(antenna)).chain(places) {
                for holder in holders(folders, &lock).await {
                    let is_same = |lock_holder: &LockHolder| {
                        lock_holder.process == holder.process
                            && lock_holder.antenna() == holder.antenna()
                    };
                    if !all.iter().any(is_same) {
                        all.push(holder);
                    }
                }
            }
        }
        let mut tasks = JoinSet::new();
        for holder in all {
            let ask = Ask::Stop { antenna: holder.antenna().map(str::to_owned) };
            let delivered = holder.deliver(&ask).await;
            tasks.spawn(outcome(Some(holder), ask, delivered));
        }
        tasks.join_all().await
    })
}

fn blocking<T>(work: impl Future<Output = T>) -> io::Result<T> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    Ok(runtime.block_on(work))
}

/// Returns the processes that hold `lock`. Several can hold it only if one of them is an older
/// version.
pub(super) async fn holders(folders: &LockFolders, lock: &str) -> Vec<LockHolder> {
    let mut holders: Vec<LockHolder> = Vec::new();
    let mut add = |new: LockHolder| {
        if !holders.iter().any(|lock_holder| lock_holder.process == new.process) {
            holders.push(new);
        }
    };
    for folder in folders.paths() {
        let path = file_path(folder, lock);
        let holder = match holder_of(&path) {
            Some(HeldBy::Azel(holder)) => holder,
            Some(HeldBy::Unknown(_)) | None => continue,
        };
        let process = holder.as_ref().map(|holder| holder.process);
        add(LockHolder { process, holder, evidence: Evidence::File(path) });
    }
    #[cfg(target_os = "linux")]
    if let Some(process) = linux::listener(lock).await {
        add(LockHolder { process, holder: None, evidence: Evidence::Name(lock.to_owned()) });
    }
    holders
}

impl LockHolder {
    /// Returns the holder's name for the antenna; `None` if it holds no unit.
    pub(super) fn antenna(&self) -> Option<&str> {
        self.holder.as_ref()?.antenna.as_deref()
    }

    /// Sends `ask`. If the socket fails, a STOP goes as a signal.
    pub(super) async fn deliver(&self, ask: &Ask) -> Delivered {
        let socket = self.holder.as_ref().and_then(|holder| holder.socket.as_deref());
        let sent = match socket {
            Some(socket) => send(socket, ask).await,
            None => Err(io::Error::new(io::ErrorKind::NotFound, "it names no socket")),
        };
        match sent {
            Ok(connection) => Delivered::Asked(connection),
            Err(error) => Delivered::Over(self.without_answer(ask, &error).await),
        }
    }

    async fn without_answer(&self, ask: &Ask, error: &io::Error) -> Outcome {
        match ask {
            Ask::Stop { .. } => match self.signal().await {
                Ok(()) => Outcome::Signalled,
                Err(no_signal) => Outcome::NotReached(format!("{error}, {no_signal}")),
            },
            Ask::Status | Ask::Automatic { .. } | Ask::LockOut { .. } => {
                Outcome::NotReached(error.to_string())
            }
        }
    }

    /// Sends the STOP signal, but only to a process that certainly holds the lock.
    #[cfg(target_os = "linux")]
    async fn signal(&self) -> io::Result<()> {
        use rustix::process::{Pid, PidfdFlags, Signal, pidfd_open, pidfd_send_signal};
        let process = self.process.and_then(|process| i32::try_from(process).ok());
        let process = process.and_then(Pid::from_raw);
        let process = process.ok_or_else(|| io::Error::other("its process is not known"))?;
        // From here on, the handle identifies this process even if a later one gets its number.
        let handle = pidfd_open(process, PidfdFlags::empty())?;
        let number = process.as_raw_nonzero().get().unsigned_abs();
        let holds_it = match &self.evidence {
            Evidence::File(path) => linux::has_locked(path, number)?,
            Evidence::Name(lock) => linux::listener(lock).await == Some(Some(number)),
        };
        if !holds_it {
            return Err(io::Error::other("it is not certain which process holds the lock"));
        }
        // The signal would end a process that does not handle it.
        if !linux::handles_stop(number)? {
            return Err(io::Error::other("the process takes no signals yet"));
        }
        Ok(pidfd_send_signal(handle, Signal::USR1)?)
    }

    /// Returns an error: other systems do not report which process has locked a file.
    #[cfg(not(target_os = "linux"))]
    #[allow(clippy::unused_async, reason = "Linux waits here")]
    async fn signal(&self) -> io::Result<()> {
        let _: &Evidence = &self.evidence;
        Err(io::Error::other("this system does not tell which process holds the lock"))
    }
}

/// Waits for the answer to a sent request.
pub(super) async fn outcome(holder: Option<LockHolder>, ask: Ask, delivered: Delivered) -> Reached {
    let outcome = match delivered {
        Delivered::Over(outcome) => outcome,
        Delivered::Asked(connection) => match (connection.answer().await, &holder) {
            (Ok(answer), _) => Outcome::Answered(answer),
            (Err(error), Some(holder)) => holder.without_answer(&ask, &error).await,
            (Err(error), None) => Outcome::NotReached(error.to_string()),
        },
    };
    Reached { holder, outcome }
}

#[cfg(target_os = "linux")]
mod linux {
    //! Facts about processes, from Linux.

    use std::{fs, io, os::unix::fs::MetadataExt as _, path::Path};

    use tokio::net::UnixStream;

    use crate::{
        contract::claim::HeldBy,
        engine::claim::lock::{holder_of, machine},
    };

    /// Max number of readings of the list of locks: a reading may lack a line while other processes
    /// lock files.
    const LOOKS: u32 = 10;
    /// Bit of SIGUSR1 in a signal mask.
    const STOP: u64 = 1 << (nix::libc::SIGUSR1 - 1);

    /// Returns the process that listens at the name of `lock`. `None` means no process,
    /// `Some(None)` a process of unknown number.
    pub(super) async fn listener(lock: &str) -> Option<Option<u32>> {
        match UnixStream::connect(format!("\0{}", machine::address(lock))).await {
            Ok(stream) => {
                let process = stream.peer_cred().ok().and_then(|peer| peer.pid());
                // Zero means a process in another container.
                Some(
                    process
                        .and_then(|process| u32::try_from(process).ok())
                        .filter(|process| *process > 0),
                )
            }
            Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => None,
            Err(_) => Some(None),
        }
    }

    /// Returns `true` if `process` has locked the file at `path` and written its number there.
    pub(super) fn has_locked(path: &Path, process: u32) -> io::Result<bool> {
        let holder = match holder_of(path) {
            Some(HeldBy::Azel(Some(holder))) => holder,
            Some(HeldBy::Azel(None) | HeldBy::Unknown(_)) | None => return Ok(false),
        };
        let file = fs::metadata(path)?.ino();
        if holder.process != process {
            return Ok(false);
        }
        for _ in 0..LOOKS {
            let locks = fs::read_to_string("/proc/locks")?;
            if locks.lines().any(|line| is_lock(line, process, file)) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns `true` if a line of `/proc/locks` shows a lock of `process` on the file with this
    /// inode. The device is ignored: some file systems show another one than the file has.
    pub(super) fn is_lock(line: &str, process: u32, inode: u64) -> bool {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, "FLOCK", _, "WRITE", name, file, ..] = words.as_slice() else { return false };
        name.parse() == Ok(process)
            && file.rsplit(':').next().and_then(|last| last.parse().ok()) == Some(inode)
    }

    /// Returns `true` if the process has a handler for the STOP signal.
    pub(super) fn handles_stop(process: u32) -> io::Result<bool> {
        Ok(handles(&fs::read_to_string(format!("/proc/{process}/status"))?))
    }

    /// Returns `true` if the status text of a process shows a handler for the STOP signal.
    pub(super) fn handles(status: &str) -> bool {
        let handled = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let handled = handled.and_then(|set| u64::from_str_radix(set.trim(), 16).ok());
        handled.is_some_and(|handled| handled & STOP != 0)
    }
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use std::{fs::File, io::Write as _, process};

    use jiff::Timestamp;
    use tokio::signal::unix::{SignalKind, signal};

    use super::*;
    use crate::contract::claim::HolderKind;

    const LOCK: &str = "station-0";

    /// Creates a lock like an older version: one file, locked by this process, that names
    /// `process`.
    fn older_lock(folder: &std::path::Path, process: u32) -> File {
        let holder = Holder {
            kind: HolderKind::Serve,
            process,
            start: Timestamp::UNIX_EPOCH,
            socket: Some(folder.join("gone.sock")),
            antenna: None,
        };
        let mut file = File::create(file_path(folder, LOCK)).unwrap();
        file.try_lock().unwrap();
        file.write_all(serde_json::to_string(&holder).unwrap().as_bytes()).unwrap();
        file
    }

    async fn stop(folder: &std::path::Path) -> Vec<Outcome> {
        let stop = Ask::Stop { antenna: None };
        let mut outcomes = Vec::new();
        for holder in holders(&folder.to_owned().into(), LOCK).await {
            let delivered = holder.deliver(&stop).await;
            outcomes.push(outcome(Some(holder), stop.clone(), delivered).await.outcome);
        }
        outcomes
    }

    #[tokio::test]
    async fn an_older_version_without_a_socket_gets_stop_by_signal() {
        let folder = tempfile::tempdir().unwrap();
        let lock = older_lock(folder.path(), process::id());
        let mut stops = signal(SignalKind::user_defined1()).unwrap();
        let outcomes = stop(folder.path()).await;
        assert!(matches!(outcomes.as_slice(), [Outcome::Signalled]), "{outcomes:?}");
        stops.recv().await.unwrap();
        drop(lock);
        assert!(stop(folder.path()).await.is_empty());
    }

    #[test]
    fn a_process_that_would_be_ended_by_the_signal_is_known() {
        assert!(linux::handles("Name:\tazel\nSigCgt:\t0000000100000200\n"));
        assert!(!linux::handles("Name:\tazel\nSigCgt:\t0000000100000000\n"));
        assert!(!linux::handles("Name:\tazel\n"));
    }

    #[test]
    fn lines_of_locks_are_read() {
        let line = "1: FLOCK  ADVISORY  WRITE 30329 fe:00:10010788 0 EOF";
        assert!(linux::is_lock(line, 30_329, 10_010_788));
        assert!(!linux::is_lock(line, 30_329, 10_010_789));
        assert!(!linux::is_lock(line, 30_328, 10_010_788));
        assert!(!linux::is_lock(&line.replace("FLOCK", "POSIX"), 30_329, 10_010_788));
        assert!(!linux::is_lock("", 0, 0));
    }
}
