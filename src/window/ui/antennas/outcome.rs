//! Sentences on the result of a change: the failure, its reason, the current value, and the remedy.

use crate::{
    device::settings::{Field, Group, Kind, ReadFailure, Value, Values, WriteError, Written},
    ui::{format, words},
};

/// Placeholder for a value that must not be readable.
pub(super) const HIDDEN: &str = "hidden";

/// Placeholder for a value that the unit never reports, or did not report.
pub(super) const NOT_REPORTED: &str = "not reported";

/// Formats a value without its unit of measure.
pub(super) fn shown(field: &Field, value: &Value) -> String {
    match (field.kind, value) {
        (_, Value::Secret(_)) => HIDDEN.to_owned(),
        (Kind::Integer { .. }, Value::Integer(number)) => format::number(*number as f64, 0),
        (Kind::Decimal { .. }, Value::Decimal(_)) => {
            let text = field.kind.text(value);
            let is_zero = !text.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
            let minus = if is_zero { "" } else { "\u{2212}" };
            text.replace('-', minus)
        }
        _ => field.kind.text(value),
    }
}

/// Formats a value with its unit of measure, if any.
fn with_unit(field: &Field, value: Option<&Value>) -> String {
    let Some(value) = value else { return NOT_REPORTED.to_owned() };
    let value = shown(field, value);
    match field.unit {
        "" => value,
        "°" => format!("{value}°"),
        unit => format!("{value} {unit}"),
    }
}

/// Returns the reason why a group is unknown.
pub(super) fn read_failure(failure: &ReadFailure) -> String {
    match failure {
        ReadFailure::Refused(answer) => format!("the unit answered {answer}"),
        ReadFailure::Unanswered => "the unit did not answer".to_owned(),
    }
}

/// Returns the reason why `written` failed. `expected` holds the values that the form showed
/// before, `current` the unit's values now.
pub(super) fn sentence(
    group: &Group,
    written: &Written,
    error: &WriteError,
    expected: Option<&Values>,
    current: Option<&Values>,
) -> String {
    let fields: Vec<&Field> =
        written.change.values.keys().filter_map(|key| group.field(key)).collect();
    let subject = match fields.as_slice() {
        [only] => only.label,
        _ => group.title,
    };
    let kept_text = || kept_values(&fields, current);
    match error {
        WriteError::NoLink => format!("{subject}: not sent, there is no link. Your edit is kept."),
        WriteError::LinkLost => format!(
            "{subject}: the link was lost before it was read back. The unit's value is unknown \
             until it is read again."
        ),
        WriteError::NoSuchSetting => format!("{subject}: not sent, the unit has no such setting."),
        WriteError::Locked => {
            format!("{subject}: not sent, the service functions are locked. Unlock Service.")
        }
        WriteError::LockedOut => {
            format!("{subject}: not sent, the unit is in maintenance. Your edit is kept.")
        }
        WriteError::Moving => {
            format!("{subject}: not sent, the antenna is moving. Apply when it has stopped.")
        }
        WriteError::Stopped => format!("{subject}: not sent, STOP came first."),
        WriteError::Hindered { field, hindrance } => {
            let label = group.field(field).map_or(subject, |field| field.label);
            format!("{label}: not sent. {} Your edit is kept.", words::hindrance(*hindrance))
        }
        WriteError::Unread(failure) => format!(
            "{subject}: not sent, its present value cannot be read: {}. Read again.",
            read_failure(failure)
        ),
        WriteError::ChangedMeanwhile => {
            let changed = changed(group, expected, current);
            format!("{}: not sent. {changed} Apply again to send yours.", group.title)
        }
        WriteError::CannotBeSent { field, reason } => {
            let label = group.field(field).map_or(subject, |field| field.label);
            format!("{label} {reason}. Nothing was sent.")
        }
        WriteError::Refused(answer) => {
            format!("{subject}: the unit answered {answer} and kept {}.", kept_text())
        }
        WriteError::Unanswered => {
            format!("{subject}: the unit did not answer and kept {}. Apply again.", kept_text())
        }
        WriteError::NotReadBack(failure) => format!(
            "{subject}: sent, but not read back: {}. The unit's value is unknown. Read again.",
            read_failure(failure)
        ),
        WriteError::Differs(keys) => {
            let fields: Vec<&Field> = keys.iter().filter_map(|key| group.field(key)).collect();
            let holds = self::kept_values(&fields, current);
            format!("{subject}: the unit accepted it, but holds {holds}. Read again.")
        }
        WriteError::Useless(explanation) => format!("{subject}: set, but {explanation}."),
    }
}

