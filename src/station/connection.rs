//! Which controller an antenna has, and where it answers.

use serde::Serialize;

/// Which controller, and where it answers.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "controller", rename_all = "lowercase")]
pub enum Connection {
    /// SVS Satrak on TCP.
    Satrak {
        /// Host and port, such as `192.168.10.21:4001`.
        address: String,
        /// The element file on the unit from which satellites are chosen;
        /// empty for the one that the unit uses already.
        #[serde(skip_serializing_if = "String::is_empty")]
        element_file: String,
    },
    /// 4O3A Rotator Genius on TCP.
    Genius {
        /// Host and port, such as `192.168.1.250:9006`.
        address: String,
        /// What its two rotators turn.
        rotators: Rotators,
    },
    /// Research Concepts RC2000C on a serial line or a serial server.
    Rc2000c {
        /// A serial port, such as `/dev/ttyUSB0` or `COM3`, or the host and port
        /// of a serial server that hands the bytes on as they are.
        address: String,
        /// Bits a second of the serial port; unused with a serial server.
        baud: u32,
        /// On the bus, 49 to 111.
        bus_address: u8,
        /// What its counts mean.
        calibration: Calibration,
    },
}

/// What the two rotators of a Rotator Genius turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rotators {
    /// One the azimuth and one the elevation of the same antenna.
    Pair,
    /// The first one turns the antenna, the second something else.
    First,
    /// The second one turns the antenna, the first something else.
    Second,
}

/// What the counts of a position sensor mean: points that the operator has
/// measured. Between and beyond them a straight line is laid.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Calibration {
    /// Of the azimuth; two points or more, or none while it is not calibrated.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub azimuth: Vec<CountPoint>,
    /// Of the elevation, likewise.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub elevation: Vec<CountPoint>,
}

/// A count and the angle at which it was read.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CountPoint {
    /// As on the front panel, 0 to 65535.
    pub counts: u16,
    /// As the mount counts, degrees.
    pub degrees: f64,
}

impl Connection {
    /// Where the controller answers, for the operator's eyes.
    pub fn address(&self) -> &str {
        match self {
            Self::Satrak { address, .. }
            | Self::Genius { address, .. }
            | Self::Rc2000c { address, .. } => address,
        }
    }
}
