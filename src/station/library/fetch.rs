//! Requests to element servers, within limits.

use std::{env, io, time::Duration};

use rustls::CertificateError;
use ureq::{
    Agent, Body, Proxy,
    http::{Response, Uri, header},
    tls::{RootCerts, TlsConfig},
};

use super::{disk::read_limited, index::AddressRecord};
use crate::{contract::sources::check_address, orbit::FetchProblem};

/// Limits for requests and files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Timeout of a whole request.
    pub timeout: Duration,
    /// Max size of one unpacked body or one file, bytes.
    pub bytes: u64,
}

impl Default for Limits {
    /// Returns one minute and 64 MB: the whole catalog as XML has 30 MB.
    fn default() -> Self {
        Self { timeout: Duration::from_mins(1), bytes: 64 << 20 }
    }
}

/// Answer of a server.
pub(super) enum ServerAnswer {
    /// The server has nothing newer.
    NotModified,
    /// New content, with its validators for the next request.
    New { body: Vec<u8>, etag: Option<String>, last_modified: Option<String> },
}

/// Returns the host of `url`; empty if `url` has none.
pub(super) fn host(url: &str) -> String {
    let uri: Option<Uri> = url.parse().ok();
    uri.and_then(|uri| uri.host().map(str::to_lowercase)).unwrap_or_default()
}

/// Requests `url` once, conditionally if `record` is given. Follows no redirection: the operator
/// must check an address that has moved.
pub(super) fn fetch(
    url: &str,
    record: Option<&AddressRecord>,
    limits: Limits,
    authorities: &RootCerts,
) -> Result<ServerAnswer, FetchProblem> {
    let agent = agent(url, limits, authorities)?;
    let mut request = agent.get(url);
    for (name, value) in [
        (header::IF_NONE_MATCH, record.and_then(|record| record.etag.as_deref())),
        (header::IF_MODIFIED_SINCE, record.and_then(|record| record.last_modified.as_deref())),
    ] {
        if let Some(value) = value {
            request = request.header(name, value);
        }
    }
    let response = request.call().map_err(|error| unanswered(&error, &agent, url))?;
    match response.status().as_u16() {
        200 => {}
        304 if record.is_some() => return Ok(ServerAnswer::NotModified),
        status => return Err(FetchProblem::Answer(status)),
    }
    let mark = |name| {
        let value = Response::headers(&response).get(name)?.to_str().ok()?;
        Some(value.to_owned())
    };
    let (etag, last_modified) = (mark(header::ETAG), mark(header::LAST_MODIFIED));
    let body = body_of(response, limits)?;
    Ok(ServerAnswer::New { body, etag, last_modified })
}

/// Returns a client for the server of `url`. Fails if Azel may not ask this address.
pub(super) fn agent(
    url: &str,
    limits: Limits,
    authorities: &RootCerts,
) -> Result<Agent, FetchProblem> {
    let is_local = check_address(url)?;
    let mut config = Agent::config_builder()
        .https_only(!is_local)
        .http_status_as_error(false)
        .max_redirects(0)
        .max_redirects_will_error(false)
        .timeout_global(Some(limits.timeout))
        .tls_config(TlsConfig::builder().root_certs(authorities.clone()).build())
        .user_agent(concat!("azel/", env!("CARGO_PKG_VERSION")));
    config = config.proxy(if is_local { None } else { environment_proxy()? });
    Ok(Agent::from(config.build()))
}

/// Environment variables that name a proxy. The first set variable counts.
const PROXY_VARIABLES: [&str; 6] =
    ["ALL_PROXY", "all_proxy", "HTTPS_PROXY", "https_proxy", "HTTP_PROXY", "http_proxy"];
/// Environment variables that list hosts to reach without a proxy.
const NO_PROXY_VARIABLES: [&str; 2] = ["NO_PROXY", "no_proxy"];

/// Returns the proxy of this program's environment.
pub fn environment_proxy() -> Result<Option<Proxy>, FetchProblem> {
    proxy(|name| env::var(name).ok())
}

