//! What a Satrak tells beyond the state that all antennas share.

use jiff::Timestamp;

use crate::protocol::satrak::{
    Faults, GpsData, GpsSettings, Satellite, Settings, StartStopTime, Version,
};

/// What the unit reported, each part as last read. `None` means not read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SatrakState {
    /// Control unit and drive unit, as they name themselves.
    pub version: Option<Version>,
    /// The last state could not be read, and the unit seems to write decimal
    /// commas.
    pub decimal_commas: bool,
    /// A fault or warning exists.
    pub fault_flag: bool,
    /// The faults, and when they were read.
    pub faults: Option<(Faults, Timestamp)>,
    /// The unit's clock.
    pub clock: Option<UnitClock>,
    /// The clock was set from GPS.
    pub clock_from_gps: Option<bool>,
    /// The GPS receiver.
    pub gps: Option<GpsData>,
    /// Whether the unit uses the place of its receiver.
    pub gps_settings: Option<GpsSettings>,
    /// The general settings.
    pub settings: Option<Settings>,
    /// The satellite that the unit holds.
    pub satellite: Option<Satellite>,
    /// The satellite was read after the window was seen to change: its highest
    /// elevation is that of this window.
    pub height_is_of_window: bool,
    /// When it tracks.
    pub window: Option<StartStopTime>,
}

/// The unit's clock against ours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitClock {
    /// How far the unit is ahead of us, in seconds; half the way over the link
    /// is taken off.
    pub ahead_s: f64,
    /// It was set by somebody.
    pub is_set: bool,
    /// When it was read, by our clock.
    pub read_at: Timestamp,
}
