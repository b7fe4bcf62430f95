//! Polarization in a status: two characters of text, and one character for the device and the fine
//! part of the position.

use super::BASE;

/// Steps of a polarotor over its whole range of 99 shown values.
const POLAROTOR_STEPS: u16 = 661;
const POLAROTOR_SHOWN: u16 = 99;
/// Steps of a rotating feed in one shown value.
const FEED_STEPS: u16 = 11;
// A feed at 1023 would show 93, but that position is beyond any limit and shows CC.
/// Max shown value of a rotating feed.
const FEED_MAX_SHOWN: u8 = 92;

/// Device that turns the polarization.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolarizationDevice {
    /// A probe in the feed, 0 to 661.
    Polarotor,
    /// The whole feed, 0 to 1023.
    RotatingFeed,
    /// Unknown upper bits.
    Unknown(u8),
}

/// Position of the polarization according to the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedPosition {
    /// Coarse number, which grows counter-clockwise as seen into the horn.
    Shown(u8),
    /// Clockwise limit.
    ClockwiseLimit,
    /// Counter-clockwise limit.
    CounterClockwiseLimit,
    /// Unknown text, as received.
    Unknown([u8; 2]),
}

/// Report on the polarization.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FeedReading {
    pub device: PolarizationDevice,
    /// Coarse position.
    pub position: FeedPosition,
    /// Steps between the coarse and the exact position, 0 to 15.
    pub fine_steps: u8,
}

impl FeedReading {
    /// Returns the reading of a polarotor at a position of 0 to 661.
    pub fn polarotor(units: u16) -> Self {
        let position = match units {
            // Both ends of the count are limits, which show as letters instead (appendix E).
            0 => FeedPosition::ClockwiseLimit,
            POLAROTOR_STEPS.. => FeedPosition::CounterClockwiseLimit,
            _ => {
                let below = |shown: &u8| first_step(*shown) <= units;
                FeedPosition::Shown((0..POLAROTOR_SHOWN as u8).rev().find(below).unwrap_or(0))
            }
        };
        let fine_steps = match position {
            FeedPosition::Shown(shown) => (units - first_step(shown)) as u8,
            _ => 0,
        };
        Self { device: PolarizationDevice::Polarotor, position, fine_steps }
    }

    /// Returns the reading of a rotating feed within its limits, which are below 1023.
    pub fn rotating_feed(units: u16) -> Self {
        Self {
            device: PolarizationDevice::RotatingFeed,
            position: FeedPosition::Shown((units / FEED_STEPS).min(FEED_MAX_SHOWN.into()) as u8),
            fine_steps: (units % FEED_STEPS) as u8,
        }
    }

    /// Returns the exact position in the unit's count: 0 to 661 or 0 to 1023. A rotating feed at a
    /// limit does not report it.
    pub fn units(&self) -> Option<u16> {
        let fine = u16::from(self.fine_steps);
        match (self.device, self.position) {
            (PolarizationDevice::Polarotor, FeedPosition::Shown(shown)) => {
                Some(first_step(shown) + fine)
            }
            (PolarizationDevice::Polarotor, FeedPosition::ClockwiseLimit) => Some(0),
            (PolarizationDevice::Polarotor, FeedPosition::CounterClockwiseLimit) => {
                Some(POLAROTOR_STEPS)
            }
            (PolarizationDevice::RotatingFeed, FeedPosition::Shown(shown)) => {
                Some(u16::from(shown) * FEED_STEPS + fine)
            }
            // The user sets the limits of a rotating feed, so CW and CC have no fixed number there.
            _ => None,
        }
    }

    pub(super) fn parse(text: [u8; 2], device: u8) -> Self {
        let position = match &text {
            b"CW" => FeedPosition::ClockwiseLimit,
            // Two characters leave no room for the W of CCW.
            b"CC" => FeedPosition::CounterClockwiseLimit,
            [tens @ (b' ' | b'0'..=b'9'), ones @ b'0'..=b'9'] => {
                let tens = if *tens == b' ' { 0 } else { tens - b'0' };
                FeedPosition::Shown(tens * 10 + (ones - b'0'))
            }
            _ => FeedPosition::Unknown(text),
        };
        let kind = match device & 0xf0 {
            0x20 => PolarizationDevice::Polarotor,
            0x30 => PolarizationDevice::RotatingFeed,
            other => PolarizationDevice::Unknown(other),
        };
        Self { device: kind, position, fine_steps: device & 0x0f }
    }

