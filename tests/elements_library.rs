//! Element library tested against a real server on loopback.

use std::{
    fs,
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{SocketAddr, TcpListener},
    path::Path,
    sync::{Arc, Mutex},
    thread,
    time::Duration,
};

use azel::{
    library::{Library, Limits},
    orbit::{FetchProblem, Source, SourcePlace, SourceReport},
};
use jiff::{SignedDuration, Timestamp};

const BUNDLED: &[u8] = include_bytes!("../assets/elements/active_2026-08-11.tle.gz");
pub(crate) const LIMITS: Limits = Limits { timeout: Duration::from_secs(20), bytes: 8 << 20 };
const HOUR: SignedDuration = SignedDuration::from_hours(1);

/// Answer of the server to one connection.
pub(crate) enum Reply {
    /// Status, additional header lines, body.
    Whole(u16, String, Vec<u8>),
    /// A body shorter than the length in its header.
    Torn(Vec<u8>),
    /// No answer.
    Silence,
}

pub(crate) fn ok(headers: &str, body: &str) -> Reply {
    Reply::Whole(200, headers.to_owned(), body.as_bytes().to_vec())
}

pub(crate) fn status(status: u16) -> Reply {
    Reply::Whole(status, String::new(), Vec::new())
}

/// A server that gives its replies in order and records the requests.
pub(crate) struct Server {
    address: SocketAddr,
    requests: Arc<Mutex<Vec<String>>>,
}

impl Server {
    pub(crate) fn new(replies: Vec<Reply>) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let requests = Arc::new(Mutex::new(Vec::new()));
        let asked = Arc::clone(&requests);
        let serve = move || {
            for reply in replies {
                let (mut stream, _) = listener.accept().unwrap();
                let mut reader = BufReader::new(stream.try_clone().unwrap());
                let mut request = String::new();
                while !request.ends_with("\r\n\r\n") {
                    assert_ne!(reader.read_line(&mut request).unwrap(), 0);
                }
                let lower = request.to_lowercase();
                let length = lower.split("content-length: ").nth(1);
                let length = length.and_then(|text| text.lines().next()?.parse().ok());
                let mut body = vec![0; length.unwrap_or(0)];
                reader.read_exact(&mut body).unwrap();
                request.push_str(std::str::from_utf8(&body).unwrap());
                asked.lock().unwrap().push(request);
                let (head, body) = match reply {
                    Reply::Whole(status, headers, body) => {
                        (format!("{status} X\r\n{headers}Content-Length: {}", body.len()), body)
                    }
                    Reply::Torn(body) => {
                        (format!("200 X\r\nContent-Length: {}", body.len() + 1), body)
                    }
                    Reply::Silence => {
                        // Wait until the client gives up.
                        drop(reader.read_to_end(&mut Vec::new()));
                        continue;
                    }
                };
                let head = format!("HTTP/1.1 {head}\r\nConnection: close\r\n\r\n");
                // Ignore errors: the client stops reading at its size limit.
                drop(stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(&body)));
            }
        };
        thread::Builder::new().name("test-server".to_owned()).spawn(serve).unwrap();
        Self { address, requests }
    }

    pub(crate) fn url(&self) -> String {
        format!("http://{}", self.address)
    }

    pub(crate) fn source(&self, name: &str) -> Source {
        Source {
            name: name.to_owned(),
            place: SourcePlace::Web(format!("http://{}/{name}", self.address)),
            refresh: None,
        }
    }

    pub(crate) fn requests(&self) -> Vec<String> {
        self.requests.lock().unwrap().clone()
    }
}

pub(crate) fn object(number: u32, day: u32) -> String {
    format!(
        "[{{\"OBJECT_NAME\":\"A\",\"NORAD_CAT_ID\":{number},\"EPOCH\":\"2026-08-{day:02}T00:00:00\",\
         \"MEAN_MOTION\":15.5,\"ECCENTRICITY\":0.001,\"INCLINATION\":51.6,\"RA_OF_ASC_NODE\":0,\
         \"ARG_OF_PERICENTER\":0,\"MEAN_ANOMALY\":0,\"BSTAR\":0}}]"
    )
}

