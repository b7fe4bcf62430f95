//! The station file on disk, which Azel always reads and replaces as a whole.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::Serialize;

use super::{
    ControllerSpec, Note, Station,
    read::{Read, read},
    rewrite::{UnreadTree, rewritten, rewritten_with},
};
use crate::whole_file;

/// Version of the file that Azel writes. Azel does not change a file of a later version.
const VERSION: i64 = 1;

/// Default name of a station file.
const FILE: &str = "station.toml";

/// The content of a station file.
#[derive(Debug)]
pub struct Loaded {
    pub station: Station,
    /// Entries that Azel did not use as written in the file.
    pub notes: Vec<Note>,
}

/// Entries that are still unreadable in a saved station file.
#[derive(Debug, Default)]
pub struct Saved {
    pub notes: Vec<Note>,
    /// Unreadable settings on which safety depends.
    pub unread: Vec<super::Unread>,
}

/// Reason why Azel has not read the station file. The file stays unchanged on disk.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    #[error("there are no settings yet")]
    Missing,
    /// An error of the operating system.
    #[error("the settings cannot be read: {source}: {}", path.display())]
    Read { source: io::Error, path: PathBuf },
    /// An encoding such as UTF-16, which some editors write.
    #[error("the settings are not UTF-8 text; save the file as UTF-8: {}", path.display())]
    Encoding { path: PathBuf },
    #[error("the settings are not valid TOML: {source}: {}", path.display())]
    Syntax {
        /// Error with its place in the text.
        source: Box<toml::de::Error>,
        path: PathBuf,
    },
    /// A file from a newer Azel.
    #[error("the settings have version {found}, this program knows {VERSION}: {}", path.display())]
    Newer {
        /// Version of the file.
        found: i64,
        path: PathBuf,
    },
}

/// Reason why Azel has not written the station file. The previous file stays.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    #[error("the settings cannot be put into TOML: {0}")]
    Form(#[from] toml::ser::Error),
    /// An error of the operating system.
    #[error("the settings were not saved, the old ones stay: {source}: {}", path.display())]
    Write { source: io::Error, path: PathBuf },
    /// An unreadable entry that the save would delete.
    #[error(
        "the settings were not saved: that would delete {place}, which could not be read. The old \
         file is unchanged. Repair the entry, then save again: {}",
        path.display()
    )]
    WouldDrop { place: String, path: PathBuf },
    /// An existing file that is not TOML.
    #[error(
        "the settings were not saved: the station file cannot be read, and saving would replace it. \
         Mend it or move it away, then save again: {}",
        .0.display()
    )]
    Unreadable(PathBuf),
}

/// Returns the path of this user's station file; `None` on a machine without a home folder.
pub fn settings_path() -> Option<PathBuf> {
    directories::ProjectDirs::from("", "", "azel").map(|dirs| dirs.config_dir().join(FILE))
}

/// Returns a free path in `folder` for another station file.
pub fn free_path(folder: &Path) -> PathBuf {
    let default_path = folder.join(FILE);
    let mut numbered = (2..).map(|number| folder.join(format!("station-{number}.toml")));
    let is_free = |path: &PathBuf| !path.exists();
    if is_free(&default_path) {
        default_path
    } else {
        numbered.find(is_free).unwrap_or(default_path)
    }
}

/// Reads the station at `path`, with controllers of the makes in `specs`.
pub fn load(path: &Path, specs: &[&'static ControllerSpec]) -> Result<Loaded, LoadError> {
    let text = fs::read_to_string(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => LoadError::Missing,
        io::ErrorKind::InvalidData => LoadError::Encoding { path: path.to_owned() },
        _ => LoadError::Read { source, path: path.to_owned() },
    })?;
    let table: toml::Table = toml::from_str(&text)
        .map_err(|source| LoadError::Syntax { source: source.into(), path: path.to_owned() })?;
    let version = table.get("version").and_then(toml::Value::as_integer).unwrap_or(VERSION);
    if version > VERSION {
        return Err(LoadError::Newer { found: version, path: path.to_owned() });
    }
    let Read { station, mut notes, .. } = read(table, specs);
    for note in &mut notes {
        note.line = line_of(&text, &note.place);
    }
    Ok(Loaded { station, notes })
}

