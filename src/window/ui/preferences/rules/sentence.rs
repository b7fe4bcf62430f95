//! Describes a rule in one sentence, made from its fields.

use super::{
    cannot_act::RuleContext,
    draft::{DraftSubject, RuleDraft},
};
use crate::{
    station::{HoursOfDay, RuleAction, SunIs},
    ui::words,
};

/// Returns the rule as a sentence. `name` returns the name of a satellite.
pub(super) fn sentence(
    rule: &RuleDraft,
    context: &RuleContext<'_>,
    name: &dyn Fn(u32) -> String,
) -> String {
    let passes = passes(rule, context, name);
    let action = rule.typed.read().0.action;
    let does = match (rule.antenna.map(|id| context.antenna(id)), action) {
        (None, RuleAction::Take) => format!("any antenna may take {passes}, whatever their limits"),
        (None, RuleAction::Leave) if rule.subject == DraftSubject::All => {
            "no antenna takes any pass".to_owned()
        }
        (None, RuleAction::Leave) => format!("no antenna takes {passes}"),
        (None, RuleAction::Park) if rule.subject == DraftSubject::All => {
            "all antennas are parked and take no passes".to_owned()
        }
        (None, RuleAction::Park) => format!("no antenna takes {passes}, but none is parked"),
        (Some(antenna), action) => {
            let antenna = antenna.unwrap_or("an antenna that is removed");
            match action {
                RuleAction::Take => format!("{antenna} may take {passes}, whatever their limits"),
                RuleAction::Leave => format!("{antenna} leaves {passes} out"),
                RuleAction::Park if rule.subject == DraftSubject::All => {
                    format!("{antenna} is parked and takes no passes")
                }
                RuleAction::Park => format!("{antenna} leaves {passes} out, but is not parked"),
            }
        }
    };
    let when = when(rule);
    let whole = if when.is_empty() { does } else { format!("{when}, {does}") };
    format!("{}.", words::capitalised(&whole))
}

fn passes(rule: &RuleDraft, context: &RuleContext<'_>, name: &dyn Fn(u32) -> String) -> String {
    match rule.subject {
        DraftSubject::All => "all passes".to_owned(),
        DraftSubject::Satellite(Some(number)) => format!("passes of {}", name(number)),
        DraftSubject::Satellite(None) => "passes of a satellite yet to be chosen".to_owned(),
        DraftSubject::Group(group) => match group.and_then(|group| context.group(group)) {
            Some(group) => format!("passes of the group {group}"),
            None => "passes of a group yet to be chosen".to_owned(),
        },
    }
}

/// Returns the Sun and hour conditions of a rule; empty if the rule always applies.
fn when(rule: &RuleDraft) -> String {
    let conditions = rule.typed.read().0;
    let sun = conditions.sun.map(|sun| match sun {
        SunIs::Up => "while the Sun is up".to_owned(),
        SunIs::Down => "while the Sun is down".to_owned(),
    });
    let hours = conditions.hours().map(|hours| {
        let [start_text, end_text] = [hours.start, hours.end].map(HoursOfDay::time_text);
        format!("from {start_text} to {end_text} UTC")
    });
    sun.into_iter().chain(hours).collect::<Vec<_>>().join(", ")
}

/// Returns the conditions of a rule in a few words.
pub(super) fn when_in_short(
    rule: &RuleDraft,
    context: &RuleContext<'_>,
    name: &dyn Fn(u32) -> String,
) -> String {
    let conditions = rule.typed.read().0;
    let subject = match rule.subject {
        DraftSubject::All => None,
        DraftSubject::Satellite(number) => {
            Some(number.map_or_else(|| "no satellite".to_owned(), name))
        }
        DraftSubject::Group(group) => {
            let group = group.and_then(|group| context.group(group));
            Some(group.unwrap_or_else(|| "no group".to_owned()))
        }
    };
    let sun = conditions.sun.map(|sun| match sun {
        SunIs::Up => "Sun up".to_owned(),
        SunIs::Down => "Sun down".to_owned(),
    });
    let hours = conditions.hours().map(|hours| {
        let [start_text, end_text] = [hours.start, hours.end].map(HoursOfDay::time_text);
        format!("{start_text} to {end_text} UTC")
    });
    let parts: Vec<String> = subject.into_iter().chain(sun).chain(hours).collect();
    if parts.is_empty() { "always".to_owned() } else { parts.join(", ") }
}

/// Returns the effect of a rule in a few words.
pub(super) fn then_in_short(rule: &RuleDraft) -> &'static str {
    match (rule.typed.read().0.action, rule.subject) {
        (RuleAction::Take, _) => "take, whatever the limits",
        (RuleAction::Leave, _) => "leave out",
        (RuleAction::Park, DraftSubject::All) => "park, take nothing",
        (RuleAction::Park, _) => "leave out, do not park",
    }
}
