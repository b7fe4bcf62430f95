//! The columns of a pass.

use std::borrow::Cow;

use serde::{Serialize, Serializer};

use super::{ExportedPass, View, degrees, times};
use crate::{
    astro::sun_moon,
    export::{RowFormat, Time, rounded, rows::rfc3339},
    orbit::{Distance, OverGround, Propagator, is_lit},
};

/// A pass with its columns. New columns go at the end, before the Doppler shifts, so that programs
/// that count columns keep working.
#[derive(Default, Serialize)]
pub(super) struct Row<'a> {
    catalog_number: u32,
    name: Cow<'a, str>,
    aos_time: Time,
    aos_azimuth_deg: f64,
    aos_elevation_deg: f64,
    tca_time: Time,
    tca_azimuth_deg: f64,
    tca_elevation_deg: f64,
    los_time: Time,
    los_azimuth_deg: f64,
    los_elevation_deg: f64,
    max_elevation_deg: f64,
    duration_s: f64,
    starts_before: bool,
    ends_after: bool,
    epoch: Epoch,
    age_days: f64,
    /// Range at TCA, km.
    range_km: Option<f64>,
    sunlit: Option<bool>,
    designator: Option<Cow<'a, str>>,
    dark_at_site: bool,
    aos_range_km: Option<f64>,
    los_range_km: Option<f64>,
    aos_range_rate_km_s: Option<f64>,
    tca_range_rate_km_s: Option<f64>,
    los_range_rate_km_s: Option<f64>,
    #[serde(skip_serializing_if = "Doppler::is_left_out")]
    aos_doppler_hz: Doppler,
    #[serde(skip_serializing_if = "Doppler::is_left_out")]
    tca_doppler_hz: Doppler,
    #[serde(skip_serializing_if = "Doppler::is_left_out")]
    los_doppler_hz: Doppler,
}

/// A Doppler shift.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Doppler {
    /// No column, because the list has no carrier.
    #[default]
    LeftOut,
    Unknown,
    Hertz(f64),
}

impl Doppler {
    fn is_left_out(&self) -> bool {
        *self == Self::LeftOut
    }
}

impl Serialize for Doppler {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::LeftOut | Self::Unknown => serializer.serialize_none(),
            Self::Hertz(hertz) => serializer.serialize_f64(*hertz),
        }
    }
}

/// An epoch, written with microseconds; elements have no further digits.
#[derive(Default)]
struct Epoch(jiff::Timestamp);

impl Serialize for Epoch {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&rfc3339::<6>(self.0))
    }
}

/// Distance and Doppler shift, rounded.
#[derive(Clone, Copy, PartialEq)]
struct Geometry {
    range_km: f64,
    range_rate_km_s: f64,
    doppler_hz: Doppler,
}

impl<'a> Row<'a> {
    /// Returns an empty row with the columns of a list with or without Doppler shifts.
    pub(super) fn columns(has_doppler: bool) -> Self {
        let doppler = if has_doppler { Doppler::Unknown } else { Doppler::LeftOut };
        let [aos_doppler_hz, tca_doppler_hz, los_doppler_hz] = [doppler; 3];
        Self { aos_doppler_hz, tca_doppler_hz, los_doppler_hz, ..Self::default() }
    }

