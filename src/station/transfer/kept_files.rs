//! Recent files of all units on this computer, so that Azel can restore each of them.
//!
//! Content files are named by their hash; a small TOML file lists units, files and times.

use std::{
    collections::BTreeSet,
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    contract::transfer::{FileHash, KeptFile, Origin, TleFile},
    whole_file,
};

/// Version that this program writes. Azel leaves a list of a later version unchanged.
const VERSION: u32 = 1;
/// Max number of stored versions per file and unit.
const MAX: usize = 20;

/// List on the disk.
#[derive(Debug, Serialize, Deserialize)]
struct KeptFileList {
    version: u32,
    /// Kept files, oldest first.
    #[serde(rename = "kept", default)]
    kept_files: Vec<KeptFile>,
}

/// Reason why a file was not kept, or cannot be restored.
#[derive(Debug, thiserror::Error)]
pub enum KeptError {
    #[error("{source}; make room or fix the permissions on this computer: {}", path.display())]
    Disk { source: io::Error, path: PathBuf },
    /// The list is not valid TOML.
    #[error("the list of kept files cannot be read: {source}; move it away: {}", path.display())]
    Syntax {
        /// Syntax error with its place in the text.
        source: Box<toml::de::Error>,
        path: PathBuf,
    },
    #[error("the list of kept files cannot be put into TOML: {0}")]
    Form(#[from] toml::ser::Error),
    /// A later program wrote the list.
    #[error("the list of kept files has version {found}, this program knows {VERSION}; use the newer program: {}", path.display())]
    Newer { found: u32, path: PathBuf },
    /// The content does not match its hash.
    #[error("the kept file was changed on disk; choose another one: {}", path.display())]
    Changed { path: PathBuf },
}

/// Kept files of all units.
#[derive(Debug, Clone)]
pub struct KeptFiles {
    folder: PathBuf,
}

impl KeptFiles {
    /// Uses `folder`, which may not exist yet.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// Returns the files of this user; `None` on a machine without a home folder.
    pub fn of_this_user() -> Option<Self> {
        directories::ProjectDirs::from("", "", "azel")
            .map(|dirs| Self::new(dirs.data_dir().join("uploads")))
    }

    /// Returns the kept versions of `file` on `unit`, newest first.
    pub fn list(&self, unit: &str, file: &str) -> Result<Vec<KeptFile>, KeptError> {
        let mut kept_files = self.load()?.kept_files;
        kept_files.retain(|one| one.unit == unit && one.file == file);
        kept_files.reverse();
        Ok(kept_files)
    }

    /// Reads and checks the content of `kept_file`, for a roll-back on the unit.
    pub fn read(&self, kept_file: &KeptFile) -> Result<TleFile, KeptError> {
        let path = self.content(kept_file.sha256);
        let bytes = fs::read(&path).map_err(disk_error(&path))?;
        if FileHash::new(&bytes) != kept_file.sha256 {
            return Err(KeptError::Changed { path });
        }
        Ok(TleFile::from_bytes(bytes))
    }

    /// Keeps a file of a unit. Skips a file found on the unit whose content equals the newest
    /// version.
    pub(super) fn keep(
        &self,
        unit: &str,
        file: &str,
        bytes: &[u8],
        time: Timestamp,
        origin: Origin,
    ) -> Result<(), KeptError> {
        let mut list = self.load()?;
        let is_of_file = |one: &KeptFile| one.unit == unit && one.file == file;
        let sha256 = FileHash::new(bytes);
        let newest = list.kept_files.iter().rfind(|one| is_of_file(one));
        let is_held = newest.is_some_and(|newest| newest.sha256 == sha256);
        let path = self.content(sha256);
        if is_held && origin == Origin::Found && path.is_file() {
            return Ok(());
        }
        whole_file::replace(&path, bytes).map_err(disk_error(&path))?;
        list.kept_files.push(KeptFile {
            unit: unit.to_owned(),
            file: file.to_owned(),
            sha256,
            bytes: bytes.len() as u64,
            time,
            origin,
        });
        let too_many =
            list.kept_files.iter().filter(|one| is_of_file(one)).count().saturating_sub(MAX);
        let mut dropped = Vec::new();
        list.kept_files.retain(|one| {
            let is_old = is_of_file(one) && dropped.len() < too_many;
            if is_old {
                dropped.push(one.sha256);
            }
            !is_old
        });
        self.save(&list)?;
        self.clear(&dropped, &list);
        Ok(())
    }

    /// Removes content files that the list no longer names.
    fn clear(&self, dropped: &[FileHash], list: &KeptFileList) {
        let needed: BTreeSet<_> =
            list.kept_files.iter().map(|one| one.sha256.to_string()).collect();
        for hash in dropped.iter().filter(|hash| !needed.contains(&hash.to_string())) {
            let path = self.content(*hash);
            if let Err(error) = fs::remove_file(&path) {
                tracing::warn!(%error, path = %path.display(), "an old upload was not removed");
            }
        }
    }

