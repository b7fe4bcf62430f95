//! Claims: a station file and each unit may be held by one Azel of this machine at a time.
//! A claim is a locked file; the operating system frees it with the process, however that
//! ends.

use std::{
    collections::BTreeMap,
    fmt::Write as _,
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, Read as _, Write as _},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError, Weak},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use crate::station::Antenna;

/// The process that holds a claim.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    pub kind: HolderKind,
    /// Process id.
    pub process: u32,
    pub since: Timestamp,
    /// Socket on which it takes STOP.
    pub socket: Option<PathBuf>,
    /// Its name of the antenna, where it holds a unit.
    pub antenna: Option<String>,
}

/// Kind of Azel that holds a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HolderKind {
    /// An Azel with a window.
    #[default]
    Window,
    /// `azel serve`.
    Serve,
}

/// Why something is not claimed here.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum HeldBy {
    /// Another Azel of this machine holds it; `None` where it does not say who it is.
    Azel(Option<Holder>),
    /// No lock can be made, for this reason, so nobody knows whether another program has it.
    Unknown(String),
}

impl std::fmt::Display for HeldBy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let holder = match self {
            Self::Azel(holder) => holder,
            Self::Unknown(why) => {
                return write!(f, "perhaps another program (Azel could not lock it: {why})");
            }
        };
        let Some(Holder { kind, process, since, .. }) = holder else {
            return write!(f, "another Azel");
        };
        let kind = match kind {
            HolderKind::Window => "another window of Azel",
            HolderKind::Serve => "azel serve",
        };
        write!(f, "{kind} (process {process}, since {})", since.strftime("%F %H:%MZ"))
    }
}

/// A claim lasts as long as this or a clone of it lives: a session keeps one until it has
/// ended.
pub(super) type Claim = Arc<File>;

/// Why a claim failed.
pub(super) enum Unclaimed {
    /// Another Azel holds it.
    Held(HeldBy),
    /// The lock file cannot be opened, locked or written.
    Io(io::Error),
}

/// Folder of the claims, and the holder in whose name they are made.
#[derive(Debug)]
pub(super) struct Claims {
    folder: PathBuf,
    kind: HolderKind,
    /// Socket on which STOP is taken.
    socket: Option<PathBuf>,
    /// Claims held here, by the names of their files: two antennas on one line share a
    /// claim, and a new session of a unit has it before the old one has ended.
    held: Mutex<BTreeMap<String, Weak<File>>>,
}

impl Claims {
    /// Creates the folder; on Unix nobody else may look into it.
    pub(super) fn new(
        folder: PathBuf,
        kind: HolderKind,
        socket: Option<PathBuf>,
    ) -> io::Result<Self> {
        let mut builder = fs::DirBuilder::new();
        builder.recursive(true);
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
        builder.create(&folder)?;
        // A folder that was there may be open to others.
        #[cfg(unix)]
        fs::set_permissions(&folder, std::os::unix::fs::PermissionsExt::from_mode(0o700))?;
        Ok(Self { folder, kind, socket, held: Mutex::default() })
    }

    /// Claims the station file at `path`.
    pub(super) fn station(&self, path: &Path) -> Result<Claim, Unclaimed> {
        self.claim(station_lock(path), None)
    }

    /// Claims the unit of `antenna`.
    pub(super) fn unit(&self, antenna: &Antenna) -> Result<Claim, Unclaimed> {
        let connection = &antenna.connection;
        let address = connection.address.trim().to_lowercase();
        let unit = format!("{} {address}", connection.spec().key);
        self.claim(lock_name("unit", unit.as_bytes()), Some(antenna.name.clone()))
    }

    fn claim(&self, name: String, antenna: Option<String>) -> Result<Claim, Unclaimed> {
        // No code panics while it holds the lock.
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(claim) = held.get(&name).and_then(Weak::upgrade) {
            return Ok(claim);
        }
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(self.folder.join(&name)).map_err(Unclaimed::Io)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(Unclaimed::Held(held_by(&mut file))),
            Err(TryLockError::Error(error)) => return Err(Unclaimed::Io(error)),
        }
        let me = Holder {
            kind: self.kind,
            process: std::process::id(),
            since: Timestamp::now(),
            socket: self.socket.clone(),
            antenna,
        };
        let text = serde_json::to_string(&me).map_err(|error| Unclaimed::Io(error.into()))?;
        let written = file.set_len(0).and_then(|()| file.write_all(text.as_bytes()));
        written.map_err(Unclaimed::Io)?;
        let claim = Arc::new(file);
        held.insert(name, Arc::downgrade(&claim));
        Ok(claim)
    }
}

