//! Sources of elements.

use std::{net::IpAddr, path::PathBuf};

use http::Uri;
use serde::{Deserialize, Serialize};

use crate::orbit::{BUNDLED_SOURCE, FetchProblem, Source, SourcePlace, SourceReport};

/// Host of the Space-Track server.
pub const SPACE_TRACK_HOST: &str = "www.space-track.org";

/// Returns the normal form of a log-in name, for comparisons and as a key. Two spellings of one
/// name share an account and its limits.
pub fn log_in_key(user: &str) -> String {
    user.trim().to_lowercase()
}

/// Reason why a source cannot be added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SourceProblem {
    #[error("type a name")]
    NoName,
    /// Another source or its group already has this name.
    #[error("another source has this name: type another one")]
    NameTaken,
    /// The path is relative, and would depend on the folder in which the program was started.
    #[error("type the whole path, from the root or the drive on")]
    RelativePath,
    /// The address is not `https`, or contains a user name.
    #[error("type an address that begins with https:// and holds no password")]
    Address,
    #[error("type the log-in name")]
    NoLogIn,
    /// The log-in is in use: two sources would share one account and its limits.
    #[error("another source has this log-in: use that one")]
    LogInTaken,
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
        SourcePlace::Web(url) if check_address(url).is_err() => Err(SourceProblem::Address),
        _ => Ok(()),
    }
}

/// Returns `true` if `source` logs in as `user`, in any spelling.
pub fn has_log_in(source: &Source, user: &str) -> bool {
    match &source.place {
        SourcePlace::SpaceTrack(own) => log_in_key(own) == log_in_key(user),
        SourcePlace::Web(_) | SourcePlace::File(_) | SourcePlace::Folder(_) => false,
    }
}

/// Checks that `url` is allowed, and returns whether its host is this computer. Plain `http` is
/// allowed only for this computer. A password is never allowed, because addresses are stored on
/// disk and shown.
pub fn check_address(url: &str) -> Result<bool, FetchProblem> {
    let uri: Uri = url.parse().map_err(|_| FetchProblem::Address)?;
    let host = uri.host().ok_or(FetchProblem::Address)?;
    let address: Option<IpAddr> = host.trim_matches(['[', ']']).parse().ok();
    let is_local = host == "localhost" || address.is_some_and(|address| address.is_loopback());
    let is_plain = uri.authority().is_some_and(|authority| !authority.as_str().contains('@'));
    let is_safe =
        uri.scheme_str() == Some("https") || (uri.scheme_str() == Some("http") && is_local);
    if is_plain && is_safe { Ok(is_local) } else { Err(FetchProblem::Address) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(name: &str, place: SourcePlace) -> Source {
        Source { name: name.to_owned(), place, refresh: None }
    }

    #[test]
    fn only_what_can_be_asked_and_told_apart_is_added() {
        let log_in = |user: &str| SourcePlace::SpaceTrack(user.to_owned());
        let sources =
            [Source::celestrak("weather"), source("Space-Track", log_in("Op@Example.org"))];
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
            assert_eq!(check_source(&source(name, place), &sources), expected, "{name}");
        }
    }

    #[test]
    fn only_safe_addresses_are_asked() {
        for (url, expected) in [
            ("https://celestrak.org/NORAD/elements/gp.php?GROUP=active&FORMAT=json", Ok(false)),
            ("http://127.0.0.1:80/x", Ok(true)),
            ("http://[::1]/x", Ok(true)),
            ("https://localhost/x", Ok(true)),
            ("http://celestrak.org/x", Err(FetchProblem::Address)),
            ("https://user:word@celestrak.org/x", Err(FetchProblem::Address)),
            ("ftp://127.0.0.1/x", Err(FetchProblem::Address)),
            ("file:///etc/passwd", Err(FetchProblem::Address)),
            ("celestrak.org", Err(FetchProblem::Address)),
            ("", Err(FetchProblem::Address)),
        ] {
            assert_eq!(check_address(url), expected, "{url}");
        }
    }
}

/// Sources at the last reading.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Sources {
    /// All sources, in the operator's order.
    pub list: Vec<Source>,
    /// One report for each source, in the same order; empty while the library is unusable.
    pub reports: Vec<SourceReport>,
    pub work: SourceWork,
    /// Problems of the list or the library as a whole, in order of occurrence.
    pub problems: Vec<String>,
    /// The list is unreadable: Azel leaves it unchanged and accepts no change.
    pub is_locked: bool,
}

/// Work under way on the sources.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum SourceWork {
    #[default]
    Nothing,
    Reading,
    Asking,
}

/// Elements for a copy into the library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Copied {
    File(PathBuf),
    Text(String),
}

impl Sources {
    /// Returns `true` if Azel would accept a change now.
    pub fn is_free(&self) -> bool {
        self.work == SourceWork::Nothing && !self.is_locked
    }
}
