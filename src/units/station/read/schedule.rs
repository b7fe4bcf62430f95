//! Reading of the settings for the schedule and for automatic operation.

use std::ops::RangeInclusive;

use jiff::Timestamp;
use toml::Value;

use super::TableFields;
use crate::station::{
    AntennaId, Automatic, AutomationRule, BetweenPasses, ChooseBy, HoursOfDay, Partly, PassChoice,
    RuleAction, RuleSubject, Scheduling, SunIs, Take, Upkeep, ranges,
};

impl TableFields<'_> {
    pub(super) fn scheduling(&mut self) -> Scheduling {
        let default = Scheduling::default();
        let choose_by = [
            ("elevation", ChooseBy::Elevation),
            ("duration", ChooseBy::Duration),
            ("most_passes", ChooseBy::MostPasses),
            ("most_minutes", ChooseBy::MostMinutes),
        ];
        self.inner("schedule", |fields| Scheduling {
            choose_by: fields.one_of("choose_by", &choose_by, default.choose_by),
            span_h: fields.number("span_h", &ranges::SCHEDULE_SPAN_H, default.span_h),
            partly: fields.partly(),
            hand_over: fields.flag("hand_over", default.hand_over),
            max_element_age_d: fields.optional("max_element_age_d", &ranges::ELEMENT_AGE_D),
            warn_after_rest_min: fields.number(
                "warn_after_rest_min",
                &ranges::REST_MIN,
                default.warn_after_rest_min,
            ),
            warning_s: fields.number("warning_s", &ranges::WARNING_S, default.warning_s),
        })
    }

    fn partly(&mut self) -> Option<Partly> {
        const KEY: &str = "partly";
        self.table.contains_key(KEY).then(|| {
            self.inner(KEY, |fields| Partly {
                min_percent: fields.number("least_percent", &ranges::MIN_PERCENT, 50.0),
                min_s: fields.number("least_s", &ranges::MIN_DURATION_S, 60.0),
            })
        })
    }

    /// Reads the settings of an antenna for automatic operation.
    pub(super) fn automatic(&mut self) -> Automatic {
        let choices = [
            ("stay", BetweenPasses::Stay),
            ("wait", BetweenPasses::Wait),
            ("park", BetweenPasses::Park),
        ];
        Automatic {
            is_on_at_start: self.flag("automatic_operation_at_start", false),
            resumes_after_crash: self.flag("automatic_operation_after_crash", false),
            between_passes: self.one_of("between_passes", &choices, BetweenPasses::default()),
            uses_auto_track: self.flag("uses_auto_track", false),
            set_up_s: self.optional("set_up_s", &ranges::SET_UP_S),
        }
    }

    /// Reads the rules of an antenna for the upkeep of its unit.
    pub(super) fn upkeep(&mut self) -> Upkeep {
        let default = Upkeep::default();
        self.inner("upkeep", |fields| Upkeep {
            sets_clock: fields.flag("sets_clock", default.sets_clock),
            clock_limit_s: fields.number(
                "clock_limit_s",
                &ranges::CLOCK_LIMIT_S,
                default.clock_limit_s,
            ),
            uploads_elements: fields.flag("uploads_elements", default.uploads_elements),
            element_limit_d: fields.number(
                "element_limit_d",
                &ranges::ELEMENT_AGE_D,
                default.element_limit_d,
            ),
        })
    }

    pub(super) fn pass_choice(&mut self) -> Option<PassChoice> {
        let take = [("always", Some(Take::Always)), ("never", Some(Take::Never))];
        let satellite = self.satellite();
        let (tca, chosen_at) = (self.timestamp("tca"), self.timestamp("chosen_at"));
        if !self.table.contains_key("take") {
            self.invalid("take", "must be always or never");
        }
        let take = self.one_of("take", &take, None)?;
        let tca = tca?;
        Some(PassChoice { satellite: satellite?, tca, take, chosen_at: chosen_at.unwrap_or(tca) })
    }

    fn timestamp(&mut self, key: &str) -> Option<Timestamp> {
        let value = self.table.remove(key);
        let text = value.as_ref().map(|value| match value {
            Value::String(text) => text.clone(),
            other => other.to_string(),
        });
        let time = text.and_then(|text| text.parse().ok());
        if time.is_none() {
            self.invalid(key, "must be a time such as \"2026-08-12T12:00:00Z\"");
        }
        time
    }

    /// Reads a rule. Omits a rule with an unreadable condition: without the condition, it would
    /// apply more often than intended.
    pub(super) fn automation_rule(
        &mut self,
        antennas: &[AntennaId],
        groups: &[&str],
    ) -> Option<AutomationRule> {
        let before = self.notes.len();
        let choices = [
            ("take", Some(RuleAction::Take)),
            ("leave", Some(RuleAction::Leave)),
            ("park", Some(RuleAction::Park)),
        ];
        let sun = [("up", Some(SunIs::Up)), ("down", Some(SunIs::Down))];
        if !self.table.contains_key("then") {
            self.invalid("then", "must be take, leave or park");
        }
        let rule = AutomationRule {
            is_on: self.flag("on", true),
            antenna: self.antenna_of_rule(antennas),
            subject: self.satellites_of_rule(groups),
            sun: self.one_of("sun", &sun, None),
            hours: self.hours("hours"),
            action: self.one_of("then", &choices, None)?,
        };
        (self.notes.len() == before).then_some(rule)
    }

    pub(super) fn antenna_of_rule(&mut self, antennas: &[AntennaId]) -> Option<AntennaId> {
        let number = self.table.remove("antenna")?.as_integer();
        let id = number.and_then(|number| u32::try_from(number).ok()).map(AntennaId);
        let valid = id.filter(|id| antennas.contains(id));
        if valid.is_none() {
            self.invalid("antenna", "must be the id of an antenna of the station");
        }
        valid
    }

    pub(super) fn satellites_of_rule(&mut self, groups: &[&str]) -> Option<RuleSubject> {
        if self.table.contains_key("satellite") {
            return self.satellite().map(RuleSubject::Satellite);
        }
        let name = self.table.remove("group")?;
        let valid = name.as_str().filter(|name| groups.contains(name)).map(str::to_owned);
        if valid.is_none() {
            self.invalid("group", "must be the name of a group");
        }
        valid.map(RuleSubject::Group)
    }

    /// Reads hours of the day; `None` if an end cannot be read, because a guess would be wrong.
    pub(super) fn hours(&mut self, key: &str) -> Option<HoursOfDay> {
        if !self.table.contains_key(key) {
            return None;
        }
        let ends = self.inner(key, |fields| (fields.time_of_day("from"), fields.time_of_day("to")));
        let (Some(start), Some(end)) = ends else { return None };
        if start == end {
            self.invalid(key, "must end at another time than they begin");
            return None;
        }
        Some(HoursOfDay { start, end })
    }

    fn time_of_day(&mut self, key: &str) -> Option<jiff::civil::Time> {
        let value = self.table.remove(key);
        let time = value.as_ref().and_then(Value::as_str).and_then(HoursOfDay::read_time);
        if time.is_none() {
            self.invalid(key, "must be a time of day such as \"22:00\"");
        }
        time
    }

    pub(super) fn flag(&mut self, key: &str, default: bool) -> bool {
        match self.table.remove(key) {
            None => default,
            Some(Value::Boolean(on)) => on,
            Some(_) => {
                self.invalid(key, "must be true or false");
                default
            }
        }
    }

    /// Reads a number that may be missing.
    pub(super) fn optional(&mut self, key: &str, range: &RangeInclusive<f64>) -> Option<f64> {
        let number = self.table.contains_key(key).then(|| self.number(key, range, f64::NAN));
        number.filter(|number| !number.is_nan())
    }
}
