//! General settings (sections 12 and 13). The query returns 12 values, the setting takes
//! 11: it has no TLE mode, so the last value moves up by one.

use super::ValueError;
use super::coded::coded;
use super::fields::{FieldError, FrameFields};
use super::number::{checked, pointed};

coded! {
    /// Sensors that measure the position.
    PositionBase {
        ResolverAndEncoder = 0,
        Resolver = 1,
    }
}

coded! {
    /// Switch of the transmitter's power amplifier (SSPA).
    SspaMode {
        Off = 0,
        /// On: the antenna radiates.
        On = 1,
        /// Automatic switching by [`SspaAutoRule`].
        Auto = 2,
    }
}

coded! {
    /// Condition for an automatic power amplifier to be on.
    SspaAutoRule {
        Tracking = 0,
        CarrierLock = 1,
        /// Tracking with the carrier locked.
        Both = 2,
        /// Tracking, or a locked carrier.
        Either = 3,
    }
}

coded! {
    /// Source of the unit's elements.
    TleMode {
        /// A file in the unit.
        File = 0,
        /// A web address.
        Web = 1,
        /// An FTP server.
        Ftp = 2,
    }
}

/// Reply to `SETTINGS?`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// `true` if the clock follows GPS.
    pub rtc_from_gps: bool,
    /// Time by which tracking runs ahead, milliseconds.
    pub time_offset_ms: i64,
    /// Offset that the unit adds to the azimuth while tracking, degrees.
    pub az_offset_deg: f64,
    /// Offset that the unit adds to the elevation while tracking, degrees.
    pub el_offset_deg: f64,
    /// Time before the window at which the unit goes to the start point, milliseconds.
    pub lead_ms: i64,
    pub position_base: PositionBase,
    pub minimum_elevation_deg: f64,
    pub north_offset_deg: f64,
    pub sspa: SspaMode,
    pub sspa_auto: SspaAutoRule,
    /// Source of the elements. The document has no request that sets it.
    pub tle_mode: TleMode,
    pub elevation_threshold_deg: f64,
}

impl Settings {
    pub(super) const FIELDS: usize = 12;

    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        Ok(Self {
            rtc_from_gps: fields.flag(1)?,
            time_offset_ms: fields.integer(2)?,
            az_offset_deg: fields.decimal(3)?,
            el_offset_deg: fields.decimal(4)?,
            lead_ms: fields.integer(5)?,
            position_base: PositionBase::from_code(fields.integer(6)?),
            minimum_elevation_deg: fields.decimal(7)?,
            north_offset_deg: fields.decimal(8)?,
            sspa: SspaMode::from_code(fields.integer(9)?),
            sspa_auto: SspaAutoRule::from_code(fields.integer(10)?),
            tle_mode: TleMode::from_code(fields.integer(11)?),
            elevation_threshold_deg: fields.decimal(12)?,
        })
    }

    /// Returns the settings that the read-back must show after `change`.
    #[must_use]
    pub fn after(self, change: &SettingsChange) -> Self {
        Self {
            rtc_from_gps: change.rtc_from_gps.unwrap_or(self.rtc_from_gps),
            time_offset_ms: change.time_offset_ms.unwrap_or(self.time_offset_ms),
            az_offset_deg: change.az_offset_deg.unwrap_or(self.az_offset_deg),
            el_offset_deg: change.el_offset_deg.unwrap_or(self.el_offset_deg),
            lead_ms: change.lead_ms.unwrap_or(self.lead_ms),
            position_base: change.position_base.unwrap_or(self.position_base),
            minimum_elevation_deg: change
                .minimum_elevation_deg
                .unwrap_or(self.minimum_elevation_deg),
            north_offset_deg: change.north_offset_deg.unwrap_or(self.north_offset_deg),
            sspa: change.sspa.unwrap_or(self.sspa),
            sspa_auto: change.sspa_auto.unwrap_or(self.sspa_auto),
            tle_mode: self.tle_mode,
            elevation_threshold_deg: change
                .elevation_threshold_deg
                .unwrap_or(self.elevation_threshold_deg),
        }
    }
}

/// Settings to change; `None` keeps a value. [`Settings`] describes the fields.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SettingsChange {
    pub rtc_from_gps: Option<bool>,
    pub time_offset_ms: Option<i64>,
    pub az_offset_deg: Option<f64>,
    pub el_offset_deg: Option<f64>,
    pub lead_ms: Option<i64>,
    pub position_base: Option<PositionBase>,
    pub minimum_elevation_deg: Option<f64>,
    pub north_offset_deg: Option<f64>,
    pub sspa: Option<SspaMode>,
    pub sspa_auto: Option<SspaAutoRule>,
    pub elevation_threshold_deg: Option<f64>,
}

/// Checked values of `SETTINGS=`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SettingsRequest(SettingsChange);

/// Azel's own limits; the document gives none.
const MAX_TIME_MS: f64 = 3_600_000.0;
const MAX_OFFSET_DEG: f64 = 10.0;
const MAX_NORTH_OFFSET_DEG: f64 = 360.0;

