//! Sources of elements: the bundled source and the operator's sources. A separate thread reads,
//! saves and fetches them.

mod passwords;

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use jiff::Timestamp;

pub(super) use self::passwords::Passwords;
use super::older_sets::use_older_sets;
use crate::{
    contract::{
        older_sets::{OlderSet, SetChoice},
        sources::{Copied, Sources, check_source, has_log_in},
    },
    job::{Job, Wake},
    library::{
        self, History, IndexError, LOG_IN_PAUSE, Library, Limits, SpaceTrackAccess, load_sources,
        read_element_file, save_sources,
    },
    orbit::{Catalog, Source, SourceOrders, SourcePlace, SourceReport, bundled, bundled_sharing},
    whole_file,
};

/// Returns the names of sources whose servers Azel should ask at `now` without a client.
pub(super) fn due_by_themselves(sources: &Sources, now: Timestamp) -> Vec<String> {
    let reported = sources.list.iter().zip(&sources.reports);
    let is_pausing = |report: &SourceReport| report.pause_end(now).is_some_and(|next| next > now);
    // A server that has just failed is not asked for its other sources.
    let failed: Vec<String> = reported
        .clone()
        .filter(|(_, report)| report.failures > 0 && is_pausing(report))
        .filter_map(|(source, _)| library::server_of(source))
        .collect();
    let is_due = |(source, report): &(&Source, &SourceReport)| {
        let has_failed = library::server_of(source).is_some_and(|host| failed.contains(&host));
        let next = source.next_by_itself(Some(report), now);
        !is_pausing(report) && !has_failed && next.is_some_and(|next| next <= now)
    };
    reported.filter(is_due).map(|(source, _)| source.name.clone()).collect()
}

/// Paths of the list and the library; `None` on a machine without a home.
#[derive(Debug, Clone)]
pub(super) struct Places {
    list: Option<PathBuf>,
    library: Option<PathBuf>,
}

impl Places {
    /// Creates the paths; the list is beside the station file.
    pub(super) fn new(station: Option<&Path>, library: Option<PathBuf>) -> Self {
        Self {
            list: station.map(|station| station.with_file_name("sources.toml")),
            library: library.or_else(library::library_folder),
        }
    }

    /// Returns the folder of the library.
    pub(super) fn library(&self) -> Option<&Path> {
        self.library.as_deref()
    }
}

/// Work before Azel reads all elements again.
#[derive(Debug, Default)]
pub(super) struct Task {
    /// Elements to copy into the library, with the name of their source.
    pub(super) copy: Option<(String, Copied)>,
    /// New list to save.
    pub(super) list: Option<Vec<Source>>,
    /// Names of sources whose servers to ask, if permitted.
    pub(super) ask: Vec<String>,
    pub(super) set: Option<SetChoice>,
    /// Preferred sources of satellites.
    pub(super) orders: SourceOrders,
    /// Catalog numbers of the favourites, for servers that Azel asks only for these objects.
    pub(super) favourites: Vec<u32>,
    pub(super) passwords: Option<Passwords>,
    /// `true` to wait until the servers accept another log-in: the operator has typed a password.
    pub(super) awaits_log_in: bool,
    /// `true` to ask even if the last request is recent.
    pub(super) forced: bool,
}

/// Result of reading.
pub(super) struct Outcome {
    /// Elements of all sources.
    pub(super) catalog: Catalog,
    /// Reason why the bundled elements are missing.
    pub(super) bundled_problem: Option<String>,
    pub(super) sources: Sources,
}

/// Starts `task` at `now`. Stores sets of `in_use` that newer sets replace.
pub(super) fn start(
    places: &Places,
    task: Task,
    in_use: Option<Arc<Catalog>>,
    now: Timestamp,
    wake: Wake,
) -> Job<Outcome> {
    let places = places.clone();
    Job::start("azel-elements", wake, move |cancelled| {
        let mut outcome = carry_out(&places, &task, in_use.as_ref(), now, cancelled);
        match places.library() {
            Some(folder) => {
                let used = use_older_sets(folder, task.set, &mut outcome.catalog);
                outcome.sources.problems.extend(used.err());
            }
            None => outcome.catalog.apply_orders(|_| false),
        }
        keep_superseded(&places, &mut outcome.catalog, in_use.as_deref());
        outcome
    })
}

