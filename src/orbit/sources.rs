//! Sources of elements, the state of each, and how often a server may be asked.

use std::path::PathBuf;

use jiff::{SignedDuration, Timestamp};
use serde::{Deserialize, Serialize};

use super::{MergeSummary, Nothing};
use crate::astro::time;

/// A server is asked for one source at most once in this time, unless the
/// operator wants it. `CelesTrak` makes its elements anew every two hours and
/// shuts out who asks for them more often.
pub const FETCH_PAUSE: SignedDuration = SignedDuration::from_hours(2);

/// A source of elements; also the group of its objects.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    pub name: String,
    #[serde(flatten)]
    pub place: SourcePlace,
}

/// The place of a source.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SourcePlace {
    /// A file of elements in any form.
    File(PathBuf),
    /// All files of elements in a folder, without the folders in it.
    Folder(PathBuf),
    /// An `https` address that answers with elements in any form.
    Web(String),
}

impl Source {
    /// A group of `CelesTrak`, such as `active` or `weather`, as OMM: a TLE
    /// carries no object that was cataloged after July 2026.
    pub fn celestrak(group: &str) -> Self {
        let url = format!("https://celestrak.org/NORAD/elements/gp.php?GROUP={group}&FORMAT=json");
        Self { name: group.to_owned(), place: SourcePlace::Web(url) }
    }
}

/// Returns `true` if a server may be asked at `now` that was last asked at
/// `last_attempt`, whatever its answer was. `forced`: the operator wants it.
pub fn may_fetch(last_attempt: Option<Timestamp>, now: Timestamp, forced: bool) -> bool {
    // A clock that was set back must not shut the source off.
    forced || last_attempt.is_none_or(|last| last > now || now.duration_since(last) >= FETCH_PAUSE)
}

/// Why a server gave no new elements. What was held stays.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FetchProblem {
    /// Not an `https` address, or one with a user name in it.
    #[error("the address is not a plain https address")]
    Address,
    /// Another answer than 200 and 304; the server is not asked again soon.
    #[error("the server answered {0}")]
    Answer(u16),
    /// No whole answer.
    #[error("no answer: {0}")]
    Unreachable(String),
    /// The server could not prove who it is; nothing was asked of it.
    #[error("the server's certificate is not trusted: {0}")]
    Certificate(String),
    /// More than the limit, bytes.
    #[error("the answer is larger than {0} bytes")]
    TooLarge(u64),
    /// Nothing in the answer could be read.
    #[error("the answer holds no elements")]
    NoElements,
    /// Nothing in the answer looks like elements.
    #[error("the answer holds no elements, {0}")]
    Nothing(Nothing),
    /// All that came is older than what is held.
    #[error("the answer is older than what is held")]
    Older,
    /// The answer could not be put on disk.
    #[error("the answer could not be kept: {0}")]
    Disk(String),
}

/// The state of one source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceReport {
    pub source: String,
    /// Its files: one, or all of a folder; none when nothing was fetched yet.
    pub files: Vec<FileReport>,
    /// When its elements were last known to be current: a file's time of
    /// change, or the last time a server sent or confirmed them.
    pub as_of: Option<Timestamp>,
    /// The newest epoch in it.
    pub newest_epoch: Option<Timestamp>,
    /// The reason why the last request brought no new elements.
    pub fetch_problem: Option<FetchProblem>,
    /// When the server may be asked again without force, where one is asked.
    pub next_fetch: Option<Timestamp>,
    /// It was not read, because the program ended while it was read the last time.
    pub is_set_aside: bool,
}

/// The state of one file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileReport {
    pub path: PathBuf,
    pub objects: usize,
    /// Changes in the catalog, and refusals.
    pub merge: MergeSummary,
    /// Why it could not be read at all, in the words of the operating system.
    pub problem: Option<String>,
}

impl SourceReport {
    pub fn objects(&self) -> usize {
        self.files.iter().map(|file| file.objects).sum()
    }

    pub fn refused(&self) -> usize {
        let merges = self.files.iter().map(|file| &file.merge);
        merges.map(|merge| merge.refused.len() + merge.refused_unlisted).sum()
    }

    /// Age of what is held at `now`, in seconds.
    pub fn age_s(&self, now: Timestamp) -> Option<f64> {
        self.as_of.map(|as_of| time::seconds_between(as_of, now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_server_is_asked_once_in_two_hours_unless_forced() {
        let at = |text: &str| -> Timestamp { text.parse().unwrap() };
        let now = at("2026-08-12T12:00:00Z");
        assert!(may_fetch(None, now, false));
        assert!(may_fetch(Some(at("2026-08-12T10:00:00Z")), now, false));
        assert!(!may_fetch(Some(at("2026-08-12T10:00:01Z")), now, false));
        assert!(may_fetch(Some(at("2026-08-12T11:59:59Z")), now, true));
        assert!(may_fetch(Some(at("2026-08-13T00:00:00Z")), now, false));
    }

    #[test]
    fn sources_are_kept_in_settings() {
        #[derive(Debug, PartialEq, Serialize, Deserialize)]
        struct Settings {
            source: Vec<Source>,
        }
        let file = Source { name: "Own".to_owned(), place: SourcePlace::File("own.tle".into()) };
        let settings = Settings { source: vec![Source::celestrak("active"), file] };
        let text = toml::to_string(&settings).unwrap();
        assert!(text.contains("web = \"https://celestrak.org/"), "{text}");
        assert_eq!(toml::from_str::<Settings>(&text).unwrap(), settings);
    }
}
