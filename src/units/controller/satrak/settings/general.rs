//! General settings (sections 12 and 13). The document gives no ranges; Azel uses plausible ones.

use super::desired::{Desired, cannot};
use crate::{
    device::{
        TrackOffsetFields,
        settings::{Field, Group, Guard, Key, Value, Values, WriteError},
    },
    protocol::satrak::{
        PositionBase, Reply, Setting, SettingsChange, SettingsRequest, SspaAutoRule, SspaMode,
    },
};

const CLOCK_FROM_GPS: Key<bool> = Key::flag("clock_from_gps");
const TIME_OFFSET_MS: Key<i64> = Key::integer("time_offset_ms", -3_600_000, 3_600_000);
const AZIMUTH_OFFSET_DEG: Key<f64> = Key::decimal("azimuth_offset_deg", -10.0, 10.0, 2);
const ELEVATION_OFFSET_DEG: Key<f64> = Key::decimal("elevation_offset_deg", -10.0, 10.0, 2);
const LEAD_MS: Key<i64> = Key::integer("lead_ms", 0, 3_600_000);
const POSITION_BASE: Key<i64> =
    Key::choice("position_base", &[(0, "Resolver+enc."), (1, "Resolver")]);
pub const MINIMUM_ELEVATION_DEG: Key<f64> = Key::decimal("minimum_elevation_deg", 0.0, 90.0, 1);
const NORTH_OFFSET_DEG: Key<f64> = Key::decimal("north_offset_deg", -360.0, 360.0, 1);
const SSPA: Key<i64> = Key::choice("sspa", &[(0, "Off"), (1, "On"), (2, "Auto")]);
const SSPA_RULE: Key<i64> =
    Key::choice("sspa_rule", &[(0, "Tracking"), (1, "Carrier lock"), (2, "Both"), (3, "Either")]);
pub const TLE_FROM_FILE: i64 = 0;
pub const TLE_SOURCE: Key<i64> =
    Key::choice("tle_source", &[(TLE_FROM_FILE, "File"), (1, "Web"), (2, "FTP")]);
const ELEVATION_THRESHOLD_DEG: Key<f64> = Key::decimal("elevation_threshold_deg", 0.0, 90.0, 1);

pub static TRACK_OFFSETS: TrackOffsetFields = TrackOffsetFields {
    group: GENERAL.key,
    time_ms: TIME_OFFSET_MS.name,
    azimuth_deg: AZIMUTH_OFFSET_DEG.name,
    elevation_deg: ELEVATION_OFFSET_DEG.name,
};

pub static GENERAL: Group = Group {
    key: "general",
    title: "General",
    is_service: false,
    fields: &[
        Field::edit(CLOCK_FROM_GPS, "Clock from GPS")
            .moving()
            .description("The unit sets its clock from GPS by itself."),
        Field::edit(TIME_OFFSET_MS, "Tracking time offset").in_unit("ms").moving().description(
            "Shifts the track in time. Whether a larger value is ahead or behind is not \
                    documented.",
        ),
        Field::edit(AZIMUTH_OFFSET_DEG, "Azimuth offset")
            .in_unit("°")
            .moving()
            .description("Added to the azimuth while the unit tracks."),
        Field::edit(ELEVATION_OFFSET_DEG, "Elevation offset")
            .in_unit("°")
            .moving()
            .description("Added to the elevation while the unit tracks."),
        Field::edit(LEAD_MS, "Lead time").in_unit("ms").moving().description(
            "How long before the window begins the unit goes to the start of the track.",
        ),
        Field::edit(POSITION_BASE, "Position base")
            .moving()
            .description("The sensors from which the unit takes its position."),
        Field::edit(MINIMUM_ELEVATION_DEG, "Minimum elevation")
            .in_unit("°")
            .moving()
            .description("The unit does not point lower than this."),
        Field::edit(NORTH_OFFSET_DEG, "North offset")
            .in_unit("°")
            .moving()
            .description("Between the mount's zero and north."),
        Field::edit(SSPA, "Transmitter (SSPA)")
            .guarded(sspa_guard)
            .description("Power amplifier of the transmitter. On radiates at once."),
        Field::edit(SSPA_RULE, "SSPA auto rule")
            .description("What switches the amplifier on when it is on Auto."),
        Field::read(TLE_SOURCE, "TLE source in use").description(
            "No command sets it: presumably the last of file, web and FTP that was set.",
        ),
        Field::edit(ELEVATION_THRESHOLD_DEG, "Elevation threshold")
            .in_unit("°")
            .moving()
            .description("What the unit does with it is not documented."),
    ],
};

fn sspa_guard(value: &Value) -> Guard {
    match value {
        Value::Choice(0) => Guard::Free,
        Value::Choice(2) => Guard::Confirm,
        _ => Guard::Service,
    }
}

pub(super) fn values(reply: &Reply) -> Option<Values> {
    let Reply::Settings(settings) = reply else { return None };
    Some(Values::from([
        CLOCK_FROM_GPS.entry(settings.rtc_from_gps),
        TIME_OFFSET_MS.entry(settings.time_offset_ms),
        AZIMUTH_OFFSET_DEG.entry(settings.az_offset_deg),
        ELEVATION_OFFSET_DEG.entry(settings.el_offset_deg),
        LEAD_MS.entry(settings.lead_ms),
        POSITION_BASE.entry(settings.position_base.code()),
        MINIMUM_ELEVATION_DEG.entry(settings.minimum_elevation_deg),
        NORTH_OFFSET_DEG.entry(settings.north_offset_deg),
        SSPA.entry(settings.sspa.code()),
        SSPA_RULE.entry(settings.sspa_auto.code()),
        TLE_SOURCE.entry(settings.tle_mode.code()),
        ELEVATION_THRESHOLD_DEG.entry(settings.elevation_threshold_deg),
    ]))
}

/// Returns the command with only the changed values; a sign in each other field keeps its value.
pub(super) fn write(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    let new = desired.new;
    let change = SettingsChange {
        rtc_from_gps: CLOCK_FROM_GPS.get(new),
        time_offset_ms: TIME_OFFSET_MS.get(new),
        az_offset_deg: AZIMUTH_OFFSET_DEG.get(new),
        el_offset_deg: ELEVATION_OFFSET_DEG.get(new),
        lead_ms: LEAD_MS.get(new),
        position_base: POSITION_BASE.get(new).map(PositionBase::from_code),
        minimum_elevation_deg: MINIMUM_ELEVATION_DEG.get(new),
        north_offset_deg: NORTH_OFFSET_DEG.get(new),
        sspa: SSPA.get(new).map(SspaMode::from_code),
        sspa_auto: SSPA_RULE.get(new).map(SspaAutoRule::from_code),
        elevation_threshold_deg: ELEVATION_THRESHOLD_DEG.get(new),
    };
    let first = new.keys().next().copied().unwrap_or(GENERAL.key);
    SettingsRequest::new(&change).map(Setting::Settings).map_err(cannot(first))
}
