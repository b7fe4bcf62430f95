//! OMM as lines of `KEY = value`: one message, or several in succession.

use std::borrow::Cow;

use super::{Field, MessageFields, Value};
use crate::reader::ReadReport;

/// Key that starts every message. The reader also accepts a source that omits it.
const START: &str = "CCSDS_OMM_VERS";

/// Returns `true` if `line` may be the first line of a KVN text.
pub(in crate::reader) fn is_first(line: &str) -> bool {
    line.split_once('=').is_some_and(|(key, _)| {
        let key = key.trim();
        key.eq_ignore_ascii_case(START)
            || matches!(key, "CREATION_DATE" | "ORIGINATOR")
            || Field::named(key).is_some()
    })
}

/// Returns `true` if `line` is a comment, without data of an object.
pub(in crate::reader) fn is_comment(line: &str) -> bool {
    line.split_whitespace().next() == Some("COMMENT")
}

pub(in crate::reader) fn read(text: &str) -> ReadReport {
    let mut report = ReadReport::default();
    let (mut message, mut start) = (MessageFields::default(), 1);
    for (index, line) in text.lines().enumerate() {
        let Some((key, value)) = line.split_once('=').filter(|_| !is_comment(line)) else {
            continue;
        };
        let field = Field::named(key.trim());
        // A repeated field belongs to the next object.
        if key.trim().eq_ignore_ascii_case(START) || field.is_some_and(|field| message.has(field)) {
            std::mem::take(&mut message).finish(start, &mut report);
        }
        if let Some(field) = field {
            if message.is_empty() {
                start = index + 1;
            }
            message.set(field, Value::Text(Cow::Borrowed(without_unit(field, value.trim()))));
        }
    }
    message.finish(start, &mut report);
    report
}

/// Removes the unit from the end of a number, such as `51.6 [deg]`. Names keep their brackets.
fn without_unit(field: Field, value: &str) -> &str {
    match value.strip_suffix(']').and_then(|value| value.rsplit_once('[')) {
        Some((number, _)) if !field.is_text() => number.trim_end(),
        _ => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elements, RefusalReason};

    const MESSAGE: &str = "\
CCSDS_OMM_VERS = 2.0
COMMENT EPOCH = of no object
CREATION_DATE = 2026-08-11T10:00:00
ORIGINATOR = ELSEWHERE

OBJECT_NAME = FENGYUN 1C [-]
OBJECT_ID = 1999-025A
CENTER_NAME = EARTH
REF_FRAME = TEME
TIME_SYSTEM = UTC
MEAN_ELEMENT_THEORY = SGP/SGP4
EPOCH = 2026-08-11T01:21:00.123456Z
MEAN_MOTION = 14.19 [rev/day]
ECCENTRICITY = 0.0012
INCLINATION = 98.6[deg]
RA_OF_ASC_NODE = 225.4004 [deg]
ARG_OF_PERICENTER = 44.9625 [deg]
MEAN_ANOMALY = 5.1087 [deg]
GM = 398600.8 [km**3/s**2]
EPHEMERIS_TYPE = 0
CLASSIFICATION_TYPE = U
NORAD_CAT_ID = 25730
ELEMENT_SET_NO = 999
REV_AT_EPOCH = 23587
BSTAR = 0.00012 [1/ER]
MEAN_MOTION_DOT = 0.00000123 [rev/day**2]
MEAN_MOTION_DDOT =
USER_DEFINED_EARTH_MODEL = WGS-72
";

    #[test]
    fn units_comments_and_fields_of_others_do_no_harm() {
        let report = read(MESSAGE);
        assert_eq!(report.refused, []);
        let elements = &report.elements[0];
        assert_eq!(elements.name(), "FENGYUN 1C [-]");
        assert_eq!(elements.catalog_number(), 25_730);
        assert!((elements.inclination().degrees() - 98.6).abs() < 1e-12);
        assert_eq!(elements.epoch(), "2026-08-11T01:21:00.123456Z".parse().unwrap());
    }

    #[test]
    fn messages_follow_each_other_with_and_without_a_header() {
        let second = MESSAGE.replace("25730", "100001").to_lowercase().replace("utc", "UTC");
        let second = second.replace("sgp/sgp4", "SGP4").replace("teme", "TEME");
        let bare = MESSAGE.split_once("\n\n").unwrap().1.replace("25730", "7");
        let bad = MESSAGE.replace("0.0012\n", "1.0\n").replace("25730", "8");
        let text = format!("{MESSAGE}{second}{bad}{bare}").replace('\n', "\r\n");
        let report = read(&text);
        let numbers: Vec<_> = report.elements.iter().map(Elements::catalog_number).collect();
        assert_eq!(numbers, [25_730, 100_001, 7]);
        let lines = MESSAGE.lines().count();
        assert_eq!(report.refused.len(), 1);
        // This is the first line with data of the object.
        assert_eq!(report.refused[0].line, 2 * lines + 6);
        assert!(matches!(report.refused[0].reason, RefusalReason::Orbit(_)));
    }

    #[test]
    fn dates_by_the_day_of_the_year_are_read() {
        let text = MESSAGE.replace("2026-08-11T01:21:00.123456Z", "2026-223T01:21:00.123456");
        assert_eq!(read(&text).elements, read(MESSAGE).elements);
        let text = MESSAGE.replace("2026-08-11T01:21:00.123456Z", "2026-367T01:21:00");
        assert_eq!(read(&text).refused[0].reason, RefusalReason::Field("EPOCH"));
    }

    #[test]
    fn other_frames_times_and_theories_are_refused() {
        for (line, field) in [
            ("CENTER_NAME = MOON", "CENTER_NAME"),
            ("REF_FRAME = GCRF", "REF_FRAME"),
            ("TIME_SYSTEM = GPS", "TIME_SYSTEM"),
            ("MEAN_ELEMENT_THEORY = DSST", "MEAN_ELEMENT_THEORY"),
        ] {
            let lines = MESSAGE.lines().filter(|row| !row.starts_with(field));
            let text = lines.chain([line]).collect::<Vec<_>>().join("\n");
            assert_eq!(read(&text).refused[0].reason, RefusalReason::Field(field));
        }
    }
}
