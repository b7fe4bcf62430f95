//! Replies of the unit, byte for byte as recorded, or in the form that the quirks request.

use std::collections::BTreeSet;

use super::Quirk;
use super::rotor::Rotor;
use crate::protocol::rotator_genius::{Moving, WholeDegrees};

/// Placeholder for a missing angle.
const NONE: u16 = 999;

/// Returns the reply to `|h`.
pub(super) fn status(rotors: &[Rotor; 2], panic: u8, quirks: &BTreeSet<Quirk>) -> Vec<u8> {
    let active = if quirks.contains(&Quirk::Active0) { b'0' } else { b'2' };
    let header = [b'|', b'h', active, panic];
    let rotors = rotors.iter().flat_map(|rotor| rotator(rotor, quirks));
    header.into_iter().chain(rotors).collect()
}

fn rotator(rotor: &Rotor, quirks: &BTreeSet<Quirk>) -> Vec<u8> {
    let is_narrow = quirks.contains(&Quirk::Narrow);
    let angle = |angle: Option<WholeDegrees>| angle.map_or(NONE, WholeDegrees::degrees);
    let position = angle(rotor.measured());
    let journey = rotor.journey().filter(|_| !rotor.rests_falsely());
    let target = angle(journey.map(|(target, _)| target));
    let start = angle(journey.map(|(_, start)| start));
    let (cw, ccw) = (rotor.limit_cw, rotor.limit_ccw);
    let kind = char::from(rotor.kind.letter());
    let moving = match rotor.moving() {
        _ if rotor.rests_falsely() => '0',
        Moving::Stopped => '0',
        Moving::Clockwise => '1',
        Moving::CounterClockwise => '2',
    };
    let (front, name_length) = if is_narrow {
        // In this form, the document describes the field as the stop offset.
        let (cw, ccw, offset) = (cw.degrees(), ccw.degrees(), rotor.stop_offset_deg);
        let numbers = format!("{position:03}{cw:03}{ccw:03}{kind}{moving}{offset:02}");
        (format!("{numbers}{target:03}{start:03}"), 10)
    } else {
        let (cw, ccw, offset) = (cw.degrees(), ccw.degrees(), rotor.offset_deg);
        let numbers = format!("{position:>3}{cw:>3}{ccw:>3}{kind}{moving}{offset:>4}");
        (format!("{numbers}{target:>3}{start:>3}"), 12)
    };
    let name = rotor.name.chars().map(|c| u8::try_from(c).unwrap_or(b'?'));
    let blanks = std::iter::repeat(b' ');
    let limit = limit_byte(rotor.is_outside_limits(), quirks);
    front.bytes().chain([limit]).chain(name.chain(blanks).take(name_length)).collect()
}

fn limit_byte(is_outside: bool, quirks: &BTreeSet<Quirk>) -> u8 {
    match is_outside {
        true if quirks.contains(&Quirk::LimitBinary) => 1,
        true => b'1',
        false if quirks.contains(&Quirk::LimitAscii) => b'0',
        false => 0,
    }
}

/// Returns the reply to the command with this letter.
pub(super) fn acknowledgement(letter: u8, is_accepted: bool) -> Vec<u8> {
    vec![b'|', letter, verdict(is_accepted)]
}

/// Returns the reply to the go-to `command`, which it may repeat.
pub(super) fn go_to(command: &[u8], is_accepted: bool, quirks: &BTreeSet<Quirk>) -> Vec<u8> {
    match command.get(3..) {
        Some(angle) if quirks.contains(&Quirk::GoToReply6) => {
            [b"|A", angle, &[verdict(is_accepted)]].concat()
        }
        _ => acknowledgement(b'A', is_accepted),
    }
}

fn verdict(is_accepted: bool) -> u8 {
    if is_accepted { b'K' } else { b'F' }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::rotator_genius::{Direction, RotatorKind};
    use crate::sim::rotator_genius::RotatorOptions;

    fn angle(degrees: u16) -> WholeDegrees {
        WholeDegrees::new(degrees).unwrap()
    }

    fn rotor(position: Option<u16>, offset_deg: i16, name: &str) -> Rotor {
        Rotor::perfect(&RotatorOptions {
            name: name.to_owned(),
            position: angle(position.unwrap_or(0)),
            has_sensor: position.is_some(),
            offset_deg,
            ..RotatorOptions::default()
        })
    }

    #[test]
    fn replies_are_byte_for_byte_those_that_were_recorded() {
        let rotors = [rotor(None, 0, "Tower"), rotor(Some(43), 0, "Rotator 2")];
        let recorded =
            b"|h2\x00999359  0A0   0999999\x00Tower        43359  0A0   0999999\x00Rotator 2   ";
        assert_eq!(status(&rotors, 0, &BTreeSet::new()), recorded);
        let rotors = [rotor(Some(173), 10, "Steppir"), rotor(None, 0, "Rotator 2 -")];
        let recorded =
            b"|h2\x00173359  0A0  10999999\x00Steppir     999359  0A0   0999999\x00Rotator 2 - ";
        assert_eq!(status(&rotors, 0, &BTreeSet::new()), recorded);
    }

    #[test]
    fn the_narrow_form_is_that_of_the_documents_example() {
        let documented = |name: &str, limits: [u16; 2], kind| RotatorOptions {
            name: name.to_owned(),
            kind,
            limit_cw: angle(limits[0]),
            limit_ccw: angle(limits[1]),
            position: angle(100),
            ..RotatorOptions::default()
        };
        let one = documented("TOW1", [5, 350], RotatorKind::Azimuth);
        let two = documented("", [10, 60], RotatorKind::Elevation);
        let mut one = Rotor::perfect(&RotatorOptions { stop_offset_deg: 0, ..one });
        let two = Rotor::perfect(&RotatorOptions { stop_offset_deg: 1, has_sensor: false, ..two });
        one.rotate(Direction::Clockwise);
        let quirks = [Quirk::Narrow, Quirk::Active0, Quirk::LimitAscii].into();
        // The document's example says "inside", but 100 degrees are outside its own limits.
        let expected = b"|h0\x00100005350A1009999991TOW1      999010060E0019999990          ";
        assert_eq!(status(&[one, two], 0, &quirks), expected);
    }

    #[test]
    fn the_limit_byte_has_its_forms() {
        for (quirks, in_force, outside) in
            [(&[][..], 0, b'1'), (&[Quirk::LimitAscii], b'0', b'1'), (&[Quirk::LimitBinary], 0, 1)]
        {
            let quirks = quirks.iter().copied().collect();
            assert_eq!(limit_byte(false, &quirks), in_force);
            assert_eq!(limit_byte(true, &quirks), outside);
        }
    }

    #[test]
    fn a_go_to_may_be_repeated() {
        let long = [Quirk::GoToReply6].into();
        assert_eq!(go_to(b"|A2158", false, &long), b"|A158F");
        assert_eq!(go_to(b"|A2158", true, &BTreeSet::new()), b"|AK");
    }
}
