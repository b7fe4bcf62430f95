//! OMM with the fields of `CelesTrak`, in the order of `CelesTrak`.

use std::io::{self, Write};

use jiff::tz::TimeZone;
use serde::Serialize;

use crate::Elements;

#[derive(Serialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
struct Message<'a> {
    object_name: &'a str,
    object_id: &'a str,
    epoch: String,
    mean_motion: f64,
    eccentricity: f64,
    inclination: f64,
    ra_of_asc_node: f64,
    arg_of_pericenter: f64,
    mean_anomaly: f64,
    ephemeris_type: u8,
    classification_type: char,
    norad_cat_id: u32,
    element_set_no: u32,
    rev_at_epoch: u32,
    bstar: f64,
    mean_motion_dot: f64,
    mean_motion_ddot: f64,
}

impl<'a> From<&'a Elements> for Message<'a> {
    fn from(elements: &'a Elements) -> Self {
        let epoch = elements.epoch.to_zoned(TimeZone::UTC);
        Self {
            object_name: &elements.name,
            object_id: &elements.international_designator,
            epoch: epoch.strftime("%Y-%m-%dT%H:%M:%S%.6f").to_string(),
            mean_motion: elements.mean_motion_rev_day,
            eccentricity: elements.eccentricity,
            inclination: elements.inclination_deg,
            ra_of_asc_node: elements.node_deg,
            arg_of_pericenter: elements.perigee_deg,
            mean_anomaly: elements.mean_anomaly_deg,
            ephemeris_type: elements.ephemeris_type,
            classification_type: elements.classification.letter(),
            norad_cat_id: elements.catalog_number,
            element_set_no: elements.set_number,
            rev_at_epoch: elements.revolution_number,
            bstar: elements.bstar,
            mean_motion_dot: elements.mean_motion_dot,
            mean_motion_ddot: elements.mean_motion_ddot,
        }
    }
}

/// Writes a JSON list, one message per line. The function fails only if `out` fails.
pub fn write_omm_json<'a>(
    elements: impl IntoIterator<Item = &'a Elements>,
    mut out: impl Write,
) -> io::Result<()> {
    let mut before = "[\n";
    for elements in elements {
        out.write_all(before.as_bytes())?;
        serde_json::to_writer(&mut out, &Message::from(elements))?;
        before = ",\n";
    }
    // An empty list still needs its opening bracket.
    let end = if before == "[\n" { "[]\n" } else { "\n]\n" };
    out.write_all(end.as_bytes())
}

/// Writes a header and one row per message, or nothing if there are no messages. The function fails
/// only if `out` fails.
pub fn write_omm_csv<'a>(
    elements: impl IntoIterator<Item = &'a Elements>,
    out: impl Write,
) -> io::Result<()> {
    let mut rows = csv::Writer::from_writer(out);
    for elements in elements {
        rows.serialize(Message::from(elements))?;
    }
    rows.flush()
}
