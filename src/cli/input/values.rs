//! Values of the command line, each with a sentence about the permitted ones.

use jiff::{Timestamp, civil, tz::TimeZone};

use crate::astro::{Site, SiteError};

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "not a number".to_owned())
}

fn site(latitude_deg: f64, longitude_deg: f64, altitude_m: f64) -> Result<(), String> {
    let site = Site::new(latitude_deg, longitude_deg, altitude_m);
    site.map(|_| ()).map_err(|error: SiteError| error.to_string())
}

pub(super) fn latitude(text: &str) -> Result<f64, String> {
    let degrees = number(text)?;
    site(degrees, 0.0, 0.0).map(|()| degrees)
}

pub(super) fn longitude(text: &str) -> Result<f64, String> {
    let degrees = number(text)?;
    site(0.0, degrees, 0.0).map(|()| degrees)
}

pub(super) fn altitude(text: &str) -> Result<f64, String> {
    let metres = number(text)?;
    site(0.0, 0.0, metres).map(|()| metres)
}

pub(in crate::cli) fn elevation(text: &str) -> Result<f64, String> {
    let degrees = number(text)?;
    if (-90.0..=90.0).contains(&degrees) {
        Ok(degrees)
    } else {
        Err("not between -90 and 90 degrees".to_owned())
    }
}

pub(in crate::cli) fn hours(text: &str) -> Result<f64, String> {
    above_zero(text, 24.0 * 366.0, "hours")
}

pub(in crate::cli) fn minutes(text: &str) -> Result<f64, String> {
    above_zero(text, 60.0 * 24.0 * 31.0, "minutes")
}

pub(in crate::cli) fn megahertz(text: &str) -> Result<f64, String> {
    above_zero(text, 1e6, "MHz")
}

pub(in crate::cli) fn share(text: &str) -> Result<f64, String> {
    let share = number(text)?;
    if (0.0..=1.0).contains(&share) { Ok(share) } else { Err("not between 0 and 1".to_owned()) }
}

pub(in crate::cli) fn step_s(text: &str) -> Result<f64, String> {
    let seconds = number(text)?;
    if (0.1..=86_400.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("not between 0.1 and 86400 seconds".to_owned())
    }
}

pub(in crate::cli) fn duration_s(text: &str) -> Result<f64, String> {
    let seconds = number(text)?;
    if (0.0..=1e9).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("not between 0 and 1000000000 seconds".to_owned())
    }
}

fn above_zero(text: &str, max: f64, unit: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value > 0.0 && value <= max {
        Ok(value)
    } else {
        Err(format!("not between 0 and {max} {unit}"))
    }
}

/// Parses `now`, a date (its first instant in UTC), or RFC 3339.
pub(in crate::cli) fn instant(text: &str) -> Result<Timestamp, String> {
    if text.eq_ignore_ascii_case("now") {
        return Ok(Timestamp::now());
    }
    // Checked by length: the parser of dates ignores a time behind the date.
    let date = (text.len() == 10).then(|| text.parse::<civil::Date>().ok()).flatten();
    let midnight = date.and_then(|date| date.to_zoned(TimeZone::UTC).ok());
    midnight.map(|midnight| midnight.timestamp()).or_else(|| text.parse().ok()).ok_or_else(|| {
        "neither now, nor a date such as 2026-08-12, nor a time with Z or an offset such as \
         2026-08-12T09:00:00+03:00"
            .to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instant_is_now_a_date_or_a_time_with_an_offset() {
        let utc = |text: &str| text.parse::<Timestamp>().unwrap();
        for (text, expected) in [
            ("2026-08-12", "2026-08-12T00:00:00Z"),
            ("2026-08-12T06:30:00Z", "2026-08-12T06:30:00Z"),
            ("2026-08-12T09:30:00+03:00", "2026-08-12T06:30:00Z"),
            ("2026-08-12 01:00:00-05:30", "2026-08-12T06:30:00Z"),
        ] {
            assert_eq!(instant(text), Ok(utc(expected)), "{text}");
        }
        let (before, now, after) = (Timestamp::now(), instant("now"), Timestamp::now());
        assert!((before..=after).contains(&now.unwrap()));
        for text in ["yesterday", "", "2026-08-32", "2026-08-12T06:30:00", "12.08.2026"] {
            assert!(instant(text).unwrap_err().contains("2026-08-12"), "{text}");
        }
    }

    #[test]
    fn a_place_is_on_the_earth() {
        assert_eq!(latitude("-90"), Ok(-90.0));
        assert!(latitude("91").unwrap_err().contains("between -90 and 90"));
        assert!(longitude("NaN").is_err() && longitude("361").is_err() && altitude("1e5").is_err());
        assert_eq!((longitude("360"), altitude("-430")), (Ok(360.0), Ok(-430.0)));
    }
}
