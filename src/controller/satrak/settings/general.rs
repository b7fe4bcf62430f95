//! General settings (sections 12 and 13). No ranges are documented: these are
//! what makes sense.

use super::wish::{Wish, cannot};
use crate::{
    device::settings::{Field, Group, Guard, Kind, SettleError, Value, Values},
    protocol::satrak::{
        PositionBase, Setting, Settings, SettingsChange, SettingsRequest, SspaAutoRule, SspaMode,
    },
};

const OFFSET: Kind = Kind::Decimal { least: -10.0, most: 10.0, places: 2 };
const ELEVATION: Kind = Kind::Decimal { least: 0.0, most: 90.0, places: 1 };

pub(super) static GENERAL: Group = Group {
    key: "general",
    title: "General",
    is_service: false,
    fields: &[
        Field::edit("clock_from_gps", "Clock from GPS", Kind::Flag)
            .moving()
            .about("The unit sets its clock from GPS by itself."),
        Field::edit(
            "time_offset_ms",
            "Tracking time offset",
            Kind::Integer { least: -3_600_000, most: 3_600_000 },
        )
        .in_unit("ms")
        .moving()
        .about("Shifts the track in time. Whether more is ahead or behind is not documented."),
        Field::edit("azimuth_offset_deg", "Azimuth offset", OFFSET)
            .in_unit("°")
            .moving()
            .about("Added to the azimuth while the unit tracks."),
        Field::edit("elevation_offset_deg", "Elevation offset", OFFSET)
            .in_unit("°")
            .moving()
            .about("Added to the elevation while the unit tracks."),
        Field::edit("lead_ms", "Go to start before", Kind::Integer { least: 0, most: 3_600_000 })
            .in_unit("ms")
            .moving()
            .about("So long before the window begins the unit goes to the start of the track."),
        Field::edit(
            "position_base",
            "Position base",
            Kind::Choice(&[(0, "Resolver+enc."), (1, "Resolver")]),
        )
        .moving()
        .about("The sensors from which the unit takes its position."),
        Field::edit("minimum_elevation_deg", "Minimum elevation", ELEVATION)
            .in_unit("°")
            .moving()
            .about("The unit does not point lower."),
        Field::edit(
            "north_offset_deg",
            "North offset",
            Kind::Decimal { least: -360.0, most: 360.0, places: 1 },
        )
        .in_unit("°")
        .moving()
        .about("Between the mount's zero and north."),
        Field::edit(
            "sspa",
            "Transmitter (SSPA)",
            Kind::Choice(&[(0, "Off"), (1, "On"), (2, "Auto")]),
        )
        .guarded(sspa_guard)
        .about("Power amplifier of the transmitter. On radiates at once."),
        Field::edit(
            "sspa_rule",
            "SSPA auto rule",
            Kind::Choice(&[(0, "Tracking"), (1, "Carrier lock"), (2, "Both"), (3, "Either")]),
        )
        .about("What switches the amplifier on when it is on Auto."),
        Field::read(
            "tle_source",
            "TLE source in use",
            Kind::Choice(&[(0, "File"), (1, "Web"), (2, "FTP")]),
        )
        .about("No command sets it: presumably the last of file, web and FTP that was set."),
        Field::edit("elevation_threshold_deg", "Elevation threshold", ELEVATION)
            .in_unit("°")
            .moving()
            .about("What the unit does with it is not documented."),
    ],
};

fn sspa_guard(value: &Value) -> Guard {
    match value {
        Value::Choice(0) => Guard::Free,
        Value::Choice(2) => Guard::Confirm,
        _ => Guard::Service,
    }
}

pub(super) fn values(settings: &Settings) -> Values {
    [
        ("clock_from_gps", Value::Flag(settings.rtc_from_gps)),
        ("time_offset_ms", Value::Integer(settings.time_offset_ms)),
        ("azimuth_offset_deg", Value::Decimal(settings.az_offset_deg)),
        ("elevation_offset_deg", Value::Decimal(settings.el_offset_deg)),
        ("lead_ms", Value::Integer(settings.lead_ms)),
        ("position_base", Value::Choice(settings.position_base.code())),
        ("minimum_elevation_deg", Value::Decimal(settings.minimum_elevation_deg)),
        ("north_offset_deg", Value::Decimal(settings.north_offset_deg)),
        ("sspa", Value::Choice(settings.sspa.code())),
        ("sspa_rule", Value::Choice(settings.sspa_auto.code())),
        ("tle_source", Value::Choice(settings.tle_mode.code())),
        ("elevation_threshold_deg", Value::Decimal(settings.elevation_threshold_deg)),
    ]
    .into()
}

/// Only what changes is sent; for the rest stands the sign that keeps it.
pub(super) fn write(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    let new = wish.new;
    let integer = |key| match new.get(key) {
        Some(Value::Integer(number)) => Some(*number),
        _ => None,
    };
    let decimal = |key| match new.get(key) {
        Some(Value::Decimal(number)) => Some(*number),
        _ => None,
    };
    let code = |key| match new.get(key) {
        Some(Value::Choice(code)) => Some(*code),
        _ => None,
    };
    let change = SettingsChange {
        rtc_from_gps: new.contains_key("clock_from_gps").then(|| wish.flag("clock_from_gps")),
        time_offset_ms: integer("time_offset_ms"),
        az_offset_deg: decimal("azimuth_offset_deg"),
        el_offset_deg: decimal("elevation_offset_deg"),
        lead_ms: integer("lead_ms"),
        position_base: code("position_base").map(PositionBase::from_code),
        minimum_elevation_deg: decimal("minimum_elevation_deg"),
        north_offset_deg: decimal("north_offset_deg"),
        sspa: code("sspa").map(SspaMode::from_code),
        sspa_auto: code("sspa_rule").map(SspaAutoRule::from_code),
        elevation_threshold_deg: decimal("elevation_threshold_deg"),
    };
    let first = new.keys().next().copied().unwrap_or("general");
    SettingsRequest::new(&change).map(Setting::Settings).map_err(cannot(first))
}
