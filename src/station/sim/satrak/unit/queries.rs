//! Answers to queries, value by value as the document lists them.

use super::Satrak;
use super::memory::DEFAULT_REDUCTION;
use crate::protocol::satrak::{AxisMotion, FaultKind, Query};
use crate::sim::satrak::answer::{Answer, Value};

impl Satrak {
    pub(super) fn query(&self, query: Query) -> Answer {
        let values = match query {
            Query::Version => {
                let units = ["SATRAK CU V1.2 18/10/2017", "SATRAK DU V1.22 18/10/2017"];
                units.map(Value::text).to_vec()
            }
            Query::Status => self.status(),
            Query::Faults => FaultKind::ALL.map(|kind| self.fault_value(kind)).to_vec(),
            Query::Clock => self.clock(),
            Query::StartStopTime => self.start_stop_time(),
            Query::Settings => self.settings(),
            Query::AngleSettings => self.angle_settings(),
            Query::GpsData => self.gps_data(),
            Query::TimedPosition => self.timed_position(),
            Query::GpsSettings => self.gps_settings(),
            Query::Satellite => self.satellite(),
            Query::SatelliteHttp => self.satellite_http(),
            Query::SatelliteFtp => self.satellite_ftp(),
            // The document does not explain the values; zero probably means "idle".
            Query::ImageStatus => vec![Value::text(0)],
            Query::Reduction => {
                let ratio = self.memory.reduction;
                let (x, y) = ratio.map_or((DEFAULT_REDUCTION, DEFAULT_REDUCTION), |reduction| {
                    (reduction.x(), reduction.y())
                });
                vec![Value::text(x), Value::text(y)]
            }
        };
        Answer::values(query.word(), values)
    }

    fn status(&self) -> Vec<Value> {
        let direction = self.direction();
        // Round first, so that 359.999 becomes 0.00 and not 360.00.
        let az_deg = (direction.azimuth_deg() * 100.0).round() / 100.0 % 360.0;
        let [x_deg, y_deg] = self.last_xy_deg;
        let (x, y) = (&self.mount.x, &self.mount.y);
        let state = self.tracking.state(self.rtc(), self.memory.settings.lead_ms);
        let waited = self.elapsed.min(self.gps_lock_after);
        vec![
            Value::flag(FaultKind::ALL.into_iter().any(|kind| self.has_fault(kind))),
            Value::fixed(az_deg, 2),
            Value::fixed(direction.elevation_deg(), 2),
            Value::flag(x.is_at_upper_end()),
            Value::flag(x.is_at_lower_end()),
            Value::flag(y.is_at_upper_end()),
            Value::flag(y.is_at_lower_end()),
            Value::flag(self.tracking.is_enabled),
            Value::text(state.code()),
            Value::flag(self.is_clock_from_gps),
            Value::text(waited.as_secs()),
            Value::text(self.reported(x.motion()).code()),
            Value::text(self.reported(y.motion()).code()),
            Value::fixed(x_deg, 1),
            Value::fixed(y_deg, 1),
            Value::flag(self.tracking.is_auto),
        ]
    }

    fn reported(&self, motion: AxisMotion) -> AxisMotion {
        if self.rests_falsely { AxisMotion::Still } else { motion }
    }

    fn fault_value(&self, kind: FaultKind) -> Value {
        // A sensor fault is a lost connection, 2; a configuration error would be 1.
        let code = if matches!(kind, FaultKind::XSensor | FaultKind::YSensor) { 2 } else { 1 };
        Value::text(if self.has_fault(kind) { code } else { 0 })
    }

    fn clock(&self) -> Vec<Value> {
        let rtc = self.rtc();
        let mut values = Value::time(rtc);
        values.push(Value::text(rtc.subsec_millisecond()));
        values
    }

    fn start_stop_time(&self) -> Vec<Value> {
        let window = self.tracking.window;
        // A new unit shows the start of its calendar twice.
        let unset = jiff::Timestamp::from_second(946_684_800).unwrap_or_default();
        let (start, stop) = window
            .map_or((unset, unset), |track_window| (track_window.start(), track_window.stop()));
        [Value::time(start), Value::time(stop)].concat()
    }

