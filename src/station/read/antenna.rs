//! Reads one antenna.

use std::ops::RangeInclusive;

use serde::de::DeserializeOwned;
use toml::Value;

use super::Fields;
use crate::station::{
    AfterPass, Antenna, Calibration, Connection, CountPoint, Direction, Following, MotionLimits,
    Mount, PollRates, Rotators, check_address, check_line, ranges,
};

impl Fields<'_> {
    /// An antenna needs a controller and an address: nothing stands in for them.
    pub(super) fn antenna(&mut self) -> Option<Antenna> {
        let default = self.inner("connection", connection)?;
        let name = self.text("name", &default.name);
        Some(Antenna {
            name,
            mount: self.inner("mount", |mount| mount.mount(default.mount)),
            beam_width_deg: self.number(
                "beam_width_deg",
                &ranges::BEAM_WIDTH_DEG,
                default.beam_width_deg,
            ),
            park: self.inner("park", |park| park.direction(default.park)),
            limits: self.inner("limits", |limits| limits.limits(default.limits)),
            poll: self.inner("poll", |poll| poll.poll(default.poll)),
            follow: self.inner("follow", |follow| follow.following(default.follow)),
            connection: default.connection,
        })
    }

    fn direction(&mut self, default: Direction) -> Direction {
        let Direction { azimuth_deg, elevation_deg } = default;
        Direction {
            azimuth_deg: self.number("azimuth_deg", &ranges::AZIMUTH_DEG, azimuth_deg),
            elevation_deg: self.number("elevation_deg", &ranges::ELEVATION_DEG, elevation_deg),
        }
    }

    fn limits(&mut self, default: MotionLimits) -> MotionLimits {
        let MotionLimits { minimum_elevation_deg, maximum_rate_deg_s, maximum_step_deg } = default;
        MotionLimits {
            minimum_elevation_deg: self.number(
                "minimum_elevation_deg",
                &ranges::ELEVATION_DEG,
                minimum_elevation_deg,
            ),
            maximum_rate_deg_s: self.number(
                "maximum_rate_deg_s",
                &ranges::MAXIMUM_RATE_DEG_S,
                maximum_rate_deg_s,
            ),
            maximum_step_deg: self.number(
                "maximum_step_deg",
                &ranges::MAXIMUM_STEP_DEG,
                maximum_step_deg,
            ),
        }
    }

    fn poll(&mut self, default: PollRates) -> PollRates {
        PollRates {
            idle_hz: self.number("idle_hz", &ranges::POLL_HZ, default.idle_hz),
            moving_hz: self.number("moving_hz", &ranges::POLL_HZ, default.moving_hz),
        }
    }

    fn following(&mut self, default: Following) -> Following {
        let after =
            [("hold", AfterPass::Hold), ("park", AfterPass::Park), ("next", AfterPass::Next)];
        let Following { period_s, dead_band_deg, latency_s, .. } = default;
        Following {
            period_s: self.number("period_s", &ranges::FOLLOW_PERIOD_S, period_s),
            dead_band_deg: self.number("dead_band_deg", &ranges::DEAD_BAND_DEG, dead_band_deg),
            latency_s: self.number("latency_s", &ranges::LATENCY_S, latency_s),
            after: self.one_of("after", &after, default.after),
        }
    }

    fn baud(&mut self, default: u32) -> u32 {
        let Some(value) = self.table.remove("baud") else { return default };
        let read = value.as_integer().and_then(|baud| u32::try_from(baud).ok());
        read.filter(|baud| ranges::BAUDS.contains(baud)).unwrap_or_else(|| {
            let known = ranges::BAUDS.map(|baud| baud.to_string()).join(", ");
            self.invalid("baud", format!("must be one of {known}"));
            default
        })
    }

    fn bus_address(&mut self, default: u8) -> u8 {
        let Some(value) = self.table.remove("bus_address") else { return default };
        let read = value.as_integer().and_then(|number| u8::try_from(number).ok());
        read.filter(|number| ranges::BUS_ADDRESS.contains(number)).unwrap_or_else(|| {
            let (low, high) = ranges::BUS_ADDRESS.into_inner();
            self.invalid("bus_address", format!("must be a whole number from {low} to {high}"));
            default
        })
    }

    fn points(&mut self, key: &str) -> Vec<CountPoint> {
        #[derive(serde::Deserialize)]
        struct Point {
            counts: u16,
            degrees: f64,
        }
        let points: Vec<Point> = self.list(key);
        let points: Vec<CountPoint> = points
            .into_iter()
            .map(|Point { counts, degrees }| CountPoint { counts, degrees })
            .collect();
        if let Err(why) = CountPoint::check(&points) {
            self.invalid(key, why);
            return Vec::new();
        }
        points
    }

    fn list<T: DeserializeOwned>(&mut self, key: &str) -> Vec<T> {
        let Some(value) = self.table.remove(key) else { return Vec::new() };
        value.try_into().unwrap_or_else(|error: toml::de::Error| {
            self.invalid(key, error.message());
            Vec::new()
        })
    }

    fn one_of<T: Copy>(&mut self, key: &str, known: &[(&str, T)], default: T) -> T {
        let Some(value) = self.table.remove(key) else { return default };
        let found = known.iter().find(|(name, _)| value.as_str() == Some(name));
        found.map_or_else(
            || {
                let names: Vec<String> =
                    known.iter().map(|(name, _)| format!("{name:?}")).collect();
                self.invalid(key, format!("must be one of {}", names.join(", ")));
                default
            },
            |(_, value)| *value,
        )
    }

    fn mount(&mut self, default: Mount) -> Mount {
        match default {
            Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, travel_to_deg } => {
                self.mount_type("xy");
                Mount::Xy {
                    lower_axis_azimuth_deg: self.number(
                        "lower_axis_azimuth_deg",
                        &ranges::LOWER_AXIS_AZIMUTH_DEG,
                        lower_axis_azimuth_deg,
                    ),
                    travel_from_deg: self.number(
                        "travel_from_deg",
                        &ranges::TRAVEL_FROM_DEG,
                        travel_from_deg,
                    ),
                    travel_to_deg: self.number(
                        "travel_to_deg",
                        &ranges::TRAVEL_TO_DEG,
                        travel_to_deg,
                    ),
                }
            }
            Mount::AzEl {
                azimuth_from_deg: from,
                azimuth_to_deg: to,
                elevation_from_deg: low,
                elevation_to_deg: high,
            } => {
                self.mount_type("azel");
                let from = self.number("azimuth_from_deg", &ranges::AZIMUTH_FROM_DEG, from);
                let low = self.number("elevation_from_deg", &ranges::ELEVATION_FROM_DEG, low);
                Mount::AzEl {
                    azimuth_from_deg: from,
                    azimuth_to_deg: self.number(
                        "azimuth_to_deg",
                        &above(from, &ranges::AZIMUTH_SPAN_DEG, &ranges::AZIMUTH_TO_DEG),
                        to.max(from + ranges::AZIMUTH_SPAN_DEG.start()),
                    ),
                    elevation_from_deg: low,
                    elevation_to_deg: self.number(
                        "elevation_to_deg",
                        &above(low, &ranges::ELEVATION_SPAN_DEG, &ranges::ELEVATION_TO_DEG),
                        high.max(low + ranges::ELEVATION_SPAN_DEG.start()),
                    ),
                }
            }
        }
    }

    /// The arrangement follows from the controller; another in the file is told.
    fn mount_type(&mut self, kind: &str) {
        match self.table.remove("type") {
            None => {}
            Some(Value::String(text)) if text == kind => {}
            Some(_) => self.invalid("type", format!("must be {kind:?}")),
        }
    }
}

