//! The actions that only a Rotator Genius has.

use std::time::Duration;

use crate::device::{
    panel::Action,
    settings::{Field, Key},
};

/// Key of the action that turns the rotator that does not belong to the antenna.
pub const OTHER: &str = "other";
/// Key of the action that allows a jog outside the limits.
pub const RESCUE: &str = "rescue";

/// Heading for [`OTHER`], whole degrees.
pub(super) const DIRECTION: Key<i64> = Key::integer("direction_deg", 0, 360);
/// Time for which a rescue stays armed, unless the operator's STOP ends it earlier.
pub(super) const ARMED: Duration = Duration::from_mins(1);

pub(super) const SEND_OTHER: Action = Action {
    key: OTHER,
    label: "Send the other rotator",
    description: "Turns the rotator that is not this antenna's. STOP stops both.",
    fields: &[Field::edit(DIRECTION, "Direction")
        .in_unit("°")
        .description("In that rotator's own degrees.")],
    moves: true,
    question: None,
};

pub(super) const ARM_RESCUE: Action = Action {
    key: RESCUE,
    label: "Allow jogs outside limits",
    description: "For a minute or until STOP, a rotator outside its limits may be jogged back. The \
            device does not end such a motion by itself: Azel stops it when the key is let go \
            and when a reply is missing.",
    fields: &[],
    moves: false,
    question: Some(
        "Outside the limits nothing but STOP ends a motion, and a lost link leaves it running. \
         Is somebody watching the antenna?",
    ),
};
