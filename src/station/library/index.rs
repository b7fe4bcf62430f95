//! Index of all requested addresses, in a small TOML file.

use std::{
    collections::BTreeMap,
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::lock::Lock;
use crate::{orbit::FetchProblem, whole_file};

/// Version that this program writes. Azel leaves a file of a later version unchanged.
const VERSION: u32 = 1;
/// Max length of the part of a file name taken from the source's name, characters.
const MAX_FILE_CHARS: usize = 40;

/// All addresses that Azel ever asked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Index {
    version: u32,
    /// Records by address: a source with a new address shares nothing with its old address.
    #[serde(default)]
    address: BTreeMap<String, AddressRecord>,
}

/// Record of one address.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct AddressRecord {
    /// File in the library with the last answer.
    pub(super) file: String,
    /// Time of the last request.
    pub(super) attempted_at: Timestamp,
    /// Time of the last query of elements, for servers that limit queries.
    #[serde(default)]
    pub(super) queried_at: Option<Timestamp>,
    /// Time at which the server last sent this content, or confirmed it as current.
    pub(super) confirmed_at: Option<Timestamp>,
    /// Entity tag of the content.
    pub(super) etag: Option<String>,
    /// Header `Last-Modified` of the content, unchanged.
    pub(super) last_modified: Option<String>,
    /// Number of failed requests in a row.
    #[serde(default)]
    pub(super) failures: u32,
    /// Reason why the last request failed.
    pub(super) problem: Option<FetchProblem>,
}

/// Reason why the index of a library cannot be used. The file stays unchanged.
#[derive(Debug, thiserror::Error)]
pub enum IndexError {
    #[error("the index of the elements cannot be used: {source}: {}", path.display())]
    Disk { source: io::Error, path: PathBuf },
    /// Neither the index nor the previous one is valid TOML.
    #[error("the index of the elements cannot be read: {source}: {}", path.display())]
    Syntax {
        /// Syntax error with its place in the text.
        source: Box<toml::de::Error>,
        path: PathBuf,
    },
    #[error("the index of the elements cannot be put into TOML: {0}")]
    Form(#[from] toml::ser::Error),
    /// A later program wrote the index.
    #[error("the index of the elements has version {found}, this program knows {VERSION}: {}", path.display())]
    Newer { found: u32, path: PathBuf },
}

impl AddressRecord {
    /// Returns the time of the last attempt, if it reached a server.
    pub(super) fn asked_at(&self) -> Option<Timestamp> {
        let is_unasked = self.problem.as_ref().is_some_and(FetchProblem::is_before_request);
        (!is_unasked).then_some(self.attempted_at)
    }
}

impl Default for Index {
    fn default() -> Self {
        Self { version: VERSION, address: BTreeMap::new() }
    }
}

impl Index {
    /// Reads the index in `folder`, or the previous one if the index is damaged.
    pub(super) fn load(folder: &Path) -> Result<Self, IndexError> {
        let path = folder.join("index.toml");
        match Self::read(&path) {
            Err(damaged @ IndexError::Syntax { .. }) => {
                Self::read(&whole_file::old(&path)).map_err(|_| damaged)
            }
            Err(IndexError::Disk { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
                Ok(Self::default())
            }
            other => other,
        }
    }

    fn read(path: &Path) -> Result<Self, IndexError> {
        let text = fs::read_to_string(path)
            .map_err(|source| IndexError::Disk { source, path: path.to_owned() })?;
        let index: Self = toml::from_str(&text).map_err(|source| IndexError::Syntax {
            source: source.into(),
            path: path.to_owned(),
        })?;
        if index.version > VERSION {
            return Err(IndexError::Newer { found: index.version, path: path.to_owned() });
        }
        Ok(index)
    }

    pub(super) fn save(&self, folder: &Path) -> Result<(), IndexError> {
        let path = folder.join("index.toml");
        let text = toml::to_string_pretty(self)?;
        whole_file::replace_and_keep_old(&path, text.as_bytes())
            .map_err(|source| IndexError::Disk { source, path })
    }

    /// Writes the record of `url` into the index in `folder`. Adopts the other records from the
    /// file, because another process may have changed them.
    pub(super) fn save_record(&mut self, url: &str, folder: &Path) -> Result<(), IndexError> {
        let lock = Lock::wait(folder, "index.lock");
        let mut index = Self::load(folder)?;
        if let Some(record) = self.get(url) {
            index.address.insert(url.to_owned(), record.clone());
        }
        index.save(folder)?;
        drop(lock);
        *self = index;
        Ok(())
    }

    pub(super) fn get(&self, url: &str) -> Option<&AddressRecord> {
        self.address.get(url)
    }

    /// Returns the record of `url`. If there is none, adds one for a request at `now` for the
    /// source `name`.
    pub(super) fn entry(&mut self, url: &str, name: &str, now: Timestamp) -> &mut AddressRecord {
        let file = self.unused_file(name);
        self.address.entry(url.to_owned()).or_insert(AddressRecord {
            file,
            attempted_at: now,
            queried_at: None,
            confirmed_at: None,
            etag: None,
            last_modified: None,
            failures: 0,
            problem: None,
        })
    }

    /// Returns a file name like `name` that no address uses yet.
    fn unused_file(&self, name: &str) -> String {
        let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '-' };
        let stem: String = name.to_lowercase().chars().map(plain).take(MAX_FILE_CHARS).collect();
        let is_used = |file: &str| self.address.values().any(|record| record.file == file);
        let mut file = format!("{stem}.elements");
        let mut count = 2;
        while is_used(&file) {
            file = format!("{stem}-{count}.elements");
            count += 1;
        }
        file
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn now() -> Timestamp {
        "2026-08-12T12:00:00Z".parse().unwrap()
    }

    #[test]
    fn an_index_comes_back_as_it_was_saved() {
        let folder = tempfile::tempdir().unwrap();
        let mut index = Index::load(folder.path()).unwrap();
        assert_eq!(index, Index::default());
        index.entry("https://a.example/x?y=z", "Weather, Şile", now()).problem =
            Some(FetchProblem::Unreachable("timeout".to_owned()));
        index.entry("https://b.example", "weather- -ile", now()).etag = Some("\"7\"".to_owned());
        index.entry("https://c.example", "../../..", now()).confirmed_at = Some(now());
        index.save(folder.path()).unwrap();
        assert_eq!(Index::load(folder.path()).unwrap(), index);
        let files: Vec<_> = index.address.values().map(|record| record.file.as_str()).collect();
        assert_eq!(
            files,
            ["weather---ile.elements", "weather---ile-2.elements", "--------.elements"]
        );
    }

    #[test]
    fn a_damaged_index_gives_way_to_the_one_before_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("index.toml");
        let mut index = Index::default();
        index.entry("https://a.example", "a", now());
        index.save(folder.path()).unwrap();
        index.save(folder.path()).unwrap();
        fs::write(&path, "version = ").unwrap();
        assert_eq!(Index::load(folder.path()).unwrap(), index);
        fs::write(whole_file::old(&path), "version = ").unwrap();
        assert!(matches!(Index::load(folder.path()), Err(IndexError::Syntax { .. })));
        fs::write(&path, "version = 9").unwrap();
        assert!(matches!(Index::load(folder.path()), Err(IndexError::Newer { found: 9, .. })));
    }
}
