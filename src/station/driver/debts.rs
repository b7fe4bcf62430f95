//! STOPs that are owed, auto-track that is to be off, and offsets of shifted tracks. A debt belongs
//! to a unit, not to a row of the settings: it outlives the session, the name and the address of its
//! antenna and, as a record on disk, this program. Auto-track has such a record only where no antenna
//! is left that would be looked after at the next start.

mod shifted_track;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs, io,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use tokio::sync::Notify;

use crate::{clock::Instant, station::Antenna, whole_file};
pub(super) use shifted_track::ShiftedTrack;

/// End of the names of records of auto-track.
const AUTO_TRACK: &str = ".auto-track.toml";

/// A unit, by what does not change when the operator renames its antenna.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Unit {
    /// Key of its make, as in the station file.
    pub make: String,
    /// Address in lower case, because host names ignore case.
    pub address: String,
}

impl Unit {
    pub fn of(antenna: &Antenna) -> Self {
        Self {
            make: antenna.connection.spec().key.to_owned(),
            address: antenna.connection.address.trim().to_lowercase(),
        }
    }

    /// Name of the record of a STOP: readable, and unique to the unit.
    fn file_name(&self) -> String {
        format!("{}.toml", self.stem())
    }

    /// Name of the record that auto-track is to be off.
    fn auto_track_file_name(&self) -> String {
        format!("{}{AUTO_TRACK}", self.stem())
    }

    fn stem(&self) -> String {
        let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '-' };
        let readable: String = self.address.chars().map(plain).take(40).collect();
        let hash = Sha256::digest(format!("{}\n{}", self.make, self.address));
        let [a, b, c, d, ..] = *hash.first_chunk::<4>().unwrap_or(&[0; 4]);
        format!("{}-{readable}-{a:02x}{b:02x}{c:02x}{d:02x}", self.make)
    }
}

/// Content of a record on disk.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Mark {
    #[serde(flatten)]
    unit: Unit,
    /// When the motion by hand began.
    since: Timestamp,
}

impl Ledger {
    /// The STOP of a newer session of the same unit.
    fn newer(&self, unit: &Unit, session: u64) -> Option<&Arc<Notify>> {
        let newest = self.sessions.get(unit).filter(|(number, _)| *number > session);
        newest.map(|(_, stop)| stop)
    }
}

/// All debts of this program. Clones share them.
#[derive(Debug, Clone, Default)]
pub struct Debts {
    /// Folder of the records; `None` for none.
    folder: Option<Arc<Path>>,
    ledger: Arc<Mutex<Ledger>>,
    /// Held while records of auto-track and offsets are written or removed. The ledger is taken
    /// after it, and never before.
    files: Arc<Mutex<()>>,
}

#[derive(Debug, Default)]
struct Ledger {
    /// Number of the newest session.
    newest: u64,
    /// The newest session of each unit, and its STOP.
    sessions: BTreeMap<Unit, (u64, Arc<Notify>)>,
    owed: BTreeSet<Unit>,
    /// Units whose auto-track is to be off and was not read back as off since.
    auto_track: BTreeSet<Unit>,
    /// Units that were moved from here since then and are not known to stand.
    unproved: BTreeMap<Unit, Instant>,
    /// Units that may hold offsets of a pass that were written from here.
    shifted: BTreeMap<Unit, ShiftedTrack>,
}

impl Debts {
    /// With records in `folder`, and what an earlier run recorded there of auto-track and offsets.
    pub fn marked_in(folder: Option<PathBuf>) -> Self {
        let debts = Self { folder: folder.map(Arc::from), ..Self::default() };
        if let Some(folder) = debts.folder.as_deref() {
            lowercase_record_names(folder);
        }
        let found = debts.folder.as_deref().map_or_else(Vec::new, with_auto_track);
        debts.ledger().auto_track.extend(found);
        let shifted = debts.folder.as_deref().map_or_else(Vec::new, shifted_track::found);
        debts.ledger().shifted.extend(shifted);
        debts
    }

    fn ledger(&self) -> MutexGuard<'_, Ledger> {
        // No code panics while it holds the lock.
        self.ledger.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn files(&self) -> MutexGuard<'_, ()> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A session of `unit` begins; `stop` stops it, at once if a STOP is owed. Returns its
    /// number.
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

    /// The unit stands, or the operator has seen that it does.
    pub(super) fn settle(&self, unit: &Unit) {
        self.ledger().owed.remove(unit);
    }

