//! The description of a Rotator Genius.

use super::{GROUPS, Genius, actions};
use crate::{
    device::{
        Capabilities, Effect, JogSpeed, JogSpeeds, SecondAxis, Standstill, Variant,
        settings::{Field, Key, Value},
    },
    station::{
        AfterPass, Antenna, Connection, ControllerSpec, DefaultFigures, Direction, Link,
        MotionLimits, Mount, PollRates, Setting, TrackSettings,
    },
};

const SPEEDS: JogSpeeds = JogSpeeds::Named(&[JogSpeed { name: "Turn", share: 1.0 }]);

/// Description of a Genius that turns azimuth and elevation unless [`ROTATORS`] says otherwise.
pub static SPEC: ControllerSpec = ControllerSpec {
    key: "genius",
    name: "4O3A Rotator Genius",
    short_name: "Genius",
    link: Link::Tcp,
    default_address: "192.168.1.250:9006",
    defaults: DefaultFigures {
        mount: Mount::AzEl {
            azimuth_from_deg: 0.0,
            azimuth_to_deg: 360.0,
            elevation_from_deg: 0.0,
            // The antenna turns over the zenith only if the operator allows it.
            elevation_to_deg: 90.0,
        },
        beam_width_deg: 20.0,
        park: Direction { azimuth_deg: 0.0, elevation_deg: 0.0 },
        limits: MotionLimits {
            minimum_elevation_deg: 0.0,
            maximum_rate_deg_s: 4.0,
            maximum_step_deg: 10.0,
        },
        poll: PollRates { idle_hz: 2.0, moving_hz: 4.0 },
        follow: TrackSettings {
            period_s: 1.0,
            dead_band_deg: 0.5,
            latency_s: 0.5,
            after: AfterPass::Hold,
        },
        set_up_s: 2.0,
    },
    settings: &[&ROTATORS],
    closed_note: Some("Perhaps another program holds the connection."),
    element_files: None,
    explain: None,
    why_no_question: None,
    variants: &[&PAIR, &ALONE],
    variant: |connection| match Rotators::from_connection(connection) {
        Rotators::Pair => &PAIR,
        Rotators::First | Rotators::Second => &ALONE,
    },
    open: |antenna| {
        Box::new(Genius::new(antenna.poll, Rotators::from_connection(&antenna.connection)))
    },
};

/// Variant of a unit whose two rotators turn the same antenna.
pub static PAIR: Variant = Variant {
    capabilities: Capabilities {
        axes: ["Az", "El"],
        has_program: false,
        takes_positions: true,
        arrives_within_deg: 1.5,
        position_step_deg: 1.0,
        azimuth_wraps: true,
        second_axis: SecondAxis::Elevation,
        jog: SPEEDS,
        jogs_one_axis: true,
        steps: false,
        ends_jogs: false,
        waits_for_word: false,
        // Readings are whole degrees; the slowest rotators of this unit take two minutes a turn.
        standstill: Standstill { resolution_deg: 1.0, slowest_deg_s: 3.0, overrun_s: 0.8 },
        effect: Effect { shows_after_s: 5.0, ignores_deg: 10.0 },
        stop_note: Some("STOP stops both rotators."),
    },
    groups: GROUPS,
    track_offsets: None,
    clock: None,
    actions: &[actions::ARM_RESCUE],
};

/// Variant of a unit that turns the azimuth of the antenna and another device.
pub static ALONE: Variant = Variant {
    capabilities: Capabilities {
        axes: ["Az", "Other"],
        second_axis: SecondAxis::Other("other rotator"),
        ..PAIR.capabilities
    },
    groups: GROUPS,
    track_offsets: None,
    clock: None,
    actions: &[actions::SEND_OTHER, actions::ARM_RESCUE],
};

/// Setting with a value of [`Rotators`].
pub static ROTATORS: Setting = Setting::new(
    Field::edit(
        Key::word(
            "rotators",
            &[
                (PAIR_WORD, "Azimuth + elevation"),
                (FIRST_WORD, "Only rotator 1"),
                (SECOND_WORD, "Only rotator 2"),
            ],
        ),
        "Rotators of this antenna",
    ),
    || Rotators::Pair.into(),
)
.noted(|value| {
    let is_alone = *value != Rotators::Pair.into();
    is_alone.then_some("It turns the azimuth; the other rotator turns something else.")
});

const PAIR_WORD: &str = "pair";
const FIRST_WORD: &str = "first";
const SECOND_WORD: &str = "second";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rotators {
    Pair,
    First,
    Second,
}

impl Rotators {
    /// Returns the rotators of a Genius with this connection.
    pub fn from_connection(connection: &Connection) -> Self {
        match connection.text(&ROTATORS) {
            FIRST_WORD => Self::First,
            SECOND_WORD => Self::Second,
            _ => Self::Pair,
        }
    }
}

impl From<Rotators> for Value {
    fn from(rotators: Rotators) -> Self {
        Self::from(match rotators {
            Rotators::Pair => PAIR_WORD,
            Rotators::First => FIRST_WORD,
            Rotators::Second => SECOND_WORD,
        })
    }
}

impl Antenna {
    /// Returns a Rotator Genius at `address` that turns azimuth and elevation, with default
    /// figures.
    pub fn genius(name: &str, address: &str) -> Self {
        SPEC.antenna(name, address)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_rotators_say_which_variant_it_is() {
        let mut connection = SPEC.connection("h:9006");
        for (rotators, has_elevation) in
            [(Rotators::First, false), (Rotators::Second, false), (Rotators::Pair, true)]
        {
            connection.put(&ROTATORS, rotators).unwrap();
            assert_eq!(Rotators::from_connection(&connection), rotators);
            assert_eq!(connection.variant().capabilities.has_elevation(), has_elevation);
        }
    }
}
