//! Reading of the retention of the record.

use super::TableFields;
use crate::station::{Retention, ranges};

impl TableFields<'_> {
    pub(super) fn keeping(&mut self) -> Retention {
        let default = Retention::default();
        self.inner("record", |fields| Retention {
            raw_days: fields.number("raw_days", &ranges::RAW_DAYS, default.raw_days),
            years: fields.number("years", &ranges::RECORD_YEARS, default.years),
        })
    }
}
