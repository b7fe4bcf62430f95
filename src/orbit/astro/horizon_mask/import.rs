//! Imports horizon masks written by other programs.

use super::{Builder, HorizonMask, MaskError};

/// Names of the azimuth column in lower case, most certain first.
const AZIMUTH: [&str; 8] = [
    "azimuth",
    "az",
    "true bearing",
    "bearing",
    "true heading",
    "heading",
    "direction",
    "horizontal angle",
];
/// Names of the elevation column in lower case, most certain first. A file from a phone may also
/// hold the altitude of the location.
const ELEVATION: [&str; 11] = [
    "elevation angle",
    "vertical angle",
    "altitude angle",
    "horizon angle",
    "elevation",
    "el",
    "inclination",
    "pitch",
    "angle",
    "altitude",
    "alt",
];
/// Sections that contain a mask in a file of keys and values, in lower case.
const SECTIONS: [&str; 3] = ["horizon", "horizon mask", "mask"];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MaskForm {
    /// Two numbers per line, without names.
    Points,
    /// A table whose first line names its columns.
    Table,
    /// Lines of `azimuth = elevation`, optionally in a section, as in the station files of
    /// other programs.
    Keys,
}

/// Reason why a text contains no mask in a known form.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MaskImportError {
    #[error("line {line} names no column for the {column}")]
    Column {
        /// Line that names the columns, counted from 1.
        line: usize,
        /// Missing column: "azimuth" or "elevation".
        column: &'static str,
    },
    /// The file has sections, but none for a horizon.
    #[error("the file has no section [horizon]")]
    NoSection,
    #[error("line {line} does not hold an azimuth and an elevation in degrees")]
    Format {
        /// Line, counted from 1.
        line: usize,
    },
    /// A line contains a point that the mask refuses.
    #[error("line {line}: {reason}")]
    Point {
        /// Line, counted from 1.
        line: usize,
        reason: MaskError,
    },
    #[error("there is no azimuth and elevation in it")]
    Empty,
}