/// Returns a set as `SatNOGS` DB lists it, under the number `listed`.
fn satnogs(listed: u32) -> String {
    format!(
        r#"{{"tle0": "TESTSAT A",
        "tle1": "1 90001U 98067ZZ  26220.25000000  .00001000  00000-0  10000-3 0  9994",
        "tle2": "2 90001  51.6400  10.0000 0004000  90.0000  30.0000 15.50000000000017",
        "tle_source": "SatNOGS", "sat_id": "TEST-0000-0000", "norad_cat_id": {listed}}}"#
    )
}

pub(crate) fn start() -> Timestamp {
    "2026-08-12T12:00:00Z".parse().unwrap()
}

/// Refreshes a source once, then loads it from a library opened again. Returns the number of
/// renewed sources and the report.
fn refresh(
    folder: &Path,
    source: &Source,
    now: Timestamp,
    forced: bool,
    limits: Limits,
) -> (usize, SourceReport) {
    let sources = std::slice::from_ref(source);
    let mut library = Library::open(folder, limits).unwrap();
    let renewed = library.refresh(sources, now, forced, &|| false).unwrap();
    let (_, mut reports) = Library::open(folder, limits).unwrap().load(sources);
    (renewed, reports.remove(0))
}

#[test]
fn a_list_of_satnogs_is_a_source_and_its_bad_sets_cost_themselves() {
    let folder = tempfile::tempdir().unwrap();
    let list = format!("[{}, {}]", satnogs(90_001), satnogs(5));
    let server = Server::new(vec![ok("", &list)]);
    let (renewed, report) =
        refresh(folder.path(), &server.source("satnogs"), start(), false, LIMITS);
    assert_eq!((renewed, report.objects(), report.refused()), (1, 1, 1));
    let refusal = report.files[0].merge.refused[0].reason.to_string();
    assert_eq!(refusal, "it is listed as 5, but its lines are of 90001");
    assert_eq!(report.newest_epoch, Some("2026-08-08T06:00:00Z".parse().unwrap()));
}

#[test]
fn a_set_for_a_launch_to_come_does_not_make_later_answers_older() {
    let folder = tempfile::tempdir().unwrap();
    let (ahead, today) = (object(6, 30), object(5, 11));
    let both = format!("[{},{}]", ahead.trim_matches(['[', ']']), today.trim_matches(['[', ']']));
    let server = Server::new(vec![ok("", &both), ok("", &object(5, 12)), ok("", &object(5, 11))]);
    let source = server.source("satnogs");
    let ask = |hours| refresh(folder.path(), &source, start() + HOUR * hours, false, LIMITS).1;
    assert_eq!(ask(0).fetch_problem, None);
    assert_eq!(ask(2).fetch_problem, None, "the launch was taken off the list");
    assert_eq!(ask(4).fetch_problem, Some(FetchProblem::Older));
}

#[test]
fn an_answer_is_not_judged_by_one_of_its_sets() {
    let folder = tempfile::tempdir().unwrap();
    let list = |sets: &[(u32, u32)]| {
        let objects = sets
            .iter()
            .map(|(number, day)| object(*number, *day).trim_matches(['[', ']']).to_owned());
        format!("[{}]", objects.collect::<Vec<_>>().join(","))
    };
    let server = Server::new(vec![
        ok("", &list(&[(5, 10), (6, 10), (7, 12)])),
        // Both sets are newer; object 7, which had the newest set, has left the list.
        ok("", &list(&[(5, 11), (6, 11)])),
        // One set is newer and one is older. In the last list, both are older.
        ok("", &list(&[(5, 12), (6, 10)])),
        ok("", &list(&[(5, 10), (6, 10)])),
    ]);
    let source = server.source("mixed");
    let ask = |hours| refresh(folder.path(), &source, start() + HOUR * hours, false, LIMITS).1;
    let problems = [0, 2, 4, 6].map(|hours| ask(hours).fetch_problem);
    assert_eq!(problems, [None, None, None, Some(FetchProblem::Older)]);
}

