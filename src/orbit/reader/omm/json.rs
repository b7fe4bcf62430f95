//! OMM in JSON: one object or a list of objects. The reader also accepts TLE that `SatNOGS` DB
//! writes as JSON.

mod split;

use std::{borrow::Cow, fmt};

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use self::split::{Part, parts};
use super::{Field, MessageFields, Value};
use crate::reader::{ReadReport, RefusalReason};

pub(in crate::reader) fn read(text: &str) -> ReadReport {
    let mut report = ReadReport::default();
    // Some servers wrap the list in an object.
    let mut is_wrapped = false;
    let (mut last, mut is_sound) = (1, true);
    for Part { line, text } in parts(text) {
        last = line;
        if !text.starts_with('{') {
            if !is_wrapped {
                report.refuse(line, None, RefusalReason::NotAnObject);
            }
            continue;
        }
        let mut message = MessageFields::default();
        let mut json = serde_json::Deserializer::from_str(text);
        let filled = Fill(&mut message).deserialize(&mut json).and_then(|()| json.end());
        if filled.is_err() && message.is_empty() && text.trim_end().ends_with('[') {
            is_wrapped = true;
            continue;
        }
        is_sound = filled.is_ok();
        let filled = filled.map_err(|_| RefusalReason::Json);
        let object = message.object();
        let read = match message.tle() {
            Some(tle) => filled.and(tle).map(|read| {
                read.finish(line, object.as_deref(), &mut report);
            }),
            None => filled.and_then(|()| message.elements()).map(|elements| {
                report.elements.push(elements);
            }),
        };
        if let Err(reason) = read {
            report.refuse(line, object.as_deref(), reason);
        }
    }
    // An object that breaks off has already been refused.
    if is_sound && text.trim_start().starts_with('[') && !text.trim_end().ends_with(']') {
        report.refuse(last, None, RefusalReason::BreaksOff);
    }
    report
}

/// Seed that fills a message from a JSON object, as far as it can be read.
struct Fill<'m, 'a>(&'m mut MessageFields<'a>);

impl<'de> DeserializeSeed<'de> for Fill<'_, 'de> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Fill<'_, 'de> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<(), A::Error> {
        while let Some(field) = fields.next_key_seed(KeySeed)? {
            let value = fields.next_value_seed(ValueSeed)?;
            self.0.has_tle |= field.is_some_and(Field::is_tle);
            if let (Some(field), Some(value)) = (field, value) {
                self.0.set(field, value);
            }
        }
        Ok(())
    }
}

/// Seed that reads a key; `None` if no field has this name.
struct KeySeed;

impl<'de> DeserializeSeed<'de> for KeySeed {
    type Value = Option<Field>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl Visitor<'_> for KeySeed {
    type Value = Option<Field>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E>(self, key: &str) -> Result<Self::Value, E> {
        Ok(Field::named(key))
    }
}

/// Seed that reads a value of any kind; `None` is null.
struct ValueSeed;