    fn content(&self, hash: FileHash) -> PathBuf {
        self.folder.join(format!("{hash}.tle"))
    }

    fn index(&self) -> PathBuf {
        self.folder.join("index.toml")
    }

    fn load(&self) -> Result<KeptFileList, KeptError> {
        let path = self.index();
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Ok(KeptFileList { version: VERSION, kept_files: Vec::new() });
            }
            other => other.map_err(disk_error(&path))?,
        };
        let list: KeptFileList = toml::from_str(&text)
            .map_err(|source| KeptError::Syntax { source: source.into(), path: path.clone() })?;
        if list.version > VERSION {
            return Err(KeptError::Newer { found: list.version, path });
        }
        Ok(list)
    }

    fn save(&self, list: &KeptFileList) -> Result<(), KeptError> {
        let path = self.index();
        let text = toml::to_string_pretty(list)?;
        whole_file::replace_and_keep_old(&path, text.as_bytes()).map_err(disk_error(&path))
    }
}

fn disk_error(path: &Path) -> impl FnOnce(io::Error) -> KeptError {
    let path = path.to_owned();
    move |source| KeptError::Disk { source, path }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: &str = "unit:22";

    fn time(minute: usize) -> Timestamp {
        format!("2026-08-12T12:{minute:02}:00Z").parse().unwrap()
    }

    fn files() -> (tempfile::TempDir, KeptFiles) {
        let folder = tempfile::tempdir().unwrap();
        let kept_files = KeptFiles::new(folder.path().join("uploads"));
        (folder, kept_files)
    }

    #[test]
    fn files_come_back_newest_first_and_by_unit_and_name() {
        let (_folder, kept_files) = files();
        assert_eq!(kept_files.list(UNIT, "a.txt").unwrap(), []);
        for (minute, (unit, file, bytes, origin)) in [
            (UNIT, "a.txt", "one", Origin::Found),
            (UNIT, "a.txt", "two", Origin::Uploaded),
            (UNIT, "a.txt", "two", Origin::Found),
            (UNIT, "b.txt", "three", Origin::Uploaded),
            ("other:22", "a.txt", "four", Origin::Uploaded),
        ]
        .into_iter()
        .enumerate()
        {
            kept_files.keep(unit, file, bytes.as_bytes(), time(minute), origin).unwrap();
        }
        let list = kept_files.list(UNIT, "a.txt").unwrap();
        let shown: Vec<_> = list.iter().map(|one| (one.origin, one.time, one.bytes)).collect();
        assert_eq!(shown, [(Origin::Uploaded, time(1), 3), (Origin::Found, time(0), 3)]);
        assert_eq!(kept_files.read(&list[1]).unwrap().bytes(), b"one");
        assert_eq!(kept_files.list("other:22", "a.txt").unwrap().len(), 1);
    }

    #[test]
    fn the_oldest_give_way() {
        let (_folder, kept_files) = files();
        kept_files.keep("other:22", "a.txt", b"0", time(0), Origin::Uploaded).unwrap();
        for minute in 0..MAX + 3 {
            let bytes = minute.to_string();
            kept_files
                .keep(UNIT, "a.txt", bytes.as_bytes(), time(minute), Origin::Uploaded)
                .unwrap();
        }
        let list = kept_files.list(UNIT, "a.txt").unwrap();
        assert_eq!((list.len(), list[MAX - 1].time), (MAX, time(3)));
        let exists = |bytes: &str| kept_files.content(FileHash::new(bytes.as_bytes())).is_file();
        assert!(!exists("1") && !exists("2") && exists("3"));
        assert!(exists("0"), "another unit still names it");
    }

    #[test]
    fn what_was_changed_on_disk_is_not_put_back() {
        let (_folder, kept_files) = files();
        kept_files.keep(UNIT, "a.txt", b"one", time(0), Origin::Uploaded).unwrap();
        let one = kept_files.list(UNIT, "a.txt").unwrap().remove(0);
        fs::write(kept_files.content(one.sha256), "onf").unwrap();
        assert!(matches!(kept_files.read(&one), Err(KeptError::Changed { .. })));
        fs::write(kept_files.index(), "version = 2").unwrap();
        assert!(matches!(kept_files.list(UNIT, "a.txt"), Err(KeptError::Newer { found: 2, .. })));
        fs::write(kept_files.index(), "version").unwrap();
        let refused = kept_files.keep(UNIT, "a.txt", b"two", time(1), Origin::Found);
        assert!(matches!(refused, Err(KeptError::Syntax { .. })));
    }
}
