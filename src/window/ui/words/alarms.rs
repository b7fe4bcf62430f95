//! Sentences of the alarm list.

use jiff::Timestamp;

use super::{automatic::not_ready, clock};
use crate::{
    contract::{
        alarms::{Alarm, AlarmKind, AlarmState, Work},
        claim::HeldBy,
        driver::{LinkLoss, OffTargetCause},
    },
    model::DistanceUnit,
    plan::on_board::Ranked,
    station::{Note, NoteReason},
    ui::format,
};

/// Returns the time of an alarm, and its number of occurrences.
pub fn alarm_times(alarm: &Alarm, now: Timestamp) -> String {
    let first = format::moment(alarm.raised, now);
    match alarm.count {
        0 | 1 => first,
        count => format!("{first}, {count} times, last {}", format::moment(alarm.last, now)),
    }
}

/// Returns the state of an alarm in words.
pub fn alarm_state(state: AlarmState, now: Timestamp) -> String {
    match state {
        AlarmState::New => "new".to_owned(),
        AlarmState::NewAndOver { over_since: start } => {
            format!("new, over since {}", format::moment(start, now))
        }
        AlarmState::Seen => "seen".to_owned(),
        AlarmState::Over { over_since: start } => {
            format!("over since {}", format::moment(start, now))
        }
        AlarmState::Shelved { end } => format!("shelved to {}", format::moment(end, now)),
    }
}

/// Describes the cause in kilometres, so that window, desktop and record have the same words.
fn cause_of(ranked: &Ranked) -> String {
    super::cause(ranked, DistanceUnit::Kilometres)
}

/// Returns the reason why an antenna is off its satellite, as a sentence.
pub fn off_because(cause: &OffTargetCause, now: Timestamp) -> String {
    match cause {
        OffTargetCause::Reported(ranked) => super::capitalised(&cause_of(ranked)) + ".",
        OffTargetCause::Measured(explained) => {
            super::record::explained(explained, now).unwrap_or_default()
        }
    }
}