impl<'de> DeserializeSeed<'de> for ValueSeed {
    type Value = Option<Value<'de>>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ValueSeed {
    type Value = Option<Value<'de>>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_borrowed_str<E>(self, text: &'de str) -> Result<Self::Value, E> {
        Ok(Some(Value::Text(Cow::Borrowed(text))))
    }

    fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
        Ok(Some(Value::Text(Cow::Owned(text.to_owned()))))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Self::Value, E> {
        Ok(Some(Value::Number(number as f64)))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
        Ok(Some(Value::Number(number as f64)))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
        Ok(Some(Value::Number(number)))
    }

    fn visit_bool<E>(self, _: bool) -> Result<Self::Value, E> {
        Ok(Some(Value::Other))
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        while list.next_element::<IgnoredAny>()?.is_some() {}
        Ok(Some(Value::Other))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<Self::Value, A::Error> {
        while object.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(Some(Value::Other))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value as Json, json};

    use super::*;
    use crate::{ElementsError, reader::Refusal};

    /// Returns a message as `CelesTrak` writes it, with a number that no TLE can carry.
    fn celestrak() -> Json {
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

    /// Returns the message with one field changed; null removes the field.
    fn message_with(key: &str, value: Json) -> Json {
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
        let two = read(
            &json!([celestrak(), message_with("NORAD_CAT_ID", json!(999_999_999))]).to_string(),
        );
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
        dialect["DECAY_DATE"] = Json::Null;
        assert_eq!(read(&dialect.to_string()).elements, plain);
        for key in ["EPHEMERIS_TYPE", "CLASSIFICATION_TYPE"] {
            let report = read(&message_with(key, Json::Null).to_string());
            assert_eq!(report.elements, plain, "{key}");
        }
    }

    #[test]
    fn epochs_before_1970_keep_their_fraction() {
        let report = read(&message_with("EPOCH", json!("1959-02-17T16:05:00.25")).to_string());
        assert_eq!(report.elements[0].epoch(), "1959-02-17T16:05:00.25Z".parse().unwrap());
    }

    #[test]
    fn what_is_no_orbit_is_refused_by_its_field() {
        use RefusalReason as Why;
        let year = |year| jiff::civil::date(year, 1, 1).at(0, 0, 0, 0);
        for (key, value, reason) in [
            ("EPOCH", json!("soon"), Why::Field("EPOCH")),
            (
                "EPOCH",
                json!("-009999-01-01T00:00:00"),
                Why::Orbit(ElementsError::Epoch(year(-9999))),
            ),
            ("EPOCH", json!("0000-01-01T00:00:00"), Why::Orbit(ElementsError::Epoch(year(0)))),
            ("MEAN_MOTION", Json::Null, Why::MissingField("MEAN_MOTION")),
            ("MEAN_MOTION", json!(-1.0), Why::Orbit(ElementsError::MeanMotion(-1.0))),
            ("ECCENTRICITY", json!(1.0), Why::Orbit(ElementsError::Eccentricity(1.0))),
            ("INCLINATION", json!("inf"), Why::Orbit(ElementsError::NotFinite)),
            ("BSTAR", json!([]), Why::Field("BSTAR")),
            ("EPHEMERIS_TYPE", json!(4), Why::Orbit(ElementsError::EphemerisType(4))),
            ("EPHEMERIS_TYPE", json!(256), Why::Field("EPHEMERIS_TYPE")),
            ("MEAN_ELEMENT_THEORY", json!("SGP4-XP"), Why::Field("MEAN_ELEMENT_THEORY")),
        ] {
            let report = read(&json!([message_with(key, value), celestrak()]).to_string());
            assert_eq!(report.elements.len(), 1, "{key}");
            let object = Some("NEW OBJECT".to_owned());
            assert_eq!(report.refused, [Refusal { line: 1, object, reason }]);
        }
    }

    #[test]
    fn a_list_that_breaks_off_between_objects_is_told() {
        let list = format!("[\n{},\n{}", celestrak(), celestrak());
        for end in ["", ",", ",\n"] {
            let report = read(&format!("{list}{end}"));
            assert_eq!(report.elements.len(), 2);
            let refusal_reason = RefusalReason::BreaksOff;
            assert_eq!(report.refused, [Refusal { line: 3, object: None, reason: refusal_reason }]);
        }
        assert_eq!(read(&format!("{list}\n]\n")).refused, []);
    }

    #[test]
    fn lists_within_an_object_and_an_object_around_the_list_are_read() {
        let nested =
            message_with("extra", json!({"a": {"b": [1, {"c": 3}]}, "d": [{"e": 1}, {"f": 2}]}));
        let report = read(&json!([nested, celestrak()]).to_string());
        assert_eq!((report.elements.len(), report.refused.len()), (2, 0), "{:?}", report.refused);
        for wrapper in [
            json!({"data": [nested, celestrak()]}),
            json!({"count": 2, "data": [celestrak(), nested], "next": null}),
        ] {
            let report = read(&wrapper.to_string());
            assert_eq!((report.elements.len(), report.refused.len()), (2, 0), "{wrapper}");
        }
    }

    /// Returns a set as `SatNOGS` DB lists it.
    fn satnogs() -> Json {
        json!({
            "tle0": "0 TESTSAT A",
            "tle1": "1 90001U 98067ZZ  26331.25000000  .00001000  00000-0  10000-3 0  9997",
            "tle2": "2 90001  51.6400  10.0000 0004000  90.0000  30.0000 15.50000000000017",
            "tle_source": "Space-Track.org", "sat_id": "TEST-0000-0000", "norad_cat_id": 90_001,
            "updated": "2026-11-27T07:00:00.000000+0000"
        })
    }

    #[test]
    fn the_sets_of_satnogs_are_read() {
        let mut bare = satnogs();
        bare["norad_cat_id"] = Json::Null;
        bare["tle0"] = json!("TESTSAT A");
        for wrapper in [json!([satnogs(), bare]), json!({"results": [satnogs(), bare]})] {
            let report = read(&wrapper.to_string());
            assert_eq!((report.elements.len(), &report.refused), (2, &vec![]), "{wrapper}");
            assert_eq!(report.elements[0], report.elements[1]);
            let read = &report.elements[0];
            assert_eq!((read.catalog_number(), read.name()), (90_001, "TESTSAT A"));
            assert_eq!(read.epoch(), "2026-11-27T06:00:00Z".parse().unwrap());
        }
        let mut unprotected = satnogs();
        let line = unprotected["tle1"].as_str().unwrap()[..68].to_owned();
        unprotected["tle1"] = json!(line);
        let report = read(&json!([unprotected]).to_string());
        assert_eq!((report.elements.len(), report.notes.len()), (1, 1));
    }

    #[test]
    fn a_bad_set_of_satnogs_is_refused_alone_and_says_why() {
        use RefusalReason as Why;
        let wrong = satnogs()["tle2"].as_str().unwrap().replace("51.6400", "51.7400");
        for (key, value, reason) in [
            ("tle1", Json::Null, Why::MissingLine { missing: 1 }),
            ("tle2", json!(""), Why::MissingLine { missing: 2 }),
            ("tle1", json!("1 90001U"), Why::TooShort { line: 1, columns: 8 }),
            ("tle2", json!(wrong), Why::Checksum { line: 2, found: 7, expected: 8 }),
            ("norad_cat_id", json!(25_544), Why::OtherNumber { stated: 25_544, lines: 90_001 }),
            ("norad_cat_id", json!("soon"), Why::Field("NORAD_CAT_ID")),
        ] {
            let mut bad = satnogs();
            bad[key] = value;
            let report = read(&format!("[{bad},\n{}]", satnogs()));
            assert_eq!(report.elements.len(), 1, "{key}");
            let object = Some("TESTSAT A".to_owned());
            assert_eq!(report.refused, [Refusal { line: 1, object, reason }], "{key}");
        }
        let nothing = json!([{ "tle0": null, "tle1": null, "tle2": null, "norad_cat_id": 7 }]);
        let report = read(&nothing.to_string());
        let object = Some("7".to_owned());
        let reason = Why::MissingLine { missing: 1 };
        assert_eq!(report.refused, [Refusal { line: 1, object, reason }]);
    }

    #[test]
    fn a_torn_download_keeps_what_arrived() {
        let whole = format!("[\n{},\n{}\n]", celestrak(), celestrak());
        let report = read(&whole[..whole.len() - 40]);
        assert_eq!(report.elements.len(), 1);
        let object = Some("NEW OBJECT".to_owned());
        let torn = Refusal { line: 3, object, reason: RefusalReason::Json };
        assert_eq!(report.refused, [torn]);
    }
}
