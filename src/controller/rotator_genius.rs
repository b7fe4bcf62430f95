//! Behaviour of a Rotator Genius.

use super::{Capabilities, JogSpeed, JogSpeeds, Make};

/// The one speed of its rotators.
const SPEEDS: JogSpeeds = JogSpeeds::Named(&[JogSpeed { name: "Turn", share: 1.0 }]);

/// A Rotator Genius whose rotators turn azimuth and elevation of one antenna.
pub const PAIR: Make = Make {
    key: "genius",
    name: "4O3A Rotator Genius",
    capabilities: Capabilities {
        axes: ["Az", "El"],
        has_program: false,
        takes_positions: true,
        arrives_within_deg: 1.5,
        position_step_deg: 1.0,
        has_elevation: true,
        jog: SPEEDS,
        jogs_one_axis: true,
        steps: false,
        ends_jogs: false,
        waits_for_word: false,
        stop_note: Some("STOP stops both rotators."),
    },
    groups: &[],
    actions: &[],
};

/// A Rotator Genius of which one rotator turns the azimuth of the antenna and
/// the other something else.
pub const ALONE: Make = Make {
    capabilities: Capabilities { axes: ["Az", "Other"], has_elevation: false, ..PAIR.capabilities },
    ..PAIR
};
