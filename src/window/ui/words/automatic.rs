//! Words for automatic operation and the list of the day.

use jiff::Timestamp;

use super::{clock, schedule};
use crate::{
    contract::{
        antenna::AntennaModel,
        automatic::{
            DayEvent, DayLine, Doing, Flown, GivenUp, Interruption, MissCause, NotReady,
            OffBecause, On, Operation, Taking,
        },
    },
    model::Model,
    plan::{
        pass_report::LossCause,
        schedule::{Entry, between_passes, sets_out},
    },
    ui::format,
};

/// Label of the button that resumes a suspended antenna whose next pass is unknown or too long for
/// a label.
pub const RESUME: &str = "Resume";

/// Returns the reason why automatic operation of an antenna is off, as a sentence.
pub fn off_reason(because: OffBecause) -> &'static str {
    match because {
        OffBecause::NotSwitchedOn => "Nobody has switched it on since the start.",
        OffBecause::Operator => "It was switched off.",
        OffBecause::Stop => "STOP switched it off.",
        OffBecause::Safety => "The antenna was stopped for safety.",
        OffBecause::LockedOut => "The unit is locked out.",
        OffBecause::Changed => "The settings of the antenna were changed.",
        OffBecause::NotAsLeft => "After an outage the unit was not as it had been left.",
        OffBecause::Failures => "Two passes in a row could not be loaded or verified.",
    }
}

/// Returns the cause of an interruption, as a sentence.
pub fn interruption(kind: Interruption) -> &'static str {
    match kind {
        Interruption::ByHand => "The antenna was commanded by hand.",
        Interruption::Elsewhere => "The antenna turned without a command from Azel.",
        Interruption::EndedByUnit => {
            "The unit ended a motion that Azel had not ended: by its panel, by another program or by \
             itself."
        }
        Interruption::Clock => {
            "The clock of this computer jumped, and no time service is known to keep it: check the \
             clock first."
        }
    }
}

/// Returns the reason why a unit cannot begin a pass, as a sentence.
pub fn not_ready(reason: NotReady) -> &'static str {
    match reason {
        NotReady::Fault => "A fault of the unit blocks motion. Clear the fault.",
        NotReady::WouldMiss => {
            "The unit's own clock, site or elements would make it miss the pass. Check them."
        }
        NotReady::NoPosition => "The unit reports no position. Check the sensors.",
    }
}

/// Returns the interruption in two or three words.
fn suspended(interruption: Interruption) -> &'static str {
    match interruption {
        Interruption::ByHand => "Suspended by hand.",
        Interruption::Elsewhere => "Suspended by others.",
        Interruption::EndedByUnit => "Suspended by the unit.",
        Interruption::Clock => "Suspended: clock.",
    }
}

fn name_of(model: &Model, entry: &Entry) -> String {
    schedule::satellite_name(model, entry.pass.satellite)
}

/// Returns the state of automatic operation of an antenna, in one line. A time comes before a name,
/// because a long name may be cut.
pub fn in_short(model: &Model, antenna: &AntennaModel) -> String {
    let moment = |time| format::moment(time, model.now);
    match &antenna.operation {
        Operation::Off(OffBecause::NotSwitchedOn | OffBecause::Operator) => "Off.".to_owned(),
        Operation::Off(because) => format!("Off. {}", off_reason(*because)),
        Operation::Suspended { interruption, .. } => suspended(*interruption).to_owned(),
        Operation::On(On { doing, .. }) => match doing {
            Doing::Announces { moves_at, .. } => {
                format!("On. Moves {} unless STOP.", moment(*moves_at))
            }
            Doing::Parks => "On. Parks until the next pass.".to_owned(),
            Doing::Takes(Taking { pass, asked_at, proved_at, .. }) => {
                let name = schedule::pass_name(model, *pass);
                match proved_at {
                    None => format!("On. Sent {}: {name}.", moment(*asked_at)),
                    Some(time) => format!("On. Verified {}: {name}.", moment(*time)),
                }
            }
            Doing::Rests => model.next_entry(antenna.id()).map_or_else(
                || "On. No pass is planned.".to_owned(),
                |next| format!("On. Next {}: {}.", moment(next.start), name_of(model, next)),
            ),
        },
    }
}