/// Describes an alarm. `antenna` is the name of its antenna, if it has one.
// The match has one arm for each kind.
#[allow(clippy::too_many_lines)]
pub fn alarm(kind: &AlarmKind, antenna: &str, now: Timestamp) -> String {
    match kind {
        AlarmKind::StationStands(stood) => format!(
            "What is shown is {} old: the part of Azel that runs the station is not responding. \
             STOP bypasses it.",
            format::age(stood.as_secs_f64())
        ),
        AlarmKind::StationElsewhere(holder) => format!(
            "This station is open in {holder}: nothing is driven from here. Esc stops its antennas \
             there."
        ),
        AlarmKind::StopNotElsewhere => {
            "The Azel that drives the antenna has not confirmed STOP. Use its window or the local \
             panel."
                .to_owned()
        }
        AlarmKind::UnitElsewhere(HeldBy::Unknown(reason)) => format!(
            "{antenna} is not connected: Azel could not lock it ({reason}), so another program may be \
             driving it. Free disk space or fix the permissions of the folder of locks; Azel tries \
             again each second."
        ),
        AlarmKind::UnitElsewhere(holder) => {
            format!("{antenna} is driven by {holder}: nothing goes to it from here.")
        }
        AlarmKind::LinkLost(LinkLoss::Unreadable) => {
            format!("{antenna} answers, but its answers cannot be read.")
        }
        AlarmKind::LinkLost(loss) => {
            format!("{antenna} does not reply: {}.", super::link_loss(loss))
        }
        AlarmKind::StopNotConfirmed => {
            format!("{antenna} is still not known to have stopped after STOP. Use the local panel.")
        }
        AlarmKind::StopRefused(answer) => {
            format!("{antenna} answered {answer} to STOP. Use the local panel.")
        }
        AlarmKind::JogLeaseOver => {
            format!("{antenna}: the jog was stopped because the window did not renew it in time.")
        }
        AlarmKind::JogPositionOld => {
            format!("{antenna}: the jog was stopped because its position came too late.")
        }
        AlarmKind::LosesPositions => format!(
            "{antenna} answers late or not at all: three of its positions are missing within 10 s. \
             What it shows may be seconds old. Check its cable and the network."
        ),
        AlarmKind::AutoTrackStillOn => {
            format!("{antenna} is stopped, but auto-track is on: it may start by itself.")
        }
        AlarmKind::AutoStaysOn => format!("{antenna} did not switch auto-track off."),
        AlarmKind::AutoTrackNotKnown => format!(
            "The unit of {antenna} was told to switch auto-track off but does not report auto-track: \
             it may start tracking by itself. Check auto-track at the unit."
        ),
        AlarmKind::AutoTrackOwed(unit) => super::auto_track_owed(unit),
        AlarmKind::OffsetsOwed(unit) => super::offsets_owed(unit),
        AlarmKind::LockOutUnproved => format!(
            "{antenna} is locked out, but it is not confirmed that its auto-track is off: it may \
             start by itself. Switch it off at the unit."
        ),
        AlarmKind::Refused(motion, answer) => {
            format!("{}: {antenna} answered {answer}.", super::motion_name(*motion))
        }
        AlarmKind::Unanswered(motion) => {
            format!("{}: {antenna} did not answer and does not move.", super::motion_name(*motion))
        }
        AlarmKind::CannotTrack(target, reason) => {
            format!("{antenna} does not track {}: {}.", target.name, super::prepare_error(reason))
        }
        AlarmKind::CannotProgramTrack(name, problem) => {
            format!("{antenna} does not follow {name}: {}", super::track_problem(problem, now))
        }
        AlarmKind::OffTarget { deviation, cause } => {
            let deviation_text = format::degrees(deviation.degrees(), 1);
            match cause {
                Some(cause) => {
                    format!("{antenna} is {deviation_text} off its satellite. {}", super::off_because(cause, now))
                }
                None => format!(
                    "{antenna} is {deviation_text} off its satellite. Neither its positions nor the reports of \
                     the unit tell why: check its drives, and the age of its elements."
                ),
            }
        }
        AlarmKind::OffsetsLeft { offsets, reason: left } => super::offsets_left(antenna, *offsets, left, now),
        AlarmKind::OffsetNotTaken(error) => {
            format!("{antenna}: {}", super::offset_not_taken(error))
        }
        AlarmKind::UnitDiffers(ranked) => {
            let likely = cause_of(ranked);
            format!("{antenna}, tracking by itself, would miss its satellite: {likely}.")
        }
        AlarmKind::NotCompared { satellite: Some(name) } => format!(
            "{antenna} tracks {name} by its own program. Azel has no elements of it and cannot \
             tell whether it is on its satellite: add a source that has them."
        ),
        AlarmKind::NotCompared { satellite: None } => format!(
            "{antenna} tracks by its own program and does not report what. Azel cannot tell \
             whether it is on its satellite; its limits and keep-outs are watched."
        ),
        AlarmKind::NoAntennaFor { pass: (_, aos), name } => format!(
            "No antenna is on its way to {name}, AOS {}. Select the pass and track it, or stop a \
             track that is worth less.",
            format::moment(*aos, now)
        ),
        AlarmKind::NotOnItsWay { pass: (_, aos), name, reason } => {
            let cause_words = reason.map_or_else(String::new, |cause| format!(" {}", not_ready(cause)));
            format!(
                "{antenna} is not on its way to {name}, AOS {}, which the schedule assigns to it.{cause_words}",
                format::moment(*aos, now)
            )
        }
        AlarmKind::AutomaticMoves { time: moment, name } => format!(
            "{antenna} will move by itself at {}, for {name}. STOP or Standby prevents it.",
            format::moment(*moment, now)
        ),
        AlarmKind::AutomaticSuspended(interruption) => format!(
            "Automatic operation of {antenna} is suspended. {} Resume it on its card or in Plan.",
            super::automatic::interruption(*interruption)
        ),
        AlarmKind::AutomaticOff(because) => format!(
            "Automatic operation of {antenna} is off. {} Switch it on again in Plan.",
            super::automatic::off_reason(*because)
        ),
        AlarmKind::TrackingEnded => format!("{antenna} ended tracking before LOS."),
        AlarmKind::EndedShort => format!("{antenna} stopped before it reached its target."),
        AlarmKind::StartedByItself => {
            format!("{antenna} tracks by its own program, not by this console.")
        }
        AlarmKind::MovesByItself => format!("{antenna} is moving, but not by this console."),
        AlarmKind::Safety(matter) => super::safety(matter, antenna, now),
        AlarmKind::Owed(unit) => super::owed(unit),
        AlarmKind::DriverStands(stood) => format!(
            "For {} no command could be sent, not even STOP. \
             Use their local panels.",
            format::age(stood.as_secs_f64())
        ),
        AlarmKind::RecordRemoved => "Somebody removed or replaced the file of the record. Azel goes on in \
             a new one. What was recorded before is not in it: bring the old file back from where it \
             went, under another name."
            .to_owned(),
        AlarmKind::NoRecord(reason) => format!(
            "Nothing is being recorded: {reason}. What was recorded is kept, and Azel tries again \
             every 2 s."
        ),
        AlarmKind::BrokeOff(Work::Elements) => {
            "Reading the elements failed inside Azel. The previous elements stay in use; Elements \
             can read the sources again."
                .to_owned()
        }
        AlarmKind::BrokeOff(Work::Schedule) => {
            "Planning the passes failed inside Azel. The schedule stays as it was; it is made \
             again when something changes."
                .to_owned()
        }
        AlarmKind::BrokeOff(Work::Passes) => {
            "The search for passes failed inside Azel. The previous list stays; Search starts it \
             again."
                .to_owned()
        }
        AlarmKind::SourceSetAside(name) => format!(
            "The source {name} is not read: Azel ended while reading it. Check what it holds; \
             Elements can read it again."
        ),
        AlarmKind::SourceFails { source, as_of } => {
            let current = as_of.map_or_else(
                || "It has never returned any.".to_owned(),
                |as_of| {
                    format!("Its elements were last current at {}.", format::moment(as_of, now))
                },
            );
            format!(
                "The source {source} gives no elements. {current} See the cause in Elements. Add another \
                 source or a file before the elements get too old."
            )
        }
        AlarmKind::ElementsOld { name, others } => {
            let others = match others {
                0 => String::new(),
                1 => " and of one other satellite".to_owned(),
                others => format!(" and of {others} other satellites"),
            };
            format!(
                "The elements of {name}{others} will be more than 7 days old at a planned pass, or older \
                 than the station allows. The antenna may miss the pass, or Azel leaves it out. Refresh \
                 the elements."
            )
        }
        AlarmKind::ElementsNotUploaded { reason } => format!(
            "Azel could not upload newer elements to {antenna}: {reason}. The unit keeps its current elements. \
             Azel tries again in an hour. Upload them by hand in Elements to see each step."
        ),
        AlarmKind::NotTaken => {
            format!("{antenna} is too busy: the command was not sent. Try again.")
        }
        AlarmKind::Check(check) => format!("{antenna}: {}. {}", check.name, check.advice),
        AlarmKind::ClockOff(ahead_s) => {
            format!("The clock of {antenna} is {}.", clock::difference(*ahead_s, now))
        }
        AlarmKind::Unreadable(reason) => {
            format!("{antenna}: its position cannot be read. {reason}")
        }
        AlarmKind::ClockNotSet => format!("The clock of {antenna} was never set."),
        AlarmKind::Setting(note) => setting_note(note),
        AlarmKind::SafetySetting { note, antenna } => {
            let note = setting_note(note);
            match antenna {
                Some(antenna) => {
                    format!("{note} Until it is repaired, {antenna} does not move by itself.")
                }
                None => {
                    format!("{note} Until it is repaired, the antennas do not move by themselves.")
                }
            }
        }
        AlarmKind::Settings(text) | AlarmKind::Elements(text) | AlarmKind::LockOuts(text) => {
            super::capitalised(text)
        }
    }
}

/// Returns a note on an entry of the station file, as a sentence.
pub fn setting_note(note: &Note) -> String {
    let line = note.line.map_or_else(String::new, |line| format!(" (line {line})"));
    let place = format!("{}{line}", note.place);
    match &note.reason {
        NoteReason::Invalid(reason) => format!("Setting {place} is not used: {reason}."),
        NoteReason::Unknown => format!("Setting {place} is not known."),
        NoteReason::DoesNotHold { name, reason: explanation } => {
            format!("{name} does not apply: {explanation}. It is {place} in the settings.")
        }
    }
}
