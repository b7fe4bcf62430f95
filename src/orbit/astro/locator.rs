//! Maidenhead locators: squares of the ground, named by pairs of letters and digits.

use super::GroundPoint;

/// Division of a square by the next pair of characters.
struct Division {
    first: char,
    count: u32,
}

/// Fields, squares, subsquares and extended squares.
const DIVISIONS: [Division; 4] = [
    Division { first: 'A', count: 18 },
    Division { first: '0', count: 10 },
    Division { first: 'A', count: 24 },
    Division { first: '0', count: 10 },
];

/// Square of the ground that a locator names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocatorSquare {
    pub centre: GroundPoint,
    /// Size from south to north, degrees; the size from west to east is twice as large.
    pub height_deg: f64,
}

/// Reason why a text is no locator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LocatorError {
    #[error("must have 4, 6 or 8 characters, such as KN41 or KN41ob")]
    Length,
    /// The character at this place, counted from 1, is out of range.
    #[error("has a wrong character at place {place}: it must be {first} to {last}")]
    Character { place: usize, first: char, last: char },
}

/// Reads a locator of 4, 6 or 8 characters, in upper or lower case.
pub fn read_locator(text: &str) -> Result<LocatorSquare, LocatorError> {
    let letters: Vec<char> =
        text.trim().chars().map(|letter| letter.to_ascii_uppercase()).collect();
    if !matches!(letters.len(), 4 | 6 | 8) {
        return Err(LocatorError::Length);
    }
    let (mut longitude_deg, mut latitude_deg) = (-180.0, -90.0);
    let mut height_deg = 180.0;
    for ((index, pair), division) in letters.chunks(2).enumerate().zip(&DIVISIONS) {
        height_deg /= f64::from(division.count);
        for (offset, letter) in pair.iter().enumerate() {
            let step = division.step(*letter).ok_or_else(|| LocatorError::Character {
                place: 2 * index + offset + 1,
                first: division.first,
                last: division.last(),
            })?;
            if offset == 0 {
                longitude_deg += 2.0 * height_deg * step;
            } else {
                latitude_deg += height_deg * step;
            }
        }
    }
    let centre =
        GroundPoint::from_degrees(latitude_deg + height_deg / 2.0, longitude_deg + height_deg);
    Ok(LocatorSquare { centre, height_deg })
}

impl Division {
    /// Returns the number of the part that `letter` names, from south or west.
    fn step(&self, letter: char) -> Option<f64> {
        let step = u32::from(letter).checked_sub(u32::from(self.first))?;
        (step < self.count).then_some(f64::from(step))
    }

    fn last(&self) -> char {
        char::from_u32(u32::from(self.first) + self.count - 1).unwrap_or(self.first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn centre(locator: &str) -> (f64, f64) {
        let square = read_locator(locator).unwrap();
        (square.centre.latitude.degrees(), square.centre.longitude.degrees())
    }

    /// The places are W1AW in Newington, Munich, Montevideo, Washington and Wellington.
    #[test]
    fn published_locators_hold_their_places() {
        for (locator, latitude_deg, longitude_deg) in [
            ("FN31pr", 41.714_775, -72.727_260),
            ("JN58td", 48.146_66, 11.608_33),
            ("GF15vc", -34.91, -56.211_66),
            ("FM18lw", 38.92, -77.065),
            ("RE78ir", -41.283_33, 174.745),
        ] {
            let square = read_locator(locator).unwrap();
            let deviation = (latitude_deg - square.centre.latitude.degrees()).abs();
            assert!(deviation <= square.height_deg / 2.0, "{locator}");
            let difference = (longitude_deg - square.centre.longitude.degrees()).abs();
            assert!(difference <= square.height_deg, "{locator}");
        }
    }

    #[test]
    fn a_locator_names_the_centre_of_its_square() {
        let is_near =
            |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-9 && (b - d).abs() < 1e-9;
        assert!(is_near(centre("JJ00"), (0.5, 1.0)));
        assert!(is_near(centre("AA00"), (-89.5, -179.0)));
        assert!(is_near(centre("RR99"), (89.5, 179.0)));
        assert!(is_near(centre("JJ00aa"), (0.5 / 24.0, 1.0 / 24.0)));
        assert!(is_near(centre("jj00AA00"), (0.5 / 240.0, 1.0 / 240.0)));
        assert!(is_near(centre(" KN41ob "), (41.0 + 1.5 / 24.0, 28.0 + 29.0 / 24.0)));
    }

    #[test]
    fn what_is_no_locator_is_refused_with_its_place() {
        for text in ["", "K", "KN4", "KN41o", "KN41ob5", "KN41ob55a", "41.02"] {
            assert_eq!(read_locator(text), Err(LocatorError::Length), "{text}");
        }
        for (text, wrong) in
            [("SN41", 1), ("KN4x", 4), ("KN41oy", 6), ("1N41", 1), ("KN41ob5\u{b2}", 8)]
        {
            let Err(LocatorError::Character { place, .. }) = read_locator(text) else {
                panic!("{text}")
            };
            assert_eq!(place, wrong, "{text}");
        }
    }
}
