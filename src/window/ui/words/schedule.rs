//! Words for the schedule: reasons why passes are left out, and the cost of a swap.

use jiff::Timestamp;

use crate::{
    contract::{antenna::AntennaModel, passes::PassListKey, schedule::Swap},
    model::{
        Model,
        plan::{PlannedActivity, Standing},
    },
    plan::{
        Loss,
        schedule::{
            AntennaOff, Change, Changed, Class, ClassWorth, Conflict, Impossible, LeftOutReason,
            Lost, Proof, Refusal, Rule, Schedule,
        },
    },
    station::{AntennaId, ChooseBy, Light},
    ui::format,
};

/// Names a rule for the best schedule, as a choice.
pub fn choose_by(rule: ChooseBy) -> &'static str {
    match rule {
        ChooseBy::Elevation => "Priority, then elevation",
        ChooseBy::Duration => "Priority, then duration",
        ChooseBy::MostPasses => "Most passes",
        ChooseBy::MostMinutes => "Most minutes",
    }
}

/// Describes the time that the mount loses in a pass, and the place, as a sentence without a full
/// stop.
pub fn lost(lost: Lost) -> String {
    let seconds = format::duration(lost.seconds);
    match lost.loss {
        Loss::Keyhole(azimuth) => {
            format!("Loses {seconds} at the keyhole at {}", format::azimuth(azimuth.degrees()))
        }
        Loss::Overhead => format!("Loses {seconds} near the zenith"),
        Loss::Slew => format!("Loses {seconds} at the azimuth unwrap"),
        Loss::BeyondAzimuth(end) => {
            format!("Loses {seconds} beyond azimuth {}", format::azimuth(end.degrees()))
        }
        Loss::OutOfReach => format!("Loses {seconds} out of reach"),
    }
}

/// Functions for the names in the reasons why passes are left out.
#[derive(Clone, Copy)]
pub struct Names<'a> {
    /// Function that names the satellite of a pass.
    pub pass: &'a dyn Fn(PassListKey) -> String,
    pub antenna: &'a dyn Fn(AntennaId) -> String,
}

/// Returns the reason why a pass is left out, as a sentence without a full stop.
pub fn left_out_reason(names: Names<'_>, reason: &LeftOutReason) -> String {
    match reason {
        LeftOutReason::Refused(refusal) => refused(*refusal),
        LeftOutReason::Impossible(impossible) => not_possible(impossible),
        LeftOutReason::Off(AntennaOff::LockedOut) => "The unit is locked out".to_owned(),
        LeftOutReason::Off(AntennaOff::SwitchedOff) => "The antenna is not connected".to_owned(),
        LeftOutReason::OtherAntennas(allowed) if allowed.is_empty() => {
            "Your limits or rules allow no antenna".to_owned()
        }
        LeftOutReason::OtherAntennas(allowed) => {
            let allowed: Vec<String> = allowed.iter().map(|id| (names.antenna)(*id)).collect();
            format!("Your limits or rules allow only {}", format::list(&allowed))
        }
        LeftOutReason::Overlaps(conflict) => {
            let name = format::duration(conflict.missing_s);
            let verb = if conflict.others.is_empty() { "overlaps" } else { "overlap" };
            format!("{} {verb} by {name}", conflict_words(names, conflict))
        }
        LeftOutReason::SlewTooShort(conflict) => {
            let name = format::duration(conflict.missing_s);
            let conflict_words = conflict_words(names, conflict);
            format!("Too close to {conflict_words}: {name} short for slew and set-up")
        }
        LeftOutReason::TooFar => "The antenna cannot be there in time".to_owned(),
        LeftOutReason::UnderWay => "The pass is under way".to_owned(),
        LeftOutReason::MaxPerDay(max) => match max {
            1 => "One pass of the satellite is already taken that day".to_owned(),
            max => format!("{max} passes of the satellite are already taken that day"),
        },
        LeftOutReason::NotFound => "It would fit, but no better plan was found with it".to_owned(),
    }
}

fn refused(refusal: Refusal) -> String {
    match refusal {
        Refusal::Never => "Never, as you chose".to_owned(),
        Refusal::BelowFloor { floor_deg } => {
            format!("Maximum elevation is below the floor of {}", format::degrees(floor_deg, 0))
        }
        Refusal::OldElements { age_s } => {
            format!("The elements will be {} old", format::age(age_s))
        }
        Refusal::Rule(Rule::MinElevation { degrees }) => {
            format!(
                "Maximum elevation is below {}, the limit of the satellite",
                format::degrees(degrees, 0)
            )
        }
        Refusal::Rule(Rule::MinDuration { seconds }) => {
            format!("Shorter than {}, the limit of the satellite", format::duration(seconds))
        }
        Refusal::Rule(Rule::Light(light)) => match light {
            Light::Day => "The satellite is limited to passes by day".to_owned(),
            Light::Night => "The satellite is limited to passes by night".to_owned(),
            Light::Sunlit => {
                "The satellite is limited to passes in sunlight, and it is in shadow".to_owned()
            }
        },
    }
}

