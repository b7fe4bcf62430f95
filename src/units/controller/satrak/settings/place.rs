//! GPS settings: the location that the unit uses (sections 16, 21 and 22).

use jiff::Timestamp;

use super::desired::{Desired, cannot};
use crate::{
    device::settings::{Field, Group, Key, Value, Values, WriteError},
    protocol::satrak::{GpsSettingsChange, Position, Reply, Setting},
};

pub const IS_AUTOMATIC: Key<bool> = Key::flag("is_automatic");
pub const LATITUDE_DEG: Key<f64> = Key::place("latitude_deg", 90.0, ['N', 'S']);
pub const LONGITUDE_DEG: Key<f64> = Key::place("longitude_deg", 180.0, ['E', 'W']);
pub const IS_VALID: Key<bool> = Key::flag("is_valid");
const PLACE: &str = "place";
const TIME: Key<Timestamp> = Key::time("time");
const LOCK_DELAY_S: Key<f64> = Key::decimal("lock_delay_s", f64::MIN, f64::MAX, 0);

pub static GPS: Group =
    Group {
        key: "gps",
        title: "GPS",
        is_service: false,
        fields: &[
            Field::edit(IS_AUTOMATIC, "Position from GPS")
                .moving()
                .description("On: the unit uses its receiver. Off: it uses the location below."),
            Field::edit(LATITUDE_DEG, "Latitude").part_of(PLACE).moving().description(
                "Used while the position does not come from GPS. Sent with two decimals.",
            ),
            Field::edit(LONGITUDE_DEG, "Longitude").part_of(PLACE).moving().description(
                "Used while the position does not come from GPS. Sent with two decimals.",
            ),
        ],
    };

pub static RECEIVER: Group = Group {
    key: "receiver",
    title: "GPS receiver",
    is_service: false,
    fields: &[
        Field::read(IS_VALID, "Fix"),
        Field::read(LATITUDE_DEG, "Latitude"),
        Field::read(LONGITUDE_DEG, "Longitude"),
        Field::read(TIME, "Time"),
        Field::read(LOCK_DELAY_S, "Lock delay").in_unit("s"),
    ],
};

pub(super) fn values(reply: &Reply) -> Option<Values> {
    let Reply::GpsSettings(settings) = reply else { return None };
    let mut values = place(settings.position);
    values.extend([IS_AUTOMATIC.entry(settings.automatic)]);
    Some(values)
}

/// Returns the values of the GPS receiver without [`lock_delay`], which STATUS reports.
pub(super) fn receiver(reply: &Reply) -> Option<Values> {
    let Reply::GpsData(data) = reply else { return None };
    let mut values = place(data.position);
    values.extend([IS_VALID.entry(data.valid)]);
    values.extend(data.time.map(|time| TIME.entry(time)));
    Some(values)
}

/// Returns the entry of the lock delay, seconds. STATUS reports it; `GPS_DATA` does not.
pub(in crate::controller::satrak) fn lock_delay(delay_s: f64) -> (&'static str, Value) {
    LOCK_DELAY_S.entry(delay_s)
}

fn place(position: Option<Position>) -> Values {
    let Some(position) = position else { return Values::new() };
    Values::from([
        LATITUDE_DEG.entry(position.latitude_deg()),
        LONGITUDE_DEG.entry(position.longitude_deg()),
    ])
}

/// Returns the command with all three values: the document does not say whether an automatic unit
/// needs the place.
pub(super) fn write(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    let position = Position::new(desired.get(&LATITUDE_DEG)?, desired.get(&LONGITUDE_DEG)?)
        .map_err(cannot(LATITUDE_DEG.name))?;
    let automatic = desired.is_on(&IS_AUTOMATIC);
    Ok(Setting::GpsSettings(GpsSettingsChange { automatic, position }))
}