/// Formats the unit's values in `fields`.
fn kept_values(fields: &[&Field], current: Option<&Values>) -> String {
    let value =
        |field: &Field| with_unit(field, current.and_then(|current| current.get(field.key)));
    if let [only] = fields {
        return value(only);
    }
    let named = fields.iter().map(|field| format!("{} {}", field.label, value(field)));
    named.collect::<Vec<_>>().join(", ")
}

/// Lists the fields whose values on the unit differ from the expected ones.
fn changed(group: &Group, expected: Option<&Values>, current: Option<&Values>) -> String {
    let changes = group.fields.iter().filter_map(|field| {
        let (was, is) = (expected?.get(field.key), current?.get(field.key));
        let same = match (was, is) {
            (Some(was), Some(is)) => field.kind.same(was, is),
            (was, is) => was.is_some() == is.is_some(),
        };
        let (was, is) = (with_unit(field, was), with_unit(field, is));
        (!same).then(|| format!("{} was {was} and is now {is}", field.label))
    });
    let changes: Vec<String> = changes.collect();
    if changes.is_empty() {
        return "Its values on the unit have changed meanwhile.".to_owned();
    }
    format!("On the unit: {}.", changes.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::satrak::settings::{FTP, GENERAL, PASSWORD};
    use crate::device::settings::{Change, Secret};
    use jiff::Timestamp;

    fn outcome_text(values: Values, error: &WriteError, expected_deg: f64, current: f64) -> String {
        let make_values = |low| Values::from([("elevation_threshold_deg", Value::Decimal(low))]);
        let change =
            Change { ticket: 1, group: GENERAL.key, values, expected: None, is_unlocked: false };
        let written = Written { change, time: Timestamp::UNIX_EPOCH, result: Err(error.clone()) };
        sentence(
            &GENERAL,
            &written,
            error,
            Some(&make_values(expected_deg)),
            Some(&make_values(current)),
        )
    }

    #[test]
    fn a_refusal_names_the_field_the_answer_and_what_was_kept() {
        let values = Values::from([("elevation_threshold_deg", Value::Decimal(12.0))]);
        assert_eq!(
            outcome_text(values.clone(), &WriteError::Refused("ERR,7".to_owned()), 2.0, 2.0),
            "Elevation threshold: the unit answered ERR,7 and kept 2.0°."
        );
        assert_eq!(
            outcome_text(values, &WriteError::ChangedMeanwhile, 2.0, 7.5),
            "General: not sent. On the unit: Elevation threshold was 2.0° and is now 7.5°. Apply \
             again to send yours."
        );
    }

    #[test]
    fn a_password_is_never_in_a_sentence() {
        let secret = |text: &str| Values::from([PASSWORD.entry(Secret::new(text))]);
        let values = secret("hunter2");
        let change =
            Change { ticket: 1, group: FTP.key, values, expected: None, is_unlocked: false };
        for error in [
            WriteError::Refused("7".to_owned()),
            WriteError::ChangedMeanwhile,
            WriteError::Differs(vec![PASSWORD.name]),
        ] {
            let result = Err(error.clone());
            let written = Written { change: change.clone(), time: Timestamp::UNIX_EPOCH, result };
            let (loaded, current) = (secret("hunter3"), secret("hunter4"));
            let words = sentence(&FTP, &written, &error, Some(&loaded), Some(&current));
            assert!(!words.contains("hunter") && words.contains(HIDDEN), "{words}");
        }
    }
}
