//! Debts to units: owed STOPs, auto-track to be disabled, and offsets of shifted tracks. A debt
//! belongs to a unit, not to an antenna entry of the settings: it outlives the session, the name
//! and the address of its antenna. As a promise on disk, a debt also outlives this program.
//! Auto-track has such a record only if no antenna of the settings has the unit at the next start.
//!
//! Debts lock the ledger during every request to the store of promises, so that both have the same
//! order. A worker of the store writes the files.

mod shifted_track;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs, io,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use sha2::{Digest as _, Sha256};
use tokio::sync::Notify;

use crate::{
    clock::Instant,
    contract::driver::Unit,
    promises::{FileState, PromisedFile, Promises},
};
pub(super) use shifted_track::{AddedTo, ShiftedTrack};

/// File name extensions for a STOP, for auto-track, and for offsets.
const STOP: &str = ".toml";
const AUTO_TRACK: &str = ".auto-track.toml";
const OFFSETS: &str = ".offsets.toml";

/// Returns the readable and unique name of a file about `unit`.
fn file_name(unit: &Unit, ending: &str) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '-' };
    let readable: String = unit.address.chars().map(plain).take(40).collect();
    let hash = Sha256::digest(format!("{}\n{}", unit.make, unit.address));
    let [a, b, c, d, ..] = *hash.first_chunk::<4>().unwrap_or(&[0; 4]);
    format!("{}-{readable}-{a:02x}{b:02x}{c:02x}{d:02x}{ending}", unit.make)
}

/// Record of a unit that may be moving.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::driver) struct Mark {
    /// Start of the manual motion or time of the STOP; `None` if the file is unreadable.
    #[serde(rename = "since", default, skip_serializing_if = "Option::is_none")]
    pub(in crate::driver) start: Option<Timestamp>,
    /// Last time at which a session recorded a pending attempt to stop the unit. Earlier versions
    /// did not record this time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::driver) tried: Option<Timestamp>,
}

impl Mark {
    /// Returns the last time at which a session is known to have attended to the unit.
    pub(in crate::driver) fn last_attempt(self) -> Option<Timestamp> {
        self.tried.max(self.start)
    }
}

/// Content of a debt file.
#[derive(Debug, Serialize, Deserialize)]
struct DebtRecord<T> {
    #[serde(flatten)]
    unit: Unit,
    #[serde(flatten)]
    debt: T,
}

/// Content of the auto-track file, besides the unit.
#[derive(Debug, Serialize, Deserialize)]
struct AutoTrack {
    #[serde(rename = "since")]
    start: Timestamp,
}

impl Ledger {
    /// Returns the STOP trigger of a newer session of the same unit.
    fn newer_stop(&self, unit: &Unit, session: u64) -> Option<&Arc<Notify>> {
        let newest = self.sessions.get(unit).filter(|(number, _)| *number > session);
        newest.map(|(_, stop)| stop)
    }
}

/// All debts of this program. Clones share them.
#[derive(Debug, Clone, Default)]
pub struct Debts {
    /// Folder of the files; `None` to keep no files.
    folder: Option<Arc<Path>>,
    promises: Promises,
    ledger: Arc<Mutex<Ledger>>,
}

#[derive(Debug, Default)]
struct Ledger {
    /// Number of the newest session.
    newest: u64,
    /// Newest session of each unit, and its STOP trigger.
    sessions: BTreeMap<Unit, (u64, Arc<Notify>)>,
    owed: BTreeSet<Unit>,
    /// Units that an earlier run may have left moving, until a session has proved standstill.
    left: BTreeSet<Unit>,
    /// Session that marked each unit last.
    marked_by: BTreeMap<Unit, u64>,
    /// Units whose auto-track must be disabled and was not yet read back as off.
    auto_track: BTreeSet<Unit>,
    /// Time of Azel's first motion of each unit without proved standstill.
    unproved: BTreeMap<Unit, Instant>,
    /// Units that may hold pass offsets written by this program.
    shifted: BTreeMap<Unit, ShiftedTrack>,
}

