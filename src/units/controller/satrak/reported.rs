//! The unit's last reports.

use crate::{
    device::UnitClock,
    protocol::satrak::{GpsData, GpsSettings, Satellite, Settings, StartStopTime},
};

/// Each part as last read; `None` if not read.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Reported {
    /// A fault or warning exists.
    pub(super) fault_flag: bool,
    pub(super) clock: Option<UnitClock>,
    pub(super) clock_is_from_gps: Option<bool>,
    pub(super) gps_lock_delay_s: Option<f64>,
    pub(super) gps: Option<GpsData>,
    /// Says whether the unit uses the place of its receiver.
    pub(super) gps_settings: Option<GpsSettings>,
    pub(super) settings: Option<Settings>,
    pub(super) satellite: Option<Satellite>,
    /// The satellite was read after the window had changed, so its maximum elevation belongs
    /// to that window.
    pub(super) height_is_of_window: bool,
    pub(super) window: Option<StartStopTime>,
}