    fn settings(&self) -> Vec<Value> {
        let settings = &self.memory.settings;
        vec![
            Value::flag(settings.rtc_from_gps),
            Value::text(settings.time_offset_ms),
            Value::decimal(settings.az_offset_deg),
            Value::decimal(settings.el_offset_deg),
            Value::text(settings.lead_ms),
            Value::text(settings.position_base.code()),
            Value::decimal(settings.minimum_elevation_deg),
            Value::decimal(settings.north_offset_deg),
            Value::text(settings.sspa.code()),
            Value::text(settings.sspa_auto.code()),
            Value::text(settings.tle_mode.code()),
            Value::decimal(settings.elevation_threshold_deg),
        ]
    }

    fn angle_settings(&self) -> Vec<Value> {
        let angles = &self.memory.angles;
        vec![
            Value::text(angles.x_sensor),
            Value::decimal(angles.x_deg),
            Value::text(angles.y_sensor),
            Value::decimal(angles.y_deg),
        ]
    }

    fn gps_data(&self) -> Vec<Value> {
        if !self.is_gps_locked() {
            let mut values = place(0.0, 0.0);
            values.extend([0; 7].map(Value::text));
            return values;
        }
        let mut values = place(self.site.latitude().degrees(), self.site.longitude().degrees());
        values.push(Value::flag(true));
        let mut time = Value::time(self.utc());
        time.pop();
        values.extend(time);
        let year = jiff::tz::TimeZone::UTC.to_datetime(self.utc()).year();
        values.push(Value::text(year.rem_euclid(100)));
        values
    }

    fn timed_position(&self) -> Vec<Value> {
        let [x_deg, y_deg] = self.last_xy_deg;
        let mut values = vec![Value::fixed(x_deg, 2), Value::fixed(y_deg, 2)];
        values.extend(self.clock());
        values
    }

    fn gps_settings(&self) -> Vec<Value> {
        let (is_automatic, latitude_deg, longitude_deg) = self.memory.gps.map_or_else(
            || (true, self.site.latitude().degrees(), self.site.longitude().degrees()),
            |gps| (gps.automatic, gps.position.latitude_deg(), gps.position.longitude_deg()),
        );
        let mut values = vec![Value::flag(is_automatic)];
        values.extend(place(latitude_deg, longitude_deg));
        values
    }

    fn satellite(&self) -> Vec<Value> {
        let (file, name, period) = self.memory.satellite.as_ref().map_or(("", "", 1), |choice| {
            (choice.file.as_str(), choice.name.as_str(), choice.period)
        });
        let target = self.tracking.target.as_ref();
        let highest_deg = self.tracking.highest_deg(self.own_site()).unwrap_or(0.0);
        vec![
            Value::text(file),
            Value::text(name),
            Value::text(period),
            Value::text(target.map_or(0, |target| target.catalog_number)),
            Value::fixed(highest_deg, 1),
        ]
    }

    fn satellite_http(&self) -> Vec<Value> {
        self.memory.http.as_ref().map_or_else(
            || vec![Value::text(""), Value::text(1), Value::flag(false)],
            |source| {
                vec![
                    Value::text(source.url.as_str()),
                    Value::text(source.period_days),
                    Value::flag(source.continue_on_error),
                ]
            },
        )
    }

    fn satellite_ftp(&self) -> Vec<Value> {
        let Some(source) = &self.memory.ftp else {
            let texts = ["", "", "", "21", "", "", "1", "0"];
            return texts.map(Value::text).to_vec();
        };
        let (file, satellite) = source
            .selection
            .as_ref()
            .map_or(("", ""), |chosen| (chosen.file.as_str(), chosen.satellite.as_str()));
        vec![
            Value::text(source.address.as_str()),
            Value::text(source.user.as_str()),
            // A real unit also sends the password in clear text.
            Value::text(source.password.reveal()),
            Value::text(source.port),
            Value::text(file),
            Value::text(satellite),
            Value::text(source.period_days),
            Value::flag(source.continue_on_error),
        ]
    }
}

/// Returns latitude and longitude with their letters.
fn place(latitude_deg: f64, longitude_deg: f64) -> Vec<Value> {
    let text = |angle: f64, plus, minus| {
        let letter = if angle < 0.0 { minus } else { plus };
        Value::Decimal(format!("{:.2}{letter}", angle.abs()))
    };
    vec![text(latitude_deg, 'N', 'S'), text(longitude_deg, 'E', 'W')]
}