/// The other Azel that holds the station file at `path`, if any does.
pub(super) fn holder_of_station(folder: &Path, path: &Path) -> Option<HeldBy> {
    let mut file = File::open(folder.join(station_lock(path))).ok()?;
    match file.try_lock_shared() {
        Err(TryLockError::WouldBlock) => Some(held_by(&mut file)),
        Ok(()) | Err(TryLockError::Error(_)) => None,
    }
}

/// The holder that `file` tells of.
fn held_by(file: &mut File) -> HeldBy {
    let mut text = String::new();
    // The claim is held even if the holder's text cannot be read.
    let _ = file.read_to_string(&mut text);
    HeldBy::Azel(serde_json::from_str(&text).ok())
}

/// Socket of the holder of the station file at `path`. It has a name in a folder of its
/// own, because the path of a socket must be short.
#[cfg(unix)]
pub fn socket_path(folder: &Path, path: &Path) -> PathBuf {
    let path = whole_path(path);
    folder.join(format!("{}.sock", digest("station", path.to_string_lossy().as_bytes())))
}

/// Folder of this user's claims and sockets; `None` on a machine without a home.
pub fn claims_folder() -> Option<PathBuf> {
    let dirs = directories::ProjectDirs::from("", "", "azel")?;
    let own = dirs.runtime_dir().map(Path::to_path_buf);
    Some(own.unwrap_or_else(|| dirs.data_dir().join("run")))
}

/// The canonical path of a station file, even where the file does not exist yet.
pub(super) fn whole_path(path: &Path) -> PathBuf {
    let whole = path.canonicalize().or_else(|_| {
        // The file may not exist yet.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new(".")).canonicalize()?;
        Ok::<_, io::Error>(folder.join(path.file_name().unwrap_or_default()))
    });
    whole.unwrap_or_else(|_| path.to_owned())
}

fn station_lock(path: &Path) -> String {
    lock_name("station", whole_path(path).to_string_lossy().as_bytes())
}

fn lock_name(kind: &str, of: &[u8]) -> String {
    format!("{}.lock", digest(kind, of))
}

pub(super) fn digest(kind: &str, of: &[u8]) -> String {
    let mut name = format!("{kind}-");
    for byte in Sha256::digest(of).iter().take(8) {
        // Writing to a text cannot fail.
        let _ = write!(name, "{byte:02x}");
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claims(folder: &Path) -> Claims {
        Claims::new(folder.join("run"), HolderKind::Serve, None).unwrap()
    }

    #[test]
    fn what_is_held_is_held_by_one_who_says_who_it_is_until_it_ends() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (claims(folder.path()), claims(folder.path()));
        let path = folder.path().join("station.toml");
        let held = first.station(&path).ok().unwrap();
        let Err(Unclaimed::Held(HeldBy::Azel(Some(holder)))) = second.station(&path) else {
            panic!("free")
        };
        assert_eq!((holder.kind, holder.process), (HolderKind::Serve, std::process::id()));
        let run = folder.path().join("run");
        assert_eq!(holder_of_station(&run, &path), Some(HeldBy::Azel(Some(holder))));
        assert_eq!(holder_of_station(&run, &folder.path().join("other.toml")), None);
        // The holder may claim again, and holds it until the last clone is gone.
        let again = first.station(&path).ok().unwrap();
        drop(held);
        assert!(second.station(&path).is_err());
        drop(again);
        assert_eq!(holder_of_station(&run, &path), None);
        assert!(second.station(&path).is_ok());
    }

    #[test]
    fn a_unit_is_one_whatever_its_antenna_is_called() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (claims(folder.path()), claims(folder.path()));
        let dish = Antenna::satrak("Dish", "Unit.Local:4001");
        let other = Antenna::satrak("Other", "unit.local:4001 ");
        let held = first.unit(&dish).ok().unwrap();
        let Err(Unclaimed::Held(HeldBy::Azel(Some(holder)))) = second.unit(&other) else {
            panic!("free")
        };
        assert_eq!(holder.antenna.as_deref(), Some("Dish"));
        assert!(second.unit(&Antenna::satrak("Dish", "unit.local:4002")).is_ok());
        drop(held);
    }

    #[test]
    fn a_station_file_has_one_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        let spelled = folder.path().join(".").join("station.toml");
        assert_eq!(whole_path(&path), whole_path(&spelled), "before it is there");
        fs::write(&path, "").unwrap();
        assert_eq!(whole_path(&path), whole_path(&spelled));
    }
}
