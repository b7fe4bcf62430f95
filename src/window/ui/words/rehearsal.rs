//! Words for the outcome of passes in a rehearsal.

use jiff::Timestamp;

use super::{automatic, record};
use crate::{
    contract::rehearsal::RehearsedPass, model::rehearsal::RehearsalState,
    plan::pass_report::PassVerdict, ui::format,
};

/// Describes the outcome of a pass and its losses, in sentences.
pub fn outcome(pass: &RehearsedPass, now: Timestamp) -> String {
    if pass.is_given_up {
        return "A newer plan left it out.".to_owned();
    }
    let tracked = pass.report.as_ref().map(|report| record::verdict_sentence(report, now));
    let cause = match &pass.flown {
        None => Some(match pass.off_reason {
            Some(because) => {
                format!("Automatic operation was off by then: {}", automatic::off_reason(because))
            }
            None => "The antenna never set out for it.".to_owned(),
        }),
        Some(flown) => flown.cause.map(|cause| {
            format!("{} lost: {}", format::duration(pass.lost_s()), automatic::miss_cause(cause))
        }),
    };
    let sentences: Vec<String> = cause.into_iter().chain(tracked).collect();
    sentences.join(" ")
}

/// Returns the result of the last rehearsal; `None` without one.
pub fn in_short(rehearsal_state: &RehearsalState, now: Timestamp) -> Option<String> {
    match rehearsal_state {
        RehearsalState::None => None,
        RehearsalState::UnderWay(_) => Some("Rehearsal under way".to_owned()),
        RehearsalState::Failed(reason) => Some(format!("Rehearsal: {reason}")),
        RehearsalState::Done { rehearsed, time } => {
            let is_good = |rehearsed_pass: &&RehearsedPass| {
                let report = rehearsed_pass.report.as_ref();
                report.is_some_and(|report| report.report.verdict == PassVerdict::Good)
            };
            let good = rehearsed.passes.iter().filter(is_good).count();
            let (all, time_text) = (rehearsed.passes.len(), format::moment(*time, now));
            Some(format!("Rehearsal of {time_text}: {good} of {all} good"))
        }
    }
}

/// Returns the achieved and the promised time of a pass, for a row.
pub fn beside_promise(pass: &RehearsedPass) -> String {
    let [reached, promised] = [pass.got_s(), pass.promised_s].map(format::duration);
    format!("{reached} of {promised}")
}

/// Returns the verdict on a pass, in a word.
pub fn verdict(pass: &RehearsedPass) -> &'static str {
    match &pass.report {
        Some(report) => report.report.verdict.word(),
        None if pass.is_given_up => "given up",
        None => "missed",
    }
}