    /// Returns the text, and the character for device and fine part.
    pub(super) fn bytes(self) -> ([u8; 2], u8) {
        let text = match self.position {
            FeedPosition::Shown(shown @ 0..10) => [b' ', b'0' + shown],
            FeedPosition::Shown(shown @ 10..100) => [b'0' + shown / 10, b'0' + shown % 10],
            FeedPosition::Shown(_) => *b"**",
            FeedPosition::ClockwiseLimit => *b"CW",
            FeedPosition::CounterClockwiseLimit => *b"CC",
            FeedPosition::Unknown(text) => text,
        };
        let kind = match self.device {
            PolarizationDevice::Polarotor => 0x20,
            PolarizationDevice::RotatingFeed => 0x30,
            PolarizationDevice::Unknown(upper) => upper & 0xf0,
        };
        (text, kind | self.fine_steps & 0x0f)
    }
}

/// Returns the first step of a shown value of a polarotor.
fn first_step(shown: u8) -> u16 {
    // The division comes last and rounds down: the example in the manual converts 39 to 260.
    u16::from(shown) * POLAROTOR_STEPS / POLAROTOR_SHOWN
}

/// Stored polarization at which the feed stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolarizationCode {
    /// Horizontal, shown as H.
    Horizontal,
    /// Close to horizontal, shown as h.
    NearHorizontal,
    /// Vertical, shown as V.
    Vertical,
    /// Close to vertical, shown as v.
    NearVertical,
    /// No stored polarization.
    None,
    Unknown(u8),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PolarizationMode {
    /// Stored polarization on the display.
    pub code: PolarizationCode,
    /// `true` if the unit sets the polarization automatically.
    pub is_automatic: bool,
}

impl PolarizationMode {
    pub(super) const fn from_byte(byte: u8) -> Option<Self> {
        if byte & 0xf0 != BASE {
            return None;
        }
        let code = match byte & 0x07 {
            0 => PolarizationCode::Horizontal,
            1 => PolarizationCode::NearHorizontal,
            2 => PolarizationCode::Vertical,
            3 => PolarizationCode::NearVertical,
            4 => PolarizationCode::None,
            other => PolarizationCode::Unknown(other),
        };
        Some(Self { code, is_automatic: byte & 0x08 != 0 })
    }

    pub(super) const fn byte(self) -> u8 {
        let code = match self.code {
            PolarizationCode::Horizontal => 0,
            PolarizationCode::NearHorizontal => 1,
            PolarizationCode::Vertical => 2,
            PolarizationCode::NearVertical => 3,
            PolarizationCode::None => 4,
            PolarizationCode::Unknown(other) => other & 0x07,
        };
        BASE | (self.is_automatic as u8) << 3 | code
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_position_comes_back() {
        for units in 0..=661 {
            let reading = FeedReading::polarotor(units);
            assert!(reading.fine_steps <= 6, "{reading:?}");
            assert_eq!(reading.units(), Some(units));
            let (text, device) = reading.bytes();
            assert_eq!(FeedReading::parse(text, device), reading);
        }
        for units in 0..1023 {
            let reading = FeedReading::rotating_feed(units);
            assert_eq!(reading.units(), Some(units));
            let (text, device) = reading.bytes();
            assert_eq!(FeedReading::parse(text, device), reading);
        }
    }

    #[test]
    fn at_a_limit_only_a_polarotor_has_a_number() {
        let reading = |text: &[u8; 2], device| FeedReading::parse(*text, device).units();
        assert_eq!(reading(b"CC", 0x20), Some(661));
        assert_eq!(reading(b"CW", 0x20), Some(0));
        assert_eq!(reading(b"CC", 0x35), None);
        assert_eq!(reading(b"39", 0x45), None);
        assert_eq!(reading(b"  ", 0x20), None);
    }

    #[test]
    fn the_manuals_example_is_260() {
        assert_eq!(FeedReading::parse(*b"39", 0x20).units(), Some(260));
    }
}
