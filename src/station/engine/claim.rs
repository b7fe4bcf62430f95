//! Claims: one Azel of this machine at a time may hold a station file and each unit. A claim
//! consists of locks. A station's lock follows its path; a unit's locks follow its address as text
//! and every place that the address leads to.

mod folders;
pub(super) mod lock;

use std::{
    collections::BTreeMap,
    fmt::Write as _,
    fs::File,
    io::{self, Read as _},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError, Weak},
};

use jiff::Timestamp;
use sha2::{Digest as _, Sha256};

pub use self::folders::{LockFolder, LockFolders};
use self::lock::{Lock, NotLocked};
use crate::{
    contract::claim::{HeldBy, Holder, HolderKind},
    driver::{Endpoint, UnitLock, known_endpoints},
    station::Antenna,
};

/// Lock of another process.
#[derive(Debug, Clone)]
pub(super) struct Elsewhere {
    pub(super) holder: HeldBy,
    /// Name of the lock; `None` if no lock could be tried.
    pub(super) lock: Option<String>,
}

/// Reason why a claim failed.
#[derive(Debug)]
pub(super) enum Unclaimed {
    /// Another Azel has one of the locks.
    Held(Elsewhere),
    /// A lock cannot be made.
    Io(io::Error),
}

/// Folders of the locks, and the holder's data for the lock files.
#[derive(Debug)]
pub(super) struct Claims {
    folders: LockFolders,
    kind: HolderKind,
    /// Socket that takes STOP.
    socket: Option<PathBuf>,
    /// Locks of this process by name. Two antennas on one line share a lock, and a new session of a
    /// unit shares it with the old one.
    locks: Mutex<BTreeMap<String, Weak<Lock>>>,
}

impl Claims {
    /// Creates claims, and the first lock folder.
    pub(super) fn new(
        folders: LockFolders,
        kind: HolderKind,
        socket: Option<PathBuf>,
    ) -> io::Result<Self> {
        folders.own.iter().take(1).try_for_each(LockFolder::make)?;
        Ok(Self { folders, kind, socket, locks: Mutex::default() })
    }

    /// Returns the folder and path of the socket that takes STOP.
    #[cfg(unix)]
    pub(super) fn socket(&self) -> Option<(LockFolder, PathBuf)> {
        self.folders.own.first().cloned().zip(self.socket.clone())
    }

    /// Claims the station file at `path`.
    pub(super) fn station(&self, path: &Path) -> Result<Arc<Lock>, Unclaimed> {
        self.lock(&station_lock(path), None)
    }

    /// Claims the unit of `antenna`: takes the locks that need no name service. `also` is the lock
    /// that another process had before.
    pub(super) fn unit(
        self: &Arc<Self>,
        antenna: &Antenna,
        also: Option<&str>,
    ) -> Result<Claim, Unclaimed> {
        let name = antenna.name.as_str();
        let written = self.lock(&written_lock(antenna), Some(name))?;
        let also = also.map(|lock| self.lock(lock, Some(name))).transpose()?;
        let claim = UnitClaim {
            claims: Arc::clone(self),
            antenna: name.to_owned(),
            written,
            places: Mutex::new(also.into_iter().collect()),
            elsewhere: Mutex::default(),
        };
        if let Some(endpoints) = known_endpoints(&antenna.connection) {
            claim.lock_places(&endpoints)?;
        }
        Ok(Arc::new(claim))
    }

    /// Recreates lock files that were removed.
    pub(super) fn renew(&self) {
        let locks: Vec<Arc<Lock>> = {
            let mut locks = unpoisoned(&self.locks);
            locks.retain(|_, lock| lock.strong_count() > 0);
            locks.values().filter_map(Weak::upgrade).collect()
        };
        for lock in locks {
            lock.renew();
        }
    }

    fn lock(&self, name: &str, antenna: Option<&str>) -> Result<Arc<Lock>, Unclaimed> {
        let mut locks = unpoisoned(&self.locks);
        if let Some(lock) = locks.get(name).and_then(Weak::upgrade) {
            return match holder_elsewhere(&lock) {
                Some(elsewhere) => Err(Unclaimed::Held(elsewhere)),
                None => Ok(lock),
            };
        }
        let me = Holder {
            kind: self.kind,
            process: std::process::id(),
            start: Timestamp::now(),
            socket: self.socket.clone(),
            antenna: antenna.map(str::to_owned),
        };
        let text = serde_json::to_string(&me).map_err(|error| Unclaimed::Io(error.into()))?;
        let lock = Lock::take(name, text, &self.folders).map_err(|error| match error {
            NotLocked::Held(holder) => {
                Unclaimed::Held(Elsewhere { holder, lock: Some(name.to_owned()) })
            }
            NotLocked::Io(error) => Unclaimed::Io(error),
        })?;
        let lock = Arc::new(lock);
        locks.insert(name.to_owned(), Arc::downgrade(&lock));
        Ok(lock)
    }
}

