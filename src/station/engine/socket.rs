//! Socket of a station for other programs. Programs of the same user can stop antennas, lock them
//! out and ask for their status. Members of the socket's group can stop antennas and ask for their
//! status. A request is one line of JSON, and so is its answer.

use std::{
    io,
    os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown},
    path::{Path, PathBuf},
    thread::{self, JoinHandle},
    time::Duration,
};

use serde::{Deserialize, Serialize};
use tokio::{
    io::{AsyncBufReadExt as _, AsyncReadExt as _, AsyncWriteExt as _, BufReader},
    net::{UnixListener, UnixStream},
    sync::oneshot,
    time::{Instant, MissedTickBehavior, timeout, timeout_at},
};

use super::{Client, claim::LockFolder, status::AntennaStatus};
use crate::{
    contract::{
        Command, CommandOrigin, Snapshot,
        alarms::AlarmKind,
        antenna::AntennaModel,
        driver::{self, LinkState, StopState},
    },
    station::{AntennaId, LockOut},
};

/// Max length of a request, bytes.
const MAX_BYTES: u64 = 64 * 1024;
/// Timeout for a client to send its request.
const ASKS_WITHIN: Duration = Duration::from_secs(5);
/// Timeout for a session to report proof of a STOP, even for a unit that may sway.
const PROVED_WITHIN: Duration = Duration::from_secs(12);
/// Timeout for a lock-out: Azel first stops the unit and switches its own program off.
const LOCKED_WITHIN: Duration = Duration::from_secs(15);
/// Interval between checks that the socket file is still in its place.
const REPAIRED_WITHIN: Duration = Duration::from_millis(500);

/// Request to a station.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ask {
    /// STOP for one antenna, or for all that are connected or were moved.
    Stop {
        /// Name of the antenna; `None` for all.
        antenna: Option<String>,
    },
    /// Status of all antennas.
    Status,
    /// Automatic operation of an antenna, on or off.
    Automatic {
        /// Name of the antenna.
        antenna: String,
        is_on: bool,
    },
    /// Lock-out of an antenna, or its removal.
    LockOut {
        /// Name of the antenna.
        antenna: String,
        /// Holder and reason of the lock-out; `None` to remove it.
        lock_out: Option<LockOut>,
        /// Previous holder, for a removal. Azel then does not remove a newer lock-out of somebody
        /// else.
        #[serde(default)]
        locked_by: Option<String>,
    },
}

/// Answer to a request.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// Antennas that received STOP, with the proof of their standstill.
    Stopped(Vec<Stopped>),
    Status(Vec<AntennaStatus>),
    /// Automatic operation was switched on or off.
    Automatic {
        /// `true` if the link stays off until the operator connects.
        waits_for_connect: bool,
    },
    /// The lock-out was set or removed.
    LockOut {
        /// `true` if the unit confirmed that it stands and will not start on its own.
        proved: bool,
        /// Reason why the next start would not know the lock-out.
        #[serde(default)]
        not_on_disk: Option<String>,
    },
    /// Reason why Azel cannot carry out the request.
    Refused(String),
}

/// STOP that went to an antenna.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stopped {
    /// Name of the antenna.
    pub antenna: String,
    /// `true` if the unit has since reported standstill.
    pub proved: bool,
    /// Reason why the next start would not send the unproved STOP again.
    #[serde(default)]
    pub not_on_disk: Option<String>,
}

/// Connection with a sent request.
pub(super) struct Connection {
    /// Process behind the socket, if the system reports it.
    pub(super) process: Option<u32>,
    stream: UnixStream,
}

/// Sends `ask` to the process that serves the socket at `path`.
pub(super) async fn send(path: &Path, ask: &Ask) -> io::Result<Connection> {
    let mut text = serde_json::to_string(ask)?;
    text.push('\n');
    timeout(ASKS_WITHIN, async {
        let mut stream = UnixStream::connect(path).await?;
        let process = stream.peer_cred()?.pid().and_then(|process| u32::try_from(process).ok());
        stream.write_all(text.as_bytes()).await?;
        Ok(Connection { process, stream })
    })
    .await?
}

impl Connection {
    pub(super) async fn answer(self) -> io::Result<Answer> {
        let mut line = String::new();
        let mut reader = BufReader::new(self.stream);
        timeout(LOCKED_WITHIN + ASKS_WITHIN, reader.read_line(&mut line)).await??;
        Ok(serde_json::from_str(&line)?)
    }
}