/// An antenna with this connection and the usual figures of its controller.
fn connection(fields: &mut Fields<'_>) -> Option<Antenna> {
    let controller = fields.text("controller", "");
    let address = fields.text("address", "");
    let Some(mut antenna) = Antenna::of_controller(&controller, &address) else {
        fields.invalid("controller", "must be \"satrak\", \"genius\" or \"rc2000c\"");
        return None;
    };
    let mut check: fn(&str) -> Result<(), &'static str> = check_address;
    match &mut antenna.connection {
        Connection::Satrak { element_file, .. } => *element_file = fields.text("element_file", ""),
        Connection::Genius { rotators, .. } => {
            let known = [
                ("pair", Rotators::Pair),
                ("first", Rotators::First),
                ("second", Rotators::Second),
            ];
            *rotators = fields.one_of("rotators", &known, *rotators);
        }
        Connection::Rc2000c { baud, bus_address, calibration, .. } => {
            check = check_line;
            *baud = fields.baud(*baud);
            *bus_address = fields.bus_address(*bus_address);
            *calibration = fields.inner("calibration", |inner| Calibration {
                azimuth: inner.points("azimuth"),
                elevation: inner.points("elevation"),
            });
        }
    }
    match check(&address) {
        Ok(()) => Some(antenna),
        Err(why) => {
            fields.invalid("address", why);
            None
        }
    }
}

/// What the upper end of an axis may be whose lower end is `from`.
fn above(
    from: f64,
    span: &RangeInclusive<f64>,
    range: &RangeInclusive<f64>,
) -> RangeInclusive<f64> {
    (from + span.start()).max(*range.start())..=(from + span.end()).min(*range.end())
}
