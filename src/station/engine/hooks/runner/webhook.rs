//! Call of a web address with the values as JSON.

use std::io::Read as _;

use ureq::{
    Agent,
    http::Uri,
    tls::{Certificate, RootCerts, TlsConfig},
};

use super::{Call, CappedOutput, MAX_OUTPUT};
use crate::{
    contract::hooks::HookResult,
    library::{environment_proxy, system_authorities},
};

/// Posts the values once. Follows no redirection: the operator must check an address that has
/// moved, and another host must not receive the values.
pub(super) fn post(url: &str, call: &Call) -> (HookResult, CappedOutput) {
    let mut output = CappedOutput::default();
    let result = ask(url, call, &mut output);
    (result.unwrap_or_else(|reason| reason), output)
}

fn ask(url: &str, call: &Call, output: &mut CappedOutput) -> Result<HookResult, HookResult> {
    let no_answer = |reason: String| HookResult::NoAnswer(reason);
    let uri: Uri = url.parse().map_err(|_| no_answer("the address is not valid".to_owned()))?;
    let proxy = if is_loopback(&uri) {
        None
    } else {
        environment_proxy().map_err(|error| no_answer(error.to_string()))?
    };
    let own = system_authorities().iter().map(|own| Certificate::from_der(own).to_owned());
    let own: Vec<_> = own.collect();
    let roots = if own.is_empty() { RootCerts::WebPki } else { own.into_iter().into() };
    let config = Agent::config_builder()
        .http_status_as_error(false)
        .max_redirects(0)
        .max_redirects_will_error(false)
        .timeout_global(Some(call.timeout))
        .tls_config(TlsConfig::builder().root_certs(roots).build())
        .proxy(proxy)
        .user_agent(concat!("azel/", env!("CARGO_PKG_VERSION")));
    let request = Agent::from(config.build()).post(uri).content_type("application/json");
    let response = request.send(&call.json).map_err(|error| failed(&error))?;
    let status = response.status().as_u16();
    let mut body = response.into_body().into_reader().take(MAX_OUTPUT as u64 + 1);
    let mut buffer = [0; 1024];
    loop {
        match body.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => output.push(buffer.get(..count).unwrap_or_default()),
            // The status is the answer; the rest of the reply may stay unread.
            Err(error) => {
                tracing::debug!(%error, "the reply to a hook breaks off");
                output.is_cut = true;
                break;
            }
        }
    }
    Ok(HookResult::Answered(status))
}

fn failed(error: &ureq::Error) -> HookResult {
    match error {
        ureq::Error::Timeout(_) => HookResult::TimedOut,
        error => HookResult::NoAnswer(error.to_string()),
    }
}

fn is_loopback(uri: &Uri) -> bool {
    let host = uri.host().unwrap_or_default().trim_matches(['[', ']']);
    let is_address = host.parse().is_ok_and(|address: std::net::IpAddr| address.is_loopback());
    is_address || host.eq_ignore_ascii_case("localhost")
}