/// Socket of a station. Dropping `Served` closes the socket before it returns.
pub(super) struct Served {
    close: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Drop for Served {
    fn drop(&mut self) {
        drop(self.close.take());
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the thread of the socket panicked");
        }
    }
}

/// Serves the socket called `name` in `folder` on its own thread until the station ends.
pub(super) fn serve(folder: LockFolder, name: PathBuf, station: Client) -> io::Result<Served> {
    let station = station.acting_for(CommandOrigin::Program);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let door = {
        let _within = runtime.enter();
        Door::open(folder, name)?
    };
    let (close, closed) = oneshot::channel();
    let thread = thread::Builder::new().name("azel-socket".to_owned()).spawn(move || {
        runtime.block_on(accept(door, station, closed));
    })?;
    Ok(Served { close: Some(close), thread: Some(thread) })
}

/// Listening socket and its place in the file system.
struct Door {
    folder: LockFolder,
    path: PathBuf,
    listener: UnixListener,
    /// Device and inode of the socket.
    file: (u64, u64),
    /// `true` once Azel has logged a loss that it cannot repair.
    is_loss_told: bool,
}

impl Door {
    /// Binds the socket in a private folder, sets its mode, and then moves it to its place. The
    /// socket is never open wider than that mode.
    fn open(folder: LockFolder, path: PathBuf) -> io::Result<Self> {
        folder.make()?;
        let closed = std::fs::Permissions::from_mode(0o700);
        let private =
            tempfile::Builder::new().prefix(".").permissions(closed).tempdir_in(&folder.path)?;
        let made = private.path().join("s");
        let listener = UnixListener::bind(&made)?;
        let mode = if folder.group.is_some() { 0o660 } else { 0o600 };
        if folder.group.is_some() {
            chown(&made, None, folder.group)?;
        }
        std::fs::set_permissions(&made, std::fs::Permissions::from_mode(mode))?;
        if path.is_dir() {
            // `remove_dir` removes only an empty folder.
            std::fs::remove_dir(&path)?;
        }
        std::fs::rename(&made, &path)?;
        let file = file_id(&path)?;
        Ok(Self { folder, path, listener, file, is_loss_told: false })
    }

    /// Recreates the socket if it was removed or replaced. Keeps a replacement on which another
    /// process listens.
    async fn repair(&mut self) {
        if file_id(&self.path).is_ok_and(|file| file == self.file)
            || UnixStream::connect(&self.path).await.is_ok()
        {
            return;
        }
        match Self::open(self.folder.clone(), self.path.clone()) {
            Ok(door) => *self = door,
            Err(error) if !self.is_loss_told => {
                tracing::error!(%error, "the socket is gone; only signals reach this process");
                self.is_loss_told = true;
            }
            Err(_) => {}
        }
    }
}

fn file_id(path: &Path) -> io::Result<(u64, u64)> {
    let metadata = std::fs::symlink_metadata(path)?;
    Ok((metadata.dev(), metadata.ino()))
}

