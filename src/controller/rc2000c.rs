//! Behaviour of an RC2000C.

use super::{Capabilities, JogSpeed, JogSpeeds, Make};

/// An RC2000C as the rest of the program knows it.
pub const MAKE: Make = Make {
    key: "rc2000c",
    name: "Research Concepts RC2000C",
    capabilities: Capabilities {
        axes: ["Az", "El"],
        has_program: false,
        takes_positions: true,
        arrives_within_deg: 0.5,
        position_step_deg: 0.0,
        has_elevation: true,
        jog: JogSpeeds::Named(&[
            JogSpeed { name: "Slow", share: 0.25 },
            JogSpeed { name: "Fast", share: 1.0 },
        ]),
        jogs_one_axis: true,
        steps: false,
        ends_jogs: true,
        waits_for_word: true,
        stop_note: None,
    },
    groups: &[],
    actions: &[],
};