    /// Hands the debt of `session` to a newer session of the same unit; returns `false` if
    /// there is none.
    pub(super) fn hand_over(&self, unit: &Unit, session: u64) -> bool {
        let ledger = self.ledger();
        let newer = ledger.newer(unit, session);
        if let Some(stop) = newer {
            stop.notify_one();
        }
        newer.is_some()
    }

    /// Returns `true` if there is a newer session of the same unit than `session`.
    pub(super) fn is_followed(&self, unit: &Unit, session: u64) -> bool {
        self.ledger().newer(unit, session).is_some()
    }

    /// From now on `unit` is not to track by itself.
    pub fn owe_auto_track_off(&self, unit: &Unit) {
        self.ledger().auto_track.insert(unit.clone());
    }

    /// Like [`Self::owe_auto_track_off`], also for the next start: no antenna is left that has this
    /// unit. Blocks until it is on the disk.
    pub fn mark_auto_track_off(&self, unit: &Unit, since: Timestamp) -> io::Result<()> {
        self.owe_auto_track_off(unit);
        let Some(folder) = &self.folder else { return Ok(()) };
        let mark = Mark { unit: unit.clone(), since };
        let text = toml::to_string(&mark).map_err(io::Error::other)?;
        let _files = self.files();
        whole_file::replace(&folder.join(unit.auto_track_file_name()), text.as_bytes())
    }

    /// The unit does not track by itself any more, is to do so again, or is another's. Returns
    /// `true` if it was to be off; then [`Self::unmark_auto_track`] removes the record.
    pub fn settle_auto_track(&self, unit: &Unit) -> bool {
        self.ledger().auto_track.remove(unit)
    }

    /// Removes the record of a debt that is settled and has not arisen anew. Blocks.
    pub(super) fn unmark_auto_track(&self, unit: &Unit) {
        let Some(folder) = &self.folder else { return };
        let _files = self.files();
        if !self.owes_auto_track_off(unit) {
            // A missing file needs no removal; one that stays switches auto-track off once more.
            fs::remove_file(folder.join(unit.auto_track_file_name())).ok();
        }
    }

    pub(super) fn owes_auto_track_off(&self, unit: &Unit) -> bool {
        self.ledger().auto_track.contains(unit)
    }

    /// The units whose auto-track is to be off and is not read back as off.
    pub fn with_auto_track(&self) -> Vec<Unit> {
        self.ledger().auto_track.iter().cloned().collect()
    }

    /// Records since when `unit` was moved without proof that it stands. An older `session`
    /// than the newest is ignored.
    pub(super) fn keep_unproved(&self, unit: &Unit, session: u64, since: Option<Instant>) {
        let mut ledger = self.ledger();
        if ledger.sessions.get(unit).is_none_or(|(newest, _)| *newest != session) {
            return;
        }
        match since {
            Some(since) => drop(ledger.unproved.insert(unit.clone(), since)),
            None => drop(ledger.unproved.remove(unit)),
        }
    }

    /// Since when `unit` was moved without proof that it stands.
    pub(super) fn unproved_since(&self, unit: &Unit) -> Option<Instant> {
        self.ledger().unproved.get(unit).copied()
    }

    pub fn owes(&self, unit: &Unit) -> bool {
        self.ledger().owed.contains(unit)
    }

    /// The units to which a STOP is owed.
    pub fn units(&self) -> Vec<Unit> {
        self.ledger().owed.iter().cloned().collect()
    }

    /// Returns `true` if there is a folder for records.
    pub(super) fn has_marks(&self) -> bool {
        self.folder.is_some()
    }

    /// Records on disk that `unit` is moved by hand. Blocks until it is on the disk.
    pub(super) fn mark(&self, unit: &Unit, since: Timestamp) -> io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let text =
            toml::to_string(&Mark { unit: unit.clone(), since }).map_err(io::Error::other)?;
        whole_file::replace(&folder.join(unit.file_name()), text.as_bytes())
    }

    pub(super) fn unmark(&self, unit: &Unit) {
        let Some(folder) = &self.folder else { return };
        // A missing file needs no removal; one that stays costs a STOP.
        fs::remove_file(folder.join(unit.file_name())).ok();
    }

    /// Returns `true` if an earlier run may have left `unit` moving. Blocks.
    pub fn is_marked(&self, unit: &Unit) -> bool {
        self.marked(unit).is_some()
    }

    /// Since when `unit` may be moving, by the record of an earlier run. An unreadable record
    /// counts from the beginning of time.
    pub(super) fn marked(&self, unit: &Unit) -> Option<Timestamp> {
        let path = self.folder.as_ref()?.join(unit.file_name());
        match fs::read_to_string(path) {
            Ok(text) => {
                let mark = toml::from_str::<Mark>(&text);
                Some(mark.map_or(Timestamp::UNIX_EPOCH, |mark| mark.since))
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(_) => Some(Timestamp::UNIX_EPOCH),
        }
    }
}

