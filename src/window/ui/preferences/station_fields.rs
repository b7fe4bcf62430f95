//! Fields of the site and of the satellites that the station follows.

use super::{
    connection_fields::not_empty,
    fields::{Description, Placed, placed},
};
use crate::{
    astro::{Air, Refraction, Site},
    device::settings::{Kind, Value},
    station::{Antenna, Favourites, Frequency, Notices, OnClose, Retention, Station, ranges},
};

/// Labels of the place.
pub(in crate::ui) const LATITUDE: &str = "Latitude";
pub(in crate::ui) const LONGITUDE: &str = "Longitude, east";

/// Sections of the fields, each of which is a card.
pub(super) const SITE: &str = "Site";
pub(super) const REFRACTION: &str = "Refraction";
pub(super) const PASSES: &str = "Passes";
pub(super) const CLOSING: &str = "Closing";
pub(super) const RECORD: &str = "Record";
pub(super) const SATELLITES: &str = "Satellites";
pub(super) const FREQUENCIES: &str = "Frequencies";

/// A station without its antennas, with a site that may be invalid.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct Ground {
    name: String,
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
    refraction: Refraction,
    aos_elevation_deg: f64,
    elevation_floor_deg: f64,
    favourites: Favourites,
    frequencies: Vec<Frequency>,
    on_close: Option<OnClose>,
    record: Retention,
    /// Source of the settings that other views edit.
    elsewhere: Box<Station>,
}

impl Ground {
    pub(super) fn of(station: &Station) -> Self {
        let site = station.site;
        Self {
            name: station.name.clone(),
            latitude_deg: rounded(site.latitude().degrees()),
            longitude_deg: rounded(site.longitude().degrees()),
            altitude_m: site.altitude_m(),
            refraction: site.refraction(),
            aos_elevation_deg: station.aos_elevation_deg,
            elevation_floor_deg: station.elevation_floor_deg,
            favourites: station.favourites.clone(),
            frequencies: station.frequencies.clone(),
            on_close: station.on_close,
            record: station.record,
            elsewhere: Box::new(station.clone()),
        }
    }

    pub(super) fn favourites(&self) -> Vec<u32> {
        self.favourites.numbers()
    }

    /// The station with these antennas, without the contents of the other pages.
    pub(in crate::ui) fn with(self, antennas: Vec<Antenna>) -> Option<Station> {
        let place = Site::new(self.latitude_deg, self.longitude_deg, self.altitude_m).ok()?;
        Some(Station {
            site: place.with_refraction(self.refraction).ok()?,
            name: self.name,
            horizon_mask: None,
            aos_elevation_deg: self.aos_elevation_deg,
            elevation_floor_deg: self.elevation_floor_deg,
            favourites: self.favourites,
            frequencies: self.frequencies,
            notices: Notices::default(),
            on_close: self.on_close,
            record: self.record,
            keep_outs: Vec::new(),
            sun_avoidance: None,
            antennas,
            ..*self.elsewhere
        })
    }
}

/// Rounds to a centimetre, without the noise of the conversion.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e7).round() / 1e7
}

type Of = Description<Ground>;

/// All fields of a station besides its antennas.
pub(super) fn all() -> Vec<Placed<Ground>> {
    let mut all = placed(SITE, site());
    all.extend(placed(REFRACTION, refraction()));
    all.extend(placed(PASSES, passes()));
    all.extend(placed(SATELLITES, [satellites()]));
    all.extend(placed(FREQUENCIES, [frequencies()]));
    all.extend(placed(CLOSING, [closing()]));
    all.extend(placed(RECORD, record()));
    all
}

fn site() -> [Of; 4] {
    [
        Of::text("Name", not_empty, |ground| Some(&mut ground.name)),
        Of::number(LATITUDE, -90.0..=90.0, "°", |ground| Some(&mut ground.latitude_deg)),
        Of::number(LONGITUDE, -180.0..=360.0, "°", |ground| Some(&mut ground.longitude_deg)),
        Of::number("Altitude", -1000.0..=10_000.0, "m", |ground| Some(&mut ground.altitude_m)),
    ]
}

