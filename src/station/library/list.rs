//! List of sources, in a small file beside the station's.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use crate::{orbit::Source, whole_file};

/// Version that this program writes. Azel leaves a file of a later version unchanged.
const VERSION: u32 = 1;

/// Reason why the list of sources cannot be used or written. The file stays unchanged.
#[derive(Debug, thiserror::Error)]
pub enum SourcesError {
    #[error("the list of element sources cannot be used: {source}: {}", path.display())]
    Disk { source: io::Error, path: PathBuf },
    #[error("the list of element sources cannot be read: {source}: {}", path.display())]
    Syntax {
        /// Syntax error with its place in the text.
        source: Box<toml::de::Error>,
        path: PathBuf,
    },
    /// A later program wrote the list.
    #[error("the list of element sources has version {found}, this program knows {VERSION}: {}", path.display())]
    Newer { found: u32, path: PathBuf },
    #[error("the list of element sources cannot be put into TOML: {0}")]
    Form(#[from] toml::ser::Error),
}

#[derive(Serialize, Deserialize)]
struct ListFile {
    #[serde(default = "this_version")]
    version: u32,
    #[serde(default)]
    source: Vec<Source>,
}

fn this_version() -> u32 {
    VERSION
}

/// Reads the sources at `path`; none if there is no file. Keeps entries that `check_source`
/// refuses: Azel asks no server at such an address, and the operator can remove the entry.
pub fn load_sources(path: &Path) -> Result<Vec<Source>, SourcesError> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(source) => return Err(SourcesError::Disk { source, path: path.to_owned() }),
    };
    let syntax = |source: toml::de::Error| SourcesError::Syntax {
        source: source.into(),
        path: path.to_owned(),
    };
    let table: toml::Table = toml::from_str(&text).map_err(syntax)?;
    let version = table.get("version").and_then(toml::Value::as_integer);
    let found = version.and_then(|version| u32::try_from(version).ok()).unwrap_or(VERSION);
    if found > VERSION {
        return Err(SourcesError::Newer { found, path: path.to_owned() });
    }
    let file: ListFile = table.try_into().map_err(syntax)?;
    Ok(file.source)
}

/// Replaces the list at `path`, and keeps the previous file beside it with the ending `.old`.
pub fn save_sources(sources: &[Source], path: &Path) -> Result<(), SourcesError> {
    let file = ListFile { version: VERSION, source: sources.to_vec() };
    let text = toml::to_string_pretty(&file)?;
    whole_file::replace_and_keep_old(path, text.as_bytes())
        .map_err(|source| SourcesError::Disk { source, path: path.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::SourcePlace;

    fn source(name: &str, place: SourcePlace) -> Source {
        Source { name: name.to_owned(), place, refresh: None }
    }

    #[test]
    fn sources_come_back_as_they_were_saved() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/sources.toml");
        assert_eq!(load_sources(&path).unwrap(), []);
        let sources = [
            Source::celestrak("weather"),
            source("Şile \"own\"", SourcePlace::File("/var/elements/own.tle".into())),
            source("All", SourcePlace::Folder("/var/elements".into())),
        ];
        save_sources(&sources, &path).unwrap();
        assert_eq!(load_sources(&path).unwrap(), sources);
        save_sources(&[], &path).unwrap();
        assert_eq!(load_sources(&path).unwrap(), []);
        assert_eq!(load_sources(&whole_file::old(&path)).unwrap(), sources);
    }

    #[test]
    fn a_list_that_cannot_be_read_is_left_alone_and_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sources.toml");
        for (text, newer) in [
            ("source = ", false),
            ("[[source]]\nname = 'x'", false),
            ("version = 9\n[[source]]\nlater = 1", true),
        ] {
            fs::write(&path, text).unwrap();
            let error = load_sources(&path).unwrap_err();
            assert_eq!(matches!(error, SourcesError::Newer { found: 9, .. }), newer, "{error}");
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert!(matches!(load_sources(folder.path()), Err(SourcesError::Disk { .. })));
    }
}