fn not_possible(impossible: &Impossible) -> String {
    match impossible {
        Impossible::Name => "Not possible: this unit cannot take the satellite's name".to_owned(),
        Impossible::TooLow => "Stays below the minimum elevation of the antenna".to_owned(),
        Impossible::Hidden => "The horizon mask hides all of it".to_owned(),
        Impossible::Lost(Lost { loss: Loss::Keyhole(_), .. }) => {
            "Not possible: all of it lies in the keyhole".to_owned()
        }
        Impossible::Lost(_) => "Not possible: the mount cannot follow it".to_owned(),
        Impossible::NoWay => "Not possible: no path leads there around the keep-outs".to_owned(),
        Impossible::KeepOut(barrier) => {
            format!("Not possible: it leads {}", super::forbidden(barrier))
        }
    }
}

fn conflict_words(names: Names<'_>, conflict: &Conflict) -> String {
    let name = (names.pass)((conflict.pass.satellite, conflict.pass.aos));
    let class = match conflict.class {
        Class::Always => " (always)".to_owned(),
        Class::Priority(priority) => format!(" (priority {})", priority.number()),
        Class::Fixed => " (under way)".to_owned(),
        Class::All | Class::Kept => String::new(),
    };
    match conflict.others.len() {
        0 => format!("{name}{class}"),
        1 => format!("{name}{class} and one more"),
        others => format!("{name}{class} and {others} more"),
    }
}

/// Returns the reason why a pass is left out, with the names that the window shows.
pub fn why_left_out(model: &Model, reason: &LeftOutReason) -> String {
    let antenna = |id| antenna_name(model, id).to_owned();
    left_out_reason(Names { pass: &|pass| pass_name(model, pass), antenna: &antenna }, reason)
}

/// Describes the status of a pass on an antenna of this name, as the end of a sentence.
pub fn standing(model: &Model, standing: Standing<'_>, antenna: &str) -> String {
    match standing {
        Standing::Flown(flown) => super::automatic::flown_part(flown),
        Standing::Running => format!("running on {antenna}"),
        Standing::Proved(_) => format!("planned on {antenna}, verified"),
        Standing::Sent(_) => format!("planned on {antenna}, sent, not verified"),
        Standing::Planned(_) => format!("planned on {antenna}"),
        Standing::TakenBy(other) => format!("planned on {}", antenna_name(model, other)),
        Standing::LeftOut(reason) => format!("left out: {}", why_left_out(model, reason)),
        Standing::NotKnown => "not planned yet".to_owned(),
    }
}

/// Describes the planned activity of an antenna, as a participle.
pub fn doing(model: &Model, doing: PlannedActivity) -> String {
    match doing {
        PlannedActivity::Tracks(pass) => format!("tracking {}", pass_name(model, pass)),
        PlannedActivity::SlewsTo(pass) => format!("slewing to {}", pass_name(model, pass)),
        PlannedActivity::WaitsFor(pass) => format!("waiting for {}", pass_name(model, pass)),
        PlannedActivity::Stays => "holding".to_owned(),
        PlannedActivity::SlewsToPark => "slewing to park".to_owned(),
        PlannedActivity::Parked => "parked".to_owned(),
    }
}

/// Returns the short name of the satellite of a pass.
pub fn pass_name(model: &Model, pass: PassListKey) -> String {
    satellite_name(model, pass.0)
}

/// Returns the short name of a satellite, or its catalog number if no pass of it is known.
pub fn satellite_name(model: &Model, number: u32) -> String {
    let found = model.pass_lists.satellite(number);
    found.map_or_else(|| number.to_string(), |listed| listed.short_name().to_owned())
}

/// Describes the cost of taking a pass, as a sentence.
pub fn price(model: &Model, swap: &Swap) -> String {
    let Some(changes) = &swap.changes else {
        return "It cannot be taken.".to_owned();
    };
    let (satellite, aos) = swap.pass;
    let own = |change: &&Change| change.pass.satellite != satellite || change.pass.aos != aos;
    let costs: Vec<String> = changes.iter().filter(own).map(|one| change(model, one)).collect();
    if costs.is_empty() {
        "No other pass is lost.".to_owned()
    } else {
        format!("{}.", costs.join("; "))
    }
}

