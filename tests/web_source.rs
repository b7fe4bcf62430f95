//! Elements from the web as a unit fetches them, from a server on loopback.

use std::{
    io::{BufRead as _, BufReader, Write as _},
    net::TcpListener,
    sync::mpsc,
    thread,
    time::Duration,
};

use azel::transfer::{
    CancellationToken, ElementSource, FetchError, Interruption, KnownHosts, Limits, Trust, fetch,
};

const LIMITS: Limits = Limits {
    connect: Duration::from_secs(10),
    log_in: Duration::from_secs(10),
    request: Duration::from_secs(10),
    file: Duration::from_secs(10),
    file_bytes: 1000,
};

/// Starts a server that gives one answer to one request. If `answer` is empty, the server holds the
/// connection until `end` closes. Returns its address.
fn serve(answer: Vec<u8>, end: mpsc::Receiver<()>) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/tle?GROUP=weather%2C2", listener.local_addr().unwrap());
    let serve = move || {
        let (mut stream, _) = listener.accept().unwrap();
        let lines = BufReader::new(stream.try_clone().unwrap()).lines();
        let mut head = lines.map_while(Result::ok).take_while(|line| !line.is_empty());
        let first = head.next().unwrap_or_default();
        head.for_each(drop);
        if answer.is_empty() {
            // The channel never carries a message; it closes with the test.
            let _ = end.recv();
        }
        let answer =
            if first.starts_with("GET /tle?GROUP=weather%2C2 ") { &answer[..] } else { &[] };
        // Ignore errors: the client may have left.
        let _ = stream.write_all(answer);
    };
    thread::Builder::new().name("server".to_owned()).spawn(serve).unwrap();
    url
}

fn answer(status: &str, headers: &str, body: &[u8]) -> Vec<u8> {
    let length = body.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Length: {length}\r\nConnection: close\r\n{headers}\r\n"
    );
    [head.as_bytes(), body].concat()
}

/// Requests elements from a server that gives `answer`, and returns the result.
fn get(answer: Vec<u8>, limits: Limits, cancel: &CancellationToken) -> Result<Vec<u8>, FetchError> {
    let (_hold, end) = mpsc::sync_channel(0);
    let source = ElementSource::Web { url: serve(answer, end) };
    let known_hosts = KnownHosts::new("/nowhere/known_hosts");
    let trust = Trust { known_hosts, own_authorities: Vec::new() };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let result = runtime.block_on(fetch(&source, &trust, limits, cancel));
    runtime.shutdown_background();
    result.map(|fetched| fetched.bytes)
}

#[test]
fn a_file_comes_as_it_is_up_to_its_limit() {
    let nobody = CancellationToken::new();
    let body = [b'x'; 1000];
    assert_eq!(get(answer("200 OK", "", &body), LIMITS, &nobody).unwrap(), body);
    let error = get(answer("200 OK", "", &[b'x'; 1001]), LIMITS, &nobody).unwrap_err();
    assert!(matches!(error, FetchError::TooLarge(1000)), "{error}");
    let mut torn = answer("200 OK", "", &body);
    torn.truncate(500);
    let error = get(torn, LIMITS, &nobody).unwrap_err();
    assert!(matches!(error, FetchError::NoAnswer(_)), "{error}");
}

#[test]
fn another_answer_than_the_file_is_told() {
    let nobody = CancellationToken::new();
    let error = get(answer("404 Not Found", "", b"gone"), LIMITS, &nobody).unwrap_err();
    assert!(matches!(error, FetchError::Status { status: 404 }), "{error}");
    let moved = answer("301 Moved", "Location: https://example.org/new\r\n", b"");
    let error = get(moved, LIMITS, &nobody).unwrap_err();
    assert!(
        matches!(&error, FetchError::Redirected { destination } if destination == "https://example.org/new"),
        "{error}"
    );
}

#[test]
fn a_server_that_stalls_is_left_by_limit_and_by_cancel() {
    let nobody = CancellationToken::new();
    let file = Duration::from_millis(300);
    let error = get(Vec::new(), Limits { file, ..LIMITS }, &nobody).unwrap_err();
    // The request has one time limit and the fetch has another.
    assert!(
        matches!(
            error,
            FetchError::Interrupted(Interruption::TimedOut(_)) | FetchError::NoAnswer(_)
        ),
        "{error}"
    );
    let cancelled = CancellationToken::new();
    cancelled.cancel();
    let error = get(Vec::new(), LIMITS, &cancelled).unwrap_err();
    assert!(matches!(error, FetchError::Interrupted(Interruption::Cancelled)), "{error}");
}
