//! Sentences about safety.

use jiff::Timestamp;

use super::clock;
use crate::{
    contract::driver::{
        AxisLessons, Breach, Evidence, Mover, Response, Safety, Snapshot, StopState, StoppingWay,
        Unit, Unlike,
    },
    controller::SPECS,
    plan::Barrier,
    station::Station,
    ui::format,
};

/// Describes a barrier as the goal of a motion, such as "too close to the Sun".
pub fn forbidden(barrier: &Barrier) -> String {
    match barrier {
        Barrier::MinimumElevation => "below its minimum elevation".to_owned(),
        Barrier::KeepOut(name) => format!("into the keep-out \u{201c}{name}\u{201d}"),
        Barrier::Sun => "too close to the Sun".to_owned(),
        Barrier::Unread(place) => {
            format!("where only the unreadable setting {place} would tell whether it may point")
        }
    }
}

/// Describes a barrier as the position of an antenna.
pub fn inside_barrier(barrier: &Barrier) -> String {
    match barrier {
        Barrier::KeepOut(name) => format!("inside \u{201c}{name}\u{201d}"),
        Barrier::MinimumElevation | Barrier::Sun | Barrier::Unread(_) => forbidden(barrier),
    }
}

/// Returns the reason why an antenna inside a barrier, or possibly inside, does not move.
pub fn kept_still(antenna: &str, Breach { barrier, unknown_axis, .. }: &Breach) -> String {
    if let Barrier::Unread(setting) = barrier {
        return format!(
            "{antenna} does not move by itself: the setting {setting} could not be read."
        );
    }
    let place = inside_barrier(barrier);
    match (unknown_axis, barrier) {
        (Some(axis), _) => {
            format!("{antenna} may be {place}: the angle of {axis} is not known.")
        }
        (None, Barrier::Sun) => format!("{antenna} points {place}."),
        (None, _) => format!("{antenna} stands {place} and leaves it by hand alone."),
    }
}

/// Describes the motions allowed to an antenna that is, or may be, inside a barrier. `may_leave` is
/// `true` if the operator has allowed them.
pub fn way_out(antenna: &str, Breach { barrier, unknown_axis, may_leave }: &Breach) -> String {
    if let Barrier::Unread(setting) = barrier {
        let unread = format!(
            "The setting {setting} could not be read, so {antenna} does not move by itself."
        );
        return if *may_leave {
            format!("{unread} You have allowed slow motion by hand for a minute, unchecked.")
        } else {
            format!(
                "{unread} Repair it in the station file, or hold the button to move it slowly by hand for a minute."
            )
        };
    }
    let place = inside_barrier(barrier);
    if let Some(axis) = unknown_axis {
        let unknown = format!("The angle of {axis} is not known: {antenna} may be {place}.");
        return if *may_leave {
            format!(
                "{unknown} You have allowed slow motion by hand for a minute. Azel does not check \
                 where it leads, so watch the antenna."
            )
        } else {
            format!("{unknown} Hold the button to move it slowly by hand for a minute, unchecked.")
        };
    }
    match (may_leave, barrier) {
        (false, Barrier::Sun) => {
            format!("{antenna} is {place} now. It may move away from it, not nearer.")
        }
        (false, _) => {
            format!("{antenna} is {place} now. It can be moved out by hand once you allow it.")
        }
        (true, _) => format!(
            "{antenna} is {place}. You have allowed it to be moved out by hand for a minute, \
             slowly and outwards only."
        ),
    }
}

/// Returns the consequence of following the Sun with `antenna` under Sun avoidance of `radius_deg`.
pub fn sun_lifted(antenna: &str, radius_deg: f64) -> String {
    format!(
        "The Sun avoidance keeps {antenna} {} away from the Sun. The hold lifts it for this track \
         alone.",
        format::degrees(radius_deg, 1)
    )
}

/// Note while an antenna follows the Sun.
pub const SUN_IS_LIFTED: &str =
    "You have lifted the Sun avoidance for this track alone. STOP ends both.";

/// Returns the operator's reason for a keep-out, to append to a sentence; empty without a reason.
pub fn reason(barrier: &Barrier, station: &Station) -> String {
    let Barrier::KeepOut(name) = barrier else { return String::new() };
    let keep_out = station.keep_outs.iter().find(|zone| zone.name == name.as_str());
    let reason = keep_out.map_or("", |zone| zone.reason.trim().trim_end_matches('.'));
    if reason.is_empty() {
        return String::new();
    }
    format!(" \u{201c}{name}\u{201d}: {reason}.")
}

/// Describes the overrun of an antenna, and the source of that value.
pub fn stopping_way(StoppingWay { overrun_s, stops, is_learned }: StoppingWay) -> String {
    let overrun = format!("Coasts for {} s", format::number(overrun_s, 1));
    let enough = StoppingWay::ENOUGH;
    if is_learned {
        return format!("{overrun}: the longest of the last {enough} of {stops} STOPs.");
    }
    format!(
        "{overrun}: the default of its make, until {enough} STOPs are measured ({stops} so far)."
    )
}

