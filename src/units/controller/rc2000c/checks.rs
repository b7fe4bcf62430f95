//! The alarms of the unit, and advice for each.

use crate::{
    device::panel::{Check, CheckState},
    protocol::rc2000c::{Alarm, AxisDrive, DeviceType, MountKind, Status, Submode},
};

pub(super) fn checks(
    status: Option<&Status>,
    device: Option<DeviceType>,
    is_offline: bool,
    is_calibrated: bool,
) -> Vec<Check> {
    let mut checks = vec![remote_mode(status, is_offline)];
    if let Some(status) = status {
        checks.push(drive("Azimuth drive", status.azimuth_drive));
        checks.push(drive("Elevation drive", status.elevation_drive));
        checks.extend(alarm(status.alarm));
        checks.extend(status.track.and_then(|track| tracking(track.submode)));
    }
    checks.extend(device.and_then(kind));
    if !is_calibrated {
        checks.push(Check::new(
            "Calibration",
            CheckState::Caution,
            "The meaning of the counts is not known. Enter two points or more for \
                     azimuth and elevation in Preferences; until then no direction can be sent.",
        ));
    }
    checks
}

/// Returns `true` if the unit reports a fault that forbids every motion.
pub(super) fn forbids_motion(status: &Status) -> bool {
    let drives = [
        drive("Azimuth drive", status.azimuth_drive),
        drive("Elevation drive", status.elevation_drive),
    ];
    drives.into_iter().chain(alarm(status.alarm)).any(|check| check.forbids_motion())
}

/// Returns `true` if the unit no longer knows its position or limits.
fn locks_motion(alarm: Alarm) -> bool {
    matches!(
        alarm,
        Alarm::AzimuthCount | Alarm::ElevationCount | Alarm::AzimuthLimits | Alarm::ElevationLimits
    )
}

fn remote_mode(status: Option<&Status>, is_offline: bool) -> Check {
    let (state, advice) = match (is_offline, status) {
        (true, _) => (
            CheckState::Fault,
            "Remote mode is disabled on the unit. Set Remote Mode Enable to 1 in its CONFIG \
             mode; until then it takes no command, not even STOP.",
        ),
        (false, Some(_)) => (CheckState::Good, ""),
        (false, None) => (CheckState::Unknown, ""),
    };
    Check::new("Remote mode", state, advice)
}

fn drive(name: &'static str, drive: AxisDrive) -> Check {
    let (state, advice) = match drive {
        AxisDrive::Runaway => (
            CheckState::Fault,
            "It moved without a command. Look at the drive and its relays before you reset it.",
        ),
        AxisDrive::Jammed => (
            CheckState::Fault,
            "It was commanded, but its sensor saw no motion. Look for ice, a blown fuse or a \
             broken sensor wire, then reset it.",
        ),
        AxisDrive::Limit => {
            (CheckState::Caution, "It has run into its limit. Move it the other way.")
        }
        AxisDrive::Overcurrent => (
            CheckState::Fault,
            "It drew too much current. Look for what blocks the axis, then reset it.",
        ),
        AxisDrive::Unknown(_) => {
            (CheckState::Caution, "It reports a state that the manual does not name.")
        }
        AxisDrive::Still | AxisDrive::Pending(_) | AxisDrive::Moving(_) | AxisDrive::AutoMove => {
            (CheckState::Good, "")
        }
    };
    Check { locks_motion: true, ..Check::new(name, state, advice) }
}

/// Returns the most urgent alarm; the unit shows the next alarm when this one is cleared.
pub(super) fn alarm(alarm: Alarm) -> Option<Check> {
    let enter_again = "The memory of the unit has lost it. Enter it again in CONFIG mode.";
    let (name, advice) = match alarm {
        Alarm::None => return None,
        Alarm::LowBattery => (
            "Low battery",
            "The battery of the memory is low. Write down the settings and replace it.",
        ),
        Alarm::Azimuth => {
            ("Azimuth alarm", "Its drive reports which. Fix the cause, then reset it.")
        }
        Alarm::Elevation => {
            ("Elevation alarm", "Its drive reports which. Fix the cause, then reset it.")
        }
        Alarm::AzimuthCount => (
            "Azimuth count",
            "The count no longer fits the position. Set the limits of the unit again.",
        ),
        Alarm::ElevationCount => (
            "Elevation count",
            "The count no longer fits the position. Set the limits of the unit again.",
        ),
        Alarm::AzimuthLimits => {
            ("Azimuth limits", "The limits are corrupt. Set them again at the unit.")
        }
        Alarm::ElevationLimits => {
            ("Elevation limits", "The limits are corrupt. Set them again at the unit.")
        }
        Alarm::AutoPolarizationData => ("Automatic polarization data", enter_again),
        Alarm::SimultaneousAxes => ("Simultaneous azimuth and elevation", enter_again),
        Alarm::AzimuthSlowSpeed => ("Azimuth slow speed", enter_again),
        Alarm::ElevationSlowSpeed => ("Elevation slow speed", enter_again),
        Alarm::SerialPortData => ("Serial port data", enter_again),
        Alarm::GeoElevationPosition => ("Geographic and elevation data", enter_again),
        Alarm::TrackConfiguration => ("TRACK configuration", enter_again),
        Alarm::AntennaReceiver => ("Antenna and receiver data", enter_again),
        Alarm::TimeOrDate => ("Time or date", "Set the clock of the unit."),
        Alarm::AngleDisplay => ("Angle display data", enter_again),
        Alarm::PolarizationOptions => ("Polarization options", enter_again),
        Alarm::Polarization => ("Polarization alarm", "Look at the feed, then reset its drive."),
        Alarm::AxisOptions => ("Azimuth and elevation options", enter_again),
        Alarm::Unknown(_) => ("Unknown alarm", "Read it from the display of the unit."),
    };
    let locks_motion = locks_motion(alarm);
    Some(Check { locks_motion, ..Check::new(name, CheckState::Fault, advice) })
}

fn tracking(submode: Submode) -> Option<Check> {
    let advice = match submode {
        Submode::JammedError => "An axis is jammed. Reset its drive, then TRACK.",
        Submode::LimitError => "An axis is at its limit. Move it away, then reset TRACK.",
        Submode::DriveError => "A drive has an alarm. Reset the drive, then TRACK.",
        Submode::PeakLimitError => "The peak of the signal was not found. Reset TRACK.",
        Submode::AzimuthScaleError => "The scale factor of the azimuth is wrong.",
        Submode::GeoPositionError => "The geographic position in the unit is wrong.",
        Submode::SystemError | Submode::ChecksumError => "The unit has lost what it had learned.",
        _ => return None,
    };
    Some(Check::new("TRACK", CheckState::Fault, advice))
}

/// Returns a warning for another kind of unit. Related units number their alarms differently, and
/// the axes of a polar mount are not azimuth and elevation.
fn kind(device: DeviceType) -> Option<Check> {
    let advice = match device.mount {
        MountKind::ElevationOverAzimuth | MountKind::AzimuthOverElevation => return None,
        MountKind::Polar => "It is made for a polar mount: its axes are not azimuth and elevation.",
        MountKind::Other(_) => "It is not an RC2000C: its alarms may mean something else.",
    };
    Some(Check::new("Kind of unit", CheckState::Caution, advice))
}
