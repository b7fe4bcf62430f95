//! Capabilities, settings and actions of a unit with its connection settings.

use super::{
    Capabilities, TrackOffsetFields,
    panel::Action,
    settings::{Group, Values},
};

/// Capabilities, settings and actions of a unit. A make has several variants if its connection
/// settings change them, such as for a rotator without elevation.
#[derive(Debug)]
pub struct Variant {
    pub capabilities: Capabilities,
    /// Settings of the unit.
    pub groups: &'static [&'static Group],
    /// Actions that only this unit has.
    pub actions: &'static [Action],
    /// Track offsets; `None` for a unit that computes no tracks, or whose tracks cannot be shifted.
    pub track_offsets: Option<&'static TrackOffsetFields>,
    /// Clock; `None` for a unit without a clock.
    pub clock: Option<&'static ClockSetting>,
}

/// Description of a unit's clock setting.
#[derive(Debug)]
pub struct ClockSetting {
    /// Key of the settings group of the clock.
    pub group: &'static str,
    /// Function that returns the values of that group that set the clock from this computer.
    pub from_here: fn() -> Values,
    /// Test of the values of that group: `true` if the unit sets its own clock.
    pub is_kept_by_unit: fn(&Values) -> bool,
}

impl Variant {
    pub fn action(&self, key: &str) -> Option<&'static Action> {
        self.actions.iter().find(|action| action.key == key)
    }
}
