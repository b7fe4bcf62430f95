//! Test data for schedules, also for the dependent packages.

#[cfg(test)]
mod days;

use jiff::Timestamp;

use super::{Class, Entry, PassKey};
use crate::{
    astro::time::seconds_between,
    station::{AntennaId, Priority},
};

#[cfg(test)]
pub(in crate::plan) use days::*;

/// Returns an entry of an antenna that tracks a pass from AOS to LOS.
pub fn entry(antenna: AntennaId, pass: PassKey, end: Timestamp) -> Entry {
    Entry {
        pass,
        antenna,
        class: Class::Priority(Priority::default()),
        start: pass.aos,
        end,
        late_s: 0.0,
        early_s: 0.0,
        counted_s: seconds_between(pass.aos, end),
        worth: 1,
        lost: None,
        axes_deg: [[0.0; 2]; 2],
        after: None,
        slew_s: 0.0,
        set_up_s: 0.0,
        spare_s: None,
        shared_with: None,
        is_fixed: false,
    }
}