/// Renames the records of addresses with capitals, so that their units find them. A record that
/// cannot be read or renamed stays, and the log says so.
fn lowercase_record_names(folder: &Path) {
    let Ok(files) = fs::read_dir(folder) else { return };
    for path in files.filter_map(|file| Some(file.ok()?.path())) {
        let renamed = with_lowercase_address(&path).and_then(|renamed| {
            let Some((name, text)) = renamed else { return Ok(()) };
            whole_file::replace(&folder.join(name), text.as_bytes())?;
            fs::remove_file(&path)
        });
        if let Err(error) = renamed {
            tracing::error!(%error, path = %path.display(), "could not rename a record, so its unit does not find it");
        }
    }
}

/// Returns the name and text of a record with its address in lower case, if the address has
/// capitals.
fn with_lowercase_address(path: &Path) -> io::Result<Option<(String, String)>> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let endings = [AUTO_TRACK, shifted_track::SHIFTED, ".toml"];
    let Some(ending) = endings.into_iter().find(|ending| name.ends_with(ending)) else {
        return Ok(None);
    };
    let text = fs::read_to_string(path)?;
    // The reader reports other files.
    let Ok(mut table) = toml::from_str::<toml::Table>(&text) else { return Ok(None) };
    let Ok(unit) = toml::Value::Table(table.clone()).try_into::<Unit>() else { return Ok(None) };
    let address = unit.address.to_lowercase();
    if address == unit.address {
        return Ok(None);
    }
    table.insert("address".to_owned(), toml::Value::String(address.clone()));
    let name = format!("{}{ending}", Unit { address, ..unit }.stem());
    Ok(Some((name, toml::to_string(&table).map_err(io::Error::other)?)))
}

