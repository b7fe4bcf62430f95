//! OMM in JSON: one object, or a list of them.
//!
//! Source: CCSDS 502.0-B "Orbit Data Messages", with the keys `CelesTrak` and
//! Space-Track write. Space-Track writes numbers as strings; some sources end
//! the epoch with `Z` and leave out the ephemeris type and the classification.

mod split;

use jiff::civil;
use serde_json::{Map, Value};
use sgp4::chrono::{DateTime, NaiveDateTime};

use self::split::{Part, parts};
use super::{ReadReport, Refusal, RefusalReason};
use crate::orbit::{Elements, elements::ElementsError};

/// The fields of one message.
type Fields = Map<String, Value>;

/// Reads all objects of `text`.
pub(super) fn read(text: &str) -> ReadReport {
    let mut report = ReadReport::default();
    for Part { line, text } in parts(text) {
        let mut refuse = |object, reason| report.refused.push(Refusal { line, object, reason });
        if !text.starts_with('{') {
            refuse(None, RefusalReason::NotAnObject);
            continue;
        }
        let Ok(fields) = serde_json::from_str::<Fields>(text) else {
            refuse(None, RefusalReason::Json);
            continue;
        };
        match message(&fields) {
            Ok(elements) => report.elements.push(elements),
            Err(reason) => refuse(object(&fields), reason),
        }
    }
    report
}

/// The name of a message, or its number, to name a refused one.
fn object(fields: &Fields) -> Option<String> {
    let field = |key| match fields.get(key)? {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    };
    field("OBJECT_NAME").or_else(|| field("NORAD_CAT_ID"))
}

/// Reads one message.
fn message(fields: &Fields) -> Result<Elements, RefusalReason> {
    if let Some(theory) = text(fields, "MEAN_ELEMENT_THEORY")
        && !matches!(theory, "SGP4" | "SGP" | "SGP/SGP4")
    {
        return Err(RefusalReason::Field("MEAN_ELEMENT_THEORY"));
    }
    let inner = sgp4::Elements {
        object_name: text(fields, "OBJECT_NAME").map(str::to_owned),
        international_designator: text(fields, "OBJECT_ID").map(str::to_owned),
        norad_id: whole(fields, "NORAD_CAT_ID")?
            .ok_or(RefusalReason::MissingField("NORAD_CAT_ID"))?,
        classification: match text(fields, "CLASSIFICATION_TYPE") {
            Some("C") => sgp4::Classification::Classified,
            Some("S") => sgp4::Classification::Secret,
            _ => sgp4::Classification::Unclassified,
        },
        datetime: epoch(fields)?,
        mean_motion_dot: decimal(fields, "MEAN_MOTION_DOT")?.unwrap_or(0.0),
        mean_motion_ddot: decimal(fields, "MEAN_MOTION_DDOT")?.unwrap_or(0.0),
        drag_term: needed(fields, "BSTAR")?,
        element_set_number: whole(fields, "ELEMENT_SET_NO")?.unwrap_or(0),
        inclination: needed(fields, "INCLINATION")?,
        right_ascension: needed(fields, "RA_OF_ASC_NODE")?,
        eccentricity: needed(fields, "ECCENTRICITY")?,
        argument_of_perigee: needed(fields, "ARG_OF_PERICENTER")?,
        mean_anomaly: needed(fields, "MEAN_ANOMALY")?,
        mean_motion: needed(fields, "MEAN_MOTION")?,
        revolution_number: whole(fields, "REV_AT_EPOCH")?.unwrap_or(0),
        ephemeris_type: u8::try_from(whole(fields, "EPHEMERIS_TYPE")?.unwrap_or(0))
            .map_err(|_| RefusalReason::Field("EPHEMERIS_TYPE"))?,
    };
    Ok(Elements::new(inner)?)
}

/// A text that says something.
fn text<'a>(fields: &'a Fields, key: &str) -> Option<&'a str> {
    fields.get(key)?.as_str().map(str::trim).filter(|text| !text.is_empty())
}

/// A number, written as such or as a string. `None` when it is absent or null.
fn number<T: std::str::FromStr>(
    fields: &Fields,
    key: &'static str,
    plain: fn(&Value) -> Option<T>,
) -> Result<Option<T>, RefusalReason> {
    let value = match fields.get(key) {
        None | Some(Value::Null) => return Ok(None),
        Some(Value::String(text)) => text.trim().parse().ok(),
        Some(other) => plain(other),
    };
    value.map(Some).ok_or(RefusalReason::Field(key))
}

fn whole(fields: &Fields, key: &'static str) -> Result<Option<u64>, RefusalReason> {
    number(fields, key, Value::as_u64)
}

fn decimal(fields: &Fields, key: &'static str) -> Result<Option<f64>, RefusalReason> {
    number(fields, key, Value::as_f64)
}

fn needed(fields: &Fields, key: &'static str) -> Result<f64, RefusalReason> {
    decimal(fields, key)?.ok_or(RefusalReason::MissingField(key))
}

