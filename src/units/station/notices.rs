//! Notices of the station through the desktop, and the passes with reminders.

use std::collections::BTreeSet;

use serde::Serialize;

use super::HoursOfDay;

/// Sound of a notice, the least urgent first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Tones {
    None,
    /// Two rising tones.
    Rising,
    /// Two falling tones.
    Falling,
}

impl Tones {
    /// All sounds with their words in the station file.
    pub(super) const WORDS: [(&'static str, Self); 3] =
        [("none", Self::None), ("rising", Self::Rising), ("falling", Self::Falling)];
}

/// Settings for notices: alarms and reminders that the desktop shows and sounds. Alarms of the top
/// priority ignore these settings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Notices {
    /// `true` if the desktop shows new alarms and reminders.
    pub notifications: bool,
    /// `true` if new alarms and reminders make a sound.
    pub sounds: bool,
    /// Sound of alarms about a current problem.
    pub warning_tones: Tones,
    /// Sound of alarms about a future problem or a missed action.
    pub caution_tones: Tones,
    pub reminder_tones: Tones,
    /// Quiet hours; `None` without quiet hours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quiet: Option<HoursOfDay>,
    /// Time from a reminder to AOS, minutes, 1 to 60.
    pub reminder_min: f64,
    /// Catalog numbers of the favourites with reminders of their passes.
    pub reminders: BTreeSet<u32>,
}

impl Default for Notices {
    fn default() -> Self {
        Self {
            notifications: true,
            sounds: true,
            warning_tones: Tones::Falling,
            caution_tones: Tones::Falling,
            reminder_tones: Tones::Rising,
            quiet: None,
            reminder_min: 5.0,
            reminders: BTreeSet::new(),
        }
    }
}
