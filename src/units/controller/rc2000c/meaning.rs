//! Meaning of a frame, for the wire log.

use std::borrow::Cow;

use super::axes::Axes;
use crate::{
    device::{Meaning, panel::Tone},
    protocol::rc2000c::{
        Address, AutoMove, Band, Decoder, Direction, DriveReset, Frame, Jog, Motion, Polarity,
        PolarizationMove, PolarizationUnits, Query, Reply, Request, Setting, Speed,
    },
};

/// Returns the meaning of a command to the unit at `address`. `axes` converts counts to angles.
pub(super) fn of_sent(bytes: &[u8], address: Address, axes: &Axes) -> Option<Meaning> {
    let mut decoder = Decoder::new(address);
    decoder.push(bytes);
    let frame = decoder.next().and_then(Result::ok);
    let Some(Ok(request)) = frame.as_ref().map(Request::parse) else { return None };
    let text: Cow<'static, str> = match request {
        Request::Query(Query::DeviceType) => "Asks for the type of the unit".into(),
        Request::Query(Query::Status) => "Asks for the status".into(),
        Request::Query(Query::SatelliteName(index)) => {
            format!("Asks for the name of stored satellite {}", index.number()).into()
        }
        Request::Stop => "Stops azimuth and elevation".into(),
        Request::Motion(Motion::AutoMove(target)) => auto_move(&target, axes).into(),
        Request::Motion(Motion::Jog(jog)) => jogged(jog).into(),
        Request::Motion(Motion::Polarization(step)) => polarization(step).into(),
        Request::Motion(Motion::ResetDrive(drive)) => match drive {
            DriveReset::Azimuth => "Clears the alarm of the azimuth drive",
            DriveReset::Elevation => "Clears the alarm of the elevation drive",
            DriveReset::Polarization => "Clears the alarm of the polarization drive",
        }
        .into(),
        Request::Motion(Motion::RestartTracking) => "Starts its tracking again".into(),
        Request::Setting(Setting::AutoPolarization(true)) => {
            "Switches the automatic polarization on".into()
        }
        Request::Setting(Setting::AutoPolarization(false)) => {
            "Switches the automatic polarization off".into()
        }
        Request::Setting(Setting::Band(Band::C)) => "Chooses the C band of the receiver".into(),
        Request::Setting(Setting::Band(Band::K)) => "Chooses the K band of the receiver".into(),
    };
    Some(Meaning { tone: Tone::Plain, text })
}

fn auto_move(target: &AutoMove, axes: &Axes) -> String {
    if let Some((name, polarity)) = target.to_satellite() {
        let suffix = match polarity {
            Some(Polarity::Horizontal) => ", horizontal polarization",
            Some(Polarity::Vertical) => ", vertical polarization",
            None => "",
        };
        return format!("Goes to {}{suffix}", name.as_str());
    }
    if let Some((az_counts, el_counts)) = target.to_position() {
        let counts = format!("counts {az_counts}, {el_counts}");
        return match axes.degrees([az_counts, el_counts]) {
            Some([Some(az_deg), Some(el_deg)]) => {
                format!("Goes to Az {az_deg:.1}°, El {el_deg:.1}° ({counts})").replace('-', "−")
            }
            _ => format!("Goes to {counts}"),
        };
    }
    let position = target.to_polarization().map_or(0, PolarizationUnits::units);
    format!("Turns the polarization to {position}")
}

fn jogged(jog: Jog) -> String {
    let way = match jog.direction() {
        Direction::CounterClockwise => "azimuth counter-clockwise",
        Direction::Clockwise => "azimuth clockwise",
        Direction::Down => "elevation down",
        Direction::Up => "elevation up",
    };
    let speed = match jog.speed() {
        Speed::Slow => "slowly",
        Speed::Fast => "fast",
    };
    format!("Turns {way} {speed} for {:.2} s", jog.duration().as_secs_f64())
}

const fn polarization(step: PolarizationMove) -> &'static str {
    match step {
        PolarizationMove::JogClockwise => "Turns the polarization clockwise for a moment",
        PolarizationMove::JogCounterClockwise => {
            "Turns the polarization counter-clockwise for a moment"
        }
        PolarizationMove::ToStored(Polarity::Horizontal) => {
            "Turns the polarization to the stored horizontal one"
        }
        PolarizationMove::ToStored(Polarity::Vertical) => {
            "Turns the polarization to the stored vertical one"
        }
    }
}

/// Returns the meaning of a reply.
pub(super) fn of_reply(frame: &Frame) -> Option<Meaning> {
    let (tone, text) = match Reply::parse(frame).ok()? {
        Reply::DeviceType(_) => (Tone::Plain, "Type of the unit"),
        Reply::Status { .. } => (Tone::Plain, "Status"),
        Reply::SatelliteName(_) => (Tone::Plain, "Name of a stored satellite"),
        Reply::Offline { .. } => (Tone::Plain, "Remote mode is off, nothing is taken"),
        Reply::Refused { .. } => (Tone::Bad, "Refused"),
    };
    Some(Meaning { tone, ..Meaning::plain(text) })
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::{
        controller::rc2000c::Calibration, device::CountPoint, protocol::rc2000c::SatelliteName,
    };

    fn says(request: Request) -> String {
        let address = Address::new(0x31).unwrap();
        let point = |counts, degrees| CountPoint { counts, degrees };
        let axes = Axes::new(&Calibration {
            azimuth: vec![point(0, 0.0), point(36_000, 360.0)],
            elevation: vec![point(0, 0.0), point(9_000, 90.0)],
        });
        of_sent(&request.to_bytes(address), address, &axes).unwrap().text.into_owned()
    }

    #[test]
    fn commands_tell_their_axis_target_and_time() {
        let jog = Jog::new(Direction::Clockwise, Speed::Fast, Duration::from_millis(600)).unwrap();
        let name = SatelliteName::new("TDRS 5").unwrap();
        let to_satellite = AutoMove::satellite(name, Some(Polarity::Vertical)).unwrap();
        for (motion, words) in [
            (Motion::Jog(jog), "Turns azimuth clockwise fast for 0.60 s"),
            (
                Motion::AutoMove(AutoMove::position(12_510, 3_260)),
                "Goes to Az 125.1°, El 32.6° (counts 12510, 3260)",
            ),
            (Motion::AutoMove(to_satellite), "Goes to TDRS 5, vertical polarization"),
            (Motion::ResetDrive(DriveReset::Elevation), "Clears the alarm of the elevation drive"),
        ] {
            assert_eq!(says(Request::Motion(motion)), words);
        }
        assert_eq!(says(Request::Stop), "Stops azimuth and elevation");
    }

    #[test]
    fn without_a_calibration_a_target_is_told_in_counts() {
        let address = Address::new(0x31).unwrap();
        let bytes = Request::Motion(Motion::AutoMove(AutoMove::position(7, 9))).to_bytes(address);
        let meaning = of_sent(&bytes, address, &Axes::new(&Calibration::default())).unwrap();
        assert_eq!(meaning.text, "Goes to counts 7, 9");
    }
}
