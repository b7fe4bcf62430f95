//! Space-Track as a source, against a server on loopback.

use std::{
    fs::{self, File},
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
    sync::{Arc, Mutex},
};

use azel::{
    library::{Library, PasswordStore, SpaceTrackAccess},
    orbit::{FetchProblem, RefreshHours, Source, SourcePlace, SourceReport},
    secret::Secret,
};
use jiff::{SignedDuration, Timestamp};

use crate::elements_library::{LIMITS, Reply, Server, object, ok, start, status};

const PASSWORD: &str = "hunter2 &=+%";
const SESSION: &str = "Set-Cookie: chocolatechip=s3ss10n; path=/; secure; HttpOnly\r\n";

fn source() -> Source {
    Source {
        name: "Space-Track".to_owned(),
        place: SourcePlace::SpaceTrack("op@example.org".to_owned()),
        refresh: Some(RefreshHours::from(2)),
    }
}

/// Returns the answers to a log-in, a query with `answer`, and the log-out.
fn visit(answer: Reply) -> [Reply; 3] {
    [ok(SESSION, "\"\""), answer, ok("", "\"Successfully logged out\"")]
}

/// A station with Space-Track as its source.
struct Station {
    folder: tempfile::TempDir,
    server: Server,
    password: Arc<Mutex<Option<&'static str>>>,
    numbers: Vec<u32>,
}

impl Station {
    fn new(replies: impl IntoIterator<Item = Reply>) -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
            server: Server::new(replies.into_iter().collect()),
            password: Arc::new(Mutex::new(Some(PASSWORD))),
            numbers: vec![5, 25_544],
        }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn library(&self) -> Library {
        let password = Arc::clone(&self.password);
        self.library_with(move |user: &str| {
            assert_eq!(user, "op@example.org");
            password.lock().unwrap().map(Secret::new).ok_or(FetchProblem::NoPassword)
        })
    }

    fn library_with(&self, passwords: impl PasswordStore + 'static) -> Library {
        let access = SpaceTrackAccess::new(self.numbers.clone(), Arc::new(passwords));
        let library = Library::open(self.path(), LIMITS).unwrap();
        library.with_space_track(access.with_server(&self.server.url()))
    }

    /// Asks `after_s` seconds after the start. Returns `true` if new elements came, and the report.
    fn ask(&self, after_s: i64, forced: bool) -> (bool, SourceReport) {
        let renewed = self.library().refresh(&[source()], at(after_s), forced, &|| false).unwrap();
        (renewed > 0, self.report())
    }

    fn report(&self) -> SourceReport {
        Library::open(self.path(), LIMITS).unwrap().load(&[source()]).1.remove(0)
    }

    fn first_lines(&self) -> Vec<String> {
        let requests = self.server.requests();
        let first = |request: &String| request.lines().next().unwrap_or_default().to_owned();
        requests.iter().map(first).collect()
    }
}

fn at(after_s: i64) -> Timestamp {
    start() + SignedDuration::from_secs(after_s)
}

#[test]
fn a_visit_logs_in_asks_for_the_favourites_once_and_logs_out() {
    let station = Station::new(visit(ok("", &object(5, 11))));
    let (is_new, report) = station.ask(0, false);
    assert!(is_new);
    assert_eq!((report.objects(), report.fetch_problem.clone()), (1, None));
    assert_eq!((report.as_of, report.next_fetch), (Some(at(0)), Some(at(7200))));
    assert_eq!(
        station.first_lines(),
        [
            "POST /ajaxauth/login HTTP/1.1",
            "GET /basicspacedata/query/class/gp/NORAD_CAT_ID/5,25544/orderby/NORAD_CAT_ID/format/json \
             HTTP/1.1",
            "GET /ajaxauth/logout HTTP/1.1",
        ]
    );
    let requests = station.server.requests();
    let form = requests[0].split("\r\n\r\n").nth(1);
    assert_eq!(form, Some("identity=op%40example.org&password=hunter2+%26%3D%2B%25"));
    for request in &requests[1..] {
        assert!(request.to_lowercase().contains("cookie: chocolatechip=s3ss10n\r\n"), "{request}");
        assert!(!request.contains("hunter2"), "{request}");
    }
}

