//! Fetch of one file from the web.

use std::io;

use tokio_util::sync::CancellationToken;
use ureq::{
    Agent,
    http::{Uri, header},
};

use super::FetchError;
use crate::{
    library::disk::read_limited,
    transfer::{Limits, limits::with_timeout},
};

/// Requests `url` once. Reports a redirection but does not follow it.
pub(super) async fn fetch(
    url: &str,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Vec<u8>, FetchError> {
    let uri: Uri = url.parse().map_err(|_| FetchError::Address)?;
    let is_web = matches!(uri.scheme_str(), Some("http" | "https"));
    // Refuse a password in the address: it would be shown and logged.
    let is_plain = uri.authority().is_some_and(|authority| !authority.as_str().contains('@'));
    if !is_web || !is_plain {
        return Err(FetchError::Address);
    }
    // After a cancel, the thread ends by its own timeout.
    let asking = tokio::task::spawn_blocking(move || ask(&uri, limits));
    with_timeout(limits.file, cancel, asking)
        .await?
        .unwrap_or_else(|_| Err(FetchError::NoAnswer("the fetch was interrupted".to_owned())))
}

fn ask(uri: &Uri, limits: Limits) -> Result<Vec<u8>, FetchError> {
    let config = Agent::config_builder()
        .http_status_as_error(false)
        .max_redirects(0)
        .max_redirects_will_error(false)
        // Use no proxy: the unit does not use this computer's proxy.
        .proxy(None)
        .timeout_connect(Some(limits.connect))
        .timeout_recv_response(Some(limits.request))
        .timeout_global(Some(limits.file))
        .user_agent(concat!("azel/", env!("CARGO_PKG_VERSION")));
    let request = Agent::from(config.build()).get(uri);
    let response = request.call().map_err(|error| FetchError::NoAnswer(error.to_string()))?;
    match response.status().as_u16() {
        200 => {}
        status @ 300..400 => {
            let destination = response
                .headers()
                .get(header::LOCATION)
                .and_then(|header_value| header_value.to_str().ok());
            return Err(destination.map_or(FetchError::Status { status }, |destination| {
                FetchError::Redirected { destination: destination.to_owned() }
            }));
        }
        status => return Err(FetchError::Status { status }),
    }
    read_limited(response.into_body().into_reader(), limits.file_bytes).map_err(|error| match error
        .kind()
    {
        io::ErrorKind::FileTooLarge => FetchError::TooLarge(limits.file_bytes),
        _ => FetchError::NoAnswer(error.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn only_plain_addresses_are_asked() {
        for url in
            ["ftp://127.0.0.1/x", "file:///etc/passwd", "http://op:word@127.0.0.1/x", "x", ""]
        {
            let cancel = CancellationToken::new();
            let error = fetch(url, Limits::default(), &cancel).await.unwrap_err();
            assert!(matches!(error, FetchError::Address), "{url}: {error}");
            assert!(!error.to_string().contains("word"));
        }
    }
}