#[test]
fn elements_are_kept_and_only_asked_for_when_they_changed() {
    let folder = tempfile::tempdir().unwrap();
    let marks = "ETag: \"one\"\r\nLast-Modified: Wed, 12 Aug 2026 10:00:00 GMT\r\n";
    let server = Server::new(vec![
        ok(marks, &object(5, 11)),
        status(304),
        ok("", &object(5, 12)),
        ok("", &object(5, 10)),
    ]);
    let source = server.source("weather");
    let ask =
        |hours, forced| refresh(folder.path(), &source, start() + HOUR * hours, forced, LIMITS);
    let (renewed, report) = ask(0, false);
    assert_eq!((renewed, report.objects(), report.refused()), (1, 1, 0));
    assert_eq!((report.as_of, report.fetch_problem), (Some(start()), None));
    assert_eq!(report.next_fetch, Some(start() + HOUR * 2));
    assert_eq!(report.newest_epoch, Some("2026-08-11T00:00:00Z".parse().unwrap()));

    let (renewed, report) = ask(1, false);
    assert_eq!((renewed, server.requests().len()), (0, 1), "asked too early");
    assert_eq!(report.age_s(start() + HOUR), Some(3_600.0));

    let (renewed, report) = ask(2, false);
    assert_eq!((renewed, report.objects(), report.as_of), (0, 1, Some(start() + HOUR * 2)));
    let (renewed, report) = ask(3, true);
    assert_eq!((renewed, report.as_of), (1, Some(start() + HOUR * 3)));
    let (renewed, report) = ask(4, true);
    assert_eq!((renewed, report.fetch_problem), (0, Some(FetchProblem::Older)));
    assert_eq!(report.newest_epoch, Some("2026-08-12T00:00:00Z".parse().unwrap()));

    let requests: Vec<_> = server.requests().iter().map(|text| text.to_lowercase()).collect();
    assert!(requests[0].starts_with("get /weather http/1.1\r\n"), "{}", requests[0]);
    assert!(requests[0].contains("user-agent: azel/"), "{}", requests[0]);
    assert!(!requests[0].contains("if-"), "{}", requests[0]);
    assert!(requests[1].contains("if-none-match: \"one\"\r\n"), "{}", requests[1]);
    assert!(requests[1].contains("if-modified-since: wed, 12 aug 2026 10:00:00 gmt\r\n"));
    assert!(requests[2].contains("if-none-match: \"one\"\r\n"), "a 304 keeps the marks");
    assert!(!requests[3].contains("if-"), "the old marks are of the old elements");
}

#[test]
fn a_server_that_says_no_is_left_alone_for_all_its_sources() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::new(vec![status(403), ok("", &object(5, 11))]);
    let sources = [server.source("one"), server.source("two")];
    let mut library = Library::open(folder.path(), LIMITS).unwrap();
    let mut ask = |hours, forced| {
        let now = start() + HOUR * hours;
        library.refresh(&sources[..=usize::from(hours == 0)], now, forced, &|| false).unwrap()
    };
    assert_eq!((ask(0, false), server.requests().len()), (0, 1));
    assert_eq!((ask(1, false), server.requests().len()), (0, 1));
    let (_, reports) = Library::open(folder.path(), LIMITS).unwrap().load(&sources);
    assert_eq!(reports[0].fetch_problem, Some(FetchProblem::Answer(403)));
    assert_eq!((reports[0].next_fetch, reports[0].as_of), (Some(start() + HOUR * 2), None));
    assert_eq!((&reports[1].fetch_problem, reports[1].next_fetch), (&None, None));
    assert_eq!((ask(1, true), server.requests().len()), (1, 2));
}