/// Returns the line of the entry at `place` in `text`, from 1.
fn line_of(text: &str, place: &str) -> Option<usize> {
    let document = toml_edit::Document::parse(text).ok()?;
    let mut item = document.as_item();
    let mut span = None;
    for part in place.split('.') {
        let (key, index) = match part.split_once('[') {
            Some((key, rest)) => (key, rest.trim_end_matches(']').parse::<usize>().ok()),
            None => (part, None),
        };
        let table = item.as_table_like();
        let named = table.and_then(|table| table.get_key_value(key));
        let Some((name, inner)) = named else { break };
        span = name.span().or_else(|| inner.span()).or(span);
        item = inner;
        if let Some(index) = index {
            let Some(entry) = item.get(index) else { break };
            span = entry.span().or(span);
            item = entry;
        }
    }
    let before = text.get(..span?.start)?;
    Some(before.matches('\n').count() + 1)
}

/// Returns the time at which the file at `path` was last written.
pub fn saved_at(path: &Path) -> Option<Timestamp> {
    let modified = fs::metadata(path).and_then(|metadata| metadata.modified()).ok()?;
    Timestamp::try_from(modified).ok()
}

/// Writes the station to `path`, into the existing text: the operator's comments and all unreadable
/// entries stay. A failure at any moment leaves the previous file whole. Azel keeps a copy of the
/// previous file with the added ending `.old`.
pub fn save(
    station: &Station,
    path: &Path,
    specs: &[&'static ControllerSpec],
) -> Result<Saved, SaveError> {
    let text = written(station)?;
    let text = match fs::read_to_string(path) {
        Ok(old) => merged(&old, &text, path, specs)?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => text,
        Err(source) => return Err(SaveError::Write { source, path: path.to_owned() }),
    };
    whole_file::replace_and_keep_old(path, text.as_bytes())
        .map_err(|source| SaveError::Write { source, path: path.to_owned() })?;
    let Some(Read { station: read, mut notes, .. }) = read_text(&text, specs) else {
        return Ok(Saved::default());
    };
    for note in &mut notes {
        note.line = line_of(&text, &note.place);
    }
    Ok(Saved { notes, unread: read.unread })
}

fn written(station: &Station) -> Result<String, SaveError> {
    #[derive(Serialize)]
    struct Versioned<'a> {
        version: i64,
        #[serde(flatten)]
        station: &'a Station,
    }
    Ok(toml::to_string_pretty(&Versioned { version: VERSION, station })?)
}

fn read_text(text: &str, specs: &[&'static ControllerSpec]) -> Option<Read> {
    toml::from_str(text).ok().map(|table| read(table, specs))
}

/// Returns the text `new` of a station, merged into the text `old` of the file at `path`.
fn merged(
    old: &str,
    new: &str,
    path: &Path,
    specs: &[&'static ControllerSpec],
) -> Result<String, SaveError> {
    let Some(Read { station, notes, left_out }) = read_text(old, specs) else {
        return Err(SaveError::Unreadable(path.to_owned()));
    };
    let places = notes.iter().map(|note| note.place.as_str());
    let unread = UnreadTree::find(places, left_out.iter().map(String::as_str));
    if unread.is_empty() {
        return Ok(rewritten(old, new));
    }
    let means_the_same = |text: &str| {
        let found = read_text(text, specs);
        found.is_some_and(|found| {
            found.left_out.len() == left_out.len()
                && written(&found.station).is_ok_and(|text| same_settings(&text, new))
        })
    };
    rewritten_with(old, &written(&station)?, new, &unread, means_the_same).ok_or_else(|| {
        let place = notes.first().map(|note| note.place.clone()).unwrap_or_default();
        SaveError::WouldDrop { place, path: path.to_owned() }
    })
}

fn same_settings(one: &str, other: &str) -> bool {
    let [one, other] = [one, other].map(|text| toml::from_str::<toml::Table>(text).ok());
    one.is_some() && one == other
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