impl Debts {
    /// Loads the debts that an earlier run left in `folder`, and keeps files there.
    pub fn marked_in(folder: Option<PathBuf>) -> Self {
        Self::with_promises(folder, Promises::default())
    }

    /// Does the same as [`Self::marked_in`] with the given store of promises.
    pub(in crate::driver) fn with_promises(folder: Option<PathBuf>, promises: Promises) -> Self {
        let debts = Self { folder: folder.map(Arc::from), promises, ..Self::default() };
        if let Some(folder) = debts.folder.as_deref() {
            lowercase_names(folder, &debts.promises);
            let mut ledger = debts.ledger();
            let stops = found::<Mark>(folder, STOP, "a unit may still move");
            ledger.left.extend(stops.into_iter().map(|(unit, _)| unit));
            let auto_track = found::<AutoTrack>(folder, AUTO_TRACK, "a unit may track by itself");
            ledger.auto_track.extend(auto_track.into_iter().map(|(unit, _)| unit));
            let shifted = found(folder, OFFSETS, "a unit may still hold offsets of a pass");
            ledger.shifted.extend(shifted.into_iter().map(ShiftedTrack::mark_found));
        }
        debts
    }

    fn ledger(&self) -> MutexGuard<'_, Ledger> {
        // No code panics while it owns the lock, so the data of a poisoned lock is valid.
        self.ledger.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn path(&self, unit: &Unit, ending: &str) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(file_name(unit, ending)))
    }

    /// Returns the store of all promises of this program.
    pub fn promises(&self) -> &Promises {
        &self.promises
    }

    /// Waits until the disk has stored or refused the last requested state of every file of `unit`.
    pub(super) async fn wait_for_disk(&self, unit: &Unit) {
        let paths = [STOP, AUTO_TRACK, OFFSETS].map(|ending| self.path(unit, ending));
        let paths: Vec<PathBuf> = paths.into_iter().flatten().collect();
        self.promises.settled(&paths).await;
    }

    /// Registers a new session of `unit` and returns its number. Notifies `stop` at once if Azel
    /// owes the unit a STOP.
    pub(super) fn begin(&self, unit: &Unit, stop: Arc<Notify>) -> u64 {
        let mut ledger = self.ledger();
        ledger.newest += 1;
        let number = ledger.newest;
        if ledger.owed.contains(unit) {
            stop.notify_one();
        }
        ledger.sessions.insert(unit.clone(), (number, stop));
        number
    }

    pub fn owe(&self, unit: &Unit) {
        self.ledger().owed.insert(unit.clone());
    }

    /// Clears the owed STOP: the unit stands, or the operator has confirmed that it stands.
    pub(super) fn settle(&self, unit: &Unit) {
        self.ledger().owed.remove(unit);
    }

    /// Hands the debt of `session` to a newer session of the same unit; returns `false` if
    /// there is none.
    pub(super) fn hand_over(&self, unit: &Unit, session: u64) -> bool {
        let ledger = self.ledger();
        let newer = ledger.newer_stop(unit, session);
        if let Some(stop) = newer {
            stop.notify_one();
        }
        newer.is_some()
    }

    /// Returns `true` if there is a newer session of the same unit than `session`.
    pub(super) fn is_followed(&self, unit: &Unit, session: u64) -> bool {
        self.ledger().newer_stop(unit, session).is_some()
    }

    /// Records that `unit` must not track on its own.
    pub fn owe_auto_track_off(&self, unit: &Unit) {
        self.ledger().auto_track.insert(unit.clone());
    }

    /// Does the same as [`Self::owe_auto_track_off`], also for the next start, because no antenna
    /// has this unit any more. Blocks until the record is on disk; the error contains the reason
    /// for a failure.
    pub fn mark_auto_track_off(&self, unit: &Unit, start: Timestamp) -> Result<(), String> {
        let mut ledger = self.ledger();
        ledger.auto_track.insert(unit.clone());
        let Some(path) = self.path(unit, AUTO_TRACK) else { return Ok(()) };
        let work = self.promises.request(&path, file(unit, AutoTrack { start })?);
        drop(ledger);
        self.promises.finish(&path, work)
    }

    /// Clears the auto-track debt: the unit no longer tracks on its own, or the operator wants it
    /// to.
    pub(super) fn settle_auto_track(&self, unit: &Unit) {
        let mut ledger = self.ledger();
        if ledger.auto_track.remove(unit)
            && let Some(path) = self.path(unit, AUTO_TRACK)
        {
            self.promises.put(&path, FileState::Absent);
        }
    }

    /// Removes the debts of an earlier run to a unit, and leaves its files to the Azel instance
    /// that now drives it.
    pub fn leave(&self, unit: &Unit) {
        let mut ledger = self.ledger();
        ledger.auto_track.remove(unit);
        ledger.left.remove(unit);
    }

    pub(super) fn owes_auto_track_off(&self, unit: &Unit) -> bool {
        self.ledger().auto_track.contains(unit)
    }

    /// Returns the units whose auto-track must be disabled and was not yet read back as off.
    pub fn with_auto_track(&self) -> Vec<Unit> {
        self.ledger().auto_track.iter().cloned().collect()
    }

    /// Records the start of the motion of `unit` without proved standstill. Ignores all sessions
    /// except the newest.
    pub(super) fn keep_unproved(&self, unit: &Unit, session: u64, start: Option<Instant>) {
        let mut ledger = self.ledger();
        if ledger.sessions.get(unit).is_none_or(|(newest, _)| *newest != session) {
            return;
        }
        match start {
            Some(start) => drop(ledger.unproved.insert(unit.clone(), start)),
            None => drop(ledger.unproved.remove(unit)),
        }
    }

    /// Returns the start of the motion of `unit` without proved standstill.
    pub(super) fn unproved_since(&self, unit: &Unit) -> Option<Instant> {
        self.ledger().unproved.get(unit).copied()
    }

    pub fn owes(&self, unit: &Unit) -> bool {
        self.ledger().owed.contains(unit)
    }

    /// Returns the units to which Azel owes a STOP.
    pub fn units(&self) -> Vec<Unit> {
        self.ledger().owed.iter().cloned().collect()
    }

    /// Returns the units that an earlier run may have left moving, until a session proves their
    /// standstill.
    pub fn left_moving(&self) -> Vec<Unit> {
        self.ledger().left.iter().cloned().collect()
    }

    /// Returns `true` if there is a folder for files.
    pub(super) fn has_marks(&self) -> bool {
        self.folder.is_some()
    }

    /// Requests a file that records the possible motion of `unit`. A worker writes the file.
    pub(super) fn mark(&self, unit: &Unit, session: u64, mark: Mark) {
        let mut ledger = self.ledger();
        let newest = ledger.marked_by.entry(unit.clone()).or_default();
        *newest = session.max(*newest);
        if let Some(path) = self.path(unit, STOP) {
            match file(unit, mark) {
                Ok(state) => self.promises.put(&path, state),
                Err(error) => tracing::error!(error, "a mark is not on the disk"),
            }
        }
    }

    /// Requests the removal of the file of `unit` after `session` has proved standstill, unless a
    /// newer session has marked the unit.
    pub(super) fn unmark(&self, unit: &Unit, session: u64) {
        let mut ledger = self.ledger();
        if ledger.marked_by.get(unit).is_some_and(|newest| *newest > session) {
            return;
        }
        ledger.marked_by.remove(unit);
        ledger.left.remove(unit);
        if let Some(path) = self.path(unit, STOP) {
            self.promises.put(&path, FileState::Absent);
        }
    }

    /// Returns the progress of the file about the possible motion of `unit`.
    pub(super) fn mark_kept(&self, unit: &Unit) -> PromisedFile {
        self.path(unit, STOP).map_or(PromisedFile::OnDisk, |path| self.promises.promised(&path))
    }

    /// Returns `true` if an earlier run may have left `unit` moving. Blocks.
    pub fn is_marked(&self, unit: &Unit) -> bool {
        self.marked(unit).is_some()
    }

    /// Reads the mark of `unit` from disk. An unreadable mark has no time. Blocks.
    pub(super) fn marked(&self, unit: &Unit) -> Option<Mark> {
        let unreadable = Mark { start: None, tried: None };
        match self.promises.read(&self.path(unit, STOP)?) {
            Ok(text) => Some(toml::from_str(&text?).unwrap_or(unreadable)),
            Err(_) => Some(unreadable),
        }
    }

    /// Reads the mark of `unit` from disk; from now on, `session` may remove it. Blocks.
    pub(super) fn take_over_mark(&self, unit: &Unit, session: u64) -> Option<Mark> {
        let mark = self.marked(unit)?;
        let mut ledger = self.ledger();
        let newest = ledger.marked_by.entry(unit.clone()).or_default();
        *newest = session.max(*newest);
        Some(mark)
    }
}

