//! What the station tells through the desktop, and of which passes it reminds.

use std::collections::BTreeSet;

use serde::Serialize;

use super::HoursOfDay;

/// Settings for notices: alarms and reminders that the desktop shows and sounds. Alarms of the
/// first rank ignore them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Notices {
    /// The desktop shows new alarms and reminders.
    pub notifications: bool,
    /// New alarms and reminders make a sound.
    pub sounds: bool,
    /// `None` where no hours are quiet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quiet: Option<HoursOfDay>,
    /// Time from a reminder to AOS, minutes, 1 to 60.
    pub reminder_min: f64,
    /// Catalog numbers of the favourites whose passes have a reminder.
    pub reminders: BTreeSet<u32>,
}

impl Default for Notices {
    fn default() -> Self {
        Self {
            notifications: true,
            sounds: true,
            quiet: None,
            reminder_min: 5.0,
            reminders: BTreeSet::new(),
        }
    }
}