fn refraction() -> [Of; 5] {
    const AIR: [Air; 3] = [Air::Standard, Air::Measured, Air::None];
    const IN_PASSES: [bool; 2] = [false, true];
    let is_measured = |ground: &Ground| ground.refraction.air == Air::Measured;
    [
        Of::choice("Air", &[(0, "Standard"), (1, "Measured"), (2, "None")], &AIR, |ground| {
            &mut ground.refraction.air
        })
        .noted(|ground| Some(about_air(ground.refraction.air).to_owned())),
        Of::number("Pressure", Refraction::PRESSURE_HPA, "hPa", |ground| {
            Some(&mut ground.refraction.pressure_hpa)
        })
        .when(is_measured)
        .noted(|_| Some("At the height of the site, not reduced to sea level.".to_owned())),
        Of::number("Temperature", Refraction::TEMPERATURE_C, "°C", |ground| {
            Some(&mut ground.refraction.temperature_c)
        })
        .when(is_measured),
        Of::number("Humidity", Refraction::HUMIDITY_PERCENT, "%", |ground| {
            Some(&mut ground.refraction.humidity_percent)
        })
        .when(is_measured)
        .checked(|ground| {
            let air = ground.refraction.check();
            air.map_err(|_| "with this temperature makes air that does not occur; lower one")
        }),
        Of::choice("AOS and LOS", &[(0, "Geometric"), (1, "Apparent")], &IN_PASSES, |ground| {
            &mut ground.refraction.in_passes
        })
        .noted(|_| {
            let words = "Geometric times are those of other lists. Apparent ones begin some \
                         seconds earlier and end as much later.";
            Some(words.to_owned())
        }),
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

fn passes() -> [Of; 2] {
    [
        Of::number("AOS elevation", ranges::ELEVATION_DEG, "°", |ground| {
            Some(&mut ground.aos_elevation_deg)
        })
        .noted(|_| {
            let words = "A pass begins and ends there. The mask and an antenna's own minimum \
                         elevation shorten it.";
            Some(words.to_owned())
        }),
        Of::number("Elevation floor", ranges::ELEVATION_FLOOR_DEG, "°", |ground| {
            Some(&mut ground.elevation_floor_deg)
        })
        .noted(|_| Some("A pass whose maximum stays below it is not listed.".to_owned())),
    ]
}

fn satellites() -> Of {
    Of::new(
        "Satellites",
        Kind::Text(|_| Ok(())),
        |ground| Some(Value::Text(favourites(ground))),
        put_favourites,
    )
    .wrapped()
    .noted(|_| Some("The favourites, by their catalogue numbers.".to_owned()))
}

fn frequencies() -> Of {
    Of::new(
        "Frequencies",
        Kind::Text(|text| Frequency::read_list(text).map(drop)),
        |ground| Some(Value::Text(Frequency::list_text(&ground.frequencies))),
        |ground, value| {
            if let Value::Text(text) = value {
                ground.frequencies = Frequency::read_list(&text).map_err(|why| why.to_string())?;
            }
            Ok(())
        },
    )
    .of_lines("Number, MHz, name, one per line")
    .noted(|_| Some("For the Doppler shift; a satellite may have several.".to_owned()))
}

fn closing() -> Of {
    Of::choice(
        "When the window closes",
        &[(0, "Ask"), (1, "Stop and hold"), (2, "Park first"), (3, "Let finish")],
        &ON_CLOSE,
        |ground| &mut ground.on_close,
    )
    .noted(|ground| Some(about_closing(ground.on_close).to_owned()))
}

fn record() -> [Of; 2] {
    [
        Of::number("Keep positions and traffic", ranges::RAW_DAYS, "days", |ground| {
            Some(&mut ground.record.raw_days)
        })
        .noted(|_| Some("What was measured, and what went over the links.".to_owned())),
        Of::number("Keep the rest", ranges::RECORD_YEARS, "years", |ground| {
            Some(&mut ground.record.years)
        })
        .noted(|_| {
            let words = "Reports and tracks of passes, commands, events, alarms, changes.";
            Some(words.to_owned())
        }),
    ]
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

/// Catalog numbers, separated by commas.
fn favourites(ground: &Ground) -> String {
    let numbers: Vec<String> = ground.favourites.numbers().iter().map(u32::to_string).collect();
    numbers.join(", ")
}

fn put_favourites(ground: &mut Ground, value: Value) -> Result<(), String> {
    let Value::Text(text) = value else { return Ok(()) };
    let parts = text.split(',').map(str::trim).filter(|part| !part.is_empty());
    let numbers: Option<Vec<u32>> =
        parts.map(|part| part.parse().ok().filter(|number| *number <= 999_999_999)).collect();
    let numbers =
        numbers.ok_or("must be catalogue numbers separated by commas, such as 43013, 25544")?;
    ground.favourites = ground.favourites.with_numbers(&numbers);
    Ok(())
}