fn file<T: Serialize>(unit: &Unit, debt: T) -> Result<FileState, String> {
    let record = DebtRecord { unit: unit.clone(), debt };
    toml::to_string(&record).map(FileState::Holds).map_err(|error| error.to_string())
}

/// Reads the files of `folder` with this name ending. An unreadable file names no unit: it stays,
/// and the log explains its meaning.
fn found<T: DeserializeOwned>(folder: &Path, ending: &str, meaning: &str) -> Vec<(Unit, T)> {
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).map_err(io::Error::other);
        let record = text.and_then(|text| toml::from_str(&text).map_err(io::Error::other));
        let DebtRecord { unit, debt } = record
            .inspect_err(|error| tracing::error!(%error, path = %path.display(), "{meaning}"))
            .ok()?;
        Some((unit, debt))
    };
    files(folder).filter(|path| file_ending(path) == Some(ending)).filter_map(read).collect()
}

fn files(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let files = fs::read_dir(folder).into_iter().flatten();
    files.filter_map(|file| Some(file.ok()?.path()))
}

/// Returns the name ending of a debt file; prefers the longest match.
fn file_ending(path: &Path) -> Option<&'static str> {
    let name = path.file_name()?.to_string_lossy();
    [AUTO_TRACK, OFFSETS, STOP].into_iter().find(|ending| name.ends_with(ending))
}

