//! The reasons of refusals and failures.

use jiff::Timestamp;

use crate::{
    contract::driver::{LinkLoss, Refusal, TrackProblem},
    device::{PrepareError, settings::Hindrance},
    ui::format,
};

/// Label of the hold button for an action whose end only the unit knows.
pub const HOLD_UNSEEN: &str = "Hold 1 s to start it without knowing where it ends";
/// Label of the hold button that allows moving an antenna out of a forbidden zone.
pub const HOLD_WAY_OUT: &str = "Hold 1 s to move out by hand";
/// Label of the hold button that permits a motion by hand while the angle of an axis is unknown.
pub const HOLD_UNCHECKED: &str = "Hold 1 s to move unchecked";
/// Label of the hold button that allows motion without a dead-man timer.
pub const HOLD_UNGUARDED: &str = "Hold 1 s to move without the dead-man timer";

/// Returns the reason why a motion was not sent.
// The match has one arm for each kind.
#[allow(clippy::too_many_lines)]
pub fn refusal(refusal: &Refusal, now: Timestamp) -> String {
    match refusal {
        Refusal::LockedOut { operator: author, reason } => {
            format!("Not sent: in maintenance, locked out by {author}: {reason}.")
        }
        Refusal::PanelLockedOut { operator: author } => format!(
            "Not connected: in maintenance by {author}, and even a query would take the panel of \
             this unit from the person working at it. STOP still goes out. Remove the lock-out \
             first."
        ),
        Refusal::Elsewhere(author) => format!("Not sent: {author} drives this unit."),
        Refusal::PositionUnknown => {
            "Not sent: the position of the antenna is not known.".to_owned()
        }
        Refusal::PositionOld(age) => {
            format!("Not sent: the last position is {} old.", format::age(age.as_secs_f64()))
        }
        Refusal::Intent(intent) => {
            format!("Not sent: not possible in {}. Choose another mode.", super::intent(*intent))
        }
        Refusal::Fault => "Not sent: a fault of the unit forbids motion. See Faults.".to_owned(),
        Refusal::FaultsUnknown => {
            "Not sent: the unit has not reported its faults yet. Try again.".to_owned()
        }
        Refusal::Limit { axis, plus } => {
            let (end, back) = (super::way(axis, *plus), super::way(axis, !*plus));
            format!("Not sent: {end} limit switch is set. Jog {back} to leave the limit.")
        }
        Refusal::Nothing => "Not sent: no motion was asked for.".to_owned(),
        Refusal::TooFast { asked_deg_s, allowed_deg_s } => format!(
            "Not sent: {} °/s is faster than the {} °/s allowed.",
            format::number(*asked_deg_s, 2),
            format::number(*allowed_deg_s, 2)
        ),
        Refusal::StepTooLarge { asked_deg, allowed_deg } => format!(
            "Not sent: a step of {} is larger than the {} allowed.",
            format::degrees(*asked_deg, 1),
            format::degrees(*allowed_deg, 1)
        ),
        Refusal::Elevation { asked_deg, lowest_deg } => format!(
            "Not sent: elevation {} is not between {} and 90°.",
            format::degrees(*asked_deg, 1),
            format::degrees(*lowest_deg, 1)
        ),
        Refusal::Travel { axis, asked_deg, from_deg, to_deg } => format!(
            "Not sent: {axis} would have to go to {}, beyond its travel of {} to {}.",
            format::degrees(*asked_deg, 1),
            format::degrees(*from_deg, 1),
            format::degrees(*to_deg, 1)
        ),
        Refusal::NotOffered => "Not sent: this controller cannot do that.".to_owned(),
        Refusal::AngleUnknown { axis } => {
            format!("Not sent: the angle of {axis} is not known, so nobody would see it turn.")
        }
        Refusal::OneAxis => "Not sent: this controller turns one axis at a time.".to_owned(),
        Refusal::Forbidden { barrier, direction } => format!(
            "Not sent: the path leads {}, at {}.",
            super::forbidden(barrier),
            format::pointing_at(*direction)
        ),
        Refusal::Inside(barrier) => format!(
            "Not sent: the antenna is {}. Use \u{201c}{HOLD_WAY_OUT}\u{201d} on its card to allow it for a \
             minute.",
            super::inside_barrier(barrier)
        ),
        Refusal::Unchecked { axis, barrier } => format!(
            "Not sent: {axis} reports no angle, so the motion may lead {}. Hold \
             \u{201c}{HOLD_UNCHECKED}\u{201d} on the card to allow slow motion by hand for a minute.",
            super::forbidden(barrier)
        ),
        Refusal::SettingsUnread { place } => format!(
            "Not sent: Azel could not read the setting {place}. Repair it in the station file. Until \
             then, hold \u{201c}{HOLD_UNCHECKED}\u{201d} on the card to move slowly by hand."
        ),
        Refusal::NoRefuge => "Not sent: no clear direction with a clear path to it was found. \
                              Move the antenna by hand."
            .to_owned(),
        Refusal::Controller(explanation) => format!("Not sent: {explanation}."),
        Refusal::Unseen { reason: explanation, is_watched, .. } => {
            let watched = if *is_watched {
                "Azel stops the antenna before a forbidden direction"
            } else {
                "its angles are not known, so somebody has to look at the antenna"
            };
            format!(
                "Not sent: {explanation}. Use \u{201c}{HOLD_UNSEEN}\u{201d} on its card to start it \
                 anyway: {watched}."
            )
        }
        Refusal::StillMoving => {
            "Not sent: the antenna is still moving. Step again when it has stopped.".to_owned()
        }
        Refusal::Unguarded => format!(
            "Not sent: nothing would stop the antenna if Azel ended. Use \
             \u{201c}{HOLD_UNGUARDED}\u{201d} on its card to allow it for a minute."
        ),
        Refusal::Stopping => "Not sent: a stop is under way.".to_owned(),
        Refusal::PassUnknown => "Not sent: the pass is not known. Choose it again.".to_owned(),
        Refusal::NoTrack => {
            "Not sent: nothing is tracked that an offset could be added to.".to_owned()
        }
        Refusal::OffsetsUnknown => {
            "Not sent: what the unit adds to its track has not been read yet. Try again.".to_owned()
        }
        Refusal::NoOffsetsRecord => {
            "Not sent: what the unit held before could not be recorded on disk, and would be lost if \
             Azel ended. Make room on the disk."
                .to_owned()
        }
        Refusal::TargetStands => {
            "Not sent: the target does not move, so nothing is along or across its track. Use \
             azimuth and elevation."
                .to_owned()
        }
        Refusal::OffsetTooLarge { max } => {
            format!("Not sent: an offset {} is the largest allowed.", super::offset(*max))
        }
        Refusal::OrbitUnknown { name } => format!(
            "Not sent: the unit holds {name}, and Azel has no elements of it: where it would point \
             is not known. Load its elements, or choose another satellite."
        ),
        Refusal::InControl(party) => format!(
            "Not sent: {} controls the antenna. Release control or hand it over first.",
            super::party(*party)
        ),
        Refusal::NotAllowed => "Not sent: you have not allowed the program to point the antenna. \
                                Hand control over on its card."
            .to_owned(),
        Refusal::ClientGone => "Not sent: the program has hung up.".to_owned(),
        Refusal::Closing => "Not sent: Azel is closing. Choose to stay open first.".to_owned(),
        Refusal::BeingJudged => "Not sent: what the unit reports changes while Azel judges the way. Try \
                                 again."
            .to_owned(),
        Refusal::WindowTooLong { hours } => format!(
            "Not sent: the unit's tracking window is {} days long, and Azel checks 24 hours at most. \
             Set a shorter window under Antennas.",
            format::number(hours / 24.0, 1)
        ),
        Refusal::NoDirection { time: moment } => format!(
            "Not sent: the elements give no direction at {}, so Azel cannot check where the unit would \
             point. Load newer elements or set a shorter window under Antennas.",
            format::moment(*moment, now)
        ),
        Refusal::TooLow { highest_deg, lowest_deg } => format!(
            "Not sent: the rest of the pass is not above the {} of this antenna; the pass \
             reaches {}.",
            format::degrees(*lowest_deg, 1),
            format::degrees(*highest_deg, 1)
        ),
        Refusal::Path(trespass) => super::trespass(trespass, now),
        Refusal::Setting { field, hindrance: cause } => format!("{field} was not sent. {}", hindrance(*cause)),
    }
}