/// Copies elements into the library, and returns the stored list with a source of this copy.
fn with_copy(places: &Places, name: &str, copied: &Copied) -> Result<Vec<Source>, String> {
    let path = places.list.as_deref().ok_or("this user has no folder for settings")?;
    let folder = places.library.as_deref().ok_or("this user has no folder for data")?;
    let mut list = load_sources(path).map_err(|error| error.to_string())?;
    let read;
    let bytes = match copied {
        Copied::Text(text) => text.as_bytes(),
        Copied::File(file) => {
            let in_words = |error| format!("cannot be read: {error}: {}", file.display());
            read = read_element_file(file).map_err(in_words)?;
            &read
        }
    };
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '-' };
    let stem: String = name.to_lowercase().chars().map(plain).take(40).collect();
    let copies = folder.join("copies");
    let mut files = (1..).map(|count| copies.join(format!("{stem}-{count}.elements")));
    let file = files.find(|file| !file.exists()).unwrap_or(copies);
    let source =
        Source { name: name.to_owned(), place: SourcePlace::File(file.clone()), refresh: None };
    check_source(&source, &list).map_err(|problem| problem.to_string())?;
    whole_file::replace(&file, bytes)
        .map_err(|error| format!("the elements were not copied: {error}: {}", file.display()))?;
    list.push(source);
    Ok(list)
}

/// Stores unused sets, and sets of `before` that newer sets replaced, in the library's history.
/// Logs a failure, which does not affect the elements in use.
fn keep_superseded(places: &Places, catalog: &mut Catalog, before: Option<&Catalog>) {
    let Some(folder) = places.library.as_deref() else { return };
    let merged = catalog.take_superseded().into_iter();
    let mut sets: Vec<OlderSet> =
        merged.map(|(elements, source)| OlderSet { elements, source }).collect();
    for old in before.into_iter().flat_map(Catalog::iter) {
        let number = old.catalog_number();
        let is_replaced = catalog.get(number).is_some_and(|new| new.epoch() > old.epoch());
        if is_replaced {
            let source = before.and_then(|before| before.source_of(number)).unwrap_or_default();
            sets.push(OlderSet { elements: old.clone(), source: source.to_owned() });
        }
    }
    let set_aside = catalog.all_set_aside().map(|(elements, source)| OlderSet {
        elements: elements.clone(),
        source: source.to_owned(),
    });
    sets.extend(set_aside);
    if let Err(error) = History::new(folder).add(&sets) {
        tracing::warn!(%error, "older sets are not kept");
    }
}

fn carry_out(
    places: &Places,
    task: &Task,
    in_use: Option<&Arc<Catalog>>,
    now: Timestamp,
    cancelled: &dyn Fn() -> bool,
) -> Outcome {
    let mut sources = Sources::default();
    let copied = match &task.copy {
        Some((name, copy)) => with_copy(places, name, copy).map(Some),
        None => Ok(task.list.clone()),
    };
    let list = copied.unwrap_or_else(|problem| {
        sources.problems.push(problem);
        None
    });
    if let Some(list) = &list {
        let previous = places.list.as_deref().and_then(|path| load_sources(path).ok());
        let saved = places.list.as_deref().map(|path| save_sources(list, path));
        match saved {
            Some(Ok(())) => {
                let previous = previous.unwrap_or_default();
                if let Some(passwords) = &task.passwords {
                    unused_log_ins(&previous, list).for_each(|user| passwords.forget(user));
                }
            }
            Some(Err(error)) => sources.problems.push(error.to_string()),
            None => sources.problems.push("this user has no folder for settings".to_owned()),
        }
    }
    // Use the list on disk even if the requested list was not saved.
    match places.list.as_deref().map_or(Ok(Vec::new()), load_sources) {
        Ok(list) => sources.list = list,
        Err(error) => {
            sources.problems.push(error.to_string());
            sources.is_locked = true;
        }
    }
    // The current catalog stays in use during the read. Sharing the bundled elements keeps the
    // memory peak low.
    let read_bundled = in_use.map_or_else(bundled, bundled_sharing);
    let (mut catalog, bundled_problem) = match read_bundled {
        Ok(catalog) => (catalog, None),
        Err(error) => (Catalog::default(), Some(error.to_string())),
    };
    catalog.set_time(now);
    catalog.set_orders(task.orders.clone());
    if !sources.list.is_empty() {
        match read(places, &mut sources, task, now, &mut catalog, cancelled) {
            Ok(reports) => sources.reports = reports,
            Err(problem) => sources.problems.push(problem),
        }
    }
    sources.problems.extend(task.passwords.iter().flat_map(Passwords::take_problems));
    Outcome { catalog, bundled_problem, sources }
}

