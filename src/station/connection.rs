//! Which controller an antenna has, and where it answers.

use serde::Serialize;

use super::{CalibrationError, CountLine, ranges};

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
        /// Bits a second of the line. A serial server is set to it by its own
        /// means; here it tells how long replies take.
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

impl CountPoint {
    /// Whether points make a scale, in any order; the reason when they do not.
    /// None at all are a scale that is not known yet.
    pub(crate) fn check(points: &[Self]) -> Result<(), String> {
        if points.is_empty() {
            return Ok(());
        }
        let range = ranges::CALIBRATED_DEG;
        if !points.iter().all(|point| range.contains(&point.degrees)) {
            let words = format!("must hold angles from {} to {}°", range.start(), range.end());
            return Err(words.replace('-', "−"));
        }
        CountLine::through(points).map(|_| ()).map_err(|error| match error {
            CalibrationError::TooFew => "must hold two points or more, or none".to_owned(),
            CalibrationError::SameCounts(counts) => format!("must not hold {counts} counts twice"),
            CalibrationError::Flat => "must hold angles that change with the counts".to_owned(),
        })
    }
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

/// Whether `address` is a host and a port; the reason when it is not.
pub(crate) fn check_address(address: &str) -> Result<(), &'static str> {
    let Some((host, port)) = address.rsplit_once(':') else {
        return Err("must be a host and a port, such as 192.168.10.21:4001");
    };
    if host.is_empty() || host.contains(|c: char| c.is_whitespace() || c == '/') {
        return Err("must have a host without blanks and slashes before the port");
    }
    match port.parse::<u16>() {
        Ok(1..) => Ok(()),
        _ => Err("must have a port from 1 to 65535 behind the host"),
    }
}

/// Whether `address` is a serial port or else a host and a port; the reason when
/// it is neither.
pub(crate) fn check_line(address: &str) -> Result<(), &'static str> {
    if address.is_empty() {
        return Err("must be a serial port, such as /dev/ttyUSB0 or COM3, or a host and a port");
    }
    // Names of ports by their place on the machine hold colons too.
    let is_port = address.starts_with(['/', '\\']) || !address.contains(':');
    if is_port { Ok(()) } else { check_address(address) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_a_serial_port_or_a_host_and_a_port() {
        for good in ["/dev/ttyUSB0", "COM3", "/dev/serial/by-path/pci-0000:00:14.0-port0", "h:1"] {
            assert_eq!(check_line(good), Ok(()), "{good}");
        }
        for bad in ["", "host:", "host:0", "host:70000", ":4001"] {
            assert!(check_line(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_scale_has_two_points_and_a_slope() {
        let check = |points: &[(u16, f64)]| {
            let points = points.iter().map(|&(counts, degrees)| CountPoint { counts, degrees });
            CountPoint::check(&points.collect::<Vec<_>>())
        };
        assert_eq!(check(&[]), Ok(()));
        assert_eq!(check(&[(100, 90.0), (300, 270.0), (200, 181.0)]), Ok(()));
        assert_eq!(check(&[(100, 90.0), (300, -90.0)]), Ok(()));
        for bad in [
            &[(100, 90.0)][..],
            &[(100, 90.0), (100, 91.0)],
            &[(100, 90.0), (200, 90.0)],
            &[(100, 90.0), (200, 9000.0)],
            &[(100, f64::NAN), (200, 90.0)],
        ] {
            assert!(check(bad).is_err(), "{bad:?}");
        }
    }
}