/// Returns the state of automatic operation of an antenna with its next action and time, as one or
/// two sentences; `None` while it is off.
pub fn in_full(model: &Model, antenna: &AntennaModel) -> Option<String> {
    let moment = |time| format::moment(time, model.now);
    let in_time = |time| format!("{}, in {}", moment(time), format::time_left(model.now, time));
    let on = match &antenna.operation {
        Operation::Off(_) => return None,
        Operation::Suspended { interruption: kind, .. } => {
            return Some(format!("Suspended. {}", interruption(*kind)));
        }
        Operation::On(on) => on,
    };
    Some(match &on.doing {
        Doing::Announces { moves_at, pass } => {
            let name = schedule::pass_name(model, *pass);
            format!("Moves at {} unless you press STOP: {name}.", in_time(*moves_at))
        }
        Doing::Parks => format!("Parks. {}", next(model, antenna)),
        Doing::Takes(taking) => {
            let name = schedule::pass_name(model, taking.pass);
            match (not_tracking(&antenna.operation), taking.proved_at) {
                (Some(reason), _) => format!("{name} is not tracked. {reason}"),
                (None, None) => {
                    format!("Sent {}, not verified yet: {name}.", moment(taking.asked_at))
                }
                (None, Some(_)) if taking.start > model.now => {
                    format!("Takes {} at {}.", name, in_time(taking.start))
                }
                (None, Some(_)) => {
                    let next_words = following(model, antenna, taking);
                    format!("Takes {name} until {}{next_words}.", moment(taking.end))
                }
            }
        }
        Doing::Rests => next(model, antenna),
    })
}

/// Returns a sentence about the next pass of an antenna that takes none now.
fn next(model: &Model, antenna: &AntennaModel) -> String {
    let Some(entry) = model.next_entry(antenna.id()) else {
        return "No pass is planned.".to_owned();
    };
    let policy = between_passes(&model.station, &antenna.config, model.now);
    let time = Some(sets_out(entry, policy)).filter(|time| *time > model.now);
    let leaves = time.map_or_else(String::new, |time| {
        let left = format::time_left(model.now, time);
        format!(" {}, in {left}.", schedule::sets_out(antenna, time, model.now))
    });
    format!(
        "Next at {}: {}.{leaves}",
        format::moment(entry.start, model.now),
        name_of(model, entry)
    )
}

/// Returns the next pass after the current one, as the end of a sentence.
fn following(model: &Model, antenna: &AntennaModel, taking: &Taking) -> String {
    let entries = model.schedule.schedule.entries.iter();
    let own = entries.filter(|entry| entry.antenna == antenna.id() && entry.start >= taking.end);
    let next = own.min_by_key(|entry| entry.start);
    next.map_or_else(String::new, |entry| {
        let time_text = format::moment(entry.start, model.now);
        format!(", then {} at {time_text}", name_of(model, entry))
    })
}

/// Returns the label of the button that resumes a suspended antenna, with its next pass.
pub fn go_on(model: &Model, antenna: &AntennaModel) -> Option<String> {
    if !matches!(antenna.operation, Operation::Suspended { .. }) {
        return None;
    }
    Some(model.next_entry(antenna.id()).map_or_else(
        || RESUME.to_owned(),
        |entry| {
            let time_text = format::moment(entry.start, model.now);
            format!("Go on with {}, {time_text}", name_of(model, entry))
        },
    ))
}

/// Returns the effect of closing the station on automatic operation, as sentences; `None` while it
/// is off for all antennas.
pub fn lost_by_closing(model: &Model) -> Option<String> {
    let is_on = |antenna: &&AntennaModel| !matches!(antenna.operation, Operation::Off(_));
    let antennas = || model.antennas.iter().filter(is_on);
    let names: Vec<&str> = antennas().map(|antenna| &*antenna.config.name).collect();
    if names.is_empty() {
        return None;
    }
    let comes_back = antennas().all(|antenna| antenna.config.automatic.is_on_at_start);
    let end_text = if comes_back { "this station runs again" } else { "you switch it on again" };
    let next = antennas().filter_map(|antenna| model.next_entry(antenna.id()));
    let next = next.min_by_key(|entry| entry.start).map_or_else(String::new, |entry| {
        let time_text = format::moment(entry.start, model.now);
        format!(" The next would be {} at {time_text}.", name_of(model, entry))
    });
    let names = format::list(&names);
    Some(format!("Automatic operation of {names} ends: it takes no pass until {end_text}.{next}"))
}

/// Returns the state of automatic operation in one or two words.
pub fn standing(operation: &Operation) -> &'static str {
    match operation {
        Operation::Off(_) => "off",
        Operation::Suspended { .. } => "suspended",
        Operation::On(On { doing, .. }) => match doing {
            Doing::Rests => "on",
            Doing::Announces { .. } => "on, about to move",
            Doing::Parks => "on, parking",
            Doing::Takes(_) => "on, running",
        },
    }
}

/// Returns the reason why a pass or a part of it was missed, as the end of a sentence.
pub fn miss_cause(cause: MissCause) -> String {
    let sentence = match cause {
        MissCause::Off(because) => off_reason(because),
        MissCause::Suspended(kind) => interruption(kind),
        MissCause::NotResumed => {
            "After an outage Azel asked whether to continue tracking, and nobody answered."
        }
        MissCause::Refused => "It was refused, or could not be verified.",
        MissCause::NotReady(reason) => not_ready(reason),
        MissCause::OffTarget => "Azel ended the track: the antenna stayed off its target.",
        MissCause::Lost(cause) => lost(cause),
    };
    sentence.to_owned()
}

