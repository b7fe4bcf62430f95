//! Look angles of one satellite, one row per instant.

use std::io::{self, Write};

use jiff::Timestamp;
use serde::Serialize;

use super::{
    ListFormat, RowFormat, Satellite, Time, civil,
    passes::{about_elevations, degrees, is_refracted, turn},
    rounded,
    rows::{rfc3339, to_millisecond},
    write_rows,
};
use crate::astro::{Site, time};

/// A list of look angles to write.
#[derive(Debug, Clone, Copy)]
pub struct LookList<'a> {
    pub satellite: &'a Satellite,
    pub site: Site,
    pub start: Timestamp,
    /// Number of rows; the first row is at `start`.
    pub count: u32,
    pub step_s: f64,
    /// Carrier frequency of the Doppler shift, Hz.
    pub carrier_hz: Option<f64>,
}

/// Look angles at one instant.
#[derive(Debug, Default, Serialize)]
struct Row {
    time: Time,
    azimuth_deg: f64,
    elevation_deg: f64,
    range_km: f64,
    range_rate_km_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    doppler_hz: Option<f64>,
}

impl LookList<'_> {
    /// Writes the list, which ends where the object decays. All times are UTC.
    pub fn write(&self, out: &mut impl Write, format: ListFormat) -> io::Result<()> {
        let row_format = match format {
            ListFormat::Table => return self.write_table(out),
            ListFormat::Csv => RowFormat::Csv,
            ListFormat::Json => RowFormat::Json,
        };
        let columns = Row { doppler_hz: self.carrier_hz, ..Row::default() };
        write_rows(out, row_format, ("look_angles", &[]), &columns, self.rows())
    }

    fn rows(&self) -> impl Iterator<Item = Row> {
        let instants = (0..self.count)
            .map(|index| time::add_seconds(self.start, f64::from(index) * self.step_s));
        instants.map_while(|time| {
            let look = self.satellite.propagator.look_from(self.site, time).ok()?;
            let distance = look.distance();
            let doppler_hz = |carrier_hz| rounded(distance.doppler_hz(carrier_hz), 10.0);
            Some(Row {
                time: Time(time),
                azimuth_deg: degrees(look.direction.azimuth_deg()),
                elevation_deg: degrees(look.direction.elevation_deg()),
                range_km: rounded(distance.range_km, 1e3),
                range_rate_km_s: rounded(distance.range_rate_km_s, 1e6),
                doppler_hz: self.carrier_hz.map(doppler_hz),
            })
        })
    }

    fn write_table(&self, out: &mut impl Write) -> io::Result<()> {
        // Times show fractions of a second if the step has them.
        let is_fine = self.step_s.fract() > 0.0;
        let head = if is_fine { "UTC                    " } else { "UTC                " };
        write!(out, "{head}     az     el    range km      km/s")?;
        writeln!(out, "{}", if self.carrier_hz.is_some() { "    Doppler Hz" } else { "" })?;
        for row in self.rows() {
            let Time(time) = row.time;
            let shown = if is_fine {
                rfc3339::<3>(to_millisecond(time))
                    .replace('T', " ")
                    .trim_end_matches('Z')
                    .to_owned()
            } else {
                civil(time, "%Y-%m-%d %H:%M:%S")
            };
            write!(
                out,
                "{shown}  {:>5.1}  {:>5.1}  {:>10.1}  {:>8.4}",
                turn(row.azimuth_deg),
                row.elevation_deg,
                row.range_km,
                row.range_rate_km_s,
            )?;
            let doppler = row.doppler_hz.map(|hertz| format!("  {hertz:>12.1}"));
            writeln!(out, "{}", doppler.unwrap_or_default())?;
        }
        writeln!(out, "{}", about_elevations(is_refracted(self.site)))
    }
}

#[cfg(test)]
mod tests {
    use super::{super::passes::testing::example, *};

    fn written(format: ListFormat, step_s: f64, carrier_hz: Option<f64>) -> String {
        let satellite = Satellite::new(example().0).unwrap();
        let start = "2026-08-12T01:00:00Z".parse().unwrap();
        let site = Site::default();
        let list = LookList { satellite: &satellite, site, start, count: 3, step_s, carrier_hz };
        let mut out = Vec::new();
        list.write(&mut out, format).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn all_forms_say_the_same() {
        let whole: serde_json::Value =
            serde_json::from_str(&written(ListFormat::Json, 30.0, Some(1e8))).unwrap();
        let rows = whole["look_angles"].as_array().unwrap();
        let csv = written(ListFormat::Csv, 30.0, Some(1e8));
        let table = written(ListFormat::Table, 30.0, Some(1e8));
        // The last line of the table says which elevations these are.
        assert_eq!((rows.len(), csv.lines().count(), table.lines().count()), (3, 4, 5));
        let head = "time,azimuth_deg,elevation_deg,range_km,range_rate_km_s,doppler_hz";
        assert_eq!(csv.lines().next(), Some(head));
        for ((row, csv), table) in rows.iter().zip(csv.lines().skip(1)).zip(table.lines().skip(1)) {
            let fields: Vec<&str> = csv.split(',').collect();
            assert_eq!(row["time"], fields[0]);
            for (name, field) in head.split(',').zip(&fields).skip(1) {
                assert_eq!(row[name].as_f64(), field.parse().ok(), "{name}");
            }
            let shown: Vec<&str> = table.split_whitespace().collect();
            assert_eq!(shown.len(), 7, "{table}");
            let range_km: f64 = shown[4].parse().unwrap();
            assert!((range_km - row["range_km"].as_f64().unwrap()).abs() < 0.06, "{table}");
        }
    }

    #[test]
    fn steps_of_parts_of_a_second_are_shown() {
        let table = written(ListFormat::Table, 0.5, None);
        assert!(table.contains("\n2026-08-12 01:00:00.500  "), "{table}");
        assert_eq!(table.lines().next().unwrap().len(), table.lines().nth(1).unwrap().len());
    }
}