/// Renames the files of addresses with capitals, which earlier versions wrote, because units look
/// for lower-case names. A file that cannot be read or renamed stays, with a note in the log.
fn lowercase_names(folder: &Path, promises: &Promises) {
    for path in files(folder) {
        let renamed = with_lowercase_address(&path).map_err(|error| error.to_string());
        let renamed = renamed.and_then(|renamed| {
            let Some((name, text)) = renamed else { return Ok(()) };
            let target = folder.join(name);
            // This version wrote the target, so the target is newer.
            if !target.exists() {
                promises.put_and_wait(&target, FileState::Holds(text))?;
            }
            promises.put_and_wait(&path, FileState::Absent)
        });
        if let Err(error) = renamed {
            tracing::error!(
                error,
                path = %path.display(),
                "could not rename a promise, so its unit does not find it"
            );
        }
    }
}

/// Returns the name and text of a file with its address in lower case, if the address has capitals.
fn with_lowercase_address(path: &Path) -> io::Result<Option<(String, String)>> {
    let Some(ending) = file_ending(path) else { return Ok(None) };
    let text = fs::read_to_string(path)?;
    // The reader reports unreadable files.
    let Ok(mut table) = toml::from_str::<toml::Table>(&text) else { return Ok(None) };
    let Ok(unit) = toml::Value::Table(table.clone()).try_into::<Unit>() else { return Ok(None) };
    let address = unit.address.to_lowercase();
    if address == unit.address {
        return Ok(None);
    }
    table.insert("address".to_owned(), toml::Value::String(address.clone()));
    let name = file_name(&Unit { address, ..unit }, ending);
    Ok(Some((name, toml::to_string(&table).map_err(io::Error::other)?)))
}

#[cfg(test)]
mod tests;
