//! The part of HTTP/1.1 that a scrape needs: one request for each connection, without a body.

/// Max size of a request with its headers, bytes.
pub(super) const MAX_REQUEST: usize = 8192;

/// Path of the metrics.
const PATH: &str = "/metrics";
/// Content type of `OpenMetrics`.
const OPEN_METRICS: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// A request that Azel understands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Request {
    Get,
    /// Request for the headers alone.
    Head,
}

/// Refusal of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The bytes are no request.
    Malformed,
    NotFound,
    /// The method would change something, or is unknown.
    Method,
    /// The request did not arrive in time.
    Late,
    TooLarge,
    Version,
    /// The metrics could not be written as text.
    Broken,
}

impl Refusal {
    /// Returns the status line, without the version, and an explanation for a person.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Malformed => ("400 Bad Request", "This is no HTTP request."),
            Self::NotFound => ("404 Not Found", "The metrics are at /metrics."),
            Self::Method => ("405 Method Not Allowed", "Only GET and HEAD are allowed."),
            Self::Late => ("408 Request Timeout", "The request did not arrive in time."),
            Self::TooLarge => ("431 Request Header Fields Too Large", "The request is too large."),
            Self::Version => ("505 HTTP Version Not Supported", "Use HTTP/1.1."),
            Self::Broken => ("500 Internal Server Error", "The metrics cannot be written."),
        }
    }

    /// Returns the response.
    pub(super) fn response(self) -> Vec<u8> {
        let (status, explanation) = self.words();
        let allow = if self == Self::Method { "Allow: GET, HEAD\r\n" } else { "" };
        let body = format!("{explanation}\n");
        let mut response = head(status, "text/plain; charset=utf-8", body.len(), allow);
        response.push_str(&body);
        response.into_bytes()
    }
}

impl Request {
    /// Returns the response with the metrics.
    pub(super) fn response(self, metrics: &str) -> Vec<u8> {
        let mut response = head("200 OK", OPEN_METRICS, metrics.len(), "");
        match self {
            Self::Get => response.push_str(metrics),
            Self::Head => {}
        }
        response.into_bytes()
    }
}

fn head(status: &str, content_type: &str, length: usize, more: &str) -> String {
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: {content_type}\r\nContent-Length: {length}\r\n\
         Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n{more}\
         Connection: close\r\n\r\n"
    )
}

/// Returns the request in the bytes that have arrived so far; `None` while it is incomplete.
pub(super) fn parse(bytes: &[u8]) -> Option<Result<Request, Refusal>> {
    // Judge the first line at once, so that garbage does not occupy a connection.
    let line = bytes.iter().position(|byte| *byte == b'\n');
    let first = bytes.get(..line.unwrap_or(bytes.len())).unwrap_or_default();
    if !first.iter().all(|byte| byte.is_ascii_graphic() || matches!(byte, b' ' | b'\r')) {
        return Some(Err(Refusal::Malformed));
    }
    let is_too_large = bytes.len() >= MAX_REQUEST;
    if line.is_none() {
        return is_too_large.then_some(Err(Refusal::TooLarge));
    }
    let request = std::str::from_utf8(first).map_err(|_| Refusal::Malformed).and_then(judge);
    let is_complete =
        bytes.windows(2).any(|end| end == b"\n\n") || bytes.windows(3).any(|end| end == b"\n\r\n");
    match request {
        // The connection ends without a look at the headers.
        Err(Refusal::Malformed) => Some(Err(Refusal::Malformed)),
        request if is_complete => Some(request),
        _ => is_too_large.then_some(Err(Refusal::TooLarge)),
    }
}

