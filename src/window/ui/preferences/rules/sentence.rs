//! A rule as one sentence, made from its fields.

use super::{
    cannot_act::Around,
    draft::{Of, RuleDraft},
};
use crate::{
    station::{HoursOfDay, RuleAction, SunIs},
    ui::words,
};

/// The rule as a sentence. `name` gives the name of a satellite.
pub(super) fn sentence(
    rule: &RuleDraft,
    around: &Around<'_>,
    name: &dyn Fn(u32) -> String,
) -> String {
    let passes = passes(rule, around, name);
    let then = rule.typed.read().0.then;
    let does = match (rule.antenna.map(|id| around.antenna(id)), then) {
        (None, RuleAction::Take) => format!("any antenna may take {passes}, whatever their limits"),
        (None, RuleAction::Leave) if rule.of == Of::All => "no antenna takes any pass".to_owned(),
        (None, RuleAction::Leave) => format!("no antenna takes {passes}"),
        (None, RuleAction::Park) if rule.of == Of::All => {
            "all antennas are parked and take no passes".to_owned()
        }
        (None, RuleAction::Park) => format!("no antenna takes {passes}, but none is parked"),
        (Some(antenna), then) => {
            let antenna = antenna.unwrap_or("an antenna that is removed");
            match then {
                RuleAction::Take => format!("{antenna} may take {passes}, whatever their limits"),
                RuleAction::Leave => format!("{antenna} leaves {passes} out"),
                RuleAction::Park if rule.of == Of::All => {
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

fn passes(rule: &RuleDraft, around: &Around<'_>, name: &dyn Fn(u32) -> String) -> String {
    match rule.of {
        Of::All => "all passes".to_owned(),
        Of::Satellite(Some(number)) => format!("passes of {}", name(number)),
        Of::Satellite(None) => "passes of a satellite yet to be chosen".to_owned(),
        Of::Group(group) => match group.and_then(|group| around.group(group)) {
            Some(group) => format!("passes of the group {group}"),
            None => "passes of a group yet to be chosen".to_owned(),
        },
    }
}

/// The Sun and the hours of a rule; empty where it always holds.
fn when(rule: &RuleDraft) -> String {
    let conditions = rule.typed.read().0;
    let sun = conditions.sun.map(|sun| match sun {
        SunIs::Up => "while the Sun is up".to_owned(),
        SunIs::Down => "while the Sun is down".to_owned(),
    });
    let hours = conditions.hours().map(|hours| {
        let [from, to] = [hours.start, hours.end].map(HoursOfDay::time_text);
        format!("from {from} to {to} UTC")
    });
    sun.into_iter().chain(hours).collect::<Vec<_>>().join(", ")
}

/// The conditions of a rule in a few words.
pub(super) fn when_in_short(
    rule: &RuleDraft,
    around: &Around<'_>,
    name: &dyn Fn(u32) -> String,
) -> String {
    let conditions = rule.typed.read().0;
    let of = match rule.of {
        Of::All => None,
        Of::Satellite(number) => Some(number.map_or_else(|| "no satellite".to_owned(), name)),
        Of::Group(group) => {
            let group = group.and_then(|group| around.group(group));
            Some(group.unwrap_or_else(|| "no group".to_owned()))
        }
    };
    let sun = conditions.sun.map(|sun| match sun {
        SunIs::Up => "Sun up".to_owned(),
        SunIs::Down => "Sun down".to_owned(),
    });
    let hours = conditions.hours().map(|hours| {
        let [from, to] = [hours.start, hours.end].map(HoursOfDay::time_text);
        format!("{from} to {to} UTC")
    });
    let parts: Vec<String> = of.into_iter().chain(sun).chain(hours).collect();
    if parts.is_empty() { "always".to_owned() } else { parts.join(", ") }
}

/// Effect of a rule, in a few words.
pub(super) fn then_in_short(rule: &RuleDraft) -> &'static str {
    match (rule.typed.read().0.then, rule.of) {
        (RuleAction::Take, _) => "take, whatever the limits",
        (RuleAction::Leave, _) => "leave out",
        (RuleAction::Park, Of::All) => "park, take nothing",
        (RuleAction::Park, _) => "leave out, do not park",
    }
}
