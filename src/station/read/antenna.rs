//! Reads one antenna.

use serde::de::DeserializeOwned;
use toml::Value;

use super::{Fields, check_address};
use crate::station::{
    AfterPass, Antenna, Calibration, Connection, CountPoint, Direction, Mount, Rotators,
};

/// Speeds of a serial line that a controller knows, bits a second.
const BAUDS: [u32; 6] = [300, 600, 1200, 2400, 4800, 9600];

impl Fields<'_> {
    /// An antenna needs a controller and an address: nothing stands in for them.
    pub(super) fn antenna(&mut self) -> Option<Antenna> {
        let default = self.inner("connection", connection)?;
        let name = self.text("name", &default.name);
        let limit = default.limits;
        let follow = default.follow;
        Some(Antenna {
            name,
            mount: self.inner("mount", |mount| mount.mount(default.mount)),
            beam_width_deg: self.number("beam_width_deg", 0.01, 180.0, default.beam_width_deg),
            park: self.inner("park", |park| Direction {
                azimuth_deg: park.number("azimuth_deg", 0.0, 360.0, default.park.azimuth_deg),
                elevation_deg: park.number("elevation_deg", 0.0, 90.0, default.park.elevation_deg),
            }),
            limits: self.inner("limits", |limits| {
                let mut read = limit;
                read.minimum_elevation_deg =
                    limits.number("minimum_elevation_deg", 0.0, 90.0, read.minimum_elevation_deg);
                read.maximum_rate_deg_s =
                    limits.number("maximum_rate_deg_s", 0.01, 30.0, read.maximum_rate_deg_s);
                read.maximum_step_deg =
                    limits.number("maximum_step_deg", 0.01, 90.0, read.maximum_step_deg);
                read
            }),
            poll: self.inner("poll", |poll| {
                let mut read = default.poll;
                read.idle_hz = poll.number("idle_hz", 2.0, 10.0, read.idle_hz);
                read.moving_hz = poll.number("moving_hz", 2.0, 10.0, read.moving_hz);
                read
            }),
            follow: self.inner("follow", |fields| {
                let mut read = follow;
                read.period_s = fields.number("period_s", 0.05, 600.0, read.period_s);
                read.dead_band_deg = fields.number("dead_band_deg", 0.0, 90.0, read.dead_band_deg);
                read.latency_s = fields.number("latency_s", 0.0, 60.0, read.latency_s);
                let after = [
                    ("hold", AfterPass::Hold),
                    ("park", AfterPass::Park),
                    ("next", AfterPass::Next),
                ];
                read.after = fields.one_of("after", &after, read.after);
                read
            }),
            connection: default.connection,
        })
    }

    fn baud(&mut self, default: u32) -> u32 {
        let read = self.number("baud", 300.0, 9600.0, default.into()) as u32;
        if BAUDS.contains(&read) {
            return read;
        }
        self.invalid("baud", "must be 300, 600, 1200, 2400, 4800 or 9600");
        default
    }

    fn points(&mut self, key: &str) -> Vec<CountPoint> {
        #[derive(serde::Deserialize)]
        struct Point {
            counts: u16,
            degrees: f64,
        }
        let points: Vec<Point> = self.list(key);
        points.into_iter().map(|Point { counts, degrees }| CountPoint { counts, degrees }).collect()
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
                        0.0,
                        180.0,
                        lower_axis_azimuth_deg,
                    ),
                    travel_from_deg: self.number("travel_from_deg", -180.0, 90.0, travel_from_deg),
                    travel_to_deg: self.number("travel_to_deg", 90.0, 360.0, travel_to_deg),
                }
            }
            Mount::AzEl {
                azimuth_from_deg,
                azimuth_to_deg,
                elevation_from_deg,
                elevation_to_deg,
            } => {
                self.mount_type("azel");
                let from = self.number("azimuth_from_deg", -360.0, 360.0, azimuth_from_deg);
                Mount::AzEl {
                    azimuth_from_deg: from,
                    azimuth_to_deg: self.number(
                        "azimuth_to_deg",
                        from + 1.0,
                        from + 1080.0,
                        azimuth_to_deg.max(from + 1.0),
                    ),
                    elevation_from_deg: self.number(
                        "elevation_from_deg",
                        -90.0,
                        89.0,
                        elevation_from_deg,
                    ),
                    elevation_to_deg: self.number("elevation_to_deg", 0.0, 180.0, elevation_to_deg),
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
    let element_file = fields.text("element_file", "");
    let mut antenna = match &*controller {
        "satrak" => Antenna::satrak("Satrak", &address),
        "genius" => Antenna::genius("Genius", &address),
        "rc2000c" => Antenna::rc2000c("RC2000C", &address),
        _ => {
            fields.invalid("controller", "must be \"satrak\", \"genius\" or \"rc2000c\"");
            return None;
        }
    };
    let mut is_serial = false;
    match &mut antenna.connection {
        Connection::Satrak { element_file: file, .. } => *file = element_file,
        Connection::Genius { rotators, .. } => {
            let known = [
                ("pair", Rotators::Pair),
                ("first", Rotators::First),
                ("second", Rotators::Second),
            ];
            *rotators = fields.one_of("rotators", &known, *rotators);
        }
        Connection::Rc2000c { baud, bus_address, calibration, .. } => {
            is_serial = !address.trim().is_empty() && check_address(&address).is_err();
            *baud = fields.baud(*baud);
            *bus_address = fields.number("bus_address", 49.0, 111.0, (*bus_address).into()) as u8;
            *calibration = fields.inner("calibration", |inner| Calibration {
                azimuth: inner.points("azimuth"),
                elevation: inner.points("elevation"),
            });
        }
    }
    match check_address(&address) {
        Err(why) if !is_serial => {
            fields.invalid("address", why);
            None
        }
        _ => Some(antenna),
    }
}