/// Claim on a unit. It lasts until the last clone is dropped; a session keeps a clone until it
/// ends.
pub(super) type Claim = Arc<UnitClaim>;

#[derive(Debug)]
pub(super) struct UnitClaim {
    claims: Arc<Claims>,
    /// Name of the antenna.
    antenna: String,
    /// Lock of the address as text; older versions know only this lock.
    written: Arc<Lock>,
    /// Locks of the places that the address leads to.
    places: Mutex<Vec<Arc<Lock>>>,
    /// Lock that another process had when the session opened the link.
    elsewhere: Mutex<Option<Elsewhere>>,
}

impl UnitClaim {
    /// Returns a lock of this claim that another process has.
    pub(super) fn elsewhere(&self) -> Option<Elsewhere> {
        let refused = unpoisoned(&self.elsewhere).clone();
        refused.or_else(|| {
            let places = unpoisoned(&self.places);
            let mut locks = std::iter::once(&self.written).chain(places.iter());
            locks.find_map(|lock| holder_elsewhere(lock))
        })
    }

    fn lock_places(&self, endpoints: &[Endpoint]) -> Result<(), Unclaimed> {
        if let Some(elsewhere) = holder_elsewhere(&self.written) {
            return Err(Unclaimed::Held(elsewhere));
        }
        let mut names: Vec<String> = endpoints.iter().map(place_lock).collect();
        // All processes take the locks in the same order. Two that start together then cannot each
        // get some of the locks.
        names.sort_unstable();
        names.dedup();
        let locks = names.iter().map(|name| self.claims.lock(name, Some(&self.antenna)));
        *unpoisoned(&self.places) = locks.collect::<Result<_, _>>()?;
        Ok(())
    }
}

/// Takes the locks of the unit's places; `None` takes no locks.
impl UnitLock for Option<Claim> {
    fn lock(&self, endpoints: &[Endpoint]) -> io::Result<()> {
        let Some(claim) = self else { return Ok(()) };
        claim.lock_places(endpoints).map_err(|error| match error {
            Unclaimed::Held(elsewhere) => {
                let text = format!("{} has the unit", elsewhere.holder);
                *unpoisoned(&claim.elsewhere) = Some(elsewhere);
                io::Error::other(text)
            }
            Unclaimed::Io(error) => io::Error::other(format!("the unit cannot be locked: {error}")),
        })
    }
}

/// Returns the lock if another process took it after its file was removed.
pub(super) fn holder_elsewhere(lock: &Lock) -> Option<Elsewhere> {
    let holder = lock.taken_by()?;
    Some(Elsewhere { holder, lock: Some(lock.name().to_owned()) })
}

/// Returns the other Azel that holds the station file at `path`.
pub(super) fn holder_of_station(folders: &LockFolders, path: &Path) -> Option<HeldBy> {
    lock::holder_of_name(&station_lock(path), folders)
}

/// Returns the holder named in a lock file. The lock is valid even if the file cannot be read.
fn read_holder(file: &mut File) -> Option<Holder> {
    let mut text = String::new();
    file.read_to_string(&mut text).ok()?;
    serde_json::from_str(&text).ok()
}

/// Locks a mutex. No code panics while it holds one, so poisoning can be ignored.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the socket path for the station file at `path`. It is a short name in `folder`, because
/// socket paths have a small max length.
#[cfg(unix)]
pub(super) fn socket_path(folder: &Path, path: &Path) -> PathBuf {
    folder.join(format!("{}.sock", station_lock(path)))
}

/// Returns the canonical path of a station file, even before the file exists.
pub(super) fn whole_path(path: &Path) -> PathBuf {
    let whole = path.canonicalize().or_else(|_| {
        // The file may not exist yet; its folder does.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new(".")).canonicalize()?;
        Ok::<_, io::Error>(folder.join(path.file_name().unwrap_or_default()))
    });
    whole.unwrap_or_else(|_| path.to_owned())
}

pub(super) fn station_lock(path: &Path) -> String {
    digest("station", whole_path(path).to_string_lossy().as_bytes())
}

/// Returns the name of a unit's lock for its address as text.
pub(super) fn written_lock(antenna: &Antenna) -> String {
    let connection = &antenna.connection;
    let address = connection.address.trim().to_lowercase();
    digest("unit", format!("{} {address}", connection.spec().key).as_bytes())
}

/// Returns the name of the lock for a place where a unit can be reached.
pub(super) fn place_lock(endpoint: &Endpoint) -> String {
    digest("unit", endpoint.key().as_bytes())
}

