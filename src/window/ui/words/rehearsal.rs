//! Words for what became of the passes of a rehearsal.

use jiff::Timestamp;

use super::{automatic, record};
use crate::{
    contract::rehearsal::RehearsedPass, model::rehearsal::RehearsalState,
    plan::pass_report::PassVerdict, ui::format,
};

/// Outcome of a pass, and its losses, in sentences.
pub fn outcome(pass: &RehearsedPass, now: Timestamp) -> String {
    if pass.is_given_up {
        return "A newer plan left it out.".to_owned();
    }
    let tracked = pass.report.as_ref().map(|report| record::verdict_sentence(report, now));
    let cause = match &pass.flown {
        None => Some(match pass.off_reason {
            Some(because) => {
                format!("Automatic operation was off by then: {}", automatic::off(because))
            }
            None => "The antenna never set out for it.".to_owned(),
        }),
        Some(flown) => flown.cause.map(|cause| {
            format!("{} lost: {}", format::duration(pass.lost_s()), automatic::miss_cause(cause))
        }),
    };
    let told: Vec<String> = cause.into_iter().chain(tracked).collect();
    told.join(" ")
}

/// Result of the last rehearsal; `None` without one.
pub fn in_short(of: &RehearsalState, now: Timestamp) -> Option<String> {
    match of {
        RehearsalState::None => None,
        RehearsalState::UnderWay(_) => Some("Rehearsal under way".to_owned()),
        RehearsalState::Failed(why) => Some(format!("Rehearsal: {why}")),
        RehearsalState::Done { rehearsed, at } => {
            let is_good = |of: &&RehearsedPass| {
                let report = of.report.as_ref();
                report.is_some_and(|report| report.report.verdict == PassVerdict::Good)
            };
            let good = rehearsed.passes.iter().filter(is_good).count();
            let (all, at) = (rehearsed.passes.len(), format::moment(*at, now));
            Some(format!("Rehearsal of {at}: {good} of {all} good"))
        }
    }
}

/// Time that a pass got, and the promised time, for a row.
pub fn beside_promise(pass: &RehearsedPass) -> String {
    let [got, promised] = [pass.got_s(), pass.promised_s].map(format::duration);
    format!("{got} of {promised}")
}

/// Verdict on a pass, in a word.
pub fn verdict(pass: &RehearsedPass) -> &'static str {
    match &pass.report {
        Some(report) => report.report.verdict.word(),
        None if pass.is_given_up => "given up",
        None => "missed",
    }
}