/// Returns the reason why a stretch of a pass was lost, as a sentence.
fn lost(cause: LossCause) -> &'static str {
    match cause {
        LossCause::NotMeasured => "The unit reported no positions.",
        LossCause::LinkLost => "The unit did not answer.",
        LossCause::ProgramEnded => "Azel had ended.",
        LossCause::OutOfReach => "The mount cannot point there.",
        LossCause::Keyhole => "It led through a keyhole of the mount.",
        LossCause::RateOfMount => "The mount is too slow for it.",
        LossCause::Slew => "The azimuth axis had to unwrap.",
        LossCause::LateStart => "The antenna did not arrive in time.",
        LossCause::EarlyEnd => "The antenna left the satellite before its end.",
        LossCause::Stopped => "The antenna was stopped.",
        LossCause::NoEffect => "An axis did not turn as commanded, so Azel stopped the antenna.",
        LossCause::GivenUp => "The antenna stayed off its target, so Azel gave up the pass.",
        LossCause::ForeignHands => "The antenna turned without a command from Azel.",
        LossCause::Forbidden => "Azel stopped the antenna at a barrier.",
        LossCause::NotCommanded => "The antenna was not commanded to track it.",
        LossCause::OutsideBeam => "The satellite was outside the beam: a pointing error.",
    }
}

/// Returns the reason why automatic operation does not track a current pass, as a sentence; `None`
/// if nothing prevents tracking.
pub fn not_tracking(operation: &Operation) -> Option<String> {
    let cause = match operation {
        Operation::Off(because) => MissCause::Off(*because),
        Operation::Suspended { interruption: kind, .. } => MissCause::Suspended(*kind),
        Operation::On(_) => match operation.taking()?.given_up? {
            GivenUp::Refused => MissCause::Refused,
            GivenUp::OffTarget => MissCause::OffTarget,
            GivenUp::WouldMiss => MissCause::NotReady(NotReady::WouldMiss),
        },
    };
    Some(miss_cause(cause))
}

/// Returns the outcome of a pass, as a sentence.
pub fn flown(flown: &Flown, now: Timestamp) -> String {
    let (_, aos) = flown.pass;
    let cause = flown.cause.map_or_else(String::new, |cause| format!(" {}", miss_cause(cause)));
    let pass = format!("{}, AOS {}", flown.name, format::moment(aos, now));
    format!("{pass}: {}.{cause}", flown_part(flown))
}

/// Returns the tracked or missed part of a pass, as the end of a sentence.
pub fn flown_part(flown: &Flown) -> String {
    let Flown { of_s, in_beam_s, cause, .. } = flown;
    if cause.is_none() {
        let percent = 100.0 * in_beam_s / of_s.max(1.0);
        return format!("done, {} % in the beam", format::number(percent, 0));
    }
    format!("missed {} of {}", format::duration(flown.lost_s()), format::duration(*of_s))
}

/// Returns a line of the list of the day, as a sentence.
pub fn day_line(line: &DayLine, now: Timestamp) -> String {
    match &line.event {
        DayEvent::SwitchedOn => "Automatic operation is on.".to_owned(),
        DayEvent::SwitchedOff(because) => {
            format!("Automatic operation is off. {}", off_reason(*because))
        }
        DayEvent::Suspended(kind) => {
            format!("Automatic operation is suspended. {}", interruption(*kind))
        }
        DayEvent::WentOn => "Automatic operation resumed.".to_owned(),
        DayEvent::Flown(outcome) => flown(outcome, now),
        DayEvent::ClockSet { was_ahead_s } => {
            let was = was_ahead_s.map_or_else(
                || "was not set".to_owned(),
                |ahead_s| format!("was {}", clock::side(ahead_s)),
            );
            format!("Azel set the unit's clock, which {was}.")
        }
        DayEvent::ElementsUploaded { file, satellites, old_algorithms } => {
            let noun = if *satellites == 1 { "satellite" } else { "satellites" };
            let subject = format!(
                "Azel uploaded the elements of {satellites} {noun} to the unit, as {file}."
            );
            match super::old_algorithms(old_algorithms) {
                Some(caution) => format!("{subject} {caution}"),
                None => subject,
            }
        }
        DayEvent::ElementsNotUploaded { reason } => {
            format!("Azel could not upload elements to the unit: {reason}.")
        }
        DayEvent::ClockNotSet { reason } => {
            format!("Azel could not set the unit's clock: {reason}.")
        }
    }
}
