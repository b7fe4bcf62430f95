//! Library of elements from all sources on this computer. Only this module asks servers for new
//! elements.
//!
//! The library stores the answers of servers unchanged, one file for each source, beside an index.
//! Being offline is a normal state: Azel keeps the stored elements and shows their age. All calls
//! wait for disks and servers: make them on a worker thread.

mod authorities;
pub mod disk;
mod exceptions;
mod fetch;
mod history;
mod index;
mod list;
mod lock;
mod space_track;
mod unfinished;

use std::{
    borrow::Cow,
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use rustls::pki_types::CertificateDer;
use ureq::tls::{Certificate, RootCerts};

pub use self::{
    authorities::system_authorities,
    exceptions::Exceptions,
    fetch::{Limits, environment_proxy},
    history::History,
    index::IndexError,
    list::{SourcesError, load_sources, save_sources},
    space_track::{LOG_IN_PAUSE, PasswordStore, SpaceTrackAccess},
};
use self::{
    fetch::{ServerAnswer, agent, fetch, host},
    index::{AddressRecord, Index},
    lock::Lock,
    space_track::{Step, Visit},
    unfinished::{ReadingNote, SetAside},
};
use crate::{
    contract::sources::SPACE_TRACK_HOST,
    orbit::{
        Catalog, Elements, FETCH_PAUSE, FetchProblem, FileReport, MergeSummary, ReadReport, Source,
        SourcePlace, SourceReport, may_fetch, not_before, read_element_bytes,
    },
    whole_file,
};

/// Extensions of element files in a folder.
const ENDINGS: [&str; 9] = ["tle", "2le", "3le", "txt", "json", "csv", "xml", "kvn", "omm"];

/// File that locks visits to Space-Track.
const VISIT_LOCK: &str = "space-track.lock";

/// Returns the element files in `folder`, sorted by name, without those in subfolders.
pub fn element_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    disk::files(folder, &ENDINGS)
}

/// Returns the server of a source; `None` for a source without one.
pub fn server_of(source: &Source) -> Option<String> {
    match &source.place {
        SourcePlace::Web(url) => Some(host(url)),
        SourcePlace::SpaceTrack(_) => Some(SPACE_TRACK_HOST.to_owned()),
        SourcePlace::File(_) | SourcePlace::Folder(_) => None,
    }
}

/// Reads a file of elements, up to the default size limit.
pub fn read_element_file(path: &Path) -> io::Result<Vec<u8>> {
    Ok(disk::read(path, Limits::default().bytes)?.bytes)
}

/// Epochs by catalog number.
type Epochs = BTreeMap<u32, Timestamp>;

/// Library of elements on disk.
#[derive(Debug)]
pub struct Library {
    folder: PathBuf,
    index: Index,
    limits: Limits,
    authorities: RootCerts,
    space_track: Option<SpaceTrackAccess>,
}

/// Returns the key of a source in the index; `None` for a source without a server.
fn key(source: &Source) -> Option<Cow<'_, str>> {
    match &source.place {
        SourcePlace::Web(url) => Some(url.into()),
        SourcePlace::SpaceTrack(user) => Some(space_track::key(user).into()),
        SourcePlace::File(_) | SourcePlace::Folder(_) => None,
    }
}

/// Returns the element folder of this user; `None` on a machine without a home folder.
pub fn library_folder() -> Option<PathBuf> {
    directories::ProjectDirs::from("", "", "azel").map(|dirs| dirs.data_dir().join("elements"))
}

impl Library {
    /// Opens the library in `folder`, which may not exist yet.
    pub fn open(folder: &Path, limits: Limits) -> Result<Self, IndexError> {
        let (folder, index) = (folder.to_owned(), Index::load(folder)?);
        Ok(Self { folder, index, limits, authorities: RootCerts::WebPki, space_track: None }
            .trusting(system_authorities()))
    }

