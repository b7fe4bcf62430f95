//! What the unit reported of itself.

use crate::{
    device::UnitClock,
    protocol::satrak::{GpsData, GpsSettings, Satellite, Settings, StartStopTime},
};

/// Each part as last read. `None` means not read.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Reported {
    /// A fault or warning exists.
    pub(super) fault_flag: bool,
    /// The unit's clock.
    pub(super) clock: Option<UnitClock>,
    /// The GPS receiver.
    pub(super) gps: Option<GpsData>,
    /// Whether the unit uses the place of its receiver.
    pub(super) gps_settings: Option<GpsSettings>,
    /// The general settings.
    pub(super) settings: Option<Settings>,
    /// The satellite that the unit holds.
    pub(super) satellite: Option<Satellite>,
    /// The satellite was read after the window was seen to change: its highest
    /// elevation is that of this window.
    pub(super) height_is_of_window: bool,
    /// When it tracks.
    pub(super) window: Option<StartStopTime>,
}