#[test]
fn the_server_is_asked_once_an_hour_even_if_the_operator_asks_more_often() {
    let replies = [visit(ok("", &object(5, 11))), visit(ok("", &object(5, 12)))];
    let station = Station::new(replies.into_iter().flatten());
    let (_, report) = station.ask(0, false);
    assert_eq!(report.not_before(at(0)), Some(at(3600)));
    for (after_s, forced) in [(1, true), (3599, true), (3600, false)] {
        assert!(!station.ask(after_s, forced).0);
    }
    assert_eq!(station.server.requests().len(), 3);
    assert!(station.ask(3600, true).0);
}

#[test]
fn a_refused_log_in_is_not_repeated_until_the_operator_asks() {
    let refused = || ok("", "{\"Login\":\"Failed\"}");
    let answer = visit(ok("", &object(5, 11)));
    let station = Station::new([refused(), status(401)].into_iter().chain(answer));
    let (_, report) = station.ask(0, false);
    assert_eq!((report.fetch_problem.clone(), report.failures), (Some(FetchProblem::LogIn), 1));
    assert!(report.awaits_operator());
    assert_eq!(source().next_by_itself(Some(&report), at(30)), None);
    assert!(!station.ask(14, true).0, "too soon for another log-in");
    assert!(!station.ask(86_400, false).0, "without the operator");
    assert_eq!(station.first_lines(), ["POST /ajaxauth/login HTTP/1.1"], "no query, no log-out");
    let (_, report) = station.ask(15, true);
    assert_eq!(report.fetch_problem, Some(FetchProblem::LogIn));
    let (is_new, report) = station.ask(30, true);
    assert!(is_new && !report.awaits_operator());
    assert!(source().next_by_itself(Some(&report), at(30)).is_some());
}

#[test]
fn whatever_goes_wrong_leaves_what_was_held_and_no_secret_on_disk() {
    let good = || ok("", &object(5, 11));
    let error = "{\"error\":\"You've violated your query rate limit.\"}";
    let moved = || Reply::Whole(302, "Location: http://127.0.0.1:9/\r\n".to_owned(), Vec::new());
    let refused = || FetchProblem::Refused("You've violated your query rate limit.".to_owned());
    let log_out = || ok("", "");
    let echo = format!("{{\"error\":\"no {PASSWORD}\"}}");
    let cases: Vec<(Vec<Reply>, Option<FetchProblem>)> = vec![
        (visit(ok("", error)).into(), Some(refused())),
        (visit(Reply::Whole(500, String::new(), error.into())).into(), Some(refused())),
        (visit(status(500)).into(), Some(FetchProblem::Answer(500))),
        (visit(moved()).into(), Some(FetchProblem::Answer(302))),
        (visit(Reply::Torn(object(5, 12).into_bytes())).into(), None),
        (vec![moved()], Some(FetchProblem::Answer(302))),
        (vec![ok("", error)], Some(refused())),
        (vec![ok("", &echo)], Some(FetchProblem::Answer(200))),
        (vec![ok("", "\"\"")], Some(FetchProblem::NoSession)),
        (vec![status(503)], Some(FetchProblem::Answer(503))),
        (vec![ok(SESSION, "\"\""), ok("", "[]"), log_out()], None),
    ];
    let (replies, problems): (Vec<_>, Vec<_>) = cases.into_iter().unzip();
    let first: Vec<Reply> = visit(good()).into();
    let station = Station::new(first.into_iter().chain(replies.into_iter().flatten()));
    assert!(station.ask(0, false).0);
    for (place, problem) in (1..).zip(problems) {
        let (is_new, report) = station.ask(place * 7200, true);
        assert!(!is_new && report.fetch_problem.is_some(), "{place}");
        if problem.is_some() {
            assert_eq!(report.fetch_problem, problem, "{place}");
        }
        assert_eq!((report.objects(), report.as_of), (1, Some(at(0))), "{place}");
        assert_eq!(i64::from(report.failures), place);
    }
    for entry in fs::read_dir(station.path()).unwrap() {
        let text = String::from_utf8_lossy(&fs::read(entry.unwrap().path()).unwrap()).into_owned();
        assert!(!text.contains("hunter2") && !text.contains("s3ss10n"), "{text}");
    }
}

