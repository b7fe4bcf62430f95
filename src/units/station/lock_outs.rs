//! Lock-outs of units for maintenance, in a separate file beside the station file.
//!
//! Invariant: an unreadable file locks out all units, never none.

use std::{collections::BTreeMap, fs, io, path::Path};

use jiff::Timestamp;
use serde::{Deserialize, Deserializer, Serialize};

use super::{Antenna, Connection};

/// Name of the file beside the station file.
pub const LOCK_OUTS_FILE: &str = "lock-outs.toml";
/// Version of the file that Azel writes.
const VERSION: i64 = 1;

/// Lock-out of a unit while somebody works on it: Azel sends it only questions and STOP.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LockOut {
    /// Person who has locked out the unit.
    #[serde(rename = "by", deserialize_with = "one_line")]
    pub operator: String,
    #[serde(deserialize_with = "one_line")]
    pub reason: String,
    #[serde(rename = "since")]
    pub start: Timestamp,
}

/// Reads a text and replaces control characters with spaces. The text can then neither send escape
/// sequences to a terminal nor forge a line.
fn one_line<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let text = String::deserialize(deserializer)?;
    Ok(text.replace(char::is_control, " "))
}

/// Key of a unit: its make and address, without the name of its antenna.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct UnitKey {
    make: String,
    address: String,
}

impl UnitKey {
    fn new(connection: &Connection) -> Self {
        let address = connection.address.trim().to_lowercase();
        Self { make: connection.spec().key.to_owned(), address }
    }
}

/// All locked-out units.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LockOuts {
    units: BTreeMap<UnitKey, LockOut>,
    /// Lock-out of all other units, because the file could not be read.
    others: Option<LockOut>,
    /// Changes that are not on the disk yet; `None` removes a lock-out.
    unsaved: BTreeMap<UnitKey, Option<LockOut>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    version: i64,
    #[serde(default, rename = "lock_out")]
    lock_outs: Vec<LockOutEntry>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LockOutEntry {
    make: String,
    address: String,
    #[serde(rename = "by", deserialize_with = "one_line")]
    operator: String,
    #[serde(deserialize_with = "one_line")]
    reason: String,
    #[serde(rename = "since")]
    start: Timestamp,
}

impl LockOuts {
    /// Reads the file at `path`. A missing file locks out no unit. An unreadable file locks out
    /// every unit; the second value gives the reason.
    pub fn load(path: &Path, now: Timestamp) -> (Self, Option<String>) {
        let read = match fs::read_to_string(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Default::default(),
            Err(error) => Err(error.to_string()),
            Ok(text) => Self::parse(&text),
        };
        match read {
            Ok(units) => (Self { units, ..Self::default() }, None),
            Err(reason) => {
                let others = LockOut {
                    operator: "Azel".to_owned(),
                    reason: format!("{LOCK_OUTS_FILE} cannot be read"),
                    start: now,
                };
                let lock_outs = Self { others: Some(others), ..Self::default() };
                (lock_outs, Some(format!("{}: {}", reason.trim(), path.display())))
            }
        }
    }

    /// Reads the file again like [`Self::load`]. Keeps the changes that are not saved yet.
    pub fn reload(&mut self, path: &Path, now: Timestamp) -> Option<String> {
        let (loaded, problem) = Self::load(path, now);
        let unsaved = std::mem::take(&mut self.unsaved);
        *self = loaded;
        for (unit, lock_out) in &unsaved {
            self.put(unit.clone(), lock_out.clone());
        }
        self.unsaved = unsaved;
        problem
    }

    fn put(&mut self, unit: UnitKey, lock_out: Option<LockOut>) {
        match lock_out {
            Some(lock_out) => drop(self.units.insert(unit, lock_out)),
            None => drop(self.units.remove(&unit)),
        }
    }

    fn parse(text: &str) -> Result<BTreeMap<UnitKey, LockOut>, String> {
        let file: File = toml::from_str(text).map_err(|error| error.message().to_owned())?;
        if file.version != VERSION {
            return Err(format!("it has version {}, this program knows {VERSION}", file.version));
        }
        let unit = |line: LockOutEntry| {
            let LockOutEntry { make, address, operator, reason, start } = line;
            (UnitKey { make, address }, LockOut { operator, reason, start })
        };
        Ok(file.lock_outs.into_iter().map(unit).collect())
    }

    /// Returns the lock-out of the unit at `connection`.
    pub fn find(&self, connection: &Connection) -> Option<&LockOut> {
        self.units.get(&UnitKey::new(connection)).or(self.others.as_ref())
    }

