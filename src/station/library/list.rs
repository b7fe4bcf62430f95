//! List of sources, in a small file beside the station's.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::{fetch, space_track::log_in_key};
use crate::{
    orbit::{BUNDLED_SOURCE, Source, SourcePlace},
    whole_file,
};

/// Version that this program writes. A file of a later version is left alone.
const VERSION: u32 = 1;

/// Reason why a source cannot be added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SourceProblem {
    #[error("type a name")]
    NoName,
    /// Another source has this name, which is also the name of its group.
    #[error("another source has this name: type another one")]
    NameTaken,
    /// A relative path, which would depend on the folder in which the program was started.
    #[error("type the whole path, from the root or the drive on")]
    RelativePath,
    /// Not an `https` address, or one with a user name in it.
    #[error("type an address that begins with https:// and holds no password")]
    Address,
    #[error("type the log-in name")]
    NoLogIn,
    /// Two sources would share one account and its limits.
    #[error("another source has this log-in: use that one")]
    LogInTaken,
}

/// Reason why the list of sources cannot be used or written. The file stays unchanged.
#[derive(Debug, thiserror::Error)]
pub enum SourcesError {
    #[error("the list of element sources cannot be used: {source}: {}", path.display())]
    Disk { source: io::Error, path: PathBuf },
    #[error("the list of element sources cannot be read: {source}: {}", path.display())]
    Syntax {
        /// Error with its place in the text.
        source: Box<toml::de::Error>,
        path: PathBuf,
    },
    /// A later program wrote the list.
    #[error("the list of element sources has version {found}, this program knows {VERSION}: {}", path.display())]
    Newer { found: u32, path: PathBuf },
    #[error("the list of element sources cannot be put into TOML: {0}")]
    Form(#[from] toml::ser::Error),
}

/// Checks that `source` can be added to `others`.
pub fn check_source(source: &Source, others: &[Source]) -> Result<(), SourceProblem> {
    let name = source.name.trim();
    if name.is_empty() {
        return Err(SourceProblem::NoName);
    }
    if name == BUNDLED_SOURCE || others.iter().any(|other| other.name == name) {
        return Err(SourceProblem::NameTaken);
    }
    match &source.place {
        SourcePlace::File(path) | SourcePlace::Folder(path) if path.is_relative() => {
            Err(SourceProblem::RelativePath)
        }
        SourcePlace::SpaceTrack(user) if user.trim().is_empty() => Err(SourceProblem::NoLogIn),
        SourcePlace::SpaceTrack(user) if others.iter().any(|other| has_log_in(other, user)) => {
            Err(SourceProblem::LogInTaken)
        }
        SourcePlace::Web(url) if fetch::check(url).is_err() => Err(SourceProblem::Address),
        _ => Ok(()),
    }
}

/// Returns `true` if `source` logs in as `user`.
pub fn has_log_in(source: &Source, user: &str) -> bool {
    match &source.place {
        SourcePlace::SpaceTrack(own) => log_in_key(own) == log_in_key(user),
        SourcePlace::Web(_) | SourcePlace::File(_) | SourcePlace::Folder(_) => false,
    }
}

#[derive(Serialize, Deserialize)]
struct File {
    #[serde(default = "this_version")]
    version: u32,
    #[serde(default)]
    source: Vec<Source>,
}

fn this_version() -> u32 {
    VERSION
}

/// Reads the sources at `path`; none if there is no file. Entries that [`check_source`]
/// refuses are kept: no server is ever asked at such an address, and the operator sees
/// them and may remove them.
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
    let file: File = table.try_into().map_err(syntax)?;
    Ok(file.source)
}

/// Replaces the list at `path`. The previous file is kept beside it with the ending
/// `.old`.
pub fn save_sources(sources: &[Source], path: &Path) -> Result<(), SourcesError> {
    let file = File { version: VERSION, source: sources.to_vec() };
    let text = toml::to_string_pretty(&file)?;
    whole_file::replace_and_keep_old(path, text.as_bytes())
        .map_err(|source| SourcesError::Disk { source, path: path.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn only_what_can_be_asked_and_told_apart_is_added() {
        let log_in = |user: &str| SourcePlace::SpaceTrack(user.to_owned());
        let known = [Source::celestrak("weather"), source("Space-Track", log_in("Op@Example.org"))];
        let web = |url: &str| SourcePlace::Web(url.to_owned());
        for (name, place, expected) in [
            ("own", SourcePlace::File("/a/b.tle".into()), Ok(())),
            ("noaa", web("https://celestrak.org/x"), Ok(())),
            (" ", web("https://celestrak.org/x"), Err(SourceProblem::NoName)),
            ("weather", SourcePlace::File("/a".into()), Err(SourceProblem::NameTaken)),
            (BUNDLED_SOURCE, SourcePlace::File("/a".into()), Err(SourceProblem::NameTaken)),
            ("own", SourcePlace::Folder("b".into()), Err(SourceProblem::RelativePath)),
            ("own", SourcePlace::File("".into()), Err(SourceProblem::RelativePath)),
            ("own", web("http://celestrak.org/x"), Err(SourceProblem::Address)),
            ("own", log_in("other@example.org"), Ok(())),
            ("own", log_in(" op@example.ORG "), Err(SourceProblem::LogInTaken)),
            ("own", log_in(" "), Err(SourceProblem::NoLogIn)),
            ("own", web("https://me:word@celestrak.org/x"), Err(SourceProblem::Address)),
        ] {
            assert_eq!(check_source(&source(name, place), &known), expected, "{name}");
        }
    }
}
