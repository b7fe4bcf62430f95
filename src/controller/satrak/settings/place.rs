//! Where the unit believes to be (sections 16, 21 and 22).

use super::wish::{Wish, cannot};
use crate::{
    device::settings::{Field, Group, Kind, SettleError, Value, Values},
    protocol::satrak::{GpsData, GpsSettings, GpsSettingsChange, Position, Setting},
};

const LATITUDE: Kind = Kind::Place { most: 90.0, letters: ['N', 'S'] };
const LONGITUDE: Kind = Kind::Place { most: 180.0, letters: ['E', 'W'] };

pub(super) static GPS: Group = Group {
    key: "gps",
    title: "GPS",
    is_service: false,
    fields: &[
        Field::edit("is_automatic", "Position from GPS", Kind::Flag)
            .moving()
            .about("On: the unit uses its receiver. Off: it uses the place below."),
        Field::edit("latitude_deg", "Latitude", LATITUDE)
            .moving()
            .about("Used while the position does not come from GPS. Sent with two decimals."),
        Field::edit("longitude_deg", "Longitude", LONGITUDE)
            .moving()
            .about("Used while the position does not come from GPS. Sent with two decimals."),
    ],
};

pub(super) static RECEIVER: Group = Group {
    key: "receiver",
    title: "GPS receiver",
    is_service: false,
    fields: &[
        Field::read("is_valid", "Fix", Kind::Flag),
        Field::read("latitude_deg", "Latitude", LATITUDE),
        Field::read("longitude_deg", "Longitude", LONGITUDE),
        Field::read("time", "Time", Kind::Time),
    ],
};

pub(super) fn values(settings: &GpsSettings) -> Values {
    let mut values = place(settings.position);
    values.insert("is_automatic", Value::Flag(settings.automatic));
    values
}

pub(super) fn receiver(data: &GpsData) -> Values {
    let mut values = place(data.position);
    values.insert("is_valid", Value::Flag(data.valid));
    values.extend(data.time.map(|time| ("time", Value::Time(time))));
    values
}

fn place(position: Option<Position>) -> Values {
    let Some(position) = position else { return Values::new() };
    [
        ("latitude_deg", Value::Decimal(position.latitude_deg())),
        ("longitude_deg", Value::Decimal(position.longitude_deg())),
    ]
    .into()
}

/// All three always go out: whether the place is needed on automatic is not
/// documented.
pub(super) fn write(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    let position = Position::new(wish.decimal("latitude_deg")?, wish.decimal("longitude_deg")?)
        .map_err(cannot("latitude_deg"))?;
    Ok(Setting::GpsSettings(GpsSettingsChange { automatic: wish.flag("is_automatic"), position }))
}
