//! The unit's last reports.

use crate::{
    device::UnitClock,
    protocol::satrak::{GpsData, GpsSettings, Satellite, Settings, StartStopTime},
};

/// The last report of each part; `None` if not read.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Reported {
    /// `true` if the unit has a fault or warning.
    pub(super) fault_flag: bool,
    pub(super) clock: Option<UnitClock>,
    pub(super) clock_is_from_gps: Option<bool>,
    pub(super) gps_lock_delay_s: Option<f64>,
    pub(super) gps: Option<GpsData>,
    /// GPS settings, which say whether the unit uses the place of its receiver.
    pub(super) gps_settings: Option<GpsSettings>,
    pub(super) settings: Option<Settings>,
    pub(super) satellite: Option<Satellite>,
    /// `true` if Azel read the satellite after the window had changed: its max elevation then
    /// belongs to that window.
    pub(super) height_is_of_window: bool,
    pub(super) window: Option<StartStopTime>,
}
