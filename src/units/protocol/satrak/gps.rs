//! GPS receiver and its settings (sections 16, 21 and 22).

use jiff::Timestamp;

use super::ValueError;
use super::fields::{FieldError, FieldProblem, FrameFields};
use super::number::{checked, parse_decimal};

/// Offset of the year: the receiver reports only its last two digits.
const CENTURY: i16 = 2000;

/// A place as the protocol writes it: degrees with a letter, read as decimal degrees. The
/// document's example would also fit degrees and minutes (`41.01` for 41 degrees 1 minute).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    latitude_deg: f64,
    longitude_deg: f64,
}

impl Position {
    /// Returns a place with latitude -90 to 90, north positive, and longitude -180 to 180, east
    /// positive. Azel sends it with two decimals, as in the document.
    pub fn new(latitude_deg: f64, longitude_deg: f64) -> Result<Self, ValueError> {
        Ok(Self {
            latitude_deg: checked("latitude", latitude_deg, -90.0, 90.0)?,
            longitude_deg: checked("longitude", longitude_deg, -180.0, 180.0)?,
        })
    }

    /// Returns the latitude in degrees, north positive.
    pub fn latitude_deg(self) -> f64 {
        self.latitude_deg
    }

    /// Returns the longitude in degrees, east positive.
    pub fn longitude_deg(self) -> f64 {
        self.longitude_deg
    }

    /// Reads two values from `first` on: latitude and longitude.
    pub(super) fn read(fields: FrameFields<'_>, first: usize) -> Result<Self, FieldError> {
        let angle = |field, plus, minus| {
            lettered(fields.text(field)?, plus, minus)
                .ok_or(FieldError { field, problem: FieldProblem::NotPlace })
        };
        let latitude_deg = angle(first, 'N', 'S')?;
        let longitude_deg = angle(first + 1, 'E', 'W')?;
        // The value keeps the precision of the report: only sent values are rounded.
        if latitude_deg.abs() > 90.0 || longitude_deg.abs() > 180.0 {
            return Err(FieldError { field: first, problem: FieldProblem::Range });
        }
        Ok(Self { latitude_deg, longitude_deg })
    }

    fn values(self) -> [String; 2] {
        let text = |angle: f64, plus, minus| {
            // Section 22 has two decimals, and no section shows that a unit takes more.
            format!("{:.2}{}", angle.abs(), if angle < 0.0 { minus } else { plus })
        };
        [text(self.latitude_deg, 'N', 'S'), text(self.longitude_deg, 'E', 'W')]
    }
}

/// Reads a number whose sign is the letter after it.
fn lettered(text: &str, plus: char, minus: char) -> Option<f64> {
    let letter = text.chars().next_back()?.to_ascii_uppercase();
    // `get` is safe if the last character is longer than one byte.
    let magnitude = parse_decimal(text.get(..text.len() - 1)?.trim_end())?;
    match letter {
        // Sign and letter could contradict each other, as in `-41.01S`.
        _ if magnitude < 0.0 => None,
        letter if letter == plus => Some(magnitude),
        letter if letter == minus => Some(-magnitude),
        _ => None,
    }
}

/// Reply to `GPS_DATA?`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GpsData {
    /// `true` if the receiver has a fix. Without a fix, the other fields have no meaning.
    pub valid: bool,
    /// Place of the receiver; `None` if unreadable without a fix.
    pub position: Option<Position>,
    /// Time of the fix, UTC; `None` if unreadable without a fix.
    pub time: Option<Timestamp>,
}

impl GpsData {
    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        // The value is not read as a flag: an unexplained number must not confirm place and time.
        let valid = fields.integer::<i64>(3)? == 1;
        let position = Position::read(fields, 1);
        let time = fields.time(4, CENTURY);
        // A receiver without a fix fills these fields with arbitrary values.
        if valid {
            return Ok(Self { valid, position: Some(position?), time: Some(time?) });
        }
        Ok(Self { valid, position: position.ok(), time: time.ok() })
    }
}

/// Reply to `GPS_SETTINGS?`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GpsSettings {
    /// `true` if the unit takes its place from the receiver, not from `position`.
    pub automatic: bool,
    /// Manual place; `None` if unreadable in automatic mode.
    pub position: Option<Position>,
}

impl GpsSettings {
    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        let automatic = fields.flag(1)?;
        let position = Position::read(fields, 2);
        // In mode 1 the unit does not use the manual place (section 21), which may be empty.
        let position = if automatic { position.ok() } else { Some(position?) };
        Ok(Self { automatic, position })
    }
}

/// Values of `GPS_SETTINGS=`. Azel always sends all three, because the document does not say that
/// the place may be omitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GpsSettingsChange {
    /// `true` to take the place from the receiver.
    pub automatic: bool,
    /// Manual place.
    pub position: Position,
}

impl GpsSettingsChange {
    pub(super) fn values(self) -> Vec<String> {
        let [latitude, longitude] = self.position.values();
        vec![u8::from(self.automatic).to_string(), latitude, longitude]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::Frame;

    fn gps(payload: &str) -> Result<GpsData, FieldError> {
        GpsData::read(FrameFields::new(&Frame::from_payload(payload)))
    }

    #[test]
    fn the_letter_is_the_sign() {
        let south = gps("GPS_DATA?,33.86S,70.5w,1,6,0,2,19,10,17").unwrap().position.unwrap();
        assert_eq!((south.latitude_deg(), south.longitude_deg()), (-33.86, -70.5));
        let change = GpsSettingsChange { automatic: false, position: south };
        assert_eq!(change.values(), ["0", "33.86S", "70.50W"]);
        for bad in ["41.01", "-41.01N", "41.01E", "N", "", "95.0N", "41.01\u{130}"] {
            assert!(gps(&format!("GPS_DATA?,{bad},29.17E,1,6,0,2,19,10,17")).is_err(), "{bad}");
        }
    }

    #[test]
    fn without_a_fix_anything_may_stand_there() {
        let searching = gps("GPS_DATA?,,,0,0,0,0,0,0,0").unwrap();
        assert_eq!(searching, GpsData { valid: false, position: None, time: None });
        assert!(gps("GPS_DATA?,,,1,0,0,0,0,0,0").is_err());
    }
}