pub(super) fn digest(kind: &str, bytes: &[u8]) -> String {
    let mut name = format!("{kind}-");
    for byte in Sha256::digest(bytes).iter().take(8) {
        // Writing to a `String` cannot fail.
        let _ = write!(name, "{byte:02x}");
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claims(folder: &Path) -> Arc<Claims> {
        let folders = folder.join("run").into();
        Arc::new(Claims::new(folders, HolderKind::Serve, None).unwrap())
    }

    /// Returns a port of this machine that stays reserved while the listener exists.
    fn port() -> (std::net::TcpListener, u16) {
        let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let port = listener.local_addr().unwrap().port();
        (listener, port)
    }

    #[test]
    fn what_is_held_is_held_by_one_who_says_who_it_is_until_it_ends() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (claims(folder.path()), claims(folder.path()));
        let path = folder.path().join("station.toml");
        let lock = first.station(&path).ok().unwrap();
        let Err(Unclaimed::Held(Elsewhere { holder: HeldBy::Azel(Some(holder)), .. })) =
            second.station(&path)
        else {
            panic!("free")
        };
        assert_eq!((holder.kind, holder.process), (HolderKind::Serve, std::process::id()));
        let run = folder.path().join("run").into();
        assert_eq!(holder_of_station(&run, &path), Some(HeldBy::Azel(Some(holder))));
        assert_eq!(holder_of_station(&run, &folder.path().join("other.toml")), None);
        // The holder may claim again. The claim lasts until the last clone is dropped.
        let again = first.station(&path).ok().unwrap();
        drop(lock);
        assert!(second.station(&path).is_err());
        drop(again);
        assert_eq!(holder_of_station(&run, &path), None);
        assert!(second.station(&path).is_ok());
    }

    #[test]
    fn a_unit_is_one_whatever_its_antenna_is_called() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (claims(folder.path()), claims(folder.path()));
        let me = std::process::id();
        let dish = Antenna::satrak("Dish", &format!("Unit-{me}.Invalid:4001"));
        let other = Antenna::satrak("Other", &format!("unit-{me}.invalid:4001 "));
        let unit_claim = first.unit(&dish, None).ok().unwrap();
        let Err(Unclaimed::Held(Elsewhere { holder: HeldBy::Azel(Some(holder)), .. })) =
            second.unit(&other, None)
        else {
            panic!("free")
        };
        assert_eq!(holder.antenna.as_deref(), Some("Dish"));
        assert!(
            second.unit(&Antenna::satrak("Dish", &format!("unit-{me}.invalid:1")), None).is_ok()
        );
        drop(unit_claim);
    }

    #[test]
    fn a_unit_is_one_whatever_its_make_and_address_are_called() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (claims(folder.path()), claims(folder.path()));
        let (_listener, port) = port();
        let unit_claim = first.unit(&Antenna::satrak("Dish", &format!("127.0.0.1:{port}")), None);
        assert!(unit_claim.is_ok());
        let other = Antenna::genius("Mast", &format!("[::1]:{port}"));
        assert!(matches!(second.unit(&other, None), Err(Unclaimed::Held(_))));
    }

    #[test]
    fn a_name_is_locked_by_where_it_leads_and_the_lock_in_the_way_is_kept_in_mind() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (claims(folder.path()), claims(folder.path()));
        let (_listener, port) = port();
        let dish = Antenna::satrak("Dish", &format!("127.0.0.1:{port}"));
        let unit_claim = first.unit(&dish, None).ok().unwrap();
        // The places behind a host name are unknown before the name is looked up.
        let other = Antenna::satrak("Dish", &format!("name-{port}.invalid:4001"));
        let claim = second.unit(&other, None).ok().unwrap();
        assert!(claim.elsewhere().is_none());
        let endpoints = known_endpoints(&dish.connection).unwrap();
        let error = Some(Arc::clone(&claim)).lock(&endpoints).unwrap_err().to_string();
        assert!(error.contains("azel serve"), "{error}");
        let lock = claim.elsewhere().unwrap().lock;
        drop(claim);
        assert!(second.unit(&other, lock.as_deref()).is_err(), "it is still held");
        drop(unit_claim);
        let claim = second.unit(&other, lock.as_deref()).ok().unwrap();
        assert!(first.unit(&dish, None).is_err());
        assert!(Some(claim).lock(&endpoints).is_ok());
    }

    #[test]
    fn a_station_file_has_one_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        let spelled = folder.path().join(".").join("station.toml");
        assert_eq!(whole_path(&path), whole_path(&spelled), "before it is there");
        std::fs::write(&path, "").unwrap();
        assert_eq!(whole_path(&path), whole_path(&spelled));
    }
}
