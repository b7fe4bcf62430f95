//! Service functions: calibration, drive scaling, firmware (sections 14, 15
//! and 29 to 32).

use super::ValueError;
use super::fields::{FieldError, FrameFields};
use super::number::{checked, plain, pointed};

/// Azel's own plausibility limit; the document gives neither unit nor range.
const MAX_REDUCTION: f64 = 1_000_000.0;
const MAX_REFERENCE_DEG: f64 = 360.0;

/// Reference angles of both axes for sensor readings, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorAngles {
    x_deg: f64,
    y_deg: f64,
}

impl SensorAngles {
    /// Returns reference angles from -360 to 360 degrees, rounded to a thousandth.
    pub fn new(x_deg: f64, y_deg: f64) -> Result<Self, ValueError> {
        let angle =
            |value| checked("reference angle", value, -MAX_REFERENCE_DEG, MAX_REFERENCE_DEG);
        Ok(Self { x_deg: angle(x_deg)?, y_deg: angle(y_deg)? })
    }

    /// Returns the reference angle of the X axis, degrees.
    pub fn x_deg(self) -> f64 {
        self.x_deg
    }

    /// Returns the reference angle of the Y axis, degrees.
    pub fn y_deg(self) -> f64 {
        self.y_deg
    }
}

/// Reply to `ANGLE_SETTINGS?`: pairs of sensor reading and angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleSettings {
    /// Sensor reading of the X axis, in counts.
    pub x_sensor: i64,
    /// Angle of the X axis at that reading, degrees.
    pub x_deg: f64,
    /// Sensor reading of the Y axis, in counts.
    pub y_sensor: i64,
    /// Angle of the Y axis at that reading, degrees.
    pub y_deg: f64,
}

impl AngleSettings {
    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        Ok(Self {
            x_sensor: fields.integer(1)?,
            x_deg: fields.decimal(2)?,
            y_sensor: fields.integer(3)?,
            y_deg: fields.decimal(4)?,
        })
    }
}

/// Values of `ANGLE_SETTINGS=`, which calibrate the reported angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AngleChange {
    /// Angles of the current position.
    PresentPosition(SensorAngles),
    // Section 14 gives no unit, but 39049 and 36838 in its example fit 16 bits.
    /// Angles of the given sensor readings, which are counts of 16 bits.
    Given {
        /// Sensor reading of the X axis.
        x_sensor: u16,
        /// Sensor reading of the Y axis.
        y_sensor: u16,
        angles: SensorAngles,
    },
}

impl AngleChange {
    pub(super) fn values(self) -> Vec<String> {
        let (automatic, x_sensor, y_sensor, angles) = match self {
            // The unit ignores these sensor values. The example in section 15 has zeros.
            Self::PresentPosition(angles) => ("1", 0, 0, angles),
            Self::Given { x_sensor, y_sensor, angles } => ("0", x_sensor, y_sensor, angles),
        };
        vec![
            automatic.to_owned(),
            x_sensor.to_string(),
            pointed(angles.x_deg),
            y_sensor.to_string(),
            pointed(angles.y_deg),
        ]
    }
}

/// Reply to `REDUCTION?` and values of `REDUCTION=`: scales of the drives,
/// presumably gear ratios.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reduction {
    x: f64,
    y: f64,
}

impl Reduction {
    /// Returns scales from 0.001 to a million, rounded to a thousandth.
    pub fn new(x: f64, y: f64) -> Result<Self, ValueError> {
        // A thousandth is the smallest scale that does not round to zero.
        let ratio = |value| checked("reduction", value, 0.001, MAX_REDUCTION);
        Ok(Self { x: ratio(x)?, y: ratio(y)? })
    }

    /// Returns the scale of the X axis.
    pub fn x(self) -> f64 {
        self.x
    }

    /// Returns the scale of the Y axis.
    pub fn y(self) -> f64 {
        self.y
    }

    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        // The values are unchecked: the range is Azel's own, and a unit may hold other values.
        Ok(Self { x: fields.decimal(1)?, y: fields.decimal(2)? })
    }

    pub(super) fn values(self) -> Vec<String> {
        vec![plain(self.x), plain(self.y)]
    }
}

/// Reply to `LOAD_IMAGE?`. The document explains none of its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImageStatus {
    /// Values as reported.
    pub raw: String,
}
