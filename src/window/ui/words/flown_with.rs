//! Words for the conditions of a recorded track: elements, commands to the antenna, and clocks.

use jiff::Timestamp;

use super::record;
use crate::{
    astro::time::DAY_S,
    contract::{driver::TimeSync, record::RecordedReport},
    plan::pass_report::{Cause, Explanation},
    ui::format,
};

/// Clock error from which a unit gets a caution, seconds.
const CLOCK_OFF_S: f64 = 0.1;

/// A name with a value.
pub struct Fact {
    pub name: &'static str,
    pub value: String,
    pub kind: FactKind,
}

pub enum FactKind {
    Plain,
    Caution,
    NotKnown,
}

/// Returns the conditions of a recorded track, and its rms error.
pub fn facts(report: &RecordedReport, now: Timestamp) -> Vec<Fact> {
    let fact = |name, value, kind| Fact { name, value, kind };
    let plain = |name, value| fact(name, value, FactKind::Plain);
    let about_track = &report.track;
    let mut facts = vec![
        plain("Elements of", format::copied(report.elements.epoch())),
        plain("Element age at the pass", format::age(report.age_days * DAY_S)),
        plain("Tracked by", record::tracked_by(about_track.tracked_by).to_owned()),
        plain("Tracked since", format::moment(about_track.begun, now)),
    ];
    if let Some(sent) = about_track.sent {
        facts.push(plain("Positions sent", sent.to_string()));
    }
    if let Some((start, offsets)) = about_track.offsets.changes().last() {
        let changes = about_track.offsets.changes().len();
        let and = if changes > 1 { format!("the last of {changes}, ") } else { String::new() };
        let start_text = format::moment(*start, now);
        facts.push(plain(
            "Offsets",
            format!("{} ({and}from {start_text})", super::offsets(*offsets)),
        ));
    }
    if !about_track.pointing_model.is_none() {
        facts.push(plain("Pointing model", "applied".to_owned()));
    }
    if let Some(ahead_s) = about_track.unit_clock_ahead_s {
        let kind = if is_off(ahead_s) { FactKind::Caution } else { FactKind::Plain };
        let way = if ahead_s < 0.0 { "late" } else { "early" };
        let words = format!("{} s {way}", format::number(ahead_s.abs(), 2));
        facts.push(fact("Unit clock", words, kind));
    }
    let (sync, kind) = match about_track.sync {
        TimeSync::Synchronised => ("synchronised", FactKind::Plain),
        TimeSync::NotSynchronised => ("not synchronised", FactKind::Caution),
        TimeSync::NotKnown => ("not known", FactKind::NotKnown),
    };
    facts.push(fact("Clock of this computer", sync.to_owned(), kind));
    let text = format!(
        "{} of {}",
        format::duration(report.report.known_s),
        format::duration(report.report.counted_s)
    );
    facts.push(plain("Position data for", text));
    if let Some(rms) = report.report.rms {
        let two = |a: f64, b: f64| format!("{}, {}", format::degrees(a, 3), format::degrees(b, 3));
        facts.push(plain("Rms in azimuth, elevation", two(rms.azimuth_deg, rms.elevation_deg)));
        facts.push(plain("Rms along, across", two(rms.along_deg, rms.across_deg)));
    }
    facts
}

/// Returns the first remedy if a time error explains the error and the clock of the unit was off.
pub fn clock_first(report: &RecordedReport) -> Option<&'static str> {
    let is_time = |explanation: &Explanation| {
        explanation.causes().any(|cause| matches!(cause, Cause::Late { .. }))
    };
    let is_late = report.causes.first().is_some_and(is_time)
        && report.track.unit_clock_ahead_s.is_some_and(is_off);
    is_late.then_some(
        "Set the unit's clock first: a time offset would hide the wrong clock, and be wrong \
         itself once the clock is set.",
    )
}

fn is_off(ahead_s: f64) -> bool {
    ahead_s.abs() >= CLOCK_OFF_S
}
