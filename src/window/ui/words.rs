//! Reports of the lower layers as plain sentences: the failure, its reason, the current state, and
//! the remedy.

mod alarms;
pub mod automatic;
mod clock;
mod control;
pub mod flown_with;
pub mod hooks;
mod link_tests;
mod notices;
mod offsets;
mod old_algorithms;
mod on_board;
pub mod pointing;
pub mod record;
mod refusals;
pub mod rehearsal;
mod safety;
pub mod schedule;
mod site;
mod way_there;

use crate::{
    contract::{
        CatalogState,
        antenna::{AntennaModel, Stake},
        driver::Intent,
    },
    controller::SPECS,
    device::{Motion, MotionRequest, SecondAxis, settings::Unfit},
    model::Model,
    orbit::Elements,
    ui::format,
};
pub use alarms::{alarm, alarm_state, alarm_times, off_because, setting_note};
pub use clock::compared_clock;
pub use control::{
    asked_for_control, asks_for_control, connected, in_control, metrics_port_failed, party,
    port_failed,
};
pub use link_tests::{link_test, link_test_faults, link_test_reached, link_test_state, place};
pub use notices::{missing_outlets, notice, reminder, trial};
pub use offsets::{
    OFFSETS_NEED_ELEMENTS, offset, offset_name, offset_not_taken, offset_value, offsets,
    offsets_left, offsets_on_unit, offsets_on_unit_about,
};
pub use old_algorithms::old_algorithms;
pub use on_board::{cause, lower_minimum, not_known, trespass, within_beam, would_miss};
pub use refusals::{
    HOLD_UNCHECKED, HOLD_UNGUARDED, HOLD_UNSEEN, HOLD_WAY_OUT, hindrance, link_loss, not_possible,
    prepare_error, refusal, track_problem,
};
pub use safety::{
    SUN_IS_LIFTED, UNGUARDED, asks_standing, auto_track_owed, drive, forbidden, inside_barrier,
    kept_still, offsets_owed, owed, reason, safety, stopping_way, sun_lifted, way_out,
};
pub use site::{off_the_told, sun_there};
pub use way_there::{WayThere, needs};

/// Age from which Azel mentions old elements, seconds. After some days a satellite in low orbit is
/// minutes away from the prediction.
pub const OLD_ELEMENTS_S: f64 = 7.0 * 86_400.0;

/// Names a request to an antenna, as on its key or button.
pub fn motion_name(request: MotionRequest) -> &'static str {
    let motion = match request {
        MotionRequest::Motion(motion) => motion,
        MotionRequest::Action(key) => return action_name(key),
    };
    match motion {
        Motion::Jog { .. } => "Jog",
        Motion::Step { .. } => "Step",
        Motion::Position { .. } => "Go to",
        Motion::StartProgram => "Track",
        Motion::EnableAuto => "Auto-track on",
    }
}

/// Returns the label of the action with this key, whichever make has it.
fn action_name(key: &str) -> &'static str {
    let mut actions =
        SPECS.iter().flat_map(|spec| spec.variants).flat_map(|variant| variant.actions);
    actions.find(|action| action.key == key).map_or("Action", |action| action.label)
}

/// Names an end of an axis, or the direction towards it, as on the jog keys.
pub fn way(axis: &str, plus: bool) -> String {
    match (axis, plus) {
        ("Az", true) => "CW".to_owned(),
        ("Az", false) => "CCW".to_owned(),
        ("El", true) => "Up".to_owned(),
        ("El", false) => "Down".to_owned(),
        (axis, true) => format!("{axis}+"),
        (axis, false) => format!("{axis}−"),
    }
}

/// Returns a sentence about an ongoing activity of an antenna.
pub fn stake(antenna: &str, stake: &Stake) -> String {
    let short = super::state_sentence::short;
    match stake {
        Stake::OnBoard(Some(name)) => format!("{antenna} tracks {} by itself.", short(name)),
        Stake::OnBoard(None) => format!("{antenna} tracks by itself."),
        Stake::ProgramTracked(name) => format!("Azel tracks {} with {antenna}.", short(name)),
        Stake::Moves => format!("{antenna} moves."),
        Stake::OwesStop => format!("STOP of {antenna} is not confirmed."),
        Stake::Unproved => format!("{antenna} was moved and is not known to have stopped."),
    }
}

/// Returns the reason why a value is invalid, with the unit of measure after the ends of a range.
pub fn unfit(reason: &Unfit, unit: &str) -> String {
    match reason {
        Unfit::Number { .. } | Unfit::Integer { .. } if !unit.is_empty() => {
            let gap = if unit == "°" { "" } else { " " };
            format!("{reason}{gap}{unit}")
        }
        _ => reason.to_string(),
    }
}

/// Returns the reason why a value is invalid, in a few words next to its field.
pub fn unfit_in_short(reason: &Unfit, unit: &str) -> String {
    let only = |min: f64, max: f64| {
        let gap = if unit == "°" || unit.is_empty() { "" } else { " " };
        format!("Must be {min} to {max}{gap}{unit}").replace('-', "−")
    };
    match *reason {
        Unfit::Number { min, max } => only(min, max),
        Unfit::Integer { min, max } => only(min as f64, max as f64),
        _ => capitalised(&reason.to_string()),
    }
}

/// Names an intent.
pub fn intent(intent: Intent) -> &'static str {
    match intent {
        Intent::Standby => "Standby",
        Intent::Manual => "Manual",
        Intent::Position => "Position",
        Intent::Track => "Track",
        Intent::Park => "Park",
    }
}

/// Describes the park position of an antenna, as a sentence.
pub fn parks_at(antenna: &AntennaModel) -> String {
    let park = antenna.config.park_direction();
    let azimuth = format::degrees(park.azimuth_deg(), 1);
    match antenna.variant().capabilities.second_axis {
        SecondAxis::Elevation => {
            let elevation = format::degrees(park.elevation_deg(), 1);
            format!("It parks at azimuth {azimuth}, elevation {elevation}.")
        }
        SecondAxis::Other(_) | SecondAxis::Absent => format!("It parks at azimuth {azimuth}."),
    }
}

/// Returns a problem reported by a lower layer, as a sentence.
pub fn sentence(problem: &str) -> String {
    let words = capitalised(problem);
    if words.ends_with('.') { words } else { format!("{words}.") }
}

/// Returns the text with its first letter capitalised.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase).into_iter().flatten();
    first.chain(letters).collect()
}

/// Returns the short name of a satellite by its catalog number, or the number if it has no name.
pub fn satellite(model: &Model, number: u32) -> String {
    let name = match &model.catalog {
        CatalogState::Ready(catalog) => catalog.get(number).map(Elements::short_name),
        CatalogState::Loading | CatalogState::Failed => None,
    };
    name.filter(|name| !name.is_empty()).map_or_else(|| number.to_string(), str::to_owned)
}