/// Returns the request of a first line.
fn judge(line: &str) -> Result<Request, Refusal> {
    let mut words = line.trim_end_matches('\r').split(' ');
    let (Some(method), Some(target), Some(version), None) =
        (words.next(), words.next(), words.next(), words.next())
    else {
        return Err(Refusal::Malformed);
    };
    let is_method = !method.is_empty() && method.bytes().all(|byte| byte.is_ascii_uppercase());
    if !is_method || !version.starts_with("HTTP/") {
        return Err(Refusal::Malformed);
    }
    if !matches!(version, "HTTP/1.1" | "HTTP/1.0") {
        return Err(Refusal::Version);
    }
    // A proxy sends the whole address.
    let path = match target.strip_prefix("http://") {
        Some(rest) => rest.find('/').and_then(|start| rest.get(start..)).unwrap_or("/"),
        None => target,
    };
    let path = path.split_once('?').map_or(path, |(path, _)| path);
    match method {
        _ if path != PATH => Err(Refusal::NotFound),
        "GET" => Ok(Request::Get),
        "HEAD" => Ok(Request::Head),
        _ => Err(Refusal::Method),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_request_is_judged_by_its_first_line() {
        for (line, expected) in [
            ("GET /metrics HTTP/1.1", Ok(Request::Get)),
            ("GET /metrics HTTP/1.0", Ok(Request::Get)),
            ("GET /metrics?format=x HTTP/1.1", Ok(Request::Get)),
            ("GET http://127.0.0.1:9464/metrics HTTP/1.1", Ok(Request::Get)),
            ("HEAD /metrics HTTP/1.1", Ok(Request::Head)),
            ("GET / HTTP/1.1", Err(Refusal::NotFound)),
            ("GET /metrics/ HTTP/1.1", Err(Refusal::NotFound)),
            ("GET http://127.0.0.1:9464 HTTP/1.1", Err(Refusal::NotFound)),
            ("POST /metrics HTTP/1.1", Err(Refusal::Method)),
            ("DELETE /metrics HTTP/1.1", Err(Refusal::Method)),
            ("POST /stop HTTP/1.1", Err(Refusal::NotFound)),
            ("GET /metrics HTTP/2.0", Err(Refusal::Version)),
            ("GET /metrics", Err(Refusal::Malformed)),
            ("GET  /metrics HTTP/1.1", Err(Refusal::Malformed)),
            ("get /metrics HTTP/1.1", Err(Refusal::Malformed)),
            ("P 100 40", Err(Refusal::Malformed)),
            ("", Err(Refusal::Malformed)),
        ] {
            let request = format!("{line}\r\nHost: 127.0.0.1:9464\r\nAccept: */*\r\n\r\n");
            assert_eq!(parse(request.as_bytes()), Some(expected), "{line}");
        }
    }

    #[test]
    fn a_request_may_arrive_in_pieces_and_must_end() {
        let request = b"GET /metrics HTTP/1.1\r\nHost: a\r\n\r\n";
        for length in 0..request.len() {
            assert_eq!(parse(&request[..length]), None, "{length}");
        }
        assert_eq!(parse(request), Some(Ok(Request::Get)));
        assert_eq!(parse(b"GET /metrics HTTP/1.1\n\n"), Some(Ok(Request::Get)));
        let endless = [&request[..request.len() - 2], &[b'a'; MAX_REQUEST]].concat();
        assert_eq!(parse(&endless), Some(Err(Refusal::TooLarge)));
        assert_eq!(parse(&[b'a'; MAX_REQUEST]), Some(Err(Refusal::TooLarge)));
        // A TLS client's first bytes.
        assert_eq!(parse(&[0x16, 0x03, 0x01]), Some(Err(Refusal::Malformed)));
    }

    #[test]
    fn responses_have_the_length_of_their_body() {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let get = text(Request::Get.response("azel 1\n# EOF\n"));
        assert!(get.starts_with("HTTP/1.1 200 OK\r\nContent-Type: application/openmetrics-text; "));
        assert!(get.contains("\r\nContent-Length: 13\r\n"), "{get}");
        assert!(get.ends_with("\r\n\r\nazel 1\n# EOF\n"), "{get}");
        let head = text(Request::Head.response("azel 1\n# EOF\n"));
        assert_eq!(get.strip_suffix("azel 1\n# EOF\n"), Some(&*head));
        let refused = text(Refusal::Method.response());
        assert!(refused.contains("\r\nAllow: GET, HEAD\r\n"), "{refused}");
    }

    proptest! {
        #[test]
        fn any_bytes_are_harmless(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
            let _ = parse(&bytes);
        }
    }
}