/// The epoch, which is UTC whether it says so or not.
fn epoch(fields: &Fields) -> Result<NaiveDateTime, RefusalReason> {
    let text = text(fields, "EPOCH").ok_or(RefusalReason::MissingField("EPOCH"))?;
    let civil: civil::DateTime =
        text.trim_end_matches(['Z', 'z']).parse().map_err(|_| RefusalReason::Field("EPOCH"))?;
    let out_of_range = RefusalReason::Orbit(ElementsError::Epoch);
    let utc =
        civil.to_zoned(jiff::tz::TimeZone::UTC).map_err(|_| out_of_range.clone())?.timestamp();
    // Never negative: the range of epochs begins before 1970, so take the floor.
    let seconds = utc.as_nanosecond().div_euclid(1_000_000_000);
    let nanoseconds = utc.as_nanosecond().rem_euclid(1_000_000_000);
    i64::try_from(seconds)
        .ok()
        .zip(u32::try_from(nanoseconds).ok())
        .and_then(|(seconds, nanoseconds)| DateTime::from_timestamp(seconds, nanoseconds))
        .map(|time| time.naive_utc())
        .ok_or(out_of_range)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// A message as `CelesTrak` writes it, with a number no TLE can carry.
    fn celestrak() -> Value {
        json!({
            "OBJECT_NAME": "NEW OBJECT", "OBJECT_ID": "2026-150A",
            "EPOCH": "2026-08-11T01:21:00.123456", "MEAN_MOTION": 15.495_605_32,
            "ECCENTRICITY": 0.000_177_1, "INCLINATION": 51.6435, "RA_OF_ASC_NODE": 225.4004,
            "ARG_OF_PERICENTER": 44.9625, "MEAN_ANOMALY": 5.1087, "EPHEMERIS_TYPE": 0,
            "CLASSIFICATION_TYPE": "U", "NORAD_CAT_ID": 100_123, "ELEMENT_SET_NO": 999,
            "REV_AT_EPOCH": 23587, "BSTAR": 0.004_964_5, "MEAN_MOTION_DOT": 0.002_890_36,
            "MEAN_MOTION_DDOT": 0
        })
    }

    /// The message with one field changed; null takes it away.
    fn with(key: &str, value: Value) -> Value {
        let mut message = celestrak();
        let fields = message.as_object_mut().unwrap();
        if value.is_null() {
            fields.remove(key)
        } else {
            fields.insert(key.into(), value)
        };
        message
    }

    #[test]
    fn one_object_and_a_list_are_read() {
        let one = read(&celestrak().to_string());
        let two = read(&json!([celestrak(), with("NORAD_CAT_ID", json!(999_999_999))]).to_string());
        assert_eq!((&one.refused, &two.refused), (&vec![], &vec![]));
        assert_eq!(one.elements[0], two.elements[0]);
        assert_eq!(one.elements[0].catalog_number(), 100_123);
        assert_eq!(one.elements[0].name(), "NEW OBJECT");
        assert_eq!(one.elements[0].epoch(), "2026-08-11T01:21:00.123456Z".parse().unwrap());
        assert_eq!(two.elements[1].catalog_number(), 999_999_999);
    }

    #[test]
    fn the_dialects_give_the_same_orbit() {
        let plain = read(&celestrak().to_string()).elements;
        let mut dialect = celestrak();
        for (_, value) in dialect.as_object_mut().unwrap() {
            if value.is_number() {
                *value = json!(value.to_string());
            }
        }
        dialect["EPOCH"] = json!("2026-08-11T01:21:00.123456Z");
        dialect["CREATION_DATE"] = json!("2026-08-11T02:00:00");
        dialect["DECAY_DATE"] = Value::Null;
        assert_eq!(read(&dialect.to_string()).elements, plain);
        for key in ["EPHEMERIS_TYPE", "CLASSIFICATION_TYPE"] {
            let report = read(&with(key, Value::Null).to_string());
            assert_eq!(report.elements, plain, "{key}");
        }
    }

    #[test]
    fn epochs_before_1970_keep_their_fraction() {
        let report = read(&with("EPOCH", json!("1959-02-17T16:05:00.25")).to_string());
        assert_eq!(report.elements[0].epoch(), "1959-02-17T16:05:00.25Z".parse().unwrap());
    }

    #[test]
    fn what_is_no_orbit_is_refused_by_its_field() {
        use RefusalReason as Why;
        for (key, value, reason) in [
            ("EPOCH", json!("soon"), Why::Field("EPOCH")),
            ("EPOCH", json!("-009999-01-01T00:00:00"), Why::Orbit(ElementsError::Epoch)),
            ("EPOCH", json!("0000-01-01T00:00:00"), Why::Orbit(ElementsError::Epoch)),
            ("MEAN_MOTION", Value::Null, Why::MissingField("MEAN_MOTION")),
            ("MEAN_MOTION", json!(-1.0), Why::Orbit(ElementsError::MeanMotion(-1.0))),
            ("ECCENTRICITY", json!(1.0), Why::Orbit(ElementsError::Eccentricity(1.0))),
            ("INCLINATION", json!("inf"), Why::Orbit(ElementsError::NotFinite)),
            ("BSTAR", json!([]), Why::Field("BSTAR")),
            ("EPHEMERIS_TYPE", json!(4), Why::Orbit(ElementsError::EphemerisType(4))),
            ("EPHEMERIS_TYPE", json!(256), Why::Field("EPHEMERIS_TYPE")),
            ("MEAN_ELEMENT_THEORY", json!("SGP4-XP"), Why::Field("MEAN_ELEMENT_THEORY")),
        ] {
            let report = read(&json!([with(key, value), celestrak()]).to_string());
            assert_eq!(report.elements.len(), 1, "{key}");
            let object = Some("NEW OBJECT".to_owned());
            assert_eq!(report.refused, [Refusal { line: 1, object, reason }]);
        }
    }

    #[test]
    fn a_torn_download_keeps_what_arrived() {
        let whole = format!("[\n{},\n{}\n]", celestrak(), celestrak());
        let report = read(&whole[..whole.len() - 40]);
        assert_eq!(report.elements.len(), 1);
        let torn = Refusal { line: 3, object: None, reason: RefusalReason::Json };
        assert_eq!(report.refused, [torn]);
    }
}