/// The units with records of auto-track in `folder`. One that cannot be read names no unit: it
/// stays, and the log says so.
fn with_auto_track(folder: &Path) -> Vec<Unit> {
    let Ok(files) = fs::read_dir(folder) else { return Vec::new() };
    let paths = files.filter_map(|file| Some(file.ok()?.path()));
    let is_one = |path: &PathBuf| path.to_string_lossy().ends_with(AUTO_TRACK);
    let unit = |path: PathBuf| {
        let text = fs::read_to_string(&path).map_err(io::Error::other);
        let mark = text.and_then(|text| toml::from_str::<Mark>(&text).map_err(io::Error::other));
        let told = mark.inspect_err(|error| {
            tracing::error!(%error, path = %path.display(), "a unit may still track by itself");
        });
        told.ok().map(|mark| mark.unit)
    };
    paths.filter(is_one).filter_map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(address: &str) -> Unit {
        Unit { make: "satrak".to_owned(), address: address.to_owned() }
    }

    #[test]
    fn a_mark_outlives_the_program_until_it_is_taken_away() {
        let folder = tempfile::tempdir().unwrap();
        let since: Timestamp = "2026-08-12T01:02:03Z".parse().unwrap();
        let (one, other) = (unit("10.0.0.5:4001"), unit("10.0.0.5_4001"));
        let debts = || Debts::marked_in(Some(folder.path().join("marks")));
        debts().mark(&one, since).unwrap();
        assert_eq!(debts().marked(&one), Some(since));
        assert_eq!(debts().marked(&other), None, "another address");
        debts().unmark(&one);
        assert_eq!(debts().marked(&one), None);
        debts().unmark(&one);
    }

    #[test]
    fn records_of_an_address_with_capitals_are_found_with_lowercase_address() {
        let folder = tempfile::tempdir().unwrap();
        let since: Timestamp = "2026-08-12T01:02:03Z".parse().unwrap();
        let debts = || Debts::marked_in(Some(folder.path().to_owned()));
        // As an earlier version wrote them.
        debts().mark(&unit("Dish.Local:4001"), since).unwrap();
        debts().mark_auto_track_off(&unit("Mast.Local:4001"), since).unwrap();
        let written = unit("DISH.local:4001");
        let antenna = Antenna::satrak("Dish", &written.address);
        assert_eq!(Unit::of(&antenna), unit("dish.local:4001"));
        let debts = debts();
        assert_eq!(debts.marked(&Unit::of(&antenna)), Some(since));
        assert_eq!(debts.with_auto_track(), [unit("mast.local:4001")]);
        debts.unmark(&Unit::of(&antenna));
        assert_eq!(
            Debts::marked_in(debts.folder.as_deref().map(Path::to_owned))
                .marked(&Unit::of(&antenna)),
            None
        );
    }

    #[test]
    fn a_mark_that_cannot_be_read_still_warns() {
        let folder = tempfile::tempdir().unwrap();
        let debts = Debts::marked_in(Some(folder.path().to_owned()));
        fs::write(folder.path().join(unit("a:1").file_name()), "since = ").unwrap();
        assert_eq!(debts.marked(&unit("a:1")), Some(Timestamp::UNIX_EPOCH));
    }

    #[test]
    fn a_debt_goes_to_the_newest_session_of_its_unit() {
        let (debts, unit) = (Debts::default(), unit("a:1"));
        let (old, new) = (Arc::new(Notify::new()), Arc::new(Notify::new()));
        let first = debts.begin(&unit, old);
        debts.owe(&unit);
        assert!(!debts.hand_over(&unit, first), "nobody else is there");
        let second = debts.begin(&unit, Arc::clone(&new));
        assert!(second > first && debts.hand_over(&unit, first));
        assert!(is_notified(&new), "STOP is its first word");
        debts.settle(&unit);
        assert_eq!(debts.units(), []);
    }

    #[test]
    fn auto_track_that_is_to_be_off_hands_no_stop_to_the_next_session() {
        let (debts, unit) = (Debts::default(), unit("a:1"));
        let first = debts.begin(&unit, Arc::default());
        debts.owe_auto_track_off(&unit);
        assert!(!debts.is_followed(&unit, first));
        let stop = Arc::new(Notify::new());
        debts.begin(&unit, Arc::clone(&stop));
        assert!(debts.is_followed(&unit, first) && !is_notified(&stop));
        assert_eq!(debts.with_auto_track(), std::slice::from_ref(&unit));
        debts.settle_auto_track(&unit);
        assert!(!debts.owes_auto_track_off(&unit));
    }

    #[test]
    fn auto_track_that_is_to_be_off_outlives_the_program_until_it_is_settled() {
        let folder = tempfile::tempdir().unwrap();
        let debts = || Debts::marked_in(Some(folder.path().join("marks")));
        let (one, other) = (unit("10.0.0.5:4001"), unit("10.0.0.6:4001"));
        let first = debts();
        first.mark(&other, Timestamp::UNIX_EPOCH).unwrap();
        first.mark_auto_track_off(&one, Timestamp::UNIX_EPOCH).unwrap();
        first.owe_auto_track_off(&other);
        assert_eq!(first.with_auto_track(), [one.clone(), other.clone()]);
        assert_eq!(debts().marked(&one), None, "it is no STOP");
        let second = debts();
        assert_eq!(second.with_auto_track(), std::slice::from_ref(&one));
        second.unmark_auto_track(&one);
        assert_eq!(debts().with_auto_track(), std::slice::from_ref(&one), "it is not settled");
        assert!(second.settle_auto_track(&one) && !second.settle_auto_track(&one));
        second.unmark_auto_track(&one);
        assert_eq!(debts().with_auto_track(), []);
        assert!(debts().marked(&other).is_some());
    }

    #[test]
    fn a_record_of_auto_track_that_cannot_be_read_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(unit("a:1").auto_track_file_name());
        fs::write(&path, "since = ").unwrap();
        assert_eq!(Debts::marked_in(Some(folder.path().to_owned())).with_auto_track(), []);
        assert!(path.exists());
    }

    #[test]
    fn that_a_unit_is_not_known_to_stand_outlives_its_session() {
        let (debts, unit) = (Debts::default(), unit("a:1"));
        let first = debts.begin(&unit, Arc::default());
        let since = Instant::now();
        debts.keep_unproved(&unit, first, Some(since));
        let second = debts.begin(&unit, Arc::default());
        assert_eq!(debts.unproved_since(&unit), Some(since));
        debts.keep_unproved(&unit, first, None);
        assert_eq!(debts.unproved_since(&unit), Some(since), "the older one knows no better");
        debts.keep_unproved(&unit, second, None);
        assert_eq!(debts.unproved_since(&unit), None);
    }

    /// Whether a permit waits.
    fn is_notified(notify: &Notify) -> bool {
        use std::{
            future::Future as _,
            task::{Context, Waker},
        };
        let mut notified = Box::pin(notify.notified());
        notified.as_mut().poll(&mut Context::from_waker(Waker::noop())).is_ready()
    }
}
