//! OMM: one object as named fields, in JSON, XML, KVN or CSV.
//!
//! Each form fills a [`Message`], and this module alone interprets its fields.
//!
//! Source: CCSDS 502.0-B "Orbit Data Messages", with the fields that `CelesTrak` and Space-Track
//! write. Space-Track writes numbers as strings; some sources end the epoch with `Z` and omit the
//! ephemeris type and the classification.

pub(super) mod csv;
pub(super) mod json;
pub(super) mod kvn;
pub(super) mod xml;

use std::borrow::Cow;

use jiff::{Timestamp, civil, tz::TimeZone};

use super::{ReadReport, RefusalReason, clean, numbers, tle};
use crate::{
    Elements,
    elements::{Classification, ElementsError, catalog_number},
};

/// Fields that are read; all others are ignored. The last three are not part of OMM: `SatNOGS` DB
/// writes the lines of a TLE under these names.
const FIELDS: [&str; 24] = [
    "OBJECT_NAME",
    "OBJECT_ID",
    "NORAD_CAT_ID",
    "EPOCH",
    "MEAN_MOTION",
    "ECCENTRICITY",
    "INCLINATION",
    "RA_OF_ASC_NODE",
    "ARG_OF_PERICENTER",
    "MEAN_ANOMALY",
    "BSTAR",
    "MEAN_MOTION_DOT",
    "MEAN_MOTION_DDOT",
    "EPHEMERIS_TYPE",
    "CLASSIFICATION_TYPE",
    "ELEMENT_SET_NO",
    "REV_AT_EPOCH",
    "MEAN_ELEMENT_THEORY",
    "CENTER_NAME",
    "REF_FRAME",
    "TIME_SYSTEM",
    "TLE0",
    "TLE1",
    "TLE2",
];

/// A field that is read, as its index in [`FIELDS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Field(usize);

impl Field {
    /// Returns the field called `name`, in any case.
    fn named(name: &str) -> Option<Self> {
        FIELDS.iter().position(|field| field.eq_ignore_ascii_case(name)).map(Self)
    }

    /// Returns `true` if the field holds text that is used without conversion.
    fn is_text(self) -> bool {
        FIELDS.get(self.0).is_some_and(|name| name.starts_with("OBJECT_"))
    }

    /// Returns `true` if the field holds a number that may have a fraction.
    fn is_number(self) -> bool {
        FIELDS.get(self.0).is_some_and(|name| {
            name.starts_with("MEAN_MOTION")
                || matches!(
                    *name,
                    "ECCENTRICITY"
                        | "INCLINATION"
                        | "RA_OF_ASC_NODE"
                        | "ARG_OF_PERICENTER"
                        | "MEAN_ANOMALY"
                        | "BSTAR"
                )
        })
    }

