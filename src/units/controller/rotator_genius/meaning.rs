//! Meaning of a command, for the wire log.

use std::borrow::Cow;

use crate::{
    device::{Meaning, panel::Tone},
    protocol::rotator_genius::{Configuration, Direction, Motion, Request, RotatorKind},
};

/// Returns the meaning of a command; `None` if the document has no such command.
pub(super) fn of_sent(bytes: &[u8]) -> Option<Meaning> {
    let text: Cow<'static, str> = match Request::parse(bytes).ok()? {
        Request::Read => "Asks for the status".into(),
        Request::Stop => "Stops both rotators".into(),
        Request::Motion(Motion::GoTo { rotator, target }) => {
            format!("Turns rotator {} to {target}°", rotator.number()).into()
        }
        Request::Motion(Motion::Rotate { rotator, direction }) => {
            let way = match direction {
                Direction::Clockwise => "clockwise",
                Direction::CounterClockwise => "counter-clockwise",
            };
            format!("Turns rotator {} {way} until stopped", rotator.number()).into()
        }
        Request::Configure(configuration) => configured(&configuration).into(),
    };
    Some(Meaning { tone: Tone::Plain, text })
}

fn configured(configuration: &Configuration) -> String {
    let kind = match configuration.kind() {
        RotatorKind::Azimuth => "azimuth",
        RotatorKind::Elevation => "elevation",
    };
    format!(
        "Configures rotator {}, {}: {kind}, limits {}° CCW and {}° CW, stop offset {}°",
        configuration.rotator().number(),
        configuration.name().as_str(),
        configuration.limit_ccw(),
        configuration.limit_cw(),
        configuration.stop_offset_deg(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_tell_the_rotator_and_the_angle() {
        for (bytes, words) in [
            (&b"|h"[..], "Asks for the status"),
            (b"|S", "Stops both rotators"),
            (b"|A1130", "Turns rotator 1 to 130°"),
            (b"|P2", "Turns rotator 2 clockwise until stopped"),
            (b"|M1", "Turns rotator 1 counter-clockwise until stopped"),
            (
                b"|c2350010E05Top       ",
                "Configures rotator 2, Top: elevation, limits 10° CCW and 350° CW, stop offset 5°",
            ),
        ] {
            assert_eq!(of_sent(bytes).unwrap().text, words);
        }
        assert_eq!(of_sent(b"|x"), None);
    }
}