/// Returns the log-in names of `previous` that no source in `list` uses any more.
fn unused_log_ins<'a>(previous: &'a [Source], list: &'a [Source]) -> impl Iterator<Item = &'a str> {
    let users = previous.iter().filter_map(|source| match &source.place {
        SourcePlace::SpaceTrack(user) => Some(user.as_str()),
        SourcePlace::Web(_) | SourcePlace::File(_) | SourcePlace::Folder(_) => None,
    });
    users.filter(|user| !list.iter().any(|source| has_log_in(source, user)))
}

fn read(
    places: &Places,
    sources: &mut Sources,
    task: &Task,
    now: Timestamp,
    catalog: &mut Catalog,
    cancelled: &dyn Fn() -> bool,
) -> Result<Vec<SourceReport>, String> {
    let folder = places.library.as_deref().ok_or("this user has no folder for data")?;
    let in_words = |error: IndexError| error.to_string();
    let mut library = Library::open(folder, Limits::default()).map_err(in_words)?;
    if let Some(passwords) = task.passwords.clone() {
        let access = SpaceTrackAccess::new(task.favourites.clone(), Arc::new(passwords));
        library = library.with_space_track(access);
    }
    let list = &sources.list;
    let read_sources: Vec<Source> =
        list.iter().filter(|source| task.ask.contains(&source.name)).cloned().collect();
    let now =
        if task.awaits_log_in { after_pause(&library, &read_sources, now, cancelled) } else { now };
    // If the disk is full, the stored elements stay in use.
    let refreshed = library.refresh(&read_sources, now, task.forced, cancelled);
    sources.problems.extend(refreshed.err().map(in_words));
    library.read_again(list, &task.ask);
    Ok(library.load_into(list, catalog))
}

