//! Reads the settings for notices.

use jiff::civil::Time;
use toml::Value;

use super::Fields;
use crate::station::{Notices, QuietHours, ranges};

impl Fields<'_> {
    pub(super) fn notices(&mut self) -> Notices {
        let default = Notices::default();
        self.inner("notices", |fields| Notices {
            notifications: fields.flag("notifications", default.notifications),
            sounds: fields.flag("sounds", default.sounds),
            quiet: fields.quiet_hours(),
            reminder_min: fields.number(
                "reminder_min",
                &ranges::REMINDER_MIN,
                default.reminder_min,
            ),
            reminders: fields.catalog_numbers("reminders", default.reminders),
        })
    }

    fn flag(&mut self, key: &str, default: bool) -> bool {
        match self.table.remove(key) {
            None => default,
            Some(Value::Boolean(on)) => on,
            Some(_) => {
                self.invalid(key, "must be true or false");
                default
            }
        }
    }

    /// Quiet hours of which one end cannot be read are none: silence is not guessed.
    fn quiet_hours(&mut self) -> Option<QuietHours> {
        const KEY: &str = "quiet";
        if !self.table.contains_key(KEY) {
            return None;
        }
        let ends = self.inner(KEY, |fields| (fields.time_of_day("from"), fields.time_of_day("to")));
        let (Some(from), Some(to)) = ends else { return None };
        if from == to {
            self.invalid(KEY, "must end at another time than they begin");
            return None;
        }
        Some(QuietHours { from, to })
    }

    fn time_of_day(&mut self, key: &str) -> Option<Time> {
        let value = self.table.remove(key);
        let time = value.as_ref().and_then(Value::as_str).and_then(QuietHours::read_time);
        if time.is_none() {
            self.invalid(key, "must be a local time such as \"22:00\"");
        }
        time
    }
}
