//! Sources of elements, their states, and the limits on requests to servers.

use std::path::PathBuf;

use jiff::{SignedDuration, Timestamp};
use serde::{Deserialize, Serialize};

use super::{MergeSummary, Nothing};
use crate::astro::time;

/// Min time between requests to a server for one source, unless the operator requests it.
/// `CelesTrak` renews its elements every two hours and blocks clients that ask more often.
pub const FETCH_PAUSE: SignedDuration = SignedDuration::from_hours(2);

/// A source of elements, which is also the group of its objects.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    pub name: String,
    #[serde(flatten)]
    pub place: SourcePlace,
    /// Interval between automatic requests to a server; `None` for no automatic requests.
    #[serde(default, rename = "refresh_hours", skip_serializing_if = "Option::is_none")]
    pub refresh: Option<RefreshHours>,
}

/// Hours between two automatic requests to a server, 2 to 168.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "u32", into = "u32")]
pub struct RefreshHours(u32);

impl From<u32> for RefreshHours {
    /// Clamps the hours: fewer would be impolite, and more would be as good as never.
    fn from(hours: u32) -> Self {
        Self(hours.clamp(2, 168))
    }
}

impl From<RefreshHours> for u32 {
    fn from(hours: RefreshHours) -> Self {
        hours.0
    }
}

/// Place from which a source is read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SourcePlace {
    /// A file of elements in any form.
    File(PathBuf),
    /// All files of elements in a folder, without its subfolders.
    Folder(PathBuf),
    /// An `https` address that answers with elements in any form.
    Web(String),
    /// Elements of the favourites at Space-Track, with this log-in name.
    SpaceTrack(String),
}

impl SourcePlace {
    /// Returns `true` if a server gives the elements.
    pub fn is_server(&self) -> bool {
        match self {
            Self::Web(_) | Self::SpaceTrack(_) => true,
            Self::File(_) | Self::Folder(_) => false,
        }
    }
}

impl Source {
    /// Returns a group of `CelesTrak`, such as `active` or `weather`, as OMM. A TLE carries no
    /// object that was cataloged after July 2026.
    pub fn celestrak(group: &str) -> Self {
        let url = format!("https://celestrak.org/NORAD/elements/gp.php?GROUP={group}&FORMAT=json");
        Self { name: group.to_owned(), place: SourcePlace::Web(url), refresh: None }
    }

    /// Returns the source with the newest TLE of each satellite in `SatNOGS` DB.
    pub fn satnogs() -> Self {
        let url = "https://db.satnogs.org/api/tle/?format=json".to_owned();
        Self { name: "SatNOGS".to_owned(), place: SourcePlace::Web(url), refresh: None }
    }

    /// Returns the time of the next automatic request; `None` if there is none, such as after a
    /// refused log-in.
    ///
    /// Each failure in a row doubles the interval, at most four times. A variation of up to a tenth
    /// keeps many consoles from asking at once.
    pub fn next_by_itself(
        &self,
        report: Option<&SourceReport>,
        now: Timestamp,
    ) -> Option<Timestamp> {
        let hours = self.refresh.filter(|_| self.place.is_server())?;
        let report = report.filter(|report| !report.is_set_aside && !report.awaits_operator())?;
        let Some(last) = report.attempted_at(now) else { return Some(Timestamp::UNIX_EPOCH) };
        let interval_s = f64::from(hours.0) * 3600.0 * f64::from(1_u32 << report.failures.min(4));
        let spread = f64::from(spread(&self.name, last)) / f64::from(u16::MAX);
        Some(time::add_seconds(last, interval_s * (1.0 + 0.1 * spread)))
    }
}

/// Returns a number that differs between sources and between requests.
fn spread(name: &str, last: Timestamp) -> u16 {
    let bytes = name.bytes().chain(last.as_microsecond().to_le_bytes());
    let mixed = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    (mixed >> 32) as u16
}