    /// Returns `true` if the field holds a line of a TLE.
    fn is_tle(self) -> bool {
        FIELDS.get(self.0).is_some_and(|name| name.starts_with("TLE"))
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Value<'a> {
    /// Text, which may contain a number.
    Text(Cow<'a, str>),
    Number(f64),
    /// Value that no field can hold.
    Other,
}

/// Fields of one message that have a value.
#[derive(Debug, Default)]
struct MessageFields<'a> {
    values: [Option<Value<'a>>; FIELDS.len()],
    /// The message has places for lines of a TLE, even if they are empty.
    has_tle: bool,
}

impl<'a> MessageFields<'a> {
    /// Sets a field. Empty text does not count as a value.
    fn set(&mut self, field: Field, value: Value<'a>) {
        if let Value::Text(text) = &value
            && text.trim().is_empty()
        {
            return;
        }
        if let Some(place) = self.values.get_mut(field.0) {
            *place = Some(value);
        }
    }

    fn has(&self, field: Field) -> bool {
        self.values.get(field.0).is_some_and(Option::is_some)
    }

    fn is_empty(&self) -> bool {
        self.values.iter().all(Option::is_none)
    }

    /// Adds the elements of the message to `report`; adds nothing for an empty message.
    fn finish(&self, line: usize, report: &mut ReadReport) {
        if self.is_empty() {
            return;
        }
        match self.elements() {
            Ok(elements) => report.elements.push(elements),
            Err(reason) => report.refuse(line, self.object().as_deref(), reason),
        }
    }

    /// Returns the name or number of the object, for a refusal.
    fn object(&self) -> Option<String> {
        let field = |name| match self.value(name)? {
            Value::Text(text) => Some(text.trim().to_owned()),
            Value::Number(number) => Some(number.to_string()),
            Value::Other => None,
        };
        let name = || self.text("TLE0").map(|line| tle::name_in(line).to_owned());
        field("OBJECT_NAME").or_else(name).or_else(|| field("NORAD_CAT_ID"))
    }

    /// Reads the TLE of a message that holds a TLE in place of an orbit; returns `None` for an OMM.
    fn tle(&self) -> Option<Result<tle::Read, RefusalReason>> {
        if !self.has_tle || self.text("EPOCH").is_some() {
            return None;
        }
        Some(self.read_tle())
    }

    fn read_tle(&self) -> Result<tle::Read, RefusalReason> {
        let name = tle::name_in(self.text("TLE0").unwrap_or_default());
        let read = tle::read_lines(name, self.text("TLE1"), self.text("TLE2"))?;
        // `SatNOGS` DB may list a satellite with the lines of another object that flies with it.
        let lines = read.elements.catalog_number();
        match self.whole("NORAD_CAT_ID")? {
            Some(stated) if stated != u64::from(lines) => {
                Err(RefusalReason::OtherNumber { stated, lines })
            }
            _ => Ok(read),
        }
    }

    fn elements(&self) -> Result<Elements, RefusalReason> {
        self.is_sgp4()?;
        // OMM 3.0 allows a message without a number, but catalog, favourites and plans identify an
        // object by its number.
        let number = self.whole("NORAD_CAT_ID")?;
        let number = number.ok_or(RefusalReason::MissingField("NORAD_CAT_ID"))?;
        let elements = Elements {
            name: clean(self.text("OBJECT_NAME").unwrap_or_default()),
            international_designator: clean(self.text("OBJECT_ID").unwrap_or_default()),
            catalog_number: catalog_number(number)?,
            epoch: self.epoch()?,
            mean_motion_rev_day: self.needed("MEAN_MOTION")?,
            mean_motion_dot: self.decimal("MEAN_MOTION_DOT")?.unwrap_or(0.0),
            mean_motion_ddot: self.decimal("MEAN_MOTION_DDOT")?.unwrap_or(0.0),
            bstar: self.needed("BSTAR")?,
            inclination_deg: self.needed("INCLINATION")?,
            node_deg: self.needed("RA_OF_ASC_NODE")?,
            eccentricity: self.needed("ECCENTRICITY")?,
            perigee_deg: self.needed("ARG_OF_PERICENTER")?,
            mean_anomaly_deg: self.needed("MEAN_ANOMALY")?,
            set_number: self.count("ELEMENT_SET_NO")?,
            revolution_number: self.count("REV_AT_EPOCH")?,
            ephemeris_type: self.count("EPHEMERIS_TYPE")?,
            classification: Classification::from_letter(
                self.text("CLASSIFICATION_TYPE").unwrap_or_default(),
            ),
        };
        Ok(elements.checked()?)
    }

    /// Checks that the numbers are for SGP4 as used here, if the message declares it. Numbers of
    /// another theory or frame would be off by kilometres.
    fn is_sgp4(&self) -> Result<(), RefusalReason> {
        let fits = |name, fit: fn(&str) -> bool| match self.text(name) {
            Some(text) if !fit(text) => Err(RefusalReason::Field(name)),
            _ => Ok(()),
        };
        fits("MEAN_ELEMENT_THEORY", |theory| {
            matches!(theory, "SGP4" | "SGP" | "SGP/SGP4" | "SDP4")
        })?;
        fits("CENTER_NAME", |center| center.eq_ignore_ascii_case("EARTH"))?;
        fits("REF_FRAME", |frame| frame.starts_with("TEME"))?;
        fits("TIME_SYSTEM", |system| system == "UTC")
    }

    fn value(&self, name: &'static str) -> Option<&Value<'a>> {
        self.values.get(Field::named(name)?.0)?.as_ref()
    }

    /// Returns text that is not empty.
    fn text(&self, name: &'static str) -> Option<&str> {
        match self.value(name)? {
            Value::Text(text) => Some(text.trim()),
            _ => None,
        }
    }

    /// Returns a whole number; `None` if the field is absent.
    fn whole(&self, name: &'static str) -> Result<Option<u64>, RefusalReason> {
        let whole = match self.value(name) {
            None => return Ok(None),
            Some(Value::Text(text)) => {
                let text = text.trim();
                // Source: CCSDS 502.0-B, 7.5.4.
                numbers::digits(text.strip_prefix('+').unwrap_or(text))
            }
            Some(Value::Number(number)) if *number >= 0.0 && number.fract() == 0.0 => {
                Some(*number as u64)
            }
            Some(_) => None,
        };
        whole.map(Some).ok_or(RefusalReason::Field(name))
    }

    /// Returns a whole number, 0 if absent.
    fn count<T: TryFrom<u64>>(&self, name: &'static str) -> Result<T, RefusalReason> {
        let count = self.whole(name)?.unwrap_or(0);
        T::try_from(count).map_err(|_| RefusalReason::Field(name))
    }

    fn decimal(&self, name: &'static str) -> Result<Option<f64>, RefusalReason> {
        let number = match self.value(name) {
            None => return Ok(None),
            Some(Value::Text(text)) => text.trim().parse().ok(),
            Some(Value::Number(number)) => Some(*number),
            Some(Value::Other) => None,
        };
        number.map(Some).ok_or(RefusalReason::Field(name))
    }

    fn needed(&self, name: &'static str) -> Result<f64, RefusalReason> {
        self.decimal(name)?.ok_or(RefusalReason::MissingField(name))
    }

    /// Returns the epoch, which is UTC even if the text does not say so.
    fn epoch(&self) -> Result<Timestamp, RefusalReason> {
        let text = self.text("EPOCH").ok_or(RefusalReason::MissingField("EPOCH"))?;
        // The parser of civil times ignores an offset and a zone.
        let time = text.split_once(['T', 't', ' ']).map_or("", |(_, time)| time);
        if time.contains('[') {
            return Err(RefusalReason::Field("EPOCH"));
        }
        if time.contains(['+', '-']) {
            return text.parse().map_err(|_| RefusalReason::Field("EPOCH"));
        }
        let text = text.trim_end_matches(['Z', 'z']);
        let civil: Option<civil::DateTime> = text.parse().ok().or_else(|| by_day_of_year(text));
        let civil = civil.ok_or_else(|| {
            if has_date_order(text) {
                RefusalReason::DateOrder
            } else {
                RefusalReason::Field("EPOCH")
            }
        })?;
        let zoned = civil.to_zoned(TimeZone::UTC).map_err(|_| ElementsError::Epoch(civil))?;
        Ok(zoned.timestamp())
    }
}

/// Returns `true` if `text` begins with a date of three numbers that does not start with a year,
/// such as `27/11/2026`.
fn has_date_order(text: &str) -> bool {
    let date = text.split([' ', 'T']).next().unwrap_or_default();
    let parts: Vec<&str> = date.split(['/', '.', '-']).collect();
    let is_number = |part: &&str| {
        (1..=4).contains(&part.len()) && part.bytes().all(|letter| letter.is_ascii_digit())
    };
    matches!(parts[..], [first, _, _] if first.len() <= 2) && parts.iter().all(is_number)
}

/// Returns the time in the other date format of CCSDS: `2026-223T01:21:00`.
fn by_day_of_year(text: &str) -> Option<civil::DateTime> {
    let (date, time) = text.split_once('T')?;
    let (year, day) = date.split_once('-')?;
    let date = civil::Date::new(year.parse().ok()?, 1, 1).ok()?;
    let date = date.with().day_of_year(day.parse().ok()?).build().ok()?;
    Some(date.to_datetime(time.parse().ok()?))
}
