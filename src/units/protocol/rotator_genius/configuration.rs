//! Configuration of a rotator in the unit (section 1.1).

use super::{RotatorKind, RotatorName, RotatorNumber, ValueError, WholeDegrees};

/// Max stop offset, degrees.
pub const MAX_STOP_OFFSET_DEG: u8 = 10;

/// Configuration of one rotator, which Azel always sends as a whole.
///
/// Azel cannot read back the whole configuration: a status has the limits, kind and name but not
/// the stop offset. The field "Offset" of a status is another value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Configuration {
    rotator: RotatorNumber,
    limit_cw: WholeDegrees,
    limit_ccw: WholeDegrees,
    kind: RotatorKind,
    stop_offset_deg: u8,
    name: RotatorName,
}

impl Configuration {
    /// Returns a configuration from the clockwise and counter-clockwise limit, kind, stop offset
    /// and name. The stop offset is the distance to a target at which the unit cuts off the drive,
    /// degrees, 0 to [`MAX_STOP_OFFSET_DEG`].
    pub fn new(
        rotator: RotatorNumber,
        [limit_cw, limit_ccw]: [WholeDegrees; 2],
        kind: RotatorKind,
        stop_offset_deg: u8,
        name: RotatorName,
    ) -> Result<Self, ValueError> {
        if stop_offset_deg > MAX_STOP_OFFSET_DEG {
            return Err(ValueError::StopOffset(stop_offset_deg));
        }
        Ok(Self { rotator, limit_cw, limit_ccw, kind, stop_offset_deg, name })
    }

    pub fn rotator(&self) -> RotatorNumber {
        self.rotator
    }

    /// Returns the end of the travel clockwise.
    pub fn limit_cw(&self) -> WholeDegrees {
        self.limit_cw
    }

    /// Returns the end of the travel counter-clockwise.
    pub fn limit_ccw(&self) -> WholeDegrees {
        self.limit_ccw
    }

    pub fn kind(&self) -> RotatorKind {
        self.kind
    }

    /// Returns the distance to a target at which the unit cuts off the drive, degrees.
    pub fn stop_offset_deg(&self) -> u8 {
        self.stop_offset_deg
    }

    pub fn name(&self) -> &RotatorName {
        &self.name
    }

    /// Encodes 22 bytes. The document's example has 12: it lacks the name that the document lists.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        // The order follows the input data in section 1.1. The descriptions below that put the name
        // in another place.
        let front = format!(
            "|c{}{}{}{}{:02}",
            self.rotator.number(),
            self.limit_cw.digits(),
            self.limit_ccw.digits(),
            char::from(self.kind.letter()),
            self.stop_offset_deg,
        );
        front.bytes().chain(self.name.bytes()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stop_offset_ends_at_ten() {
        let limits = [WholeDegrees::MAX, WholeDegrees::new(0).unwrap()];
        let build = |offset| {
            let name = RotatorName::new("x").unwrap();
            Configuration::new(RotatorNumber::Two, limits, RotatorKind::Elevation, offset, name)
        };
        assert_eq!(build(10).unwrap().to_bytes(), b"|c2360000E10x         ");
        assert_eq!(build(11), Err(ValueError::StopOffset(11)));
    }
}
