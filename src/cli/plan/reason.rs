//! Why a pass is left out, in a sentence.

use crate::plan::{
    Barrier, Loss,
    schedule::{Class, Conflict, Impossible, LeftOut, Light, Lost, Off, Refusal, Rule, Why},
};

pub(super) fn reason(left: &LeftOut, name: &dyn Fn(u32) -> String) -> String {
    match &left.why {
        Why::Refused(refusal) => refused(*refusal),
        Why::Impossible(impossible) => not_possible(impossible),
        Why::Off(Off::SwitchedOff) => "every antenna is switched off".to_owned(),
        Why::Off(Off::LockedOut) => "every antenna is locked out".to_owned(),
        Why::OtherAntennas => "the rules of the satellite leave out every antenna".to_owned(),
        Why::Overlaps(conflict) => {
            format!("overlaps with {} by {}", with(conflict, name), seconds(conflict.missing_s))
        }
        Why::SlewTooShort(conflict) => format!(
            "{} too little for slew and set-up, {}",
            seconds(conflict.missing_s),
            with(conflict, name)
        ),
        Why::TooFar => "no antenna can be there in time from where it stands".to_owned(),
        Why::MaxADay(most) => format!("{most} of its passes are taken on this day"),
        Why::NotFound => "a schedule with it was not found".to_owned(),
    }
}

fn refused(refusal: Refusal) -> String {
    match refusal {
        Refusal::Never => "set to never".to_owned(),
        Refusal::BelowFloor { floor_deg } => format!("stays below {floor_deg:.1}°"),
        Refusal::OldElements { age_s } => {
            format!("its elements are {:.1} days old", age_s / crate::astro::time::DAY_S)
        }
        Refusal::Rule(Rule::MinElevation { degrees }) => {
            format!("stays below {degrees:.1}°, by the rules of the satellite")
        }
        Refusal::Rule(Rule::MinDuration { seconds: least }) => {
            format!("is shorter than {}, by the rules of the satellite", seconds(least))
        }
        Refusal::Rule(Rule::Light(Light::Day)) => "is not by day".to_owned(),
        Refusal::Rule(Rule::Light(Light::Night)) => "is not by night".to_owned(),
        Refusal::Rule(Rule::Light(Light::Sunlit)) => "is not sunlit".to_owned(),
    }
}

fn not_possible(impossible: &Impossible) -> String {
    match impossible {
        Impossible::TooLow => "stays below the minimum elevation".to_owned(),
        Impossible::Hidden => "is hidden by the horizon mask".to_owned(),
        Impossible::Lost(Lost { seconds: lost_s, at }) => {
            let place = match at {
                Loss::Keyhole(azimuth) => format!("keyhole at {:.0}°", azimuth.degrees()),
                Loss::Overhead => "too fast overhead".to_owned(),
                Loss::Slew => "end of the azimuth axis".to_owned(),
                Loss::OutOfReach => "out of travel".to_owned(),
            };
            format!("not possible, {place}: {} lost", seconds(*lost_s))
        }
        Impossible::KeepOut(Barrier::KeepOut(name)) => format!("leads through keep-out {name}"),
        Impossible::KeepOut(Barrier::Sun) => "leads too near to the Sun".to_owned(),
        Impossible::KeepOut(Barrier::MinimumElevation) => {
            "stays below the minimum elevation".to_owned()
        }
        Impossible::NoWay => "no way leads there past the keep-outs".to_owned(),
    }
}

fn with(conflict: &Conflict, name: &dyn Fn(u32) -> String) -> String {
    let name = name(conflict.with.satellite);
    match conflict.class {
        Class::Fixed => format!("{name} (begun)"),
        Class::Always => format!("{name} (always)"),
        Class::Priority(priority) => format!("{name} (priority {})", priority.number()),
        Class::All | Class::Kept => name,
    }
}

fn seconds(seconds: f64) -> String {
    let whole = seconds.ceil() as i64;
    if whole < 60 { format!("{whole} s") } else { format!("{}:{:02}", whole / 60, whole % 60) }
}