    /// Returns a row for each pass, in the order of the passes.
    pub(super) fn all(view: &View, format: RowFormat, passes: &[ExportedPass<'a>]) -> Vec<Self> {
        let requests: Vec<_> = passes
            .iter()
            .flat_map(|row| times(&row.pass).map(|time| (&row.satellite.propagator, time)))
            .collect();
        let places = Propagator::over_ground(&requests);
        let rows = passes.iter().zip(places.as_chunks().0);
        rows.map(|(row, places)| Self::new(view, format, row, places)).collect()
    }

    fn new(
        view: &View,
        format: RowFormat,
        ExportedPass { satellite, pass }: &ExportedPass<'a>,
        places: &[Option<OverGround>; 3],
    ) -> Self {
        let elements = &satellite.elements;
        let geometry = |distance: Distance| Geometry {
            range_km: rounded(distance.range_km, 1e3),
            range_rate_km_s: rounded(distance.range_rate_km_s, 1e6),
            doppler_hz: view.carrier_hz.map_or(Doppler::LeftOut, |hertz| {
                Doppler::Hertz(rounded(distance.doppler_hz(hertz), 10.0))
            }),
        };
        let geometry_at = |place: &Option<OverGround>, time| {
            place.as_ref().map(|place| geometry(view.distance(satellite, place, time, geometry)))
        };
        let [aos_place, tca_place, los_place] = places;
        let aos = geometry_at(aos_place, pass.aos.time);
        let tca = geometry_at(tca_place, pass.tca.time);
        let los = geometry_at(los_place, pass.los.time);
        let sun_km = sun_moon::sun_ecef_km(pass.tca.time);
        let doppler_hz = |geometry: Option<Geometry>| match (geometry, view.carrier_hz) {
            (Some(geometry), _) => geometry.doppler_hz,
            (None, Some(_)) => Doppler::Unknown,
            (None, None) => Doppler::LeftOut,
        };
        Self {
            catalog_number: elements.catalog_number(),
            name: format.text(elements.name()),
            aos_time: Time(pass.aos.time),
            aos_azimuth_deg: degrees(pass.aos.direction.azimuth_deg()),
            aos_elevation_deg: degrees(pass.aos.direction.elevation_deg()),
            tca_time: Time(pass.tca.time),
            tca_azimuth_deg: degrees(pass.tca.direction.azimuth_deg()),
            tca_elevation_deg: degrees(pass.tca.direction.elevation_deg()),
            los_time: Time(pass.los.time),
            los_azimuth_deg: degrees(pass.los.direction.azimuth_deg()),
            los_elevation_deg: degrees(pass.los.direction.elevation_deg()),
            max_elevation_deg: degrees(pass.max_elevation().degrees()),
            duration_s: rounded(pass.duration_s(), 1e3),
            starts_before: pass.starts_before,
            ends_after: pass.ends_after,
            epoch: Epoch(elements.epoch()),
            age_days: satellite.age_days(pass.aos.time),
            range_km: tca.map(|geometry| geometry.range_km),
            sunlit: tca_place.as_ref().map(|place| is_lit(place.position_km, sun_km)),
            designator: elements.international_designator().map(|text| format.text(text)),
            dark_at_site: view.is_dark(sun_km),
            aos_range_km: aos.map(|geometry| geometry.range_km),
            los_range_km: los.map(|geometry| geometry.range_km),
            aos_range_rate_km_s: aos.map(|geometry| geometry.range_rate_km_s),
            tca_range_rate_km_s: tca.map(|geometry| geometry.range_rate_km_s),
            los_range_rate_km_s: los.map(|geometry| geometry.range_rate_km_s),
            aos_doppler_hz: doppler_hz(aos),
            tca_doppler_hz: doppler_hz(tca),
            los_doppler_hz: doppler_hz(los),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use serde_json::Value;

    use super::super::testing::{example, write_to, written, written_with};
    use crate::export::EventFormat;

    #[test]
    fn a_row_of_csv_has_its_columns() {
        let (elements, pass) = example();
        let text = written(EventFormat::Csv, elements, &[pass]);
        let (header, row) = text.split_once('\n').unwrap();
        assert!(header.starts_with("catalog_number,name,aos_time,aos_azimuth_deg"), "{header}");
        let before = "25544,\"ISS, (ZARYA); \"\"1\"\"\",2026-08-12T01:02:03.457Z,350.5,0.0,\
             2026-08-12T01:07:00.000Z,80.25,45.123457,2026-08-12T01:12:00.000Z,170.0,0.0,\
             45.123457,596.543,false,true,2026-08-11T01:21:00.000000Z,0.9868,";
        let rest = row.strip_prefix(before).unwrap_or_else(|| panic!("{row}"));
        let fields: Vec<&str> = rest.trim_end().split(',').collect();
        let [range_km, sunlit, designator, dark_at_site, ..] = fields[..] else { panic!("{row}") };
        assert!((400.0..14_000.0).contains(&range_km.parse::<f64>().unwrap()), "{row}");
        assert!(sunlit.parse::<bool>().is_ok(), "{row}");
        // The pass is before sunrise in Istanbul.
        assert_eq!((designator, dark_at_site), ("1998-067A", "true"));
    }

    #[test]
    fn doppler_comes_last_where_it_is_asked_for() {
        let (elements, pass) = example();
        let text = written_with(EventFormat::Csv, elements, &[pass], Some(145.8e6));
        let (header, row) = text.split_once('\n').unwrap();
        assert!(
            header.ends_with("los_range_rate_km_s,aos_doppler_hz,tca_doppler_hz,los_doppler_hz"),
            "{header}"
        );
        let shifts: Vec<f64> =
            row.trim_end().rsplit(',').take(3).map(|text| text.parse().unwrap()).collect();
        // Upper limit: the Doppler shift at 8 km/s.
        assert!(shifts.iter().all(|shift| shift.abs() < 3_900.0), "{row}");
    }

    #[test]
    fn a_row_of_json_is_flat_and_says_the_same() {
        let (elements, pass) = example();
        let json = written_with(EventFormat::Json, elements.clone(), &[pass, pass], Some(145.8e6));
        let whole: Value = serde_json::from_str(&json).unwrap();
        let rows = whole["passes"].as_array().unwrap();
        assert_eq!((rows.len(), &rows[0]), (2, &rows[1]));
        let csv = written_with(EventFormat::Csv, elements, &[pass], Some(145.8e6));
        let mut table = csv::Reader::from_reader(csv.as_bytes());
        let names = table.headers().unwrap().clone();
        let row = table.records().next().unwrap().unwrap();
        assert_eq!(names.len(), rows[0].as_object().unwrap().len());
        for (name, field) in names.iter().zip(&row) {
            let value = match &rows[0][name] {
                Value::String(text) => text.clone(),
                other => other.to_string(),
            };
            assert_eq!(value, field, "{name}");
        }
        for point in ["aos", "tca", "los"] {
            let number = |name: String| rows[0][name].as_f64().unwrap();
            let shift_hz = -number(format!("{point}_range_rate_km_s")) / 299_792.458 * 145.8e6;
            assert!((number(format!("{point}_doppler_hz")) - shift_hz).abs() < 1.0, "{json}");
        }
    }

    #[test]
    fn a_reader_that_stops_is_told_by_its_kind() {
        struct Closed;
        impl io::Write for Closed {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::BrokenPipe.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let (elements, pass) = example();
        let error = write_to(&mut Closed, EventFormat::Csv, elements, &[pass], None).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::BrokenPipe);
    }
}