/// Returns `true` if a server that was last asked at `last_attempt` may be asked at `now`. Its last
/// answer does not matter. With `forced`, the operator requests it.
pub fn may_fetch(last_attempt: Option<Timestamp>, now: Timestamp, forced: bool) -> bool {
    // A clock that was set back must not block the source.
    forced || last_attempt.is_none_or(|last| last > now || now.duration_since(last) >= FETCH_PAUSE)
}

/// A limit of a server that also applies to the operator: no request for `pause` after `time`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct RequestLimit {
    /// Time of the request that began the limit.
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub pause: SignedDuration,
}

/// Returns the end of the last of `limits`. A limit that begins after `now` does not count, because
/// the clock was ahead then and must not block the source for years.
pub fn not_before(limits: &[RequestLimit], now: Timestamp) -> Option<Timestamp> {
    let limits = limits.iter().filter(|limit| limit.time <= now);
    limits.filter_map(|limit| limit.time.checked_add(limit.pause).ok()).max()
}

/// Reason why a server gave no new elements. The stored elements stay.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FetchProblem {
    /// The address is not `https`, or contains a user name.
    #[error("the address is not a plain https address")]
    Address,
    /// The answer is neither 200 nor 304. Azel does not ask the server again soon.
    #[error("the server answered {0}")]
    Answer(u16),
    /// The answer is missing or incomplete.
    #[error("no answer: {0}")]
    Unreachable(String),
    /// The server could not prove its identity. Azel sent no request.
    #[error("the server's certificate is not trusted: {0}")]
    Certificate(String),
    /// No trusted authority signed the server's certificate. Azel sent no request.
    #[error("this computer trusts no authority that signed the server's certificate")]
    UnknownAuthority,
    /// The answer is larger than this limit in bytes.
    #[error("the answer is larger than {0} bytes")]
    TooLarge(u64),
    /// The proxy of this environment variable is unusable. Azel asked no server.
    #[error("the proxy in {0} cannot be used; correct the variable, or remove it")]
    Proxy(String),
    /// Azel could read no elements in the answer.
    #[error("the answer holds no elements")]
    NoElements,
    /// The answer does not look like elements.
    #[error("the answer holds no elements, {0}")]
    Nothing(Nothing),
    #[error("the answer is older than what is held")]
    Older,
    /// The keyring has no password for the log-in name. Azel asked no server.
    #[error("no password is stored for this log-in")]
    NoPassword,
    /// The keyring did not give the password. Azel asked no server.
    #[error("the password cannot be read: {0}")]
    Keyring(String),
    /// Name or password are wrong, or the account is closed. Servers lock accounts that try again.
    #[error("the server refused the log-in")]
    LogIn,
    #[error("the server opened no session")]
    NoSession,
    /// The server gave no elements, for this reason.
    #[error("the server answered: {0}")]
    Refused(String),
    /// The library on disk accepts no record of a request, so a restart could ask too often. Azel
    /// asked no server.
    #[error("no server was asked, because the request cannot be recorded: {0}")]
    Unrecorded(String),
    /// Azel had logged in, but the library on disk accepts no record of the query. Azel did not
    /// send the query.
    #[error("the query was not sent, because it cannot be recorded: {0}")]
    QueryUnrecorded(String),
    /// The source needs favourites, but there are none. Azel asked no server.
    #[error("there are no favourites to ask for")]
    NoFavourites,
    /// Azel could not write the answer to disk.
    #[error("the answer could not be kept: {0}")]
    Disk(String),
}

impl FetchProblem {
    /// Returns `true` if the problem occurred before any request, so that no limit of a server has
    /// begun.
    pub fn is_before_request(&self) -> bool {
        match self {
            Self::Address
            | Self::Proxy(_)
            | Self::NoPassword
            | Self::Keyring(_)
            | Self::Unrecorded(_)
            | Self::NoFavourites => true,
            Self::Answer(_)
            | Self::Unreachable(_)
            | Self::Certificate(_)
            | Self::UnknownAuthority
            | Self::TooLarge(_)
            | Self::NoElements
            | Self::Nothing(_)
            | Self::Older
            | Self::LogIn
            | Self::NoSession
            | Self::Refused(_)
            | Self::QueryUnrecorded(_)
            | Self::Disk(_) => false,
        }
    }
}

