//! The twelve checks of a Satrak.

use crate::protocol::satrak::FaultKind;

/// What is checked.
pub fn fault_name(kind: FaultKind) -> &'static str {
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

/// What is good, or not, with it.
pub fn fault_about(kind: FaultKind) -> &'static str {
    match kind {
        FaultKind::InternalLink => "between control and drive unit",
        FaultKind::TleOutdated => "young enough to track by",
        FaultKind::TleMissing => "is on the unit",
        FaultKind::SatelliteMissing => "its name is found",
        FaultKind::WebTle => "the unit can read them",
        FaultKind::TrackingStopped => "not ended by an error",
        FaultKind::Setup => "of the unit",
        FaultKind::XMotor | FaultKind::YMotor => "works",
        FaultKind::XSensor | FaultKind::YSensor => "connected and set up",
        FaultKind::GpsLink => "the receiver answers",
    }
}

/// What to do when it is not good.
pub fn fault_advice(kind: FaultKind) -> &'static str {
    match kind {
        FaultKind::InternalLink => {
            "Control and drive unit do not talk: check the cable between them."
        }
        FaultKind::TleOutdated => "Give the unit newer elements before the next pass.",
        FaultKind::TleMissing => "Upload the element file or choose another one.",
        FaultKind::SatelliteMissing => "The name must stand in the file exactly as it is set.",
        FaultKind::WebTle => "Check the web address and the unit's network.",
        FaultKind::TrackingStopped => {
            "Find the cause in the other checks, then start tracking again."
        }
        FaultKind::Setup => "Let the service look at the unit's setup.",
        FaultKind::XMotor => "Do not move X: check motor, brake and drive.",
        FaultKind::YMotor => "Do not move Y: check motor, brake and drive.",
        FaultKind::XSensor => "The X angle cannot be trusted: check the sensor and its cable.",
        FaultKind::YSensor => "The Y angle cannot be trusted: check the sensor and its cable.",
        FaultKind::GpsLink => "Check the GPS receiver, or set place and time by hand.",
    }
}