impl SettingsRequest {
    /// Checks a change against Azel's own ranges: angle offsets within 10 degrees, times within an
    /// hour, elevations 0 to 90, north offset within a turn. Rounds angles to a thousandth. Returns
    /// an error for an empty change.
    pub fn new(change: &SettingsChange) -> Result<Self, ValueError> {
        if *change == SettingsChange::default() {
            return Err(ValueError::NoChange);
        }
        if let Some(ms) = change.time_offset_ms {
            // Only the test matters: whole milliseconds need no rounding.
            checked("time offset in ms", ms as f64, -MAX_TIME_MS, MAX_TIME_MS)?;
        }
        if let Some(ms) = change.lead_ms {
            // Section 12 calls it a time before the start, so it cannot be negative.
            checked("lead time in ms", ms as f64, 0.0, MAX_TIME_MS)?;
        }
        for (name, unknown) in [
            ("position base", change.position_base.map(|base| (base.code(), 1))),
            ("power amplifier", change.sspa.map(|mode| (mode.code(), 2))),
            ("power amplifier rule", change.sspa_auto.map(|rule| (rule.code(), 3))),
        ] {
            // A unit may report an unexplained number, but its effect as a setting is unknown.
            if let Some((code, last)) = unknown
                && !(0..=last).contains(&code)
            {
                return Err(ValueError::Choice { name, code });
            }
        }
        let angle = |field, value: Option<f64>, min, max| {
            value.map(|value| checked(field, value, min, max)).transpose()
        };
        let offset = MAX_OFFSET_DEG;
        let north = MAX_NORTH_OFFSET_DEG;
        Ok(Self(SettingsChange {
            az_offset_deg: angle("azimuth offset", change.az_offset_deg, -offset, offset)?,
            el_offset_deg: angle("elevation offset", change.el_offset_deg, -offset, offset)?,
            minimum_elevation_deg: angle(
                "minimum elevation",
                change.minimum_elevation_deg,
                0.0,
                90.0,
            )?,
            north_offset_deg: angle("north offset", change.north_offset_deg, -north, north)?,
            elevation_threshold_deg: angle(
                "elevation threshold",
                change.elevation_threshold_deg,
                0.0,
                90.0,
            )?,
            ..*change
        }))
    }

    pub fn change(&self) -> &SettingsChange {
        &self.0
    }

    pub(super) fn values(&self) -> Vec<String> {
        let keep = || "?".to_owned();
        let flag =
            |value: Option<bool>| value.map_or_else(keep, |value| u8::from(value).to_string());
        let integer = |value: Option<i64>| value.map_or_else(keep, |value| value.to_string());
        let angle = |value: Option<f64>| value.map_or_else(keep, pointed);
        let SettingsChange { rtc_from_gps, time_offset_ms, lead_ms, .. } = self.0;
        vec![
            flag(rtc_from_gps),
            integer(time_offset_ms),
            angle(self.0.az_offset_deg),
            angle(self.0.el_offset_deg),
            integer(lead_ms),
            integer(self.0.position_base.map(PositionBase::code)),
            angle(self.0.minimum_elevation_deg),
            angle(self.0.north_offset_deg),
            integer(self.0.sspa.map(SspaMode::code)),
            integer(self.0.sspa_auto.map(SspaAutoRule::code)),
            angle(self.0.elevation_threshold_deg),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::Frame;

    #[test]
    fn the_threshold_stands_at_different_places() {
        let payload = "SETTINGS?,1,100,1.0,2.0,60000,1,3.0,6.0,1,1,2,2.5";
        let now = Settings::read(FrameFields::new(&Frame::from_payload(payload))).unwrap();
        assert_eq!((now.tle_mode, now.elevation_threshold_deg), (TleMode::Ftp, 2.5));
        let change = SettingsChange { elevation_threshold_deg: Some(4.0), ..Default::default() };
        let request = SettingsRequest::new(&change).unwrap();
        assert_eq!(request.values().last().map(String::as_str), Some("4.0"));
        assert_eq!(request.values().len(), 11);
        let changed = now.after(request.change());
        assert_eq!(changed, Settings { elevation_threshold_deg: 4.0, ..now });
    }

    #[test]
    fn wishes_without_sense_are_refused() {
        assert_eq!(SettingsRequest::new(&SettingsChange::default()), Err(ValueError::NoChange));
        let refused = [
            SettingsChange { lead_ms: Some(-1), ..Default::default() },
            SettingsChange { time_offset_ms: Some(i64::MIN), ..Default::default() },
            SettingsChange { sspa: Some(SspaMode::Unknown(3)), ..Default::default() },
            SettingsChange { az_offset_deg: Some(f64::NAN), ..Default::default() },
            SettingsChange { minimum_elevation_deg: Some(-1.0), ..Default::default() },
        ];
        for change in refused {
            assert!(SettingsRequest::new(&change).is_err(), "{change:?}");
        }
    }
}
