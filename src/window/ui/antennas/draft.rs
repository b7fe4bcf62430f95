//! Edits of one group of settings, and their results.

use std::collections::BTreeMap;

use jiff::Timestamp;

use crate::{
    clock::Instant,
    device::settings::{Access, Field, Unfit, Value, Values, Written},
    ui::widgets::hold_button::HoldState,
};

/// Edits of one group. The type has no `Debug`, because an edit may be a password.
#[derive(Default)]
pub(super) struct Draft {
    edits: BTreeMap<&'static str, Edit>,
    /// Values on the unit when the first edit began.
    expected: Option<Values>,
    sent: Option<Sent>,
    outcomes: BTreeMap<&'static str, Outcome>,
    /// Values that the unit held when Azel verified an edit.
    proved: Values,
}

#[derive(Default)]
struct Edit {
    text: String,
    is_confirmed: bool,
    hold: HoldState,
}

/// Change that the unit has not answered yet.
pub(super) struct Sent {
    pub(super) ticket: u64,
    pub(super) instant: Instant,
    pub(super) values: Values,
}

/// Result of the last change of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Value that Azel read back and found correct.
    Verified(Timestamp),
    /// Value that the unit accepted but never reports.
    Taken(Timestamp),
    Rejected,
}

/// Content of a field compared with the value of the unit.
#[derive(Debug, PartialEq)]
pub(super) enum Reading {
    Same,
    New(Value),
    Unfit(Unfit),
}

/// Returns the content of a field without an edit.
fn default_text(field: &Field, current: Option<&Values>) -> String {
    if field.access == Access::Write {
        return field.kind.untouched();
    }
    let value = current.and_then(|current| current.get(field.key));
    value.map(|value| field.kind.text(value)).unwrap_or_default()
}

impl Draft {
    /// Returns the typed content of the field, or its content without an edit.
    pub(super) fn text(&self, field: &Field, current: Option<&Values>) -> String {
        let typed = self.edits.get(field.key).map(|edit| edit.text.clone());
        typed.unwrap_or_else(|| default_text(field, current))
    }

    /// Takes `text` as typed by the operator.
    pub(super) fn type_in(
        &mut self,
        field: &'static Field,
        text: String,
        current: Option<&Values>,
    ) {
        self.outcomes.remove(field.key);
        if text == default_text(field, current) {
            self.edits.remove(field.key);
        } else {
            if self.edits.is_empty() {
                self.expected = current.cloned();
            }
            self.edits.insert(field.key, Edit { text, ..Edit::default() });
        }
    }

    pub(super) fn reading(&self, field: &Field, current: Option<&Values>) -> Reading {
        let Some(edit) = self.edits.get(field.key) else { return Reading::Same };
        if edit.text == default_text(field, current) {
            return Reading::Same;
        }
        match field.kind.read(&edit.text) {
            Ok(new) => {
                let same = current.and_then(|current| current.get(field.key));
                if same.is_some_and(|old| field.kind.same(old, &new)) {
                    Reading::Same
                } else {
                    Reading::New(new)
                }
            }
            Err(unfit) => Reading::Unfit(unfit),
        }
    }

    pub(super) fn is_confirmed(&self, key: &str) -> bool {
        self.edits.get(key).is_some_and(|edit| edit.is_confirmed)
    }

    /// Returns the state of the hold button that confirms the edit of this field.
    pub(super) fn hold(&mut self, key: &str) -> Option<&mut HoldState> {
        self.edits.get_mut(key).map(|edit| &mut edit.hold)
    }

    /// Marks the edit of the field as confirmed by the operator.
    pub(super) fn confirm(&mut self, key: &str) {
        if let Some(edit) = self.edits.get_mut(key) {
            edit.is_confirmed = true;
        }
    }

    /// Returns the result of the last change of the field. A verified result is void once the unit
    /// holds another value.
    pub(super) fn outcome(&self, field: &Field, current: Option<&Values>) -> Option<Outcome> {
        let outcome = self.outcomes.get(field.key).copied()?;
        let now = current.and_then(|current| current.get(field.key));
        let still = match (self.proved.get(field.key), now) {
            (Some(proved), Some(now)) => field.kind.same(proved, now),
            _ => false,
        };
        (still || !matches!(outcome, Outcome::Verified(_))).then_some(outcome)
    }

    pub(super) fn expected(&self) -> Option<&Values> {
        self.expected.as_ref()
    }

    pub(super) fn sent(&self) -> Option<&Sent> {
        self.sent.as_ref()
    }

    pub(super) fn is_sending(&self, key: &str) -> bool {
        self.sent.as_ref().is_some_and(|sent| sent.values.contains_key(key))
    }

    pub(super) fn begin(&mut self, sent: Sent) {
        self.sent = Some(sent);
    }

