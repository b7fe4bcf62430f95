//! Reading of the hooks. Azel omits a hook with any unreadable setting: without a condition, the
//! hook would call more often than intended.

use toml::Value;

use super::TableFields;
use crate::station::{AntennaId, Hook, HookAction, HookEvent, HookProblem};

impl TableFields<'_> {
    pub(super) fn hooks(&mut self, antennas: &[AntennaId], groups: &[&str]) -> Vec<Hook> {
        let mut names: Vec<String> = Vec::new();
        self.list("hooks", |fields| {
            let hook = fields.hook(antennas, groups)?;
            if names.contains(&hook.name) {
                fields.invalid("name", "another hook has it too");
                return None;
            }
            if names.len() >= Hook::MAX_NUMBER {
                let reason = format!("a station has {} hooks at most", Hook::MAX_NUMBER);
                fields.invalid("name", reason);
                return None;
            }
            names.push(hook.name.clone());
            Some(hook)
        })
    }

    fn hook(&mut self, antennas: &[AntennaId], groups: &[&str]) -> Option<Hook> {
        let before = self.notes.len();
        for (key, reason) in [
            ("name", "must be a text that is not empty".to_owned()),
            (
                "event",
                format!("must be one of {}", HookEvent::WORDS.map(|(word, _)| word).join(", ")),
            ),
        ] {
            if !self.table.contains_key(key) {
                self.invalid(key, reason);
            }
        }
        let words = HookEvent::WORDS.map(|(word, event)| (word, Some(event)));
        let (name, event) = (self.text("name", ""), self.one_of("event", &words, None));
        let (is_on, antenna) = (self.flag("on", true), self.antenna_of_rule(antennas));
        let subject = self.satellites_of_rule(groups);
        let delay_s = self.number("delay_s", &Hook::DELAY_S, 0.0);
        let timeout_s = self.number("timeout_s", &Hook::TIMEOUT_S, Hook::DEFAULT_TIMEOUT_S);
        let action = self.hook_action();
        let (event, action) = (event?, action?);
        let hook = Hook { name, is_on, antenna, subject, event, delay_s, action, timeout_s };
        if let Err(problem) = hook.check_delay() {
            self.invalid("delay_s", problem.to_string());
        }
        if let Err(problem) = hook.check_subject() {
            self.invalid("event", problem.to_string());
        }
        (self.notes.len() == before).then_some(hook)
    }

    fn hook_action(&mut self) -> Option<HookAction> {
        let (command, webhook) = (self.table.remove("command"), self.table.remove("webhook"));
        let (key, action) = match (command, webhook) {
            (Some(command), None) => ("command", words(&command).map(HookAction::Command)),
            (None, Some(Value::String(url))) => ("webhook", Ok(HookAction::Webhook(url))),
            (None, Some(_)) => ("webhook", Err(HookProblem::NoAddress)),
            (None, None) | (Some(_), Some(_)) => {
                self.invalid("command", "a hook has either a command or a webhook");
                return None;
            }
        };
        let valid = action.and_then(|action| action.check().map(|()| action));
        valid.map_err(|problem| self.invalid(key, problem.to_string())).ok()
    }
}

fn words(value: &Value) -> Result<Vec<String>, HookProblem> {
    let words = value.as_array().ok_or(HookProblem::NoProgram)?.iter();
    let words = words.map(|word| word.as_str().map(str::to_owned).ok_or(HookProblem::NoProgram));
    words.collect()
}
