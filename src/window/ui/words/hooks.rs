//! Words for hooks and their calls.

use crate::{
    contract::hooks::{HookOutcome, HookResult, HookRun, HookState, NotRun},
    station::HookEvent,
};

/// Returns the name of an event.
pub fn event(event: HookEvent) -> &'static str {
    match event {
        HookEvent::Aos => "AOS",
        HookEvent::Los => "LOS",
        HookEvent::TrackingStart => "start of tracking",
        HookEvent::TrackingEnd => "end of tracking",
        HookEvent::MissedPass => "missed pass",
        HookEvent::Alarm => "top-priority alarm",
    }
}

/// Describes a call with its result and the first line of its output.
pub fn run(run: &HookRun) -> String {
    let name = format!("Hook {}", run.hook);
    let result = state(&run.state);
    let output = match &run.state {
        HookState::Ended(outcome) => outcome.output.lines().find(|line| !line.trim().is_empty()),
        HookState::Running | HookState::NotRun(_) => None,
    };
    match output {
        Some(line) => format!("{name}: {result}: {}", line.trim()),
        None => format!("{name}: {result}"),
    }
}

/// Describes the state of a call.
pub fn state(state: &HookState) -> String {
    match state {
        HookState::Running => "running".to_owned(),
        HookState::Ended(outcome) => ended(outcome),
        HookState::NotRun(NotRun::Busy) => {
            "not called, because earlier calls have not ended".to_owned()
        }
        HookState::NotRun(NotRun::TooLate) => {
            "not called, because the clock jumped over its time".to_owned()
        }
    }
}

fn ended(outcome: &HookOutcome) -> String {
    let took = format!("{:.1} s", outcome.duration_s);
    match &outcome.result {
        HookResult::Exited(0) => format!("done in {took}"),
        HookResult::Exited(code) => format!("failed with exit code {code} after {took}"),
        HookResult::Killed => format!("ended by a signal after {took}"),
        HookResult::TimedOut => format!("ended by Azel after {took}"),
        HookResult::CannotStart(reason) => format!("cannot start: {reason}"),
        HookResult::Answered(status) if outcome.result.is_success() => {
            format!("answered with {status} in {took}")
        }
        HookResult::Answered(status @ 300..400) => {
            format!("redirected with {status}: enter the new address")
        }
        HookResult::Answered(status) => format!("refused with {status}"),
        HookResult::NoAnswer(reason) => format!("no answer: {reason}"),
        HookResult::BrokeOff => "failed inside Azel".to_owned(),
    }
}