impl HorizonMask {
    /// Reads a mask in any known form, recognised by its content. The forms are two numbers per
    /// line, a table, or lines of `azimuth = elevation`. Commas, semicolons or tabs separate the
    /// cells of a table, and its first line names the columns. A line with an unusable point is an
    /// error, so that no point is lost silently.
    pub fn import(text: &str) -> Result<(Self, MaskForm), MaskImportError> {
        let lines: Vec<(usize, &str)> = (1..)
            .zip(text.trim_start_matches('\u{feff}').lines())
            .map(|(number, line)| (number, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !is_comment(line))
            .collect();
        let Some((_, first)) = lines.first() else { return Err(MaskImportError::Empty) };
        let (points, form) = if first.starts_with('[') || first.contains('=') {
            (keys(&lines)?, MaskForm::Keys)
        } else if first.chars().any(char::is_alphabetic) {
            (table(&lines)?, MaskForm::Table)
        } else {
            (plain(&lines)?, MaskForm::Points)
        };
        let mut builder = Builder::default();
        let at_line = |(line, reason)| match reason {
            MaskError::Empty => MaskImportError::Empty,
            _ => MaskImportError::Point { line, reason },
        };
        for (line, azimuth_deg, elevation_deg) in points {
            builder.add(line, azimuth_deg, elevation_deg).map_err(at_line)?;
        }
        Ok((builder.finish().map_err(at_line)?, form))
    }

    /// Returns the mask as a table for other programs. Commas separate the cells, and the first
    /// line names the columns. [`HorizonMask::import`] reads the table without loss.
    pub fn to_csv(&self) -> String {
        let lines = self.points.iter().map(|(azimuth, elevation)| format!("{azimuth},{elevation}"));
        std::iter::once("azimuth_deg,elevation_deg".to_owned())
            .chain(lines)
            .map(|line| line + "\n")
            .collect()
    }
}

type Point = (usize, f64, f64);

fn is_comment(line: &str) -> bool {
    line.starts_with('#') || line.starts_with("//")
}

/// Reads lines of two numbers. Decimal commas are allowed if spaces, tabs or semicolons
/// separate the numbers.
fn plain(lines: &[(usize, &str)]) -> Result<Vec<Point>, MaskImportError> {
    let point = |&(line, text): &(usize, &str)| {
        let text = text.split('#').next().unwrap_or_default().trim();
        let two = |(azimuth, elevation): (f64, f64)| (line, azimuth, elevation);
        let read = super::numbers(text).or_else(|| {
            let cells: Vec<&str> =
                text.split([';', '\t', ' ']).filter(|cell| !cell.is_empty()).collect();
            match cells[..] {
                [azimuth, elevation] => Some((number(azimuth)?, number(elevation)?)),
                _ => None,
            }
        });
        read.map(two).ok_or(MaskImportError::Format { line })
    };
    lines.iter().map(point).collect()
}

/// Reads a table with a header line.
fn table(lines: &[(usize, &str)]) -> Result<Vec<Point>, MaskImportError> {
    let Some(((line, head), rows)) = lines.split_first() else { return Ok(Vec::new()) };
    let separator = [';', '\t', ','].into_iter().find(|mark| head.contains(*mark)).unwrap_or(',');
    let names: Vec<String> = cells(head, separator).iter().map(|name| plain_name(name)).collect();
    let place = |aliases: &[&str], column| {
        let found =
            aliases.iter().find_map(|name| names.iter().position(|heading| heading == name));
        found.ok_or(MaskImportError::Column { line: *line, column })
    };
    let azimuth = place(&AZIMUTH, "azimuth")?;
    let elevation = place(&ELEVATION, "elevation")?;
    let point = |&(line, text): &(usize, &str)| {
        let cells = cells(text, separator);
        let cell = |place: usize| cells.get(place).and_then(|cell| number(cell));
        let (Some(azimuth_deg), Some(elevation_deg)) = (cell(azimuth), cell(elevation)) else {
            return Err(MaskImportError::Format { line });
        };
        Ok((line, azimuth_deg, elevation_deg))
    };
    rows.iter().map(point).collect()
}

/// Reads the keys and values of the sections for the horizon, or all of them if there are no
/// sections.
fn keys(lines: &[(usize, &str)]) -> Result<Vec<Point>, MaskImportError> {
    let has_sections = lines.iter().any(|(_, line)| line.starts_with('['));
    let (mut is_inside, mut was_inside) = (!has_sections, !has_sections);
    let mut points = Vec::new();
    for &(line, text) in lines {
        if let Some(name) = text.strip_prefix('[') {
            let name = name.trim_end_matches(']').trim().to_lowercase();
            is_inside = SECTIONS.contains(&name.as_str());
            was_inside |= is_inside;
        } else if is_inside {
            let pair = text.split_once('=').and_then(|(azimuth, elevation)| {
                Some((line, number(azimuth)?, number(elevation)?))
            });
            points.push(pair.ok_or(MaskImportError::Format { line })?);
        }
    }
    if was_inside { Ok(points) } else { Err(MaskImportError::NoSection) }
}

fn cells(line: &str, separator: char) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut is_quoted = false;
    for mark in line.chars() {
        if mark == '"' {
            is_quoted = !is_quoted;
        } else if mark == separator && !is_quoted {
            cells.push(String::new());
        } else if let Some(cell) = cells.last_mut() {
            cell.push(mark);
        }
    }
    cells
}

/// Returns the name of a column without its unit: `Azimuth (deg)` and `azimuth_deg` both become
/// "azimuth".
fn plain_name(name: &str) -> String {
    let name = name.split(['(', '[', '°']).next().unwrap_or_default();
    let name = name.replace('_', " ").to_lowercase();
    let name = name.trim();
    let bare = ["degrees", "degree", "deg"].iter().find_map(|unit| name.strip_suffix(unit));
    bare.unwrap_or(name).trim().to_owned()
}