/// Describes the learned properties of a drive, and the properties still to learn.
pub fn drive(lessons: &AxisLessons) -> String {
    let properties = [
        (
            "dead time",
            lessons.dead_time_s().map(|s| format!("starts within {} s", format::number(s, 1))),
        ),
        (
            "top rate",
            lessons
                .max_rate_deg_s()
                .map(|rate| format!("turns at up to {}/s", format::degrees(rate, 1))),
        ),
        (
            "coasting",
            lessons
                .runs_past_deg()
                .map(|deg| format!("runs up to {} past a target", format::degrees(deg, 1))),
        ),
        (
            "noise",
            lessons
                .spread_deg()
                .map(|deg| format!("reads within {} at rest", format::degrees(deg, 2))),
        ),
    ];
    let learned: Vec<String> = properties.iter().filter_map(|(_, figure)| figure.clone()).collect();
    let assumed: Vec<&str> =
        properties.iter().filter(|(_, figure)| figure.is_none()).map(|(name, _)| *name).collect();
    let mut sentences = Vec::new();
    if !learned.is_empty() {
        sentences.push(format!("The drive {}.", format::list(&learned)));
    }
    if !assumed.is_empty() {
        sentences.push(format!(
            "Azel assumes the worst until it has learned {}.",
            format::list(&assumed)
        ));
    }
    sentences.join(" ")
}

/// The reason why jogging waits for the operator's permission.
pub const UNGUARDED: &str = "The dead-man timer could not be started: if Azel ended while the \
     key is held, nothing would stop the antenna.";

/// Returns the reason for asking the operator to confirm that the antenna stands still.
pub fn asks_standing(snapshot: &Snapshot, now: Timestamp) -> Option<String> {
    if let StopState::NotConfirmed { .. } = snapshot.stop {
        let reason = "STOP is repeated until the antenna is known to be at rest. Look at it before \
                   you confirm.";
        return Some(reason.to_owned());
    }
    let ended = ended_at(snapshot.left_moving?.start, now);
    Some(format!("{ended} while the antenna was moved. Look at it before you confirm."))
}

/// Describes the end of an earlier run of Azel. The record of that run may be damaged.
fn ended_at(start: Option<Timestamp>, now: Timestamp) -> String {
    start.map_or_else(
        || "Azel ended at an unknown time".to_owned(),
        |start| format!("Azel ended at {}", format::moment(start, now)),
    )
}

/// Returns the sentence about an owed STOP of a unit that no longer belongs to an antenna.
pub fn owed(unit: &Unit) -> String {
    format!(
        "{} may still move: STOP is not confirmed, and no antenna of this station uses this unit. \
         Look at the antenna. If Azel does not reach it, add it to the station and press STOP.",
        at_its_address(unit)
    )
}

/// Returns the sentence about auto-track of a unit that no longer belongs to an antenna.
pub fn auto_track_owed(unit: &Unit) -> String {
    format!(
        "{} may still track by itself. No antenna of this station uses this unit any more. Azel \
         keeps trying to switch its auto-track off; check it at the unit.",
        at_its_address(unit)
    )
}

/// Returns the sentence about offsets on a unit that no longer belongs to an antenna.
pub fn offsets_owed(unit: &Unit) -> String {
    format!(
        "{} may still add offsets that were written for a pass. No antenna of this station uses this \
         unit any more. Add one with this address to take them back, or set them at the unit.",
        at_its_address(unit)
    )
}

fn at_its_address(Unit { make, address }: &Unit) -> String {
    let controller_spec = SPECS.iter().find(|controller_spec| controller_spec.key == make);
    format!(
        "The {} at {address}",
        controller_spec.map_or(make.as_str(), |controller_spec| controller_spec.name)
    )
}

/// Returns the difference of a unit from its earlier state, as a sentence after a blank.
fn unlike(unlike: Unlike) -> &'static str {
    match unlike {
        Unlike::Identity => {
            " It answers with another name or firmware than before: check that it is the same \
             unit."
        }
        Unlike::Limits => " Its limits have changed: check its settings.",
        Unlike::Place => " The location it reports has changed: check its settings.",
        Unlike::Position => " It does not point where it was left.",
        Unlike::Offsets => " Its offsets have changed: check its settings.",
        Unlike::Unread => " It has not reported again what it reported before.",
    }
}

/// Describes a motion that Azel did not command. Only a jog proves that a person caused it; an
/// angle does not distinguish a person from wind or a drive.
fn foreign_hands(antenna: &str, axis: &str, evidence: Evidence) -> String {
    let moved = match evidence {
        Evidence::Outside { off_deg } => format!(
            "{antenna} turned without a command from Azel: {axis} reads {} away from where its commands \
             lead. Somebody at its panel, another program, wind or its drive may have moved it.",
            format::degrees(off_deg.abs(), 1)
        ),
        Evidence::Jogged => format!(
            "Somebody else moved {antenna}, at its panel or by another program: its unit reports a jog \
             of {axis} that Azel did not send."
        ),
        Evidence::Runaway => format!(
            "{antenna} turned without a command: its unit reports that {axis} runs away. Look at its \
             drive and its relays."
        ),
    };
    format!(
        "{moved} Azel does not move it on. Find out what moved it before you move it again. After work \
         on its drives, reset their learned figures in Preferences."
    )
}

