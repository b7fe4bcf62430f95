//! Reading of the settings for notices.

use super::TableFields;
use crate::station::{Notices, Tones, ranges};

impl TableFields<'_> {
    pub(super) fn notices(&mut self) -> Notices {
        let default = Notices::default();
        self.inner("notices", |fields| Notices {
            notifications: fields.flag("notifications", default.notifications),
            sounds: fields.flag("sounds", default.sounds),
            warning_tones: fields.one_of("warning_tones", &Tones::WORDS, default.warning_tones),
            caution_tones: fields.one_of("caution_tones", &Tones::WORDS, default.caution_tones),
            reminder_tones: fields.one_of("reminder_tones", &Tones::WORDS, default.reminder_tones),
            quiet: fields.hours("quiet"),
            reminder_min: fields.number(
                "reminder_min",
                &ranges::REMINDER_MIN,
                default.reminder_min,
            ),
            reminders: fields.catalog_numbers("reminders", default.reminders),
        })
    }
}
