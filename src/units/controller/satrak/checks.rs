//! The twelve checks of the unit.

use std::borrow::Cow;

use crate::{
    device::panel::{Check, CheckState},
    protocol::satrak::{FaultKind, FaultState, Faults},
};

/// Names of the checks that are bad when the unit does not find a satellite in its file.
pub(super) const FILE_CHECKS: [&str; 2] =
    [name(FaultKind::TleMissing), name(FaultKind::SatelliteMissing)];

/// Returns the checks in the order of the document, as unknown if the unit has not reported any.
pub fn checks(faults: Option<&Faults>) -> Vec<Check> {
    let check = |kind: FaultKind| {
        let fault_state = faults.and_then(|faults| faults.state(kind));
        let state = match fault_state {
            None => CheckState::Unknown,
            Some(FaultState::Clear) => CheckState::Good,
            Some(_) if kind.is_warning() => CheckState::Caution,
            Some(_) => CheckState::Fault,
        };
        let shown = match fault_state {
            Some(FaultState::Disconnected) => Cow::Borrowed("Not connected"),
            Some(FaultState::Unknown(code)) => Cow::Owned(format!("Unknown ({code})")),
            None | Some(FaultState::Clear | FaultState::Set) => Cow::Borrowed(""),
        };
        let (when_good, locks_motion) = (when_good(kind), kind.locks_motion());
        Check {
            when_good,
            unit_text: shown,
            locks_motion,
            ..Check::new(name(kind), state, advice(kind))
        }
    };
    FaultKind::ALL.into_iter().map(check).collect()
}

const fn name(kind: FaultKind) -> &'static str {
    match kind {
        FaultKind::InternalLink => "Internal link",
        FaultKind::TleOutdated => "Age of the elements",
        FaultKind::TleMissing => "Element file",
        FaultKind::SatelliteMissing => "Satellite in the file",
        FaultKind::WebTle => "Elements from the web",
        FaultKind::TrackingStopped => "Tracking",
        FaultKind::Setup => "Setup",
        FaultKind::XMotor => "X motor",
        FaultKind::YMotor => "Y motor",
        FaultKind::XSensor => "X position sensor",
        FaultKind::YSensor => "Y position sensor",
        FaultKind::GpsLink => "GPS link",
    }
}

/// Returns the meaning of a good result.
fn when_good(kind: FaultKind) -> &'static str {
    match kind {
        FaultKind::InternalLink => "control and drive unit talk",
        // The unit also reports no fault while it holds no file.
        FaultKind::TleOutdated | FaultKind::TleMissing | FaultKind::SatelliteMissing => {
            "no fault reported"
        }
        FaultKind::WebTle => "the unit can read them",
        FaultKind::TrackingStopped => "not ended by an error",
        FaultKind::Setup => "complete",
        FaultKind::XMotor | FaultKind::YMotor => "works",
        FaultKind::XSensor | FaultKind::YSensor => "connected and set up",
        FaultKind::GpsLink => "the receiver answers",
    }
}

/// Returns the advice for a bad result.
fn advice(kind: FaultKind) -> &'static str {
    match kind {
        FaultKind::InternalLink => {
            "Control and drive unit do not communicate: check the cable between them."
        }
        FaultKind::TleOutdated => "Give the unit newer elements before the next pass.",
        FaultKind::TleMissing => "Upload the element file or choose another one.",
        FaultKind::SatelliteMissing => "The name in the file must match the one set exactly.",
        FaultKind::WebTle => "Check the web address and the unit's network.",
        FaultKind::TrackingStopped => {
            "Find the cause in the other checks, then start tracking again."
        }
        FaultKind::Setup => "Have the service check the unit's setup.",
        FaultKind::XMotor => "Do not move X: check motor, brake and drive.",
        FaultKind::YMotor => "Do not move Y: check motor, brake and drive.",
        FaultKind::XSensor => "The X angle cannot be trusted: check the sensor and its cable.",
        FaultKind::YSensor => "The Y angle cannot be trusted: check the sensor and its cable.",
        FaultKind::GpsLink => "Check the GPS receiver, or set location and time by hand.",
    }
}
