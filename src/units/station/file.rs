//! The station file on disk, always read and replaced as a whole.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::Serialize;

use super::{ControllerSpec, Note, Station, from_toml, rewrite::rewritten};
use crate::whole_file;

/// Version that this program writes. A file of a later one is left alone.
const VERSION: i64 = 1;

/// Usual name of a station file.
const FILE: &str = "station.toml";

/// A station file that was read.
#[derive(Debug)]
pub struct Loaded {
    pub station: Station,
    /// Entries that were not taken over as they stand in the file.
    pub notes: Vec<Note>,
}

/// Why the station file was not read. It stays as it is on disk.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    #[error("there are no settings yet")]
    Missing,
    /// The operating system refused.
    #[error("the settings cannot be read: {source}: {}", path.display())]
    Read { source: io::Error, path: PathBuf },
    #[error("the settings are not valid TOML: {source}: {}", path.display())]
    Syntax {
        /// Error with its place in the text.
        source: Box<toml::de::Error>,
        path: PathBuf,
    },
    /// A newer program wrote the file.
    #[error("the settings have version {found}, this program knows {VERSION}: {}", path.display())]
    Newer {
        /// Version of the file.
        found: i64,
        path: PathBuf,
    },
}

/// Why the station file was not written. The old one is still there.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    #[error("the settings cannot be put into TOML: {0}")]
    Form(#[from] toml::ser::Error),
    /// The operating system refused.
    #[error("the settings were not saved, the old ones stay: {source}: {}", path.display())]
    Write { source: io::Error, path: PathBuf },
}

/// Path of this user's station file; `None` on a machine without a home.
pub fn settings_path() -> Option<PathBuf> {
    directories::ProjectDirs::from("", "", "azel").map(|dirs| dirs.config_dir().join(FILE))
}

/// Path in `folder` for one more station file; there is no file yet.
pub fn free_path(folder: &Path) -> PathBuf {
    let usual = folder.join(FILE);
    let mut numbered = (2..).map(|number| folder.join(format!("station-{number}.toml")));
    let is_free = |path: &PathBuf| !path.exists();
    if is_free(&usual) { usual } else { numbered.find(is_free).unwrap_or(usual) }
}

/// Reads the station at `path`, with controllers of the makes in `specs`.
pub fn load(path: &Path, specs: &[&'static ControllerSpec]) -> Result<Loaded, LoadError> {
    let text = fs::read_to_string(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => LoadError::Missing,
        _ => LoadError::Read { source, path: path.to_owned() },
    })?;
    let table: toml::Table = toml::from_str(&text)
        .map_err(|source| LoadError::Syntax { source: source.into(), path: path.to_owned() })?;
    let version = table.get("version").and_then(toml::Value::as_integer).unwrap_or(VERSION);
    if version > VERSION {
        return Err(LoadError::Newer { found: version, path: path.to_owned() });
    }
    let (station, notes) = from_toml(table, specs);
    Ok(Loaded { station, notes })
}

/// When the file at `path` was written last.
pub fn saved_at(path: &Path) -> Option<Timestamp> {
    let modified = fs::metadata(path).and_then(|metadata| metadata.modified()).ok()?;
    Timestamp::try_from(modified).ok()
}

/// Writes the station to `path`, into the text that stands there: the operator's comments
/// stay. A failure at any moment leaves the old file whole. The previous file is kept beside
/// it with the ending `.old`, because reading forgives more than it can carry over.
pub fn save(station: &Station, path: &Path) -> Result<(), SaveError> {
    #[derive(Serialize)]
    struct Versioned<'a> {
        version: i64,
        #[serde(flatten)]
        station: &'a Station,
    }
    let text = toml::to_string_pretty(&Versioned { version: VERSION, station })?;
    let text = match fs::read_to_string(path) {
        Ok(old) => rewritten(&old, &text),
        Err(_) => text,
    };
    whole_file::replace_and_keep_old(path, text.as_bytes())
        .map_err(|source| SaveError::Write { source, path: path.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_more_station_takes_no_name_that_is_in_use() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["station.toml", "station-2.toml", "station-3.toml"] {
            let free = free_path(folder.path());
            assert_eq!(free, folder.path().join(name));
            fs::write(&free, "").unwrap();
        }
    }
}
