//! Readings and checks of a Rotator Genius besides the direction of the antenna.

use std::time::Duration;

use super::roles::Roles;
use crate::{
    device::panel::{Check, CheckState, Reading, Tone},
    protocol::rotator_genius::{Moving, Rotator, RotatorKind, RotatorNumber, Status, WholeDegrees},
};

struct RotatorNames {
    sensor: &'static str,
    limits: &'static str,
}

const NAMES: [RotatorNames; 2] = [
    RotatorNames { sensor: "Sensor of rotator 1", limits: "Limits of rotator 1" },
    RotatorNames { sensor: "Sensor of rotator 2", limits: "Limits of rotator 2" },
];

/// Returns faults and warnings of the rotators that turn this antenna.
pub(super) fn checks(status: &Status, roles: Roles) -> Vec<Check> {
    let kinds = Check::new(
        "Kinds of the rotators",
        if roles.is_clear { CheckState::Good } else { CheckState::Fault },
        if roles.is_pair {
            "This antenna needs an azimuth and an elevation rotator, and the unit reports others. \
             Choose \"Only rotator 1\" or 2 in Preferences, or change a kind in the unit."
        } else {
            "This antenna needs an azimuth rotator, and the unit reports another kind. Choose the \
             other rotator in Preferences, or change the kind in the unit."
        },
    );
    let panic = Check::new(
        "Panic code",
        match status.panic {
            None => CheckState::Unknown,
            Some(0) => CheckState::Good,
            Some(_) => CheckState::Caution,
        },
        "The document of the unit does not say what its codes mean. Look at the unit.",
    );
    let ours = roles.axes.into_iter().filter(|number| roles.is_ours(*number));
    let of_rotators = ours.flat_map(|number| {
        let (rotator, names) = (status.rotator(number), number.select(&NAMES));
        let sensor = Check::new(
            names.sensor,
            if rotator.position.is_ok() { CheckState::Good } else { CheckState::Fault },
            "The unit gives no position and refuses to turn. Check the sensor and its \
                     cable.",
        );
        let limits = Check::new(
            names.limits,
            match rotator.is_outside_limits {
                Some(false) => CheckState::Good,
                Some(true) => CheckState::Caution,
                None => CheckState::Unknown,
            },
            "Outside its limits nothing but STOP ends a motion of the rotator. Send it \
                     to a direction, or choose \"Allow jogs outside limits\" and jog it back.",
        );
        [sensor, limits]
    });
    [kinds, panic].into_iter().chain(of_rotators).collect()
}

/// Returns the other readings, rotator by rotator.
pub(super) fn readings(
    status: &Status,
    roles: Roles,
    rescue_left: Option<Duration>,
) -> Vec<Reading> {
    let rescue = rescue_left.filter(|left| !left.is_zero()).map(|left| {
        let text = format!("allowed, {} s left", left.as_secs_f64().ceil());
        Reading::new("Jogs outside limits", text).in_tone(Tone::Caution)
    });
    let of_rotators =
        RotatorNumber::ALL.into_iter().flat_map(|number| of_rotator(status, roles, number));
    let panic = status
        .panic
        .filter(|code| *code != 0)
        .map(|code| Reading::new("Panic code", format!("0x{code:02X}")).in_tone(Tone::Caution));
    rescue.into_iter().chain(of_rotators).chain(panic).collect()
}