    /// Ends the change. Verified values stop being edits, and the unit's current values become the
    /// expected ones.
    pub(super) fn end(&mut self, written: &Written, fields: &[Field], current: Option<&Values>) {
        let Some(sent) = self.sent.take() else { return };
        for (key, value) in &sent.values {
            let Some(field) = fields.iter().find(|field| field.key == *key) else { continue };
            let outcome = match (&written.result, field.access) {
                (Err(_), _) => Outcome::Rejected,
                (Ok(()), Access::Write) => Outcome::Taken(written.time),
                (Ok(()), _) => Outcome::Verified(written.time),
            };
            self.outcomes.insert(field.key, outcome);
            let proved = current.and_then(|current| current.get(field.key)).cloned();
            self.proved.extend(proved.map(|value| (field.key, value)));
            let still = self.edits.get(key).map(|edit| field.kind.read(&edit.text));
            if outcome != Outcome::Rejected && still == Some(Ok(value.clone())) {
                self.edits.remove(key);
            }
        }
        self.expected = current.cloned();
    }

    /// Abandons the change when no result will come.
    pub(super) fn give_up(&mut self) {
        self.sent = None;
    }

    /// Drops the edits. A change on its way to the unit continues.
    pub(super) fn revert(&mut self) {
        self.edits.clear();
        self.outcomes.retain(|_, outcome| *outcome != Outcome::Rejected);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::settings::{Change, Key, WriteError};

    static FIELDS: [Field; 2] = [
        Field::edit(Key::decimal("low", 0.0, 90.0, 1), "Low"),
        Field::write(Key::flag("keep"), "Keep"),
    ];

    fn held_values(low: f64) -> Values {
        [("low", Value::Decimal(low))].into()
    }

    fn draft_of(text: &str) -> Draft {
        let mut draft = Draft::default();
        draft.type_in(&FIELDS[0], text.to_owned(), Some(&held_values(3.0)));
        draft
    }

    fn written(result: Result<(), WriteError>) -> Written {
        let values = held_values(5.0);
        let change = Change { ticket: 1, group: "g", values, expected: None, is_unlocked: false };
        Written { change, time: Timestamp::UNIX_EPOCH, result }
    }

    fn send(draft: &mut Draft) {
        draft.begin(Sent { ticket: 1, instant: Instant::now(), values: held_values(5.0) });
    }

    #[test]
    fn only_what_differs_is_an_edit() {
        for (text, reading) in [("3.0", Reading::Same), ("3,00", Reading::Same)] {
            assert_eq!(draft_of(text).reading(&FIELDS[0], Some(&held_values(3.0))), reading);
        }
        let new = draft_of("5").reading(&FIELDS[0], Some(&held_values(3.0)));
        assert_eq!(new, Reading::New(Value::Decimal(5.0)));
        assert_eq!(draft_of("5").reading(&FIELDS[0], Some(&held_values(5.0))), Reading::Same);
        let unfit = draft_of("x").reading(&FIELDS[0], Some(&held_values(3.0)));
        assert_eq!(unfit, Reading::Unfit(Unfit::Number { min: 0.0, max: 90.0 }));
    }

    #[test]
    fn what_was_seen_is_what_stood_there_when_the_edit_began() {
        let mut draft = draft_of("5");
        draft.type_in(&FIELDS[1], "On".to_owned(), Some(&held_values(7.5)));
        assert_eq!(draft.expected(), Some(&held_values(3.0)));
        draft.revert();
        draft.type_in(&FIELDS[1], "On".to_owned(), Some(&held_values(7.5)));
        assert_eq!(draft.expected(), Some(&held_values(7.5)));
    }

    #[test]
    fn a_proved_edit_is_none_any_more_and_a_refused_one_stays() {
        let mut draft = draft_of("5");
        send(&mut draft);
        assert!(draft.is_sending("low"));
        draft.end(&written(Err(WriteError::NoLink)), &FIELDS, Some(&held_values(3.0)));
        assert_eq!(draft.outcome(&FIELDS[0], Some(&held_values(3.0))), Some(Outcome::Rejected));
        assert_eq!(draft.text(&FIELDS[0], Some(&held_values(3.0))), "5");
        send(&mut draft);
        draft.end(&written(Ok(())), &FIELDS, Some(&held_values(5.0)));
        let verified = Some(Outcome::Verified(Timestamp::UNIX_EPOCH));
        assert_eq!(draft.outcome(&FIELDS[0], Some(&held_values(5.0))), verified);
        assert_eq!(draft.outcome(&FIELDS[0], Some(&held_values(7.5))), None, "changed by another");
        assert_eq!(draft.reading(&FIELDS[0], Some(&held_values(5.0))), Reading::Same);
        draft.type_in(&FIELDS[0], "6".to_owned(), Some(&held_values(5.0)));
        assert_eq!(
            draft.outcome(&FIELDS[0], Some(&held_values(5.0))),
            None,
            "until it is edited again"
        );
    }

    #[test]
    fn what_was_typed_on_while_it_was_sent_stays_an_edit() {
        let mut draft = draft_of("5");
        send(&mut draft);
        draft.type_in(&FIELDS[0], "6".to_owned(), Some(&held_values(3.0)));
        draft.end(&written(Ok(())), &FIELDS, Some(&held_values(5.0)));
        let still = draft.reading(&FIELDS[0], Some(&held_values(5.0)));
        assert_eq!(still, Reading::New(Value::Decimal(6.0)));
    }

    #[test]
    fn another_text_has_to_be_confirmed_again() {
        let mut draft = draft_of("5");
        draft.confirm("low");
        assert!(draft.is_confirmed("low"));
        draft.type_in(&FIELDS[0], "6".to_owned(), Some(&held_values(3.0)));
        assert!(!draft.is_confirmed("low"));
    }
}
