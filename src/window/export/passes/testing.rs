//! An example pass for the tests of all formats.

use std::io::{self, Write};

use jiff::Timestamp;

use super::{ExportedPass, PassList, PassQuery, Satellite};
use crate::{
    astro::{Angle, AzEl, Site},
    export::EventFormat,
    orbit::{Elements, Pass, PassPoint, PassSearch, read_elements},
};

/// Returns a pass, and a satellite whose name contains every character that some format has to
/// quote.
pub(in crate::export) fn example() -> (Elements, Pass) {
    let text = serde_json::json!({
        "OBJECT_NAME": "ISS, (ZARYA); \"1\"", "OBJECT_ID": "1998-067A", "NORAD_CAT_ID": 25_544,
        "EPOCH": "2026-08-11T01:21:00", "MEAN_MOTION": 15.5, "ECCENTRICITY": 0.001,
        "INCLINATION": 51.6, "RA_OF_ASC_NODE": 0, "ARG_OF_PERICENTER": 0, "MEAN_ANOMALY": 0,
        "BSTAR": 0
    });
    let elements = read_elements(&text.to_string()).elements.remove(0);
    let point = |time: &str, azimuth: f64, elevation: f64| PassPoint {
        time: time.parse().unwrap(),
        direction: AzEl {
            azimuth: Angle::from_degrees(azimuth),
            elevation: Angle::from_degrees(elevation),
        },
    };
    let pass = Pass {
        aos: point("2026-08-12T01:02:03.4567Z", 350.5, -1e-9),
        tca: point("2026-08-12T01:07:00Z", 80.25, 45.123_456_7),
        los: point("2026-08-12T01:12:00Z", 170.0, 0.0),
        starts_before: false,
        ends_after: true,
    };
    (elements, pass)
}

pub(super) fn written(format: EventFormat, elements: Elements, passes: &[Pass]) -> String {
    written_with(format, elements, passes, None)
}

/// Formats passes like [`written`], with the Doppler shift of a carrier.
pub(super) fn written_with(
    format: EventFormat,
    elements: Elements,
    passes: &[Pass],
    carrier_hz: Option<f64>,
) -> String {
    let mut out = Vec::new();
    write_to(&mut out, format, elements, passes, carrier_hz).unwrap();
    String::from_utf8(out).unwrap()
}

/// Writes passes over Istanbul, in a window from the day before.
pub(super) fn write_to(
    out: &mut impl Write,
    format: EventFormat,
    elements: Elements,
    passes: &[Pass],
    carrier_hz: Option<f64>,
) -> io::Result<()> {
    let satellite = Satellite::new(elements).unwrap();
    let rows = passes.iter().map(|pass| ExportedPass { satellite: &satellite, pass: *pass });
    let time = |text: &str| -> Timestamp { text.parse().unwrap() };
    let (now, end) = (time("2026-08-11T00:00:00Z"), time("2026-08-13T00:00:00Z"));
    let query = PassQuery { search: PassSearch::new(Site::default(), now, end), mask: None };
    let (place, alarm_before_s) = (None, None);
    let list = PassList { query: &query, place, carrier_hz, alarm_before_s, now };
    list.write(out, format, rows)
}
