//! Fields of the site.

use std::{
    borrow::Cow,
    net::{AddrParseError, SocketAddr},
};

use super::{
    connection_fields::not_empty,
    draft::Draft,
    fields::{Description, Placed, Typed, placed},
    search::Spot,
    section::{DraftSection, Finding},
};
use crate::{
    astro::{Air, Refraction, Site},
    device::settings::{Kind, Unfit, Value},
    station::{MetricsPort, OnClose, Station, ranges},
};

/// Labels of the location fields.
pub(in crate::ui) const LATITUDE: &str = "Latitude";
pub(in crate::ui) const LONGITUDE: &str = "Longitude, east";

/// Titles of the cards of the page.
const SITE: &str = "Site";
const REFRACTION: &str = "Refraction";
const PASSES: &str = "Passes";
const CLOSING: &str = "Closing";
pub(super) const RECORD: &str = "Record";
pub(super) const MONITORING: &str = "Monitoring";

/// A station with a site that may be invalid.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct Ground {
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
    refraction: Refraction,
    metrics: EnteredPort,
    /// The station, including the settings that no page edits.
    station: Station,
}

impl Ground {
    pub(super) fn new(station: &Station) -> Self {
        let site = station.site;
        Self {
            latitude_deg: rounded(site.latitude().degrees()),
            longitude_deg: rounded(site.longitude().degrees()),
            altitude_m: site.altitude_m(),
            refraction: site.refraction(),
            metrics: EnteredPort::new(station.metrics),
            station: station.clone(),
        }
    }

    pub(super) fn site(&self) -> Option<Site> {
        let place = Site::new(self.latitude_deg, self.longitude_deg, self.altitude_m).ok()?;
        place.with_refraction(self.refraction).ok()
    }

    /// Returns the station, with the saved contents of the other pages and without antennas.
    pub(in crate::ui) fn station(self) -> Option<Station> {
        let (site, metrics) = (self.site()?, self.metrics.port().ok()?);
        Some(Station { site, metrics, antennas: Vec::new(), ..self.station })
    }
}

/// The port for metrics, with an address that may be invalid. It keeps its address while the
/// operator has switched the port off.
#[derive(Debug, Clone, PartialEq)]
struct EnteredPort {
    is_on: bool,
    listen: String,
    open_to_network: bool,
}

impl EnteredPort {
    fn new(port: Option<MetricsPort>) -> Self {
        let MetricsPort { listen, open_to_network } = port.unwrap_or_default();
        Self { is_on: port.is_some(), listen: listen.to_string(), open_to_network }
    }

    /// Returns the port, `None` if it is off.
    fn port(&self) -> Result<Option<MetricsPort>, AddrParseError> {
        if !self.is_on {
            return Ok(None);
        }
        let listen = self.listen.parse()?;
        Ok(Some(MetricsPort { listen, open_to_network: self.open_to_network }))
    }
}

impl DraftSection for Typed<Ground> {
    fn edits(&self, _: &Draft) -> usize {
        self.edited()
    }

    fn findings(&self, _: &Draft) -> Vec<Finding> {
        self.findings_in(&self.read().1)
    }

    /// Returns the labels of all fields, including those that only another choice uses.
    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)> {
        self.fields.iter().map(|field| (field.description.label.clone(), Spot::Field)).collect()
    }

    fn write(&mut self, label: &str, text: String) {
        self.type_in(label, text);
    }

    fn put_into(&self, _: &Draft, station: &mut Station) -> Option<()> {
        *station = self.valid()?.station()?;
        Some(())
    }
}

/// Rounds to a centimetre to remove conversion noise.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e7).round() / 1e7
}

type GroundDescription = Description<Ground>;

/// Returns all fields of a station except its antennas.
pub(super) fn all() -> Vec<Placed<Ground>> {
    let mut all = placed(SITE, site());
    all.extend(placed(REFRACTION, refraction()));
    all.extend(placed(PASSES, passes()));
    all.extend(placed(CLOSING, [closing()]));
    all.extend(placed(MONITORING, monitoring()));
    // The last card, because its length differs in the demonstration.
    all.extend(placed(RECORD, record()));
    all
}

fn site() -> [GroundDescription; 4] {
    [
        GroundDescription::text("Name", not_empty, |ground| Some(&mut ground.station.name)),
        GroundDescription::number(LATITUDE, -90.0..=90.0, "°", |ground| {
            Some(&mut ground.latitude_deg)
        }),
        GroundDescription::number(LONGITUDE, -180.0..=360.0, "°", |ground| {
            Some(&mut ground.longitude_deg)
        }),
        GroundDescription::number("Altitude", -1000.0..=10_000.0, "m", |ground| {
            Some(&mut ground.altitude_m)
        }),
    ]
}