#[test]
fn without_a_password_or_favourites_no_server_is_asked() {
    let mut station = Station::new(visit(ok("", &object(5, 11))));
    *station.password.lock().unwrap() = None;
    let (_, report) = station.ask(0, false);
    assert_eq!(report.fetch_problem, Some(FetchProblem::NoPassword));
    let limits = (report.not_before(at(0)), report.next_request(at(0)));
    assert_eq!(limits, (None, None), "no limit has begun");
    let numbers = std::mem::take(&mut station.numbers);
    assert_eq!(station.ask(1, false).1.fetch_problem, Some(FetchProblem::NoFavourites));
    assert_eq!(station.server.requests(), [""; 0]);
    (*station.password.lock().unwrap(), station.numbers) = (Some(PASSWORD), numbers);
    let (is_new, report) = station.ask(2, false);
    assert!(is_new);
    assert_eq!(report.not_before(at(2)), Some(at(3602)));
}

#[test]
fn a_password_goes_to_no_other_computer_in_the_open() {
    let folder = tempfile::tempdir().unwrap();
    let passwords = |_: &str| -> Result<Secret, FetchProblem> { unreachable!("not asked for") };
    let access =
        SpaceTrackAccess::new(vec![5], Arc::new(passwords)).with_server("http://example.org");
    let mut library = Library::open(folder.path(), LIMITS).unwrap().with_space_track(access);
    library.refresh(&[source()], start(), true, &|| false).unwrap();
    let (_, reports) = library.load(&[source()]);
    assert_eq!(reports[0].fetch_problem, Some(FetchProblem::Address));
}

/// Password store that ends the program once the server has answered the log-in, or the whole
/// visit.
struct EndsProgram;

impl PasswordStore for EndsProgram {
    fn get(&self, _: &str) -> Result<Secret, FetchProblem> {
        Ok(Secret::new(PASSWORD))
    }

    fn accepted(&self, _: &str, _: &Secret) {
        panic!("killed after the visit");
    }

    fn refused(&self, _: &str, _: &Secret) {
        panic!("killed after the log-in");
    }
}

#[test]
fn a_program_that_is_killed_in_a_visit_does_not_ask_at_once_when_it_starts() {
    for (replies, end) in [(vec![status(401)], 15), (visit(ok("", &object(5, 11))).into(), 3600)] {
        let requests = replies.len();
        let mut station = Station::new(replies);
        *station.password.lock().unwrap() = None;
        station.ask(-60, false);
        let killed = catch_unwind(AssertUnwindSafe(|| {
            let mut library = station.library_with(EndsProgram);
            let _ = library.refresh(&[source()], at(0), true, &|| false);
        }));
        assert!(killed.is_err());
        assert_eq!(station.report().not_before(at(1)), Some(at(end)));
        station.password = Arc::new(Mutex::new(Some(PASSWORD)));
        assert!(!station.ask(end - 1, true).0);
        assert_eq!(station.server.requests().len(), requests);
    }
}

#[test]
fn no_server_is_asked_while_no_request_can_be_recorded() {
    let station = Station::new(visit(ok("", &object(5, 11))));
    assert!(station.ask(0, false).0);
    // A folder stands in the way of the index.
    let old = station.path().join("index.toml.old");
    let _ = fs::remove_file(&old);
    fs::create_dir_all(old.join("in the way")).unwrap();
    let mut library = station.library();
    assert!(library.refresh(&[source()], at(7200), true, &|| false).is_err());
    let report = library.load(&[source()]).1.remove(0);
    assert!(matches!(report.fetch_problem, Some(FetchProblem::Unrecorded(_))), "{report:?}");
    assert_eq!((report.objects(), station.server.requests().len()), (1, 3));
}

#[test]
fn two_processes_share_one_account_and_its_limits() {
    let station = Station::new(visit(ok("", &object(5, 11))));
    let mut other = station.library();
    let lock = File::create(station.path().join("space-track.lock")).unwrap();
    lock.lock().unwrap();
    let (is_new, report) = station.ask(0, true);
    assert!(!is_new && report.fetch_problem.is_none(), "another process asks");
    drop(lock);
    assert!(station.ask(1, true).0);
    assert_eq!(other.refresh(&[source()], at(60), true, &|| false).unwrap(), 0);
    assert_eq!(station.server.requests().len(), 3, "the other process knows of the visit");
}

#[test]
fn a_clock_that_was_ahead_does_not_block_the_source() {
    let replies = [visit(ok("", &object(5, 11))), visit(ok("", &object(5, 12)))];
    let station = Station::new(replies.into_iter().flatten());
    let year_s = 366 * 86_400;
    assert!(station.ask(year_s, false).0);
    assert_eq!(station.report().not_before(at(0)), None);
    assert!(station.ask(0, false).0);
    assert_eq!(station.report().not_before(at(1)), Some(at(3600)));
}