/// Returns the proxy of the environment, with its exempt hosts. Fails if any proxy is unusable:
/// bypassing a proxy silently could be forbidden.
fn proxy(value: impl Fn(&str) -> Option<String>) -> Result<Option<Proxy>, FetchProblem> {
    let mut first = None;
    for name in PROXY_VARIABLES {
        let Some(text) = value(name).filter(|text| !text.is_empty()) else { continue };
        let proxy = Proxy::new(&text).map_err(|_| FetchProblem::Proxy(name.to_owned()))?;
        first = first.or(Some((name, proxy)));
    }
    let Some((name, proxy)) = first else { return Ok(None) };
    let hosts = NO_PROXY_VARIABLES.into_iter().find_map(value).unwrap_or_default();
    // The HTTP client parses the list too, but keeps blanks after the commas.
    let hosts = hosts.split([',', ' ', '\t']).filter(|host| !host.is_empty());
    let mut own = Proxy::builder(proxy.protocol()).host(proxy.host()).port(proxy.port());
    if let Some(user) = proxy.username() {
        own = own.username(user);
    }
    if let Some(password) = proxy.password() {
        own = own.password(password);
    }
    let own = hosts.fold(own, ureq::ProxyBuilder::no_proxy);
    own.build().map(Some).map_err(|_| FetchProblem::Proxy(name.to_owned()))
}

/// Returns the unpacked body of an answer. The limit applies to unpacked bytes: a small answer may
/// unpack to any size.
pub(super) fn body_of(response: Response<Body>, limits: Limits) -> Result<Vec<u8>, FetchProblem> {
    read_limited(response.into_body().into_reader(), limits.bytes).map_err(|error| {
        match error.kind() {
            io::ErrorKind::FileTooLarge => FetchProblem::TooLarge(limits.bytes),
            _ => FetchProblem::Unreachable(error.to_string()),
        }
    })
}

/// Returns the reason why `agent` got no answer from `url`.
pub(super) fn unanswered(error: &ureq::Error, agent: &Agent, url: &str) -> FetchProblem {
    let cause = match error {
        ureq::Error::Rustls(error) => Some(error),
        ureq::Error::Io(error) => error.get_ref().and_then(|inner| inner.downcast_ref()),
        _ => None,
    };
    match cause {
        Some(rustls::Error::InvalidCertificate(CertificateError::UnknownIssuer)) => {
            FetchProblem::UnknownAuthority
        }
        Some(rustls::Error::InvalidCertificate(certificate_error)) => {
            FetchProblem::Certificate(certificate_error.to_string())
        }
        _ => FetchProblem::Unreachable(format!("{error}{}", way(agent, url))),
    }
}

/// Returns the proxy on the way to `url` as text without its log-in: the proxy may be the silent
/// host.
fn way(agent: &Agent, url: &str) -> String {
    let uri: Option<Uri> = url.parse().ok();
    match (agent.config().proxy(), uri) {
        (Some(proxy), Some(uri)) if !proxy.is_no_proxy(&uri) => {
            format!(", through the proxy {}:{}", proxy.host(), proxy.port())
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_proxy_that_cannot_be_used_is_named() {
        let unusable = |name: &'static str, value: &'static str| {
            proxy(|expected| (expected == name).then(|| value.to_owned())).err()
        };
        let named = |name: &str| Some(FetchProblem::Proxy(name.to_owned()));
        assert_eq!(unusable("ALL_PROXY", "socks5://127.0.0.1:1080"), None);
        assert_eq!(unusable("https_proxy", "http://proxy.example:3128"), None);
        assert_eq!(unusable("HTTPS_PROXY", ""), None);
        assert_eq!(unusable("ALL_PROXY", "gopher://127.0.0.1:70"), named("ALL_PROXY"));
        assert_eq!(unusable("http_proxy", "gopher://127.0.0.1:70"), named("http_proxy"));
    }

    #[test]
    fn a_proxy_keeps_its_log_in_and_passes_the_listed_hosts() {
        let value = |name: &str| match name {
            "HTTPS_PROXY" => Some("http://op%40home:p%3Aw@[::1]:3128".to_owned()),
            "http_proxy" => Some("http://other.example".to_owned()),
            "no_proxy" => Some("localhost, .home.example,192.0.2.7\tlast.example".to_owned()),
            _ => None,
        };
        let proxy = proxy(value).unwrap().unwrap();
        assert_eq!((proxy.host(), proxy.port()), ("[::1]", 3128));
        assert_eq!((proxy.username(), proxy.password()), (Some("op@home"), Some("p:w")));
        for (url, is_direct) in [
            ("https://a.home.example/x", true),
            ("https://192.0.2.7:8443/x", true),
            ("https://last.example/x", true),
            ("https://celestrak.org/x", false),
            ("https://home.example/x", false),
        ] {
            assert_eq!(proxy.is_no_proxy(&url.parse().unwrap()), is_direct, "{url}");
        }
    }
}