async fn accept(mut door: Door, mut station: Client, closed: oneshot::Receiver<()>) {
    let client = station.clone();
    let ended = async {
        tokio::select! {
            () = async { while station.changed().await {} } => {}
            _ = closed => {}
        }
    };
    tokio::pin!(ended);
    let mut look = tokio::time::interval(REPAIRED_WITHIN);
    look.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        let accepted = tokio::select! {
            accepted = door.listener.accept() => accepted,
            _ = look.tick() => {
                door.repair().await;
                continue;
            }
            () = &mut ended => return,
        };
        match accepted {
            Ok((stream, _)) => {
                let station = client.clone();
                tokio::spawn(async move {
                    if let Err(error) = converse(stream, station).await {
                        tracing::warn!(%error, "a program at the socket");
                    }
                });
            }
            Err(error) => {
                tracing::warn!(%error, "the socket");
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}

/// Returns `true` if a process of `user` may send this request to a station of user `own`. The
/// socket's mode admits only `own`, root and members of the group.
fn may_ask(user: u32, own: u32, ask: &Ask) -> bool {
    match ask {
        Ask::Stop { .. } | Ask::Status => true,
        Ask::Automatic { .. } | Ask::LockOut { .. } => user == own || user == 0,
    }
}

async fn converse(stream: UnixStream, station: Client) -> io::Result<()> {
    let user = stream.peer_cred()?.uid();
    let (reader, mut writer) = stream.into_split();
    let mut line = String::new();
    let mut reader = BufReader::new(reader.take(MAX_BYTES));
    timeout(ASKS_WITHIN, reader.read_line(&mut line)).await??;
    let answer = match serde_json::from_str(&line) {
        Ok(ask) if may_ask(user, nix::unistd::geteuid().as_raw(), &ask) => {
            answer(ask, station).await
        }
        Ok(_) => Answer::Refused(
            "members of the group may stop antennas and read their status, nothing else".to_owned(),
        ),
        Err(error) => Answer::Refused(format!("the question is not understood: {error}")),
    };
    let mut text = serde_json::to_string(&answer)?;
    text.push('\n');
    timeout(ASKS_WITHIN, writer.write_all(text.as_bytes())).await?
}

async fn answer(ask: Ask, station: Client) -> Answer {
    match ask {
        Ask::Status => Answer::Status(AntennaStatus::of_all(&station.snapshot())),
        Ask::Stop { antenna } => stop(antenna.as_deref(), station).await,
        Ask::Automatic { antenna, is_on } => {
            let Some(id) = named(&station, &antenna) else { return unknown(&antenna) };
            set_automatic(id, is_on, station).await
        }
        Ask::LockOut { antenna, lock_out, locked_by } => {
            let Some(id) = named(&station, &antenna) else { return unknown(&antenna) };
            set_lock_out(id, lock_out, locked_by.as_deref(), station).await
        }
    }
}

async fn stop(antenna: Option<&str>, mut station: Client) -> Answer {
    let stopped = match antenna {
        None => station.stop_all(),
        Some(name) => match named(&station, name) {
            Some(id) => station.stop(id),
            None => return unknown(name),
        },
    };
    let (pressed, elsewhere) = (stopped.instant, stopped.elsewhere.clone());
    let outcome = |antenna: &AntennaModel| match antenna.snapshot.stop {
        StopState::Stopped { time: instant } if instant >= pressed => Some(true),
        StopState::NotConfirmed { start } if start >= pressed => Some(false),
        _ => None,
    };
    let end = Instant::now() + PROVED_WITHIN;
    let mut outcomes: Vec<(AntennaId, Option<bool>)> =
        stopped.antennas.into_iter().map(|id| (id, None)).collect();
    let snapshot = loop {
        let snapshot = station.snapshot();
        for (id, proved) in &mut outcomes {
            let antenna = snapshot.antennas.iter().find(|antenna| antenna.id() == *id);
            *proved = proved.or_else(|| antenna.and_then(outcome));
        }
        let is_over = outcomes.iter().all(|(_, proved)| proved.is_some());
        if is_over || !timeout_at(end, station.changed()).await.unwrap_or_default() {
            break snapshot;
        }
    };
    let antenna = |id| snapshot.antennas.iter().find(|antenna| antenna.id() == id);
    let name = |id| antenna(id).map_or_else(String::new, |antenna| antenna.config.name.clone());
    let not_on_disk = |id| antenna(id)?.snapshot.not_on_disk.clone();
    // Another Azel drives these antennas. STOP was passed on to it, but the outcome is unknown
    // here.
    outcomes.extend(elsewhere.into_iter().map(|id| (id, Some(false))));
    let stopped = |(id, proved): (AntennaId, Option<bool>)| Stopped {
        antenna: name(id),
        proved: proved.unwrap_or_default(),
        not_on_disk: not_on_disk(id),
    };
    Answer::Stopped(outcomes.into_iter().map(stopped).collect())
}

async fn set_lock_out(
    id: AntennaId,
    lock_out: Option<LockOut>,
    locked_by: Option<&str>,
    mut station: Client,
) -> Answer {
    let snapshot = station.snapshot();
    let antenna = snapshot.antennas.iter().find(|antenna| antenna.id() == id);
    let standing = antenna.and_then(|antenna| antenna.snapshot.lock_out.clone());
    match standing {
        Some(LockOut { operator: name, reason, .. }) if lock_out.is_some() => {
            return Answer::Refused(format!("it is locked out already by {name}: {reason}"));
        }
        Some(LockOut { operator: name, reason, .. }) if locked_by != Some(name.as_str()) => {
            return Answer::Refused(format!(
                "it is locked out by {name}: {reason}. Ask {name}, then repeat the command with \
                 --locked-by \"{name}\""
            ));
        }
        Some(_) | None => {}
    }
    let command = lock_out.clone().map_or(driver::Command::Unlock, driver::Command::LockOut);
    if station.send(Command::Antenna(id, command)).is_err() {
        return Answer::Refused("Azel is too busy to take it".to_owned());
    }
    let moment = station.now();
    let end = Instant::now() + LOCKED_WITHIN;
    loop {
        let snapshot = station.snapshot();
        let antenna = snapshot.antennas.iter().find(|antenna| antenna.id() == id);
        let Some(antenna) = antenna else {
            return Answer::Refused("the antenna is not in the station any more".to_owned());
        };
        if let Some(holder) = &antenna.held_by {
            return Answer::Refused(format!("{holder} drives it: lock it out there"));
        }
        let shown = &antenna.snapshot;
        let is_so = shown.lock_out == lock_out;
        let stands = shown.state.measured.is_some_and(|measured| {
            shown.link.is_open() && measured.requested >= moment.steady && !measured.moving()
        });
        if is_so && (lock_out.is_none() || !shown.locking && stands) {
            return Answer::LockOut { proved: true, not_on_disk: not_on_disk(&snapshot) };
        }
        if !timeout_at(end, station.changed()).await.unwrap_or_default() {
            return if is_so {
                Answer::LockOut { proved: false, not_on_disk: not_on_disk(&snapshot) }
            } else {
                Answer::Refused("the session did not take it".to_owned())
            };
        }
    }
}

/// Returns the reason why the next start would not know the current lock-outs.
fn not_on_disk(snapshot: &Snapshot) -> Option<String> {
    snapshot.alarms.list().iter().find_map(|alarm| match &alarm.kind {
        AlarmKind::LockOuts(reason) => Some(reason.clone()),
        _ => None,
    })
}

async fn set_automatic(antenna: AntennaId, is_on: bool, mut station: Client) -> Answer {
    if station.send(Command::SetAutomatic { antenna, is_on }).is_err() {
        return Answer::Refused("Azel is too busy to take it".to_owned());
    }
    let end = Instant::now() + ASKS_WITHIN;
    loop {
        let snapshot = station.snapshot();
        let Some(shown) =
            snapshot.antennas.iter().find(|model_antenna| model_antenna.id() == antenna)
        else {
            return Answer::Refused("the antenna is not in the station any more".to_owned());
        };
        if shown.operation.is_on() == is_on {
            let waits_for_connect = shown.snapshot.link == LinkState::Off;
            return Answer::Automatic { waits_for_connect };
        }
        if let Some(holder) = &shown.held_by {
            return Answer::Refused(format!("{holder} drives it: switch it on there"));
        }
        if let Some(LockOut { operator: name, reason, .. }) = &shown.snapshot.lock_out {
            return Answer::Refused(format!("it is locked out by {name}: {reason}"));
        }
        if !timeout_at(end, station.changed()).await.unwrap_or_default() {
            return Answer::Refused("the station did not take it".to_owned());
        }
    }
}

fn named(station: &Client, name: &str) -> Option<AntennaId> {
    let snapshot = station.snapshot();
    let antenna = snapshot.antennas.iter().find(|antenna| antenna.config.name == name);
    antenna.map(AntennaModel::id)
}

fn unknown(name: &str) -> Answer {
    Answer::Refused(format!("the station has no antenna called {name}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_member_of_the_group_may_stop_and_look_and_no_more() {
        let lock_out = Ask::LockOut { antenna: "Dish".to_owned(), lock_out: None, locked_by: None };
        let automatic = Ask::Automatic { antenna: "Dish".to_owned(), is_on: true };
        let (own, member) = (1000, 1001);
        for ask in [&lock_out, &automatic] {
            assert!(may_ask(own, own, ask) && may_ask(0, own, ask) && !may_ask(member, own, ask));
        }
        for ask in [Ask::Stop { antenna: None }, Ask::Status] {
            assert!(may_ask(member, own, &ask));
        }
    }

    #[test]
    fn questions_and_answers_come_back_as_they_went() {
        let lock_out = LockOut {
            operator: "Ada".to_owned(),
            reason: "belts".to_owned(),
            start: jiff::Timestamp::UNIX_EPOCH,
        };
        for ask in [
            Ask::Status,
            Ask::Stop { antenna: None },
            Ask::Stop { antenna: Some("Dish \"1\"\n".to_owned()) },
            Ask::LockOut { antenna: "Dish".to_owned(), lock_out: Some(lock_out), locked_by: None },
            Ask::Automatic { antenna: "Dish".to_owned(), is_on: true },
        ] {
            let text = serde_json::to_string(&ask).unwrap();
            assert!(!text.contains('\n'), "{text}");
            assert_eq!(serde_json::from_str::<Ask>(&text).unwrap(), ask);
        }
    }
}