/// Reads a number that may have a decimal comma, a typographic minus or a degree sign.
fn number(text: &str) -> Option<f64> {
    let text = text.trim().trim_end_matches('°').trim_end();
    text.replace(',', ".").replace('−', "-").parse().ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn expected() -> HorizonMask {
        HorizonMask::from_degrees([(0.0, 1.5), (90.0, -2.0), (180.5, 3.0)]).unwrap()
    }

    #[test]
    fn every_usual_form_is_recognised_by_its_content() {
        for (text, form) in [
            ("# Azel\n0 1.5\n90 -2 # dip\n180.5 3\n", MaskForm::Points),
            ("0,1.5\r\n90,-2\r\n180.5,3", MaskForm::Points),
            ("0;1,5\n90;-2\n180,5;3", MaskForm::Points),
            ("0,0 1,5\n90,0 -2,0\n180,5 3,0", MaskForm::Points),
            ("\u{feff}az,el\n0,1.5\n90,-2\n180.5,3", MaskForm::Table),
            ("Azimuth (deg);Elevation (deg)\n180,5;3\n0;1,5\n90;−2", MaskForm::Table),
            ("azimuth_deg\televation_deg\n0\t1.5\n90\t-2\n180.5\t3", MaskForm::Table),
            (
                "\"Date\",\"Altitude\",\"True Bearing\",\"Vertical Angle\"\n\
                 \"14 Nov 2026, 12:00\",\"118\",\"0°\",\"1.5°\"\n\
                 \"14 Nov 2026, 12:01\",\"118\",\"90°\",\"-2.0°\"\n\
                 \"14 Nov 2026, 12:02\",\"118\",\"-179.5°\",\"3.0°\"",
                MaskForm::Table,
            ),
            ("bearing,distance km,altitude\n0,12,1.5\n90,3,-2\n180.5,1,3", MaskForm::Table),
            (
                "[GROUND STATION]\nLAT=41.2\nLON=29.6\n[HORIZON]\n0=1.5\n90 = -2\n180.5=3",
                MaskForm::Keys,
            ),
            ("0=1.5\n90=-2\n180.5=3", MaskForm::Keys),
        ] {
            assert_eq!(HorizonMask::import(text), Ok((expected(), form)), "{text}");
        }
    }

    #[test]
    fn what_is_no_mask_is_refused_with_line_and_reason() {
        use MaskImportError as E;
        for (text, error) in [
            ("", E::Empty),
            ("# nothing\n\n", E::Empty),
            ("az,el\n", E::Empty),
            ("name,el\n0,1", E::Column { line: 1, column: "azimuth" }),
            ("# by hand\naz,distance\n0,1", E::Column { line: 2, column: "elevation" }),
            ("az,el\n0,1\n\n90,x", E::Format { line: 4 }),
            ("az,el\n0,1\n90", E::Format { line: 3 }),
            ("0 1\n90 2 3", E::Format { line: 2 }),
            ("[GROUND STATION]\nLAT=41.2", E::NoSection),
            ("[HORIZON]\n0=1\nLAT=41.2", E::Format { line: 3 }),
            ("LAT=41.2\nLON=29", E::Format { line: 1 }),
            ("az,el\n0,1\n9,1\n0,2", E::Point { line: 4, reason: MaskError::Duplicate(0.0) }),
            ("az,el\n-181,1", E::Point { line: 2, reason: MaskError::Azimuth(-181.0) }),
            ("az,altitude\n10,118", E::Point { line: 2, reason: MaskError::Elevation(118.0) }),
            ("W1AW\n41.7\n72.7\n25", E::Column { line: 1, column: "azimuth" }),
        ] {
            assert_eq!(HorizonMask::import(text), Err(error), "{text}");
        }
    }

    proptest! {
        #[test]
        fn an_exported_mask_comes_back_whole(
            points in prop::collection::btree_map(0_u16..3600, -90.0..90.0_f64, 1..40),
        ) {
            let points = points.into_iter().map(|(tenth, el)| (f64::from(tenth) / 10.0, el));
            let mask = HorizonMask::from_degrees(points).unwrap();
            let (read, form) = HorizonMask::import(&mask.to_csv()).unwrap();
            prop_assert_eq!((&read, form), (&mask, MaskForm::Table));
            prop_assert_eq!(HorizonMask::import(&mask.to_string()), Ok((read, MaskForm::Points)));
        }

        #[test]
        fn any_text_gives_a_mask_or_a_reason(text in "[0-9 .,;=#\t\nazel\\[\\]\"-]*") {
            if let Ok((mask, _)) = HorizonMask::import(&text) {
                prop_assert!(!mask.points_deg().is_empty());
            }
        }
    }
}