/// Returns the reason why Azel would refuse a motion that nobody has requested yet.
pub fn not_possible(refusal: &Refusal, now: Timestamp) -> String {
    let words = self::refusal(refusal, now);
    match words.strip_prefix("Not sent: ") {
        Some(reason) => format!("Not possible: {reason}"),
        None => words,
    }
}

/// Returns the reason why a setting that affects pointing must wait, and the remedy.
pub fn hindrance(hindrance: Hindrance) -> String {
    super::sentence(&hindrance.to_string())
}

/// Returns the reason why a target is not tracked, or no longer tracked.
pub fn track_problem(problem: &TrackProblem, now: Timestamp) -> String {
    match problem {
        TrackProblem::NoPass => "it does not rise in the next days.".to_owned(),
        TrackProblem::NoAngle => {
            "an axis reports no angle. Check its sensor and the cable.".to_owned()
        }
        TrackProblem::Orbit(_) => "its elements do not say where it is.".to_owned(),
        TrackProblem::Refused(reason) => {
            let words = refusal(reason, now);
            words.strip_prefix("Not sent: ").map_or_else(|| words.clone(), str::to_owned)
        }
    }
}

/// Returns the reason why a link is lost.
pub fn link_loss(loss: &LinkLoss) -> String {
    match loss {
        LinkLoss::Refused(reason) => format!("the connection was not made ({reason})"),
        LinkLoss::ConnectTimeout => "nobody answers at the address".to_owned(),
        LinkLoss::Closed => "the unit closed the connection".to_owned(),
        LinkLoss::Broken(reason) => format!("the connection broke ({reason})"),
        LinkLoss::Slept => "this computer slept; the unit is being read again".to_owned(),
        LinkLoss::Unreadable => "the unit's answers cannot be read".to_owned(),
        LinkLoss::OtherDevice => {
            "another device answers there, or one that asks for a code first".to_owned()
        }
        LinkLoss::Silent => "the connection is open, but the unit is silent".to_owned(),
    }
}

/// Returns the reason why a satellite is not on the unit.
pub fn prepare_error(error: &PrepareError) -> String {
    match error {
        PrepareError::CannotBeSent(reason) => format!("it cannot be sent: {reason}"),
        PrepareError::Refused(answer) => format!("the unit answered {answer}"),
        PrepareError::Unanswered => "the unit did not answer".to_owned(),
        PrepareError::Differs { current } => format!("the unit still holds {current}"),
        PrepareError::NotOnDevice { file } => {
            format!("the unit has no elements of it in {file}")
        }
        PrepareError::NoElementFile => {
            "the unit uses no element file yet, name one in Preferences".to_owned()
        }
        PrepareError::Stopped => "STOP came in between".to_owned(),
    }
}