/// Describes a change of the schedule, as a sentence without a full stop.
pub fn change(model: &Model, change: &Change) -> String {
    let key = (change.pass.satellite, change.pass.aos);
    let name = format!("{}, {}", pass_name(model, key), format::moment(key.1, model.now));
    match change.changed {
        Changed::Added { antenna } => {
            format!("{name}, is taken by {}", antenna_name(model, antenna))
        }
        Changed::Dropped { .. } => format!("{name}, is dropped"),
        Changed::Moved { destination: antenna_id, .. } => {
            format!("{name}, goes to {}", antenna_name(model, antenna_id))
        }
        Changed::Cut { late_s, early_s } => {
            let change_words = |seconds: f64, more: &str, less: &str| {
                let word = if seconds > 0.0 { more } else { less };
                (seconds.abs() >= 1.0)
                    .then(|| format!("{} {word}", format::duration(seconds.abs())))
            };
            let starts =
                change_words(late_s, "later", "earlier").map(|words| format!("starts {words}"));
            let ends =
                change_words(early_s, "earlier", "later").map(|words| format!("ends {words}"));
            let cuts: Vec<String> = starts.into_iter().chain(ends).collect();
            format!("{name}, {}", cuts.join(" and "))
        }
    }
}

/// Describes the known quality of a schedule, in a few words.
pub fn proof(schedule: &Schedule) -> String {
    unproved(schedule).unwrap_or_else(|| "No better plan exists.".to_owned())
}

/// Describes the max possible gain of a better schedule, by class; `None` if no class can gain.
pub fn unproved(schedule: &Schedule) -> Option<String> {
    let classes = schedule.worth.iter().filter_map(|class| match class.proof {
        Proof::AtMost(bound) => {
            let percent = 100.0 * (bound - class.worth) as f64 / bound.max(1) as f64;
            Some(format!("{} by {percent:.1} %", class_name(class.class)))
        }
        Proof::Best => None,
    });
    let classes: Vec<String> = classes.collect();
    let list = classes.join(", ");
    (!classes.is_empty()).then(|| format!("At most below the best plan: {list}."))
}

fn class_name(class: Class) -> String {
    match class {
        Class::Fixed => "Under way".to_owned(),
        Class::Always => "Always".to_owned(),
        Class::Priority(priority) => format!("Priority {}", priority.number()),
        Class::All => "All passes".to_owned(),
        Class::Kept => "Kept from before".to_owned(),
    }
}

/// Returns the worth of a class and its proof, as a sentence.
pub fn class_worth(class: &ClassWorth, choose_by: ChooseBy) -> String {
    let number = |worth: i64| match choose_by {
        ChooseBy::MostPasses => format::number(worth as f64, 0),
        ChooseBy::Elevation | ChooseBy::Duration | ChooseBy::MostMinutes => {
            format::number(worth as f64 / 1000.0, 0)
        }
    };
    let proof = match class.proof {
        Proof::Best => "the best there is".to_owned(),
        Proof::AtMost(bound) => format!("the best is at most {}", number(bound)),
    };
    format!("{}: {}, {proof}.", class_name(class.class), number(class.worth))
}

/// Returns the name of an antenna.
pub fn antenna_name(model: &Model, antenna: AntennaId) -> &str {
    model.antenna_of(antenna).map_or("an antenna", |antenna| &antenna.config.name)
}

/// Words the time at which an antenna starts towards a pass, such as "Loads 12:32:50Z".
pub fn sets_out(antenna: &AntennaModel, time: Timestamp, now: Timestamp) -> String {
    let word = if antenna.variant().capabilities.has_program { "Loads" } else { "Sets out" };
    format!("{word} {}", format::moment(time, now))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{plan::schedule::PassKey as Key, station::Priority};

    const NAMES: Names<'_> =
        Names { pass: &|_| "TERRA".to_owned(), antenna: &|id| format!("Antenna {}", id.0) };

    #[test]
    fn a_limit_names_the_antennas_that_it_allows() {
        let text = |allowed: &[u32]| {
            left_out_reason(
                NAMES,
                &LeftOutReason::OtherAntennas(allowed.iter().map(|id| AntennaId(*id)).collect()),
            )
        };
        assert_eq!(text(&[2]), "Your limits or rules allow only Antenna 2");
        assert_eq!(text(&[2, 3]), "Your limits or rules allow only Antenna 2 and Antenna 3");
        assert_eq!(text(&[]), "Your limits or rules allow no antenna");
    }

    #[test]
    fn a_pass_that_is_too_close_names_the_other_with_its_priority() {
        let text = |class| {
            let other = Key { satellite: 1, aos: Timestamp::UNIX_EPOCH };
            let conflict = Conflict { pass: other, class, missing_s: 80.0, others: vec![] };
            left_out_reason(NAMES, &LeftOutReason::SlewTooShort(conflict))
        };
        let end = ": 1:20 short for slew and set-up";
        let priority = Class::Priority(Priority::default());
        assert_eq!(text(priority), format!("Too close to TERRA (priority 3){end}"));
        assert_eq!(text(Class::All), format!("Too close to TERRA{end}"));
    }
}