fn refraction() -> [GroundDescription; 5] {
    const AIR: [Air; 3] = [Air::Standard, Air::Measured, Air::None];
    const IN_PASSES: [bool; 2] = [false, true];
    let is_measured = |ground: &Ground| ground.refraction.air == Air::Measured;
    [
        GroundDescription::choice(
            "Air",
            &[(0, "Standard"), (1, "Measured"), (2, "None")],
            &AIR,
            |ground| &mut ground.refraction.air,
        )
        .noted(|ground| Some(about_air(ground.refraction.air).to_owned())),
        GroundDescription::number("Pressure", Refraction::PRESSURE_HPA, "hPa", |ground| {
            Some(&mut ground.refraction.pressure_hpa)
        })
        .when(is_measured)
        .described("At the height of the site, not reduced to sea level."),
        GroundDescription::number("Temperature", Refraction::TEMPERATURE_C, "°C", |ground| {
            Some(&mut ground.refraction.temperature_c)
        })
        .when(is_measured),
        GroundDescription::number("Humidity", Refraction::HUMIDITY_PERCENT, "%", |ground| {
            Some(&mut ground.refraction.humidity_percent)
        })
        .when(is_measured)
        .checked(|ground| {
            let air = ground.refraction.check();
            air.map_err(|_| "with this temperature makes air that does not occur; lower one")
        }),
        GroundDescription::choice(
            "AOS and LOS",
            &[(0, "Geometric"), (1, "Apparent")],
            &IN_PASSES,
            |ground| &mut ground.refraction.in_passes,
        )
        .described(
            "Geometric times are those of other lists. Apparent ones begin some \
                         seconds earlier and end as much later.",
        ),
    ]
}

fn about_air(air: Air) -> &'static str {
    match air {
        Air::Standard => {
            "Antennas point where satellites, the Sun and the Moon appear, by the mean air at this \
             altitude: 0.6° higher at the horizon, 0.15° at 5°."
        }
        Air::Measured => "Antennas point where satellites appear through the air entered below.",
        Air::None => "Antennas point at geometric directions, below where satellites appear.",
    }
}

fn passes() -> [GroundDescription; 2] {
    [
        GroundDescription::number("AOS elevation", ranges::ELEVATION_DEG, "°", |ground| {
            Some(&mut ground.station.aos_elevation_deg)
        })
        .described(
            "A pass begins and ends there. The mask and an antenna's own minimum \
                         elevation shorten it.",
        ),
        GroundDescription::number("Elevation floor", ranges::ELEVATION_FLOOR_DEG, "°", |ground| {
            Some(&mut ground.station.elevation_floor_deg)
        })
        .described("A pass whose maximum stays below it is not listed."),
    ]
}

fn closing() -> GroundDescription {
    GroundDescription::choice(
        "When the window closes",
        &[(0, "Ask"), (1, "Stop and hold"), (2, "Park first"), (3, "Let finish")],
        &ON_CLOSE,
        |ground| &mut ground.station.on_close,
    )
    .noted(|ground| Some(about_closing(ground.station.on_close).to_owned()))
}

fn record() -> [GroundDescription; 2] {
    [
        GroundDescription::number(
            "Keep positions and traffic",
            ranges::RAW_DAYS,
            "days",
            |ground| Some(&mut ground.station.record.raw_days),
        )
        .described("What was measured, and what went over the links."),
        GroundDescription::number("Keep the rest", ranges::RECORD_YEARS, "years", |ground| {
            Some(&mut ground.station.record.years)
        })
        .described("Reports and tracks of passes, commands, events, alarms, changes."),
    ]
}

fn monitoring() -> [GroundDescription; 3] {
    let is_on = |ground: &Ground| ground.metrics.is_on;
    [
        flag("Metrics for Prometheus", |ground| &mut ground.metrics.is_on)
            .described("Other programs can read the state of the station, and change nothing."),
        GroundDescription::text("Listen on", socket_address, |ground| {
            Some(&mut ground.metrics.listen)
        })
        .when(is_on),
        flag("Open to the network", |ground| &mut ground.metrics.open_to_network)
            .when(is_on)
            .checked(|ground| match ground.metrics.port() {
                Ok(Some(port)) if port.lacks_permission() => {
                    Err("must be on for this address; or listen on 127.0.0.1")
                }
                Ok(_) | Err(_) => Ok(()),
            })
            .described("Every computer of the network can then read them without a password."),
    ]
}

fn flag(label: &'static str, place: fn(&mut Ground) -> &mut bool) -> GroundDescription {
    GroundDescription::new(
        label,
        Kind::Flag,
        move |ground| Some(Value::Flag(*place(ground))),
        move |ground, value| {
            if let Value::Flag(is_on) = value {
                *place(ground) = is_on;
            }
            Ok(())
        },
    )
}

/// Checks the address and port of a server.
fn socket_address(text: &str) -> Result<(), Unfit> {
    let address = text.parse::<SocketAddr>();
    address.map(drop).map_err(|_| {
        Unfit::Text("must be an address and a port, such as 127.0.0.1:9464".to_owned())
    })
}

const ON_CLOSE: [Option<OnClose>; 4] =
    [None, Some(OnClose::Hold), Some(OnClose::Park), Some(OnClose::Leave)];

fn about_closing(on_close: Option<OnClose>) -> &'static str {
    match on_close {
        None => {
            "Asks while an antenna moves or tracks. If the system ends Azel, moving antennas \
                 are stopped."
        }
        Some(OnClose::Hold) => {
            "Antennas that move or track are stopped; the window waits for that."
        }
        Some(OnClose::Park) => {
            "Antennas that move or track are parked first, or stopped if they cannot be parked. If \
             the system ends Azel, they are stopped."
        }
        Some(OnClose::Leave) => {
            "A unit that tracks by itself goes on, with nobody watching here. Any other antenna \
             that moves is stopped."
        }
    }
}
