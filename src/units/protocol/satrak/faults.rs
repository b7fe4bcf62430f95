//! Reply to `ERRSTATUS?` (section 7).

use super::coded::coded;
use super::fields::{FieldError, FrameFields};

/// One of the twelve faults and warnings, in the order of the document.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FaultKind {
    /// No communication between control unit and drive unit.
    InternalLink,
    TleOutdated,
    /// A missing file with the elements.
    TleMissing,
    /// A satellite that the file does not contain.
    SatelliteMissing,
    /// Elements that the unit could not read from the web.
    WebTle,
    /// An error that stopped tracking.
    TrackingStopped,
    Setup,
    XMotor,
    YMotor,
    /// Position sensor of the X axis.
    XSensor,
    /// Position sensor of the Y axis.
    YSensor,
    /// A GPS receiver that does not answer.
    GpsLink,
}

impl FaultKind {
    /// All kinds, in the order of the document.
    pub const ALL: [Self; 12] = [
        Self::InternalLink,
        Self::TleOutdated,
        Self::TleMissing,
        Self::SatelliteMissing,
        Self::WebTle,
        Self::TrackingStopped,
        Self::Setup,
        Self::XMotor,
        Self::YMotor,
        Self::XSensor,
        Self::YSensor,
        Self::GpsLink,
    ];

    /// Returns the number in the document, 1 to 12.
    pub const fn index(self) -> usize {
        self as usize + 1
    }

    /// Returns `true` if the fault is only a warning and the antenna can work. This classification
    /// is Azel's own.
    pub const fn is_warning(self) -> bool {
        matches!(self, Self::TleOutdated | Self::WebTle | Self::GpsLink)
    }

    /// Returns `true` if the fault forbids motion. This classification is Azel's own.
    pub const fn locks_motion(self) -> bool {
        // With these faults a drive may not obey, or a measured angle may be wrong.
        matches!(
            self,
            Self::InternalLink
                | Self::Setup
                | Self::XMotor
                | Self::YMotor
                | Self::XSensor
                | Self::YSensor
        )
    }

    const fn is_sensor(self) -> bool {
        matches!(self, Self::XSensor | Self::YSensor)
    }
}

coded! {
    FaultState {
        Clear = 0,
        /// An existing fault; for a sensor, a wrong configuration.
        Set = 1,
        /// A sensor that is not connected.
        Disconnected = 2,
    }
}

impl FaultState {
    /// Returns `true` if the state is anything but [`Self::Clear`].
    pub fn is_set(self) -> bool {
        self != Self::Clear
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Faults {
    /// State of each fault; `None` if the unit does not report it.
    states: [Option<FaultState>; 12],
}

impl Faults {
    /// Min number of fields in a reply: the document's example omits the last field.
    pub(super) const MIN_FIELDS: usize = 11;
    pub(super) const FIELDS: usize = 12;

    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        let mut states = [None; 12];
        for (state, kind) in states.iter_mut().zip(FaultKind::ALL) {
            // With fewer than eleven values, the first missing one is an error.
            if kind.index() > fields.count().max(Self::MIN_FIELDS) {
                break;
            }
            let code = fields.integer(kind.index())?;
            *state = Some(match FaultState::from_code(code) {
                // Section 7 explains 2 only for the two sensors.
                FaultState::Disconnected if !kind.is_sensor() => FaultState::Unknown(code),
                fault_state => fault_state,
            });
        }
        Ok(Self { states })
    }

    /// Returns the state of one fault; `None` if the unit does not report it.
    pub fn state(&self, kind: FaultKind) -> Option<FaultState> {
        self.states.get(kind.index() - 1).copied().flatten()
    }

    /// Returns all kinds with their states, in the order of the document.
    pub fn iter(&self) -> impl Iterator<Item = (FaultKind, Option<FaultState>)> {
        FaultKind::ALL.into_iter().zip(self.states)
    }

    /// Returns the faults that are not clear.
    pub fn active(&self) -> impl Iterator<Item = FaultKind> {
        self.iter().filter(|(_, state)| state.is_some_and(FaultState::is_set)).map(|(kind, _)| kind)
    }

    pub fn lock_motion(&self) -> bool {
        self.active().any(FaultKind::locks_motion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::Frame;

    fn read(payload: &str) -> Faults {
        Faults::read(FrameFields::new(&Frame::from_payload(payload))).unwrap()
    }

    #[test]
    fn each_fault_has_its_place() {
        for kind in FaultKind::ALL {
            let values = FaultKind::ALL.map(|other| if other == kind { "1" } else { "0" });
            let faults = read(&format!("ERRSTATUS?,{}", values.join(",")));
            assert_eq!(faults.active().collect::<Vec<_>>(), [kind]);
            assert_eq!(faults.lock_motion(), kind.locks_motion());
        }
    }

    #[test]
    fn a_loose_sensor_is_told_from_a_wrong_one() {
        let faults = read("ERRSTATUS?,2,0,0,0,0,0,0,0,0,1,2");
        assert_eq!(faults.state(FaultKind::InternalLink), Some(FaultState::Unknown(2)));
        assert_eq!(faults.state(FaultKind::XSensor), Some(FaultState::Set));
        assert_eq!(faults.state(FaultKind::YSensor), Some(FaultState::Disconnected));
        assert_eq!(faults.state(FaultKind::GpsLink), None);
    }
}
