//! Elements from Space-Track: a log-in, one query, and the log-out.
//!
//! Source: the API documentation of www.space-track.org. An account may make less than 30 requests
//! a minute and 300 an hour, and one query of the class `gp` an hour. Space-Track answers a refused
//! log-in with 200 and the reason as JSON. It closes accounts that break the limits.

use std::{fmt, sync::Arc};

use jiff::SignedDuration;
use serde::Deserialize;
use ureq::{
    Agent, Body,
    http::{HeaderValue, Response, header},
};

use super::{
    disk::read_limited,
    fetch::{Limits, body_of, unanswered},
    index::AddressRecord,
};
use crate::{
    contract::sources::{SPACE_TRACK_HOST, log_in_key},
    orbit::{FetchProblem, RequestLimit},
    secret::Secret,
};
const SERVER: &str = "https://www.space-track.org";

/// Max number of objects that a query names. With more objects, Azel asks for all.
const MAX_NUMBERS: usize = 500;
/// Min time between two queries, also for the operator.
const QUERY_PAUSE: SignedDuration = SignedDuration::from_hours(1);
/// Min time between two log-ins. An attempt without a query is a single log-in, so log-ins make at
/// most 4 requests a minute and 240 an hour. Query and log-out add 2 an hour.
pub const LOG_IN_PAUSE: SignedDuration = SignedDuration::from_secs(15);
/// Max size of an answer that reports an error, bytes.
const MAX_ERROR_BYTES: u64 = 64 << 10;
/// Max length of a reason that the server gives, characters.
const MAX_REASON_CHARS: usize = 200;

/// Store of passwords by log-in name.
pub trait PasswordStore: Send + Sync {
    /// Returns the password of `user`. May wait for the operator's keyring.
    fn get(&self, user: &str) -> Result<Secret, FetchProblem>;

    /// Notes that the server accepted the password. Azel calls this after the log-out.
    fn accepted(&self, _user: &str, _password: &Secret) {}

    /// Notes that the server refused the log-in.
    fn refused(&self, _user: &str, _password: &Secret) {}
}

impl<F: Fn(&str) -> Result<Secret, FetchProblem> + Send + Sync> PasswordStore for F {
    fn get(&self, user: &str) -> Result<Secret, FetchProblem> {
        self(user)
    }
}

/// Access to Space-Track.
#[derive(Clone)]
pub struct SpaceTrackAccess {
    server: String,
    /// Catalog numbers of the objects to ask for.
    numbers: Vec<u32>,
    passwords: Arc<dyn PasswordStore>,
}

impl SpaceTrackAccess {
    pub fn new(numbers: Vec<u32>, passwords: Arc<dyn PasswordStore>) -> Self {
        Self { server: SERVER.to_owned(), numbers, passwords }
    }

    /// Sets another server, for tests. Its address must be `https` or on this computer.
    #[must_use]
    pub fn with_server(self, server: &str) -> Self {
        Self { server: server.to_owned(), ..self }
    }

    /// Returns the address of the server.
    pub(super) fn server(&self) -> &str {
        &self.server
    }
}

impl fmt::Debug for SpaceTrackAccess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { server, numbers, .. } = self;
        f.debug_struct("SpaceTrackAccess")
            .field("server", server)
            .field("numbers", &numbers.len())
            .finish_non_exhaustive()
    }
}

/// Returns the key of an account in the index of the library.
pub(super) fn key(user: &str) -> String {
    format!("{SPACE_TRACK_HOST}/{}", log_in_key(user))
}

/// Returns the limits that the requests of `record` started.
pub(super) fn limits(record: &AddressRecord) -> Vec<RequestLimit> {
    let log_in = record.asked_at().map(|time| RequestLimit { time, pause: LOG_IN_PAUSE });
    let query = record.queried_at.map(|time| RequestLimit { time, pause: QUERY_PAUSE });
    log_in.into_iter().chain(query).collect()
}

/// Request that Azel records before sending it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    LogIn,
    Query,
}

/// Visit to Space-Track that has not begun.
pub(super) struct Visit<'a> {
    pub(super) access: &'a SpaceTrackAccess,
    pub(super) agent: Agent,
    pub(super) limits: Limits,
}

