//! Words for what became of the passes of a rehearsal.

use jiff::Timestamp;

use super::{automatic, record};
use crate::{rehearsal::RehearsedPass, ui::format};

/// What became of a pass, and what was lost of it, in sentences.
pub fn outcome(pass: &RehearsedPass, now: Timestamp) -> String {
    if pass.is_given_up {
        return "A newer plan left it out.".to_owned();
    }
    let tracked = pass.report.as_ref().map(|report| record::verdict_sentence(report, now));
    let cause = match &pass.flown {
        None => Some("The antenna never set out for it.".to_owned()),
        Some(flown) => flown.cause.map(|cause| {
            format!("{} lost: {}", format::duration(pass.lost_s()), automatic::miss_cause(cause))
        }),
    };
    let told: Vec<String> = cause.into_iter().chain(tracked).collect();
    told.join(" ")
}

/// How good a pass was, in a word.
pub fn verdict(pass: &RehearsedPass) -> &'static str {
    match &pass.report {
        Some(report) => report.report.verdict.word(),
        None if pass.is_given_up => "given up",
        None => "missed",
    }
}