/// State of one source: its files, requests and limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceReport {
    pub source: String,
    /// Files of the source: one, or all of a folder; none before the first fetch.
    pub files: Vec<FileReport>,
    /// Last time at which the elements were known to be current. It is the modification time of a
    /// file, or the last time that a server sent or confirmed them.
    pub as_of: Option<Timestamp>,
    /// Newest epoch in the source.
    pub newest_epoch: Option<Timestamp>,
    /// Reason why the last request brought no new elements.
    pub fetch_problem: Option<FetchProblem>,
    /// Number of failed requests in a row.
    pub failures: u32,
    /// Earliest time of the next request without force, if the source is a server.
    pub next_fetch: Option<Timestamp>,
    /// Limits of the server that also apply to the operator.
    #[serde(default)]
    pub limits: Vec<RequestLimit>,
    /// Azel did not read the source, because the last reading crashed the program.
    pub is_set_aside: bool,
    /// Number of objects of the source for which the bundled elements or another source have a
    /// newer set.
    #[serde(default)]
    pub newer_elsewhere: usize,
}

/// State of one file: its objects, changes and problem.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileReport {
    pub path: PathBuf,
    pub objects: usize,
    /// Changes in the catalog, and refusals.
    pub merge: MergeSummary,
    /// Reason why the file is unreadable as a whole, in the words of the operating system.
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

    /// Returns `true` if Azel does not ask the server again until the operator acts.
    pub fn awaits_operator(&self) -> bool {
        self.fetch_problem == Some(FetchProblem::LogIn)
    }

    /// Returns the earliest time at which the operator may ask the server without force. Returns
    /// `None` if the server was never asked, or if the last attempt failed before a request.
    pub fn next_request(&self, now: Timestamp) -> Option<Timestamp> {
        let is_unasked = self.fetch_problem.as_ref().is_some_and(FetchProblem::is_before_request);
        self.pause_end(now).filter(|_| !is_unasked)
    }

    /// Returns the earliest time for the next request without force, after an attempt with any
    /// outcome.
    pub fn pause_end(&self, now: Timestamp) -> Option<Timestamp> {
        self.next_fetch.filter(|_| self.attempted_at(now).is_some())
    }

    /// Returns the earliest time at which the operator may ask the server again, if the server sets
    /// such a limit.
    pub fn not_before(&self, now: Timestamp) -> Option<Timestamp> {
        not_before(&self.limits, now)
    }

    /// Returns the time of the last attempt. Like [`may_fetch`], it ignores an attempt after `now`.
    fn attempted_at(&self, now: Timestamp) -> Option<Timestamp> {
        let last = self.next_fetch?.checked_sub(FETCH_PAUSE).ok()?;
        Some(last).filter(|last| *last <= now)
    }

    /// Returns the age of the stored elements at `now`, seconds.
    pub fn age_s(&self, now: Timestamp) -> Option<f64> {
        self.as_of.map(|as_of| time::seconds_between(as_of, now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_server_is_asked_once_in_two_hours_unless_forced() {
        let time = |text: &str| -> Timestamp { text.parse().unwrap() };
        let now = time("2026-08-12T12:00:00Z");
        assert!(may_fetch(None, now, false));
        assert!(may_fetch(Some(time("2026-08-12T10:00:00Z")), now, false));
        assert!(!may_fetch(Some(time("2026-08-12T10:00:01Z")), now, false));
        assert!(may_fetch(Some(time("2026-08-12T11:59:59Z")), now, true));
        assert!(may_fetch(Some(time("2026-08-13T00:00:00Z")), now, false));
    }

    #[test]
    fn a_source_refreshes_by_itself_only_when_set_and_waits_longer_after_failures() {
        let time = |text: &str| -> Timestamp { text.parse().unwrap() };
        let report = |failures| SourceReport {
            source: "active".to_owned(),
            files: Vec::new(),
            as_of: None,
            newest_epoch: None,
            fetch_problem: None,
            failures,
            // The last request was at 12:00.
            next_fetch: Some(time("2026-08-12T14:00:00Z")),
            limits: Vec::new(),
            is_set_aside: false,
            newer_elsewhere: 0,
        };
        let now = time("2026-08-12T12:00:00Z");
        let disabled = Source::celestrak("active");
        assert_eq!(disabled.next_by_itself(Some(&report(0)), now), None);
        let source = Source { refresh: Some(RefreshHours::from(1)), ..disabled };
        let after_h = |failures| {
            let next = source.next_by_itself(Some(&report(failures)), now).unwrap();
            time::seconds_between(time("2026-08-12T12:00:00Z"), next) / 3600.0
        };
        for (failures, min_h) in [(0, 2.0), (1, 4.0), (2, 8.0), (4, 32.0), (9, 32.0)] {
            assert!((min_h..=1.1 * min_h).contains(&after_h(failures)), "{}", after_h(failures));
        }
        assert!(after_h(0) > 2.0, "not all consoles at once");
        let never = SourceReport { next_fetch: None, ..report(0) };
        assert_eq!(source.next_by_itself(Some(&never), now), Some(Timestamp::UNIX_EPOCH));
        let refused = SourceReport { fetch_problem: Some(FetchProblem::LogIn), ..report(1) };
        assert_eq!(source.next_by_itself(Some(&refused), now), None, "the account would be locked");
        let skipped = SourceReport { is_set_aside: true, ..report(0) };
        assert_eq!(source.next_by_itself(Some(&skipped), now), None);
        let file = Source { place: SourcePlace::File("own.tle".into()), ..source.clone() };
        assert_eq!(file.next_by_itself(Some(&report(0)), now), None);
    }

    #[test]
    fn a_request_by_a_clock_that_was_ahead_blocks_nothing() {
        let time = |text: &str| -> Timestamp { text.parse().unwrap() };
        let now = time("2026-08-12T12:00:00Z");
        let hour = SignedDuration::from_hours(1);
        let limits = [("2031-01-01T00:00:00Z", hour), ("2026-08-12T11:59:50Z", hour / 240)]
            .map(|(text, pause)| RequestLimit { time: time(text), pause });
        assert_eq!(not_before(&limits, now), Some(time("2026-08-12T12:00:05Z")));
        assert_eq!(not_before(&limits[..1], now), None);
        let report = SourceReport {
            source: "active".to_owned(),
            files: Vec::new(),
            as_of: None,
            newest_epoch: None,
            fetch_problem: None,
            failures: 0,
            next_fetch: Some(time("2031-01-01T02:00:00Z")),
            limits: limits.to_vec(),
            is_set_aside: false,
            newer_elsewhere: 0,
        };
        let source = Source { refresh: Some(RefreshHours::from(2)), ..Source::celestrak("active") };
        assert_eq!(source.next_by_itself(Some(&report), now), Some(Timestamp::UNIX_EPOCH));
        assert_eq!((report.next_request(now), report.pause_end(now)), (None, None));
        assert_eq!(report.not_before(now), Some(time("2026-08-12T12:00:05Z")));
    }

    #[test]
    fn sources_are_kept_in_settings() {
        #[derive(Debug, PartialEq, Serialize, Deserialize)]
        struct Settings {
            source: Vec<Source>,
        }
        let file = Source {
            name: "Own".to_owned(),
            place: SourcePlace::File("own.tle".into()),
            refresh: None,
        };
        let active = Source { refresh: Some(RefreshHours::from(6)), ..Source::celestrak("active") };
        let space_track = Source {
            name: "Space-Track".to_owned(),
            place: SourcePlace::SpaceTrack("op@example.org".to_owned()),
            refresh: Some(RefreshHours::from(12)),
        };
        let settings = Settings { source: vec![active, space_track, file] };
        let text = toml::to_string(&settings).unwrap();
        assert!(text.contains("web = \"https://celestrak.org/"), "{text}");
        assert!(text.contains("refresh_hours = 6"), "{text}");
        assert!(text.contains("space_track = \"op@example.org\""), "{text}");
        assert_eq!(toml::from_str::<Settings>(&text).unwrap(), settings);
    }
}
