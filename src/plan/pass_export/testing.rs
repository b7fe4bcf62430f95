//! One pass to write, for the tests of all forms.

use jiff::Timestamp;

use super::{ExportedPass, PassFormat, write_passes};
use crate::{
    astro::{Angle, AzEl},
    orbit::{Elements, Pass, PassPoint, read_elements},
};

/// A satellite whose name holds all that has to be quoted somewhere, and a pass.
pub(super) fn example() -> (Elements, Pass) {
    let text = serde_json::json!({
        "OBJECT_NAME": "ISS, (ZARYA); \"1\"", "NORAD_CAT_ID": 25_544,
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

pub(super) fn written(format: PassFormat, elements: &Elements, passes: &[Pass]) -> String {
    let rows: Vec<_> = passes.iter().map(|pass| ExportedPass { elements, pass }).collect();
    let mut out = Vec::new();
    let now: Timestamp = "2026-08-11T00:00:00Z".parse().unwrap();
    write_passes(&mut out, format, &rows, now).unwrap();
    String::from_utf8(out).unwrap()
}