fn of_rotator(status: &Status, roles: Roles, number: RotatorNumber) -> Vec<Reading> {
    let rotator = status.rotator(number);
    let label = |axis_name: &str| format!("{axis_name} {}", number.number());
    let kind = match rotator.kind {
        RotatorKind::Azimuth => "azimuth",
        RotatorKind::Elevation => "elevation",
    };
    // Operators often name a rotator after its axis.
    let name = match rotator.name.as_str() {
        "" => format!("no name, {kind}"),
        name if name.eq_ignore_ascii_case(kind) => kind.to_owned(),
        name => format!("{name}, {kind}"),
    };
    let heading = match &rotator.position {
        Ok(angle) => Reading::new(label("Heading"), format!("{angle}°{}", turning(rotator.moving))),
        // A unit with one rotator usually has no heading for the other.
        Err(problem) => {
            let tone = if roles.is_ours(number) { Tone::Bad } else { Tone::Plain };
            Reading::new(label("Heading"), problem.to_string()).in_tone(tone)
        }
    };
    let outside = match rotator.is_outside_limits {
        Some(false) => ("", Tone::Plain),
        Some(true) => (", outside", Tone::Caution),
        None => (", flag not known", Tone::Caution),
    };
    let limits =
        format!("{} to {}{}", degrees(rotator.limit_ccw), degrees(rotator.limit_cw), outside.0);
    let offset =
        rotator.offset_deg.map_or("not reported".to_owned(), |offset| format!("{offset}°"));
    let mut readings = vec![
        Reading::new(label("Rotator"), name),
        heading,
        Reading::new(label("Limits"), limits).in_tone(outside.1),
        Reading::new(label("Offset"), offset),
    ];
    if let Some(target) = rotator.target {
        let line = Reading::new(label("Target"), format!("{target}°"));
        let share = progress(rotator);
        readings.insert(
            2,
            match share {
                Some(share) => line.with_bar(share),
                None => line,
            },
        );
    }
    readings
}

fn turning(moving: Moving) -> &'static str {
    match moving {
        Moving::Stopped => "",
        Moving::Clockwise => ", turning clockwise",
        Moving::CounterClockwise => ", turning counter-clockwise",
    }
}

fn degrees(angle: Option<WholeDegrees>) -> String {
    angle.map_or("?".to_owned(), |angle| format!("{angle}°"))
}

/// Returns the part of the way to its target that a rotator has gone, 0 to 1.
fn progress(rotator: &Rotator) -> Option<f64> {
    let degrees = |angle: WholeDegrees| f64::from(angle.degrees());
    let (start, target) = (degrees(rotator.start?), degrees(rotator.target?));
    let here = degrees(rotator.position.ok()?);
    let share_done = |first: f64, end: f64| match rotator.moving {
        Moving::CounterClockwise => (first - end).rem_euclid(360.0),
        Moving::Clockwise | Moving::Stopped => (end - first).rem_euclid(360.0),
    };
    let (whole, part) = (share_done(start, target), share_done(start, here));
    if whole == 0.0 {
        return Some(1.0);
    }
    // A part longer than the whole way is a little past the target or a little before the start.
    let is_before = part > whole + (360.0 - whole) / 2.0;
    Some(if is_before { 0.0 } else { (part / whole).min(1.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_to_the_target_is_counted_as_it_is_gone() {
        use Moving::{Clockwise, CounterClockwise};
        let whole = |degrees| WholeDegrees::new(degrees).ok();
        let share = |start, here, target, moving| {
            progress(&Rotator {
                position: Ok(WholeDegrees::saturating(here)),
                limit_cw: None,
                limit_ccw: None,
                kind: RotatorKind::Azimuth,
                moving,
                offset_deg: None,
                target: whole(target),
                start: whole(start),
                is_outside_limits: None,
                name: String::new(),
            })
        };
        for (start, here, target, moving, expected) in [
            (100, 125, 200, Clockwise, 0.25),
            (350, 10, 30, Clockwise, 0.5),
            (30, 10, 350, CounterClockwise, 0.5),
            (100, 99, 200, Clockwise, 0.0),
            (100, 202, 200, Clockwise, 1.0),
            (100, 101, 0, CounterClockwise, 0.0),
            (100, 100, 100, Clockwise, 1.0),
        ] {
            let share = share(start, here, target, moving).unwrap();
            assert!((share - expected).abs() < 1e-9, "{start} {here} {target}: {share}");
        }
        assert_eq!(share(100, 100, 999, Clockwise), None);
    }
}