/// Describes a safety event; `antenna` is the name of the antenna.
pub fn safety(matter: &Safety, antenna: &str, now: Timestamp) -> String {
    match matter {
        Safety::DeadManFired => format!(
            "{antenna} was stopped by the dead-man timer: Azel was late. Press the key again to \
             move it."
        ),
        Safety::LeftMoving { start: begin, asks: false } => format!(
            "{} while {antenna} was moved by hand. STOP was sent first.",
            ended_at(*begin, now)
        ),
        Safety::LeftMoving { start: begin, asks: true } => format!(
            "{} while {antenna} was moved by hand, and nobody has seen it at rest since. Press STOP, \
             or confirm that you have seen it at rest.",
            ended_at(*begin, now)
        ),
        Safety::NoMark => format!(
            "Azel could not record on disk that {antenna} is moving by hand or still needs a STOP. If \
             Azel ends now, it will not send that STOP at its next start. Check the free space and \
             the permissions of the disk."
        ),
        Safety::StoppedByFlags { axis } => format!(
            "{antenna} reports that it is at rest. {axis} reports no angle, so nothing else \
             confirms it."
        ),
        Safety::FlagsContradict { axis, turned_deg } => format!(
            "{antenna} reports that it is at rest, but {axis} has turned by {}. Look at the \
             antenna.",
            format::degrees(turned_deg.abs(), 1)
        ),
        Safety::SilentInMotion => format!(
            "{antenna} does not answer while it moves or may still move: where it is now is not \
             known. Look at it. STOP reaches it as soon as the link does; before that use the \
             local panel."
        ),
        Safety::NoEffect { axis } => {
            let angle = axis.map_or("its angles".to_owned(), |axis| format!("the angle of {axis}"));
            format!(
                "{antenna} was stopped: it took the command, but {angle} did not change. Check \
                 drive, brake and sensor before you move it again."
            )
        }
        Safety::ForeignHands { axis, evidence } => foreign_hands(antenna, axis, *evidence),
        Safety::OffTarget { off_deg, cause } => {
            let deviation_text = format::degrees(*off_deg, 1);
            let reason = match cause {
                Some(cause) => super::off_because(cause, now),
                None => "Check its drives, clock and offsets.".to_owned(),
            };
            format!(
                "{antenna} stayed {deviation_text} off its target for too long. Azel stopped it and gave up \
                 the pass. {reason}"
            )
        }
        Safety::Forbidden { barrier, driver, response } => {
            let driver = match driver {
                Mover::Azel => "Azel was moving it",
                Mover::Program => "its own program was moving it",
                Mover::Somebody => "Azel was not moving it",
            };
            let forbidden_part = forbidden(barrier);
            match response {
                Response::Stopped => {
                    format!("{antenna} was stopped before it went {forbidden_part}; {driver}.")
                }
                Response::Reported => {
                    format!("{antenna} is {}; {driver}.", inside_barrier(barrier))
                }
            }
        }
        Safety::ClockStepped { by_s, time } => format!(
            "The clock of this computer was changed {}. {antenna} does not continue by itself with \
             anything that depends on it.",
            clock::step(*by_s, *time)
        ),
        Safety::EndedForSleep => format!(
            "This computer is going to sleep: the jog of {antenna} was ended. Press the key again \
             to move it."
        ),
        Safety::Slept { lasted } => format!(
            "This computer slept for {}. {antenna} is being read again.",
            format::age(lasted.as_secs_f64())
        ),
        Safety::AsksToResume { name, lost, unlike } => format!(
            "{antenna} was tracking {name} and was out of sight for {}.{} It stays stopped until \
             you track it again.",
            format::age(lost.as_secs_f64()),
            unlike.map(self::unlike).unwrap_or_default()
        ),
        Safety::UnitDiffers { unlike } => format!(
            "{antenna} was out of reach.{} Check it before you move it.",
            self::unlike(*unlike)
        ),
        Safety::SessionBroke => {
            format!("The connection to {antenna} failed inside Azel and was restarted with STOP.")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_of_no_antenna_is_named_by_its_make_and_address() {
        let unit = |make: &str| Unit { make: make.to_owned(), address: "10.0.0.7:9".to_owned() };
        assert!(owed(&unit("genius")).starts_with("The 4O3A Rotator Genius at 10.0.0.7:9"));
        assert!(auto_track_owed(&unit("satrak")).starts_with("The SVS Satrak at 10.0.0.7:9 may"));
        let offsets = offsets_owed(&unit("satrak"));
        assert!(offsets.starts_with("The SVS Satrak at 10.0.0.7:9 may still add"), "{offsets}");
    }
}