/// Waits until the servers of `sources` accept another log-in, and returns the time after the wait.
/// The operator may type a password seconds after a refused one. Does not wait for longer limits.
fn after_pause(
    library: &Library,
    sources: &[Source],
    now: Timestamp,
    cancelled: &dyn Fn() -> bool,
) -> Timestamp {
    let is_near = |time: &Timestamp| *time > now && time.duration_since(now) <= LOG_IN_PAUSE;
    let times = sources.iter().filter_map(|source| library.not_before(source, now)).filter(is_near);
    let Some(time) = times.max() else { return now };
    let pause = Duration::try_from(time.duration_since(now)).unwrap_or_default();
    let start = std::time::Instant::now();
    while start.elapsed() < pause && !cancelled() {
        std::thread::sleep(Duration::from_millis(50));
    }
    time
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::{
        passwords::{account, tests::passwords},
        *,
    };
    use crate::{
        library::PasswordStore as _,
        orbit::{FetchProblem, RefreshHours, write_omm_json},
        secret::Secret,
        transfer::{Account, Keyring, KeyringError, MemoryKeyring, SecretString},
    };

    const ISS: u32 = 25_544;

    /// Returns the epoch of the ISS in [`Fixture::newer_file`].
    fn own_epoch() -> Timestamp {
        "2026-08-12T10:00:00Z".parse().unwrap()
    }

    fn iss_epoch(catalog: &Catalog) -> Timestamp {
        catalog.get(ISS).unwrap().epoch()
    }

    struct Fixture {
        folder: tempfile::TempDir,
        places: Places,
    }

    impl Fixture {
        fn new() -> Self {
            let folder = tempfile::tempdir().unwrap();
            let station = folder.path().join("config/station.toml");
            let places = Places::new(Some(&station), Some(folder.path().join("data")));
            Self { folder, places }
        }

        fn run(&self, task: &Task) -> Outcome {
            let now = "2026-08-12T12:00:00Z".parse().unwrap();
            carry_out(&self.places, task, None, now, &|| false)
        }

        /// Returns a source whose file has the ISS a day after the bundled elements.
        fn newer_file(&self) -> Source {
            self.file("own", "2026-08-12T10:00:00.000000")
        }

        /// Returns a source whose file has the ISS at this epoch.
        fn file(&self, name: &str, epoch: &str) -> Source {
            let bundled = bundled().unwrap();
            let mut text = Vec::new();
            write_omm_json([bundled.get(ISS).unwrap()], &mut text).unwrap();
            let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
            list[0]["EPOCH"] = epoch.into();
            let path = self.folder.path().join(format!("{name}.json"));
            fs::write(&path, list.to_string()).unwrap();
            Source { name: name.to_owned(), place: SourcePlace::File(path), refresh: None }
        }
    }

    #[test]
    fn without_sources_the_bundled_elements_are_there_and_nothing_is_written() {
        let fixture = Fixture::new();
        let outcome = fixture.run(&Task::default());
        assert!(iss_epoch(&outcome.catalog) < own_epoch());
        assert!(outcome.bundled_problem.is_none() && outcome.sources.problems.is_empty());
        assert_eq!(fs::read_dir(fixture.folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn an_added_source_is_kept_and_its_newer_elements_win() {
        let fixture = Fixture::new();
        let list = Some(vec![fixture.newer_file()]);
        let first = fixture.run(&Task { list, ask: vec!["own".to_owned()], ..Task::default() });
        for outcome in [first, fixture.run(&Task::default())] {
            assert_eq!(iss_epoch(&outcome.catalog), own_epoch());
            assert_eq!(outcome.catalog.len(), 16_089);
            assert_eq!(outcome.sources.reports[0].objects(), 1);
            assert!(outcome.sources.is_free());
        }
        let removed = fixture.run(&Task { list: Some(Vec::new()), ..Task::default() });
        assert!(iss_epoch(&removed.catalog) < own_epoch());
        assert!(removed.sources.list.is_empty());
    }

    #[test]
    fn a_source_counts_its_satellites_with_newer_sets_elsewhere() {
        let fixture = Fixture::new();
        let newer_elsewhere = |list: &[&Source]| -> Vec<usize> {
            let list = Some(list.iter().copied().cloned().collect());
            let outcome = fixture.run(&Task { list, ..Task::default() });
            outcome.sources.reports.iter().map(|report| report.newer_elsewhere).collect()
        };
        let (old, new) = (fixture.file("old", "2026-08-01T10:00:00.000000"), fixture.newer_file());
        assert_eq!(newer_elsewhere(&[&old]), [1], "the bundled set is newer");
        assert_eq!(newer_elsewhere(&[&new]), [0]);
        let later = fixture.file("later", "2026-08-12T11:00:00.000000");
        assert_eq!(newer_elsewhere(&[&new, &later]), [1, 0], "a source that is read after it");
    }

    #[test]
    fn a_set_that_is_replaced_is_kept() {
        let fixture = Fixture::new();
        let before = fixture.run(&Task::default()).catalog;
        let list = Some(vec![fixture.newer_file()]);
        let mut after = fixture.run(&Task { list, ..Task::default() }).catalog;
        keep_superseded(&fixture.places, &mut after, Some(&before));
        let history = History::new(&fixture.folder.path().join("data"));
        let older = history.sets_of(ISS);
        assert_eq!(older.len(), 1, "once, though both catalogs had it");
        assert_eq!(older[0].source, crate::orbit::BUNDLED_SOURCE);
        assert_eq!(older[0].elements.epoch(), iss_epoch(&before));
    }

    #[test]
    fn a_server_that_failed_is_not_asked_by_itself_for_its_other_sources() {
        let now: Timestamp = "2026-08-12T12:00:00Z".parse().unwrap();
        let refresh = Some(RefreshHours::from(2));
        let list =
            ["active", "weather"].map(|group| Source { refresh, ..Source::celestrak(group) });
        let library = Library::open(Path::new("/no/such"), Limits::default()).unwrap();
        let (_, reports) = library.load(&list);
        let mut sources = Sources { list: list.to_vec(), reports, ..Sources::default() };
        assert_eq!(due_by_themselves(&sources, now), ["active", "weather"]);
        sources.reports[0].failures = 1;
        sources.reports[0].next_fetch = now.checked_add(jiff::SignedDuration::from_hours(1)).ok();
        assert_eq!(due_by_themselves(&sources, now), [""; 0]);
        sources.reports[0].failures = 0;
        assert_eq!(due_by_themselves(&sources, now), ["weather"]);
        sources.list[1].refresh = None;
        assert_eq!(due_by_themselves(&sources, now), [""; 0]);
    }

    fn space_track() -> Source {
        let place = SourcePlace::SpaceTrack("op".to_owned());
        Source { name: "Space-Track".to_owned(), place, refresh: None }
    }

    #[test]
    fn a_password_that_is_missing_or_locked_is_told_and_no_server_is_asked() {
        /// Keyring that waits for its operator longer than any request.
        struct Locked;

        impl Keyring for Locked {
            fn get(&self, _: &Account) -> Result<Option<SecretString>, KeyringError> {
                std::thread::sleep(Duration::from_secs(5));
                Ok(None)
            }

            fn set(&self, _: &Account, _: &SecretString) -> Result<(), KeyringError> {
                Ok(())
            }

            fn remove(&self, _: &Account) -> Result<(), KeyringError> {
                Ok(())
            }
        }

        let locked = FetchProblem::Keyring(KeyringError::NoAnswer.to_string());
        let keyrings: [(Arc<dyn Keyring>, _); 2] = [
            (Arc::new(MemoryKeyring::default()), FetchProblem::NoPassword),
            (Arc::new(Locked), locked),
        ];
        for (keyring, problem) in keyrings {
            let fixture = Fixture::new();
            let task = |favourites| Task {
                list: Some(vec![space_track(), fixture.newer_file()]),
                ask: vec!["Space-Track".to_owned()],
                favourites,
                passwords: Some(passwords(Arc::clone(&keyring))),
                forced: true,
                ..Task::default()
            };
            let outcome = fixture.run(&task(vec![ISS]));
            assert_eq!(outcome.sources.reports[0].fetch_problem, Some(problem));
            assert_eq!(iss_epoch(&outcome.catalog), own_epoch(), "the other source is read");
        }
    }

    #[test]
    fn the_password_goes_with_the_last_source_of_its_log_in() {
        let keyring = Arc::new(MemoryKeyring::default());
        let passwords = passwords(Arc::clone(&keyring) as Arc<dyn Keyring>);
        let fixture = Fixture::new();
        let run = |list: Vec<Source>| {
            let passwords = Some(passwords.clone());
            fixture.run(&Task { list: Some(list), passwords, ..Task::default() })
        };
        let renamed = Source { name: "again".to_owned(), ..space_track() };
        run(vec![space_track()]);
        let secret = Secret::new("hunter2");
        passwords.take("op", &secret, true);
        passwords.accepted("op", &secret);
        run(vec![renamed]);
        assert_eq!(passwords.get("op"), Ok(secret), "another source uses it");
        assert_eq!(run(Vec::new()).sources.problems, [""; 0]);
        assert_eq!(passwords.get("op"), Err(FetchProblem::NoPassword));
        assert!(keyring.get(&account("op")).unwrap().is_none());
    }

    #[test]
    fn elements_are_read_where_no_request_can_be_recorded() {
        let fixture = Fixture::new();
        let data = fixture.folder.path().join("data");
        let list = vec![fixture.newer_file(), space_track()];
        let ask = || Task {
            list: Some(list.clone()),
            ask: vec!["Space-Track".to_owned()],
            passwords: Some(passwords(Arc::new(MemoryKeyring::default()))),
            forced: true,
            ..Task::default()
        };
        assert_eq!(fixture.run(&ask()).sources.problems, [""; 0]);
        // A folder blocks the place of the index.
        let old = whole_file::old(&data.join("index.toml"));
        let _ = fs::remove_file(&old);
        fs::create_dir_all(old.join("x")).unwrap();
        let outcome = fixture.run(&ask());
        assert_eq!(outcome.sources.problems.len(), 1);
        assert_eq!(iss_epoch(&outcome.catalog), own_epoch());
        assert_eq!(outcome.sources.reports.len(), 2);
    }

    #[test]
    fn copied_elements_stay_when_their_file_goes() {
        let fixture = Fixture::new();
        let own = fixture.newer_file();
        let SourcePlace::File(path) = &own.place else { unreachable!() };
        let text = fs::read_to_string(path).unwrap();
        for (name, copied) in
            [("Own, 1", Copied::File(path.clone())), ("pasted", Copied::Text(text))]
        {
            let copy = Some((name.to_owned(), copied.clone()));
            let outcome = fixture.run(&Task { copy, ..Task::default() });
            assert_eq!(outcome.sources.problems, [""; 0]);
            fs::write(path, "").unwrap();
            let outcome = fixture.run(&Task::default());
            assert_eq!(iss_epoch(&outcome.catalog), own_epoch());
            let copy = Some((name.to_owned(), copied));
            let again = fixture.run(&Task { copy, ..Task::default() });
            assert!(!again.sources.problems.is_empty(), "the name is taken");
        }
        let outcome = fixture.run(&Task::default());
        assert_eq!(outcome.sources.list.len(), 2);
        let copy = Some(("gone".to_owned(), Copied::File("/no/such/file".into())));
        let outcome = fixture.run(&Task { copy, ..Task::default() });
        assert!(!outcome.sources.problems.is_empty() && outcome.sources.list.len() == 2);
    }

    #[test]
    fn a_source_that_is_not_there_says_so_and_costs_only_itself() {
        let fixture = Fixture::new();
        let missing = Source {
            name: "missing".to_owned(),
            place: SourcePlace::File("/no/such/file.tle".into()),
            refresh: None,
        };
        let list = Some(vec![missing, fixture.newer_file()]);
        let outcome = fixture.run(&Task { list, ..Task::default() });
        assert!(outcome.sources.reports[0].files[0].problem.is_some());
        assert_eq!(outcome.sources.reports[1].objects(), 1);
        assert_eq!(outcome.catalog.len(), 16_089);
    }

    #[test]
    fn a_source_whose_reading_ended_the_program_is_read_when_it_is_asked_for() {
        let fixture = Fixture::new();
        let own = fixture.newer_file();
        fixture.run(&Task { list: Some(vec![own.clone()]), ..Task::default() });
        let note = fixture.folder.path().join("data/reading.toml");
        assert_eq!(fs::read(&note).unwrap(), b"", "the reading came to its end");
        // Leave the note like a program that ends at this point.
        fs::write(&note, toml::to_string(&own).unwrap()).unwrap();
        for _ in 0..2 {
            let outcome = fixture.run(&Task::default());
            assert!(outcome.sources.reports[0].is_set_aside);
            assert!(iss_epoch(&outcome.catalog) < own_epoch());
        }
        let outcome = fixture.run(&Task { ask: vec!["own".to_owned()], ..Task::default() });
        assert!(!outcome.sources.reports[0].is_set_aside);
        assert_eq!(iss_epoch(&outcome.catalog), own_epoch());
    }

    #[test]
    fn a_list_that_cannot_be_read_takes_no_change() {
        let fixture = Fixture::new();
        fs::create_dir_all(fixture.folder.path().join("config")).unwrap();
        fs::write(fixture.folder.path().join("config/sources.toml"), "source = 7").unwrap();
        let outcome = fixture.run(&Task::default());
        assert!(outcome.sources.is_locked && !outcome.sources.problems.is_empty());
        assert_eq!(outcome.catalog.len(), 16_089);
    }

    #[test]
    fn a_list_that_cannot_be_kept_leaves_the_one_on_disk() {
        let fixture = Fixture::new();
        let own = fixture.newer_file();
        // A file blocks the place of the folder.
        fs::write(fixture.folder.path().join("config"), "").unwrap();
        let outcome = fixture.run(&Task { list: Some(vec![own]), ..Task::default() });
        assert!(!outcome.sources.problems.is_empty() && outcome.sources.list.is_empty());
    }

    #[test]
    fn one_problem_does_not_hide_another() {
        let fixture = Fixture::new();
        let own = fixture.newer_file();
        // A file blocks the place of the folder.
        fs::write(fixture.folder.path().join("config"), "").unwrap();
        let problems = |set: Option<SetChoice>| {
            let task = Task { list: Some(vec![own.clone()]), set, ..Task::default() };
            let job = start(&fixture.places, task, None, own_epoch(), Arc::new(|| {}));
            job.wait(std::time::Duration::from_mins(1)).unwrap().sources.problems
        };
        let of_list = problems(None);
        assert!(!of_list.is_empty());
        let not_held = SetChoice::Older { catalog_number: ISS, epoch: own_epoch() };
        let texts = problems(Some(not_held));
        assert_eq!(texts.strip_prefix(&*of_list).map(<[String]>::len), Some(1), "{texts:?}");
    }

    #[test]
    fn a_machine_without_a_home_has_the_bundled_elements() {
        let places = Places { list: None, library: None };
        let now = "2026-08-12T12:00:00Z".parse().unwrap();
        let task = Task { list: Some(Vec::new()), ..Task::default() };
        let outcome = carry_out(&places, &task, None, now, &|| false);
        assert_eq!(outcome.catalog.len(), 16_089);
        assert!(!outcome.sources.problems.is_empty());
    }
}
