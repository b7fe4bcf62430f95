//! Calls of hooks. Each call has a thread of its own, so that a program or a server that hangs
//! delays no other call. The station never waits for a call.

mod program;
mod webhook;

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use crate::{
    contract::hooks::{HookOutcome, HookResult},
    job::{BrokeOff, Job, Wake},
    station::HookAction,
};

/// Max number of calls of one hook at once. With [`Hook::MAX_NUMBER`](crate::station::Hook) hooks,
/// it limits all threads and programs.
pub(super) const MAX_CALLS: usize = 4;

/// Max length of stored output, bytes.
pub(super) const MAX_OUTPUT: usize = 4096;

/// Call with everything that it needs.
#[derive(Debug, Clone)]
pub(super) struct Call {
    pub(super) action: HookAction,
    pub(super) timeout: Duration,
    pub(super) environment: Vec<(&'static str, String)>,
    pub(super) json: String,
}

/// First bytes of an output.
#[derive(Default)]
struct CappedOutput {
    bytes: Vec<u8>,
    is_cut: bool,
}

impl CappedOutput {
    fn push(&mut self, bytes: &[u8]) {
        let left = MAX_OUTPUT.saturating_sub(self.bytes.len());
        self.bytes.extend(bytes.iter().take(left));
        self.is_cut |= bytes.len() > left;
    }

    fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }
}

/// Starts a call.
pub(super) fn start(call: Call, wake: &Wake) -> Job<HookOutcome> {
    Job::start("azel-hook", Arc::clone(wake), move |_| run(&call))
}

/// Makes a call and waits for its end.
pub(super) fn run(call: &Call) -> HookOutcome {
    let begun = Instant::now();
    let (result, output) = match &call.action {
        HookAction::Command(arguments) => program::run(arguments, call),
        HookAction::Webhook(url) => webhook::post(url, call),
    };
    HookOutcome {
        duration_s: begun.elapsed().as_secs_f64(),
        result,
        output: output.text(),
        is_cut: output.is_cut,
    }
}

/// Returns the outcome of a call whose thread has ended.
pub(super) fn outcome(end: Result<HookOutcome, BrokeOff>) -> HookOutcome {
    end.unwrap_or(HookOutcome {
        duration_s: 0.0,
        result: HookResult::BrokeOff,
        output: String::new(),
        is_cut: false,
    })
}