    /// Trusts these certificate authorities, in DER, in place of the system's authorities. An empty
    /// list means the public authorities.
    #[must_use]
    pub fn trusting(self, authorities: &[CertificateDer<'static>]) -> Self {
        if authorities.is_empty() {
            return Self { authorities: RootCerts::WebPki, ..self };
        }
        let own = authorities.iter().map(|own| Certificate::from_der(own).to_owned());
        Self { authorities: own.into(), ..self }
    }

    /// Sets the access to Space-Track. Without it, Azel does not ask Space-Track.
    #[must_use]
    pub fn with_space_track(self, access: SpaceTrackAccess) -> Self {
        Self { space_track: Some(access), ..self }
    }

    /// Reads all `sources` from disk, without asking a server.
    pub fn load(&self, sources: &[Source]) -> (Catalog, Vec<SourceReport>) {
        let mut catalog = Catalog::default();
        let reports = self.load_into(sources, &mut catalog);
        (catalog, reports)
    }

    /// Reads all `sources` into a catalog that may already have elements.
    ///
    /// Skips a source whose reading ended the program, and reports it as set aside, until
    /// [`Self::read_again`] names it.
    pub fn load_into(&self, sources: &[Source], catalog: &mut Catalog) -> Vec<SourceReport> {
        let mut set_aside = SetAside::load(&self.folder);
        let mut reading = ReadingNote::begin(&self.folder, &mut set_aside);
        let report = |source: &Source| {
            let mut epochs = Epochs::new();
            if set_aside.contains(source) {
                return (SourceReport { is_set_aside: true, ..no_report(source) }, epochs);
            }
            let load = || self.load_one(source, catalog, &mut epochs);
            (reading.while_reading(source, load), epochs)
        };
        let read: Vec<(SourceReport, Epochs)> = sources.iter().map(report).collect();
        // Compare after all reads: a later source may have newer sets than an earlier one.
        let compared = read.into_iter().map(|(report, epochs)| {
            let is_older = |(number, epoch): &(&u32, &Timestamp)| {
                let best = catalog.get(**number);
                best.is_some_and(|best| catalog.is_better(best.epoch(), **epoch))
            };
            let newer_elsewhere = epochs.iter().filter(is_older).count();
            SourceReport { newer_elsewhere, ..report }
        });
        compared.collect()
    }

    /// Clears the set-aside mark of the sources in `names`, and of those no longer in `sources`.
    pub fn read_again(&self, sources: &[Source], names: &[String]) {
        SetAside::load(&self.folder).keep(sources, names);
    }

    /// Reads a source, and adds the epoch of its best set for each object to `epochs`.
    fn load_one(
        &self,
        source: &Source,
        catalog: &mut Catalog,
        epochs: &mut Epochs,
    ) -> SourceReport {
        let mut report = no_report(source);
        if let Some(record) = key(source).and_then(|key| self.index.get(&key)) {
            if let SourcePlace::SpaceTrack(_) = source.place {
                report.limits = space_track::limits(record);
            }
            report.fetch_problem.clone_from(&record.problem);
            report.failures = record.failures;
            report.next_fetch = record.attempted_at.checked_add(FETCH_PAUSE).ok();
            report.as_of = record.confirmed_at;
        }
        let paths = match self.files_of(source) {
            Ok(paths) => paths,
            Err((path, error)) => {
                report.files.push(unread(&path, &error));
                return report;
            }
        };
        for path in paths {
            match disk::read(&path, self.limits.bytes) {
                Ok(file) => {
                    let read = read_element_bytes(&file.bytes);
                    drop(file.bytes);
                    let newest = catalog.newest_of(&read.elements);
                    report.newest_epoch = report.newest_epoch.max(newest);
                    if !source.place.is_server() {
                        report.as_of = report.as_of.max(file.modified);
                    }
                    let objects = read.elements.len();
                    for elements in &read.elements {
                        let epoch = elements.epoch();
                        let best = epochs.entry(elements.catalog_number()).or_insert(epoch);
                        if catalog.is_better(epoch, *best) {
                            *best = epoch;
                        }
                    }
                    let merge = catalog.merge(read, &source.name);
                    report.files.push(FileReport { path, objects, merge, problem: None });
                }
                Err(error) => report.files.push(unread(&path, &error)),
            }
        }
        report
    }

    /// Returns the files with the elements of a source; they may be missing. The list is empty if
    /// the server never answered. An error names the folder that could not be listed.
    pub fn files_of(&self, source: &Source) -> Result<Vec<PathBuf>, (PathBuf, io::Error)> {
        match &source.place {
            SourcePlace::File(path) => Ok(vec![path.clone()]),
            SourcePlace::Folder(path) => element_files(path).map_err(|error| (path.clone(), error)),
            SourcePlace::Web(_) | SourcePlace::SpaceTrack(_) => {
                let record = key(source).and_then(|key| self.index.get(&key));
                let confirmed = record.filter(|record| record.confirmed_at.is_some());
                Ok(confirmed.map(|record| self.folder.join(&record.file)).into_iter().collect())
            }
        }
    }

    /// Asks the servers of `sources` for new elements at `now`. Azel asks each server whose pause
    /// is over, or every server that permits it if `forced`. Returns the number of sources with new
    /// elements. [`Library::load_into`] then reports each result, even after an error.
    ///
    /// A server that fails, or answers with a status other than 200 or 304, is not asked for its
    /// other sources. Azel does not visit Space-Track while another process does.
    pub fn refresh(
        &mut self,
        sources: &[Source],
        now: Timestamp,
        forced: bool,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<usize, IndexError> {
        let mut renewed = 0;
        let mut silent_hosts: Vec<String> = Vec::new();
        for source in sources {
            let (Some(key), Some(host)) = (key(source), server_of(source)) else { continue };
            if cancelled() {
                break;
            }
            if silent_hosts.contains(&host) || !self.may_ask(source, &key, now, forced) {
                continue;
            }
            // Released after the index is saved.
            let mut _lock = None;
            let permission = match &source.place {
                SourcePlace::SpaceTrack(user) => match Lock::try_take(&self.folder, VISIT_LOCK) {
                    Ok(Some(lock)) => {
                        _lock = Some(lock);
                        // Another process may have changed the index since Azel read it.
                        self.index = Index::load(&self.folder)?;
                        if !self.may_ask(source, &key, now, forced) {
                            continue;
                        }
                        self.refresh_space_track(source, user, now)
                    }
                    Ok(None) => continue,
                    Err(error) => Err(FetchProblem::Unrecorded(error.to_string())),
                },
                _ => self.refresh_one(&source.name, &key, now),
            };
            let problem = match permission {
                Ok(is_new) => {
                    renewed += usize::from(is_new);
                    None
                }
                Err(problem) => Some(problem),
            };
            let is_silent = matches!(
                problem,
                Some(
                    FetchProblem::Answer(_)
                        | FetchProblem::Unreachable(_)
                        | FetchProblem::Certificate(_)
                        | FetchProblem::UnknownAuthority
                        | FetchProblem::Refused(_)
                        | FetchProblem::NoSession
                )
            );
            if is_silent {
                silent_hosts.push(host);
            }
            let record = self.index.entry(&key, &source.name, now);
            record.failures = if problem.is_some() { record.failures.saturating_add(1) } else { 0 };
            record.problem = problem;
            self.index.save_record(&key, &self.folder)?;
        }
        Ok(renewed)
    }

    /// Returns the earliest time at which the server of `source` may be asked, if it sets a limit.
    pub fn not_before(&self, source: &Source, now: Timestamp) -> Option<Timestamp> {
        let SourcePlace::SpaceTrack(user) = &source.place else { return None };
        let record = self.index.get(&space_track::key(user))?;
        not_before(&space_track::limits(record), now)
    }

    /// Returns `true` if the server of `source` may be asked at `now`. Server limits apply to the
    /// operator too. Only the operator may repeat a refused log-in.
    fn may_ask(&self, source: &Source, key: &str, now: Timestamp, forced: bool) -> bool {
        let record = self.index.get(key);
        let last = record.and_then(AddressRecord::asked_at);
        let is_allowed = match source.place {
            SourcePlace::SpaceTrack(_) => {
                let is_early = self.not_before(source, now) > Some(now);
                let refused = Some(FetchProblem::LogIn);
                let is_refused = record.is_some_and(|record| record.problem == refused);
                self.space_track.is_some() && !is_early && (forced || !is_refused)
            }
            _ => true,
        };
        is_allowed && may_fetch(last, now, forced)
    }

    /// Asks Space-Track for the elements of the favourites. The answer replaces the stored one even
    /// if its newest epoch is older: the favourites may have changed.
    fn refresh_space_track(
        &mut self,
        source: &Source,
        user: &str,
        now: Timestamp,
    ) -> Result<bool, FetchProblem> {
        let Some(access) = self.space_track.clone() else { return Ok(false) };
        let (limits, key) = (self.limits, space_track::key(user));
        let agent = agent(access.server(), limits, &self.authorities)?;
        self.index.entry(&key, &source.name, now).attempted_at = now;
        let visit = Visit { access: &access, agent, limits };
        let body = visit.run(user, |step| self.record_step(source, &key, now, step))?;
        elements_in(&body)?;
        let record = self.index.entry(&key, &source.name, now);
        let path = self.folder.join(&record.file);
        whole_file::replace_and_keep_old(&path, &body)
            .map_err(|error| FetchProblem::Disk(error.to_string()))?;
        record.confirmed_at = Some(now);
        Ok(true)
    }

    /// Saves a request to Space-Track before sending it. Its limit then applies even if Azel is
    /// killed during the visit.
    fn record_step(
        &mut self,
        source: &Source,
        key: &str,
        now: Timestamp,
        step: Step,
    ) -> Result<(), FetchProblem> {
        let record = self.index.entry(key, &source.name, now);
        let previous = record.queried_at;
        match step {
            // An attempt that reached no server starts no limit.
            Step::LogIn => {
                record.problem.take_if(|problem| problem.is_before_request());
            }
            // The server has accepted the log-in.
            Step::Query => (record.problem, record.queried_at) = (None, Some(now)),
        }
        let Err(error) = self.index.save_record(key, &self.folder) else { return Ok(()) };
        self.index.entry(key, &source.name, now).queried_at = previous;
        Err(match step {
            Step::LogIn => FetchProblem::Unrecorded(error.to_string()),
            Step::Query => FetchProblem::QueryUnrecorded(error.to_string()),
        })
    }

    /// Requests the elements of one source; returns `true` if the answer has new content.
    fn refresh_one(&mut self, name: &str, url: &str, now: Timestamp) -> Result<bool, FetchProblem> {
        let record = self.index.entry(url, name, now);
        record.attempted_at = now;
        let record = record.clone();
        let path = self.folder.join(&record.file);
        let stored = disk::read(&path, self.limits.bytes).ok();
        let cached = stored.as_ref().map(|_| &record);
        match fetch(url, cached, self.limits, &self.authorities)? {
            ServerAnswer::NotModified => {
                self.index.entry(url, name, now).confirmed_at = Some(now);
                Ok(false)
            }
            ServerAnswer::New { body, etag, last_modified } => {
                let sent = elements_in(&body)?;
                let stored = stored.and_then(|stored| elements_in(&stored.bytes).ok());
                if stored.is_some_and(|stored| is_older(sent, stored, now)) {
                    return Err(FetchProblem::Older);
                }
                whole_file::replace_and_keep_old(&path, &body)
                    .map_err(|error| FetchProblem::Disk(error.to_string()))?;
                *self.index.entry(url, name, now) =
                    AddressRecord { etag, last_modified, confirmed_at: Some(now), ..record };
                Ok(true)
            }
        }
    }
}

/// Parses the elements of an answer, at least one.
fn elements_in(bytes: &[u8]) -> Result<Vec<Elements>, FetchProblem> {
    let report = read_element_bytes(bytes);
    if report.elements.is_empty() {
        return Err(report.nothing.map_or(FetchProblem::NoElements, FetchProblem::Nothing));
    }
    Ok(report.elements)
}

/// Returns `true` if more objects have an older set in `sent` than in `stored` than a newer one. A
/// single set decides nothing: some lists, such as the one of `SatNOGS`, hold sets for future
/// launches whose dates change in both directions.
fn is_older(sent: Vec<Elements>, stored: Vec<Elements>, now: Timestamp) -> bool {
    let catalog = |elements: Vec<Elements>| {
        let mut catalog = Catalog::default();
        catalog.set_time(now);
        catalog.merge(ReadReport { elements, ..ReadReport::default() }, "");
        catalog
    };
    let (sent, stored) = (catalog(sent), catalog(stored));
    let orders = sent.iter().filter_map(|sent| {
        let stored = stored.get(sent.catalog_number())?;
        Some(sent.epoch().cmp(&stored.epoch()))
    });
    let balance: i64 = orders.map(|order| order as i64).sum();
    balance < 0
}

fn no_report(source: &Source) -> SourceReport {
    SourceReport {
        source: source.name.clone(),
        files: Vec::new(),
        as_of: None,
        newest_epoch: None,
        fetch_problem: None,
        failures: 0,
        next_fetch: None,
        limits: Vec::new(),
        is_set_aside: false,
        newer_elsewhere: 0,
    }
}

fn unread(path: &Path, error: &io::Error) -> FileReport {
    let problem = Some(error.to_string());
    FileReport { path: path.to_owned(), objects: 0, merge: MergeSummary::default(), problem }
}