    /// Sets or removes the lock-out of the unit at `connection`. If the file could not be
    /// read, the other units of `station` stay locked out by name.
    pub fn set<'a>(
        &mut self,
        connection: &Connection,
        lock_out: Option<LockOut>,
        station: impl Iterator<Item = &'a Connection>,
    ) {
        if let Some(others) = self.others.take() {
            for connection in station {
                let unit = UnitKey::new(connection);
                if !self.units.contains_key(&unit) {
                    self.unsaved.insert(unit.clone(), Some(others.clone()));
                    self.put(unit, Some(others.clone()));
                }
            }
        }
        let unit = UnitKey::new(connection);
        self.unsaved.insert(unit.clone(), lock_out.clone());
        self.put(unit, lock_out);
    }

    /// Applies the lock-outs to changed antennas. A locked-out unit stays locked out, and also its
    /// antenna's new address or make: the person at work may be at either. Returns `true` if a
    /// lock-out was added.
    pub fn stay_with_antennas(&mut self, before: &[Antenna], after: &[Antenna]) -> bool {
        let previous_count = self.units.len();
        for old in before {
            let Some(lock_out) = self.units.get(&UnitKey::new(&old.connection)).cloned() else {
                continue;
            };
            let antenna = after.iter().find(|antenna| antenna.id == old.id);
            let unit = antenna.map(|antenna| UnitKey::new(&antenna.connection));
            if let Some(unit) = unit.filter(|unit| !self.units.contains_key(unit)) {
                self.unsaved.insert(unit.clone(), Some(lock_out.clone()));
                self.put(unit, Some(lock_out));
            }
        }
        self.units.len() > previous_count
    }

    /// Returns the content of the file with all lock-outs.
    pub fn text(&self) -> Result<String, toml::ser::Error> {
        let line = |(unit, lock_out): (&UnitKey, &LockOut)| {
            let (UnitKey { make, address }, LockOut { operator, reason, start }) =
                (unit.clone(), lock_out.clone());
            LockOutEntry { make, address, operator, reason, start }
        };
        let lock_outs = self.units.iter().map(line).collect();
        toml::to_string_pretty(&File { version: VERSION, lock_outs })
    }

    /// Marks all lock-outs as saved. Until then, the changes stay in memory, also when Azel reads
    /// the file again.
    pub fn saved(&mut self) {
        self.unsaved.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::station::AntennaId;

    fn lock_out(reason: &str) -> LockOut {
        LockOut {
            operator: "Ada".to_owned(),
            reason: reason.to_owned(),
            start: "2026-11-22T10:00:00Z".parse().unwrap(),
        }
    }

    fn now() -> Timestamp {
        "2026-11-22T11:00:00Z".parse().unwrap()
    }

    fn save(lock_outs: &mut LockOuts, path: &Path) {
        fs::write(path, lock_outs.text().unwrap()).unwrap();
        lock_outs.saved();
    }

    #[test]
    fn a_text_of_another_program_is_one_line_without_control_characters() {
        let text = r#"{"by": "Ada\u001b[2J", "reason": "belts\nMast: stands\u009b1m",
            "since": "2026-11-22T10:00:00Z"}"#;
        let read: LockOut = serde_json::from_str(text).unwrap();
        assert_eq!((&*read.operator, &*read.reason), ("Ada [2J", "belts Mast: stands 1m"));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK_OUTS_FILE);
        let dish = Antenna::satrak("Dish", "unit:1").connection;
        let file = "version = 1\n[[lock_out]]\nmake = \"satrak\"\naddress = \"unit:1\"\n\
                    by = \"Ada\"\nreason = \"belts\\u001B[2J\"\nsince = \"2026-11-22T10:00:00Z\"\n";
        fs::write(&path, file).unwrap();
        let (lock_outs, trouble) = LockOuts::load(&path, now());
        assert_eq!(trouble, None);
        assert_eq!(lock_outs.find(&dish).unwrap().reason, "belts [2J");
    }

    #[test]
    fn a_lock_out_is_of_the_unit_and_not_of_the_name_of_its_antenna() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK_OUTS_FILE);
        let dish = Antenna::satrak("Dish", "Unit.local:4001").connection;
        let renamed = Antenna::satrak("North dish", "unit.local:4001").connection;
        let other = Antenna::satrak("Dish", "unit.local:4002").connection;
        let make = Antenna::genius("Dish", "unit.local:4001").connection;
        assert_eq!(LockOuts::load(&path, now()), (LockOuts::default(), None), "no file");
        let mut lock_outs = LockOuts::default();
        lock_outs.set(&dish, Some(lock_out("gear")), std::iter::empty());
        save(&mut lock_outs, &path);

        let (mut again, problem) = LockOuts::load(&path, now());
        assert_eq!((&again, problem), (&lock_outs, None));
        assert_eq!(again.find(&renamed), Some(&lock_out("gear")));
        assert_eq!((again.find(&other), again.find(&make)), (None, None));
        again.set(&renamed, None, std::iter::empty());
        save(&mut again, &path);
        assert_eq!(LockOuts::load(&path, now()), (LockOuts::default(), None));
    }

    /// Reads a file that version f93e9bd5 wrote.
    #[test]
    fn a_list_of_an_earlier_version_means_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK_OUTS_FILE);
        let text = "version = 1\n\n[[lock_out]]\nmake = \"satrak\"\naddress = \"unit.local:4001\"\n\
                    by = \"Ada\"\nreason = \"gear\"\nsince = \"2026-11-22T10:00:00Z\"\n";
        fs::write(&path, text).unwrap();
        let (lock_outs, problem) = LockOuts::load(&path, now());
        assert_eq!(problem, None);
        let dish = Antenna::satrak("Dish", "Unit.local:4001").connection;
        assert_eq!(lock_outs.find(&dish), Some(&lock_out("gear")));
        assert_eq!(lock_outs.text().unwrap(), text, "it is written the same");
    }

    #[test]
    fn a_lock_out_that_could_not_be_saved_stays_when_the_file_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK_OUTS_FILE);
        let dish = Antenna::satrak("Dish", "10.0.0.1:4001").connection;
        let mast = Antenna::genius("Mast", "10.0.0.2:9006").connection;
        let mut lock_outs = LockOuts::default();
        lock_outs.set(&dish, Some(lock_out("gear")), std::iter::empty());
        // This change is not saved to the disk.
        assert_eq!(lock_outs.reload(&path, now()), None);
        lock_outs.set(&mast, Some(lock_out("belts")), std::iter::empty());
        assert!(lock_outs.find(&dish).is_some() && lock_outs.find(&mast).is_some());
        save(&mut lock_outs, &path);
        let (again, _) = LockOuts::load(&path, now());
        assert!(again.find(&dish).is_some() && again.find(&mast).is_some());
    }

    #[test]
    fn a_file_that_cannot_be_read_locks_everything_until_the_operator_says() {
        let dish = Antenna::satrak("Dish", "10.0.0.1:4001").connection;
        let mast = Antenna::genius("Mast", "10.0.0.2:9006").connection;
        let good = "version = 1\n[[lock_out]]\nmake = \"satrak\"\naddress = \"a:1\"\n\
                    by = \"Ada\"\nreason = \"gear\"\nsince = \"2026-11-22T10:00:00Z\"\n";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK_OUTS_FILE);
        fs::write(&path, good).unwrap();
        assert_eq!(LockOuts::load(&path, now()).1, None);
        for bad in [
            &good.replace("version = 1", "version = 2"),
            &good.replace("version = 1\n", ""),
            &good.replace("make", "mark"),
            &good.replace("by = \"Ada\"\n", ""),
            &good.replace("2026-11-22T10:00:00Z", "yesterday"),
            &format!("{good}colour = 3\n"),
            &good[..good.len() - 6],
            "",
        ] {
            fs::write(&path, bad).unwrap();
            let (mut lock_outs, problem) = LockOuts::load(&path, now());
            assert!(problem.is_some(), "{bad}");
            for unit in [&dish, &mast] {
                let lock_out = lock_outs.find(unit).expect("locked out");
                assert_eq!((lock_out.operator.as_str(), lock_out.start), ("Azel", now()));
            }
            lock_outs.set(&dish, None, [&dish, &mast].into_iter());
            save(&mut lock_outs, &path);
            let (again, problem) = LockOuts::load(&path, now());
            assert_eq!(problem, None);
            assert_eq!(again.find(&dish), None);
            assert!(again.find(&mast).is_some(), "nobody has said so of this one");
        }
        // A folder is not readable as a file.
        let (lock_outs, problem) = LockOuts::load(folder.path(), now());
        assert!(problem.is_some() && lock_outs.find(&dish).is_some());
    }

    #[test]
    fn a_lock_out_stays_with_the_antenna_whose_address_make_name_or_place_is_changed() {
        let dish = Antenna::satrak("Dish", "a:1");
        let mast = Antenna { id: AntennaId(2), ..Antenna::genius("Mast", "m:1") };
        let locked = || {
            let mut lock_outs = LockOuts::default();
            lock_outs.set(&dish.connection, Some(lock_out("gear")), std::iter::empty());
            lock_outs
        };
        let before = [dish.clone(), mast.clone()];
        for changed in [
            Antenna::satrak("Dish", "a:2"),
            Antenna::rc2000c("Dish", "COM3"),
            Antenna::satrak("North dish", "a:2"),
        ] {
            let mut lock_outs = locked();
            assert!(lock_outs.stay_with_antennas(&before, &[mast.clone(), changed.clone()]));
            assert_eq!(lock_outs.find(&changed.connection), Some(&lock_out("gear")), "{changed:?}");
            assert!(lock_outs.find(&dish.connection).is_some(), "the unit itself stays so");
            assert_eq!(lock_outs.find(&mast.connection), None);
            // The operator removes each lock-out separately, with a hold.
            lock_outs.set(&changed.connection, None, std::iter::empty());
            assert_eq!(lock_outs.find(&changed.connection), None);
        }
        let mut lock_outs = locked();
        assert!(!lock_outs.stay_with_antennas(&before, std::slice::from_ref(&mast)), "deleted");
        assert_eq!(lock_outs.find(&mast.connection), None);
        assert!(!lock_outs.stay_with_antennas(&before, &before));
    }
}
