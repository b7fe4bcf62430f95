//! Requests of the library of elements over HTTPS.

use std::time::Duration;

use azel::{
    library::{Library, Limits},
    orbit::{FetchProblem, Source, SourcePlace},
};
use jiff::Timestamp;
use rustls::pki_types::CertificateDer;

use super::{
    https_server::{Authority, FILE, HttpsServer},
    unit::elements,
};

const LIMITS: Limits = Limits { timeout: Duration::from_secs(20), bytes: 1 << 20 };

/// Returns the number of objects from `server`, or the reason why there are none.
fn objects(
    server: &HttpsServer,
    trusted: Option<CertificateDer<'static>>,
) -> Result<usize, FetchProblem> {
    let folder = tempfile::tempdir().unwrap();
    let url = format!("https://localhost:{}/{FILE}", server.port);
    let sources =
        [Source { name: "Weather".to_owned(), place: SourcePlace::Web(url), refresh: None }];
    let mut library = Library::open(folder.path(), LIMITS).unwrap();
    if let Some(authority) = trusted {
        library = library.trusting(&[authority]);
    }
    let now: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
    library.refresh(&sources, now, false, &|| false).unwrap();
    // The library saves the reason on disk as well.
    let (catalog, reports) = Library::open(folder.path(), LIMITS).unwrap().load(&sources);
    reports[0].fetch_problem.clone().map_or(Ok(catalog.len()), Err)
}

#[test]
#[ignore = "needs openssl"]
fn elements_come_from_a_server_that_proves_who_it_is_and_from_no_other() {
    let authority = Authority::new("Own");
    let (own, other) = (authority.certificate(), Authority::new("Other").certificate());
    let content = elements(5);
    let certificate = |word| Some((false, word));
    for (name, end, trusted, expected) in [
        ("localhost", 2049, Some(&own), None),
        ("localhost", 2021, Some(&own), certificate("expired")),
        ("elsewhere.example", 2049, Some(&own), certificate("not valid for name \"localhost\"")),
        ("localhost", 2049, Some(&other), Some((true, "no authority"))),
        ("localhost", 2049, None, Some((true, "no authority"))),
    ] {
        let server = HttpsServer::new(&authority, name, end, content.bytes());
        match (objects(&server, trusted.cloned()), expected) {
            (Ok(count), None) => assert_eq!(count, 5),
            (Err(problem), Some((is_unknown, word))) => {
                assert_eq!(problem == FetchProblem::UnknownAuthority, is_unknown, "{problem}");
                assert!(problem.to_string().contains(word), "{problem}");
            }
            (result, _) => panic!("{name} until {end}: {result:?}"),
        }
    }
}