impl Visit<'_> {
    /// Logs in as `user`, asks for the objects once, and logs out. Calls `record` before the log-in
    /// and before the query, and sends only recorded requests.
    pub(super) fn run(
        &self,
        user: &str,
        mut record: impl FnMut(Step) -> Result<(), FetchProblem>,
    ) -> Result<Vec<u8>, FetchProblem> {
        if self.access.numbers.is_empty() {
            return Err(FetchProblem::NoFavourites);
        }
        let password = self.access.passwords.get(user)?;
        record(Step::LogIn)?;
        let cookie = self.log_in(user.trim(), &password).inspect_err(|problem| {
            if *problem == FetchProblem::LogIn {
                self.access.passwords.refused(user, &password);
            }
        })?;
        let answer = record(Step::Query).and_then(|()| self.query(&cookie));
        // If the log-out fails, the server ends the session some time later.
        let _ = self.get("/ajaxauth/logout", &cookie);
        self.access.passwords.accepted(user, &password);
        answer
    }

    fn log_in(&self, user: &str, password: &Secret) -> Result<HeaderValue, FetchProblem> {
        let url = format!("{}/ajaxauth/login", self.access.server);
        let form = [("identity", user), ("password", password.reveal())];
        let response = self.agent.post(&url).send_form(form);
        let response = response.map_err(|error| unanswered(&error, &self.agent, &url))?;
        let cookie = cookie(&response);
        let status = response.status().as_u16();
        let problem = match status {
            401 | 403 => Some(FetchProblem::LogIn),
            200 => refusal(response),
            _ => refusal(response).or(Some(FetchProblem::Answer(status))),
        };
        match problem {
            // Drop the reason: the answer to a log-in could contain the password.
            Some(FetchProblem::Refused(text)) if text.contains(password.reveal()) => {
                Err(FetchProblem::Answer(status))
            }
            Some(problem) => Err(problem),
            None => cookie.ok_or(FetchProblem::NoSession),
        }
    }

    fn query(&self, cookie: &HeaderValue) -> Result<Vec<u8>, FetchProblem> {
        let response = self.get(&query_path(&self.access.numbers), cookie)?;
        match response.status().as_u16() {
            200 => {}
            status => return Err(refusal(response).unwrap_or(FetchProblem::Answer(status))),
        }
        let body = body_of(response, self.limits)?;
        match reason(&body) {
            Some(problem) => Err(problem),
            None => Ok(body),
        }
    }

    fn get(&self, path: &str, cookie: &HeaderValue) -> Result<Response<Body>, FetchProblem> {
        let url = format!("{}{path}", self.access.server);
        let request = self.agent.get(&url).header(header::COOKIE, cookie);
        request.call().map_err(|error| unanswered(&error, &self.agent, &url))
    }
}

/// Returns the path of a query for the newest elements of these objects. If the address would be
/// too long, the query asks for all objects of the last 30 days.
fn query_path(numbers: &[u32]) -> String {
    let objects = if numbers.len() > MAX_NUMBERS {
        "decay_date/null-val/EPOCH/%3Enow-30".to_owned()
    } else {
        let numbers: Vec<String> = numbers.iter().map(u32::to_string).collect();
        format!("NORAD_CAT_ID/{}", numbers.join(","))
    };
    format!("/basicspacedata/query/class/gp/{objects}/orderby/NORAD_CAT_ID/format/json")
}

/// Returns the cookies of an answer in the form of a request header.
fn cookie(response: &Response<Body>) -> Option<HeaderValue> {
    let set = response.headers().get_all(header::SET_COOKIE).iter();
    let pairs: Vec<&str> = set
        .filter_map(|value| value.to_str().ok()?.split(';').next())
        .map(str::trim)
        .filter(|pair| pair.contains('='))
        .collect();
    let mut value = HeaderValue::from_str(&pairs.join("; ")).ok().filter(|_| !pairs.is_empty())?;
    value.set_sensitive(true);
    Some(value)
}

/// Returns the reason in a short answer, if it has one.
fn refusal(response: Response<Body>) -> Option<FetchProblem> {
    let body = read_limited(response.into_body().into_reader(), MAX_ERROR_BYTES).ok()?;
    reason(&body)
}

/// Answer with a reason in place of elements.
#[derive(Deserialize)]
struct Reason {
    error: Option<String>,
    #[serde(rename = "Login")]
    login: Option<serde_json::Value>,
}

fn reason(body: &[u8]) -> Option<FetchProblem> {
    // A list of elements never begins with `{`, so it is not parsed twice.
    if body.trim_ascii_start().first() != Some(&b'{') {
        return None;
    }
    let reason: Reason = serde_json::from_slice(body).ok()?;
    if reason.login.is_some() {
        return Some(FetchProblem::LogIn);
    }
    let text = reason.error?;
    let plain = |letter: char| if letter.is_control() { ' ' } else { letter };
    Some(FetchProblem::Refused(text.trim().chars().map(plain).take(MAX_REASON_CHARS).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_query_names_the_objects_or_asks_for_all() {
        let some = query_path(&[25_544, 43_013]);
        assert!(some.contains("/class/gp/NORAD_CAT_ID/25544,43013/"), "{some}");
        let numbers: Vec<u32> = (1..=501).collect();
        assert!(query_path(&numbers).contains("/EPOCH/%3Enow-30/"));
        assert!(query_path(&numbers[..500]).contains("/NORAD_CAT_ID/1,2,"));
    }

    #[test]
    fn a_reason_of_the_server_is_shown_on_one_line() {
        let refused = |text: &str| Some(FetchProblem::Refused(text.to_owned()));
        for (body, problem) in [
            (&b"[]"[..], None),
            (b"\"\"", None),
            (b"{\"Login\":\"Failed\"}", Some(FetchProblem::LogIn)),
            (b" {\"error\":\"You have\\nexceeded\"}", refused("You have exceeded")),
            (b"{\"OBJECT_NAME\":\"A\"}", None),
            (b"{", None),
        ] {
            assert_eq!(reason(body), problem, "{}", String::from_utf8_lossy(body));
        }
        let long = format!("{{\"error\":\"{}\"}}", "x".repeat(5000));
        assert_eq!(reason(long.as_bytes()), refused(&"x".repeat(MAX_REASON_CHARS)));
    }
}