#[test]
fn whatever_goes_wrong_leaves_what_was_held() {
    let folder = tempfile::tempdir().unwrap();
    let moved = "Location: /again\r\n".to_owned();
    let short = Limits { timeout: Duration::from_millis(200), ..LIMITS };
    let small = Limits { bytes: 2_000, ..LIMITS };
    let cases = [
        (status(500), LIMITS, "the server answered 500"),
        (status(404), LIMITS, "the server answered 404"),
        (Reply::Whole(302, moved, Vec::new()), LIMITS, "the server answered 302"),
        (Reply::Silence, short, "no answer: timeout"),
        (Reply::Torn(object(5, 12).into_bytes()), LIMITS, "no answer: "),
        (ok("", "<html>The data has not changed.</html>"), LIMITS, "the answer holds no elements"),
        (ok("", ""), LIMITS, "the answer holds no elements"),
        (ok("Content-Encoding: gzip\r\n", "no gzip"), LIMITS, "no answer: "),
        (ok("", &" ".repeat(3_000)), small, "the answer is larger than 2000 bytes"),
        (
            Reply::Whole(200, "Content-Encoding: gzip\r\n".to_owned(), BUNDLED.to_vec()),
            Limits { bytes: 1 << 20, ..LIMITS },
            "the answer is larger than 1048576 bytes",
        ),
    ];
    let mut replies = vec![ok("", &object(5, 11))];
    let mut expected = Vec::new();
    for (reply, limits, text) in cases {
        replies.push(reply);
        expected.push((limits, text));
    }
    let server = Server::new(replies);
    let source = server.source("active");
    assert_eq!(refresh(folder.path(), &source, start(), false, LIMITS).0, 1);
    for (hours, (limits, text)) in (2..).step_by(2).zip(expected) {
        let now = start() + HOUR * hours;
        let (renewed, report) = refresh(folder.path(), &source, now, false, limits);
        assert_eq!((renewed, report.objects()), (0, 1), "{text}");
        assert_eq!(report.age_s(now), Some(f64::from(hours) * 3_600.0), "{text}");
        let problem = report.fetch_problem.unwrap().to_string();
        assert!(problem.starts_with(text), "{problem}, not {text}");
    }
    // Address of a closed listener.
    let gone = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let source = Source {
        name: "gone".into(),
        place: SourcePlace::Web(format!("http://{gone}/")),
        refresh: None,
    };
    let (_, report) = refresh(folder.path(), &source, start(), false, LIMITS);
    assert!(matches!(report.fetch_problem, Some(FetchProblem::Unreachable(_))));
}

#[test]
fn the_whole_catalog_comes_over_the_wire() {
    let folder = tempfile::tempdir().unwrap();
    let packed = Reply::Whole(200, "Content-Encoding: gzip\r\n".to_owned(), BUNDLED.to_vec());
    let server = Server::new(vec![packed]);
    let (renewed, report) =
        refresh(folder.path(), &server.source("active"), start(), false, LIMITS);
    assert_eq!((renewed, report.objects(), report.refused()), (1, 16_089, 0));
}

#[test]
fn files_folders_and_servers_make_one_catalog() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("sets")).unwrap();
    fs::write(path("own.json"), object(5, 12)).unwrap();
    fs::write(path("sets/b.JSON"), object(5, 11)).unwrap();
    fs::write(path("sets/a.txt"), object(6, 11) + "\n[{}]").unwrap();
    fs::write(path("sets/notes.md"), "[{}]").unwrap();
    fs::create_dir(path("sets/c.tle")).unwrap();
    let source = |name: &str, place| Source { name: name.to_owned(), place, refresh: None };
    let sources = [
        source("own", SourcePlace::File(path("own.json"))),
        source("sets", SourcePlace::Folder(path("sets"))),
        source("lost", SourcePlace::File(path("lost.tle"))),
        source("nowhere", SourcePlace::Folder(path("nowhere"))),
        Source::celestrak("active"),
    ];
    let (catalog, reports) = Library::open(&path("library"), LIMITS).unwrap().load(&sources);
    assert_eq!(catalog.groups_of(5).collect::<Vec<_>>(), ["own", "sets"]);
    let counts: Vec<_> =
        reports.iter().map(|report| (report.objects(), report.refused())).collect();
    // One entry of the folder is not an object. Elements older than the operator's own are not
    // refused.
    assert_eq!(counts, [(1, 0), (2, 1), (0, 0), (0, 0), (0, 0)]);
    let older = |report: &SourceReport| report.files.iter().map(|file| file.merge.older).sum();
    assert_eq!(reports.iter().map(older).collect::<Vec<usize>>(), [0, 1, 0, 0, 0]);
    let names: Vec<_> = reports[1].files.iter().map(|file| file.path.clone()).collect();
    assert_eq!(names, [path("sets/a.txt"), path("sets/b.JSON")]);
    assert!(reports[0].as_of.is_some() && reports[1].as_of.is_some());
    assert!(reports[2].files[0].problem.is_some() && reports[3].files[0].problem.is_some());
    assert!(reports[4].files.is_empty() && reports[4].as_of.is_none());
}

#[test]
fn a_cancelled_round_asks_nobody() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::new(vec![status(500)]);
    let mut library = Library::open(folder.path(), LIMITS).unwrap();
    assert_eq!(library.refresh(&[server.source("a")], start(), true, &|| true).unwrap(), 0);
    assert!(server.requests().is_empty());
}
